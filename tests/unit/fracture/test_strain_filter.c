/* SPDX-License-Identifier: BSD-3-Clause */
/* strain_filter.c: no triangle is near its limit where no spring is over its threshold, and the bound is of use. */
#include "verification/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fracture/strain_filter.h"
#include "fracture/utilisation.h"
#include "model/node_stress.h"

static const double near_limit = 0.97;

typedef struct subject {
    dem_lattice lattice;
    dem_model *model;
    element_state state;
    strain_filter filter;
} subject;

/* What breaks its triangles: tension alone, by the stresses of their corners or their own, or pressure, too, of a plate
 * and of a slice of a long body. */
enum { TENSION, OWN, PLATE, SLICE, KINDS };

/* Every triangle has another strength. */
static void scatter(dem_lattice *l)
{
    double *factor = malloc((size_t)l->n_triangles * sizeof *factor);
    assert_non_null(factor);
    for (dem_index t = 0; t < l->n_triangles; t++) factor[t] = 1.0 + 0.1 * (double)(t % 7);
    assert_ok(dem_lattice_weaken(l, factor, NULL, NULL));
    free(factor);
}

static void open_subject(subject *s, double ratio, double jitter, int kind)
{
    const dem_material solid = {.struct_size = sizeof(dem_material),
                                .youngs_modulus = 1e7,
                                .poissons_ratio = ratio,
                                .density = 1e3,
                                .thickness = 0.7,
                                .guard = 0.02,
                                .springs = DEM_SPRINGS_COUPLED,
                                .plane = kind == SLICE ? DEM_PLANE_STRAIN : DEM_PLANE_STRESS,
                                .strength = 1e5,
                                .compressive_strength = kind < PLATE ? 0.0 : (kind == PLATE ? 1.1e5 : 3e5)};
    s->lattice = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&s->lattice, 0.08, 0.1, 0.01));
    if (jitter > 0.0) assert_ok(dem_lattice_jitter(&s->lattice, jitter * 0.01, 7));
    assert_ok(dem_lattice_assemble(&s->lattice, &solid));
    scatter(&s->lattice);
    s->lattice.own_stress = kind == OWN ? malloc((size_t)s->lattice.n_triangles) : NULL;
    for (dem_index t = 0; t < s->lattice.n_triangles && kind == OWN; t++) s->lattice.own_stress[t] = 1;
    s->model = support_model(&s->lattice, NULL, 0);
    assert_ok(stress_prepare(&s->model->stress));
    assert_ok(element_state_create(&s->state, &s->model->lattice, &s->model->springs));
    assert_ok(strain_filter_create(&s->filter, s->model, &s->state, near_limit));
}

static void close_subject(subject *s)
{
    strain_filter_destroy(&s->filter);
    element_state_destroy(&s->state);
    dem_model_destroy(s->model);
    dem_lattice_free(&s->lattice);
}

/* Displacements of all kinds: uniform strains that turn with `kind`, with some of random size at each node. */
static void displace(const dem_lattice *l, int kind, double factor, double *x)
{
    const double angle = 0.4 * kind, c = cos(angle), s = sin(angle), share = 0.25 * (kind % 5);
    unsigned seed = 12345u + (unsigned)kind;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double along = c * l->x[2 * i] + s * l->x[2 * i + 1], across = c * l->x[2 * i + 1] - s * l->x[2 * i];
        const double u = along, v = (kind % 3 - 1) * across;
        for (int d = 0; d < 2; d++) {
            seed = seed * 1664525u + 1013904223u;
            const double random = (double)(seed >> 8) / 16777216.0 - 0.5;
            const double uniform = d == 0 ? c * u - s * v : s * u + c * v;
            x[2 * i + d] = l->x[2 * i + d] + factor * ((1.0 - share) * uniform + share * 0.01 * random);
        }
    }
}

static double share_of(double strain, kernel_threshold threshold)
{
    return strain > 0.0 ? strain / (double)threshold.stretch : -strain / (double)threshold.squeeze;
}

/* Largest strain over its threshold. */
static double largest_share(const subject *s, const double *x)
{
    double most = 0.0;
    for (dem_index k = 0; k < s->lattice.n_springs; k++)
        most = fmax(most, share_of(springs_strain_of(&s->model->lattice, k, x), s->filter.threshold[k]));
    return most;
}

static double largest_utilisation(const subject *s, const double *x)
{
    double most = 0.0;
    for (dem_index t = 0; t < s->lattice.n_triangles; t++) most = fmax(most, utilisation_of(s->model, &s->state, t, x));
    return most;
}

/* Deformations such that the first spring is just below its threshold. */
TEST(nothing_is_near_its_limit_below_the_thresholds)
{
    const double ratios[3] = {-0.3, 1.0 / 3.0, 0.45}, jitters[3] = {0.0, 0.1, 0.25};
    for (int k = 0; k < 9 * KINDS; k++) {
        CLEANUP(close_subject) subject s;
        open_subject(&s, ratios[k % 3], jitters[k / 3 % 3], k / 9);
        double *x = malloc(2 * (size_t)s.lattice.n_nodes * sizeof *x), most = 0.0;
        assert_non_null(x);
        for (int kind = 0; kind < 60; kind++) {
            double factor = kind % 2 == 0 ? 1e-3 : -1e-3;
            for (int trial = 0; trial < 40; trial++) {
                displace(&s.lattice, kind, factor, x);
                factor *= 0.999 / largest_share(&s, x);
            }
            displace(&s.lattice, kind, 0.999 * factor, x);
            assert_true(largest_share(&s, x) < 1.0);
            most = fmax(most, largest_utilisation(&s, x));
        }
        free(x);
        assert_true(most < near_limit);
        /* The worst triangle of a jittered mesh decides: from a twentieth of the strength on looks are taken, from half
         * of that where pressure may break as well. */
        assert_true(most > (k / 9 < PLATE ? 0.05 : 0.025));
    }
}

/* The largest utilisation of a triangle by the stress at one of its corners, without confinement. */
static double driving(const subject *s, dem_index triangle, const double *x)
{
    utilisation_limits limits = utilisation_limits_of(&s->model->lattice, &s->state, triangle);
    double most = 0.0;
    limits.confinement = 0.0;
    for (int c = 0; c < 3; c++) {
        double at[3];
        node_stress(s->model, &s->state, NODE_STRESS_EFFECTIVE, s->lattice.triangles[3 * triangle + c], x, at);
        most = fmax(most, utilisation_of_stress(limits, at, at, at));
        assert_true(s->filter.weakest.tension <= limits.tension && s->filter.weakest.pressure <= limits.pressure);
    }
    return most;
}

/* To the rounding of sums. Those that break by their own stress are not asked by their corners'. */
TEST(no_triangle_is_nearer_to_its_limit_than_one_of_its_corners)
{
    const double ratios[3] = {-0.3, 1.0 / 3.0, 0.45};
    for (int k = 0; k < 3 * KINDS; k++) {
        if (k / 3 == OWN) continue;
        CLEANUP(close_subject) subject s;
        open_subject(&s, ratios[k % 3], 0.25, k / 3);
        double *x = malloc(2 * (size_t)s.lattice.n_nodes * sizeof *x), nearest = 0.0;
        assert_non_null(x);
        for (int kind = 0; kind < 60; kind++) {
            displace(&s.lattice, kind, kind % 2 == 0 ? 0.05 : -0.05, x);
            for (dem_index t = 0; t < s.lattice.n_triangles; t++) {
                const double own = utilisation_of(s.model, &s.state, t, x), beside = driving(&s, t, x);
                assert_true(own <= (1.0 + 1e-12) * beside);
                nearest = fmax(nearest, own / beside);
            }
        }
        free(x);
        assert_true(nearest > 0.8); /* the bound is of use */
    }
}

/* Where nothing breaks there is nothing to look at. */
TEST(a_body_without_strength_has_no_thresholds)
{
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    support_block(&block);
    block.critical_stretch = malloc((size_t)block.n_springs * sizeof *block.critical_stretch);
    assert_non_null(block.critical_stretch);
    for (dem_index k = 0; k < block.n_springs; k++) block.critical_stretch[k] = k == 5 ? 0.2 : (double)INFINITY;
    dem_model *model = support_model(&block, NULL, 0);
    element_state state;
    strain_filter filter;
    assert_ok(stress_prepare(&model->stress));
    assert_ok(element_state_create(&state, &model->lattice, &model->springs));
    assert_ok(strain_filter_create(&filter, model, &state, near_limit));
    for (dem_index k = 0; k < block.n_springs; k++) {
        assert_true(k == 5 || isinf(filter.threshold[k].stretch));
        assert_true(isinf(filter.threshold[k].squeeze));
    }
    assert_true((double)filter.threshold[5].stretch <= near_limit * 0.2); /* in single precision, rounded down */
    assert_close((double)filter.threshold[5].stretch, near_limit * 0.2, 0.2 * 0x1p-23);
    strain_filter_destroy(&filter);
    element_state_destroy(&state);
    dem_model_destroy(model);
}
