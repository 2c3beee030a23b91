/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies whose strengths scatter, pulled until they break: bars of triangles and chains of springs, of 1, 4 and 16
 * times one volume, 200 of each. They start stretched and go on being stretched evenly, so that there are no waves;
 * what is broken is known to a step of the integrator. By Weibull's law of the weakest link (V/V_0) (s/sigma_0)^m of a
 * body is exponentially distributed whatever it is made of, and its mean strength is
 *     sigma_0 (V/V_0)^(-1/m) Gamma(1 + 1/m). */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

enum { BODIES = 200, SIZES = 3 };

static const int sizes[SIZES] = {1, 4, 16};
static const double shape = 8.0, scale = 1e-4, /* of strains */
    early = 0.96,                              /* where a pull begins, of what will break first; all else is refused */
    step = 2e-3,                               /* of the scale, of the integrator and between two looks */
    rate = 1e-5;                               /* 1/s; the speed of waves is about 1 m/s, bodies are up to 60 m long */

/* ---- what is drawn ---- */

/* Factors of one body's triangles or springs. \return the least, and where it is */
static double draw(const dem_lattice *l, double *limits, bool springs, double volume, uint64_t seed, dem_index *weakest)
{
    const dem_weibull law = SIZED(dem_weibull, .shape = shape, .volume = volume, .section = 1.0, .seed = seed);
    const dem_index n = springs ? l->n_springs : l->n_triangles;
    double least = (double)INFINITY;
    assert_ok(dem_lattice_weibull(l, &law, 1, NULL, springs ? NULL : limits, springs ? limits : NULL));
    for (dem_index k = 0; k < n; k++) {
        if (limits[k] < least) *weakest = k;
        least = fmin(least, limits[k]);
        limits[k] *= scale;
    }
    return least;
}

/* ---- pulling ---- */

/* Along axis c, by a strain at t = 0; across it it narrows by nu. */
static void stretch(dem_lattice *l, int c, double nu, double strain)
{
    double *place = calloc((size_t)l->n_nodes, 2 * sizeof *place), *v = calloc((size_t)l->n_nodes, 2 * sizeof *v);
    assert_true(place && v);
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) {
        const double along = k % 2 == c ? l->x[k] : -nu * l->x[k];
        place[k] = l->x[k] + strain * along;
        v[k] = rate * along;
    }
    support_start(l, place, v);
    free(place);
    free(v);
}

/* The end at 0 and the other one, of which rows of nodes are prescribed along axis c alone. */
static dem_boundary end_of(const dem_lattice *l, int c, double at, dem_index *nodes)
{
    dem_boundary b = SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY,
                           .components = c == 0 ? DEM_COMPONENT_X : DEM_COMPONENT_Y, .nodes = nodes);
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (fabs(l->x[2 * i + c] - at) < 1e-9) nodes[b.n_nodes++] = i;
    b.value[c] = rate * at;
    return b;
}

static dem_index count_broken(const support_run *run, dem_index n, bool springs, dem_index element, bool *is_broken)
{
    unsigned char *broken = calloc((size_t)n, 1);
    dem_index count = 0;
    assert_non_null(broken);
    assert_ok(dem_simulation_broken(run->simulation, springs ? NULL : broken, springs ? broken : NULL));
    for (dem_index k = 0; k < n; k++) count += broken[k];
    *is_broken = broken[element];
    free(broken);
    return count;
}

/* \return the strain over the scale at which something breaks, in the middle between two looks: it must be `weakest` */
static double pull(const dem_lattice *l, int c, bool springs, dem_index weakest, double begin)
{
    dem_index *nodes = calloc(2 * (size_t)l->n_nodes, sizeof *nodes);
    double far = 0.0, strain = begin;
    bool right = false;
    assert_non_null(nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) far = fmax(far, l->x[2 * i + c]);
    const dem_boundary ends[2] = {end_of(l, c, 0.0, nodes), end_of(l, c, far, nodes + l->n_nodes)};
    dem_options options = support_options();
    options.gravity[1] = 0.0;
    options.bodies = DEM_BODIES_NONE;
    options.max_step = step * scale / rate;
    options.boundaries = ends;
    options.n_boundaries = 2;
    CLEANUP(support_close) support_run run;
    support_open(&run, l, NULL, 0, &options);
    do {
        strain += step;
        assert_ok(dem_simulation_advance(run.simulation, (strain - begin) * scale / rate));
        assert_true(strain < begin + 0.1);
    } while (count_broken(&run, springs ? l->n_springs : l->n_triangles, springs, weakest, &right) == 0);
    assert_true(right);
    free(nodes);
    return strain - 0.5 * step;
}

/* ---- statistics ---- */

static int by_size(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Kolmogorov's statistic of the strengths of bodies: below 1.36 in 95 of 100 cases. */
static double kolmogorov(double *strength, double size)
{
    double most = 0.0;
    qsort(strength, BODIES, sizeof *strength, by_size);
    for (int b = 0; b < BODIES; b++) {
        const double expected = 1.0 - exp(-size * pow(strength[b], shape));
        most = fmax(most, fmax(expected - b / (double)BODIES, (b + 1.0) / BODIES - expected));
    }
    return most * sqrt(BODIES);
}

/* Of one body the standard deviation is 0.148 of the mean at m = 8: three of them over sqrt(200) are 3.1 %. */
static void check_strengths(double strength[SIZES][BODIES])
{
    for (int s = 0; s < SIZES; s++) {
        const double expected = pow(sizes[s], -1.0 / shape) * tgamma(1.0 + 1.0 / shape);
        double mean = 0.0;
        for (int b = 0; b < BODIES; b++) mean += strength[s][b] / BODIES;
        const double statistic = kolmogorov(strength[s], sizes[s]);
        print_message("# volume %2d: mean %.4f, expected %.4f; Kolmogorov %.2f\n", sizes[s], mean, expected, statistic);
        assert_close(mean, expected, 0.031 * expected);
        assert_true(statistic < 1.36);
    }
}

/* ---- bars and chains ---- */

/* Four spacings wide and four rows high for each volume, of 28 triangles. E = 1, so that a strength is a strain. The
 * stress is exact to the scale of strains, far below the step. */
TEST(bars_of_three_volumes_are_as_strong_as_weibull_says)
{
    const dem_material solid = SIZED(dem_material, .youngs_modulus = 1.0, .poissons_ratio = 1.0 / 3.0, .density = 1.0,
                                     .thickness = 1.0, .strength = scale);
    static double strength[SIZES][BODIES];
    for (int s = 0; s < SIZES; s++)
        for (int b = 0; b < BODIES; b++) {
            CLEANUP(dem_lattice_free)
            dem_lattice bar = support_rectangle(4.0, 4.0 * sizes[s] * sqrt(3.0) / 2.0, 1.0, &solid);
            dem_index weakest = -1;
            assert_int_equal(bar.n_triangles, 28 * sizes[s]);
            const double volume = 28.0 * sqrt(3.0) / 4.0;
            const double least = draw(&bar, bar.strength, false, volume, 1000 + (uint64_t)(s * BODIES + b), &weakest);
            stretch(&bar, 1, solid.poissons_ratio, early * least * scale);
            strength[s][b] = pull(&bar, 1, false, weakest, early * least);
            assert_close(strength[s][b], least, 1.5 * step + 1e-4);
        }
    check_strengths(strength);
}

TEST(chains_of_three_volumes_are_as_strong_as_weibull_says)
{
    static double strength[SIZES][BODIES];
    for (int s = 0; s < SIZES; s++)
        for (int b = 0; b < BODIES; b++) {
            double x[2 * 33] = {0.0}, masses[33];
            dem_index ends[64], weakest = -1;
            const dem_index n = 2 * sizes[s];
            for (dem_index i = 0; i <= n; i++) x[2 * i] = (double)i;
            for (dem_index i = 0; i <= n; i++) masses[i] = 1.0;
            for (dem_index k = 0; k < 2 * n; k++) ends[k] = (k + 1) / 2;
            CLEANUP(dem_lattice_free) dem_lattice chain = support_lattice(n + 1, x, masses, n, ends, 1.0, 1.0, NULL);
            chain.critical_stretch = calloc((size_t)n, sizeof *chain.critical_stretch);
            assert_non_null(chain.critical_stretch);
            const double least =
                draw(&chain, chain.critical_stretch, true, 2.0, 5000 + (uint64_t)(s * BODIES + b), &weakest);
            stretch(&chain, 0, 0.0, early * least * scale);
            strength[s][b] = pull(&chain, 0, true, weakest, early * least);
            assert_close(strength[s][b], least, 1.5 * step + 1e-6);
        }
    check_strengths(strength);
}
