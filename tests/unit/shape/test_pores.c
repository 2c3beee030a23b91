/* SPDX-License-Identifier: BSD-3-Clause */
/* pores.c: where random pores lie, and that a seed always gives the same ones. */
#include "unit/close.h"

#include <stdlib.h>

#include "shape/pores.h"

static const pores_recipe fourteen = {
    .box = {-0.055, 0.0, 0.055, 0.11}, .number = 14, .radius_min = 4e-3, .radius_max = 8e-3, .wall = 5e-3, .seed = 1};

static const double pi = 3.14159265358979323846;

static bool in_square(void *context, const double x[2], double radius)
{
    const double half = *(const double *)context;
    return fmin(half - fabs(x[0]), half - fabs(x[1] - half)) >= radius;
}

static pores place(const pores_recipe *recipe)
{
    double half = 0.055;
    pores out;
    assert_int_equal(pores_place(&out, recipe, in_square, &half), PORES_PLACED);
    assert_int_equal(out.n_placed, out.n);
    if (recipe->number > 0) assert_int_equal(out.n, recipe->number);
    return out;
}

TEST(pores_keep_the_wall_between_them_and_the_boundary)
{
    double half = 0.055;
    const pores p = place(&fourteen);
    for (int i = 0; i < 14; i++) {
        const pore *a = &p.list[i];
        assert_true(a->radius >= 4e-3 && a->radius <= 8e-3);
        assert_true(in_square(&half, a->centre, a->radius + 5e-3));
        if (i > 0) assert_true(a->radius <= p.list[i - 1].radius);
        for (int j = 0; j < i; j++) {
            const double dx = a->centre[0] - p.list[j].centre[0], dy = a->centre[1] - p.list[j].centre[1];
            assert_true(sqrt(dx * dx + dy * dy) >= a->radius + p.list[j].radius + 5e-3);
        }
    }
    free(p.list);
}

/* MT19937 with seed 5489, as in the C++ standard's mt19937, begins 3499211612, 581869302, 3890346734. */
TEST(a_seed_gives_the_numbers_of_the_published_generator)
{
    const double scale = 4294967296.0;
    double half = 0.5;
    const pores_recipe recipe = {
        .box = {-0.5, 0.0, 0.5, 1.0}, .number = 1, .radius_min = 0.01, .radius_max = 0.03, .seed = 5489};
    pores p;
    assert_int_equal(pores_place(&p, &recipe, in_square, &half), PORES_PLACED);
    assert_close(p.list[0].radius, 0.01 + 0.02 * 3499211612.0 / scale, 1e-15);
    assert_close(p.list[0].centre[0], -0.5 + 581869302.0 / scale, 1e-15);
    assert_close(p.list[0].centre[1], 3890346734.0 / scale, 1e-15);
    free(p.list);
}

TEST(the_same_seed_gives_the_same_pores_and_another_one_others)
{
    pores_recipe other = fourteen;
    other.seed = 2;
    const pores a = place(&fourteen), b = place(&fourteen), c = place(&other);
    assert_memory_equal(a.list, b.list, 14 * sizeof *a.list);
    assert_true(a.list[0].centre[0] != c.list[0].centre[0]);
    free(a.list);
    free(b.list);
    free(c.list);
}

TEST(equal_radii_are_legal_and_no_pores_are_too)
{
    pores_recipe recipe = fourteen;
    recipe.radius_max = recipe.radius_min;
    const pores p = place(&recipe);
    for (int i = 0; i < 14; i++) assert_close(p.list[i].radius, 4e-3, 0.0);
    free(p.list);
    recipe.number = 0;
    const pores none = place(&recipe);
    assert_int_equal(none.n, 0);
    free(none.list);
}

TEST(a_pore_that_finds_no_place_is_reported_with_its_radius)
{
    double half = 0.055;
    pores_recipe recipe = fourteen;
    pores p;
    recipe.number = 5;
    recipe.radius_min = 0.02, recipe.radius_max = 0.021;
    assert_int_equal(pores_place(&p, &recipe, in_square, &half), PORES_CROWDED);
    assert_int_equal(p.n, 5);
    assert_true(p.n_placed >= 1 && p.n_placed < 5);
    assert_true(p.list[p.n_placed].radius >= 0.02 && p.list[p.n_placed].radius <= 0.021);
    free(p.list);
}

/* ---- areas ---- */

static double area_of_all(const pores *p)
{
    double area = 0.0;
    for (size_t k = 0; k < p->n; k++) area += pi * p->list[k].radius * p->list[k].radius;
    return area;
}

TEST(an_area_is_met_to_half_a_pore)
{
    for (unsigned long seed = 1; seed <= 20; seed++) {
        const pores_recipe recipe = {.box = {-0.055, 0.0, 0.055, 0.11},
                                     .area = 0.3 * 0.11 * 0.11,
                                     .radius_min = 2e-3,
                                     .radius_max = 6e-3,
                                     .wall = 5e-4,
                                     .seed = seed};
        const pores p = place(&recipe);
        assert_close(area_of_all(&p), recipe.area, 0.5 * pi * 6e-3 * 6e-3);
        assert_true(p.n > 20);
        free(p.list);
    }
}

static bool anywhere(void *context, const double x[2], double radius)
{
    (void)context;
    return isfinite(x[0] + x[1] + radius);
}

TEST(an_area_that_needs_too_many_pores_is_refused)
{
    const double most = DEM_PORES_MAX * pi * 1e-6;
    pores_recipe recipe = {
        .box = {-9.0, -9.0, 9.0, 9.0}, .area = most * (1.0 - 1e-9), .radius_min = 1e-3, .radius_max = 1e-3};
    pores p;
    assert_int_equal(pores_place(&p, &recipe, anywhere, NULL), PORES_PLACED);
    assert_int_equal(p.n, DEM_PORES_MAX);
    free(p.list);
    recipe.area = most * (1.0 + 1e-4);
    assert_int_equal(pores_place(&p, &recipe, anywhere, NULL), PORES_TOO_MANY);
    assert_null(p.list);
}

/* ---- distributions ---- */

static int by_radius(const void *a, const void *b)
{
    const double ra = ((const pore *)a)->radius, rb = ((const pore *)b)->radius;
    return (ra > rb) - (ra < rb);
}

/* Kolmogorov and Smirnov: the largest distance of 4000 radii from their distribution, cut off at both ends. It exceeds
 * 1.95/sqrt(n) in one of a thousand samples; the seed is not one that was looked for. */
static void expect_distribution(pores_recipe *recipe, double (*below)(double radius))
{
    const double low = below(recipe->radius_min), high = below(recipe->radius_max);
    double largest = 0.0;
    pores p;
    recipe->box[0] = recipe->box[1] = -1e3, recipe->box[2] = recipe->box[3] = 1e3;
    recipe->number = 4000, recipe->seed = 1;
    assert_int_equal(pores_place(&p, recipe, anywhere, NULL), PORES_PLACED);
    qsort(p.list, p.n, sizeof *p.list, by_radius);
    for (size_t k = 0; k < p.n; k++) {
        const double expected = (below(p.list[k].radius) - low) / (high - low);
        assert_true(p.list[k].radius >= recipe->radius_min && p.list[k].radius <= recipe->radius_max);
        largest = fmax(largest, fabs(expected - (double)k / 4000.0));
    }
    free(p.list);
    assert_true(largest < 1.95 / sqrt(4000.0));
}

static double below_normal(double radius)
{
    return 0.5 * erfc(-(radius - 5.0) / 2.0 / sqrt(2.0));
}

/* Mean 5 and deviation 2: the logarithm has the variance ln(1 + 4/25) and the mean ln 5 less half of that. */
static double below_lognormal(double radius)
{
    const double variance = log(1.16);
    return 0.5 * erfc(-(log(radius) - log(5.0) + 0.5 * variance) / sqrt(2.0 * variance));
}

static double below_uniform(double radius)
{
    return radius;
}

TEST(radii_are_distributed_as_stated_between_their_limits)
{
    pores_recipe recipe = {.radius_min = 2.0, .radius_max = 9.0, .mean = 5.0, .deviation = 2.0};
    expect_distribution(&recipe, below_uniform);
    recipe.distribution = DEM_PORE_RADII_NORMAL;
    expect_distribution(&recipe, below_normal);
    recipe.distribution = DEM_PORE_RADII_LOGNORMAL;
    expect_distribution(&recipe, below_lognormal);
}

/* Rounded to single precision, their digits are those of any libm. */
TEST(radii_that_need_a_libm_are_rounded)
{
    for (int k = 1; k <= 2; k++) {
        pores_recipe recipe = fourteen;
        recipe.distribution = (dem_pore_radii)k;
        recipe.mean = 6e-3, recipe.deviation = 1e-3;
        const pores p = place(&recipe);
        for (size_t i = 0; i < p.n; i++) assert_true(p.list[i].radius == (double)(float)p.list[i].radius);
        free(p.list);
    }
}

TEST(radii_that_hardly_ever_come_are_refused)
{
    pores_recipe recipe = fourteen;
    pores p;
    recipe.distribution = DEM_PORE_RADII_NORMAL;
    recipe.mean = 1.0, recipe.deviation = 1e-3;
    assert_int_equal(pores_place(&p, &recipe, anywhere, NULL), PORES_RARE);
    recipe.distribution = DEM_PORE_RADII_LOGNORMAL;
    recipe.mean = 1e-300, recipe.deviation = 1e300; /* a variance that overflows */
    assert_int_equal(pores_place(&p, &recipe, anywhere, NULL), PORES_RARE);
    assert_null(p.list);
}

TEST(impossible_recipes_are_refused)
{
    pores_recipe bad[10];
    pores p;
    for (int k = 0; k < 10; k++) bad[k] = fourteen;
    bad[0].radius_min = 0.0;
    bad[1].radius_max = 3e-3;
    bad[2].wall = -1.0;
    bad[3].number = DEM_PORES_MAX + 1;
    bad[4].box[2] = -1.0;
    bad[5].radius_max = (double)INFINITY;
    bad[6].wall = (double)NAN;
    bad[7].area = -1.0;
    bad[8].distribution = DEM_PORE_RADII_NORMAL, bad[8].mean = 1.0;
    bad[9].distribution = DEM_PORE_RADII_LOGNORMAL, bad[9].deviation = 1.0;
    for (int k = 0; k < 10; k++) assert_int_equal(pores_place(&p, &bad[k], anywhere, NULL), PORES_UNSOUND);
}
