/* SPDX-License-Identifier: BSD-3-Clause */
/* weibull.c: how drawn strengths are distributed, by volumes, and what they do not depend on. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "harness/message.h"
#include "unit/solids.h"

static const double shape = 6.0, volume = 2e-5; /* m^3 */

static dem_weibull law(uint64_t seed)
{
    return (dem_weibull)SIZED(dem_weibull, .shape = shape, .volume = volume, .seed = seed);
}

static int by_size(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Largest difference of the distribution of n values from that of exp(1), times sqrt(n): Kolmogorov's statistic, below
 * 1.36 in 95 and below 1.63 in 99 of 100 cases. Sorts them. */
static double kolmogorov(double *values, dem_index n)
{
    double most = 0.0;
    qsort(values, (size_t)n, sizeof *values, by_size);
    for (dem_index k = 0; k < n; k++) {
        const double expected = 1.0 - exp(-values[k]);
        most = fmax(most, fmax(expected - (double)k / (double)n, (double)(k + 1) / (double)n - expected));
    }
    return most * sqrt((double)n);
}

/* (V/V_0) s^m is exponentially distributed. */
static double unit_of(double factor, double its_volume)
{
    return its_volume / volume * pow(factor, shape);
}

static double volume_of(const dem_lattice *l, dem_index t)
{
    return l->thickness[t] * area_of(l, t);
}

/* ---- distribution ---- */

/* Triangles of many sizes. The mean of exp(1) is 1, with a standard deviation of 1: 3/sqrt(n). */
TEST(strengths_of_triangles_have_weibulls_distribution)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.4, 0.4, 0.01);
    assert_ok(dem_lattice_jitter(&lattice, 0.003, 1));
    assert_ok(dem_lattice_assemble(&lattice, &rubber));
    const dem_index n = lattice.n_triangles;
    double *factor = calloc((size_t)n, sizeof *factor), mean = 0.0;
    assert_true(n > 3000 && factor != NULL);
    assert_ok(dem_lattice_weibull(&lattice, &(dem_weibull)SIZED(dem_weibull, .shape = shape, .volume = volume), 1, NULL,
                                  factor, NULL));
    for (dem_index t = 0; t < n; t++) mean += (factor[t] = unit_of(factor[t], volume_of(&lattice, t))) / (double)n;
    assert_close(mean, 1.0, 3.0 / sqrt((double)n));
    assert_true(kolmogorov(factor, n) < 1.36);
    free(factor);
}

/* The same draws in a law of 16 times the volume are 16^(1/m) as strong, to rounding. At m = 1 the mean of as many
 * draws as here is known to 1/sqrt(n), 0.2 %, so that a volume is met to 0.6 %. */
TEST(exponent_and_volume_are_exact)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.4, 0.4, 0.01);
    assert_ok(dem_lattice_assemble(&lattice, &rubber));
    const dem_index n = lattice.n_triangles;
    enum { SEEDS = 80 };
    double *small = calloc((size_t)n, sizeof *small), *large = calloc((size_t)n, sizeof *large), mean = 0.0;
    assert_true(n > 3000 && small != NULL && large != NULL);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        dem_weibull w = law(seed);
        assert_ok(dem_lattice_weibull(&lattice, &w, 1, NULL, small, NULL));
        w.volume *= 16.0;
        assert_ok(dem_lattice_weibull(&lattice, &w, 1, NULL, large, NULL));
        for (dem_index t = 0; t < n; t++) assert_close(large[t] / small[t], pow(16.0, 1.0 / shape), 1e-12);
        w = (dem_weibull)SIZED(dem_weibull, .shape = 1.0, .volume = volume, .seed = seed);
        assert_ok(dem_lattice_weibull(&lattice, &w, 1, NULL, small, NULL));
        for (dem_index t = 0; t < n; t++) mean += small[t] * volume_of(&lattice, t) / volume / (double)(SEEDS * n);
    }
    assert_close(mean, 1.0, 3.0 / sqrt((double)(SEEDS * n)));
    free(small);
    free(large);
}

/* Volumes by hand: of n equal parts of each triangle or cell a spring inside has two, at the boundary one. */
static void check_springs(const dem_lattice *lattice, double side, double diagonal)
{
    const dem_index n = lattice->n_springs;
    double *factor = calloc((size_t)n, sizeof *factor), mean = 0.0, most = 0.0;
    const dem_weibull w = law(5);
    assert_non_null(factor);
    for (dem_index k = 0; k < n; k++) most = fmax(most, lattice->stiffness[k] / lattice->rest_length[k]);
    assert_ok(dem_lattice_weibull(lattice, &w, 1, NULL, NULL, factor));
    for (dem_index k = 0; k < n; k++) {
        const bool turned = lattice->rest_length[k] > 0.012;
        const bool rim = !turned && lattice->stiffness[k] / lattice->rest_length[k] < 0.75 * most;
        factor[k] = unit_of(factor[k], (turned ? diagonal : side) * (rim ? 0.5 : 1.0));
        mean += factor[k] / (double)n;
    }
    assert_close(mean, 1.0, 3.0 / sqrt((double)n));
    assert_true(kolmogorov(factor, n) < 1.36);
    for (dem_index k = 1; k < n; k++) assert_true(factor[k] - factor[k - 1] > 1e-12 * factor[k]); /* each its own */
    free(factor);
}

TEST(springs_have_two_thirds_of_the_volume_of_a_triangle_of_a_regular_lattice)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.3, 0.3, 0.01);
    check_springs(&lattice, 2.0 / 3.0 * volume_of(&lattice, 0), 0.0);
}

/* A cell gives an eighth to each of its sides, and a fourth to each of its diagonals. */
TEST(springs_of_squares_have_a_fourth_of_the_volume_of_a_cell)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_squares(&lattice, 0.3, 0.3, 0.01));
    assert_ok(dem_lattice_assemble_squares(&lattice, &rubber, 0.5));
    check_springs(&lattice, 0.5 * volume_of(&lattice, 0), 0.5 * volume_of(&lattice, 0));
}

/* Of 400 bodies the weakest triangle, at two spacings, 64 and 272 triangles. */
TEST(the_weakest_link_of_a_body_does_not_depend_on_the_mesh)
{
    enum { bodies = 400 };
    for (int mesh = 0; mesh < 2; mesh++) {
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.05, 0.05, mesh == 0 ? 0.01 : 0.005);
        double *factor = calloc((size_t)lattice.n_triangles, sizeof *factor), body = 0.0, strength[bodies];
        assert_non_null(factor);
        for (dem_index t = 0; t < lattice.n_triangles; t++) body += volume_of(&lattice, t);
        for (int b = 0; b < bodies; b++) {
            const dem_weibull w = law(100 + (uint64_t)b);
            assert_ok(dem_lattice_weibull(&lattice, &w, 1, NULL, factor, NULL));
            double least = (double)INFINITY;
            for (dem_index t = 0; t < lattice.n_triangles; t++) least = fmin(least, factor[t]);
            strength[b] = unit_of(least, body);
        }
        assert_true(kolmogorov(strength, bodies) < 1.36);
        free(factor);
    }
}

TEST(the_larger_the_shape_the_less_strengths_scatter)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.05, 0.05, 0.01);
    double factor[200];
    const dem_weibull w = SIZED(dem_weibull, .shape = 1e6, .volume = volume);
    assert_true(lattice.n_triangles <= 200);
    assert_ok(dem_lattice_weibull(&lattice, &w, 1, NULL, factor, NULL));
    for (dem_index t = 0; t < lattice.n_triangles; t++) assert_close(factor[t], 1.0, 2e-5); /* ln(-ln u)/1e6 */
}

/* ---- what draws do not depend on ---- */

static bool is_right(void *context, const double *x)
{
    (void)context;
    return x[0] > -0.001;
}

/* A seed, a body and a number make a strength: a half that keeps its numbers draws what it had. */
TEST(a_part_that_keeps_its_numbers_draws_as_the_whole)
{
    CLEANUP(dem_lattice_free) dem_lattice whole = make_rectangle(0.1, 0.1, 0.01), part = make_rectangle(0.1, 0.1, 0.01);
    const dem_index n = whole.n_triangles;
    double *of_whole = calloc((size_t)n, sizeof *of_whole), *of_part = calloc((size_t)n, sizeof *of_part);
    dem_index *number = calloc((size_t)n, sizeof *number), n_same = 0;
    dem_weibull w = law(9);
    assert_true(of_whole && of_part && number);
    assert_ok(dem_lattice_cut(&part, is_right, NULL));
    for (dem_index t = 0, k = 0; t < n; t++) {
        bool kept = true;
        for (int c = 0; c < 3; c++) kept = kept && is_right(NULL, whole.x + 2 * whole.triangles[3 * t + c]);
        if (kept) number[k++] = t;
    }
    assert_ok(dem_lattice_weibull(&whole, &w, 1, NULL, of_whole, NULL));
    w.number = number;
    assert_ok(dem_lattice_weibull(&part, &w, 1, NULL, of_part, NULL));
    for (dem_index t = 0; t < part.n_triangles; t++) assert_close(of_part[t], of_whole[number[t]], 0.0);
    w.number = NULL;
    assert_ok(dem_lattice_weibull(&part, &w, 1, NULL, of_part, NULL));
    for (dem_index t = 0; t < part.n_triangles; t++) n_same += of_part[t] == of_whole[number[t]];
    assert_true(n_same < part.n_triangles / 10);
    free(of_whole);
    free(of_part);
    free(number);
}

/* Nodes backwards, triangles backwards with their numbers: springs get another order, but not another strength. */
static dem_lattice turn_numbers(dem_index *number)
{
    dem_lattice l = make_rectangle(0.1, 0.1, 0.01);
    const dem_index n = l.n_nodes, m = l.n_triangles;
    dem_index *old = calloc((size_t)m, 3 * sizeof *old);
    double *x = calloc((size_t)n, 2 * sizeof *x);
    assert_true(old && x);
    memcpy(old, l.triangles, (size_t)m * 3 * sizeof *old);
    for (dem_index k = 0; k < 2 * n; k++) x[k] = l.x[2 * (n - 1 - k / 2) + k % 2];
    for (dem_index k = 0; k < 3 * m; k++) l.triangles[k] = n - 1 - old[3 * (m - 1 - k / 3) + k % 3];
    for (dem_index t = 0; t < m; t++) number[t] = m - 1 - t;
    memcpy(l.x, x, (size_t)n * 2 * sizeof *x);
    free(old);
    free(x);
    assert_ok(dem_lattice_assemble(&l, &rubber));
    return l;
}

static dem_index spring_between(const dem_lattice *l, dem_index i, dem_index j)
{
    for (dem_index k = 0; k < l->n_springs; k++)
        if (l->ends[2 * k] == (i < j ? i : j) && l->ends[2 * k + 1] == (i < j ? j : i)) return k;
    fail_msg("no spring between %lld and %lld", (long long)i, (long long)j);
    return -1;
}

TEST(strengths_do_not_depend_on_how_nodes_and_springs_are_numbered)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.1, 0.1, 0.01);
    const dem_index n = lattice.n_triangles, m = lattice.n_springs;
    dem_index *number = calloc((size_t)n, sizeof *number);
    double *a = calloc((size_t)n, sizeof *a), *b = calloc((size_t)n, sizeof *b);
    double *p = calloc((size_t)m, sizeof *p), *q = calloc((size_t)m, sizeof *q);
    assert_true(number && a && b && p && q);
    CLEANUP(dem_lattice_free) dem_lattice turned = turn_numbers(number);
    dem_weibull w = law(3);
    assert_ok(dem_lattice_weibull(&lattice, &w, 1, NULL, a, p));
    w.number = number;
    assert_ok(dem_lattice_weibull(&turned, &w, 1, NULL, b, q));
    for (dem_index t = 0; t < n; t++) assert_close(b[n - 1 - t], a[t], 0.0);
    for (dem_index k = 0; k < m; k++) { /* two volumes are added in another order: a rounding */
        const dem_index last = lattice.n_nodes - 1, *end = lattice.ends + 2 * k;
        assert_close(q[spring_between(&turned, last - end[0], last - end[1])], p[k], 1e-15 * p[k]);
    }
    free(number);
    free(a);
    free(b);
    free(p);
    free(q);
}

TEST(seeds_and_bodies_draw_anew_and_both_kinds_of_elements_apart)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.05, 0.05, 0.01);
    double first[200], other[200], springs[400];
    dem_weibull w = law(1);
    assert_true(lattice.n_triangles <= 200 && lattice.n_springs <= 400);
    assert_ok(dem_lattice_weibull(&lattice, &w, 1, NULL, first, springs));
    for (int change = 0; change < 3; change++) {
        w.seed = 1 + (change == 0);
        w.body = change == 1;
        assert_ok(dem_lattice_weibull(&lattice, &w, 1, NULL, other, NULL));
        for (dem_index t = 0; t < lattice.n_triangles; t++) assert_true((first[t] == other[t]) == (change == 2));
    }
}

/* ---- laws ---- */

static int laws_at(const dem_lattice *l, const dem_index *of, dem_index spring)
{
    const dem_index *end = l->ends + 2 * spring;
    int found = 0;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        int shared = 0;
        for (int c = 0; c < 3; c++) shared += l->triangles[3 * t + c] == end[0] || l->triangles[3 * t + c] == end[1];
        if (shared == 2) found |= of[t] ? 2 : 1;
    }
    return found;
}

TEST(each_triangle_has_its_law_and_a_spring_between_two_the_smaller_factor)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.05, 0.05, 0.01);
    dem_weibull laws[2] = {law(1), law(1)};
    dem_index of[200];
    double a[200], b[200], mixed[200], p[400], q[400], both[400];
    int n[4] = {0};
    laws[1].shape = 0.0;
    assert_true(lattice.n_triangles <= 200 && lattice.n_springs <= 400);
    for (dem_index t = 0; t < lattice.n_triangles; t++) of[t] = t < 20;
    assert_ok(dem_lattice_weibull(&lattice, &laws[0], 1, NULL, a, p));
    assert_ok(dem_lattice_weibull(&lattice, &laws[1], 1, NULL, b, q));
    assert_ok(dem_lattice_weibull(&lattice, laws, 2, of, mixed, both));
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        assert_close(b[t], 1.0, 0.0);
        assert_close(mixed[t], of[t] ? b[t] : a[t], 0.0);
    }
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        const int laws_of = laws_at(&lattice, of, k); /* 1: the first, 2: the second, 3: both */
        assert_close(both[k], laws_of == 1 ? p[k] : (laws_of == 2 ? q[k] : fmin(p[k], q[k])), 0.0);
        n[laws_of]++;
    }
    assert_true(n[1] > 50 && n[2] > 10 && n[3] > 5);
}

/* A chain: a section gives its springs a volume, here that of the law, so that the mean is that of exp(1). */
TEST(springs_without_triangles_have_the_volume_of_a_section)
{
    enum { n = 2000 };
    CLEANUP(dem_lattice_free) dem_lattice chain = dem_lattice_empty();
    double *factor = calloc(n, sizeof *factor);
    chain.n_nodes = n + 1;
    chain.n_springs = n;
    chain.x = calloc(n + 1, 2 * sizeof *chain.x);
    chain.ends = calloc(n, 2 * sizeof *chain.ends);
    chain.rest_length = calloc(n, sizeof *chain.rest_length);
    chain.stiffness = calloc(n, sizeof *chain.stiffness);
    assert_true(factor && chain.x && chain.ends && chain.rest_length && chain.stiffness);
    for (dem_index k = 0; k < n; k++) {
        chain.x[2 * k + 2] = (double)(k + 1);
        chain.ends[2 * k] = k;
        chain.ends[2 * k + 1] = k + 1;
        chain.rest_length[k] = chain.stiffness[k] = 1.0;
    }
    dem_weibull w = law(4);
    assert_int_equal(dem_lattice_weibull(&chain, &w, 1, NULL, NULL, factor), DEM_ERROR_MODEL);
    assert_message_parts("spring 0 * no triangle * section");
    w.section = 3.0 * volume;
    assert_ok(dem_lattice_weibull(&chain, &w, 1, NULL, NULL, factor));
    for (dem_index k = 0; k < n; k++) factor[k] = unit_of(factor[k], 3.0 * volume);
    assert_true(kolmogorov(factor, n) < 1.36);
    free(factor);
}

TEST(laws_that_are_none_are_refused)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.05, 0.05, 0.01);
    double factor[200];
    dem_index of[200] = {0};
    dem_weibull w = law(1);
    assert_true(lattice.n_triangles <= 200);
#define refused(message)                                                                                               \
    do {                                                                                                               \
        assert_true(dem_lattice_weibull(&lattice, &w, 1, of, factor, NULL) != DEM_OK);                                 \
        assert_message_parts(message);                                                                                 \
        w = law(1);                                                                                                    \
    } while (0)
    w.shape = -1.0;
    refused("law 0 * shape * -1");
    w.shape = (double)NAN;
    refused("law 0 * shape * nan");
    w.volume = 0.0;
    refused("law 0 * volume * 0 m^3");
    w.volume = (double)INFINITY;
    refused("law 0 * volume * inf");
    w.section = -2.0;
    refused("law 0 * section * -2");
    w.volume = 1e-300;
    w.shape = 0.5;
    refused("triangle 0 * factor 0");
    of[7] = 1;
    refused("triangle 7 * law 1 * there are 1");
    of[7] = 0;
    lattice.thickness[3] = 0.0;
    refused("triangle 3 * volume 0 m^3");
    assert_int_equal(dem_lattice_weibull(&lattice, NULL, 1, NULL, factor, NULL), DEM_ERROR_ARGUMENT);
    assert_message_parts("at least one law");
#undef refused
}
