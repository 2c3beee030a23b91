/* SPDX-License-Identifier: BSD-3-Clause */
/* mersenne_twister.c: the published numbers, and those of GSL, by which decks drew their pores before. */
#include "base/mersenne_twister.h"

#include <gsl/gsl_rng.h>

#include "../close.h"

static const double scale = 4294967296.0;

/* As in the C++ standard: of the seed 5489 number 10000 is 4123659995, and the first one is 3499211612. */
TEST(the_numbers_are_the_published_ones)
{
    mersenne_twister m;
    mersenne_twister_start(&m, 5489);
    assert_close(mersenne_twister_uniform(&m) * scale, 3499211612.0, 0.0);
    for (int k = 2; k < 10000; k++) (void)mersenne_twister_uniform(&m);
    assert_close(mersenne_twister_uniform(&m) * scale, 4123659995.0, 0.0);
}

TEST(seeds_give_the_numbers_of_gsl)
{
    static const unsigned long seeds[] = {0, 1, 4357, 123456789, 4294967295UL, 4294967296UL, 4294967297UL};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(rng);
    for (size_t s = 0; s < sizeof seeds / sizeof *seeds; s++) {
        mersenne_twister m;
        mersenne_twister_start(&m, seeds[s]);
        gsl_rng_set(rng, seeds[s]);
        for (int k = 0; k < 2000; k++) assert_close(mersenne_twister_uniform(&m), gsl_rng_uniform(rng), 0.0);
        for (int k = 0; k < 2000; k++) assert_close(mersenne_twister_positive(&m), gsl_rng_uniform_pos(rng), 0.0);
    }
    gsl_rng_free(rng);
}
