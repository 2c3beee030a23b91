/* SPDX-License-Identifier: BSD-3-Clause */
/* triangles.c, triangles.h: the law of the folding guard; forces and energies of guard and area term. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_rng.h>

#include "elastic/triangles.h"
#include "harness/cleanup_gsl.h"
#include "unit/elastic/energy.h"

static const double onset = 0.4, taylor_below = 0.005;

static double energy_at(double ratio)
{
    return triangles_guard_law(ratio).energy;
}

static double slope_at(double ratio)
{
    return triangles_guard_law(ratio).slope;
}

/* ---- the law ---- */

TEST(the_guard_is_exactly_zero_from_its_onset_on)
{
    const double ratios[5] = {0.4, 0.5, 1.0, 3.0, 1e300};
    for (int k = 0; k < 5; k++) {
        assert_close(energy_at(ratios[k]), 0.0, 0.0);
        assert_close(slope_at(ratios[k]), 0.0, 0.0);
    }
    assert_true(energy_at(0.399) > 0.0);
    assert_true(slope_at(0.399) < 0.0);
}

/* Near the onset w = (d/0.4)^3 (1 + 3/2 d/0.4 + ...) at the distance d below it: value, slope and curvature vanish.
 * The next term of the series is what the tolerance leaves out. */
TEST(the_guard_sets_in_with_the_third_power_of_the_distance)
{
    for (double d = 1e-3; d > 1e-7; d *= 0.1) {
        const double s = (onset - (onset - d)) / onset; /* d as rounded in 0.4 - d */
        assert_close(energy_at(onset - d) / (s * s * s), 1.0, 2.0 * s);
        assert_close(slope_at(onset - d) / (-3.0 * s * s / onset), 1.0, 3.0 * s);
    }
}

/* The cube root brings the law back to its logarithm, and a third of the two roundings of the cube. */
TEST(its_logarithm_agrees_with_libm)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < 20000; k++) {
        const double ratio = taylor_below + (onset - taylor_below) * gsl_rng_uniform_pos(rng);
        if (ratio >= onset) continue;
        const long double expected = -logl((long double)(ratio / onset)), actual = cbrtl((long double)energy_at(ratio));
        assert_close((double)(actual / expected), 1.0, 1e-15);
    }
}

/* Central differences over d = 1e-7: d^2 w'''/6 with |w'''| < 2e9 at 0.005, and rounding of 1e-15 w/d. */
TEST(its_slope_is_the_derivative_of_its_energy)
{
    const double d = 1e-7;
    for (double ratio = -1.0; ratio < 0.5; ratio += 0.00701)
        assert_close((energy_at(ratio + d) - energy_at(ratio - d)) / (2.0 * d), slope_at(ratio),
                     4e-6 + 1e-15 * energy_at(ratio) / d);
}

/* Central differences of the slope over d = 1e-7: d^2 w''''/6 with |w''''| < 1.1e12 at 0.005, and rounding of
 * 1e-15 w'/d; not across 0.005, where the third derivative jumps. */
TEST(its_curvature_is_the_derivative_of_its_slope)
{
    const double d = 1e-7;
    for (double ratio = -1.0; ratio < 0.5; ratio += 0.00701) {
        if (fabs(ratio - taylor_below) < 2.0 * d || fabs(ratio - onset) < 2.0 * d) continue;
        assert_close((slope_at(ratio + d) - slope_at(ratio - d)) / (2.0 * d), triangles_guard_law(ratio).curvature,
                     2e-3 + 1e-15 * fabs(slope_at(ratio)) / d);
    }
}

/* Where the polynomial takes over: values, slopes and difference quotients of slopes from the two sides. The
 * curvature is (6 L + 3 L^2)/J^2, L = ln 80; over d = 1e-8 its mean differs from it by w''' d/2 = 8. */
TEST(the_polynomial_takes_over_twice_continuously_differentiable)
{
    const double J = taylor_below, d = 1e-8, L = log(80.0), curvature = (6.0 * L + 3.0 * L * L) / (J * J);
    assert_close(energy_at(J), L * L * L, 1e-13);
    assert_close(slope_at(J), -3.0 * L * L / J, 1e-11);
    assert_close(energy_at(J + d) - energy_at(J - d), 2.0 * d * slope_at(J), 1e-13);
    assert_close((slope_at(J + d) - slope_at(J)) / d, curvature, 10.0);
    assert_close((slope_at(J) - slope_at(J - d)) / d, curvature, 2e-3); /* linear: rounding of slopes and J - d */
}

/* w and w' of the polynomial are written out with L = ln 80. Rounding only. */
TEST(it_is_a_finite_rising_parabola_down_to_inverted_triangles)
{
    const double J = taylor_below, L = log(80.0), w = L * L * L;
    const double w1 = -3.0 * L * L / J, w2 = (6.0 * L + 3.0 * L * L) / (J * J);
    const double ratios[5] = {0.0049, 0.0, -0.01, -1.0, -50.0};
    double above = energy_at(J);
    for (int k = 0; k < 5; k++) {
        const double b = ratios[k] - J, expected = w + w1 * b + 0.5 * w2 * b * b;
        assert_close(energy_at(ratios[k]), expected, 1e-14 * expected);
        assert_close(slope_at(ratios[k]), w1 + w2 * b, 1e-14 * fabs(w1 + w2 * b));
        assert_true(energy_at(ratios[k]) > above);
        above = energy_at(ratios[k]);
    }
}

/* ---- forces ---- */

enum { n_nodes = 5, n_triangles = 4 };

/* A square of 1 m with its centre: four triangles of 0.25 m^2. */
static const double corners[2 * n_nodes] = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.5, 0.5};
static const dem_index fan[3 * n_triangles] = {0, 1, 4, 4, 1, 2, 3, 4, 2, 0, 4, 3};

static triangles compile_fan(const double *guard, const double *area_stiffness)
{
    triangles t;
    const dem_lattice lattice = {.n_nodes = n_nodes,
                                 .n_triangles = n_triangles,
                                 .x = (double *)corners,
                                 .triangles = (dem_index *)fan,
                                 .guard = (double *)guard,
                                 .area_stiffness = (double *)area_stiffness};
    assert_ok(triangles_compile(&t, &lattice));
    return t;
}

static const double strengths[n_triangles] = {2.0, 3.0, 5.0, 7.0}, kappas[n_triangles] = {300.0, -50.0, 0.0, 70.0};

static double energy_of(const triangles *t, const double *x)
{
    double area, guard;
    energy_triangles(t, x, &area, &guard);
    return area + guard;
}

TEST(rows_hold_the_guarded_triangles_of_each_node_in_order)
{
    const double some[n_triangles] = {2.0, 0.0, 5.0, 7.0};
    static const int32_t row[n_nodes + 1] = {0, 2, 3, 4, 6, 9};
    static const int32_t next[9] = {1, 4, 4, 3, 4, 0, 0, 2, 3}, last[9] = {4, 3, 0, 4, 2, 4, 1, 3, 0};
    static const double strength[9] = {2.0, 7.0, 2.0, 5.0, 5.0, 7.0, 2.0, 5.0, 7.0};
    triangles t = compile_fan(some, NULL);
    assert_memory_equal(t.row, row, sizeof row);
    assert_memory_equal(t.next, next, sizeof next);
    assert_memory_equal(t.last, last, sizeof last);
    for (int p = 0; p < 9; p++) assert_close(triangles_guard(&t, p), strength[p], 0.0);
    for (dem_index i = 0; i < n_nodes; i++)
        for (dem_index p = row[i]; p < row[i + 1]; p++) assert_close(triangles_rest_area(&t, i, p), 0.25, 0.0);
    triangles_free(&t);
    assert_null(t.row);
}

TEST(rows_hold_triangles_with_area_stiffness_or_guard)
{
    const double some[n_triangles] = {0.0, 0.0, 0.0, 7.0}, stiff[n_triangles] = {0.0, -3.0, 0.0, 0.0};
    static const int32_t row[n_nodes + 1] = {0, 1, 2, 3, 4, 6}, next[6] = {4, 2, 4, 0, 1, 3};
    static const double guard[6] = {7.0, 0.0, 0.0, 7.0, 0.0, 7.0}, kappa[6] = {0.0, -3.0, -3.0, 0.0, -3.0, 0.0};
    CLEANUP(triangles_free) triangles t = compile_fan(some, stiff);
    assert_memory_equal(t.row, row, sizeof row);
    assert_memory_equal(t.next, next, sizeof next);
    for (int p = 0; p < 6; p++) {
        assert_close(triangles_guard(&t, p), guard[p], 0.0);
        assert_close(t.area_stiffness_of[t.triangle[p]], kappa[p], 0.0);
    }
}

TEST(without_guards_every_row_is_empty)
{
    const double none[n_triangles] = {0.0, 0.0, 0.0, 0.0};
    const double *const cases[2] = {NULL, none};
    for (int k = 0; k < 2; k++) {
        CLEANUP(triangles_free) triangles t = compile_fan(cases[k], cases[k]);
        for (int i = 0; i <= n_nodes; i++) assert_int_equal(t.row[i], 0);
        assert_close(energy_of(&t, corners), 0.0, 0.0);
    }
}

/* Exactly: the area over the rest area is 1 from every corner. */
TEST(a_lattice_at_rest_feels_nothing)
{
    CLEANUP(triangles_free) triangles t = compile_fan(strengths, kappas);
    for (dem_index i = 0; i < n_nodes; i++) {
        const vec2 force = triangles_force(&t, TRIANGLES_WHOLE, i, corners);
        assert_true(force.x == 0.0 && force.y == 0.0);
    }
    assert_close(energy_of(&t, corners), 0.0, 0.0);
}

/* The centre at (0.5, y) leaves the lower triangle the share 2 y of its area, the upper one 2 - 2 y, the others theirs:
 * W = A0 kappa/2 (J - 1)^2 each, dA/dy = 1/2 and -1/2. Rounding only. */
TEST(the_area_term_is_linear_in_the_area)
{
    const double stiff[n_triangles] = {300.0, 0.0, -50.0, 0.0};
    double x[2 * n_nodes];
    CLEANUP(triangles_free) triangles t = compile_fan(NULL, stiff);
    memcpy(x, corners, sizeof x);
    for (double y = -1.0; y < 2.0; y += 0.3) {
        const double J = 2.0 * y, other = 2.0 - 2.0 * y;
        x[9] = y;
        const vec2 force = triangles_force(&t, TRIANGLES_WHOLE, 4, x);
        double area, guard;
        energy_triangles(&t, x, &area, &guard);
        assert_close(force.x, 0.0, 1e-13);
        assert_close(force.y, -0.5 * 300.0 * (J - 1.0) + 0.5 * -50.0 * (other - 1.0), 1e-12);
        assert_close(area, 0.125 * (300.0 * (J - 1.0) * (J - 1.0) - 50.0 * (other - 1.0) * (other - 1.0)), 1e-12);
        assert_close(guard, 0.0, 0.0);
    }
}

/* kappa/A0 g g^T, |g| half the opposite side: the centre has g = (0, 1/2) of the lower triangle, (0, -1/2) of the upper
 * one and (-1/2, 0), (1/2, 0) of those at the sides; a negative kappa does not count. */
TEST(the_block_of_a_node_has_the_triangles_that_stiffen_it)
{
    CLEANUP(triangles_free) triangles t = compile_fan(NULL, kappas);
    const sym2 block = triangles_block(&t, 4, corners);
    assert_close(block.xx, 70.0 / 0.25 * 0.25, 1e-13);
    assert_close(block.xy, 0.0, 0.0);
    assert_close(block.yy, 300.0 / 0.25 * 0.25, 1e-13);
    triangles_free(&t);
    t = compile_fan(strengths, NULL);
    assert_close(triangles_block(&t, 4, corners).yy, 0.0, 0.0);
}

/* The centre at (0.5, y) leaves the lower triangle the share 2 y of its area: W = A0 g w(2 y), force -g w'(2 y)
 * dA/dy with dA/dy = 1/2, as the others are above the onset. Rounding only. */
TEST(a_squeezed_triangle_pushes_its_corner_back)
{
    const double ratios[3] = {0.1, 0.02, -0.3};
    double x[2 * n_nodes];
    CLEANUP(triangles_free) triangles t = compile_fan(strengths, NULL);
    memcpy(x, corners, sizeof x);
    for (int k = 0; k < 3; k++) {
        x[9] = 0.5 * ratios[k];
        const vec2 force = triangles_force(&t, TRIANGLES_WHOLE, 4, x),
                   left = triangles_force(&t, TRIANGLES_WHOLE, 0, x);
        const double expected = -2.0 * slope_at(ratios[k]) * 0.5;
        assert_true(expected > 0.0);
        assert_close(force.x, 0.0, 0.0);
        assert_close(force.y, expected, 1e-13 * expected);
        assert_close(left.y, -0.5 * expected, 1e-13 * expected);
        assert_close(energy_of(&t, x), 0.25 * 2.0 * energy_at(ratios[k]), 1e-13 * expected);
        assert_close(triangles_node_energy(&t, TRIANGLES_WHOLE, 4, x), energy_of(&t, x), 0.0);
        assert_close(triangles_node_energy(&t, TRIANGLES_WHOLE, 2, x), 0.0, 0.0);
    }
}

/* Squeezed to a fifth and stirred: areas from below the onset to inverted. */
static void squeeze(double *x, gsl_rng *rng)
{
    for (int k = 0; k < 2 * n_nodes; k++)
        x[k] = (k % 2 == 0 ? 1.0 : 0.2) * corners[k] + 0.1 * (2.0 * gsl_rng_uniform(rng) - 1.0);
}

/* Central differences over 1e-7 m: truncation 1e-14 g w''' A0 (dJ/dx)^3 = 1e-6 N at worst, rounding 1e-15 * 1e3
 * J/1e-7 m. */
TEST(forces_are_minus_the_gradient_of_the_energy)
{
    const double step = 1e-7;
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double x[2 * n_nodes];
    CLEANUP(triangles_free) triangles t = compile_fan(strengths, kappas);
    for (int trial = 0; trial < 50; trial++) {
        squeeze(x, rng);
        for (dem_index k = 0; k < 2 * n_nodes; k++) {
            const vec2 force = triangles_force(&t, TRIANGLES_WHOLE, k / 2, x);
            const double here = x[k], scale = 1.0 + fabs(energy_of(&t, x));
            x[k] = here + step;
            const double above = energy_of(&t, x), node_above = triangles_node_energy(&t, TRIANGLES_WHOLE, k / 2, x);
            x[k] = here - step;
            const double below = energy_of(&t, x), node_below = triangles_node_energy(&t, TRIANGLES_WHOLE, k / 2, x);
            x[k] = here;
            assert_close(k % 2 == 0 ? force.x : force.y, (below - above) / (2.0 * step), 1e-7 * scale);
            assert_close((node_above - node_below) / (2.0 * step), (above - below) / (2.0 * step), 1e-7 * scale);
        }
    }
}

/* Second differences of the guard's energy along any direction u never exceed the sum of bound_i u_i^2, and come
 * within a factor of 3 of it along the force; it is 0 where no triangle is squeezed. */
TEST(the_bound_of_the_guard_is_above_its_second_variation)
{
    const double step = 1e-4;
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double x[2 * n_nodes], closest = 0.0;
    CLEANUP(triangles_free) triangles t = compile_fan(strengths, NULL);
    for (dem_index i = 0; i < n_nodes; i++)
        assert_close(triangles_guard_bound(&t, TRIANGLES_WHOLE, i, corners), 0.0, 0.0);
    for (int trial = 0; trial < 2000; trial++) {
        double u[2 * n_nodes], moved[2 * n_nodes], allowed = 0.0, scale = 0.0;
        squeeze(x, rng);
        for (int k = 0; k < 2 * n_nodes; k++) {
            const vec2 force = triangles_force(&t, TRIANGLES_WHOLE, k / 2, x);
            u[k] = trial % 2 == 1 ? gsl_rng_uniform(rng) - 0.5 : (k % 2 == 0 ? force.x : force.y);
            allowed += triangles_guard_bound(&t, TRIANGLES_WHOLE, k / 2, x) * u[k] * u[k];
            scale = fmax(scale, fabs(u[k]));
        }
        if (!(scale > 0.0)) continue;
        double sum = -2.0 * energy_of(&t, x);
        for (int side = -1; side <= 1; side += 2) {
            for (int k = 0; k < 2 * n_nodes; k++) moved[k] = x[k] + side * step / scale * u[k];
            sum += energy_of(&t, moved);
        }
        const double share = sum / (step * step) * scale * scale / allowed;
        assert_true(share < 1.0 + 1e-3); /* what higher orders and rounding add over the step */
        closest = fmax(closest, share);
    }
    assert_true(closest > 1.0 / 3.0);
}

/* Central differences of the forces along a random motion, over 1e-6 m: truncation 1e-12 g w'''' A0 (dJ/dx)^4 = 1e-4
 * N/m at worst where nothing crosses the ends of the polynomial, rounding 1e-15 * 1e5 N/1e-6 m. */
TEST(the_tangent_is_the_derivative_of_the_force)
{
    const double step = 1e-6;
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double x[2 * n_nodes], u[2 * n_nodes], above[2 * n_nodes], below[2 * n_nodes];
    CLEANUP(triangles_free) triangles t = compile_fan(strengths, kappas);
    for (int trial = 0; trial < 50; trial++) {
        squeeze(x, rng);
        for (int k = 0; k < 2 * n_nodes; k++) {
            u[k] = 2.0 * gsl_rng_uniform(rng) - 1.0;
            above[k] = x[k] + step * u[k];
            below[k] = x[k] - step * u[k];
        }
        for (dem_index i = 0; i < n_nodes; i++) {
            const vec2 change = vec2_sub(triangles_force(&t, TRIANGLES_WHOLE, i, below),
                                         triangles_force(&t, TRIANGLES_WHOLE, i, above));
            const vec2 tangent = triangles_tangent(&t, i, x, u);
            const double scale = 1.0 + vec2_norm(tangent);
            assert_close(tangent.x, change.x / (2.0 * step), 1e-6 * scale);
            assert_close(tangent.y, change.y / (2.0 * step), 1e-6 * scale);
        }
    }
}

/* Rounding of sums of 12 terms, against the largest force. */
TEST(triangles_exert_no_force_and_no_torque_on_the_whole)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double x[2 * n_nodes];
    CLEANUP(triangles_free) triangles t = compile_fan(strengths, kappas);
    for (int trial = 0; trial < 50; trial++) {
        double torque = 0.0, largest = 0.0, energy = 0.0;
        vec2 total = {0.0, 0.0};
        squeeze(x, rng);
        for (dem_index i = 0; i < n_nodes; i++) {
            const vec2 force = triangles_force(&t, TRIANGLES_WHOLE, i, x);
            total = vec2_add(total, force);
            torque += vec2_cross(vec2_at(x, i), force);
            largest = fmax(largest, vec2_norm(force));
            energy += triangles_node_energy(&t, TRIANGLES_WHOLE, i, x) / 3.0; /* every triangle is at three nodes */
        }
        assert_true(largest > 0.0);
        assert_close(vec2_norm(total), 0.0, 1e-13 * largest);
        assert_close(torque, 0.0, 1e-13 * largest);
        assert_close(energy, energy_of(&t, x), 1e-13 * largest);
    }
}

TEST(area_is_positive_counter_clockwise)
{
    const vec2 a = {1.0, 1.0}, b = {4.0, 1.0}, c = {2.0, 3.0};
    assert_close(vec2_triangle_area(a, b, c), 3.0, 0.0);
    assert_close(vec2_triangle_area(b, c, a), 3.0, 0.0);
    assert_close(vec2_triangle_area(a, c, b), -3.0, 0.0);
}
