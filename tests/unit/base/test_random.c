/* SPDX-License-Identifier: BSD-3-Clause */
/* random.h: numbers by seed, stream and place. */
#include "base/random.h"

#include "../close.h"

enum { n = 20000 };

/* Kolmogorov's limit of 1 % for n numbers; these are fixed by their seeds. */
TEST(numbers_of_a_stream_are_uniform)
{
    enum { bins = 100 };
    for (uint64_t seed = 0; seed < 5; seed++) {
        int count[bins] = {0};
        double sum = 0.0, most = 0.0;
        for (uint64_t k = 0; k < n; k++) count[(int)(bins * random_at(seed, 7, k))]++;
        for (int b = 0; b < bins; b++) {
            sum += count[b] / (double)n;
            most = fmax(most, fabs(sum - (b + 1.0) / bins));
        }
        assert_true(most < 1.63 / sqrt(n));
    }
}

/* Correlations of independent numbers are below 4/sqrt(n) but once in 16,000 times. */
TEST(neighbouring_seeds_streams_and_places_are_independent)
{
    double of_seeds = 0.0, of_streams = 0.0, of_places = 0.0;
    for (uint64_t k = 0; k < n; k++) {
        const double here = random_at(3, 5, k) - 0.5;
        of_seeds += 12.0 * here * (random_at(4, 5, k) - 0.5) / n;
        of_streams += 12.0 * here * (random_at(3, 6, k) - 0.5) / n;
        of_places += 12.0 * here * (random_at(3, 5, k + 1) - 0.5) / n;
    }
    assert_close(of_seeds, 0.0, 4.0 / sqrt(n));
    assert_close(of_streams, 0.0, 4.0 / sqrt(n));
    assert_close(of_places, 0.0, 4.0 / sqrt(n));
}

/* Whoever gives a seed again gets the same numbers: what they were is written here. */
TEST(the_numbers_of_a_seed_stay_what_they_are)
{
    uint64_t state = 1;
    assert_close(random_next(&state), -0.8668768496554381, 0.0);
    assert_close(random_at(1, 0, 0), 0.69351213901022934, 0.0);
    assert_close(random_at(1, 2, 3), 0.81425901152932811, 0.0);
}
