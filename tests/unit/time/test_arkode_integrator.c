/* SPDX-License-Identifier: BSD-3-Clause */
/* arkode_integrator.c: order of the methods, error control, located roots, restarts, failing derivatives. */
#include "verification/support.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <gsl/gsl_sf_elljac.h>

#include "base/status.h"
#include "harness/message.h"
#include "time/integrator.h"
#include "unit/time/floor_and_ceiling.h"

static const double g = 9.81;

/* What the callbacks get. */
typedef struct world {
    double fails_after; /* s: derivatives later than this fail ... */
    int failures_left;  /* ... as often as this */
    int calls;
    bool is_calm; /* rattle_middle() accelerates no node any more */
    floor_and_ceiling walls;
} world;

static int fail_if_due(world *w, double t)
{
    w->calls++;
    if (!(t > w->fails_after) || w->failures_left == 0) return 0;
    w->failures_left--;
    (void)status_fail(DEM_ERROR_INTEGRATOR, "the test's force fails");
    return 1;
}

/* Two pendulums, x'' = -sin x in each component. */
static int swing(double t, const double *y, double *u, double *a, void *context)
{
    for (int k = 0; k < 2; k++) {
        u[k] = y[2 + k];
        a[k] = -sin(y[k]);
    }
    return fail_if_due(context, t);
}

static int fall(double t, const double *y, double *u, double *a, void *context)
{
    u[0] = y[2];
    u[1] = y[3];
    a[0] = 0.0;
    a[1] = -g;
    return fail_if_due(context, t);
}

static int rattle(double t, const double *y, double *u, double *a, void *context)
{
    const world *w = context;
    u[0] = y[2];
    u[1] = y[3];
    a[0] = a[1] = w->calls % 2 == 0 ? 1e6 : -1e6;
    return fail_if_due(context, t);
}

/* Three nodes at rest, of which the one in the middle rattles along y until it is calm. */
static int rattle_middle(double t, const double *y, double *u, double *a, void *context)
{
    const world *w = context;
    for (int k = 0; k < 6; k++) {
        u[k] = y[6 + k];
        a[k] = 0.0;
    }
    if (!w->is_calm) a[3] = w->calls % 2 == 0 ? 1e6 : -1e6;
    return fail_if_due(context, t);
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

static integrator make(world *w, int (*derivative)(double, const double *, double *, double *, void *),
                       dem_method method, double error, double fixed_step, const double *y)
{
    const ode_problem problem = {.layout = {.dim = 2, .n_nodes = 1, .n_rows = 1},
                                 .ops = &array_ops_portable,
                                 .derivative = derivative,
                                 .context = w,
                                 .method = method,
                                 .position_error = error,
                                 .velocity_error = error,
                                 .max_step = fixed_step > 0.0 ? fixed_step : 0.1,
                                 .fixed_step = fixed_step};
    integrator i;
    assert_ok(integrator_create(&i, &problem, 0.0, y));
    return i;
}

static const double amplitude[2] = {1.0, 2.5};
static const double at_rest[4] = {1.0, 2.5, 0.0, 0.0};

/* sin(x/2) = k cd(t), k = sin(amplitude/2); x' from its derivative, cd' = -(1 - k^2) sn/dn^2. */
static void exact_swing(double t, double y[4])
{
    for (int c = 0; c < 2; c++) {
        double sn, cn, dn;
        const double k = sin(0.5 * amplitude[c]);
        assert_int_equal(gsl_sf_elljac_e(t, k * k, &sn, &cn, &dn), 0);
        const double cd = cn / dn;
        y[c] = 2.0 * asin(k * cd);
        y[2 + c] = -2.0 * k * (1.0 - k * k) * sn / (dn * dn) / sqrt(1.0 - k * k * cd * cd);
    }
}

static double error_against_exact(const double *y, double t)
{
    double exact[4], largest = 0.0;
    exact_swing(t, exact);
    for (int k = 0; k < 4; k++) largest = fmax(largest, fabs(y[k] - exact[k]));
    return largest;
}

/* ---- order and accuracy ---- */

static double error_of_fixed_steps(dem_method method, int n, int evaluations)
{
    world w = {.fails_after = 1e9};
    dense_output p = {0};
    CLEANUP(integrator_destroy) integrator i = make(&w, swing, method, 1.0, 6.0 / n, at_rest);
    for (int k = 0; k < n; k++) {
        bool rooted;
        assert_ok(integrator_step(&i, &p, &rooted));
        assert_false(rooted);
        assert_close(p.t1, 6.0 * (k + 1) / n, 1e-12);
    }
    const double error = error_against_exact(p.y1, p.t1);
    assert_int_equal(integrator_counts(&i).steps, n);
    assert_int_equal(integrator_counts(&i).rejected, 0);
    assert_int_equal(integrator_counts(&i).evaluations, n * evaluations + 1);
    return error;
}

/* Slope of the error over a doubling of the steps, which are as many as keep it above rounding. A third lower would be
 * another order; on this equation some are better than theirs. */
TEST(each_method_has_its_order)
{
    static const int steps[10] = {0, 0, 400, 400, 480, 120, 60, 30, 20, 16};
    for (int method = DEM_METHOD_FEHLBERG45; method < DEM_METHOD_VERLET; method++) {
        dem_method_traits traits = {.struct_size = sizeof traits};
        if (dem_method_describe(&traits, (dem_method)method) != DEM_OK) {
            assert_non_null(strstr(dem_status_message(), "needs SUNDIALS 6.7 or later"));
            continue;
        }
        const int n = steps[traits.order];
        const double coarse = error_of_fixed_steps((dem_method)method, n, traits.evaluations);
        const double fine = error_of_fixed_steps((dem_method)method, 2 * n, traits.evaluations);
        const double order = log2(coarse / fine);
        if (!(order > traits.order - 0.35 && order < traits.order + 1.35))
            fail_msg("%s has order %.2f, not %d", traits.name, order, traits.order);
    }
}

/* Errors of 1e-10 per step over about 100 steps; none of them may be as coarse as the capped step alone would be. */
TEST(adaptive_steps_keep_the_error_they_are_given)
{
    const double errors[2] = {1e-6, 1e-10};
    for (int k = 0; k < 2; k++) {
        world w = {.fails_after = 1e9};
        dense_output p = {0};
        CLEANUP(integrator_destroy) integrator i = make(&w, swing, DEM_METHOD_DOPRI45, errors[k], 0.0, at_rest);
        while (p.t1 < 6.0) {
            bool rooted;
            assert_ok(integrator_step(&i, &p, &rooted));
            assert_true(p.t1 - p.t0 <= 0.1 * (1.0 + 1e-15));
        }
        assert_true(error_against_exact(p.y1, p.t1) < 200.0 * errors[k]);
    }
}

static int steps_with_errors(double position, double velocity)
{
    world w = {.fails_after = 1e9};
    const ode_problem problem = {.layout = {.dim = 2, .n_nodes = 1, .n_rows = 1},
                                 .ops = &array_ops_portable,
                                 .derivative = swing,
                                 .context = &w,
                                 .position_error = position,
                                 .velocity_error = velocity,
                                 .max_step = 0.1};
    dense_output p = {0};
    CLEANUP(integrator_destroy) integrator i;
    int n = 0;
    assert_ok(integrator_create(&i, &problem, 0.0, at_rest));
    for (; p.t1 < 6.0; n++) {
        bool rooted;
        assert_ok(integrator_step(&i, &p, &rooted));
    }
    return n;
}

/* 60 of the longest steps make up 6 s; the first is a tenth of it. */
TEST(errors_of_positions_and_of_velocities_both_count)
{
    assert_true(steps_with_errors(1.0, 1.0) <= 62);
    assert_true(steps_with_errors(1e-11, 1.0) > 100);
    assert_true(steps_with_errors(1.0, 1e-11) > 100);
}

TEST(an_unknown_method_is_refused)
{
    const ode_problem problem = {.layout = {.dim = 2, .n_nodes = 1, .n_rows = 1},
                                 .ops = &array_ops_portable,
                                 .derivative = fall,
                                 .method = (dem_method)77,
                                 .position_error = 1.0,
                                 .velocity_error = 1.0,
                                 .max_step = 1.0};
    integrator i;
    assert_int_equal(integrator_create(&i, &problem, 0.0, at_rest), DEM_ERROR_ARGUMENT);
    assert_message_parts("method 77");
    assert_null(i.self);
    integrator_destroy(&(integrator){0});
}

/* ---- the dense output of a step ---- */

/* ARKODE's interpolant gives the derivatives at its ends back to rounding. */
TEST(a_step_starts_where_the_last_one_ended_and_holds_the_derivatives)
{
    world w = {.fails_after = 1e9};
    dense_output p;
    double t = 0.0, y[4], f[4];
    memcpy(y, at_rest, sizeof y);
    CLEANUP(integrator_destroy) integrator i = make(&w, swing, DEM_METHOD_FEHLBERG45, 1e-8, 0.0, at_rest);
    for (int k = 0; k < 30; k++) {
        bool rooted;
        assert_ok(integrator_step(&i, &p, &rooted));
        assert_int_equal(p.layout.n_rows, 1);
        assert_close(p.t0, t, 0.0);
        assert_true(p.t1 > t && p.end == p.t1);
        assert_memory_equal(p.y0, y, sizeof y);
        (void)swing(p.t0, p.y0, f, f + 2, &w);
        for (int q = 0; q < 4; q++) assert_close(p.f0[q], f[q], 1e-15);
        (void)swing(p.t1, p.y1, f, f + 2, &w);
        for (int q = 0; q < 4; q++) assert_close(p.f1[q], f[q], 1e-15);
        t = p.t1;
        memcpy(y, p.y1, sizeof y);
    }
}

TEST(after_a_restart_the_dense_output_has_the_derivatives_of_the_new_state)
{
    const double elsewhere[4] = {0.3, -0.7, 1.5, 2.5};
    world w = {.fails_after = 1e9};
    dense_output p;
    double f[4];
    bool rooted;
    CLEANUP(integrator_destroy) integrator i = make(&w, swing, DEM_METHOD_FEHLBERG45, 1e-8, 0.0, at_rest);
    for (int k = 0; k < 3; k++) assert_ok(integrator_step(&i, &p, &rooted));
    assert_ok(integrator_restart(&i, p.t1, elsewhere));
    assert_ok(integrator_step(&i, &p, &rooted));
    (void)swing(p.t0, elsewhere, f, f + 2, &w);
    assert_memory_equal(p.y0, elsewhere, sizeof elsewhere);
    for (int q = 0; q < 4; q++) assert_close(p.f0[q], f[q], 1e-13);
}

TEST(evaluations_are_counted)
{
    world w = {.fails_after = 1e9};
    CLEANUP(integrator_destroy) integrator i = make(&w, swing, DEM_METHOD_FEHLBERG45, 1e-8, 0.0, at_rest);
    for (int k = 0; k < 10; k++) {
        dense_output p;
        bool rooted;
        assert_ok(integrator_step(&i, &p, &rooted));
    }
    assert_true(w.calls >= 60); /* six stages */
    assert_int_equal(integrator_counts(&i).evaluations, w.calls);
    assert_int_equal(integrator_counts(&i).steps, 10);
    assert_int_equal(integrator_counts(&i).retries, 0);
}

/* ---- roots ---- */

static integrator make_fall(world *w, const double *y)
{
    const ode_problem problem = {.layout = {.dim = 2, .n_nodes = 1, .n_rows = 1},
                                 .ops = &array_ops_portable,
                                 .derivative = fall,
                                 .begin_roots = begin_roots,
                                 .root_function = root_function,
                                 .context = w,
                                 .method = DEM_METHOD_FEHLBERG45,
                                 .position_error = 1e-12,
                                 .velocity_error = 1e-12,
                                 .max_step = 0.1};
    integrator i;
    assert_ok(integrator_create(&i, &problem, 0.0, y));
    return i;
}

static void step_to_root(integrator *i, dense_output *p)
{
    bool rooted = false;
    for (int k = 0; k < 1000 && !rooted; k++) {
        assert_ok(integrator_step(i, p, &rooted));
        if (!rooted) assert_true(p->end == p->t1);
    }
    assert_true(rooted);
    assert_true(p->t0 < p->end && p->end <= p->t1);
}

/* From 0.9 m to a floor at 0.2 m, with time and place to 1e-12: ARKODE's 100 units of rounding of the time, and
 * rounding of the motion. */
TEST(the_floor_is_hit_at_the_time_of_free_fall)
{
    const double y[4] = {0.0, 0.9, 1.0, 0.0}, t = sqrt(2.0 * 0.7 / g);
    world w = {.fails_after = 1e9, .walls.floor = 0.2};
    dense_output p;
    double end[4];
    CLEANUP(integrator_destroy) integrator i = make_fall(&w, y);
    step_to_root(&i, &p);
    assert_close(p.end, t, 1e-12);
    dense_output_state(&p, p.end, end);
    assert_close(end[1], 0.2, 1e-12);
    assert_close(end[3], -g * t, 1e-12);
}

/* Starts below the floor and rises through it, which is no root; then the ceiling is one, from below, where its
 * root function falls. */
TEST(a_root_is_looked_for_only_as_the_function_falls)
{
    const double y[4] = {0.0, -0.5, 0.0, 10.0};
    world w = {.fails_after = 1e9, .walls.floor = 0.0};
    dense_output p;
    CLEANUP(integrator_destroy) integrator i = make_fall(&w, y);
    step_to_root(&i, &p);
    assert_close(p.end, (10.0 - sqrt(100.0 - 2.0 * g * 1.5)) / g, 1e-12);
}

/* Reflected at the floor it comes down again after 2 v/g; the penetration tolerance of 1e-9 m below the restart makes
 * the root function positive there. The first step after the restart is as long as before. */
TEST(a_restart_goes_on_from_the_new_state_with_the_step_kept)
{
    const double y[4] = {0.0, 0.5, 1.0, 0.0}, penetration_tolerance = 1e-9, u = sqrt(2.0 * g * 0.5);
    world w = {.fails_after = 1e9, .walls.floor = -penetration_tolerance};
    double reflected[4];
    dense_output p;
    bool rooted;
    CLEANUP(integrator_destroy) integrator i = make_fall(&w, y);
    step_to_root(&i, &p);
    const double first = p.end;
    dense_output_state(&p, p.end, reflected);
    reflected[1] = 0.0;
    reflected[3] = u;
    assert_ok(integrator_restart(&i, first, reflected));
    assert_ok(integrator_step(&i, &p, &rooted));
    assert_close(p.t0, first, 0.0);
    assert_memory_equal(p.y0, reflected, sizeof reflected);
    assert_close(p.t1 - p.t0, 0.1, 1e-15);
    step_to_root(&i, &p);
    assert_close(p.end, first + (u + sqrt(u * u + 2.0 * g * penetration_tolerance)) / g, 1e-12);
    dense_output_state(&p, p.end, reflected);
    assert_close(reflected[0], p.end, 1e-12);
}

/* Without a restart a step that was cut short at a root goes on to its end. */
TEST(without_a_restart_it_goes_on_through_a_root)
{
    const double y[4] = {0.0, 0.5, 1.0, 0.0};
    world w = {.fails_after = 1e9, .walls.floor = 0.0};
    dense_output p;
    bool rooted;
    CLEANUP(integrator_destroy) integrator i = make_fall(&w, y);
    step_to_root(&i, &p);
    const double t1 = p.t1;
    assert_ok(integrator_step(&i, &p, &rooted));
    assert_close(p.t0, t1, 0.0);
    assert_close(p.y1[1], 0.5 - 0.5 * g * p.t1 * p.t1, 1e-12);
}

/* ---- failures ---- */

TEST(a_derivative_that_fails_for_good_ends_in_an_error_at_the_last_good_state)
{
    world w = {.fails_after = 0.25, .failures_left = -1};
    dense_output p = {0};
    bool rooted;
    dem_status status = DEM_OK;
    double last = 0.0;
    CLEANUP(integrator_destroy) integrator i = make(&w, swing, DEM_METHOD_FEHLBERG45, 1e-6, 0.0, at_rest);
    for (int k = 0; k < 1000 && status == DEM_OK; k++) {
        last = p.t1;
        status = integrator_step(&i, &p, &rooted);
    }
    assert_int_equal(status, DEM_ERROR_INTEGRATOR);
    assert_message_parts("the test's force fails");
    assert_true(last > 0.2499 && last <= 0.25); /* tenths of the step lead up to it */
    assert_true(integrator_counts(&i).retries >= 10);
    w.failures_left = 0; /* the state is still in force */
    assert_ok(integrator_step(&i, &p, &rooted));
    assert_close(p.t0, last, 0.0);
    assert_true(error_against_exact(p.y1, p.t1) < 1e-5);
}

TEST(a_derivative_that_fails_for_a_while_is_tried_again_with_smaller_steps)
{
    world w = {.fails_after = 0.25, .failures_left = 3};
    dense_output p = {0};
    CLEANUP(integrator_destroy) integrator i = make(&w, swing, DEM_METHOD_FEHLBERG45, 1e-8, 0.0, at_rest);
    while (p.t1 < 1.0) {
        bool rooted;
        assert_ok(integrator_step(&i, &p, &rooted));
    }
    assert_int_equal(w.failures_left, 0);
    assert_int_equal(integrator_counts(&i).retries, 3);
    assert_true(error_against_exact(p.y1, p.t1) < 1e-6);
}

TEST(fixed_steps_are_not_tried_again)
{
    world w = {.fails_after = 0.25, .failures_left = 1};
    dense_output p = {0};
    bool rooted;
    CLEANUP(integrator_destroy) integrator i = make(&w, swing, DEM_METHOD_FEHLBERG45, 1e-6, 0.1, at_rest);
    assert_ok(integrator_step(&i, &p, &rooted));
    assert_ok(integrator_step(&i, &p, &rooted));
    assert_int_equal(integrator_step(&i, &p, &rooted), DEM_ERROR_INTEGRATOR);
    assert_message_parts("the test's force fails");
    assert_int_equal(integrator_counts(&i).retries, 0);
}

TEST(a_tolerance_out_of_reach_is_reported)
{
    world w = {.fails_after = 1e9};
    dense_output p;
    bool rooted;
    CLEANUP(integrator_destroy) integrator i = make(&w, rattle, DEM_METHOD_FEHLBERG45, 1e-12, 0.0, at_rest);
    assert_int_equal(integrator_step(&i, &p, &rooted), DEM_ERROR_INTEGRATOR);
    assert_message_parts("t = 0 s * short * rtol");
    assert_true(integrator_counts(&i).rejected > 0);
}

TEST(the_node_whose_error_no_step_mends_is_named)
{
    const double y[12] = {0.1, 0.2, 0.3, -0.4, 0.5, 0.6};
    world w = {.fails_after = 1e9};
    const ode_problem problem = {.layout = {.dim = 2, .n_nodes = 3, .n_rows = 3},
                                 .ops = &array_ops_portable,
                                 .derivative = rattle_middle,
                                 .context = &w,
                                 .method = DEM_METHOD_FEHLBERG45,
                                 .position_error = 1e-12,
                                 .velocity_error = 1e-12,
                                 .max_step = 0.1};
    dense_output p;
    bool rooted;
    CLEANUP(integrator_destroy) integrator i;
    assert_ok(integrator_create(&i, &problem, 0.0, y));
    assert_int_equal(integrator_step(&i, &p, &rooted), DEM_ERROR_INTEGRATOR);
    assert_message_parts("t = 0 s * short * rtol * node 1, at (0.3, -0.4) m");
    w.is_calm = true; /* the state is still in force; its derivative is another one now */
    assert_ok(integrator_restart(&i, 0.0, integrator_state(&i)));
    assert_ok(integrator_step(&i, &p, &rooted));
    assert_close(p.t0, 0.0, 0.0);
    for (int k = 0; k < 6; k++) assert_close(p.y1[k], y[k], 1e-15);
}

TEST(a_tolerance_below_rounding_is_reported)
{
    world w = {.fails_after = 1e9};
    dense_output p;
    bool rooted;
    CLEANUP(integrator_destroy) integrator i = make(&w, swing, DEM_METHOD_FEHLBERG45, 1e-17, 0.0, at_rest);
    assert_int_equal(integrator_step(&i, &p, &rooted), DEM_ERROR_INTEGRATOR);
    assert_message_parts("t = 0 s * rounding * rtol");
}

TEST(a_root_function_that_is_no_number_is_an_error)
{
    world w = {.fails_after = 1e9, .walls.broken = true};
    dense_output p;
    bool rooted;
    CLEANUP(integrator_destroy) integrator i = make_fall(&w, at_rest);
    assert_int_equal(integrator_step(&i, &p, &rooted), DEM_ERROR_INTEGRATOR);
    assert_message_parts("t = 0 s * not finite");
}

TEST(the_version_of_sundials_has_three_numbers)
{
    int number[3] = {-1, -1, -1}, length = 0;
    assert_int_equal(sscanf(dem_version_sundials(), "%d.%d.%d%n", &number[0], &number[1], &number[2], &length), 3);
    assert_true(number[0] >= 6 && number[1] >= 0 && number[2] >= 0 && length >= 5);
}
