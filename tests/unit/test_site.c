/* SPDX-License-Identifier: BSD-3-Clause */
/* site.c: gaps and guards of one contact site in each of its states, and what is due. Numbers are worked out by hand;
 * tolerances of 1e-15 to 1e-13 are rounding. */
#include "scene.h"

static const double skin = 1e-3;

/* A floor of 4 m and, 3 m above its end, a ceiling; bodies live between them. */
static const double floor_points[4] = {0.0, 0.0, 4.0, 0.0}, ceiling_points[4] = {6.0, 3.0, 3.0, 3.0};
static const dem_obstacle room[2] = {{.n_points = 2, .points = floor_points, .restitution = 0.5},
                                     {.n_points = 2, .points = ceiling_points, .restitution = 0.5}};
static const dem_obstacle rough = {
    .n_points = 2, .points = floor_points, .friction = 0.5, .friction_law = DEM_FRICTION_COULOMB};

/* A groove of 90 degrees with its bottom in the origin. */
static const double groove_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0};
static const dem_obstacle groove = {.n_points = 3, .points = groove_points, .restitution = 0.0};

static void set_rule(scene *s)
{
    s->c.sites.scene.rule.skin = skin;
    s->c.sites.scene.rule.max_step = 0.1;
}

/* One node of 2 kg. */
static const contact_scene *open_node(scene *s, const dem_obstacle *obstacles, dem_index n)
{
    const double x[2] = {1.0, 1.0}, mass = 2.0;
    scene_open(s, 1, x, &mass, 0, NULL, obstacles, n);
    set_rule(s);
    return &s->c.sites.scene;
}

static contact_site free_site(void)
{
    return (contact_site){.node = 0, .other = -1, .previous = -1, .next = -1, .behind = {-1, -1}};
}

static contact_site closed_site(dem_index feature, int sign)
{
    contact_site site = free_site();
    site.n_closed = 1;
    site.closed[0] = (contact_touch){.feature = feature, .sign = sign};
    return site;
}

static contact_site held_site(void)
{
    contact_site site = closed_site(0, 1);
    site.n_closed = 2;
    site.closed[1] = (contact_touch){.feature = 1, .sign = 1};
    site.closed[0].held = site.closed[1].held = true;
    return site;
}

/* State of one node and the forces in its contacts. */
typedef struct node_state {
    double x[2], v[2];
    reaction force[2];
} node_state;

static void check_guards(const contact_scene *world, const contact_site *site, const node_state *s,
                         const double expected[SITE_GUARDS])
{
    double guards[SITE_GUARDS] = {77.0, 77.0, 77.0, 77.0};
    site_guards(world, site, s->force, s->x, s->v, guards);
    for (int k = 0; k < SITE_GUARDS; k++) assert_close(guards[k], expected[k], 1e-13);
}

/* ---- guards of a node ---- */

static void check_free(const contact_scene *world, const contact_site *site, double x, double y, double guard)
{
    const node_state s = {{x, y}, {0.0, 0.0}, {{0.0, 0.0}, {0.0, 0.0}}};
    check_guards(world, site, &s, (double[]){guard, 1.0, 1.0, 1.0});
}

static void a_free_site_watches_its_gap_down_to_the_skin(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, room, 2);
    const contact_site site = free_site();
    check_free(world, &site, 1.0, 0.25, 0.25 + skin);
    check_free(world, &site, 1.0, 0.0, skin);
    check_free(world, &site, 1.0, -skin, 0.0);
    check_free(world, &site, 1.0, -0.1, -0.1 + skin);
    check_free(world, &site, 5.0, 2.5, 0.5 + skin); /* the ceiling is nearer */
    scene_close(&s);
}

static void far_from_everything_its_guard_is_finite(void **state)
{
    scene s, empty;
    (void)state;
    const contact_scene *world = open_node(&s, room, 2), *nothing = open_node(&empty, NULL, 0);
    const contact_site site = free_site();
    check_free(world, &site, -50.0, 1.0, 1.0 + skin);
    check_free(nothing, &site, 0.0, 0.0, 1.0 + skin);
    scene_close(&s);
    scene_close(&empty);
}

static void a_site_behind_an_obstacle_does_not_see_it(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, room, 2);
    contact_site site = free_site();
    site.behind[0] = 0;
    check_free(world, &site, 3.5, -0.2, 1.0 + skin);
    check_free(world, &site, 3.5, 2.5, 0.5 + skin);
    site = closed_site(1, 1);
    site.behind[0] = 0;
    const node_state at = {{3.5, 3.0}, {0.0, 0.0}, {{-20.0, 0.0}, {0.0, 0.0}}};
    check_guards(world, &site, &at, (double[]){1.0 + skin, -20.0, 0.5 + skin, 1.0});
    scene_close(&s);
}

/* The reaction, the nearer end, the other obstacle above: min(3 - 0, 1) + skin; 3 m to the ceiling count as 1. Without
 * friction the speed of sliding does not matter. */
static void a_sliding_site_watches_reaction_end_and_other_obstacles(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, room, 2);
    const contact_site on_floor = closed_site(0, 1), on_ceiling = closed_site(1, 1);
    const double x[5] = {1.5, 3.75, 4.5, 3.5, 4.0}, y[5] = {0.0, 0.0, 0.0, 2.75, 3.0};
    const double expected[5][SITE_GUARDS] = {{1.0 + skin, 20.0, 1.5 + skin, 1.0},
                                             {1.0 + skin, 20.0, 0.25 + skin, 1.0},
                                             {1.0 + skin, 20.0, -0.5 + skin, 1.0},
                                             {0.25 + skin, 20.0, 0.5 + skin, 1.0},
                                             {1.0 + skin, 20.0, 1.0 + skin, 1.0}};
    for (int k = 0; k < 5; k++) {
        const node_state at = {{x[k], y[k]}, {-3.0, 0.0}, {{20.0, 0.0}, {-7.0, -7.0}}};
        check_guards(world, k == 4 ? &on_ceiling : &on_floor, &at, expected[k]);
    }
    scene_close(&s);
}

/* The tangent of the floor is (1, 0). */
static void a_site_that_slides_with_friction_watches_its_speed_too(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, &rough, 1);
    const contact_site along = closed_site(0, 1), against = closed_site(0, -1);
    const node_state forwards = {{1.5, 0.0}, {0.75, 0.25}, {{20.0, -10.0}, {0.0, 0.0}}};
    const node_state backwards = {{3.0, 0.0}, {-0.5, 0.0}, {{20.0, 10.0}, {0.0, 0.0}}};
    check_guards(world, &along, &forwards, (double[]){1.0 + skin, 20.0, 1.5 + skin, 0.75});
    check_guards(world, &along, &backwards, (double[]){1.0 + skin, 20.0, 1.0 + skin, -0.5});
    check_guards(world, &against, &forwards, (double[]){1.0 + skin, 20.0, 1.5 + skin, -0.75});
    check_guards(world, &against, &backwards, (double[]){1.0 + skin, 20.0, 1.0 + skin, 0.5});
    scene_close(&s);
}

/* mu = 1/2: 20 N allow 10 N, either way. The end of the floor is of no matter to it. */
static void a_sticking_site_watches_its_grip(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, &rough, 1);
    const contact_site site = closed_site(0, 0);
    const double tangent[4] = {3.0, -3.0, 12.5, -12.5}, grip[4] = {7.0, 7.0, -2.5, -2.5};
    for (int k = 0; k < 4; k++) {
        const node_state at = {{4.5, 0.0}, {0.0, 0.0}, {{20.0, tangent[k]}, {-7.0, -7.0}}};
        check_guards(world, &site, &at, (double[]){1.0 + skin, 20.0, grip[k], 1.0});
    }
    scene_close(&s);
}

static void a_held_site_watches_both_reactions(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, &groove, 1);
    const contact_site site = held_site();
    const node_state first = {{0.0, 0.0}, {0.0, 0.0}, {{3.0, 0.0}, {14.0, 0.0}}};
    const node_state second = {{0.0, 0.0}, {0.0, 0.0}, {{14.0, 0.0}, {-2.0, 0.0}}};
    check_guards(world, &site, &first, (double[]){1.0 + skin, 3.0, 1.0, 1.0});
    check_guards(world, &site, &second, (double[]){1.0 + skin, -2.0, 1.0, 1.0});
    scene_close(&s);
}

static void only_what_sticks_by_friction_has_a_grip(void **state)
{
    scene s;
    const reaction force = {20.0, -4.0};
    (void)state;
    const contact_scene *world = open_node(&s, &rough, 1);
    const contact_site sticks = closed_site(0, 0), slides = closed_site(0, 1), held = held_site();
    assert_close(site_grip(world, &sticks, 0, &force), 6.0, 1e-14);
    assert_true(isinf(site_grip(world, &slides, 0, &force)) != 0);
    assert_true(isinf(site_grip(world, &held, 0, &force)) != 0);
    scene_close(&s);
}

static bool turns(const contact_scene *world, int sign, double speed)
{
    const contact_site site = closed_site(0, sign);
    const double x[2] = {1.0, 0.0}, v[2] = {speed, 0.0};
    const touch_frame f = touch_frame_at(world, &site, 0, x, v);
    return site_turns(world, &site, 0, &f);
}

static void what_slides_with_friction_turns_when_it_goes_the_other_way(void **state)
{
    scene s, smooth;
    (void)state;
    const contact_scene *world = open_node(&s, &rough, 1), *without = open_node(&smooth, room, 1);
    assert_false(turns(world, 1, 1e-6));
    assert_false(turns(world, 1, 0.0));
    assert_true(turns(world, 1, -1e-6));
    assert_false(turns(world, -1, -1e-6));
    assert_true(turns(world, -1, 1e-6));
    assert_false(turns(world, 0, 1e-6));
    assert_false(turns(without, 1, -1.0));
    scene_close(&s);
    scene_close(&smooth);
}

/* ---- ends and what is due ---- */

static int end_passed(const contact_scene *world, double x, double vx)
{
    const contact_site site = closed_site(0, 1);
    const double at[2] = {x, 0.0}, v[2] = {vx, 0.0};
    return site_end_passed(world, &site, 0, at, v);
}

static void an_end_is_passed_by_the_skin_heading_out(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, room, 2);
    assert_int_equal(end_passed(world, 2.0, 5.0), 0);
    assert_int_equal(end_passed(world, 4.0 + 0.99 * skin, 1.0), 0);
    assert_int_equal(end_passed(world, 4.0 + 1.01 * skin, 1.0), 1);
    assert_int_equal(end_passed(world, 4.1, 1.0), 1);
    assert_int_equal(end_passed(world, 4.1, -1.0), 0);
    assert_int_equal(end_passed(world, -1.01 * skin, -1.0), -1);
    assert_int_equal(end_passed(world, -0.1, -1.0), -1);
    assert_int_equal(end_passed(world, -0.1, 1.0), 0);
    scene_close(&s);
}

static void at_rest_the_force_tells_where_it_heads(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, room, 2);
    double *gravity = s.c.sites.scene.rule.load.gravity;
    assert_int_equal(end_passed(world, 4.0 + 1.01 * skin, 0.0), 0);
    gravity[0] = 1.0;
    assert_int_equal(end_passed(world, 4.0 + 1.01 * skin, 0.0), 1);
    assert_int_equal(end_passed(world, -1.01 * skin, 0.0), 0);
    gravity[0] = -1.0;
    assert_int_equal(end_passed(world, 4.0 + 1.01 * skin, 0.0), 0);
    assert_int_equal(end_passed(world, -1.01 * skin, 0.0), -1);
    scene_close(&s);
}

static void what_sticks_passes_no_end(void **state)
{
    scene s;
    const double at[2] = {4.5, 0.0}, v[2] = {1.0, 0.0};
    (void)state;
    const contact_scene *world = open_node(&s, &rough, 1);
    const contact_site sticks = closed_site(0, 0), slides = closed_site(0, 1);
    assert_int_equal(site_end_passed(world, &sticks, 0, at, v), 0);
    assert_int_equal(site_end_passed(world, &slides, 0, at, v), 1);
    scene_close(&s);
}

static bool due(const contact_scene *world, const contact_site *site, const node_state *s)
{
    return site_due(world, site, s->force, s->x, s->v);
}

static void a_sliding_site_is_due_when_pulled_at_an_end_or_on_another_obstacle(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, room, 2);
    const contact_site site = closed_site(0, 1);
    node_state at = {{2.0, 0.0}, {1.0, 0.0}, {{20.0, 0.0}, {0.0, 0.0}}};
    assert_false(due(world, &site, &at));
    at.force[0].normal = 0.0;
    assert_true(due(world, &site, &at));
    at.force[0].normal = 1e-9;
    assert_false(due(world, &site, &at));
    at.x[0] = 4.0 + 1.01 * skin;
    assert_true(due(world, &site, &at));
    at.v[0] = -1.0;
    assert_false(due(world, &site, &at));
    at.x[0] = 3.5;
    at.x[1] = 3.0 + 1.01 * skin;
    assert_true(due(world, &site, &at));
    at.x[1] = 3.0 + 0.99 * skin;
    assert_false(due(world, &site, &at));
    scene_close(&s);
}

static void with_friction_a_site_is_due_when_it_turns_back_or_loses_its_grip(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, &rough, 1);
    const contact_site slides = closed_site(0, 1), sticks = closed_site(0, 0);
    node_state at = {{2.0, 0.0}, {1e-3, 0.0}, {{20.0, -10.0}, {0.0, 0.0}}};
    assert_false(due(world, &slides, &at));
    at.v[0] = -1e-3;
    assert_true(due(world, &slides, &at));
    at.v[0] = 0.0;
    at.force[0].tangent = -9.99;
    assert_false(due(world, &sticks, &at));
    at.force[0].tangent = -10.01;
    assert_true(due(world, &sticks, &at));
    at.force[0].tangent = 10.01;
    assert_true(due(world, &sticks, &at));
    scene_close(&s);
}

static void a_held_site_is_due_when_either_reaction_ceases(void **state)
{
    scene s;
    (void)state;
    const contact_scene *world = open_node(&s, &groove, 1);
    const contact_site site = held_site();
    node_state at = {{0.0, 0.0}, {0.0, 0.0}, {{1.0, 0.0}, {1.0, 0.0}}};
    assert_false(due(world, &site, &at));
    at.force[0].normal = -0.01;
    assert_true(due(world, &site, &at));
    at.force[0].normal = 1.0;
    at.force[1].normal = -0.01;
    assert_true(due(world, &site, &at));
    scene_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_free_site_watches_its_gap_down_to_the_skin),
        cmocka_unit_test(far_from_everything_its_guard_is_finite),
        cmocka_unit_test(a_site_behind_an_obstacle_does_not_see_it),
        cmocka_unit_test(a_sliding_site_watches_reaction_end_and_other_obstacles),
        cmocka_unit_test(a_site_that_slides_with_friction_watches_its_speed_too),
        cmocka_unit_test(a_sticking_site_watches_its_grip),
        cmocka_unit_test(a_held_site_watches_both_reactions),
        cmocka_unit_test(only_what_sticks_by_friction_has_a_grip),
        cmocka_unit_test(what_slides_with_friction_turns_when_it_goes_the_other_way),
        cmocka_unit_test(an_end_is_passed_by_the_skin_heading_out),
        cmocka_unit_test(at_rest_the_force_tells_where_it_heads),
        cmocka_unit_test(what_sticks_passes_no_end),
        cmocka_unit_test(a_sliding_site_is_due_when_pulled_at_an_end_or_on_another_obstacle),
        cmocka_unit_test(with_friction_a_site_is_due_when_it_turns_back_or_loses_its_grip),
        cmocka_unit_test(a_held_site_is_due_when_either_reaction_ceases),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
