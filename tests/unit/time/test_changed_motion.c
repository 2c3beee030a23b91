/* SPDX-License-Identifier: BSD-3-Clause */
/* changed_motion.c: motions against the polynomials they are of; what was changed is taken back to the bit. Numbers
 * are of order 1 to 10, so that sums of six terms are good to 1e-14. */
#include "verification/support.h"

#include <string.h>

#include "time/changed_motion.h"

enum { n_nodes = 3, n_state = 4 * n_nodes };

/* A motion along both axes: coefficients of powers of t, other ones for x and y. */
static const double motions[2][MOTION_TERMS] = {{1.0, -2.0, 3.0, 0.5, -1.5, 0.25}, {-0.5, 1.0, 0.75, -2.0, 0.5, 1.0}};

/* The d-th derivative at t. */
static double derivative(const double c[MOTION_TERMS], int d, double t)
{
    double sum = 0.0;
    for (int k = d; k < MOTION_TERMS; k++) {
        double factor = 1.0;
        for (int q = 0; q < d; q++) factor *= k - q;
        sum += factor * c[k] * pow(t, k - d);
    }
    return sum;
}

static vec2 along_both(int d, double t)
{
    return (vec2){derivative(motions[0], d, t), derivative(motions[1], d, t)};
}

/* The polynomials from `from` on, in powers of s = (t - from)/(end - from), by Taylor's theorem. */
static motion_polynomial written_from(double from, double end)
{
    motion_polynomial m = {.from = from};
    double scale = 1.0;
    for (int k = 0; k < MOTION_TERMS; scale *= (end - from) / ++k)
        for (int c = 0; c < 2; c++) {
            m.c[k][c] = scale * derivative(motions[c], k, from);
            m.c[k][2 + c] = scale * derivative(motions[c], k + 1, from);
        }
    return m;
}

static const state_layout layout = {.dim = 2, .n_nodes = n_nodes, .n_rows = n_nodes};

typedef struct step {
    changed_motion changed;
    double y1[n_state], f1[n_state];
} step;

static void open_step(step *s, double end)
{
    assert_ok(changed_motion_create(&s->changed, &layout));
    for (int k = 0; k < n_state; k++) {
        s->y1[k] = 1.0 / (3.0 + k);
        s->f1[k] = -1.0 / (7.0 + k);
    }
    changed_motion_start(&s->changed, end, s->y1, s->f1);
}

static void check_motion(const changed_motion *tr, dem_index node, double t)
{
    const vec2 x = changed_motion_position(tr, t, node), v = changed_motion_velocity(tr, t, node);
    const vec2 x0 = along_both(0, t), v0 = along_both(1, t);
    assert_close(x.x, x0.x, 2e-14);
    assert_close(x.y, x0.y, 2e-14);
    assert_close(v.x, v0.x, 4e-14);
    assert_close(v.y, v0.y, 4e-14);
}

/* ---- polynomials ---- */

static void a_motion_is_the_polynomial_of_its_coefficients(void **state)
{
    const motion_polynomial whole = written_from(0.25, 1.5);
    step s;
    (void)state;
    open_step(&s, 1.5);
    assert_false(changed_motion_has(&s.changed, 1));
    assert_ok(changed_motion_set(&s.changed, 1, &whole));
    assert_true(changed_motion_has(&s.changed, 1));
    assert_false(changed_motion_has(&s.changed, 0));
    for (double t = 0.25; t <= 1.5; t += 0.125) check_motion(&s.changed, 1, t);
    changed_motion_destroy(&s.changed);
}

static void the_same_motion_can_be_written_from_any_later_time_on(void **state)
{
    const motion_polynomial whole = written_from(0.25, 1.5);
    (void)state;
    for (double from = 0.25; from <= 1.5; from += 0.3125) {
        const motion_polynomial later = motion_polynomial_later(&whole, from, 1.5), expected = written_from(from, 1.5);
        assert_close(later.from, from, 0.0);
        for (int k = 0; k < MOTION_TERMS; k++)
            for (int q = 0; q < 4; q++) assert_close(later.c[k][q], expected.c[k][q], 1e-13);
    }
}

/* Ten times in a row, each from the one before: rounding does not add up to more than ten times one. */
static void written_anew_again_and_again_it_stays_the_same(void **state)
{
    motion_polynomial m = written_from(0.25, 1.5);
    step s;
    (void)state;
    open_step(&s, 1.5);
    for (int k = 1; k <= 10; k++) {
        m = motion_polynomial_later(&m, 0.25 + 0.1 * k, 1.5);
        assert_ok(changed_motion_set(&s.changed, 0, &m));
        assert_close(changed_motion_of(&s.changed, 0)->from, 0.25 + 0.1 * k, 0.0);
        for (double t = 0.25 + 0.1 * k; t <= 1.5; t += 0.05) {
            const vec2 x = changed_motion_position(&s.changed, t, 0), expected = along_both(0, t);
            assert_close(x.x, expected.x, 2e-13);
            assert_close(x.y, expected.y, 2e-13);
        }
    }
    changed_motion_destroy(&s.changed);
}

/* A change with position, velocity and acceleration given at both ends is the one quintic that has them; here it is
 * the motion itself, bent out of nothing. */
static void a_bend_is_the_quintic_through_both_ends(void **state)
{
    const double from = 0.5, end = 1.25;
    const motion_change at = {along_both(0, from), along_both(1, from), along_both(2, from)};
    const motion_change by = {vec2_sub(along_both(0, end), at.x), vec2_sub(along_both(1, end), at.v),
                              vec2_sub(along_both(2, end), at.a)};
    motion_polynomial m = {.from = from};
    step s;
    (void)state;
    open_step(&s, end);
    motion_polynomial_add(&m, end, &at, &by);
    assert_ok(changed_motion_set(&s.changed, 2, &m));
    for (double t = from; t <= end; t += 0.0625) check_motion(&s.changed, 2, t);
    motion_polynomial_add(&m, end, &at, &by); /* and adds to what there is */
    assert_ok(changed_motion_set(&s.changed, 2, &m));
    for (double t = from; t <= end; t += 0.0625) {
        const vec2 x = changed_motion_position(&s.changed, t, 2), expected = along_both(0, t);
        assert_close(x.x, 2.0 * expected.x, 4e-14);
        assert_close(x.y, 2.0 * expected.y, 4e-14);
    }
    changed_motion_destroy(&s.changed);
}

/* As a path that is parabolic: x and v do not know of each other but at the start; the acceleration at the end is not
 * looked at. */
static void parabolas_go_through_what_they_are_given(void **state)
{
    const double from = 0.5, end = 2.5; /* shares of it are exact */
    const motion_change at = {{1.0, -2.0}, {3.0, 0.5}, {-4.0, 8.0}}, by = {{5.0, 7.0}, {-6.0, 1.0}, {1e9, 1e9}};
    motion_polynomial m = {.from = from};
    (void)state;
    for (int n = 1; n <= 2; n++) { /* and adds to what there is */
        double first[4], middle[4], last[4];
        motion_polynomial_add_parabolas(&m, end, &at, &by);
        motion_polynomial_at(&m, 0.0, first);
        motion_polynomial_at(&m, 0.5, middle);
        motion_polynomial_at(&m, 1.0, last);
        assert_true(first[0] == n * 1.0 && first[1] == n * -2.0 && first[2] == n * 3.0 && first[3] == n * 0.5);
        assert_true(last[0] == n * 6.0 && last[1] == n * 5.0 && last[2] == n * -3.0 && last[3] == n * 1.5);
        /* x + h v/4 + (change)/4, the same of v with a: by hand */
        assert_true(middle[0] == n * (1.0 + 1.5 + 1.25) && middle[1] == n * (-2.0 + 0.25 + 1.75));
        assert_true(middle[2] == n * (3.0 - 2.0 - 1.5) && middle[3] == n * (0.5 + 4.0 + 0.25));
    }
}

/* A jump of the velocity that nothing follows, as of a node by itself: straight on, x + v (t - from), however little of
 * the step is left. */
static void a_node_by_itself_goes_straight_on_after_a_jump(void **state)
{
    (void)state;
    for (double h = 1.0; h > 1e-12; h *= 0.1) {
        const double end = 2.0, from = end - h;
        const motion_change at = {.v = {3.0, -1.0}}, by = {.x = {3.0 * (end - from), -(end - from)}};
        motion_polynomial m = {.from = from};
        step s;
        open_step(&s, end);
        motion_polynomial_add(&m, end, &at, &by);
        assert_ok(changed_motion_set(&s.changed, 0, &m));
        for (double share = 0.0; share <= 1.0; share += 0.125) {
            const double t = from + share * (end - from);
            const vec2 x = changed_motion_position(&s.changed, t, 0), v = changed_motion_velocity(&s.changed, t, 0);
            assert_close(x.x, 3.0 * (t - from), 1e-15 * h);
            assert_close(x.y, -(t - from), 1e-15 * h);
            assert_close(v.x, 3.0, 1e-13);
            assert_close(v.y, -1.0, 1e-13);
        }
        changed_motion_destroy(&s.changed);
    }
}

/* An event at the end of the step leaves nothing to go on with. */
static void a_motion_without_length_is_the_state_at_its_time(void **state)
{
    const motion_change at = {.x = {0.25, 0.5}, .v = {3.0, -1.0}, .a = {7.0, 8.0}}, by = {.x = {0.0, 0.0}};
    const motion_polynomial whole = written_from(0.25, 1.5);
    motion_polynomial m = motion_polynomial_later(&whole, 1.5, 1.5);
    step s;
    (void)state;
    open_step(&s, 1.5);
    assert_ok(changed_motion_set(&s.changed, 1, &whole));
    motion_polynomial_add(&m, 1.5, &at, &by);
    assert_ok(changed_motion_set(&s.changed, 1, &m));
    const vec2 x = changed_motion_position(&s.changed, 1.5, 1), v = changed_motion_velocity(&s.changed, 1.5, 1);
    assert_close(x.x, along_both(0, 1.5).x + 0.25, 1e-14);
    assert_close(x.y, along_both(0, 1.5).y + 0.5, 1e-14);
    assert_close(v.x, along_both(1, 1.5).x + 3.0, 4e-14);
    assert_close(v.y, along_both(1, 1.5).y - 1.0, 4e-14);
    changed_motion_destroy(&s.changed);
}

/* Each adds 1 m/s to the velocity; the end of the step is kept once. */
static void the_last_motion_of_a_node_holds(void **state)
{
    enum { n = 400 };
    step s;
    (void)state;
    open_step(&s, 4.0);
    for (dem_index node = 0; node < 2; node++) {
        motion_polynomial m = {.from = 0.0};
        for (int k = 0; k < n; k++) {
            assert_ok(changed_motion_set(&s.changed, node, &m));
            assert_close(changed_motion_velocity(&s.changed, 0.01 * k, node).x, k, 1e-11 * (1 + k)); /* a sum of k */
            assert_close(changed_motion_velocity(&s.changed, 0.01 * k + 0.005, node).x, k, 1e-11 * (1 + k));
            m = motion_polynomial_later(&m, 0.01 * (k + 1), 4.0);
            motion_polynomial_add(&m, 4.0, &(motion_change){.v = {1.0, 0.0}},
                                  &(motion_change){.x = {4.0 - 0.01 * (k + 1), 0.0}});
        }
    }
    assert_int_equal(s.changed.n, 2);
    changed_motion_destroy(&s.changed);
}

/* ---- the end of the step ---- */

/* A node that is kept can change there, and be kept again, though its motion has not. */
static void a_node_can_be_kept_without_a_motion(void **state)
{
    const motion_polynomial still = {0};
    const motion_change jump = {{0.5, 0.25}, {2.0, 4.0}, {8.0, 16.0}};
    step s, before;
    (void)state;
    open_step(&s, 1.0);
    before = s;
    assert_ok(changed_motion_keep(&s.changed, 2));
    assert_false(changed_motion_has(&s.changed, 2));
    changed_motion_move_end(&s.changed, 2, &jump);
    assert_ok(changed_motion_set(&s.changed, 2, &still));
    changed_motion_move_end(&s.changed, 2, &jump);
    assert_ok(changed_motion_keep(&s.changed, 2));
    assert_true(changed_motion_has(&s.changed, 2));
    changed_motion_move_end(&s.changed, 2, &jump);
    changed_motion_undo(&s.changed);
    assert_false(changed_motion_has(&s.changed, 2));
    assert_memory_equal(s.y1, before.y1, sizeof s.y1);
    assert_memory_equal(s.f1, before.f1, sizeof s.f1);
    changed_motion_destroy(&s.changed);
}

static void a_jump_at_the_end_changes_the_state_and_its_derivative(void **state)
{
    const motion_change jump = {{0.5, 0.25}, {2.0, 4.0}, {8.0, 16.0}};
    const motion_polynomial still = {0};
    step s, before;
    (void)state;
    open_step(&s, 1.0);
    before = s;
    assert_ok(changed_motion_set(&s.changed, 1, &still));
    changed_motion_move_end(&s.changed, 1, &jump);
    before.y1[2] += 0.5, before.y1[3] += 0.25, before.y1[2 * n_nodes + 2] += 2.0, before.y1[2 * n_nodes + 3] += 4.0;
    before.f1[2] += 2.0, before.f1[3] += 4.0, before.f1[2 * n_nodes + 2] += 8.0, before.f1[2 * n_nodes + 3] += 16.0;
    assert_memory_equal(s.y1, before.y1, sizeof s.y1);
    assert_memory_equal(s.f1, before.f1, sizeof s.f1);
    changed_motion_destroy(&s.changed);
}

/* Jumps that are lost and won in rounding: adding and taking away would not do. */
static void undoing_brings_every_bit_back(void **state)
{
    const motion_polynomial still = {0};
    step s, before;
    (void)state;
    open_step(&s, 1.0);
    before = s;
    for (int round = 0; round < 3; round++) {
        for (int k = 0; k < 700; k++) {
            const double size = pow(10.0, k % 40 - 20);
            const motion_change jump = {{size, -0.3 * size}, {1.1 * size, size}, {0.7 * size, -size}};
            assert_ok(changed_motion_set(&s.changed, (2 * k) % n_nodes, &still));
            changed_motion_move_end(&s.changed, (2 * k) % n_nodes, &jump);
        }
        assert_memory_not_equal(s.y1, before.y1, sizeof s.y1);
        changed_motion_undo(&s.changed);
        assert_memory_equal(s.y1, before.y1, sizeof s.y1);
        assert_memory_equal(s.f1, before.f1, sizeof s.f1);
        for (dem_index i = 0; i < n_nodes; i++) assert_false(changed_motion_has(&s.changed, i));
    }
    changed_motion_undo(&s.changed); /* of nothing */
    assert_memory_equal(s.y1, before.y1, sizeof s.y1);
    changed_motion_destroy(&s.changed);
}

static void the_next_step_knows_nothing_of_the_last_which_stays_as_it_is(void **state)
{
    const motion_polynomial still = {0};
    step s, next;
    (void)state;
    open_step(&s, 1.0);
    assert_ok(changed_motion_set(&s.changed, 2, &still));
    changed_motion_move_end(&s.changed, 2, &(motion_change){.x = {1.0, 1.0}});
    next = s;
    changed_motion_start(&s.changed, 2.0, next.y1, next.f1);
    assert_false(changed_motion_has(&s.changed, 2));
    assert_ok(changed_motion_set(&s.changed, 0, &still));
    changed_motion_undo(&s.changed);
    assert_memory_equal(s.y1, next.y1, sizeof s.y1);
    assert_close(s.y1[4], 1.0 / 7.0 + 1.0, 1e-15);
    changed_motion_destroy(&s.changed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_motion_is_the_polynomial_of_its_coefficients),
        cmocka_unit_test(the_same_motion_can_be_written_from_any_later_time_on),
        cmocka_unit_test(written_anew_again_and_again_it_stays_the_same),
        cmocka_unit_test(a_bend_is_the_quintic_through_both_ends),
        cmocka_unit_test(parabolas_go_through_what_they_are_given),
        cmocka_unit_test(a_node_by_itself_goes_straight_on_after_a_jump),
        cmocka_unit_test(a_motion_without_length_is_the_state_at_its_time),
        cmocka_unit_test(the_last_motion_of_a_node_holds),
        cmocka_unit_test(a_node_can_be_kept_without_a_motion),
        cmocka_unit_test(a_jump_at_the_end_changes_the_state_and_its_derivative),
        cmocka_unit_test(undoing_brings_every_bit_back),
        cmocka_unit_test(the_next_step_knows_nothing_of_the_last_which_stays_as_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
