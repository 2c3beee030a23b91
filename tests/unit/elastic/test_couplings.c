/* SPDX-License-Identifier: BSD-3-Clause */
/* couplings.c, couplings.h: rows, forces, energies and tangent of the couplings of a square of four triangles
 * whose centre is off the middle. Oracles are differences of the energy, and sums written out. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

#include "elastic/couplings.h"
#include "harness/cleanup_gsl.h"
#include "harness/message.h"
#include "unit/elastic/energy.h"

enum { n_nodes = 5, n_triangles = 4, n_springs = 8 };

static const double corners[2 * n_nodes] = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.4, 0.55};
static const double masses[n_nodes] = {1.0, 1.0, 1.0, 1.0, 1.0};
static const dem_index ends[2 * n_springs] = {0, 1, 2, 1, 2, 3, 3, 0, 4, 0, 1, 4, 2, 4, 4, 3};
static const dem_index fan[3 * n_triangles] = {0, 1, 4, 4, 1, 2, 3, 4, 2, 0, 4, 3};
static const double strengths[3 * n_triangles] = {2.0, -3.0, 5.0, 1.0, 4.0, -2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 7.0};

/* The third triangle has no coupling. */
typedef struct square {
    dem_lattice lattice;
    springs springs;
    couplings couplings;
} square;

static void free_square(square *s)
{
    dem_lattice_free(&s->lattice);
    springs_free(&s->springs);
    couplings_free(&s->couplings);
}

static square make_square(void)
{
    square s = {.lattice = support_lattice(n_nodes, corners, masses, n_springs, ends, 1.0, 10.0, NULL)};
    s.lattice.n_triangles = n_triangles;
    s.lattice.triangles = malloc(sizeof fan);
    s.lattice.coupling = malloc(sizeof strengths);
    assert_true(s.lattice.triangles != NULL && s.lattice.coupling != NULL);
    memcpy(s.lattice.triangles, fan, sizeof fan);
    memcpy(s.lattice.coupling, strengths, sizeof strengths);
    for (int k = 0; k < n_springs; k++)
        s.lattice.rest_length[k] =
            vec2_norm(vec2_sub(vec2_at(corners, ends[2 * k]), vec2_at(corners, ends[2 * k + 1])));
    assert_ok(springs_compile(&s.springs, &s.lattice));
    assert_ok(couplings_compile(&s.couplings, &s.lattice, &s.springs));
    return s;
}

static void stir(double *x, gsl_rng *r)
{
    for (int k = 0; k < 2 * n_nodes; k++) x[k] = corners[k] + 0.2 * (2.0 * gsl_rng_uniform(r) - 1.0);
}

static double length_of(const double *x, dem_index i, dem_index j)
{
    return vec2_norm(vec2_sub(vec2_at(x, i), vec2_at(x, j)));
}

TEST(rows_hold_the_coupled_triangles_of_each_node_in_order)
{
    static const int32_t row[n_nodes + 1] = {0, 2, 4, 5, 6, 9}, slot[9] = {0, 6, 1, 4, 5, 8, 2, 3, 7};
    static const dem_index spring[9] = {0, 5, 4, 5, 1, 6, 4, 7, 3};
    CLEANUP(free_square) square s = make_square();
    assert_int_equal(s.couplings.n, 3);
    assert_memory_equal(s.couplings.row, row, sizeof row);
    assert_memory_equal(s.couplings.slot, slot, sizeof slot);
    assert_int_equal(s.couplings.list[2].triangle, 3);
    for (int k = 0; k < 9; k++) {
        assert_int_equal(s.couplings.list[k / 3].spring[k % 3], spring[k]);
        assert_close(s.couplings.list[k / 3].rest_length[k % 3], s.lattice.rest_length[spring[k]], 0.0);
    }
}

TEST(without_couplings_every_row_is_empty)
{
    CLEANUP(free_square) square s = make_square();
    for (int some = 0; some < 2; some++) {
        couplings_free(&s.couplings);
        memset(s.lattice.coupling, 0, sizeof strengths);
        if (some == 1) {
            free(s.lattice.coupling);
            s.lattice.coupling = NULL;
        }
        assert_ok(couplings_compile(&s.couplings, &s.lattice, &s.springs));
        for (int i = 0; i <= n_nodes; i++) assert_int_equal(s.couplings.row[i], 0);
        assert_close(energy_couplings(&s.couplings, TRIANGLES_WHOLE, corners), 0.0, 0.0);
    }
}

TEST(an_edge_without_a_spring_is_refused)
{
    CLEANUP(free_square) square s = make_square();
    springs_free(&s.springs);
    couplings_free(&s.couplings);
    s.lattice.n_springs--; /* the last one joins nodes 4 and 3 */
    assert_ok(springs_compile(&s.springs, &s.lattice));
    assert_int_equal(couplings_compile(&s.couplings, &s.lattice, &s.springs), DEM_ERROR_MODEL);
    assert_message_parts("triangle 3 * coupling * nodes 4 and 3 no spring");
}

/* Exactly: every length is its rest length, from whichever corner it is computed. */
TEST(a_lattice_at_rest_feels_nothing)
{
    CLEANUP(free_square) square s = make_square();
    for (dem_index i = 0; i < n_nodes; i++) {
        const vec2 force = couplings_add_force(&s.couplings, TRIANGLES_WHOLE, i, corners, (vec2){3.0, 4.0});
        assert_true(force.x == 3.0 && force.y == 4.0);
    }
}

/* The energy written out, of the first two and the last triangle; terms of some 0.1 J. */
TEST(the_energy_is_that_of_pairs_of_stretches)
{
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_square) square s = make_square();
    double x[2 * n_nodes], expected = 0.0, at_four = 0.0;
    stir(x, r);
    for (int k = 0; k < 3 * n_triangles; k++) {
        const dem_index *c = fan + 3 * (k / 3), here = c[k % 3], next = c[(k + 1) % 3], last = c[(k + 2) % 3];
        const double ahead = length_of(x, here, next) - length_of(corners, here, next);
        const double behind = length_of(x, here, last) - length_of(corners, here, last);
        expected += strengths[k] * ahead * behind;
    }
    for (dem_index i = 0; i < n_nodes; i++) at_four += couplings_node_energy(&s.couplings, TRIANGLES_WHOLE, i, x);
    assert_close(energy_couplings(&s.couplings, TRIANGLES_WHOLE, x), expected, 1e-15);
    assert_close(at_four, 3.0 * expected, 1e-14); /* every triangle counts at each of its corners */
}

/* Central differences over 1e-6 m: truncation 1e-12 times third derivatives of some 1e3 N/m^2, rounding 1e-16 J/1e-6 m.
 * The tensions are the derivatives by the rest lengths, with the opposite sign. */
TEST(forces_and_tensions_are_derivatives_of_the_energy)
{
    const double step = 1e-6;
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_square) square s = make_square();
    double x[2 * n_nodes], tension[n_springs];
    for (int trial = 0; trial < 50; trial++) {
        stir(x, r);
        for (int k = 0; k < 2 * n_nodes; k++) {
            const vec2 force = couplings_add_force(&s.couplings, TRIANGLES_WHOLE, k / 2, x, (vec2){0.0, 0.0});
            const double here = x[k];
            x[k] = here + step;
            const double above = energy_couplings(&s.couplings, TRIANGLES_WHOLE, x);
            x[k] = here - step;
            const double below = energy_couplings(&s.couplings, TRIANGLES_WHOLE, x);
            x[k] = here;
            assert_close(k % 2 == 0 ? force.x : force.y, (below - above) / (2.0 * step), 1e-8);
        }
        memset(tension, 0, sizeof tension);
        couplings_add_tensions(&s.couplings, TRIANGLES_WHOLE, x, tension);
        for (int k = 0; k < n_springs; k++) {
            double energy[2];
            for (int side = 0; side < 2; side++) {
                for (int q = 0; q < 9; q++)
                    if (s.couplings.list[q / 3].spring[q % 3] == k)
                        s.couplings.list[q / 3].rest_length[q % 3] =
                            s.lattice.rest_length[k] + (side == 0 ? -step : step);
                energy[side] = energy_couplings(&s.couplings, TRIANGLES_WHOLE, x);
            }
            for (int q = 0; q < 9; q++)
                if (s.couplings.list[q / 3].spring[q % 3] == k)
                    s.couplings.list[q / 3].rest_length[q % 3] = s.lattice.rest_length[k];
            assert_close(tension[k], (energy[0] - energy[1]) / (2.0 * step), 1e-8);
        }
    }
}

/* Forces along edges: no resultant, no moment. Rounding of some 20 terms of 1 N. */
TEST(forces_have_neither_resultant_nor_moment)
{
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_square) square s = make_square();
    for (int trial = 0; trial < 50; trial++) {
        double x[2 * n_nodes], moment = 0.0;
        vec2 sum = {0.0, 0.0};
        stir(x, r);
        for (dem_index i = 0; i < n_nodes; i++) {
            const vec2 force = couplings_add_force(&s.couplings, TRIANGLES_WHOLE, i, x, (vec2){0.0, 0.0});
            sum = vec2_add(sum, force);
            moment += vec2_cross(vec2_at(x, i), force);
        }
        assert_close(sum.x, 0.0, 1e-14);
        assert_close(sum.y, 0.0, 1e-14);
        assert_close(moment, 0.0, 1e-14);
    }
}

/* Central differences of the forces over 1e-6 m: as above, of fourth derivatives. */
TEST(the_tangent_is_the_derivative_of_the_force)
{
    const double step = 1e-6;
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_square) square s = make_square();
    for (int trial = 0; trial < 50; trial++) {
        double x[2 * n_nodes], u[2 * n_nodes], above[2 * n_nodes], below[2 * n_nodes];
        stir(x, r);
        for (int k = 0; k < 2 * n_nodes; k++) {
            u[k] = 2.0 * gsl_rng_uniform(r) - 1.0;
            above[k] = x[k] + step * u[k];
            below[k] = x[k] - step * u[k];
        }
        for (dem_index i = 0; i < n_nodes; i++) {
            const vec2 a = couplings_add_force(&s.couplings, TRIANGLES_WHOLE, i, above, (vec2){0.0, 0.0});
            const vec2 b = couplings_add_force(&s.couplings, TRIANGLES_WHOLE, i, below, (vec2){0.0, 0.0});
            const vec2 expected = vec2_scale(0.5 / step, vec2_sub(b, a));
            const vec2 found = couplings_tangent(&s.couplings, i, x, u);
            assert_close(found.x, expected.x, 1e-7);
            assert_close(found.y, expected.y, 1e-7);
        }
    }
}

/* Of the first triangle, at each of its corners. */
TEST(a_broken_triangle_has_no_couplings)
{
    const unsigned char flags[n_triangles] = {1, 1, 0, 0};
    const triangles_integrity broken = {flags, NULL, NULL};
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_square) square s = make_square();
    double x[2 * n_nodes], tension[n_springs] = {0.0};
    stir(x, r);
    const vec2 force = couplings_add_force(&s.couplings, broken, 1, x, (vec2){0.0, 0.0});
    couplings_add_tensions(&s.couplings, broken, x, tension);
    assert_true(force.x == 0.0 && force.y == 0.0);
    assert_close(couplings_node_energy(&s.couplings, broken, 1, x), 0.0, 0.0);
    assert_close(energy_couplings(&s.couplings, broken, x), couplings_node_energy(&s.couplings, broken, 3, x), 0.0);
    for (int k = 0; k < n_springs; k++) assert_int_equal(tension[k] != 0.0, k == 3 || k == 4 || k == 7);
}
