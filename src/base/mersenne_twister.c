/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/mersenne_twister.h"

static const int shift = 397; /* m of the recurrence: how far ahead the other word is */

void mersenne_twister_start(mersenne_twister *m, uint64_t seed)
{
    m->word[0] = (uint32_t)(seed == 0 ? 4357 : seed);
    for (uint32_t k = 1; k < MERSENNE_TWISTER_WORDS; k++) {
        const uint32_t before = m->word[k - 1];
        m->word[k] = 1812433253U * (before ^ (before >> 30)) + k;
    }
    m->next = MERSENNE_TWISTER_WORDS;
}

/* x[k + n] = x[k + m] xor (upper bit of x[k], lower bits of x[k + 1]) A, in place: what is behind is new already. */
static void renew(mersenne_twister *m)
{
    const int n = MERSENNE_TWISTER_WORDS;
    for (int k = 0; k < n; k++) {
        const uint32_t joined = (m->word[k] & 0x80000000U) | (m->word[(k + 1) % n] & 0x7fffffffU);
        m->word[k] = m->word[(k + shift) % n] ^ (joined >> 1) ^ ((joined & 1U) != 0 ? 0x9908b0dfU : 0U);
    }
    m->next = 0;
}

/* The tempering, which makes the leading bits of consecutive numbers equidistributed. */
static uint32_t next_word(mersenne_twister *m)
{
    if (m->next == MERSENNE_TWISTER_WORDS) renew(m);
    uint32_t y = m->word[m->next++];
    y ^= y >> 11;
    y ^= (y << 7) & 0x9d2c5680U;
    y ^= (y << 15) & 0xefc60000U;
    return y ^ (y >> 18);
}

double mersenne_twister_uniform(mersenne_twister *m)
{
    return next_word(m) / 4294967296.0;
}

double mersenne_twister_positive(mersenne_twister *m)
{
    double x;
    do x = mersenne_twister_uniform(m);
    while (x == 0.0);
    return x;
}
