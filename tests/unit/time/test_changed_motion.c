/* SPDX-License-Identifier: BSD-3-Clause */
/* changed_motion.c: motions in two and in three dimensions against the polynomials they are of; what was changed is
 * taken back to the bit. Numbers are of order 1 to 10, so that sums of six terms are good to 1e-14. */
#include "verification/support.h"

#include <string.h>

#include "time/changed_motion.h"
#include "unit/both_dimensions.h"

enum { n_nodes = 3, dim_most = STATE_DIM_MOST, n_state = 2 * dim_most * n_nodes };

/* A motion along all axes: coefficients of powers of t, other ones for each. */
static const double motions[dim_most][MOTION_TERMS] = {
    {1.0, -2.0, 3.0, 0.5, -1.5, 0.25}, {-0.5, 1.0, 0.75, -2.0, 0.5, 1.0}, {0.25, 0.5, -1.0, 1.5, 2.0, -0.75}};

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

static double along(int c, int d, double t)
{
    return derivative(motions[c], d, t);
}

static motion_change change_at(double t)
{
    motion_change at = {.x = {0.0}};
    for (int c = 0; c < dim; c++) at.x[c] = along(c, 0, t), at.v[c] = along(c, 1, t), at.a[c] = along(c, 2, t);
    return at;
}

/* The polynomials from `from` on, in powers of s = (t - from)/(end - from), by Taylor's theorem. */
static motion_polynomial written_from(double from, double end)
{
    motion_polynomial m = {.from = from, .dim = dim};
    double scale = 1.0;
    for (int k = 0; k < MOTION_TERMS; scale *= (end - from) / ++k)
        for (int c = 0; c < dim; c++) {
            m.x[k][c] = scale * derivative(motions[c], k, from);
            if (k < MOTION_SLOPES) m.v[k][c] = scale * derivative(motions[c], k + 1, from);
        }
    return m;
}

typedef struct step {
    changed_motion changed;
    double y1[n_state], f1[n_state];
} step;

static void open_step(step *s, double end)
{
    const state_layout layout = {.dim = dim, .n_nodes = n_nodes, .n_rows = n_nodes};
    assert_ok(changed_motion_create(&s->changed, &layout));
    for (int k = 0; k < n_state; k++) {
        s->y1[k] = 1.0 / (3.0 + k);
        s->f1[k] = -1.0 / (7.0 + k);
    }
    changed_motion_start(&s->changed, end, s->y1, s->f1);
}

static void set_motion(changed_motion *tr, dem_index node, const motion_polynomial *m)
{
    motion_polynomial *to;
    assert_ok(changed_motion_take(tr, node, &to));
    *to = *m;
}

/* That a node has `times` the motion. */
static void check_motion(const changed_motion *tr, dem_index node, double t, double times)
{
    double x[dim_most], v[dim_most];
    changed_motion_position(tr, t, node, x);
    changed_motion_velocity(tr, t, node, v);
    for (int c = 0; c < dim; c++) {
        assert_close(x[c], times * along(c, 0, t), times * 2e-14);
        assert_close(v[c], times * along(c, 1, t), times * 4e-14);
    }
}

/* ---- polynomials ---- */

TEST_IN_BOTH(a_motion_is_the_polynomial_of_its_coefficients)
{
    const motion_polynomial whole = written_from(0.25, 1.5);
    step s;
    open_step(&s, 1.5);
    assert_false(changed_motion_has(&s.changed, 1));
    set_motion(&s.changed, 1, &whole);
    assert_true(changed_motion_has(&s.changed, 1));
    assert_false(changed_motion_has(&s.changed, 0));
    for (double t = 0.25; t <= 1.5; t += 0.125) check_motion(&s.changed, 1, t, 1.0);
    changed_motion_destroy(&s.changed);
}

TEST_IN_BOTH(the_same_motion_can_be_written_from_any_later_time_on)
{
    const motion_polynomial whole = written_from(0.25, 1.5);
    for (double from = 0.25; from <= 1.5; from += 0.3125) {
        const motion_polynomial expected = written_from(from, 1.5);
        motion_polynomial later = whole;
        motion_polynomial_restart(&later, from, 1.5);
        assert_close(later.from, from, 0.0);
        for (int k = 0; k < MOTION_TERMS; k++)
            for (int c = 0; c < dim; c++) {
                assert_close(later.x[k][c], expected.x[k][c], 1e-13);
                if (k < MOTION_SLOPES) assert_close(later.v[k][c], expected.v[k][c], 1e-13);
            }
    }
}

/* Ten times in a row, each from the one before: rounding does not add up to more than ten times one. */
TEST_IN_BOTH(written_anew_again_and_again_it_stays_the_same)
{
    motion_polynomial m = written_from(0.25, 1.5);
    step s;
    open_step(&s, 1.5);
    for (int k = 1; k <= 10; k++) {
        motion_polynomial_restart(&m, 0.25 + 0.1 * k, 1.5);
        set_motion(&s.changed, 0, &m);
        assert_close(changed_motion_of(&s.changed, 0)->from, 0.25 + 0.1 * k, 0.0);
        for (double t = 0.25 + 0.1 * k; t <= 1.5; t += 0.05) {
            double x[dim_most];
            changed_motion_position(&s.changed, t, 0, x);
            for (int c = 0; c < dim; c++) assert_close(x[c], along(c, 0, t), 2e-13);
        }
    }
    changed_motion_destroy(&s.changed);
}

/* A change with position, velocity and acceleration given at both ends is the one quintic that has them; here it is
 * the motion itself, bent out of nothing. */
TEST_IN_BOTH(a_bend_is_the_quintic_through_both_ends)
{
    const double from = 0.5, end = 1.25;
    const motion_change at = change_at(from);
    motion_change by = change_at(end);
    for (int c = 0; c < dim; c++) by.x[c] -= at.x[c], by.v[c] -= at.v[c], by.a[c] -= at.a[c];
    motion_polynomial m = {.from = from, .dim = dim};
    step s;
    open_step(&s, end);
    motion_polynomial_add(&m, end, &at, &by, &m);
    set_motion(&s.changed, 2, &m);
    for (double t = from; t <= end; t += 0.0625) check_motion(&s.changed, 2, t, 1.0);
    motion_polynomial_add(&m, end, &at, &by, &m); /* and adds to what there is */
    set_motion(&s.changed, 2, &m);
    for (double t = from; t <= end; t += 0.0625) check_motion(&s.changed, 2, t, 2.0);
    changed_motion_destroy(&s.changed);
}

/* As a parabolic dense output: x and v do not know of each other but at the start; the acceleration at the end is not
 * looked at. */
TEST_IN_BOTH(parabolas_go_through_what_they_are_given)
{
    const double from = 0.5, end = 2.5; /* shares of it are exact */
    const motion_change at = {{1.0, -2.0, 4.0}, {3.0, 0.5, -1.0}, {-4.0, 8.0, 2.0}},
                        by = {{5.0, 7.0, 1.0}, {-6.0, 1.0, 4.0}, {1e9, 1e9, 1e9}};
    motion_polynomial m = {.from = from, .dim = dim};
    for (int n = 1; n <= 2; n++) { /* and adds to what there is */
        motion_polynomial_add_parabolas(&m, end, &at, &by, &m);
        for (int c = 0; c < dim; c++)
            for (int q = 0; q <= 2; q++) { /* with h = 2; in the middle x + h v/4 + (change)/4, the same of v with a */
                const double s = 0.5 * q, x0 = at.x[c], v0 = at.v[c], hv = 2.0 * v0, ha = 2.0 * at.a[c];
                double x[dim_most], v[dim_most];
                motion_polynomial_position(&m, s, x);
                motion_polynomial_velocity(&m, s, v);
                assert_true(x[c] == n * (x0 + s * (hv + s * (by.x[c] - hv))));
                assert_true(v[c] == n * (v0 + s * (ha + s * (by.v[c] - ha))));
            }
    }
}

/* A jump of the velocity that nothing follows, as of a node by itself: straight on, x + v (t - from), however little of
 * the step is left. */
TEST_IN_BOTH(a_node_by_itself_goes_straight_on_after_a_jump)
{
    for (double h = 1.0; h > 1e-12; h *= 0.1) {
        const double end = 2.0, from = end - h;
        const double speed[dim_most] = {3.0, -1.0, 0.5};
        motion_change at = {.x = {0.0}}, by = at;
        for (int c = 0; c < dim; c++) at.v[c] = speed[c], by.x[c] = speed[c] * (end - from);
        motion_polynomial m = {.from = from, .dim = dim};
        step s;
        open_step(&s, end);
        motion_polynomial_add(&m, end, &at, &by, &m);
        set_motion(&s.changed, 0, &m);
        for (double share = 0.0; share <= 1.0; share += 0.125) {
            const double t = from + share * (end - from);
            double x[dim_most], v[dim_most];
            changed_motion_position(&s.changed, t, 0, x);
            changed_motion_velocity(&s.changed, t, 0, v);
            for (int c = 0; c < dim; c++) {
                assert_close(x[c], speed[c] * (t - from), 1e-15 * h);
                assert_close(v[c], speed[c], 1e-13);
            }
        }
        changed_motion_destroy(&s.changed);
    }
}

/* An event at the end of the step leaves nothing to go on with. */
TEST_IN_BOTH(a_motion_without_length_is_the_state_at_its_time)
{
    const motion_change at = {.x = {0.25, 0.5, 1.0}, .v = {3.0, -1.0, 2.0}, .a = {7.0, 8.0, 9.0}}, by = {.x = {0.0}};
    const motion_polynomial whole = written_from(0.25, 1.5);
    motion_polynomial m = whole;
    double x[dim_most], v[dim_most];
    step s;
    motion_polynomial_restart(&m, 1.5, 1.5);
    open_step(&s, 1.5);
    set_motion(&s.changed, 1, &whole);
    motion_polynomial_add(&m, 1.5, &at, &by, &m);
    set_motion(&s.changed, 1, &m);
    changed_motion_position(&s.changed, 1.5, 1, x);
    changed_motion_velocity(&s.changed, 1.5, 1, v);
    for (int c = 0; c < dim; c++) {
        assert_close(x[c], along(c, 0, 1.5) + at.x[c], 1e-14);
        assert_close(v[c], along(c, 1, 1.5) + at.v[c], 4e-14);
    }
    changed_motion_destroy(&s.changed);
}

/* Each adds 1 m/s to the velocity; the end of the step is kept once. */
TEST_IN_BOTH(the_last_motion_of_a_node_holds)
{
    enum { n = 400 };
    step s;
    open_step(&s, 4.0);
    for (dem_index node = 0; node < 2; node++) {
        motion_polynomial m = {.dim = dim};
        for (int k = 0; k < n; k++) {
            set_motion(&s.changed, node, &m);
            double v[dim_most], later[dim_most];
            changed_motion_velocity(&s.changed, 0.01 * k, node, v);
            changed_motion_velocity(&s.changed, 0.01 * k + 0.005, node, later);
            assert_close(v[dim - 1], k, 1e-11 * (1 + k)); /* a sum of k */
            assert_close(later[dim - 1], k, 1e-11 * (1 + k));
            motion_change at = {.x = {0.0}}, by = at;
            at.v[dim - 1] = 1.0;
            by.x[dim - 1] = 4.0 - 0.01 * (k + 1);
            motion_polynomial_restart(&m, 0.01 * (k + 1), 4.0);
            motion_polynomial_add(&m, 4.0, &at, &by, &m);
        }
    }
    assert_int_equal(s.changed.n, 2);
    changed_motion_destroy(&s.changed);
}

/* ---- the end of the step ---- */

/* A node that is kept can change there, and be kept again, though its motion has not. */
TEST_IN_BOTH(a_node_can_be_kept_without_a_motion)
{
    const motion_polynomial still = {.dim = dim};
    const motion_change jump = {{0.5, 0.25, 0.125}, {2.0, 4.0, 6.0}, {8.0, 16.0, 32.0}};
    step s, before;
    open_step(&s, 1.0);
    before = s;
    assert_ok(changed_motion_keep(&s.changed, 2));
    assert_false(changed_motion_has(&s.changed, 2));
    changed_motion_move_end(&s.changed, 2, &jump);
    set_motion(&s.changed, 2, &still);
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

TEST_IN_BOTH(a_jump_at_the_end_changes_the_state_and_its_derivative)
{
    const motion_change jump = {{0.5, 0.25, 0.125}, {2.0, 4.0, 6.0}, {8.0, 16.0, 32.0}};
    const motion_polynomial still = {.dim = dim};
    step s, before;
    open_step(&s, 1.0);
    before = s;
    set_motion(&s.changed, 1, &still);
    changed_motion_move_end(&s.changed, 1, &jump);
    for (int c = 0; c < dim; c++) {
        before.y1[dim + c] += jump.x[c], before.y1[dim * (n_nodes + 1) + c] += jump.v[c];
        before.f1[dim + c] += jump.v[c], before.f1[dim * (n_nodes + 1) + c] += jump.a[c];
    }
    assert_memory_equal(s.y1, before.y1, sizeof s.y1);
    assert_memory_equal(s.f1, before.f1, sizeof s.f1);
    changed_motion_destroy(&s.changed);
}

/* ---- rows of quadratures ---- */

/* What 40 events add to the only row, from the first to the last or the other way: sums of doubles would differ. */
static void add_parts(step *s, bool backwards)
{
    enum { EVENTS = 40 };
    for (int e = 0; e < EVENTS; e++) {
        const int k = backwards ? EVENTS - 1 - e : e;
        changed_motion_part part = {.row = 0, .motion = {.from = 0.01 * k, .dim = dim}};
        for (int c = 0; c < dim; c++) {
            part.motion.x[1][c] = part.end.x[c] = sin(k + c);
            part.motion.v[0][c] = part.end.v[c] = exp(0.1 * k) * cos(k + c);
            part.end.a[c] = 1.0 / (1.0 + k + c);
        }
        part.motion.x[1][0] = part.motion.v[0][0] = part.end.v[0] = 0.0; /* nothing to one of them */
        assert_ok(changed_motion_add(&s->changed, &part));
    }
}

TEST_IN_BOTH(what_events_add_to_a_row_does_not_depend_on_their_order)
{
    double x[2][dim_most] = {{1.0 / 3.0}}, v[2][dim_most] = {{1.0 / 3.0}};
    step s[2];
    for (int way = 0; way < 2; way++) {
        const state_layout layout = {.dim = dim, .n_nodes = 0, .n_rows = n_nodes};
        open_step(&s[way], 1.0);
        s[way].changed.layout = layout;
        x[way][0] = v[way][0] = 1.0 / 3.0;
        add_parts(&s[way], way == 1);
        changed_motion_row_at(&s[way].changed, 0.9, 0, x[way], v[way]);
        changed_motion_end_rows(&s[way].changed);
    }
    assert_memory_equal(x[0], x[1], sizeof x[0]);
    assert_memory_equal(v[0], v[1], sizeof v[0]);
    assert_memory_equal(s[0].y1, s[1].y1, sizeof s[0].y1);
    assert_memory_equal(s[0].f1, s[1].f1, sizeof s[0].f1);
    assert_close(x[0][0], 1.0 / 3.0, 0.0); /* to which nothing is added */
    assert_close(s[0].y1[dim * n_nodes], 1.0 / (3.0 + dim * n_nodes), 0.0);
    assert_true(v[0][1] != 0.0 && x[0][1] != 0.0);
    for (int c = 0; c < dim; c++) assert_close(s[0].f1[c], s[0].y1[dim * n_nodes + c], 0.0);
    changed_motion_undo(&s[0].changed);
    for (int k = 0; k < n_state; k++) assert_close(s[0].y1[k], 1.0 / (3.0 + k), 0.0);
    for (int way = 0; way < 2; way++) changed_motion_destroy(&s[way].changed);
}

/* Jumps that are lost and won in rounding: adding and taking away would not do. */
TEST_IN_BOTH(undoing_brings_every_bit_back)
{
    const motion_polynomial still = {.dim = dim};
    step s, before;
    open_step(&s, 1.0);
    before = s;
    for (int round = 0; round < 3; round++) {
        for (int k = 0; k < 700; k++) {
            const double size = pow(10.0, k % 40 - 20);
            const motion_change jump = {
                {size, -0.3 * size, size}, {1.1 * size, size, -size}, {0.7 * size, -size, 0.1 * size}};
            set_motion(&s.changed, (2 * k) % n_nodes, &still);
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

TEST_IN_BOTH(the_next_step_knows_nothing_of_the_last_which_stays_as_it_is)
{
    const motion_polynomial still = {.dim = dim};
    step s, next;
    open_step(&s, 1.0);
    set_motion(&s.changed, 2, &still);
    changed_motion_move_end(&s.changed, 2, &(motion_change){.x = {1.0, 1.0, 1.0}});
    next = s;
    changed_motion_start(&s.changed, 2.0, next.y1, next.f1);
    assert_false(changed_motion_has(&s.changed, 2));
    set_motion(&s.changed, 0, &still);
    changed_motion_undo(&s.changed);
    assert_memory_equal(s.y1, next.y1, sizeof s.y1);
    assert_close(s.y1[2 * dim], 1.0 / (3.0 + 2 * dim) + 1.0, 1e-15);
    changed_motion_destroy(&s.changed);
}
