/* SPDX-License-Identifier: BSD-3-Clause */
/* automaton_step.c: what is found in a step that was accepted, and what follows it. Numbers are worked out by hand;
 * tolerances of 1e-15 to 1e-12 are rounding unless said otherwise. */
#include "unit/contact/resets.h"

#include "contact/automaton_step.h"

/* ---- lasting contacts ---- */

/* The rates that are integrated along: 20 N of weight less what the spring takes, 100 (y - 1); nothing of it is
 * friction. */
TEST(a_followed_step_refreshes_the_force_and_tells_its_rate)
{
    CLEANUP(scene_close) scene s;
    double a[4] = {0.0, -g, 0.0, -g}, rate[6] = {0.0};
    scene_flight f;
    open_pair(&s);
    scene_put(&s, 1, 0.0, 1.19, 0.5, 2.0);
    a[1] += 19.0 / 2.0;
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 0.01, &f);
    automaton_end_step(&s.c, &f.dense, s.y);
    assert_close(s.c.set.list[0].closed[0].force, 1.0, 1e-13);
    automaton_constrain(&s.c, 0.0, s.y, a);
    scene_add_rates(&s, rate);
    const double expected[6] = {0.0, 1.0, 0.0, 0.0, 0.0, 0.0};
    for (int k = 0; k < 6; k++) assert_close(rate[k], expected[k], 1e-13);
}

/* ---- edges on vertices ---- */

/* The edge 0-1 on the ridge, 30 penetration tolerances above it with 1 mm/s upwards at node 1: back it is put, and
 * slides on. Less than a quarter of the penetration tolerance is left alone. P has the mass 1/W = 4 kg and goes up
 * with 3/4 mm/s. */
TEST(a_closed_edge_that_has_opened_is_put_back)
{
    CLEANUP(scene_close) scene s;
    open_side(&s, &rough_roof, 0.25, 0.0, 0.0);
    launch(&s, 0.5, 0.0);
    assert_ok(scene_take_up(&s));
    for (dem_index i = 0; i < 2; i++) s.y[2 * i + 1] = 0.2 * penetration_tolerance;
    scene_v(&s)[3] = 1e-3;
    assert_false(automaton_project(&s.c, 0.1, s.y));
    assert_close(s.y[1], 0.2 * penetration_tolerance, 0.0);
    assert_close(scene_v(&s)[3], 1e-3, 0.0);
    for (dem_index i = 0; i < 2; i++) s.y[2 * i + 1] = 30.0 * penetration_tolerance;
    assert_true(automaton_project(&s.c, 0.1, s.y));
    assert_close(0.25 * s.y[1] + 0.75 * s.y[3], 0.0, 1e-9 * penetration_tolerance);
    assert_close(0.25 * scene_v(&s)[1] + 0.75 * scene_v(&s)[3], 0.0, 1e-15);
    assert_close(scene_v(&s)[0], 0.5, 1e-7);
    assert_int_equal(s.c.set.list[scene_edge(&s, 0, 1)].n_closed, 1);
    const contact_ledger *ledger = &s.c.set.ledger;
    assert_close(exact_sum_value(&ledger->impulse[1]), -4.0 * 0.75e-3, 1e-8);
    assert_close(exact_sum_value(&ledger->projection), -40.0 * 30.0 * penetration_tolerance,
                 1e-3 * penetration_tolerance);
    assert_close(exact_sum_value(&ledger->impact), 0.5 * 4.0 * 0.75e-3 * 0.75e-3, 1e-9);
    assert_int_equal(s.n_events, 1);
    assert_close(s.c.set.projected, 30.0 * penetration_tolerance, 1e-9 * penetration_tolerance);
}

/* ---- behind a free end ---- */

TEST(a_node_that_comes_round_a_free_end_is_behind_until_it_is_in_front)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, -4.0, -0.5, 1.0, 2.0); /* right below the end: from in front to 0.5 m inside */
    assert_ok(scene_resolve(&s, 0.1));
    assert_int_equal(s.c.set.ledger.counts.behind, 1);
    assert_int_equal(s.c.set.list[0].behind[0], 0);
    assert_true(s.c.set.list[0].clearance.inactive);
    scene_put(&s, 0, -3.0, -0.01, 1.0, 2.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 0.01, &f);
    automaton_end_step(&s.c, &f.dense, s.y);
    assert_int_equal(s.c.set.ledger.counts.behind, 1);
    scene_put(&s, 0, -3.0, 0.01, 1.0, 2.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 0.01, &f);
    automaton_end_step(&s.c, &f.dense, s.y);
    assert_int_equal(s.c.set.ledger.counts.behind, 0);
    assert_int_equal(s.c.set.list[0].behind[0], -1);
    assert_int_equal(s.n_impacts, 0);
}

/* ---- the root function ---- */

/* The root function at a time in a step: it reads nothing but the nodes that the active candidates depend on. */
static double root_at(scene *s, scene_flight *f, double t)
{
    for (int k = 0; k < 4 * SCENE_NODES; k++) f->scratch[k] = (double)NAN;
    f->dense.end = t;
    return automaton_root_function(&s->c, &f->dense, f->scratch);
}

/* The first node falls on the floor, the second slides to its end, which one of them is nearer to; the third is
 * inactive. */
TEST(the_root_function_is_the_lowest_of_all_candidates)
{
    static const double fall[2] = {20.0, 10.0}, height = 0.25, slide = 30.0, way = 0.5;
    for (int k = 0; k < 2; k++) {
        CLEANUP(scene_close) scene s;
        scene_flight f;
        open_scene(&s, 3, &half, 1);
        scene_put(&s, 0, 1.0, height, 0.0, -fall[k]);
        scene_put(&s, 1, 4.0 - way, 0.0, slide, 0.0);
        scene_put(&s, 2, 1.0, 0.75, 0.0, 0.0);
        assert_ok(scene_take_up(&s));
        assert_true(s.c.set.list[2].clearance.inactive);
        for (int i = 0; i < 3; i++)
            s.c.set.list[i].clearance.distance = 0.0; /* else a lower bound would do for their gaps */
        automaton_begin_roots(&s.c, 0.0, s.y);
        scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 0.01, &f);
        for (int part = 1; part <= 4; part++) {
            const double t = 0.01 * part / 4.0;
            const double falls = (height - fall[k] * t + penetration_tolerance) / (height + penetration_tolerance);
            const double slides = (way - slide * t + penetration_tolerance) / (way + penetration_tolerance);
            assert_true((falls < slides) == (k == 0));
            assert_close(root_at(&s, &f, t), fmin(falls, slides), 1e-14);
            assert_true(s.c.quiet);
        }
    }
}

/* It turns back from a speed at the start of the step, in units of which its root function is. */
TEST(what_is_zero_at_the_start_is_left_out_of_the_root_function)
{
    static const double speed[3] = {1e-3, 1e-40, 0.0}, expected[3] = {-9.0, -1e30, 1.0};
    for (int k = 0; k < 3; k++) {
        CLEANUP(scene_close) scene s;
        scene_flight f;
        rub(&s, 1.0);
        scene_v(&s)[0] = speed[k];
        automaton_begin_roots(&s.c, 0.0, s.y);
        scene_fly(&s, (vec2){-1.0, 0.0}, 0.0, 0.01, &f);
        assert_close(root_at(&s, &f, 0.01), expected[k], 1e-12);
        assert_false(s.c.quiet);
    }
}

/* ---- the check after a step ---- */

TEST(a_step_is_cut_at_the_first_contact_that_was_overlooked)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    open_scene(&s, 3, &half, 1);
    scene_put(&s, 0, 0.0, 3.0, 0.0, 0.0);
    scene_put(&s, 1, 1.0, 0.3, 0.0, -1.0);
    scene_put(&s, 2, 2.0, 0.2, 0.0, -1.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 1.0, &f);
    assert_true(automaton_check_step(&s.c, &f.dense, false, f.scratch));
    assert_close(f.dense.end, 0.2 + penetration_tolerance,
                 1e-13); /* to which times are located: 100 units of rounding */
    assert_int_equal(s.c.set.ledger.counts.late, 1);
}

/* To the resolution of times: it is that of the root. */
TEST(a_contact_at_the_root_that_ends_a_step_is_no_other)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 1.0, 0.2, 0.0, -1.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 1.0, &f);
    f.dense.end = (0.2 + penetration_tolerance) * (1.0 + 1e-14);
    const double end = f.dense.end;
    assert_false(automaton_check_step(&s.c, &f.dense, true, f.scratch));
    assert_close(f.dense.end, end, 0.0);
    assert_true(automaton_check_step(&s.c, &f.dense, false, f.scratch));
    assert_close(f.dense.end, 0.2 + penetration_tolerance, 1e-13);
    f.dense.end = 0.21;
    assert_true(automaton_check_step(&s.c, &f.dense, true, f.scratch)); /* well before a root */
    assert_close(f.dense.end, 0.2 + penetration_tolerance, 1e-13);
}

TEST(a_step_without_contacts_is_left_as_it_is)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, 0.0, 1.5, 0.0, -1.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 1.0, &f);
    assert_false(automaton_check_step(&s.c, &f.dense, false, f.scratch));
    assert_close(f.dense.end, 1.0, 0.0);
    assert_int_equal(s.c.set.ledger.counts.late, 0);
}

TEST(a_closed_contact_that_should_have_ended_cuts_the_step)
{
    CLEANUP(scene_close) scene s;
    scene_flight f;
    slide(&s, &half, 3.0, 2.0);
    scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 1.0, &f);
    assert_true(
        automaton_check_step(&s.c, &f.dense, true, f.scratch)); /* though it ends at the root of another candidate */
    assert_close(f.dense.end, 0.5 * (1.0 + penetration_tolerance), 1e-13);
}

/* The check does not evaluate again the root functions at the end of the step: it knows whether all were positive. */
TEST(the_check_goes_by_the_root_functions_at_the_end_of_the_step)
{
    for (int ends = 0; ends <= 1; ends++) {
        CLEANUP(scene_close) scene s;
        scene_flight f;
        slide(&s, &half, 3.0, ends ? 2.0 : 0.5);
        scene_fly(&s, (vec2){0.0, 0.0}, 0.0, 1.0, &f);
        automaton_begin_roots(&s.c, 0.0, s.y);
        assert_true((automaton_root_function(&s.c, &f.dense, f.scratch) > 0.0) == !ends);
        assert_int_equal(s.c.quiet, !ends);
        assert_int_equal(automaton_check_step(&s.c, &f.dense, false, f.scratch), ends);
        if (ends) assert_close(f.dense.end, 0.5 * (1.0 + penetration_tolerance), 1e-13);
    }
}

/* Above and behind the free end of a wall, 2.1 mm from it: 0.6 mm further down a node is inside the wall by its gap,
 * but has touched nothing. That goes unnoticed while nothing is near; at the start of the next step it is behind. */
TEST(what_goes_round_a_free_end_at_a_distance_is_behind_it)
{
    const double points[4] = {0.0, -1.0, 0.0, 0.0}, x[2] = {2e-3, 5e-4}, m = 1.0;
    const dem_obstacle wall = SIZED(dem_obstacle, .n_points = 2, .points = points, .restitution = 0.5);
    CLEANUP(scene_close) scene s;
    scene_flight f;
    scene_open(&s, 1, x, &m, 0, NULL, &wall, 1);
    scene_put(&s, 0, x[0], x[1], 0.01, -0.06);
    assert_ok(scene_take_up(&s));
    s.c.set.list[0].clearance.inactive = false;
    for (int k = 0; k < 2; k++) {
        scene_fly(&s, (vec2){0.0, 0.0}, 0.01 * k, 0.01, &f);
        automaton_begin_step(&s.c, &f.dense, f.scratch);
        assert_true(isinf(automaton_next_change(&s.c, &f.dense, 0, f.dense.t0, f.scratch)) != 0);
        assert_int_equal(s.c.set.list[0].behind[0], k - 1);
        memcpy(s.y, f.y1, sizeof s.y);
    }
    assert_int_equal(s.c.set.ledger.counts.behind, 1);
    assert_int_equal(s.n_events, 0);
}

/* ---- free flight ---- */

/* 1 m above the floor: travelled are 2 h times the higher of both speeds, and the longest step of 0.01 s takes the node
 * further by 1.25 h times the speed. */
TEST(a_flight_is_followed_unless_something_comes_near)
{
    CLEANUP(scene_close) scene s;
    open_scene(&s, 1, &half, 1);
    scene_put(&s, 0, -3.0, 1.0, 0.0, -2.0);
    assert_ok(automaton_restore(&s.c, 0.0, s.y));
    assert_true(automaton_may_fly(&s.c, 0.02));
    assert_false(automaton_may_fly(&s.c, 0.245)); /* 0.98 m, and 0.025 */
    const double t[3] = {0.0, 0.01, 0.02}, near[2] = {4.0, 31.0 * 31.0}, slow[2] = {4.0, 9.0};
    const broad_phase before = s.c.broad_phase;
    assert_false(automaton_can_fly(&s.c, &(automaton_flight){2, t, near})); /* 0.04 m and 0.62, and 0.39 */
    assert_memory_equal(&s.c.broad_phase, &before, sizeof before);
    assert_true(automaton_can_fly(&s.c, &(automaton_flight){2, t, slow}));
    assert_memory_equal(&s.c.broad_phase, &before, sizeof before);
    automaton_fly(&s.c, &(automaton_flight){2, t, slow});
    assert_close(s.c.broad_phase.travelled, 0.04 + 0.06, 1e-15);
    assert_close(s.c.broad_phase.speed, 3.0, 0.0);
    assert_close(s.c.way, 0.06, 1e-15);
    assert_close(s.c.solved, 0.02, 0.0);
    scene_put(&s, 0, -3.0, 0.01, 0.0, -2.0);
    assert_ok(automaton_restore(&s.c, 0.0, s.y));
    assert_false(automaton_may_fly(&s.c, 0.0));
    assert_false(automaton_can_fly(&s.c, &(automaton_flight){2, t, slow}));
}
