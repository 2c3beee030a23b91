/* SPDX-License-Identifier: BSD-3-Clause */
/* site.c: guards, reactions and ends of one contact site in each of its states, and when they change within a step.
 * Numbers are worked out by hand; tolerances of 1e-15 to 1e-13 are rounding. */
#include "../verification/support.h"

#include <float.h>
#include <stdbool.h>
#include <stdlib.h>

#include "site.h"

static const double skin = 1e-3, g = 10.0, mass = 2.0;

/* A floor of 4 m and, 3 m above its end, a ceiling; bodies live between them. */
static const double floor_points[4] = {0.0, 0.0, 4.0, 0.0}, ceiling_points[4] = {6.0, 3.0, 3.0, 3.0};
static const dem_obstacle room[2] = {{.n_points = 2, .points = floor_points, .restitution = 0.5},
                                     {.n_points = 2, .points = ceiling_points, .restitution = 0.5}};

/* A groove of 90 degrees with its bottom in the origin. */
static const double groove_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0};
static const dem_obstacle groove = {.n_points = 3, .points = groove_points, .restitution = 0.0};

static contact_scene open_scene(const dem_obstacle *obstacles, dem_index n_obstacles)
{
    const double x[4] = {1.0, 1.0};
    contact_scene scene = {.rule = {.skin = skin, .max_step = 0.1, .load.gravity = {0.0, -g}}};
    dem_lattice lattice;
    dem_model *model;
    support_lattice(&lattice, 1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    assert_ok(dem_model_create(&model, &lattice, obstacles, n_obstacles));
    dem_lattice_free(&lattice);
    scene.model = model;
    return scene;
}

static void close_scene(contact_scene *scene)
{
    dem_model_destroy((dem_model *)(uintptr_t)scene->model);
}

static contact_site free_site(void)
{
    return (contact_site){.node = 0, .behind = -1};
}

static contact_site sliding_site(dem_index s)
{
    return (contact_site){.node = 0, .behind = -1, .n_closed = 1, .segments = {s, -1}};
}

static contact_site held_site(void)
{
    return (contact_site){.node = 0, .behind = -1, .n_closed = 2, .segments = {0, 1}};
}

static void check_guards(const contact_scene *scene, const contact_site *site, double x, double y, double g0, double g1,
                         double g2)
{
    const double at[4] = {x, y};
    double guards[SITE_GUARDS] = {77.0, 77.0, 77.0};
    site_guards(scene, site, at, guards);
    assert_close(guards[0], g0, 1e-13);
    assert_close(guards[1], g1, 1e-13);
    assert_close(guards[2], g2, 1e-13);
}

/* ---- guards ---- */

static void a_free_site_watches_its_gap_down_to_the_skin(void **state)
{
    (void)state;
    contact_scene scene = open_scene(room, 2);
    const contact_site site = free_site();
    check_guards(&scene, &site, 1.0, 0.25, 0.25 + skin, 1.0, 1.0);
    check_guards(&scene, &site, 1.0, 0.0, skin, 1.0, 1.0);
    check_guards(&scene, &site, 1.0, -skin, 0.0, 1.0, 1.0);
    check_guards(&scene, &site, 1.0, -0.1, -0.1 + skin, 1.0, 1.0);
    check_guards(&scene, &site, 5.0, 2.5, 0.5 + skin, 1.0, 1.0); /* the ceiling is nearer */
    close_scene(&scene);
}

static void far_from_everything_its_guard_is_finite(void **state)
{
    (void)state;
    contact_scene scene = open_scene(room, 2), empty = open_scene(NULL, 0);
    const contact_site site = free_site();
    check_guards(&scene, &site, -50.0, 1.0, 1.0 + skin, 1.0, 1.0);
    check_guards(&empty, &site, 0.0, 0.0, 1.0 + skin, 1.0, 1.0);
    close_scene(&scene);
    close_scene(&empty);
}

static void a_site_behind_an_obstacle_does_not_see_it(void **state)
{
    (void)state;
    contact_scene scene = open_scene(room, 2);
    contact_site site = free_site();
    site.behind = 0;
    check_guards(&scene, &site, 3.5, -0.2, 1.0 + skin, 1.0, 1.0);
    check_guards(&scene, &site, 3.5, 2.5, 0.5 + skin, 1.0, 1.0);
    site = sliding_site(1);
    site.behind = 0;
    check_guards(&scene, &site, 3.5, 3.0, -mass * g, 0.5 + skin, 1.0 + skin);
    close_scene(&scene);
}

/* Reaction m g, the nearer end, the other obstacle above: min(3 - 0, 1) + skin; 3 m to the ceiling count as 1. */
static void a_sliding_site_watches_reaction_end_and_other_obstacles(void **state)
{
    (void)state;
    contact_scene scene = open_scene(room, 2);
    const contact_site on_floor = sliding_site(0), on_ceiling = sliding_site(1);
    check_guards(&scene, &on_floor, 1.5, 0.0, mass * g, 1.5 + skin, 1.0 + skin);
    check_guards(&scene, &on_floor, 3.75, 0.0, mass * g, 0.25 + skin, 1.0 + skin);
    check_guards(&scene, &on_floor, 4.5, 0.0, mass * g, -0.5 + skin, 1.0 + skin);
    check_guards(&scene, &on_floor, 3.5, 2.75, mass * g, 0.5 + skin, 0.25 + skin);
    check_guards(&scene, &on_ceiling, 4.0, 3.0, -mass * g, 1.0 + skin, 1.0 + skin);
    close_scene(&scene);
}

/* Each flank of the groove takes m g cos 45; with gravity turned into one flank's normal the other takes nothing. */
static void a_held_site_watches_both_reactions(void **state)
{
    (void)state;
    contact_scene scene = open_scene(&groove, 1);
    const contact_site site = held_site();
    double reaction[2];
    const double at[4] = {0.0, 0.0};
    check_guards(&scene, &site, 0.0, 0.0, mass * g * sqrt(0.5), mass * g * sqrt(0.5), 1.0);
    scene.rule.load.gravity[0] = -g; /* into the left flank, whose normal is (1, 1)/sqrt 2 */
    check_guards(&scene, &site, 0.0, 0.0, mass * g * sqrt(2.0), 0.0, 1.0);
    scene.rule.load.gravity[1] = 0.0;
    check_guards(&scene, &site, 0.0, 0.0, mass * g * sqrt(0.5), -mass * g * sqrt(0.5), 1.0);
    site_reactions(&scene, &site, at, reaction);
    assert_close(reaction[0], mass * g * sqrt(0.5), 1e-13);
    assert_close(reaction[1], -mass * g * sqrt(0.5), 1e-13);
    close_scene(&scene);
}

/* A spring of 100 N and 1 m stretched to 1.5 m pulls with 50 N; the weight is 20 N. */
static void the_force_on_a_site_is_elastic_and_weight(void **state)
{
    const double x[4] = {1.0, 0.0, 1.0, 1.0}, now[4] = {1.0, 0.0, 1.0, 1.5}, masses[2] = {2.0, 3.0};
    const dem_index ends[2] = {0, 1};
    const contact_site site = sliding_site(0);
    dem_lattice lattice;
    dem_model *model;
    double reaction[2];
    (void)state;
    support_lattice(&lattice, 2, x, masses, 1, ends, 1.0, 100.0, NULL);
    assert_ok(dem_model_create(&model, &lattice, room, 2));
    dem_lattice_free(&lattice);
    const contact_scene scene = {model, {.skin = skin, .load.gravity = {0.5, -g}}};
    const vec2 force = site_force(&scene, &site, now);
    assert_close(force.x, 1.0, 1e-14);
    assert_close(force.y, 30.0, 1e-14);
    site_reactions(&scene, &site, now, reaction);
    assert_close(reaction[0], -30.0, 1e-14);
    assert_close(reaction[1], 0.0, 0.0);
    dem_model_destroy(model);
}

/* ---- ends and what is due ---- */

static int end_passed(const contact_scene *scene, double x, double vx)
{
    const contact_site site = sliding_site(0);
    const double at[4] = {x, 0.0}, v[2] = {vx, 0.0};
    return site_end_passed(scene, &site, at, v);
}

static void an_end_is_passed_by_the_skin_heading_out(void **state)
{
    (void)state;
    contact_scene scene = open_scene(room, 2);
    assert_int_equal(end_passed(&scene, 2.0, 5.0), 0);
    assert_int_equal(end_passed(&scene, 4.0 + 0.99 * skin, 1.0), 0);
    assert_int_equal(end_passed(&scene, 4.0 + 1.01 * skin, 1.0), 1);
    assert_int_equal(end_passed(&scene, 4.1, 1.0), 1);
    assert_int_equal(end_passed(&scene, 4.1, -1.0), 0);
    assert_int_equal(end_passed(&scene, -1.01 * skin, -1.0), -1);
    assert_int_equal(end_passed(&scene, -0.1, -1.0), -1);
    assert_int_equal(end_passed(&scene, -0.1, 1.0), 0);
    close_scene(&scene);
}

static void at_rest_the_force_tells_where_it_heads(void **state)
{
    (void)state;
    contact_scene scene = open_scene(room, 2);
    assert_int_equal(end_passed(&scene, 4.0 + 1.01 * skin, 0.0), 0);
    scene.rule.load.gravity[0] = 1.0;
    assert_int_equal(end_passed(&scene, 4.0 + 1.01 * skin, 0.0), 1);
    assert_int_equal(end_passed(&scene, -1.01 * skin, 0.0), 0);
    scene.rule.load.gravity[0] = -1.0;
    assert_int_equal(end_passed(&scene, 4.0 + 1.01 * skin, 0.0), 0);
    assert_int_equal(end_passed(&scene, -1.01 * skin, 0.0), -1);
    close_scene(&scene);
}

static bool due(const contact_scene *scene, const contact_site *site, double x, double y, double vx)
{
    const double at[4] = {x, y, vx, 0.0};
    return site_due(scene, site, at);
}

static void a_sliding_site_is_due_when_pulled_at_an_end_or_on_another_obstacle(void **state)
{
    (void)state;
    contact_scene scene = open_scene(room, 2);
    const contact_site site = sliding_site(0);
    assert_false(due(&scene, &site, 2.0, 0.0, 1.0));
    assert_true(due(&scene, &site, 4.0 + 1.01 * skin, 0.0, 1.0));
    assert_false(due(&scene, &site, 4.0 + 1.01 * skin, 0.0, -1.0));
    assert_true(due(&scene, &site, 3.5, 3.0 + 1.01 * skin, 1.0));
    assert_false(due(&scene, &site, 3.5, 3.0 + 0.99 * skin, 1.0));
    scene.rule.load.gravity[1] = 0.0;
    assert_true(due(&scene, &site, 2.0, 0.0, 1.0));
    close_scene(&scene);
}

static void a_held_site_is_due_when_either_reaction_ceases(void **state)
{
    (void)state;
    contact_scene scene = open_scene(&groove, 1);
    const contact_site site = held_site();
    assert_false(due(&scene, &site, 0.0, 0.0, 0.0));
    scene.rule.load.gravity[0] = 1.01 * g;
    assert_true(due(&scene, &site, 0.0, 0.0, 0.0));
    scene.rule.load.gravity[0] = -1.01 * g;
    assert_true(due(&scene, &site, 0.0, 0.0, 0.0));
    close_scene(&scene);
}

/* ---- search within a step ---- */

/* Free flight y = y0 + u t - g t^2/2 from t0 to t1 over x = x0 + w t, which the path's quintic follows exactly. */
typedef struct flight {
    double y0[4], f0[4], y1[4], f1[4];
    path path;
} flight;

static void fly(flight *f, const double x[2], const double v[2], double a, double t0, double t1)
{
    const double h = t1 - t0;
    for (int k = 0; k < 2; k++) {
        const double ak = k == 1 ? a : 0.0;
        f->y0[k] = x[k];
        f->y0[2 + k] = f->f0[k] = v[k];
        f->f0[2 + k] = f->f1[2 + k] = ak;
        f->y1[k] = x[k] + h * (v[k] + 0.5 * h * ak);
        f->y1[2 + k] = f->f1[k] = v[k] + h * ak;
    }
    f->path = (path){1, t0, t1, t1, f->y0, f->f0, f->y1, f->f1};
}

/* Falls from 0.2 m: at the skin's depth after sqrt(2 (0.2 + skin)/g). The time is found to 100 units of rounding of
 * t + h, and its end is on the deep side. */
static void a_fall_reaches_the_skin_at_the_time_of_free_fall(void **state)
{
    const double x[4] = {1.0, 0.2}, v[2] = {0.3, 0.0}, start = 7.0, t = sqrt(2.0 * (0.2 + skin) / g);
    flight f;
    (void)state;
    contact_scene scene = open_scene(room, 2);
    const contact_site site = free_site();
    fly(&f, x, v, -g, start, start + 0.3);
    const double found = site_first_crossing(&scene, &site, &f.path, false);
    assert_close(found, start + t, 200.0 * DBL_EPSILON * (start + 0.3));
    assert_true(path_position(&f.path, found, 0).y <= -skin);
    f.path.end = start + 0.9 * t;
    assert_true(isinf(site_first_crossing(&scene, &site, &f.path, false)) != 0);
    close_scene(&scene);
}

static void a_crossing_at_the_end_of_a_rooted_step_is_the_root_itself(void **state)
{
    const double x[4] = {1.0, 0.2}, v[2] = {0.0, 0.0}, t = sqrt(2.0 * (0.2 + skin) / g);
    flight f;
    (void)state;
    contact_scene scene = open_scene(room, 2);
    const contact_site site = free_site();
    fly(&f, x, v, -g, 0.0, 0.3);
    f.path.end = t * (1.0 + 1e-12);
    assert_true(isinf(site_first_crossing(&scene, &site, &f.path, true)) != 0);
    assert_close(site_first_crossing(&scene, &site, &f.path, false), t, 1e-13);
    f.path.end = 1.2 * t; /* an eighth before this end it is deep already */
    assert_close(site_first_crossing(&scene, &site, &f.path, true), t, 1e-13);
    close_scene(&scene);
}

/* Thrown down against an upward pull: inside from 0.24 t1 to 0.76 t1, outside at both ends. */
static void a_dip_within_the_step_is_found(void **state)
{
    const double depth = 0.05, a = 10.0, bottom = 0.2; /* y = -depth + a (t - bottom)^2/2 */
    const double x[4] = {1.0, -depth + 0.5 * a * bottom * bottom}, v[2] = {0.0, -a * bottom};
    flight f;
    (void)state;
    contact_scene scene = open_scene(room, 2);
    const contact_site site = free_site();
    fly(&f, x, v, a, 0.0, 2.0 * bottom);
    assert_true(f.y0[1] > 0.0 && f.y1[1] > 0.0);
    assert_close(site_first_crossing(&scene, &site, &f.path, false), bottom - sqrt(2.0 * (depth - skin) / a), 1e-13);
    assert_close(site_first_crossing(&scene, &site, &f.path, true), bottom - sqrt(2.0 * (depth - skin) / a), 1e-13);
    close_scene(&scene);
}

/* A parabola whose bottom, between two of the eight samples, is a micrometre deeper than the skin for 1/500 of the
 * step; one that stays as much above it is none. Times to rounding over a vertical speed of 4.5 mm/s. */
static void the_shortest_dip_is_found_and_a_near_miss_is_none(void **state)
{
    const double a = 10.0, bottom = 0.2, end = 0.45;
    (void)state;
    contact_scene scene = open_scene(room, 2);
    const contact_site site = free_site();
    for (int k = 0; k < 2; k++) {
        const double depth = skin + (k == 0 ? 1e-6 : -1e-6);
        const double x[4] = {1.0, -depth + 0.5 * a * bottom * bottom}, v[2] = {0.0, -a * bottom};
        flight f;
        fly(&f, x, v, a, 0.0, end);
        const double found = site_first_crossing(&scene, &site, &f.path, k == 1);
        if (k == 0)
            assert_close(found, bottom - sqrt(2.0 * (depth - skin) / a), 1e-12);
        else
            assert_true(isinf(found) != 0);
    }
    close_scene(&scene);
}

static void a_site_out_of_reach_never_crosses(void **state)
{
    const double x[4] = {1.0, 0.9}, v[2] = {4.0, 0.0};
    flight f;
    (void)state;
    contact_scene scene = open_scene(room, 2);
    const contact_site site = free_site();
    fly(&f, x, v, 0.0, 0.0, 0.1);
    assert_true(isinf(site_first_crossing(&scene, &site, &f.path, false)) != 0);
    close_scene(&scene);
}

/* Slides from x = 3 with 2 m/s: beyond the end by the skin after half a second and the time for that. */
static void a_sliding_site_is_first_due_when_it_reaches_the_end(void **state)
{
    const double x[4] = {3.0, 0.0}, v[2] = {2.0, 0.0};
    double scratch[4];
    flight f;
    (void)state;
    contact_scene scene = open_scene(room, 2);
    const contact_site site = sliding_site(0);
    fly(&f, x, v, 0.0, 1.0, 1.7);
    assert_true(site_due(&scene, &site, f.y1));
    const double found = site_first_due(&scene, &site, &f.path, scratch);
    assert_close(found, 1.5 + 0.5 * skin, 200.0 * DBL_EPSILON * 2.4);
    path_state(&f.path, found, scratch);
    assert_true(site_due(&scene, &site, scratch));
    close_scene(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_free_site_watches_its_gap_down_to_the_skin),
        cmocka_unit_test(far_from_everything_its_guard_is_finite),
        cmocka_unit_test(a_site_behind_an_obstacle_does_not_see_it),
        cmocka_unit_test(a_sliding_site_watches_reaction_end_and_other_obstacles),
        cmocka_unit_test(a_held_site_watches_both_reactions),
        cmocka_unit_test(the_force_on_a_site_is_elastic_and_weight),
        cmocka_unit_test(an_end_is_passed_by_the_skin_heading_out),
        cmocka_unit_test(at_rest_the_force_tells_where_it_heads),
        cmocka_unit_test(a_sliding_site_is_due_when_pulled_at_an_end_or_on_another_obstacle),
        cmocka_unit_test(a_held_site_is_due_when_either_reaction_ceases),
        cmocka_unit_test(a_fall_reaches_the_skin_at_the_time_of_free_fall),
        cmocka_unit_test(a_crossing_at_the_end_of_a_rooted_step_is_the_root_itself),
        cmocka_unit_test(a_dip_within_the_step_is_found),
        cmocka_unit_test(the_shortest_dip_is_found_and_a_near_miss_is_none),
        cmocka_unit_test(a_site_out_of_reach_never_crosses),
        cmocka_unit_test(a_sliding_site_is_first_due_when_it_reaches_the_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
