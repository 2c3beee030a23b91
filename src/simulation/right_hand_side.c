/* SPDX-License-Identifier: BSD-3-Clause */
/* The right-hand side of y = (x, v), (3) and (4) of docs/method.md:
 *   x' = v,   m v' = m g + springs, triangles, damping, other surfaces and forces from outside + closed contacts,
 * with the motion of rigid bodies projected on rigid motions, prescribed components given, and behind the nodes the
 * rates of the quadratures, which are integrated along. Here the parts are put together in their order; the forces of
 * nodes are in src/forces, those of contacts in src/contact. The integrator (src/time) sees only the table ode_problem
 * that is filled in at the end. */
#include "simulation/right_hand_side.h"

#include "base/reduce.h"
#include "base/status.h"
#include "contact/automaton_step.h"
#include "forces/band.h"
#include "simulation/body_contact.h"
#include "simulation/guard_bound.h"
#include "time/butcher.h"

/* The first node whose velocity or acceleration is not finite; -1: none. */
static dem_index find_culprit(const state_layout *l, const double *y, const double *a)
{
    const double *v = y + state_velocities(l);
    for (dem_index k = 0; k < state_row(l, l->n_nodes); k++)
        if (!isfinite(v[k]) || !isfinite(a[k])) return k / l->dim;
    return -1;
}

/* Sets the message for a derivative that is not finite: which node it is, and where.  \return its number in the whole;
 * infinity if there is none */
static double name_culprit(const dem_simulation *s, double t, const double *y, const double *a)
{
    const dem_index i = find_culprit(&s->layout, y, a);
    if (i < 0) {
        (void)status_fail(DEM_ERROR_INTEGRATOR, "forces overflow at t = %.9g s", t);
        return INFINITY;
    }
    const double *x = state_x(&s->layout, y, i);
    const dem_index number = domain_number(s->model->domain, i);
    (void)status_fail(DEM_ERROR_INTEGRATOR, "force or velocity of node %lld is not finite at (%g, %g) m, t = %.9g s",
                      (long long)number, x[0], x[1], t);
    return (double)number;
}

/* Rates of the quadratures, behind the accelerations of the nodes, as long as nothing acts that they are of: only the
 * time goes on. */
static void begin_rates(const state_layout *l, double *a)
{
    for (dem_index k = state_row(l, l->n_nodes); k < state_velocities(l); k++) a[k] = 0.0;
    a[state_total_index(l, STATE_TIME)] = 1.0;
}

/* Rates of the quadratures: forces of closed contacts on each obstacle, N;
 * powers of friction, of moving obstacles, of damping, and of boundary conditions and external forces, W; and 1, the
 * rate of the time. */
static void fill_rates(dem_simulation *s, double t, const double *y, double *a, double work)
{
    const state_layout *l = &s->layout;
    const double *v = y + state_velocities(l);
    begin_rates(l, a);
    automaton_add_rates(&s->automaton, t, y, a);
    if (s->rigid != NULL) rigid_contact_add_rates(s->rigid, l, v, a);
    if (forces_have_friction(&s->forces))
        a[state_total_index(l, STATE_FRICTION)] += forces_evaluated_friction_power(&s->forces, v);
    a[state_total_index(l, STATE_DAMPING)] = forces_damping_power(&s->forces, y, v);
    a[state_total_index(l, STATE_WORK)] = work;
}

/* Judges accelerations of this rank by the sum of their terms. Where the contact of bodies has failed, that has its own
 * message.
 *   \return 0; 1 if something is not finite; 2 if what no shorter step mends: the external force has failed, or there
 *   was no memory for the contact of bodies */
static int judge(dem_simulation *s, double t, const double *y, const double *a, double sum)
{
    const dem_status of_contact = body_contact_failure(s);
    if (run_own_force_failed(s) || of_contact == DEM_ERROR_MEMORY) return 2;
    if (isfinite(sum)) return 0;
    s->culprit = of_contact == DEM_OK ? name_culprit(s, t, y, a) : 0.0;
    return 1;
}

/* ---- ranks ---- */

static void fill_ghosts(double *y, void *context)
{
    dem_simulation *s = context;
    double *const arrays[] = {y, y + state_velocities(&s->layout)};
    halo_exchange(&s->halo, arrays, forces_couple_velocities(&s->forces) || s->shared.once_a_step ? 2 : 1);
}

/* Ghosts are integrated through several steps from the accelerations at their start. */
static void fill_start(double *y, double *f, void *context)
{
    dem_simulation *s = context;
    const dem_index v = state_velocities(&s->layout);
    halo_exchange(&s->halo, (double *const[]){y, y + v, f + v}, 3);
}

/* Whether there are enough rings of ghosts for a step of the method, and nothing acts on them that is known to their
 * owners alone, or that takes more rings, as the velocities of neighbours do. What contacts do concerns common nodes
 * only, and the rings are about these, too. */
static bool can_integrate_ghosts(const dem_simulation *s)
{
    const int rings = butcher_rings_of(s->options.method);
    return rings > 0 && s->model->domain->n_rings >= rings && s->boundaries.n == 0 && s->external == NULL &&
           !forces_couple_velocities(&s->forces);
}

static void take_part(void *context)
{
    forces_sum_nothing(&((const dem_simulation *)context)->forces);
}

/* A rank whose derivative has failed evaluates no other until all ranks know: the message is still that. */
static void name_failure(bool is_first, void *context)
{
    const dem_simulation *s = context;
    (void)reduce_status(s->model->ranks, is_first ? DEM_ERROR_INTEGRATOR : DEM_OK, s->culprit);
}

static bool wants_stop(void *context)
{
    return ((const dem_simulation *)context)->stop.status != DEM_OK;
}

static void stop(void *context)
{
    ((dem_simulation *)context)->stop.is_known = true;
}

ode_domain right_hand_side_domain(const dem_simulation *s)
{
    const dem_model *model = s->model;
    return (ode_domain){.ranks = model->ranks,
                        .whole = state_layout_of(s->layout.dim, model->domain->n_whole, model->obstacles.n,
                                                 state_has_total(&s->layout, STATE_OBSTACLE)),
                        .is_own = model->domain->is_own,
                        .once_a_step = can_integrate_ghosts(s),
                        .fill_ghosts = fill_ghosts,
                        .fill_start = fill_start,
                        .take_part = take_part,
                        .name_failure = name_failure,
                        .wants_stop = wants_stop,
                        .stop = stop};
}

/* ---- the derivative ---- */

/* f = (u, a) of y = (x, v): u = v, m a = F(x, v) + m g + what closed contacts hold, (3) and (4); prescribed components
 * are given. Constraints follow the free accelerations, which they change. `sum` is finite only if all accelerations
 * are.
 *   \return as judge() */
static int derivative(double t, const double *y, double *u, double *a, void *context)
{
    dem_simulation *s = context;
    const dem_index n = state_velocities(&s->layout), n_real = state_row(&s->layout, s->layout.n_nodes);
    const double *v = y + n;
    const kernel_state nodes = {.x = y, .v = v, .u = u, .a = a, .is_unfolded = guard_bound_holds(s)};
    const double sum = kernel_accelerate(&s->kernel, &s->forces, &nodes);
    body_contact_take_accelerations(s, sum);
    guard_bound_take_accelerations(s, sum);
    for (dem_index k = n_real; k < n && u != NULL; k++) u[k] = v[k];
    automaton_constrain(&s->automaton, t, y, a);
    if (isfinite(sum)) rigid_motion_accelerate(&s->model->rigid, y, v, a);
    fill_rates(s, t, y, a, forces_prescribe(&s->forces, t, v, u, a));
    return judge(s, t, y, a, sum);
}

/* A whole step of Verlet's method as one sweep, where nothing but springs, triangles and weight acts and no contact is
 * closed: accelerations then depend on positions alone. automaton_constrain() has no group to solve here; it only marks
 * the forces of contacts as those of another state. Ranks exchange ghosts once, as in a step in parts: they need not
 * all take the same way.  \return -1 if it is not possible, else as derivative() */
static int take_fused_step(const ode_fused_step *step, void *context)
{
    dem_simulation *s = context;
    const dem_index n = state_velocities(&s->layout);
    const sweep_fused_step nodes = {
        .h = step->h, .x0 = step->y0, .v0 = step->y0 + n, .a0 = step->f0 + n, .x1 = step->y1, .v1 = step->y1 + n};
    const kernel_state y = {
        .x = nodes.x1, .v = nodes.v1, .a = step->f1 + n, .fused_step = &nodes, .is_unfolded = guard_bound_holds(s)};
    if (!kernel_can_fuse(&s->kernel, &s->forces) || s->automaton.set.forces.n_groups > 0) return -1;
    kernel_begin_step(&s->kernel, &nodes);
    if (run_is_shared(s)) fill_ghosts(step->y1, s);
    const double sum = kernel_accelerate(&s->kernel, &s->forces, &y);
    body_contact_take_accelerations(s, sum);
    guard_bound_take_accelerations(s, sum);
    automaton_constrain(&s->automaton, step->t1, y.x, y.a);
    fill_rates(s, step->t1, y.x, y.a, 0.0);
    return judge(s, step->t1, y.x, y.a, sum);
}

/* Several of them, which unseen_steps_take() asks for where they may well be possible. Of the quadratures only the time
 * goes on. Steps hold on all ranks, or are thrown away on all. */
static bool take_fused_steps(const ode_fused_step *steps, int n, void *context)
{
    dem_simulation *s = context;
    const dem_index v = state_velocities(&s->layout);
    step_wave_steps wave = {.n = n, .watched = s->unseen.surface, .n_watched = s->unseen.n_surface};
    double t[ODE_FUSED_STEPS + 1] = {s->t};
    for (int k = 0; k < n; k++) {
        const ode_fused_step *p = &steps[k];
        wave.step[k] =
            (sweep_fused_step){.h = p->h, .x0 = p->y0, .v0 = p->y0 + v, .a0 = p->f0 + v, .x1 = p->y1, .v1 = p->y1 + v};
        wave.a[k] = p->f1 + v;
        t[k + 1] = p->t1;
    }
    const body_flight flight = {.n = n, .t = t, .sum = wave.sum, .x = steps[n - 1].y1};
    const automaton_flight of_surface = {n, t, wave.square};
    const bool holds = step_wave_run(s->unseen.wave, &s->forces, &wave) && body_contact_can_fly(s, &flight) &&
                       automaton_can_fly(&s->automaton, &of_surface);
    if (reduce_any(s->model->ranks, !holds)) return false;
    automaton_fly(&s->automaton, &of_surface);
    body_contact_fly(s, &flight);
    guard_bound_forget(s);
    for (int k = 0; k < n; k++) begin_rates(&s->layout, steps[k].f1 + v);
    return true;
}

_Static_assert((int)ODE_FUSED_STEPS == (int)STEP_WAVE_MOST, "the integrator takes as many steps at once as a wave has");

/* Whether springs, triangles and weight are all that acts, and no contact is closed: then no node depends on others
 * than its neighbours, and no rate on the whole state. */
static bool has_bands(int n_stages, void *context)
{
    dem_simulation *s = context;
    guard_bound_forget(s);
    return s->automaton.set.forces.n_groups == 0 && band_is_possible(&s->kernel, &s->forces, s->y, n_stages);
}

static bool bands_hold(int n_stages, void *context)
{
    const dem_simulation *s = context;
    return band_was_possible(&s->forces, n_stages);
}

static double band_derivative(const ode_band *b, void *context)
{
    dem_simulation *s = context;
    const state_layout *l = &s->layout;
    const bool is_last = b->end == l->n_rows;
    if (is_last) begin_rates(l, b->a);
    return band_accelerate(&s->kernel, &s->forces,
                           &(band){.first = b->first,
                                   .end = is_last ? l->n_nodes : b->end,
                                   .goes_on = b->goes_on,
                                   .stage = b->stage,
                                   .is_own = b->is_own,
                                   .x = b->x,
                                   .v = b->v,
                                   .a = b->a,
                                   .scratch = b->scratch});
}

/* The three functions that follow are callbacks of the integrator; `exact` contacts need the first two. */
static void begin_roots(double t, const double *y, void *context)
{
    dem_simulation *s = context;
    automaton_begin_roots(&s->automaton, t, y);
}

static double root_function(const dense_output *step, void *context)
{
    dem_simulation *s = context;
    return automaton_root_function(&s->automaton, step, s->frame);
}

/* Where the folding guard acts, triangles are stiffer than at rest, and surfaces in contact are: by how much, for fixed
 * steps. */
static double stiffening(const double *y, bool is_known, void *context)
{
    dem_simulation *s = context;
    return body_contact_stiffening(s, kernel_stiffening(&s->kernel, &s->forces, y), y, is_known);
}

/* Bands of a stage compute what is next to ghosts before others have evaluated these: they must be integrated here.
 * Root functions are watched with `exact` only, and where there is something to touch. What counts as an error of 1 is
 * rtol times the spacing for a position, and rtol v_scale for a velocity (docs/method.md, Integration in time). */
ode_problem right_hand_side_problem(dem_simulation *s)
{
    const dem_model *model = s->model;
    const dem_options *o = &s->options;
    const bool rooted = model->obstacles.n > 0 && !run_is_local(s), shared = run_is_shared(s);
    return (ode_problem){
        .layout = s->layout,
        .domain = shared ? &s->shared : NULL,
        .prescribes = boundary_conditions_move(&s->boundaries),
        .derivative = derivative,
        .band_rows = s->boundaries.n == 0 ? band_nodes(&s->kernel) : 0,
        .band_scratch = band_scratch(&s->kernel),
        .has_bands = shared && !s->shared.once_a_step ? NULL : has_bands,
        .bands_hold = bands_hold,
        .band_derivative = band_derivative,
        .fused_step = s->boundaries.n == 0 ? take_fused_step : NULL,
        .fused_steps = s->unseen.wave != NULL ? take_fused_steps : NULL,
        .begin_roots = rooted ? begin_roots : NULL,
        .root_function = rooted ? root_function : NULL,
        .stiffening = model->lattice.guard != NULL || s->surfaces != NULL || s->rigid != NULL ? stiffening : NULL,
        .context = s,
        .method = o->method,
        .position_error = o->rtol * o->spacing,
        .velocity_error = o->rtol * o->v_scale,
        .max_step = o->max_step,
        .fixed_step = o->fixed_step,
        .ops = s->kernel.ops,
        .team = s->team,
    };
}
