/* SPDX-License-Identifier: BSD-3-Clause */
/* impact_law.c: reflection (8), restitution (9), friction by Coulomb and by (10), Moreau's law in a corner, which
 * surfaces hold. */
#include "verification/support.h"

#include <stdbool.h>

#include <gsl/gsl_rng.h>

#include "contact/impact_law.h"

static vec2 direction(double angle)
{
    return (vec2){cos(angle), sin(angle)};
}

static void check_vector(vec2 actual, double x, double y, double tolerance)
{
    assert_close(actual.x, x, tolerance);
    assert_close(actual.y, y, tolerance);
}

static impact_surface smooth(double nx, double ny, double restitution)
{
    return (impact_surface){.normal = {nx, ny}, .restitution = restitution};
}

static impact_surface rough(vec2 normal, double restitution, double friction, dem_friction_law law)
{
    return (impact_surface){.normal = normal, .restitution = restitution, .friction = friction, .law = law};
}

/* The velocity after; what the surfaces add must be the change, to the rounding of velocities up to 5 m/s and of the
 * parts along two normals, which grows as the sine of the corner falls. */
static vec2 rebound(const impact_surface *surface, int n, vec2 v)
{
    vec2 kick[2] = {{77.0, 77.0}, {0.0, 0.0}};
    const vec2 after = impact_law_rebound(surface, n, v, kick);
    const double corner = n == 2 ? fabs(vec2_cross(surface[0].normal, surface[1].normal)) : 1.0;
    const vec2 sum = vec2_add(kick[0], n == 2 ? kick[1] : (vec2){0.0, 0.0});
    check_vector(sum, after.x - v.x, after.y - v.y, 1e-14 / corner);
    return after;
}

/* ---- one surface ---- */

TEST(an_elastic_impact_reflects_at_the_surface)
{
    const impact_surface level = smooth(0.0, 1.0, 1.0), tilted = smooth(sqrt(0.5), sqrt(0.5), 1.0);
    check_vector(rebound(&level, 1, (vec2){3.0, -4.0}), 3.0, 4.0, 0.0);     /* (8) */
    check_vector(rebound(&tilted, 1, (vec2){-3.0, 0.5}), -0.5, 3.0, 1e-15); /* swaps and turns the components */
}

TEST(restitution_scales_the_normal_part_and_leaves_the_tangential_one)
{
    const impact_surface level = smooth(0.0, 1.0, 0.25), plastic = smooth(0.0, 1.0, 0.0);
    check_vector(rebound(&level, 1, (vec2){3.0, -4.0}), 3.0, 1.0, 0.0); /* (9) */
    check_vector(rebound(&plastic, 1, (vec2){3.0, -4.0}), 3.0, 0.0, 0.0);
}

TEST(what_does_not_approach_is_not_changed)
{
    const impact_surface level = smooth(0.0, 1.0, 0.5);
    check_vector(rebound(&level, 1, (vec2){3.0, 4.0}), 3.0, 4.0, 0.0);
    check_vector(rebound(&level, 1, (vec2){3.0, 0.0}), 3.0, 0.0, 0.0);
}

/* A push of 1 m/s^2 on what is reflected 1 m below the surface and put back on it, again and again: the height of its
 * hops at last. At eta = 0.995 it would be 99 m; it is not followed beyond 50 m. */
TEST(hops_kept_up_by_the_depth_of_impacts_reach_their_height)
{
    static const double eta[4] = {0.0, 0.3, 0.5, 0.9};
    for (int k = 0; k < 4; k++) {
        const impact_surface level = smooth(0.0, 1.0, eta[k]);
        double speed = 0.0;
        for (int hop = 0; hop < 1000; hop++) {
            const double arrives = sqrt(speed * speed + 2.0);
            speed = rebound(&level, 1, (vec2){0.0, -arrives}).y;
        }
        /* rounding of heights up to 4 m, kept up by 1/(1 - eta^2) */
        assert_close(impact_law_kept_up(&level), 0.5 * speed * speed, 1e-14);
    }
    const impact_surface springy = smooth(0.0, 1.0, 0.995), elastic = smooth(0.0, 1.0, 1.0);
    assert_close(impact_law_kept_up(&springy), 50.0, 0.0);
    assert_close(impact_law_kept_up(&elastic), 0.0, 0.0);
}

/* ---- two surfaces ---- */

TEST(a_corner_turns_back_only_what_approaches_each_wall)
{
    const impact_surface walls[2] = {smooth(0.0, 1.0, 0.5), smooth(-1.0, 0.0, 0.25)};
    check_vector(rebound(walls, 2, (vec2){-1.0, -2.0}), -1.0, 1.0, 0.0); /* the floor alone */
    check_vector(rebound(walls, 2, (vec2){2.0, 1.0}), -0.5, 1.0, 0.0);   /* the wall alone */
    check_vector(rebound(walls, 2, (vec2){2.0, -4.0}), -0.5, 2.0, 0.0);  /* both */
    check_vector(rebound(walls, 2, (vec2){-2.0, 4.0}), -2.0, 4.0, 0.0);  /* none */
}

/* Walls at 60 degrees to the vertical, a groove: straight in, both act and the velocity is -eta v. */
TEST(a_groove_sends_a_velocity_inside_its_cone_straight_back)
{
    const impact_surface walls[2] = {smooth(0.5 * sqrt(3.0), 0.5, 0.5), smooth(-0.5 * sqrt(3.0), 0.5, 0.5)};
    check_vector(rebound(walls, 2, (vec2){0.3, -2.0}), -0.15, 1.0, 1e-15);
}

/* In a blunt corner a velocity outside the cone of the inward normals meets one wall, whatever the order of the two,
 * although it approaches both: the plastic impact leaves it gliding off the other. */
TEST(a_velocity_outside_the_cone_meets_one_wall_only)
{
    const vec2 n0 = direction(1.8), n1 = direction(1.2), v = direction(1.5 - 2.0);
    const impact_surface order[2] = {smooth(n0.x, n0.y, 0.0), smooth(n1.x, n1.y, 0.0)},
                         reverse[2] = {smooth(n1.x, n1.y, 0.0), smooth(n0.x, n0.y, 0.0)};
    assert_true(vec2_dot(v, n0) < 0.0 && vec2_dot(v, n1) < 0.0);
    const vec2 first = rebound(order, 2, v), second = rebound(reverse, 2, v);
    const vec2 alone = rebound(&order[0], 1, v);
    assert_true(vec2_dot(alone, n1) >= 0.0);
    check_vector(first, alone.x, alone.y, 0.0);
    check_vector(second, alone.x, alone.y, 0.0);
}

/* 8e-10 rad apart: what one of them leaves of the velocity runs into the other, by 1.6e-19 of it. */
TEST(two_walls_as_good_as_parallel_are_one)
{
    const impact_surface walls[2] = {smooth(4e-10, 1.0, 0.5), smooth(-4e-10, 1.0, 0.5)},
                         exchanged[2] = {walls[1], walls[0]};
    check_vector(rebound(walls, 2, (vec2){0.0, -1.0}), 6e-10, 0.5, 1e-15);
    check_vector(rebound(exchanged, 2, (vec2){0.0, -1.0}), -6e-10, 0.5, 1e-15);
}

/* ---- friction ---- */

/* (eta, mu) and the tangential velocities of the exact case f3 of the verification suite, v = (3, -2). */
TEST(coulomb_friction_takes_up_to_mu_times_the_normal_change_from_what_slides)
{
    static const double eta[3] = {0.5, 0.5, 0.8}, mu[3] = {0.3, 0.9, 1.5}, slides[3] = {2.1, 0.3, 0.0};
    for (int k = 0; k < 3; k++) {
        const impact_surface level = rough((vec2){0.0, 1.0}, eta[k], mu[k], DEM_FRICTION_COULOMB);
        check_vector(rebound(&level, 1, (vec2){3.0, -2.0}), slides[k], 2.0 * eta[k], 1e-15); /* rounding of products */
        check_vector(rebound(&level, 1, (vec2){-3.0, -2.0}), -slides[k], 2.0 * eta[k], 1e-15);
        check_vector(rebound(&level, 1, (vec2){0.0, -2.0}), 0.0, 2.0 * eta[k], 0.0);
        check_vector(rebound(&level, 1, (vec2){3.0, 2.0}), 3.0, 2.0, 0.0); /* no impact, no friction */
    }
}

/* Kept is mu v_t, whatever the restitution and the normal velocity: mu = 1 is smooth, mu = 0 sticks. */
TEST(the_law_of_the_paper_keeps_mu_times_the_tangential_velocity)
{
    static const double mu[3] = {0.3, 0.0, 1.0};
    for (int k = 0; k < 3; k++) {
        const impact_surface level = rough((vec2){0.0, 1.0}, 0.5, mu[k], DEM_FRICTION_PAPER);
        check_vector(rebound(&level, 1, (vec2){3.0, -2.0}), 3.0 * mu[k], 1.0, 1e-15); /* (10); rounding of 0.9 */
        check_vector(rebound(&level, 1, (vec2){-3.0, -0.25}), -3.0 * mu[k], 0.125, 1e-15);
        check_vector(rebound(&level, 1, (vec2){3.0, 0.25}), 3.0, 0.25, 0.0); /* no impact, no friction */
    }
}

/* In a corner friction acts on the one wall that acts: the floor rubs what comes from the right, the wall what comes
 * from above; where both act there is none, and the kicks go along the normals. */
TEST(in_a_corner_friction_acts_where_one_wall_acts_alone)
{
    const impact_surface walls[2] = {rough((vec2){0.0, 1.0}, 0.5, 0.1, DEM_FRICTION_COULOMB),
                                     rough((vec2){-1.0, 0.0}, 0.25, 0.6, DEM_FRICTION_PAPER)};
    vec2 kick[2];
    /* rounding of velocities of order 1 in all */
    check_vector(impact_law_rebound(walls, 2, (vec2){-1.0, -2.0}, kick), -0.7, 1.0, 1e-15); /* 0.1 of 3 m/s */
    check_vector(kick[0], 0.3, 3.0, 1e-15);
    check_vector(kick[1], 0.0, 0.0, 0.0);
    check_vector(impact_law_rebound(walls, 2, (vec2){2.0, 1.0}, kick), -0.5, 0.6, 1e-15);
    check_vector(kick[0], 0.0, 0.0, 0.0);
    check_vector(kick[1], -2.5, -0.4, 1e-15);
    check_vector(impact_law_rebound(walls, 2, (vec2){2.0, -4.0}, kick), -0.5, 2.0, 0.0);
    check_vector(kick[0], 0.0, 6.0, 0.0);
    check_vector(kick[1], -2.5, 0.0, 0.0);
    check_vector(impact_law_rebound(walls, 2, (vec2){-2.0, 4.0}, kick), -2.0, 4.0, 0.0);
    check_vector(kick[0], 0.0, 0.0, 0.0);
    check_vector(kick[1], 0.0, 0.0, 0.0);
}

/* An acute corner where both act takes the smaller restitution in the kicks as well. */
TEST(the_kicks_of_an_acute_corner_have_the_smaller_restitution)
{
    const vec2 n[2] = {{0.0, 1.0}, {sin(0.4), -cos(0.4)}};
    const impact_surface wedge[2] = {smooth(n[0].x, n[0].y, 1.0), smooth(n[1].x, n[1].y, 0.25)};
    const vec2 v = vec2_along(vec2_scale(-2.0, n[0]), -3.0, n[1]);
    vec2 kick[2];
    /* rounding of velocities of order 1 over the sine of the corner, 0.39 */
    check_vector(impact_law_rebound(wedge, 2, v, kick), -0.25 * v.x, -0.25 * v.y, 1e-14);
    check_vector(kick[0], 2.5 * n[0].x, 2.5 * n[0].y, 1e-14);
    check_vector(kick[1], 3.75 * n[1].x, 3.75 * n[1].y, 1e-14);
}

/* ---- random impacts ---- */

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
        for (int k = 0; k < 2; k++) {
            const vec2 n = direction(2.0 * M_PI * gsl_rng_uniform(w->rng));
            w->s[k] = smooth(n.x, n.y, gsl_rng_uniform(w->rng));
        }
    } while (fabs(vec2_cross(w->s[0].normal, w->s[1].normal)) < 0.1);
    w->v = vec2_scale(2.0 * gsl_rng_uniform(w->rng), direction(2.0 * M_PI * gsl_rng_uniform(w->rng)));
}

/* Friction by both laws: Coulomb's up to 2, (10) up to 1, which is as far as it goes. */
static void sweep_friction(sweep *w)
{
    for (int k = 0; k < 2; k++) {
        w->s[k].law = gsl_rng_uniform(w->rng) < 0.5 ? DEM_FRICTION_COULOMB : DEM_FRICTION_PAPER;
        w->s[k].friction = gsl_rng_uniform(w->rng) * (w->s[k].law == DEM_FRICTION_COULOMB ? 2.0 : 1.0);
    }
}

TEST(energy_never_grows)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    for (int k = 0; k < 40000; k++) {
        sweep_next(&w);
        if (k >= 20000) sweep_friction(&w);
        for (int n = 1; n <= 2; n++) {
            const vec2 after = rebound(w.s, n, w.v);
            assert_true(vec2_dot(after, after) <= vec2_dot(w.v, w.v) + swept_tolerance);
        }
    }
    gsl_rng_free(w.rng);
}

/* A wedge of 0.4 rad with an elastic and a plastic wall: with its own restitution for each wall the energy would
 * grow sevenfold. */
TEST(an_acute_corner_takes_the_smaller_restitution)
{
    const impact_surface wedge[2] = {smooth(0.0, 1.0, 1.0), smooth(sin(0.4), -cos(0.4), 0.0)};
    check_vector(rebound(wedge, 2, (vec2){-1.0, -0.5}), 0.0, 0.0, 1e-15);
}

TEST(an_elastic_corner_keeps_the_energy)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    for (int k = 0; k < 20000; k++) {
        sweep_next(&w);
        w.s[0].restitution = w.s[1].restitution = 1.0;
        const vec2 after = rebound(w.s, 2, w.v);
        assert_close(vec2_dot(after, after), vec2_dot(w.v, w.v), swept_tolerance);
    }
    gsl_rng_free(w.rng);
}

/* After a plastic impact nothing approaches either wall, what was taken is a push out of them, and no more than
 * needed: where a wall pushes, the node glides along it. */
TEST(a_plastic_corner_leaves_what_does_not_approach)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    int n_both = 0;
    for (int k = 0; k < 20000; k++) {
        double push[2];
        sweep_next(&w);
        w.s[0].restitution = w.s[1].restitution = 0.0;
        const vec2 after = rebound(w.s, 2, w.v);
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

/* Coulomb's law as inequalities: friction opposes sliding, is no more than mu times the normal kick, and is less only
 * where it stops the sliding. */
TEST(friction_is_in_coulombs_cone_and_at_its_rim_where_it_slides_on)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    int n_stuck = 0, n_slid = 0;
    for (int k = 0; k < 20000; k++) {
        sweep_next(&w);
        sweep_friction(&w);
        w.s[0].law = DEM_FRICTION_COULOMB;
        const vec2 n = w.s[0].normal, after = rebound(w.s, 1, w.v), change = vec2_sub(after, w.v);
        const double push = vec2_dot(change, n), rub = vec2_cross(n, change);
        const double before_t = vec2_cross(n, w.v), after_t = vec2_cross(n, after);
        assert_true(fabs(rub) <= w.s[0].friction * push + 1e-15); /* rounding of velocities up to 2 m/s */
        assert_true(rub * before_t <= 0.0 && after_t * before_t >= -1e-15);
        if (push == 0.0) continue;
        if (fabs(after_t) > 1e-15) assert_close(fabs(rub), w.s[0].friction * push, 1e-15);
        n_stuck += fabs(after_t) <= 1e-15;
        n_slid += fabs(after_t) > 1e-15;
    }
    assert_true(n_stuck > 1000 && n_slid > 1000);
    gsl_rng_free(w.rng);
}

/* The walls of a corner have no order. */
TEST(exchanging_the_walls_exchanges_the_kicks)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    for (int k = 0; k < 20000; k++) {
        vec2 kick[2], other[2];
        sweep_next(&w);
        sweep_friction(&w);
        const impact_surface reverse[2] = {w.s[1], w.s[0]};
        const vec2 after = impact_law_rebound(w.s, 2, w.v, kick);
        check_vector(impact_law_rebound(reverse, 2, w.v, other), after.x, after.y, swept_tolerance);
        for (int q = 0; q < 2; q++) check_vector(other[q], kick[1 - q].x, kick[1 - q].y, swept_tolerance);
    }
    gsl_rng_free(w.rng);
}

TEST(momentum_along_a_smooth_surface_is_kept)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    for (int k = 0; k < 5000; k++) {
        sweep_next(&w);
        const vec2 n = w.s[0].normal, after = rebound(w.s, 1, w.v);
        const double before_n = vec2_dot(w.v, n), after_n = vec2_dot(after, n);
        assert_close(vec2_cross(n, after), vec2_cross(n, w.v), 1e-15);
        assert_close(after_n, before_n < 0.0 ? -w.s[0].restitution * before_n : before_n, 1e-15);
    }
    gsl_rng_free(w.rng);
}

/* ---- holding ---- */

TEST(a_surface_holds_what_presses_on_it)
{
    const impact_surface level = smooth(0.0, 1.0, 0.5);
    double reaction[2] = {77.0, 77.0};
    assert_int_equal(impact_law_holding(&level, 1, (vec2){3.0, -4.0}, reaction), 1);
    assert_close(reaction[0], 4.0, 0.0);
    assert_int_equal(impact_law_holding(&level, 1, (vec2){3.0, 4.0}, reaction), 0);
    assert_close(reaction[0], 0.0, 0.0);
    assert_int_equal(impact_law_holding(&level, 1, (vec2){3.0, 0.0}, reaction), 0);
}

TEST(the_walls_of_a_corner_hold_together_or_alone)
{
    const impact_surface walls[2] = {smooth(0.0, 1.0, 0.5), smooth(-1.0, 0.0, 0.25)};
    double reaction[2];
    assert_int_equal(impact_law_holding(walls, 2, (vec2){2.0, -4.0}, reaction), 3);
    assert_close(reaction[0], 4.0, 0.0);
    assert_close(reaction[1], 2.0, 0.0);
    assert_int_equal(impact_law_holding(walls, 2, (vec2){-2.0, -4.0}, reaction), 1);
    assert_int_equal(impact_law_holding(walls, 2, (vec2){2.0, 4.0}, reaction), 2);
    assert_close(reaction[0], 0.0, 0.0);
    assert_close(reaction[1], 2.0, 0.0);
    assert_int_equal(impact_law_holding(walls, 2, (vec2){-2.0, 4.0}, reaction), 0);
}

/* Complementarity: no reaction pulls, what is left does not press inwards, and a wall that reacts has nothing left
 * along its normal. Restitution has no say in it. */
TEST(reactions_and_what_is_left_are_complementary)
{
    sweep w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    int n_of[4] = {0};
    for (int k = 0; k < 20000; k++) {
        double reaction[2];
        sweep_next(&w);
        const int holding = impact_law_holding(w.s, 2, w.v, reaction);
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
