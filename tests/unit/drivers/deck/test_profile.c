/* SPDX-License-Identifier: BSD-3-Clause */
/* profile.c: curves that go through their points without overshoot, and heights with the statistics asked for. */
#include "unit/close.h"

#include <stdlib.h>

#include "profile.h"

static const double flat[] = {0.0, 0.0, 1.0, 0.0};
static const double hill[] = {0.0, 0.0, 1.0, 1.0, 3.0, 2.0, 4.0, 0.0};

/* To be freed. */
static double *sample(const profile_recipe *recipe)
{
    double *out = calloc(2 * (recipe->n_segments + 1), sizeof *out);
    assert_non_null(out);
    assert_int_equal(profile_sample(out, recipe), DEM_OK);
    return out;
}

/* ---- mean line ---- */

TEST(samples_are_equally_spaced_from_the_first_to_the_last_point)
{
    const profile_recipe recipe = {.points = hill, .n_points = 4, .n_segments = 7, .smooth = true};
    CLEANUP(free_memory) double *out = sample(&recipe);
    for (int k = 0; k <= 7; k++) assert_close(out[2 * k], 4.0 * k / 7.0, 1e-15);
    assert_close(out[14], 4.0, 0.0);
    assert_close(out[15], 0.0, 0.0);
}

/* By hand: Steffen's slopes are 1, 5/6, 0, -2; a cubic's middle is (y0 + y1)/2 + h (m0 - m1)/8. */
TEST(the_smooth_curve_is_that_of_steffen)
{
    const double expected[] = {0.0, 0.5 + 1.0 / 48.0, 1.0, NAN, 1.5 + 5.0 / 24.0, NAN, 2.0, 1.25, 0.0};
    const profile_recipe recipe = {.points = hill, .n_points = 4, .n_segments = 8, .smooth = true};
    CLEANUP(free_memory) double *out = sample(&recipe);
    for (int k = 0; k <= 8; k++)
        if (!isnan(expected[k])) assert_close(out[2 * k + 1], expected[k], 1e-14);
}

TEST(the_smooth_curve_stays_between_neighbouring_points)
{
    const double points[] = {0, 0, 1, 0.1, 2, 5, 3, 5, 4, -3, 5, -2.9, 6, 4};
    const profile_recipe recipe = {.points = points, .n_points = 7, .n_segments = 6000, .smooth = true};
    CLEANUP(free_memory) double *out = sample(&recipe);
    for (int k = 0; k <= 6000; k++) {
        const double *a = points + 2 * (k < 6000 ? k / 1000 : 5);
        assert_true(out[2 * k + 1] >= fmin(a[1], a[3]) - 1e-14 && out[2 * k + 1] <= fmax(a[1], a[3]) + 1e-14);
    }
}

/* A bend of the polyline is of the order of its segments: half of them, half of it. */
TEST(the_smooth_curve_has_no_corners)
{
    double bend[2] = {0.0, 0.0};
    for (int c = 0; c < 2; c++) {
        const profile_recipe recipe = {.points = hill, .n_points = 4, .n_segments = 400u << c, .smooth = true};
        CLEANUP(free_memory) double *out = sample(&recipe);
        for (size_t k = 1; k < recipe.n_segments; k++) {
            const double *y = out + 2 * k + 1;
            bend[c] = fmax(bend[c], fabs(y[2] - 2.0 * y[0] + y[-2]) * (double)recipe.n_segments / 4.0);
        }
    }
    assert_close(bend[1] / bend[0], 0.5, 0.05);
}

TEST(two_points_are_joined_by_a_straight_line)
{
    const double points[] = {-1.0, 2.0, 1.0, 4.0};
    const profile_recipe recipe = {.points = points, .n_points = 2, .n_segments = 10, .smooth = true};
    CLEANUP(free_memory) double *out = sample(&recipe);
    for (int k = 0; k <= 10; k++) assert_close(out[2 * k + 1], 3.0 + out[2 * k], 1e-15);
}

/* ---- heights ---- */

/* From MT19937, the sums and the kernel in a program of its own, with the exponential of its libm. */
TEST(heights_are_those_of_the_published_generator)
{
    const double expected[] = {-0.7206634879553279, -0.19036917351343433, 0.8037668264212315, 1.4781136816824678,
                               1.5265433108802624};
    const profile_recipe recipe = {
        .points = flat, .n_points = 2, .n_segments = 4, .roughness = 1.0, .correlation = 0.5, .seed = 5489};
    CLEANUP(free_memory) double *out = sample(&recipe);
    for (int k = 0; k <= 4; k++) assert_close(out[2 * k + 1], expected[k], 1e-14);
}

TEST(the_mean_line_and_a_scale_are_kept)
{
    profile_recipe recipe = {
        .points = hill, .n_points = 4, .n_segments = 100, .roughness = 0.25, .correlation = 0.5, .seed = 7};
    CLEANUP(free_memory) double *rough = sample(&recipe), *rougher, *mean;
    recipe.roughness = 1.0;
    rougher = sample(&recipe);
    recipe.roughness = 0.0;
    mean = sample(&recipe);
    for (int k = 0; k <= 100; k++) {
        const double *a = mean + 2 * k + 1, x = mean[2 * k];
        assert_close(*a, x < 1.0 ? x : (x < 3.0 ? 0.5 + 0.5 * x : 8.0 - 2.0 * x), 1e-14);
        assert_close(rough[2 * k], x, 0.0);
        assert_close(rougher[2 * k + 1] - *a, 4.0 * (rough[2 * k + 1] - *a), 1e-13);
    }
}

/* The last bits of the segments' length along x depend on the place: here it is off by up to 1e-13 of 0.25. */
TEST(heights_move_with_the_profile)
{
    for (int k = 0; k < 10; k++) {
        const double points[] = {1023.0 + 0.1 * k, 0.0, 1024.0 + 0.1 * k, 0.0}, origin[] = {0.0, 0.0, 1.0, 0.0};
        profile_recipe recipe = {
            .points = points, .n_points = 2, .n_segments = 4, .roughness = 1.0, .correlation = 0.5, .seed = 5};
        CLEANUP(free_memory) double *a = sample(&recipe), *b;
        recipe.points = origin;
        b = sample(&recipe);
        for (int i = 0; i <= 4; i++) assert_close(a[2 * i + 1], b[2 * i + 1], 1e-11);
    }
}

TEST(the_same_seed_gives_the_same_profile_and_another_one_another)
{
    profile_recipe recipe = {
        .points = hill, .n_points = 4, .n_segments = 100, .roughness = 0.1, .correlation = 0.5, .seed = 1};
    CLEANUP(free_memory) double *a = sample(&recipe), *b = sample(&recipe), *c;
    recipe.seed = 2;
    c = sample(&recipe);
    assert_memory_equal(a, b, 202 * sizeof *a);
    for (int k = 0; k <= 100; k++) assert_true(a[2 * k + 1] != c[2 * k + 1]);
}

/* Mean of y(k) y(k + lag). */
static double product(const double *out, size_t n, size_t lag)
{
    double sum = 0.0;
    for (size_t k = 0; k + lag < n; k++) sum += out[2 * k + 1] * out[2 * (k + lag) + 1];
    return sum / (double)(n - lag);
}

/* Over n correlation lengths c the mean has the standard error sqrt(sqrt(pi)/n), the mean product at the distance d
 * that of sqrt(sqrt(pi/2) (1 + exp(-2 (d/c)^2))/n), both over the roughness: Bartlett's formula, its sums as
 * integrals. n = 10000, and four standard errors are allowed. */
TEST(a_long_profile_has_the_roughness_and_the_autocorrelation_asked_for)
{
    enum { PER_LENGTH = 10, LENGTHS = 10000, N = PER_LENGTH * LENGTHS };
    const double points[] = {0.0, 0.0, LENGTHS, 0.0}, roughness = 0.3;
    const profile_recipe recipe = {
        .points = points, .n_points = 2, .n_segments = N, .roughness = roughness, .correlation = 1.0, .seed = 1};
    double *out = sample(&recipe), mean = 0.0;
    for (size_t k = 0; k <= N; k++) mean += out[2 * k + 1] / N;
    assert_close(mean / roughness, 0.0, 4.0 * sqrt(sqrt(acos(-1.0)) / LENGTHS));
    for (size_t lag = 0; lag <= 2 * PER_LENGTH; lag += PER_LENGTH / 2) {
        const double d = (double)lag / PER_LENGTH;
        const double error = sqrt(sqrt(acos(0.0)) * (1.0 + exp(-2.0 * d * d)) / LENGTHS);
        assert_close(product(out, N + 1, lag) / (roughness * roughness), exp(-d * d), 4.0 * error);
    }
    free(out);
}

/* Of Gaussian heights erf(1/sqrt(2)) are within the roughness, of uniform ones 1/sqrt(3). Of 20000 correlation lengths
 * about as many samples are independent: standard error sqrt(0.683 0.317/20000) = 0.0033, four of them are allowed. */
TEST(heights_are_gaussian)
{
    enum { N = 40000 };
    const double points[] = {0.0, 0.0, N / 2, 0.0};
    const profile_recipe recipe = {
        .points = points, .n_points = 2, .n_segments = N, .roughness = 1.0, .correlation = 1.0, .seed = 3};
    CLEANUP(free_memory) double *out = sample(&recipe);
    int within[2] = {0, 0};
    for (size_t k = 0; k <= N; k++)
        for (int c = 0; c < 2; c++) within[c] += fabs(out[2 * k + 1]) < c + 1.0;
    assert_close((double)within[0] / N, erf(1.0 / sqrt(2.0)), 0.0132);
    assert_close((double)within[1] / N, erf(2.0 / sqrt(2.0)), 0.0132);
}

/* Over the first, a middle and the last sample of 2000 seeds: mean squares have the standard error sqrt(2/2000). */
TEST(the_ends_are_as_rough_as_the_middle)
{
    enum { SEEDS = 2000 };
    double squares[3] = {0.0, 0.0, 0.0};
    profile_recipe recipe = {.points = flat, .n_points = 2, .n_segments = 8, .roughness = 1.0, .correlation = 0.5};
    for (recipe.seed = 1; recipe.seed <= SEEDS; recipe.seed++) {
        CLEANUP(free_memory) double *out = sample(&recipe);
        for (int c = 0; c < 3; c++) squares[c] += out[8 * c + 1] * out[8 * c + 1] / SEEDS;
    }
    for (int c = 0; c < 3; c++) assert_close(squares[c], 1.0, 4.0 * sqrt(2.0 / SEEDS));
}

/* ---- recipes ---- */

TEST(impossible_recipes_are_refused)
{
    static const double back[] = {0.0, 0.0, 1.0, 1.0, 1.0, 2.0}, odd[] = {0.0, 0.0, 1.0, (double)INFINITY};
    const profile_recipe good = {
        .points = hill, .n_points = 4, .n_segments = 8, .roughness = 0.1, .correlation = 1.0, .seed = 1};
    profile_recipe bad[10];
    double out[18] = {0};
    for (int k = 0; k < 10; k++) bad[k] = good;
    bad[0].n_points = 1;
    bad[1].n_segments = 0;
    bad[2].n_segments = PROFILE_MAX + 1;
    bad[3].points = back, bad[3].n_points = 3;
    bad[4].points = odd, bad[4].n_points = 2;
    bad[5].roughness = -0.1;
    bad[6].roughness = (double)NAN;
    bad[7].correlation = 0.99; /* of segments of 0.5 */
    bad[8].correlation = 501.0;
    bad[9].correlation = 0.0;
    assert_int_equal(profile_sample(out, &good), DEM_OK);
    for (int k = 0; k < 10; k++) assert_int_equal(profile_sample(out, &bad[k]), DEM_ERROR_ARGUMENT);
}
