/* SPDX-License-Identifier: BSD-3-Clause */
/* The Mersenne Twister MT19937 of Matsumoto and Nishimura (ACM Trans. Model. Comput. Simul. 8, 1998) with their seeding
 * of 2002: the numbers by which pores are drawn, the same on every machine. */
#ifndef DEM_BASE_MERSENNE_TWISTER_H
#define DEM_BASE_MERSENNE_TWISTER_H

#include <stdint.h>

enum { MERSENNE_TWISTER_WORDS = 624 };

typedef struct mersenne_twister {
    uint32_t word[MERSENNE_TWISTER_WORDS];
    int next; /* word that is to come; MERSENNE_TWISTER_WORDS: they are to be renewed */
} mersenne_twister;

/** Begins the numbers of a seed, of which the lower 32 bits count; 0 is as 4357. */
void mersenne_twister_start(mersenne_twister *m, uint64_t seed);

/** A multiple of 2^-32 in [0, 1). */
double mersenne_twister_uniform(mersenne_twister *m);

/** The same without 0: the next number that is none. */
double mersenne_twister_positive(mersenne_twister *m);

#endif
