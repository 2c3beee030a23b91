/* SPDX-License-Identifier: BSD-3-Clause */
/* candidate.c: gaps and root functions of one contact candidate in each of its states, and what is due. Numbers are
 * worked out by hand; tolerances of 1e-15 to 1e-13 are rounding. */
#include "obstacle/point_gap.h"
#include "unit/contact/scene_fixture.h"

static const double penetration_tolerance = 1e-3;

/* A floor of 4 m and, 3 m above its end, a ceiling; bodies live between them. */
static const double floor_points[4] = {0.0, 0.0, 4.0, 0.0}, ceiling_points[4] = {6.0, 3.0, 3.0, 3.0};
static const dem_obstacle room[2] = {
    {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor_points, .restitution = 0.5},
    {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = ceiling_points, .restitution = 0.5}};
static const dem_obstacle rough =
    SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .friction = 0.5, .friction_law = DEM_FRICTION_COULOMB);

/* A groove of 90 degrees with its bottom in the origin. */
static const double groove_points[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0};
static const dem_obstacle groove = SIZED(dem_obstacle, .n_points = 3, .points = groove_points, .restitution = 0.0);

static void set_rule(scene *s)
{
    s->c.set.scene.rule.penetration_tolerance = penetration_tolerance;
    s->c.set.scene.rule.max_step = 0.1;
}

/* One node of 2 kg. */
static const contact_scene *open_node(scene *s, const dem_obstacle *obstacles, dem_index n)
{
    const double x[2] = {1.0, 1.0}, mass = 2.0;
    scene_open(s, 1, x, &mass, 0, NULL, obstacles, n);
    set_rule(s);
    return &s->c.set.scene;
}

static contact_candidate free_candidate(void)
{
    return (contact_candidate){.node = 0, .other = -1, .previous = -1, .next = -1, .behind = {-1, -1}};
}

static contact_candidate closed_candidate(dem_index feature, int sign)
{
    contact_candidate candidate = free_candidate();
    candidate.n_closed = 1;
    candidate.closed[0] = (contact_point){.feature = feature, .slide = sign};
    return candidate;
}

static contact_candidate held_candidate(void)
{
    contact_candidate candidate = closed_candidate(0, 1);
    candidate.n_closed = 2;
    candidate.closed[1] = (contact_point){.feature = 1, .slide = 1};
    candidate.closed[0].held = candidate.closed[1].held = true;
    return candidate;
}

/* State of one node and the forces in its contacts. */
typedef struct node_state {
    double x[2], v[2];
    contact_force force[2];
} node_state;

static void check_roots(const contact_scene *world, const contact_candidate *candidate, const node_state *s,
                        const double expected[CANDIDATE_ROOTS])
{
    double roots[CANDIDATE_ROOTS] = {77.0, 77.0, 77.0, 77.0};
    candidate_root_functions(world, candidate, s->force, (scene_state){0.0, s->x, s->v}, roots);
    for (int k = 0; k < CANDIDATE_ROOTS; k++) assert_close(roots[k], expected[k], 1e-13);
}

/* ---- root functions of a node ---- */

static void check_free(const contact_scene *world, const contact_candidate *candidate, double x, double y,
                       double expected)
{
    const node_state s = {{x, y}, {0.0, 0.0}, {{0.0, 0.0}, {0.0, 0.0}}};
    check_roots(world, candidate, &s, (double[]){expected, 1.0, 1.0, 1.0});
}

TEST(a_free_candidate_has_a_root_at_the_penetration_tolerance)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, room, 2);
    const contact_candidate candidate = free_candidate();
    check_free(world, &candidate, 1.0, 0.25, 0.25 + penetration_tolerance);
    check_free(world, &candidate, 1.0, 0.0, penetration_tolerance);
    check_free(world, &candidate, 1.0, -penetration_tolerance, 0.0);
    check_free(world, &candidate, 1.0, -0.1, -0.1 + penetration_tolerance);
    check_free(world, &candidate, 5.0, 2.5, 0.5 + penetration_tolerance); /* the ceiling is nearer */
}

TEST(far_from_everything_its_root_function_is_finite)
{
    CLEANUP(scene_close) scene s, empty;
    const contact_scene *world = open_node(&s, room, 2), *nothing = open_node(&empty, NULL, 0);
    const contact_candidate candidate = free_candidate();
    check_free(world, &candidate, -50.0, 1.0, 1.0 + penetration_tolerance);
    check_free(nothing, &candidate, 0.0, 0.0, 1.0 + penetration_tolerance);
}

TEST(a_candidate_behind_an_obstacle_does_not_see_it)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, room, 2);
    contact_candidate candidate = free_candidate();
    candidate.behind[0] = 0;
    check_free(world, &candidate, 3.5, -0.2, 1.0 + penetration_tolerance);
    check_free(world, &candidate, 3.5, 2.5, 0.5 + penetration_tolerance);
    candidate = closed_candidate(1, 1);
    candidate.behind[0] = 0;
    const node_state at = {{3.5, 3.0}, {0.0, 0.0}, {{-20.0, 0.0}, {0.0, 0.0}}};
    check_roots(world, &candidate, &at,
                (double[]){1.0 + penetration_tolerance, -20.0, 0.5 + penetration_tolerance, 1.0});
}

/* The reaction, the nearer end, the other obstacle above: min(3 - 0, 1) + penetration tolerance; 3 m to the ceiling
 * count as 1. Without friction the speed of sliding does not matter. */
TEST(a_sliding_candidate_has_root_functions_of_force_end_and_other_obstacles)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, room, 2);
    const contact_candidate on_floor = closed_candidate(0, 1), on_ceiling = closed_candidate(1, 1);
    const double x[5] = {1.5, 3.75, 4.5, 3.5, 4.0}, y[5] = {0.0, 0.0, 0.0, 2.75, 3.0};
    const double expected[5][CANDIDATE_ROOTS] = {{1.0 + penetration_tolerance, 20.0, 1.5 + penetration_tolerance, 1.0},
                                                 {1.0 + penetration_tolerance, 20.0, 0.25 + penetration_tolerance, 1.0},
                                                 {1.0 + penetration_tolerance, 20.0, -0.5 + penetration_tolerance, 1.0},
                                                 {0.25 + penetration_tolerance, 20.0, 0.5 + penetration_tolerance, 1.0},
                                                 {1.0 + penetration_tolerance, 20.0, 1.0 + penetration_tolerance, 1.0}};
    for (int k = 0; k < 5; k++) {
        const node_state at = {{x[k], y[k]}, {-3.0, 0.0}, {{20.0, 0.0}, {-7.0, -7.0}}};
        check_roots(world, k == 4 ? &on_ceiling : &on_floor, &at, expected[k]);
    }
}

/* The tangent of the floor is (1, 0). */
TEST(a_candidate_that_slides_with_friction_has_one_of_its_speed_too)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, &rough, 1);
    const contact_candidate along = closed_candidate(0, 1), against = closed_candidate(0, -1);
    const node_state forwards = {{1.5, 0.0}, {0.75, 0.25}, {{20.0, -10.0}, {0.0, 0.0}}};
    const node_state backwards = {{3.0, 0.0}, {-0.5, 0.0}, {{20.0, 10.0}, {0.0, 0.0}}};
    check_roots(world, &along, &forwards,
                (double[]){1.0 + penetration_tolerance, 20.0, 1.5 + penetration_tolerance, 0.75});
    check_roots(world, &along, &backwards,
                (double[]){1.0 + penetration_tolerance, 20.0, 1.0 + penetration_tolerance, -0.5});
    check_roots(world, &against, &forwards,
                (double[]){1.0 + penetration_tolerance, 20.0, 1.5 + penetration_tolerance, -0.75});
    check_roots(world, &against, &backwards,
                (double[]){1.0 + penetration_tolerance, 20.0, 1.0 + penetration_tolerance, 0.5});
}

/* mu = 1/2: 20 N allow 10 N, either way. The end of the floor is of no matter to it. */
TEST(a_sticking_candidate_has_a_root_function_of_its_grip)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, &rough, 1);
    const contact_candidate candidate = closed_candidate(0, 0);
    const double tangent[4] = {3.0, -3.0, 12.5, -12.5}, grip[4] = {7.0, 7.0, -2.5, -2.5};
    for (int k = 0; k < 4; k++) {
        const node_state at = {{4.5, 0.0}, {0.0, 0.0}, {{20.0, tangent[k]}, {-7.0, -7.0}}};
        check_roots(world, &candidate, &at, (double[]){1.0 + penetration_tolerance, 20.0, grip[k], 1.0});
    }
}

TEST(a_held_candidate_has_one_of_the_lesser_normal_force)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, &groove, 1);
    const contact_candidate candidate = held_candidate();
    const node_state first = {{0.0, 0.0}, {0.0, 0.0}, {{3.0, 0.0}, {14.0, 0.0}}};
    const node_state second = {{0.0, 0.0}, {0.0, 0.0}, {{14.0, 0.0}, {-2.0, 0.0}}};
    check_roots(world, &candidate, &first, (double[]){1.0 + penetration_tolerance, 3.0, 1.0, 1.0});
    check_roots(world, &candidate, &second, (double[]){1.0 + penetration_tolerance, -2.0, 1.0, 1.0});
}

static double grip(const contact_scene *world, const contact_candidate *candidate)
{
    const contact_force force = {20.0, -4.0};
    const double x[2] = {1.0, 0.0}, v[2] = {0.0, 0.0};
    const contact_frame f = contact_frame_at(world, candidate, 0, (scene_state){0.0, x, v});
    return candidate_grip(world, candidate, 0, &f, &force, x);
}

TEST(only_what_sticks_by_friction_has_a_grip)
{
    CLEANUP(scene_close) scene s, t;
    const contact_scene *world = open_node(&s, &rough, 1), *corner = open_node(&t, &groove, 1);
    const contact_candidate sticks = closed_candidate(0, 0), slides = closed_candidate(0, 1), held = held_candidate();
    assert_close(grip(world, &sticks), 6.0, 1e-14);
    assert_true(isinf(grip(world, &slides)) != 0);
    assert_true(isinf(grip(corner, &held)) != 0);
}

static bool turns(const contact_scene *world, int sign, double speed)
{
    const contact_candidate candidate = closed_candidate(0, sign);
    const double x[2] = {1.0, 0.0}, v[2] = {speed, 0.0};
    const contact_frame f = contact_frame_at(world, &candidate, 0, (scene_state){0.0, x, v});
    return candidate_turns(world, &candidate, 0, &f, v);
}

TEST(what_slides_with_friction_turns_when_it_goes_the_other_way)
{
    CLEANUP(scene_close) scene s, smooth;
    const contact_scene *world = open_node(&s, &rough, 1), *without = open_node(&smooth, room, 1);
    assert_false(turns(world, 1, 1e-6));
    assert_false(turns(world, 1, 0.0));
    assert_true(turns(world, 1, -1e-6));
    assert_false(turns(world, -1, -1e-6));
    assert_true(turns(world, -1, 1e-6));
    assert_false(turns(world, 0, 1e-6));
    assert_false(turns(without, 1, -1.0));
}

/* ---- ends and what is due ---- */

static int end_passed(const contact_scene *world, double x, double vx)
{
    const contact_candidate candidate = closed_candidate(0, 1);
    const double at[2] = {x, 0.0}, v[2] = {vx, 0.0};
    return candidate_end_passed(world, &candidate, 0, (scene_state){0.0, at, v});
}

TEST(an_end_is_passed_by_the_penetration_tolerance_heading_out)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, room, 2);
    assert_int_equal(end_passed(world, 2.0, 5.0), 0);
    assert_int_equal(end_passed(world, 4.0 + 0.99 * penetration_tolerance, 1.0), 0);
    assert_int_equal(end_passed(world, 4.0 + 1.01 * penetration_tolerance, 1.0), 1);
    assert_int_equal(end_passed(world, 4.1, 1.0), 1);
    assert_int_equal(end_passed(world, 4.1, -1.0), 0);
    assert_int_equal(end_passed(world, -1.01 * penetration_tolerance, -1.0), -1);
    assert_int_equal(end_passed(world, -0.1, -1.0), -1);
    assert_int_equal(end_passed(world, -0.1, 1.0), 0);
}

TEST(at_rest_the_force_tells_where_it_heads)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, room, 2);
    double *gravity = s.acting.gravity;
    assert_int_equal(end_passed(world, 4.0 + 1.01 * penetration_tolerance, 0.0), 0);
    gravity[0] = 1.0;
    assert_int_equal(end_passed(world, 4.0 + 1.01 * penetration_tolerance, 0.0), 1);
    assert_int_equal(end_passed(world, -1.01 * penetration_tolerance, 0.0), 0);
    gravity[0] = -1.0;
    assert_int_equal(end_passed(world, 4.0 + 1.01 * penetration_tolerance, 0.0), 0);
    assert_int_equal(end_passed(world, -1.01 * penetration_tolerance, 0.0), -1);
}

TEST(what_sticks_passes_no_end)
{
    CLEANUP(scene_close) scene s;
    const double at[2] = {4.5, 0.0}, v[2] = {1.0, 0.0};
    const contact_scene *world = open_node(&s, &rough, 1);
    const contact_candidate sticks = closed_candidate(0, 0), slides = closed_candidate(0, 1);
    assert_int_equal(candidate_end_passed(world, &sticks, 0, (scene_state){0.0, at, v}), 0);
    assert_int_equal(candidate_end_passed(world, &slides, 0, (scene_state){0.0, at, v}), 1);
}

static bool due(const contact_scene *world, const contact_candidate *candidate, const node_state *s)
{
    return candidate_due(world, candidate, s->force, (scene_state){0.0, s->x, s->v});
}

TEST(a_sliding_candidate_is_due_when_pulled_at_an_end_or_on_another_obstacle)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, room, 2);
    const contact_candidate candidate = closed_candidate(0, 1);
    node_state at = {{2.0, 0.0}, {1.0, 0.0}, {{20.0, 0.0}, {0.0, 0.0}}};
    assert_false(due(world, &candidate, &at));
    at.force[0].normal = 0.0;
    assert_true(due(world, &candidate, &at));
    at.force[0].normal = 1e-9;
    assert_false(due(world, &candidate, &at));
    at.x[0] = 4.0 + 1.01 * penetration_tolerance;
    assert_true(due(world, &candidate, &at));
    at.v[0] = -1.0;
    assert_false(due(world, &candidate, &at));
    at.x[0] = 3.5;
    at.x[1] = 3.0 + 1.01 * penetration_tolerance;
    assert_true(due(world, &candidate, &at));
    at.x[1] = 3.0 + 0.99 * penetration_tolerance;
    assert_false(due(world, &candidate, &at));
}

TEST(with_friction_a_candidate_is_due_when_it_turns_back_or_loses_its_grip)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, &rough, 1);
    const contact_candidate slides = closed_candidate(0, 1), sticks = closed_candidate(0, 0);
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
}

TEST(a_held_candidate_is_due_when_either_normal_force_ceases)
{
    CLEANUP(scene_close) scene s;
    const contact_scene *world = open_node(&s, &groove, 1);
    const contact_candidate candidate = held_candidate();
    node_state at = {{0.0, 0.0}, {0.0, 0.0}, {{1.0, 0.0}, {1.0, 0.0}}};
    assert_false(due(world, &candidate, &at));
    at.force[0].normal = -0.01;
    assert_true(due(world, &candidate, &at));
    at.force[0].normal = 1.0;
    at.force[1].normal = -0.01;
    assert_true(due(world, &candidate, &at));
}

/* ---- edges ---- */

/* A roof with its ridge in the origin, and one beside it with its ridge at (0.75, -0.25); the former with friction. */
static const double roof_points[6] = {-4.0, -4.0, 0.0, 0.0, 0.5, -0.5},
                    beside_points[6] = {0.5, -0.5, 0.75, -0.25, 4.0, -3.5};
static const dem_obstacle roof = {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = roof_points},
                          rough_roof = SIZED(dem_obstacle, .n_points = 3, .points = roof_points, .friction = 0.5,
                                             .friction_law = DEM_FRICTION_COULOMB);
static const dem_obstacle roofs[2] = {{.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = roof_points},
                                      {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = beside_points}};

static const double masses[3] = {2.0, 2.0, 2.0};

/* The lower edge, from node 0 at (x, y) 2 m along. */
static contact_candidate *open_edge(scene *s, double x, double y, const dem_obstacle *obstacles, dem_index n)
{
    scene_open_triangle(s, masses, x, y, obstacles, n);
    set_rule(s);
    return &s->c.set.list[scene_edge(s, 0, 1)];
}

static void check_edge(scene *s, const contact_candidate *edge, const double expected[CANDIDATE_ROOTS])
{
    const contact_force force[2] = {{20.0, -4.0}, {8.0, 6.0}};
    double roots[CANDIDATE_ROOTS];
    candidate_root_functions(&s->c.set.scene, edge, force, (scene_state){0.0, s->y, scene_v(s)}, roots);
    for (int k = 0; k < CANDIDATE_ROOTS; k++) assert_close(roots[k], expected[k], 1e-13);
}

static void move_all(scene *s, double x, double y, double u)
{
    scene_put(s, 0, x, y, u, 0.0);
    scene_put(s, 1, x + 2.0, y, u, 0.0);
    scene_put(s, 2, x + 1.0, y + 1.0, u, 0.0);
}

/* Vertices are looked at 1 m in front of it, half its length, and half a metre behind; along it up to the penetration
 * tolerance beyond its ends. */
TEST(a_free_edge_has_a_root_function_of_the_gap_to_the_convex_vertex_below_it)
{
    const double x[10] = {-1.5,
                          -1.5,
                          -1.5,
                          -1.5,
                          0.99 * penetration_tolerance,
                          1.01 * penetration_tolerance,
                          -2.0 - 0.99 * penetration_tolerance,
                          -2.0 - 1.01 * penetration_tolerance,
                          -1.0,
                          -1.0};
    const double y[10] = {0.25, 0.0, -penetration_tolerance, 1.01, 0.25, 0.25, 0.25, 0.25, -0.51, -0.49};
    const double gap[10] = {0.25, 0.0, -penetration_tolerance, 1.0, 0.25, 1.0, 0.25, 1.0, 1.0, -0.49};
    CLEANUP(scene_close) scene s;
    const contact_candidate *edge = open_edge(&s, -1.5, 0.25, &roof, 1);
    for (int k = 0; k < 10; k++) {
        move_all(&s, x[k], y[k], 0.0);
        vec2_put(s.y, 2, (vec2){x[k] + 1.0, 10.0}); /* deep inside, the other edges are further */
        check_edge(&s, edge, (double[]){gap[k] + penetration_tolerance, 1.0, 1.0, 1.0});
    }
}

/* From (-1.5, 0.5) to (0.1, 1.7), 2 m long at a slope of 3 to 4: the ridge is 0.8 * 1.625 m away and out of reach; once
 * the edge is 1.125 m lower it is 0.8 * 0.5 m. */
TEST(the_gap_of_a_sloping_edge_is_along_its_normal)
{
    CLEANUP(scene_close) scene s;
    const contact_candidate *edge = open_edge(&s, -1.5, 0.25, &roof, 1);
    scene_put(&s, 0, -1.5, 0.5 - 1.125, 0.0, 0.0);
    scene_put(&s, 1, 0.1, 1.7 - 1.125, 0.0, 0.0);
    const candidate_positions spot = candidate_place(edge, 0.0, s.y);
    const contact_gap gap = candidate_gap(&s.c.set.scene, edge, &spot);
    assert_close(gap.distance, 0.8 * (-0.625 + 0.75 * 1.5), 1e-15);
    assert_close(gap.place, (0.8 * 1.5 + 0.6 * 0.625) / 2.0, 1e-15);
    assert_close(gap.normal.x, -0.6, 1e-15);
    assert_close(gap.normal.y, 0.8, 1e-15);
    assert_int_equal(gap.feature, 0);
    assert_int_equal(surface_segment(&s.c.set.scene, contact_point_feature(edge, gap.feature)), 0);
}

/* On the ridge of the first roof 0.5 m from its end; the second one's is 0.25 m below it. */
TEST(a_closed_edge_has_root_functions_of_force_end_and_other_vertices)
{
    scene s, rubbed;
    contact_candidate *edge = open_edge(&s, -1.5, 0.0, roofs, 2);
    edge->n_closed = 1;
    edge->closed[0] = (contact_point){.feature = 0, .slide = 1};
    move_all(&s, -1.5, 0.0, 0.75);
    check_edge(&s, edge,
               (double[]){1.0 + penetration_tolerance, 20.0, 0.5 + penetration_tolerance,
                          1.0}); /* the second ridge is beyond its end */
    move_all(&s, -0.25, 0.0, 0.75);
    check_edge(&s, edge, (double[]){0.25 + penetration_tolerance, 20.0, 0.25 + penetration_tolerance, 1.0});
    move_all(&s, 0.125, 0.0, 0.75);
    check_edge(&s, edge, (double[]){0.25 + penetration_tolerance, 20.0, -0.125 + penetration_tolerance, 1.0});
    scene_close(&s);
    edge = open_edge(&rubbed, -1.5, 0.0, &rough_roof, 1);
    edge->n_closed = 1;
    edge->closed[0] = (contact_point){.feature = 0, .slide = -1};
    move_all(&rubbed, -1.5, 0.0, 0.75);
    check_edge(&rubbed, edge, (double[]){1.0 + penetration_tolerance, 20.0, 0.5 + penetration_tolerance, -0.75});
    edge->closed[0] = (contact_point){.feature = 0, .slide = 0, .place = 0.75};
    check_edge(&rubbed, edge, (double[]){1.0 + penetration_tolerance, 20.0, 6.0, 1.0}); /* 0.5 * 20 - 4 */
    scene_close(&rubbed);
}

TEST(an_edge_on_two_vertices_has_those_of_the_lesser_of_each_and_no_gap)
{
    CLEANUP(scene_close) scene s;
    contact_candidate *edge = open_edge(&s, -0.25, 0.0, roofs, 2);
    edge->n_closed = 2;
    edge->closed[0] = (contact_point){.feature = 0, .slide = 1};
    edge->closed[1] = (contact_point){.feature = 1, .slide = 1};
    check_edge(&s, edge, (double[]){1.0 + penetration_tolerance, 8.0, 0.25 + penetration_tolerance, 1.0});
    move_all(&s, -1.15, 0.0, 0.0); /* the second is 0.1 m from the end, the first 0.85 m */
    check_edge(&s, edge, (double[]){1.0 + penetration_tolerance, 8.0, 0.1 + penetration_tolerance, 1.0});
}

/* A body that goes right takes its start to the vertex. */
TEST(a_vertex_passes_an_edges_end_against_the_motion_of_the_body)
{
    const double x[6] = {1.01 * penetration_tolerance,        1.01 * penetration_tolerance,
                         0.99 * penetration_tolerance,        -2.0 - 1.01 * penetration_tolerance,
                         -2.0 - 1.01 * penetration_tolerance, -1.0};
    const double u[6] = {1.0, -1.0, 1.0, -1.0, 1.0, 1.0};
    const int passed[6] = {-1, 0, 0, 1, 0, 0};
    CLEANUP(scene_close) scene s;
    contact_candidate *edge = open_edge(&s, -1.5, 0.0, &roof, 1);
    edge->n_closed = 1;
    edge->closed[0] = (contact_point){.feature = 0, .slide = 1};
    for (int k = 0; k < 6; k++) {
        move_all(&s, x[k], 0.0, u[k]);
        assert_int_equal(candidate_end_passed(&s.c.set.scene, edge, 0, (scene_state){0.0, s.y, scene_v(&s)}),
                         passed[k]);
    }
    s.acting.gravity[0] = 1.0; /* at rest it heads where it is driven */
    for (int k = 0; k < 2; k++) {
        move_all(&s, k == 0 ? 1.01 * penetration_tolerance : -2.0 - 1.01 * penetration_tolerance, 0.0, 0.0);
        assert_int_equal(candidate_end_passed(&s.c.set.scene, edge, 0, (scene_state){0.0, s.y, scene_v(&s)}),
                         k == 0 ? -1 : 0);
    }
}

/* The body's edge from node 1 at (2, 0) to node 2 at (1, 1) falls away by 45 degrees: what is 0.03 m above the lower
 * edge's line is outside where x + y > 2, and inside the body where it is less. */
TEST(a_vertex_round_a_convex_corner_of_the_body_is_not_inside)
{
    const double x[4] = {-1.99, -1.9, -0.01, -0.1}, gap[4] = {1.0, -0.03, 1.0, -0.03};
    CLEANUP(scene_close) scene s;
    contact_candidate *edge = open_edge(&s, -1.5, 0.0, &roof, 1);
    assert_int_equal(edge->next, 2);
    assert_int_equal(edge->previous, 2);
    for (int k = 0; k < 4; k++) {
        move_all(&s, x[k], -0.03, 0.0);
        check_edge(&s, edge, (double[]){gap[k] + penetration_tolerance, 1.0, 1.0, 1.0});
    }
}

TEST(an_edge_whose_node_is_behind_an_obstacle_does_not_see_its_vertices)
{
    CLEANUP(scene_close) scene s;
    contact_candidate *edge = open_edge(&s, -1.5, 0.25, &roof, 1);
    check_edge(&s, edge, (double[]){0.25 + penetration_tolerance, 1.0, 1.0, 1.0});
    for (int k = 0; k < 2; k++) {
        edge->behind[k] = 0;
        check_edge(&s, edge, (double[]){1.0 + penetration_tolerance, 1.0, 1.0, 1.0});
        edge->behind[k] = -1;
    }
}

/* ---- what is clear ---- */

static double uniform(unsigned *seed, double low, double high)
{
    *seed = *seed * 1664525u + 1013904223u; /* Numerical Recipes' generator */
    return low + (high - low) * (*seed >> 8) / 16777216.0;
}

/* A ragged line of 24 points, 0.3 m apart, with ridges of up to 0.3 m; and a plate that hangs above it. */
static void open_ragged(scene *s, unsigned *seed, bool triangle)
{
    double points[48], plate[6] = {3.0, 1.5, 1.5, uniform(seed, 0.9, 1.5), 0.0, 1.5};
    for (int k = 0; k < 24; k++) {
        points[2 * k] = 0.3 * k - 3.0;
        points[2 * k + 1] = uniform(seed, -0.15, 0.15);
    }
    const dem_obstacle ragged[2] = {{.struct_size = sizeof(dem_obstacle), .n_points = 24, .points = points},
                                    {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = plate}};
    if (triangle)
        scene_open_triangle(s, masses, 0.0, 1.0, ragged, 2);
    else
        scene_open(s, 1, (double[]){0.0, 1.0}, masses, 0, NULL, ragged, 2);
    set_rule(s);
}

/* The clearance less the way gone is never more than what is there, but for the margin of ten penetration tolerances
 * by which free ends count as longer; and it is of use: most of what is looked at is decided by it. */
TEST(nothing_is_nearer_to_a_node_than_its_clearance)
{
    unsigned seed = 7;
    int inside = 0;
    for (int k = 0; k < 200; k++) {
        CLEANUP(scene_close) scene s;
        dem_index nearest;
        open_ragged(&s, &seed, false);
        const contact_scene *world = &s.c.set.scene;
        const contact_candidate candidate = free_candidate();
        const double x[2] = {uniform(&seed, -3.5, 4.5), uniform(&seed, 0.1, 1.4)};
        const candidate_positions here = candidate_place(&candidate, 0.0, x);
        const double clear = candidate_clearance(world, &candidate, &here, &nearest) - 10.0 * penetration_tolerance;
        assert_int_equal(
            nearest,
            obstacles_gap(&world->model->obstacles, 0.0, here.a, 10.0 * penetration_tolerance, -1, -1).segment);
        for (int q = 0; q < 50; q++) {
            const double way = uniform(&seed, 0.0, 0.4), angle = uniform(&seed, 0.0, 6.28);
            const vec2 to = {x[0] + way * cos(angle), x[1] + way * sin(angle)};
            const candidate_positions there = {0.0, to, to, to, to};
            assert_true(candidate_gap(world, &candidate, &there).distance >= clear - way - 1e-15 || clear < way);
            inside += way < clear;
        }
    }
    assert_true(inside > 2000);
}

/* The same of an edge that turns and stretches: its ends go different ways. The ridges are steeper than it gets. */
TEST(no_vertex_is_nearer_to_an_edge_than_its_clearance)
{
    unsigned seed = 11;
    int inside = 0;
    for (int k = 0; k < 200; k++) {
        CLEANUP(scene_close) scene s;
        dem_index nearest;
        open_ragged(&s, &seed, true);
        const contact_scene *world = &s.c.set.scene;
        const contact_candidate edge = s.c.set.list[scene_edge(&s, 0, 1)];
        const double x = uniform(&seed, -2.5, 2.0), y = uniform(&seed, 0.2, 0.6), length = uniform(&seed, 0.2, 1.0);
        const double at[6] = {x, y, x + length, y + 0.2 * length * uniform(&seed, -1.0, 1.0), x, y + 0.7};
        const candidate_positions here = candidate_place(&edge, 0.0, at);
        const double clear = candidate_clearance(world, &edge, &here, &nearest);
        for (int q = 0; q < 50; q++) {
            double to[6], way = 0.0;
            for (int c = 0; c < 6; c++) to[c] = at[c] + 0.2 * length * uniform(&seed, -1.0, 1.0);
            for (int i = 0; i < 2; i++) way = fmax(way, vec2_norm(vec2_sub(vec2_at(to, i), vec2_at(at, i))));
            const candidate_positions there = candidate_place(&edge, 0.0, to);
            assert_true(candidate_gap(world, &edge, &there).distance >= clear - way - 1e-15 || clear < way);
            inside += way < clear;
        }
    }
    assert_true(inside > 2000);
}

/* Half the edge's length, 1 m, is as far as is looked; beyond that the distance of its node less its length counts. */
TEST(a_clearance_is_the_distance_to_the_nearest_vertex_or_a_bound_of_it)
{
    const double y[4] = {0.25, 0.9, 1.1, 5.0}, clear[4] = {0.25, 0.9, 1.0, sqrt(27.25) - 2.0};
    CLEANUP(scene_close) scene s;
    dem_index nearest;
    const contact_candidate *edge = open_edge(&s, -1.5, 0.25, &roof, 1);
    for (int k = 0; k < 4; k++) {
        move_all(&s, -1.5, y[k], 0.0);
        const candidate_positions spot = candidate_place(edge, 0.0, s.y);
        assert_close(candidate_clearance(&s.c.set.scene, edge, &spot, &nearest), clear[k], 1e-14);
    }
}

/* The ridge is 0.3 m beyond the end of the edge, and 0.4 m below it. */
TEST(a_vertex_beside_an_edge_is_near_it_though_it_is_no_gap)
{
    CLEANUP(scene_close) scene s;
    const contact_candidate *edge = open_edge(&s, 0.3, 0.4, &roof, 1);
    const candidate_positions spot = candidate_place(edge, 0.0, s.y);
    assert_int_equal(candidate_gap(&s.c.set.scene, edge, &spot).feature, -1);
    assert_true(candidate_around(&s.c.set.scene, edge, &spot, 0.5).feature >= 0);
    assert_false(candidate_around(&s.c.set.scene, edge, &spot, 0.29).feature >= 0);
    assert_false(candidate_around(&s.c.set.scene, edge, &spot, 0.39).feature >= 0);
}
