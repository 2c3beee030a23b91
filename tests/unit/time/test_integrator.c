/* SPDX-License-Identifier: BSD-3-Clause */
/* integrator.c: whichever method takes the steps, a ball bounces at the times of free fall, in which all are exact;
 * and it takes them alike in two and in three dimensions. */
#include "verification/support.h"

#include "time/integrator.h"
#include "unit/time/floor_and_ceiling.h"

static const double g = 9.81, penetration_tolerance = 1e-10;

typedef struct world {
    floor_and_ceiling walls;
    int calls; /* of the derivative */
} world;

static int fall(double t, const double *y, double *u, double *a, void *context)
{
    world *w = context;
    (void)t;
    w->calls++;
    for (int c = 0; c < 2 && u != NULL; c++) u[c] = y[2 + c];
    a[0] = 0.0;
    a[1] = -g;
    return 0;
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

TEST(every_method_finds_the_bounces_of_a_ball)
{
    const double y0[4] = {0.0, 0.5, 1.0, 0.0}, u = sqrt(2.0 * g * 0.5);
    for (int method = 0; method <= DEM_METHOD_VERLET; method++) {
        dem_method_traits traits = {.struct_size = sizeof traits};
        if (dem_method_describe(&traits, (dem_method)method) != DEM_OK) continue;
        world w = {.walls.floor = -penetration_tolerance};
        int bounces = 0;
        const ode_problem problem = {.layout = {.dim = 2, .n_nodes = 1, .n_rows = 1},
                                     .ops = &array_ops_portable,
                                     .derivative = fall,
                                     .begin_roots = begin_roots,
                                     .root_function = root_function,
                                     .context = &w,
                                     .method = (dem_method)method,
                                     .position_error = 1.0,
                                     .velocity_error = 1.0,
                                     .max_step = 0.05,
                                     .fixed_step = traits.adaptive ? 0.0 : 0.05};
        CLEANUP(integrator_destroy) integrator e;
        dense_output p = {0};
        assert_ok(integrator_create(&e, &problem, 0.0, y0));
        for (; bounces < 4;) {
            bool rooted;
            double y[4];
            assert_ok(integrator_step(&e, &p, &rooted));
            if (!rooted) continue;
            assert_close(p.end, (2 * bounces++ + 1) * u / g, 1e-9); /* what the penetration tolerance delays */
            dense_output_state(&p, p.end, y);
            assert_close(y[0], p.end, 1e-12);
            y[1] = 0.0;
            y[3] = -y[3];
            assert_ok(integrator_restart(&e, p.end, y));
        }
        const dem_counts counts = integrator_counts(&e);
        assert_int_equal(counts.evaluations, w.calls);
        assert_true(counts.steps >= (dem_index)(p.end / 0.05));
    }
}

/* Settled after each step and reflected where the state is; after a root nobody has to change anything. */
TEST(steps_are_settled_and_states_changed_where_they_are)
{
    const double y0[4] = {0.0, 0.5, 1.0, 0.0}, u = sqrt(2.0 * g * 0.5);
    const dem_method methods[] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET};
    for (int m = 0; m < 2; m++) {
        world w = {.walls.floor = -penetration_tolerance};
        int bounces = 0;
        const ode_problem problem = {.layout = {.dim = 2, .n_nodes = 1, .n_rows = 1},
                                     .ops = &array_ops_portable,
                                     .derivative = fall,
                                     .begin_roots = begin_roots,
                                     .root_function = root_function,
                                     .context = &w,
                                     .method = methods[m],
                                     .position_error = 1.0,
                                     .velocity_error = 1.0,
                                     .max_step = 0.05,
                                     .fixed_step = m == 0 ? 0.0 : 0.05};
        CLEANUP(integrator_destroy) integrator e;
        dense_output p = {0};
        double end[4];
        assert_ok(integrator_create(&e, &problem, 0.0, y0));
        assert_memory_equal(integrator_state(&e), y0, sizeof y0);
        while (bounces < 4) {
            bool rooted;
            assert_ok(integrator_step(&e, &p, &rooted));
            if (bounces > 0 || rooted) assert_true(p.t0 < p.t1);
            dense_output_state(&p, p.end, end);
            integrator_settle(&e, &p);
            double *y = integrator_state(&e);
            assert_memory_equal(y, end, sizeof end);
            if (!rooted) continue;
            assert_close(p.end, (2 * bounces++ + 1) * u / g, 1e-9);
            y[1] = 0.0;
            y[3] = -y[3];
            assert_ok(integrator_restart(&e, p.end, y));
            assert_memory_equal(integrator_state(&e), ((double[4]){end[0], 0.0, end[2], -end[3]}), sizeof end);
        }
        assert_ok(integrator_restart(&e, p.end, y0));
        assert_memory_equal(integrator_state(&e), y0, sizeof y0);
        bool rooted = false;
        while (!rooted) {
            assert_ok(integrator_step(&e, &p, &rooted));
            integrator_settle(&e, &p);
        }
        const double root = p.end;
        assert_ok(integrator_step(&e, &p, &rooted)); /* goes on below the floor, from the root */
        assert_false(rooted);
        assert_close(p.t0, root, 0.0);
        assert_true(p.y0[1] <= 0.0 && p.y1[1] < p.y0[1]);
    }
}

/* ---- three dimensions ---- */

/* x'' = -x of every number, the one behind the nodes too. */
static int oscillate(double t, const double *y, double *u, double *a, void *context)
{
    const state_layout *l = context;
    const dem_index n = state_velocities(l);
    (void)t;
    for (dem_index k = 0; k < n; k++) {
        if (u != NULL) u[k] = y[n + k];
        a[k] = -y[k];
    }
    return 0;
}

enum { rows = 3, most_numbers = 2 * STATE_DIM_MOST * rows };

/* Two nodes and a row of quadratures from different places; the third component starts as the first. The state in the
 * middle of the last of some steps. */
static void swing(dem_method method, state_layout l, double y[most_numbers])
{
    const ode_problem problem = {.layout = l,
                                 .ops = &array_ops_portable,
                                 .derivative = oscillate,
                                 .context = &l,
                                 .method = method,
                                 .position_error = 1.0,
                                 .velocity_error = 1.0,
                                 .max_step = 0.05,
                                 .fixed_step = 0.05};
    CLEANUP(integrator_destroy) integrator e;
    dense_output p = {0};
    bool rooted;
    for (dem_index k = 0; k < state_size(&l); k++) y[k] = 1.0 / (double)(1 + k / l.dim + k % l.dim % 2);
    assert_ok(integrator_create(&e, &problem, 0.0, y));
    for (int step = 0; step < 20; step++) assert_ok(integrator_step(&e, &p, &rooted));
    dense_output_state(&p, 0.5 * (p.t0 + p.t1), y);
}

TEST(a_third_component_goes_as_the_others_do_to_the_bit)
{
    for (int method = 0; method <= DEM_METHOD_VERLET; method++) {
        const state_layout plane = {.dim = 2, .n_nodes = 2, .n_rows = rows},
                           space = {.dim = 3, .n_nodes = 2, .n_rows = rows};
        double y[most_numbers], z[most_numbers];
        dem_method_traits traits = {.struct_size = sizeof traits};
        if (dem_method_describe(&traits, (dem_method)method) != DEM_OK) continue;
        swing((dem_method)method, plane, y);
        swing((dem_method)method, space, z);
        for (dem_index row = 0; row < 2 * rows; row++) { /* of positions, then of velocities */
            assert_memory_equal(&z[3 * row], &y[2 * row], 2 * sizeof *y);
            assert_memory_equal(&z[3 * row + 2], &y[2 * row], sizeof *y);
        }
        assert_close(y[0], cos(0.975) + sin(0.975) / 4.0, 1e-3); /* velocity of row 0; h^2/6 of methods of order 2 */
    }
}

TEST(what_cannot_be_made_is_reported)
{
    const ode_problem problem = {.layout = {.dim = 2, .n_nodes = 1, .n_rows = 1},
                                 .ops = &array_ops_portable,
                                 .derivative = fall,
                                 .max_step = 1.0,
                                 .method = (dem_method)99};
    const double y0[4] = {0.0};
    CLEANUP(integrator_destroy) integrator e;
    assert_int_equal(integrator_create(&e, &problem, 0.0, y0), DEM_ERROR_ARGUMENT);
}
