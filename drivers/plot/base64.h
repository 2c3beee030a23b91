/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers as text, four letters for three bytes (RFC 4648), little-endian. */
#ifndef DEM_BASE64_H
#define DEM_BASE64_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/** To be set to {out}. */
typedef struct base64 {
    FILE *out;
    unsigned char kept[3]; /* bytes that wait for their letters */
    int n;
} base64;

/** The lowest `bytes` bytes of a whole number, at most 8. */
void base64_whole(base64 *b, uint64_t number, int bytes);
void base64_single(base64 *b, float number);
void base64_real(base64 *b, double number);

/** The letters of what waits. */
void base64_end(base64 *b);

/** How many letters so many bytes have. */
double base64_length(double bytes);

#endif
