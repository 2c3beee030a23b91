/* SPDX-License-Identifier: BSD-3-Clause */
/* stress_bound.c: springs that are strained no more than it says leave principal stresses below what was asked for, and
 * it does not say much less than that. */
#include "verification/support.h"

#include <math.h>
#include <stdlib.h>

#include "fracture/stress_bound.h"
#include "unit/model/triangle_stress.h"

static const double modulus = 1e7;

typedef struct subject {
    dem_lattice lattice;
    dem_model *model;
    element_state state;
    double *x;
} subject;

static void open_subject(subject *s, double ratio, dem_springs kind, double jitter)
{
    const dem_material solid = {.struct_size = sizeof(dem_material),
                                .youngs_modulus = modulus,
                                .poissons_ratio = ratio,
                                .density = 1e3,
                                .thickness = 0.7,
                                .guard = 0.02,
                                .springs = kind};
    s->lattice = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&s->lattice, 0.04, 0.04, 0.01));
    if (jitter > 0.0) assert_ok(dem_lattice_jitter(&s->lattice, jitter * 0.01, 7));
    assert_ok(dem_lattice_assemble(&s->lattice, &solid));
    s->model = support_model(&s->lattice, NULL, 0);
    assert_ok(element_state_create(&s->state, &s->model->lattice, &s->model->springs));
    s->x = malloc(2 * (size_t)s->lattice.n_nodes * sizeof *s->x);
    assert_non_null(s->x);
}

static void close_subject(subject *s)
{
    free(s->x);
    element_state_destroy(&s->state);
    dem_model_destroy(s->model);
    dem_lattice_free(&s->lattice);
}

/* A uniform gradient of displacements times a factor, and a turn by 0.3. */
static void deform(const subject *s, const double gradient[4], double factor)
{
    const double c = cos(0.3), d = sin(0.3);
    for (dem_index i = 0; i < s->lattice.n_nodes; i++) {
        const double *at = &s->lattice.x[2 * i];
        const double x = at[0] + factor * (gradient[0] * at[0] + gradient[1] * at[1]);
        const double y = at[1] + factor * (gradient[2] * at[0] + gradient[3] * at[1]);
        s->x[2 * i] = c * x - d * y;
        s->x[2 * i + 1] = d * x + c * y;
    }
}

/* Of the springs of a triangle the largest share of a bound: 1 where one is at it. */
static double largest_share(const subject *s, dem_index triangle, stress_bound bound)
{
    double most = 0.0;
    for (dem_index p = s->state.row[triangle]; p < s->state.row[triangle + 1]; p++) {
        const double strain = springs_strain_of(&s->model->lattice, s->state.spring[p], s->x);
        most = fmax(most, strain > 0.0 ? strain / bound.stretch : -strain / bound.squeeze);
    }
    return most;
}

/* The largest principal stress, of `pressure` in size, where the first spring is at the bound for a stress, over
 * that. */
static double reached(const subject *s, dem_index triangle, const double gradient[4], double stress, bool pressure)
{
    const stress_bound bound = stress_bound_of(&s->model->lattice, &s->state, triangle, stress, pressure);
    double factor = bound.stretch, own[3];
    for (int k = 0; k < 30; k++) {
        deform(s, gradient, factor);
        factor /= largest_share(s, triangle, bound);
    }
    triangle_stress(s->model, &s->state, triangle, s->x, own);
    const double mean = 0.5 * (own[0] + own[1]), half = 0.5 * (own[0] - own[1]);
    return ((pressure ? fabs(mean) : mean) + sqrt(half * half + own[2] * own[2])) / stress;
}

/* Gradients of all kinds, at stresses of 1e-5 to 0.2 of the modulus; the last digits of sums may differ. */
static double largest_reached(const subject *s, double stress, bool pressure)
{
    double most = 0.0;
    unsigned seed = 12345u;
    for (int trial = 0; trial < 200; trial++) {
        double gradient[4];
        for (int k = 0; k < 4; k++) {
            seed = seed * 1664525u + 1013904223u;
            gradient[k] = (double)(seed >> 8) / 16777216.0 - 0.5;
        }
        most = fmax(most, reached(s, trial % s->lattice.n_triangles, gradient, stress, pressure));
    }
    return most;
}

TEST(no_principal_stress_is_larger_than_asked_for)
{
    const double ratios[4] = {-0.3, 0.0, 1.0 / 3.0, 0.45}, jitters[2] = {0.0, 0.25};
    for (int k = 0; k < 32; k++) {
        CLEANUP(close_subject) subject s;
        open_subject(&s, ratios[k % 4], k / 8 % 2 ? DEM_SPRINGS_COUPLED : DEM_SPRINGS_INDEPENDENT, jitters[k / 4 % 2]);
        for (double stress = 1e-5 * modulus; stress < 0.3 * modulus; stress *= 7.0)
            assert_true(largest_reached(&s, stress, k >= 16) < 1.0 + 1e-9);
    }
}

/* Of equilateral triangles at nu = 1/3, which have springs alone, it is exact for small strains that are equal in all
 * directions, which random ones come near to; else the size of each spring's part counts, whatever its sign. */
TEST(it_is_not_much_larger_for_small_strains)
{
    const double equal[4] = {1.0, 0.0, 0.0, 1.0}, small = 1e-5 * modulus;
    for (int k = 0; k < 6; k++) {
        CLEANUP(close_subject) subject s;
        open_subject(&s, k / 2 == 0 ? 1.0 / 3.0 : 0.1, DEM_SPRINGS_COUPLED, k / 2 == 2 ? 0.25 : 0.0);
        if (k / 2 == 0) assert_close(reached(&s, 3, equal, small, k % 2 != 0), 1.0, 2e-3);
        assert_true(largest_reached(&s, small, k % 2 != 0) > 0.5);
    }
}

/* Springs alone bring no tension under pressure. */
TEST(pressure_along_springs_may_be_larger_where_it_breaks_nothing)
{
    CLEANUP(close_subject) subject s;
    open_subject(&s, 1.0 / 3.0, DEM_SPRINGS_COUPLED, 0.0);
    const stress_bound tension = stress_bound_of(&s.model->lattice, &s.state, 3, 1e-5 * modulus, false);
    const stress_bound both = stress_bound_of(&s.model->lattice, &s.state, 3, 1e-5 * modulus, true);
    assert_close(tension.squeeze, 4.0 * tension.stretch, 1e-12 * tension.squeeze);
    assert_close(tension.stretch, both.stretch, 2e-3 * both.stretch);
    assert_close(both.squeeze, both.stretch, 0.0);
}

/* Uniform tension along a row of equilateral triangles strains its springs alone at nu = 1/3, of which the stress is
 * E times the strain; equal strains of all springs have 3/2 of it. */
TEST(tension_along_a_row_reaches_two_thirds)
{
    const double along[4] = {1.0, 0.0, 0.0, -1.0 / 3.0};
    CLEANUP(close_subject) subject s;
    open_subject(&s, 1.0 / 3.0, DEM_SPRINGS_COUPLED, 0.0);
    assert_close(reached(&s, 3, along, 1e-5 * modulus, false), 2.0 / 3.0, 1e-3);
}
