/* SPDX-License-Identifier: BSD-3-Clause */
/* A JSON text, written from its beginning to its end in one line. */
#ifndef DEM_JSON_H
#define DEM_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/** To be set to {out}. In what follows `key` is NULL for an element of an array, and for the outermost object. */
typedef struct json {
    FILE *out;
    bool inner; /* something stands before the next value in its object or array */
} json;

void json_open(json *j, const char *key, char bracket); /* '{' or '[' */
void json_close(json *j, char bracket);                 /* '}' or ']' */

/** What is not UTF-8 becomes U+FFFD; NULL is null. */
void json_text(json *j, const char *key, const char *text);

/** Reads back to the same bits; null where it is not finite. */
void json_real(json *j, const char *key, double x);
void json_reals(json *j, const char *key, const double *x, int n);

void json_integer(json *j, const char *key, int64_t n);
void json_truth(json *j, const char *key, bool value);

#endif
