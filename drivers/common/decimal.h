/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers as texts that read back to the same bits. */
#ifndef DEM_DECIMAL_H
#define DEM_DECIMAL_H

enum { DECIMAL_SIZE = 32 }; /* bytes */

/** The fewest digits, from 15 on, that read back to the same bits, also where "-0" is an integer. */
void decimal_print(char out[DECIMAL_SIZE], double x);

#endif
