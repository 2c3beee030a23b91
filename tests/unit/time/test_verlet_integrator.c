/* SPDX-License-Identifier: BSD-3-Clause */
/* verlet_integrator.c: order, reversibility, stability with and without damping, roots on its own dense output,
 * prescribed velocities. */
#include "verification/support.h"

#include <string.h>

#include "base/status.h"
#include "harness/message.h"
#include "time/attempt.h"
#include "time/integrator.h"
#include "unit/time/floor_and_ceiling.h"

static const double g = 9.81;

/* x'' = -omega^2 sin x - gamma v in the first component; y falls freely. The same answer for any number of calls. */
typedef struct world {
    double omega, gamma;
    floor_and_ceiling walls;
    double fails_after; /* s */
    double pulled;      /* m/s: velocity of x as prescribed, or NAN */
    int n_known;        /* calls of stiffening() for the state of the last derivative */
    double stiff_below; /* m: the stiffening is 3 where x is below */
    int calls;          /* of derivative */
} world;

static const world plain = {.omega = 1.0, .fails_after = 1e9, .pulled = (double)NAN, .stiff_below = -1e9};

static int move(double t, const double *y, double *u, double *a, void *context)
{
    world *w = context;
    w->calls++;
    assert_true(isnan(w->pulled) == (u == NULL)); /* wanted only if something is prescribed */
    if (u != NULL) {
        u[0] = w->pulled;
        u[1] = y[3];
    }
    a[0] = isnan(w->pulled) ? -w->omega * w->omega * sin(y[0]) - w->gamma * y[2] : 0.0;
    a[1] = -g;
    if (!(t > w->fails_after)) return 0;
    (void)status_fail(DEM_ERROR_INTEGRATOR, "the test's force fails");
    return 1;
}

static void begin_roots(double t, const double *y, void *context)
{
    world *w = context;
    (void)t;
    floor_and_ceiling_begin(&w->walls, y);
}

static double root_function(const dense_output *step, void *context)
{
    world *w = context;
    return floor_and_ceiling_root(&w->walls, step);
}

static double stiffening(const double *y, bool is_known, void *context)
{
    world *w = context;
    w->n_known += is_known;
    return y[0] < w->stiff_below ? 3.0 : 1.0;
}

static integrator make(world *w, double h, bool rooted, const double *y)
{
    const ode_problem problem = {.layout = {.dim = 2, .n_nodes = 1, .n_rows = 1},
                                 .ops = &array_ops_portable,
                                 .prescribes = !isnan(w->pulled),
                                 .derivative = move,
                                 .begin_roots = rooted ? begin_roots : NULL,
                                 .root_function = rooted ? root_function : NULL,
                                 .stiffening = stiffening,
                                 .context = w,
                                 .method = DEM_METHOD_VERLET,
                                 .max_step = h,
                                 .fixed_step = h};
    integrator V;
    assert_ok(integrator_create(&V, &problem, 0.0, y));
    return V;
}

static dense_output take(integrator *V, int n)
{
    dense_output p = {0};
    for (int k = 0; k < n; k++) {
        bool rooted;
        assert_ok(integrator_step(V, &p, &rooted));
        assert_false(rooted);
    }
    return p;
}

/* State after n steps of h. */
static void run(world w, double h, int n, const double *y0, double *y)
{
    CLEANUP(integrator_destroy) integrator V = make(&w, h, false, y0);
    const dense_output p = take(&V, n);
    memcpy(y, p.y1, 4 * sizeof *y);
    assert_int_equal(w.calls, n + 1);
    assert_int_equal(w.walls.asked, 0);
    assert_int_equal(integrator_counts(&V).evaluations, n + 1);
    assert_int_equal(integrator_counts(&V).steps, n);
}

/* ---- the step ---- */

/* x1 = x0 + h v0 + h^2/2 a0, v1 = v0 + h (a0 + a1)/2. */
TEST(a_step_is_a_kick_a_drift_and_a_kick)
{
    const double y0[4] = {0.4, 1.0, -0.3, 2.0}, h = 0.2, a0 = -sin(0.4);
    double y[4];
    run(plain, h, 1, y0, y);
    assert_close(y[0], 0.4 - 0.3 * h + 0.5 * h * h * a0, 1e-16);
    assert_close(y[2], -0.3 + 0.5 * h * (a0 - sin(y[0])), 1e-16);
    assert_close(y[1], 1.0 + 2.0 * h - 0.5 * g * h * h, 1e-15);
    assert_close(y[3], 2.0 - g * h, 1e-15);
}

/* ---- steps in one pass ---- */

/* A book beside the node: its rate is the node's height. */
static int move_with_book(double t, const double *y, double *u, double *a, void *context)
{
    const double node[4] = {y[0], y[1], y[4], y[5]};
    a[2] = y[1];
    a[3] = 1.0;
    return move(t, node, u, a, context);
}

/* A fused step of the node, but not from below 0. Quadratures' velocities are left to the integrator, their rates are
 * those above. */
static int fused_from_above(const ode_fused_step *s, void *context)
{
    const double h = s->h;
    double y1[4];
    if (s->y0[1] < 0.0) return -1;
    for (int c = 0; c < 2; c++) {
        const double half = s->y0[4 + c] + 0.5 * h * s->f0[4 + c];
        s->y1[c] = y1[c] = s->y0[c] + h * half;
        y1[2 + c] = half + 0.5 * h * s->f0[4 + c];
    }
    const int flag = move(s->t1, y1, NULL, s->f1 + 4, context);
    for (int c = 0; c < 2; c++) s->y1[4 + c] = y1[2 + c] + 0.5 * h * (s->f1[4 + c] - s->f0[4 + c]);
    s->f1[6] = s->y1[1];
    s->f1[7] = 1.0;
    return flag;
}

TEST(a_step_in_one_pass_is_that_in_parts)
{
    const double start[8] = {0.4, 1.0, 7.0, -7.0, -0.3, 2.0, 3.0, 5.0}, h = 0.05;
    for (int k = 0; k < 2; k++) {
        world worlds[2] = {plain, plain};
        dense_output p[2];
        integrator V[2];
        if (k == 1) worlds[0].fails_after = worlds[1].fails_after = 7.5 * h;
        for (int fused = 0; fused < 2; fused++) {
            const ode_problem problem = {.method = DEM_METHOD_VERLET,
                                         .layout = {.dim = 2, .n_nodes = 1, .n_rows = 2},
                                         .ops = &array_ops_portable,
                                         .derivative = move_with_book,
                                         .fused_step = fused ? fused_from_above : NULL,
                                         .context = &worlds[fused],
                                         .fixed_step = h};
            assert_ok(integrator_create(&V[fused], &problem, 0.0, start));
            bool rooted;
            for (int step = 0; step < (k == 0 ? 40 : 7); step++)
                assert_ok(integrator_step(&V[fused], &p[fused], &rooted));
            if (k == 1) assert_int_equal(integrator_step(&V[fused], &p[fused], &rooted), DEM_ERROR_INTEGRATOR);
        }
        if (k == 0) assert_memory_equal(p[0].y1, p[1].y1, sizeof start);
        if (k == 0) assert_true(p[0].y1[1] < 0.0); /* both ways have been gone */
        assert_int_equal(worlds[0].calls, worlds[1].calls);
        const dem_counts a = integrator_counts(&V[0]), b = integrator_counts(&V[1]);
        assert_memory_equal(&a, &b, sizeof a);
        integrator_destroy(&V[0]);
        integrator_destroy(&V[1]);
    }
}

/* The same with rates that do not change after the start. */
static int move_with_clock(double t, const double *y, double *u, double *a, void *context)
{
    const int flag = move_with_book(t, y, u, a, context);
    a[2] = t > 0.0 ? 3.0 : 5.0;
    return flag;
}

/* Several fused steps, but none if one begins below 0. */
static bool fuse_several_above(const ode_fused_step *steps, int n, void *context)
{
    for (int k = 0; k < n; k++) {
        if (fused_from_above(&steps[k], context) != 0) return false;
        steps[k].f1[6] = 3.0;
    }
    return true;
}

/* Steps until they are refused, which changes nothing, and then by themselves. */
TEST(steps_at_once_are_those_in_turn)
{
    const double start[8] = {0.4, 1.0, 7.0, -7.0, -0.3, 2.0, 3.0, 5.0}, h = 0.05;
    for (int n = 1; n <= 8; n++) {
        world worlds[2] = {plain, plain};
        integrator V[2];
        int taken = 0;
        double ends[8];
        bool rooted;
        dense_output last;
        for (int k = 0; k < 2; k++) {
            const ode_problem problem = {.method = DEM_METHOD_VERLET,
                                         .layout = {.dim = 2, .n_nodes = 1, .n_rows = 2},
                                         .ops = &array_ops_portable,
                                         .derivative = move_with_clock,
                                         .fused_steps = fuse_several_above,
                                         .context = &worlds[k],
                                         .fixed_step = h};
            assert_ok(integrator_create(&V[k], &problem, 0.0, start));
        }
        for (; integrator_take_unseen(&V[1], n, ends, &last); taken++) {
            assert_true(last.y1 == integrator_state(&V[1]) && last.end == ends[n - 1] && last.t1 == ends[n - 1]);
            assert_int_equal(integrator_counts(&V[1]).steps, n * (taken + 1));
            for (int k = 0; k < n; k++) assert_close(ends[k], h * (n * taken + k + 1), 1e-14);
        }
        assert_true(taken > 0);
        for (int k = 0; k < 2; k++) {
            dense_output p;
            for (int step = 0; step < (k == 0 ? n * taken : 0) + 2; step++) {
                assert_ok(integrator_step(&V[k], &p, &rooted));
                integrator_settle(&V[k], &p);
            }
            assert_true(k == 0 || p.t0 > 0.2);
        }
        assert_memory_equal(integrator_state(&V[0]), integrator_state(&V[1]), sizeof start);
        const dem_counts a = integrator_counts(&V[0]), b = integrator_counts(&V[1]);
        assert_memory_equal(&a, &b, sizeof a);
        integrator_destroy(&V[0]);
        integrator_destroy(&V[1]);
    }
}

/* ---- its laws ---- */

/* With damping too, whose velocity is extrapolated: halving the step quarters the difference, to what the next order
 * adds. */
TEST(the_order_is_two_with_forces_of_any_kind)
{
    const double y0[4] = {1.0, 0.0, 0.5, 0.0};
    for (int damped = 0; damped < 2; damped++) {
        world w = plain;
        double y[3][4];
        w.gamma = 0.7 * damped;
        for (int k = 0; k < 3; k++) run(w, 0.01 / (1 << k), 500 << k, y0, y[k]);
        for (int c = 0; c < 3; c += 2) assert_close((y[0][c] - y[1][c]) / (y[1][c] - y[2][c]), 4.0, 0.15);
    }
}

/* Back to the start, but for rounding, when the velocity is turned round: that is what keeps the energy. */
TEST(it_runs_backwards)
{
    const double y0[4] = {1.0, 0.0, 0.5, 3.0};
    double y[4], back[4];
    run(plain, 0.3, 1000, y0, y);
    const double turned[4] = {y[0], y[1], -y[2], -y[3]};
    run(plain, 0.3, 1000, turned, back);
    assert_close(back[0], y0[0], 1e-10);
    assert_close(back[2], -y0[2], 1e-10);
}

static double amplitude(double omega, double gamma, double h)
{
    const double y0[4] = {1e-9, 0.0, 0.0, 0.0};
    world w = plain;
    double y[4];
    w.omega = omega;
    w.gamma = gamma;
    run(w, h, 4000, y0, y);
    return fmax(fabs(y[0]), fabs(y[2])) / 1e-9;
}

/* Stable up to (omega h)^2 = 4 (1 - gamma h). */
TEST(the_stability_bound_is_that_of_the_characteristic_equation)
{
    static const double damping[4] = {0.0, 0.1, 0.5, 0.9};
    for (int k = 0; k < 4; k++) {
        const double bound = 2.0 * sqrt(1.0 - damping[k]);
        assert_true(amplitude(0.99 * bound, damping[k], 1.0) < 100.0);
        assert_true(amplitude(1.01 * bound, damping[k], 1.0) > 1e3);
    }
}

/* The step is halved twice for a stiffening of 3, and is whole again after. */
TEST(stiffening_halves_the_step)
{
    const double y0[4] = {0.9, 0.0, -1.0, 0.0};
    world w = plain;
    dense_output p = {0};
    w.stiff_below = 0.5;
    w.omega = 3.0;
    CLEANUP(integrator_destroy) integrator V = make(&w, 0.1, false, y0);
    int n_short = 0, n_long = 0;
    for (int k = 0; k < 100; k++) {
        bool rooted;
        assert_ok(integrator_step(&V, &p, &rooted));
        assert_close(p.t1 - p.t0, p.y0[0] < 0.5 ? 0.025 : 0.1, 1e-14);
        *(p.y0[0] < 0.5 ? &n_short : &n_long) += 1;
    }
    assert_true(n_short > 10 && n_long > 10);
}

/* Unless the caller has changed it. */
TEST(stiffening_knows_the_state_of_the_last_derivative)
{
    const double y0[4] = {0.9, 0.0, -1.0, 0.0};
    world w = plain;
    dense_output p = {0};
    bool rooted;
    CLEANUP(integrator_destroy) integrator V = make(&w, 0.1, false, y0);
    for (int k = 0; k < 6; k++) {
        if (k == 3) assert_ok(integrator_resume(&V));
        assert_ok(integrator_step(&V, &p, &rooted));
        assert_int_equal(w.n_known, k < 3 ? k + 1 : k);
    }
}

static double endless(const double *y, bool is_known, void *context)
{
    (void)is_known;
    (void)y;
    (void)context;
    return (double)INFINITY;
}

TEST(no_stiffening_stops_the_time)
{
    const ode_problem problem = {.fixed_step = 0.1, .stiffening = endless};
    assert_true(attempt_fixed_step(&(attempt){.problem = &problem}, NULL, false) > 1e-12);
}

/* What the derivative gives in place of a velocity is taken over, at rest or not. */
TEST(prescribed_velocities_are_taken_over)
{
    const double y0[4] = {0.0, 0.0, 0.25, 0.0};
    double y[4];
    world w = plain;
    w.pulled = 0.5;
    run(w, 0.1, 10, y0, y);
    assert_close(y[2], 0.5, 0.0);
    assert_close(y[0], 0.1 * 0.25 + 0.9 * 0.5, 1e-15); /* the first step starts from what the caller gave */
}

/* ---- its dense output ---- */

/* Up to any time within a step it is where a step of that length would go; its velocity there differs in the third
 * order. */
TEST(the_dense_output_of_a_step_is_that_of_shorter_steps)
{
    const double y0[4] = {1.0, 2.0, 0.5, 3.0}, h = 0.1;
    world w = plain;
    CLEANUP(integrator_destroy) integrator V = make(&w, h, false, y0);
    const dense_output p = take(&V, 1);
    for (int k = 0; k <= 10; k++) {
        double y[4], inside[4];
        run(plain, fmax(h * k / 10.0, 1e-300), 1, y0, y);
        dense_output_state(&p, h * k / 10.0, inside);
        for (int c = 0; c < 4; c++) assert_close(inside[c], y[c], c == 2 ? 0.1 * h * h * h : 1e-15);
    }
}

TEST(a_step_starts_where_the_last_one_ended)
{
    const double y0[4] = {1.0, 2.0, 0.5, 3.0};
    world w = plain;
    double t = 0.0, y[4], a[2];
    memcpy(y, y0, sizeof y);
    CLEANUP(integrator_destroy) integrator V = make(&w, 0.1, true, y0);
    w.walls.floor = -1e3;
    for (int k = 0; k < 20; k++) {
        dense_output p;
        bool rooted;
        assert_ok(integrator_step(&V, &p, &rooted));
        assert_close(p.t0, t, 0.0);
        assert_memory_equal(p.y0, y, sizeof y);
        (void)move(p.t1, p.y1, NULL, a, &w);
        for (int c = 0; c < 2; c++) assert_close(p.f1[2 + c], a[c], 1e-15);
        t = p.t1;
        memcpy(y, p.y1, sizeof y);
    }
}

/* ---- roots ---- */

static void step_to_root(integrator *V, dense_output *p)
{
    bool rooted = false;
    for (int k = 0; k < 1000 && !rooted; k++) {
        assert_ok(integrator_step(V, p, &rooted));
        if (!rooted) assert_true(p->end == p->t1);
    }
    assert_true(rooted);
    assert_true(p->t0 < p->end && p->end <= p->t1);
}

/* Free fall is a parabola, so that time and place are exact to the 100 units of rounding to which roots are found. */
TEST(the_floor_is_hit_at_the_time_of_free_fall)
{
    const double y0[4] = {0.0, 0.9, 0.0, 0.0}, t = sqrt(2.0 * 0.7 / g);
    world w = plain;
    dense_output p;
    double y[4];
    w.walls.floor = 0.2;
    CLEANUP(integrator_destroy) integrator V = make(&w, 0.1, true, y0);
    step_to_root(&V, &p);
    assert_close(p.end, t, 1e-13);
    dense_output_state(&p, p.end, y);
    assert_close(y[1], 0.2, 1e-12);
    assert_close(y[3], -g * t, 1e-12);
    assert_true(w.walls.asked < 30); /* 4 steps; secants do it in a few */
}

/* From below through the floor is none, the ceiling above it is. */
TEST(a_root_is_looked_for_only_as_the_function_falls)
{
    const double y0[4] = {0.0, -0.5, 0.0, 10.0};
    world w = plain;
    dense_output p;
    CLEANUP(integrator_destroy) integrator V = make(&w, 0.04, true, y0);
    step_to_root(&V, &p);
    assert_close(p.end, (10.0 - sqrt(100.0 - 2.0 * g * 1.5)) / g, 1e-13);
}

/* Reflected a penetration tolerance above the floor it comes back after the time of the throw. Without a restart it
 * goes on through. */
TEST(it_goes_on_from_a_new_state_or_through_the_root)
{
    const double y0[4] = {0.0, 0.5, 0.0, 0.0}, penetration_tolerance = 1e-9, u = sqrt(2.0 * g * 0.5);
    double reflected[4];
    for (int restarted = 0; restarted < 2; restarted++) {
        world w = plain;
        dense_output p;
        bool rooted;
        w.walls.floor = -penetration_tolerance;
        CLEANUP(integrator_destroy) integrator V = make(&w, 0.07, true, y0);
        step_to_root(&V, &p);
        const double first = p.end, t1 = p.t1;
        dense_output_state(&p, p.end, reflected);
        reflected[1] = 0.0;
        reflected[3] = u;
        if (restarted) {
            assert_ok(integrator_restart(&V, first, reflected));
            step_to_root(&V, &p);
            assert_close(p.end, first + (u + sqrt(u * u + 2.0 * g * penetration_tolerance)) / g, 1e-12);
        } else {
            assert_ok(integrator_step(&V, &p, &rooted));
            assert_false(rooted);
            assert_close(p.t0, t1, 0.0);
            assert_close(p.y1[1], 0.5 - 0.5 * g * p.t1 * p.t1, 1e-13);
        }
    }
}

/* ---- failures ---- */

TEST(a_derivative_that_fails_leaves_the_last_state)
{
    const double y0[4] = {1.0, 2.0, 0.5, 3.0};
    world w = plain;
    dense_output p = {0};
    bool rooted;
    double y[4];
    w.fails_after = 0.55;
    integrator V = make(&w, 0.1, false, y0);
    p = take(&V, 5);
    memcpy(y, p.y1, sizeof y);
    assert_int_equal(integrator_step(&V, &p, &rooted), DEM_ERROR_INTEGRATOR);
    assert_message_parts("the test's force fails");
    w.fails_after = 1e9;
    assert_ok(integrator_step(&V, &p, &rooted));
    assert_memory_equal(p.y0, y, sizeof y);
    integrator_destroy(&V);
    integrator_destroy(&(integrator){0});
}

TEST(a_root_function_that_is_no_number_is_an_error)
{
    const double y0[4] = {1.0, 2.0, 0.5, 3.0};
    world w = plain;
    dense_output p;
    bool rooted;
    CLEANUP(integrator_destroy) integrator V = make(&w, 0.1, true, y0);
    assert_ok(integrator_step(&V, &p, &rooted));
    w.walls.broken = true;
    assert_int_equal(integrator_step(&V, &p, &rooted), DEM_ERROR_INTEGRATOR);
    assert_message_parts("not finite * t = 0.2 s");
}

TEST(without_a_fixed_step_it_is_refused)
{
    const ode_problem problem = {.method = DEM_METHOD_VERLET,
                                 .layout = {.dim = 2, .n_nodes = 1, .n_rows = 1},
                                 .ops = &array_ops_portable,
                                 .derivative = move,
                                 .max_step = 1.0};
    const double y0[4] = {0.0};
    integrator V;
    assert_int_equal(integrator_create(&V, &problem, 0.0, y0), DEM_ERROR_ARGUMENT);
    assert_null(V.self);
}
