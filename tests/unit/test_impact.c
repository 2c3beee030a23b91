/* SPDX-License-Identifier: BSD-3-Clause */
/* impact.c: reflection (8), restitution (9), Moreau's law in a corner, which surfaces hold. */
#include "../verification/support.h"

#include <stdbool.h>

#include <gsl/gsl_rng.h>

#include "impact.h"

static vec2 direction(double angle)
{
    return (vec2){cos(angle), sin(angle)};
}

static void check_vector(vec2 actual, double x, double y, double tolerance)
{
    assert_close(actual.x, x, tolerance);
    assert_close(actual.y, y, tolerance);
}

/* ---- one surface ---- */

static void an_elastic_impact_reflects_at_the_surface(void **state)
{
    const impact_surface level = {{0.0, 1.0}, 1.0}, tilted = {{sqrt(0.5), sqrt(0.5)}, 1.0};
    (void)state;
    check_vector(impact_rebound(&level, 1, (vec2){3.0, -4.0}), 3.0, 4.0, 0.0);     /* (8) */
    check_vector(impact_rebound(&tilted, 1, (vec2){-3.0, 0.5}), -0.5, 3.0, 1e-15); /* swaps and turns the components */
}

static void restitution_scales_the_normal_part_and_leaves_the_tangential_one(void **state)
{
    const impact_surface level = {{0.0, 1.0}, 0.25}, plastic = {{0.0, 1.0}, 0.0};
    (void)state;
    check_vector(impact_rebound(&level, 1, (vec2){3.0, -4.0}), 3.0, 1.0, 0.0); /* (9) */
    check_vector(impact_rebound(&plastic, 1, (vec2){3.0, -4.0}), 3.0, 0.0, 0.0);
}

static void what_does_not_approach_is_not_changed(void **state)
{
    const impact_surface level = {{0.0, 1.0}, 0.5};
    (void)state;
    check_vector(impact_rebound(&level, 1, (vec2){3.0, 4.0}), 3.0, 4.0, 0.0);
    check_vector(impact_rebound(&level, 1, (vec2){3.0, 0.0}), 3.0, 0.0, 0.0);
}

/* ---- two surfaces ---- */

static void a_corner_turns_back_only_what_approaches_each_wall(void **state)
{
    const impact_surface walls[2] = {{{0.0, 1.0}, 0.5}, {{-1.0, 0.0}, 0.25}};
    (void)state;
    check_vector(impact_rebound(walls, 2, (vec2){-1.0, -2.0}), -1.0, 1.0, 0.0); /* the floor alone */
    check_vector(impact_rebound(walls, 2, (vec2){2.0, 1.0}), -0.5, 1.0, 0.0);   /* the wall alone */
    check_vector(impact_rebound(walls, 2, (vec2){2.0, -4.0}), -0.5, 2.0, 0.0);  /* both */
    check_vector(impact_rebound(walls, 2, (vec2){-2.0, 4.0}), -2.0, 4.0, 0.0);  /* none */
}

/* Walls at 60 degrees to the vertical, a groove: straight in, both act and the velocity is -eta v. */
static void a_groove_sends_a_velocity_inside_its_cone_straight_back(void **state)
{
    const impact_surface walls[2] = {{{0.5 * sqrt(3.0), 0.5}, 0.5}, {{-0.5 * sqrt(3.0), 0.5}, 0.5}};
    (void)state;
    check_vector(impact_rebound(walls, 2, (vec2){0.3, -2.0}), -0.15, 1.0, 1e-15);
}

/* In a blunt corner a velocity outside the cone of the inward normals meets one wall, whatever the order of the two,
 * although it approaches both: the plastic impact leaves it gliding off the other. */
static void a_velocity_outside_the_cone_meets_one_wall_only(void **state)
{
    const vec2 n0 = direction(1.8), n1 = direction(1.2), v = direction(1.5 - 2.0);
    const impact_surface order[2] = {{n0, 0.0}, {n1, 0.0}}, reverse[2] = {{n1, 0.0}, {n0, 0.0}};
    (void)state;
    assert_true(vec2_dot(v, n0) < 0.0 && vec2_dot(v, n1) < 0.0);
    const vec2 first = impact_rebound(order, 2, v), second = impact_rebound(reverse, 2, v);
    const vec2 alone = impact_rebound(&order[0], 1, v);
    assert_true(vec2_dot(alone, n1) >= 0.0);
    check_vector(first, alone.x, alone.y, 0.0);
    check_vector(second, alone.x, alone.y, 0.0);
}

/* Rounding of velocities of order 1, over the sine of the corner in the parts along its normals, which is above 0.1. */
static const double swept_tolerance = 1e-13;

typedef struct sweep {
    gsl_rng *rng;
    impact_surface s[2];
    vec2 v;
} sweep;

static void sweep_next(sweep *w)
{
    do {
        for (int k = 0; k < 2; k++)
            w->s[k] = (impact_surface){direction(2.0 * M_PI * gsl_rng_uniform(w->rng)), gsl_rng_uniform(w->rng)};
    } while (fabs(vec2_cross(w->s[0].normal, w->s[1].normal)) < 0.1);
    w->v = vec2_scale(2.0 * gsl_rng_uniform(w->rng), direction(2.0 * M_PI * gsl_rng_uniform(w->rng)));
}

static void energy_never_grows(void **state)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    (void)state;
    for (int k = 0; k < 20000; k++) {
        sweep_next(&w);
        for (int n = 1; n <= 2; n++) {
            const vec2 after = impact_rebound(w.s, n, w.v);
            assert_true(vec2_dot(after, after) <= vec2_dot(w.v, w.v) + swept_tolerance);
        }
    }
    gsl_rng_free(w.rng);
}

/* A wedge of 0.4 rad with an elastic and a plastic wall: with its own restitution for each wall the energy would
 * grow sevenfold. */
static void an_acute_corner_takes_the_smaller_restitution(void **state)
{
    const impact_surface wedge[2] = {{{0.0, 1.0}, 1.0}, {{sin(0.4), -cos(0.4)}, 0.0}};
    (void)state;
    check_vector(impact_rebound(wedge, 2, (vec2){-1.0, -0.5}), 0.0, 0.0, 1e-15);
}

static void an_elastic_corner_keeps_the_energy(void **state)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    (void)state;
    for (int k = 0; k < 20000; k++) {
        sweep_next(&w);
        w.s[0].restitution = w.s[1].restitution = 1.0;
        const vec2 after = impact_rebound(w.s, 2, w.v);
        assert_close(vec2_dot(after, after), vec2_dot(w.v, w.v), swept_tolerance);
    }
    gsl_rng_free(w.rng);
}

/* After a plastic impact nothing approaches either wall, what was taken is a push out of them, and no more than
 * needed: where a wall pushes, the node glides along it. */
static void a_plastic_corner_leaves_what_does_not_approach(void **state)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    int n_both = 0;
    (void)state;
    for (int k = 0; k < 20000; k++) {
        double push[2];
        sweep_next(&w);
        w.s[0].restitution = w.s[1].restitution = 0.0;
        const vec2 after = impact_rebound(w.s, 2, w.v);
        vec2_parts(vec2_sub(after, w.v), w.s[0].normal, w.s[1].normal, push);
        for (int q = 0; q < 2; q++) {
            assert_true(vec2_dot(after, w.s[q].normal) >= -swept_tolerance);
            assert_true(push[q] >= -swept_tolerance);
            assert_close(push[q] * vec2_dot(after, w.s[q].normal), 0.0, swept_tolerance);
        }
        n_both += push[0] > swept_tolerance && push[1] > swept_tolerance;
    }
    assert_true(n_both > 1000);
    gsl_rng_free(w.rng);
}

static void momentum_along_the_surface_is_kept(void **state)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    (void)state;
    for (int k = 0; k < 5000; k++) {
        sweep_next(&w);
        const vec2 n = w.s[0].normal, after = impact_rebound(w.s, 1, w.v);
        const double before_n = vec2_dot(w.v, n), after_n = vec2_dot(after, n);
        assert_close(vec2_cross(n, after), vec2_cross(n, w.v), 1e-15);
        assert_close(after_n, before_n < 0.0 ? -w.s[0].restitution * before_n : before_n, 1e-15);
    }
    gsl_rng_free(w.rng);
}

/* ---- holding ---- */

static void a_surface_holds_what_presses_on_it(void **state)
{
    const impact_surface level = {{0.0, 1.0}, 0.5};
    double reaction[2] = {77.0, 77.0};
    (void)state;
    assert_int_equal(impact_holding(&level, 1, (vec2){3.0, -4.0}, reaction), 1);
    assert_close(reaction[0], 4.0, 0.0);
    assert_int_equal(impact_holding(&level, 1, (vec2){3.0, 4.0}, reaction), 0);
    assert_close(reaction[0], 0.0, 0.0);
    assert_int_equal(impact_holding(&level, 1, (vec2){3.0, 0.0}, reaction), 0);
}

static void the_walls_of_a_corner_hold_together_or_alone(void **state)
{
    const impact_surface walls[2] = {{{0.0, 1.0}, 0.5}, {{-1.0, 0.0}, 0.25}};
    double reaction[2];
    (void)state;
    assert_int_equal(impact_holding(walls, 2, (vec2){2.0, -4.0}, reaction), 3);
    assert_close(reaction[0], 4.0, 0.0);
    assert_close(reaction[1], 2.0, 0.0);
    assert_int_equal(impact_holding(walls, 2, (vec2){-2.0, -4.0}, reaction), 1);
    assert_int_equal(impact_holding(walls, 2, (vec2){2.0, 4.0}, reaction), 2);
    assert_close(reaction[0], 0.0, 0.0);
    assert_close(reaction[1], 2.0, 0.0);
    assert_int_equal(impact_holding(walls, 2, (vec2){-2.0, 4.0}, reaction), 0);
}

/* Complementarity: no reaction pulls, what is left does not press inwards, and a wall that reacts has nothing left
 * along its normal. Restitution has no say in it. */
static void reactions_and_what_is_left_are_complementary(void **state)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    int n_of[4] = {0};
    (void)state;
    for (int k = 0; k < 20000; k++) {
        double reaction[2];
        sweep_next(&w);
        const int holding = impact_holding(w.s, 2, w.v, reaction);
        const vec2 left = vec2_along(vec2_along(w.v, reaction[0], w.s[0].normal), reaction[1], w.s[1].normal);
        n_of[holding]++;
        for (int q = 0; q < 2; q++) {
            const double inwards = vec2_dot(left, w.s[q].normal);
            assert_true(reaction[q] >= 0.0);
            assert_int_equal(reaction[q] > 0.0, (holding >> q) & 1);
            assert_true(inwards >= -swept_tolerance);
            assert_close(reaction[q] * inwards, 0.0, swept_tolerance);
        }
    }
    for (int q = 0; q < 4; q++) assert_true(n_of[q] > 1000);
    gsl_rng_free(w.rng);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_elastic_impact_reflects_at_the_surface),
        cmocka_unit_test(restitution_scales_the_normal_part_and_leaves_the_tangential_one),
        cmocka_unit_test(what_does_not_approach_is_not_changed),
        cmocka_unit_test(a_corner_turns_back_only_what_approaches_each_wall),
        cmocka_unit_test(a_groove_sends_a_velocity_inside_its_cone_straight_back),
        cmocka_unit_test(a_velocity_outside_the_cone_meets_one_wall_only),
        cmocka_unit_test(energy_never_grows),
        cmocka_unit_test(an_acute_corner_takes_the_smaller_restitution),
        cmocka_unit_test(an_elastic_corner_keeps_the_energy),
        cmocka_unit_test(a_plastic_corner_leaves_what_does_not_approach),
        cmocka_unit_test(momentum_along_the_surface_is_kept),
        cmocka_unit_test(a_surface_holds_what_presses_on_it),
        cmocka_unit_test(the_walls_of_a_corner_hold_together_or_alone),
        cmocka_unit_test(reactions_and_what_is_left_are_complementary),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
