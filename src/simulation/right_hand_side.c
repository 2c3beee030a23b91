/* SPDX-License-Identifier: BSD-3-Clause */
/* y = (x, v) with x' = v, m v' = F(x, v, t) plus the forces of closed contacts, and the rates of the quadratures. */
#include "simulation/right_hand_side.h"

#include "base/reduce.h"
#include "base/status.h"
#include "contact/automaton_step.h"

static dem_status name_culprit(const dem_simulation *s, double t, const double *y, const double *a)
{
    const state_layout *l = &s->layout;
    const double *v = y + state_velocities(l);
    for (dem_index k = 0; k < state_row(l, l->n_nodes); k++) {
        const dem_index i = k / l->dim;
        const double *x = state_x(l, y, i);
        CHECK(isfinite(v[k]) && isfinite(a[k]), DEM_ERROR_INTEGRATOR,
              "force or velocity of node %lld is not finite at (%g, %g) m, t = %.9g s", (long long)i, x[0], x[1], t);
    }
    return status_fail(DEM_ERROR_INTEGRATOR, "forces overflow at t = %.9g s", t);
}

/* Rates of the quadratures, behind the accelerations of the nodes. */
static void fill_rates(dem_simulation *s, double t, const double *y, double *a, double work)
{
    const state_layout *l = &s->layout;
    const double *v = y + state_velocities(l);
    for (dem_index k = state_row(l, l->n_nodes); k < state_velocities(l); k++) a[k] = 0.0;
    const double by_obstacles = automaton_add_rates(&s->automaton, t, y, a);
    a[state_total_index(l, STATE_DAMPING)] = reduce_rounded_sum(forces_damping_power(&s->forces, y, v));
    a[state_total_index(l, STATE_WORK)] = reduce_rounded_sum(work + by_obstacles);
    a[state_total_index(l, STATE_TIME)] = 1.0;
}

/* y = (x, v), f = (v, a) with m a = F(x, v) + m g, less what the closed contacts hold; prescribed components are given.
 *                                                                                                        (3), (4) */
static int derivative(double t, const double *y, double *u, double *a, void *context)
{
    dem_simulation *s = context;
    const dem_index n = state_velocities(&s->layout), n_real = state_row(&s->layout, s->layout.n_nodes);
    const double *v = y + n;
    const kernel_state nodes = {.x = y, .v = v, .u = u, .a = a};
    const double sum = kernel_accelerate(&s->kernel, &s->forces, &nodes);
    for (dem_index k = n_real; k < n && u != NULL; k++) u[k] = v[k];
    automaton_constrain(&s->automaton, t, y, a);
    fill_rates(s, t, y, a, forces_prescribe(&s->forces, t, v, u, a));
    if (run_force_failed(s)) return 2;
    if (!reduce_any(!isfinite(sum))) return 0;
    (void)name_culprit(s, t, y, a);
    return 1;
}

/* Takes a fused step where nothing but springs, triangles and weight acts. */
static int take_fused_step(const ode_fused_step *step, void *context)
{
    dem_simulation *s = context;
    const dem_index n = state_velocities(&s->layout);
    const sweep_fused_step nodes = {
        .h = step->h, .x0 = step->y0, .v0 = step->y0 + n, .a0 = step->f0 + n, .x1 = step->y1, .v1 = step->y1 + n};
    const kernel_state y = {.x = nodes.x1, .v = nodes.v1, .a = step->f1 + n, .fused_step = &nodes};
    if (reduce_any(!kernel_can_fuse(&s->kernel, &s->forces) || s->automaton.set.forces.n_groups > 0)) return -1;
    const double sum = kernel_accelerate(&s->kernel, &s->forces, &y);
    automaton_constrain(&s->automaton, step->t1, y.x, y.a);
    fill_rates(s, step->t1, y.x, y.a, 0.0);
    if (!reduce_any(!isfinite(sum))) return 0;
    (void)name_culprit(s, step->t1, y.x, y.a);
    return 1;
}

static void begin_roots(double t, const double *y, void *context)
{
    dem_simulation *s = context;
    automaton_begin_roots(&s->automaton, t, y);
}

static double root_function(const dense_output *step, void *context)
{
    dem_simulation *s = context;
    return reduce_min(automaton_root_function(&s->automaton, step, s->frame));
}

static double stiffening(const double *y, void *context)
{
    dem_simulation *s = context;
    return reduce_max(kernel_stiffening(&s->kernel, &s->forces, y));
}

ode_problem right_hand_side_problem(dem_simulation *s)
{
    const dem_model *model = s->model;
    const dem_options *o = &s->options;
    const bool rooted = model->obstacles.n > 0 && !run_is_local(s);
    return (ode_problem){
        .layout = s->layout,
        .prescribes = boundary_conditions_move(&s->boundaries),
        .derivative = derivative,
        .fused_step = s->boundaries.n == 0 ? take_fused_step : NULL,
        .begin_roots = rooted ? begin_roots : NULL,
        .root_function = rooted ? root_function : NULL,
        .stiffening = stiffening,
        .context = s,
        .method = o->method,
        .position_error = o->rtol * o->spacing,
        .velocity_error = o->rtol * o->v_scale,
        .max_step = o->max_step,
        .fixed_step = o->fixed_step,
        .ops = s->kernel.ops,
        .n_threads = s->kernel.n_threads,
    };
}
