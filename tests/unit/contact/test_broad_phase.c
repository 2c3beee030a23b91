/* SPDX-License-Identifier: BSD-3-Clause */
/* broad_phase.c: which candidates are inactive, until when, and that they become active in time. */
#include "unit/contact/scene_fixture.h"

#include "contact/automaton_step.h"

static const double penetration_tolerance = scene_penetration_tolerance, masses[4] = {2.0, 2.0, 2.0, 2.0},
                    max_step = 0.01; /* as in scene.h */

static const double floor_points[4] = {-4.0, 0.0, 4.0, 0.0};
static const dem_obstacle plane = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.5);

static const double roof_points[6] = {-4.0, -4.0, 0.0, 0.0, 4.0, -4.0};
static const dem_obstacle roof = SIZED(dem_obstacle, .n_points = 3, .points = roof_points, .restitution = 0.5);

static void open_nodes(scene *s, dem_index n, const double *x)
{
    scene_open(s, n, x, masses, 0, NULL, &plane, 1);
}

/* With the first node, which may touch, at this speed. */
static void look(scene *s, double speed)
{
    double v[8] = {speed};
    broad_phase_update(&s->c.broad_phase, &s->c.set, (scene_state){0.0, s->y, v});
    assert_close(s->c.broad_phase.speed, speed, 0.0);
}

TEST(the_fastest_of_the_nodes_that_may_touch_counts)
{
    const double x[6] = {0.0, 1.0, 1.0, 1.0, 2.0, 1.0};
    const unsigned char fixed[3] = {0, 0, 1};
    CLEANUP(scene_close) scene s;
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = support_lattice(3, x, masses, 2, (dem_index[]){0, 1, 1, 2}, 1.0, 1.0, fixed);
    lattice.flags[0] = 0;
    scene_start(&s, &lattice, &plane, 1);
    scene_put(&s, 0, 0.0, 1.0, 50.0, 0.0);
    scene_put(&s, 1, 1.0, 1.0, 3.0, -4.0);
    assert_close(broad_phase_speed(&s.c.set, scene_v(&s)), 5.0, 1e-15);
}

/* With 10 m/s 1.25 steps' way is 0.125 m; the margins of free ends, twenty penetration tolerances, go off what is
 * clear. */
TEST(a_candidate_further_away_than_a_step_and_a_quarter_goes_is_inactive)
{
    const double far = 0.125 + 20.0 * penetration_tolerance, x[6] = {0.0, 0.99 * far, 1.0, 1.01 * far, 2.0, 3.0};
    CLEANUP(scene_close) scene s;
    open_nodes(&s, 3, x);
    look(&s, 10.0);
    assert_int_equal(s.c.broad_phase.n, 1);
    assert_int_equal(s.c.broad_phase.active[0], 0);
    for (dem_index k = 0; k < 3; k++) {
        assert_int_equal(s.c.set.list[k].clearance.inactive, k > 0);
        assert_close(s.c.set.list[k].clearance.active_from, x[2 * k + 1] - 20.0 * penetration_tolerance, 1e-15);
    }
}

TEST(what_is_closed_is_always_active)
{
    const double x[4] = {0.0, 0.0, 1.0, 3.0};
    CLEANUP(scene_close) scene s;
    open_nodes(&s, 2, x);
    assert_ok(scene_take_up(&s));
    assert_int_equal(s.c.broad_phase.n, 1);
    assert_int_equal(s.c.broad_phase.active[0], 0);
}

/* The node falls from 3 m while nothing looks at it until the way that the fastest may have gone is enough. */
TEST(an_inactive_candidate_becomes_active_when_the_bodies_may_have_gone_far_enough)
{
    const double x[4] = {0.0, 3.0, 2.0, 9.0};
    CLEANUP(scene_close) scene s;
    open_nodes(&s, 2, x);
    look(&s, 1.0);
    const contact_candidate *candidate = &s.c.set.list[0];
    assert_true(candidate->clearance.inactive);
    s.c.broad_phase.travelled = 2.9;
    s.y[1] = 0.5;
    look(&s, 1.0);
    assert_close(candidate->clearance.active_from, 3.0 - 20.0 * penetration_tolerance, 1e-15); /* not looked at */
    assert_true(broad_phase_may_touch(&s.c.broad_phase, candidate, 0.1));
    assert_false(broad_phase_may_touch(&s.c.broad_phase, candidate, 0.09));
    s.c.broad_phase.travelled = 2.99;
    look(&s, 1.0);
    assert_true(candidate->clearance.inactive);
    assert_close(candidate->clearance.active_from, 2.99 + 0.5 - 20.0 * penetration_tolerance, 1e-15);
    s.c.broad_phase.travelled = 3.49;
    s.y[1] = 0.01;
    look(&s, 1.0);
    assert_false(candidate->clearance.inactive);
    assert_int_equal(s.c.broad_phase.n, 1);
}

/* An accepted step of h counts twice its length times the larger of the speeds at its ends. */
TEST(a_step_counts_as_twice_what_the_fastest_goes)
{
    const double x[2] = {0.0, 3.0};
    CLEANUP(scene_close) scene s;
    scene_flight f;
    open_nodes(&s, 1, x);
    scene_put(&s, 0, 0.0, 3.0, 0.0, -1.0);
    look(&s, 1.0);
    scene_fly(&s, (vec2){0.0, -scene_gravity}, 0.0, 0.01, &f);
    assert_false(automaton_check_step(&s.c, &f.dense, false, f.scratch));
    automaton_end_step(&s.c, &f.dense, f.y1);
    assert_close(s.c.broad_phase.travelled, 2.0 * 0.01 * 1.1, 1e-16);
}

/* Body far above: its edges are inactive as its nodes are, and active again before the ridge can be reached. */
TEST(edges_may_be_inactive_too)
{
    CLEANUP(scene_close) scene s;
    scene_open_triangle(&s, masses, -1.0, 1.2, &roof, 1);
    look(&s, 10.0);
    assert_int_equal(s.c.broad_phase.n, 0);
    for (dem_index i = 0; i < 3; i++) s.y[2 * i + 1] -= 1.1;
    s.c.broad_phase.travelled = 1.1;
    look(&s, 10.0);
    assert_int_equal(s.c.broad_phase.n, 1);
    assert_int_equal(s.c.broad_phase.active[0], scene_edge(&s, 0, 1));
}

/* From rest, or slowly, a step may take a node further than what counts as near at the speed of its start: the
 * crossing is found all the same, and the node hits. */
TEST(an_inactive_node_that_is_driven_on_to_the_floor_within_a_step_hits_it)
{
    const double x[2] = {0.0, 2e-4};
    CLEANUP(scene_close) scene s;
    scene_flight f;
    double y[4];
    open_nodes(&s, 1, x);
    assert_ok(scene_take_up(&s));
    assert_int_equal(s.c.broad_phase.n, 0); /* at rest nothing is in reach */
    scene_fly(&s, (vec2){0.0, -scene_gravity}, 0.0, max_step, &f);
    assert_true(f.y1[1] < 0.0);
    assert_true(automaton_check_step(&s.c, &f.dense, false, f.scratch));
    assert_close(f.dense.end, sqrt(2.0 * (2e-4 + penetration_tolerance) / scene_gravity), 1e-13);
    dense_output_state(&f.dense, f.dense.end, y);
    automaton_end_step(&s.c, &f.dense, y);
    memcpy(s.y, y, sizeof y);
    assert_int_equal(s.c.set.list[0].behind[0], -1);
    assert_ok(scene_resolve(&s, f.dense.end));
    assert_int_equal(s.n_impacts, 1);
}

/* 1.044 m from the free end at (4, 0), below it, a node is in front; a little less to the left it is inside: it has
 * come round the end, active or not. One that may have touched since it was seen to be clear has not. */
TEST(a_node_found_inside_has_come_round_a_free_end_and_may_come_back)
{
    const double x[4] = {4.3, -1.0, -3.0, 3.0}, travelled[4] = {1.04, 1.05, 1.04, 1.04};
    for (int k = 0; k < 4; k++) {
        const bool comes_round = k == 0 || k == 3;
        CLEANUP(scene_close) scene s;
        open_nodes(&s, 2, x);
        look(&s, 1.0);
        assert_int_equal(s.c.broad_phase.n, 0);
        s.y[0] = 3.5;
        s.y[1] = -0.5;
        s.c.broad_phase.travelled = travelled[k];
        if (k == 2) candidate_forget_clearance(&s.c.set.list[0]);
        if (k == 3) s.c.set.list[0].clearance.inactive = false;
        look(&s, 1.0);
        assert_int_equal(s.c.set.list[0].behind[0], comes_round ? 0 : -1);
        assert_int_equal(s.c.set.ledger.counts.behind, comes_round);
        if (!comes_round) assert_false(s.c.set.list[0].clearance.inactive);
        s.y[1] = 0.5;
        look(&s, 1.0);
        assert_int_equal(s.c.set.list[0].behind[0], -1);
        assert_int_equal(s.c.set.ledger.counts.behind, 0);
    }
}

/* Masses 0 and 1 are far from the floor, 2 is near it; 1 goes and comes back. */
TEST(who_is_active_stays_so_under_another_number)
{
    const double x[6] = {0.0, 2.0, 1.0, 1.0, 2.0, 0.0};
    dem_index outer_nodes[2] = {0, 2};
    const surface outer = {.n_nodes = 2, .nodes = outer_nodes};
    CLEANUP(scene_close) scene s;
    open_nodes(&s, 3, x);
    const broad_phase *w = &s.c.broad_phase;
    look(&s, 10.0);
    assert_int_equal(w->n, 1);
    assert_int_equal(w->active[0], 2);
    assert_close(w->earliest, 1.0 - 20.0 * penetration_tolerance, 1e-15);
    assert_ok(automaton_follow_surface(&s.c, &outer));
    assert_int_equal(w->n, 1);
    assert_int_equal(w->active[0], 1);
    assert_close(w->earliest, 2.0 - 20.0 * penetration_tolerance, 1e-15);
    assert_ok(automaton_follow_surface(&s.c, &s.model->surface));
    assert_int_equal(w->n, 2); /* nothing is known of the one that comes */
    assert_int_equal(w->active[0], 1);
    assert_int_equal(w->active[1], 2);
}
