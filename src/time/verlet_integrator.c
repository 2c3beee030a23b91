/* SPDX-License-Identifier: BSD-3-Clause */
/* Velocity Verlet, (5) of docs/method.md in the form kick, drift, kick. A step h from (x0, v0) with a0 = a(x0, v0) is
 *   v' = v0 + h/2 a0,   x1 = x0 + h v',   a1 = a(x1, v' + h/2 a0),   v1 = v' + h/2 a1.
 * Forces that depend on the velocity see it extrapolated, v0 + h a0: this keeps the order 2 with one evaluation per
 * step. Steps are fixed, and there is no error control. With `exact` contacts the first root in the step is found here,
 * too, on the parabolas of the dense output. Why the method keeps energies and the Runge-Kutta methods do not:
 * docs/method.md, Methods; figures in docs/integrators.md. The forces themselves, and what happens at a root, are the
 * caller's. */
#include "time/verlet_integrator.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/aligned.h"
#include "base/reduce.h"
#include "base/status.h"
#include "time/attempt.h"

/* Both ends of the step stand in one block with two derivatives; going on swaps pointers, so that the derivative at the
 * end of a step is that at the start of the next without another evaluation. Of derivatives the velocities are written
 * only where motions are prescribed, or an event is near, and a state inside only if an event cuts steps short: else
 * 64 of 160 bytes a node are never touched. */
typedef struct verlet_integrator {
    ode_problem problem;
    void *block;
    double *y0, *f0, *y1, *f1, *state; /* [2 dim n_rows] ends of the step with derivatives; a state inside, */
    double *f_state;                   /* and its derivative, likewise, where steps are taken at once */
    double t, t1;                      /* s, of y0, y1 */
    bool has_f0;                       /* f0 is that of y0 */
    bool at_end;                       /* the dense output was handed out: y1 is the start of the next step */
    bool resumed;                      /* the caller has changed that with its derivative */
    attempt attempt;                   /* at the present step */
    dem_counts counts;
} verlet_integrator;

static dem_status allocate(verlet_integrator *V)
{
    const size_t n = (size_t)state_size(&V->problem.layout);
    double *arrays = aligned_zeros_in(&V->block, (V->problem.fused_steps != NULL ? 6 : 5) * n);
    CHECK(arrays != NULL, DEM_ERROR_MEMORY, "out of memory for the state of %lld nodes",
          (long long)V->problem.layout.n_nodes);
    V->y0 = arrays;
    V->f0 = arrays + n;
    V->y1 = arrays + 2 * n;
    V->f1 = arrays + 3 * n;
    V->state = arrays + 4 * n;
    V->f_state = arrays + 5 * n;
    return DEM_OK;
}

static void verlet_integrator_destroy(void *self)
{
    verlet_integrator *V = self;
    if (V == NULL) return;
    free(V->block);
    free(V);
}

/* Begins at any state. Its accelerations are not known: the next step evaluates them first. There is no history, so
 * that renew() differs from this in the counts alone. */
static dem_status verlet_integrator_restart(void *self, double t, const double *y)
{
    verlet_integrator *V = self;
    if (y != V->y0) memcpy(V->y0, y, (size_t)state_size(&V->problem.layout) * sizeof *y);
    V->t = t;
    V->has_f0 = V->at_end = V->attempt.knows_stiffening = false;
    return DEM_OK;
}

static dem_status verlet_integrator_create(void **out, const ode_problem *problem, double t, const double *y)
{
    CHECK(problem->fixed_step > 0.0, DEM_ERROR_ARGUMENT, "Verlet's method needs a fixed step");
    verlet_integrator *V = calloc(1, sizeof *V);
    CHECK_MEMORY(V);
    V->problem = *problem;
    dem_status status = allocate(V);
    if (status == DEM_OK) status = verlet_integrator_restart(V, t, y);
    if (status == DEM_OK)
        *out = V;
    else
        verlet_integrator_destroy(V);
    return status;
}

static dem_status verlet_integrator_renew(void *self, const integrator_start *from)
{
    verlet_integrator *V = self;
    V->counts = (dem_counts){.steps = from->counts.steps, .evaluations = from->counts.evaluations};
    return verlet_integrator_restart(V, from->t, from->y);
}

static void swap(double **a, double **b)
{
    double *const kept = *a;
    *a = *b;
    *b = kept;
}

/* The end of the last step becomes the start of the next, once it has been handed out. */
static void go_on(verlet_integrator *V)
{
    if (!V->at_end) return;
    swap(&V->y0, &V->y1);
    swap(&V->f0, &V->f1);
    V->t = V->t1;
    V->at_end = false;
}

static void verlet_integrator_end(void *self, double **y1, double **f1)
{
    verlet_integrator *V = self;
    *y1 = V->y1;
    *f1 = V->f1;
}

/* Accepts a step. One that an event has cut short ends in the state that the dense output has there; its positions, a
 * parabola from x0 with slope v0 and second derivative a0, are just those of a shorter step of the method. The
 * accelerations at a cut are not known; at a whole end they are f1. */
static void verlet_integrator_settle(void *self, const dense_output *step)
{
    verlet_integrator *V = self;
    if (step->end < step->t1) {
        dense_output_state(step, step->end, V->state);
        swap(&V->y1, &V->state);
        V->t1 = step->end;
        V->attempt.knows_stiffening = false;
    }
    go_on(V);
    V->has_f0 = step->end == step->t1;
}

static double *verlet_integrator_state(const void *self)
{
    const verlet_integrator *V = self;
    return V->y0;
}

/* The derivative; x' is asked for only where motions are prescribed, as it is v otherwise. */
static int evaluate(verlet_integrator *V, double t, double *y, double *f)
{
    double *u = V->problem.prescribes ? f : NULL, *a = f + state_velocities(&V->problem.layout);
    ode_problem_fill_ghosts(&V->problem, y);
    V->counts.evaluations++;
    return attempt_evaluate(&V->attempt, t, y, u, a);
}

/* The end of an attempt by ranks: whether no derivative has failed on any. Where one has, f0 is what has not, unless it
 * was evaluated in this attempt and has. */
static bool is_good(verlet_integrator *V)
{
    if (V->problem.domain == NULL) return true;
    attempt_end end = attempt_own_end(&V->attempt, V->y1);
    attempt_tell(&V->attempt, &end);
    if (end.failed == ATTEMPT_NONE) return true;
    attempt_name_failure(&V->attempt, &end);
    V->counts.evaluations -= V->attempt.n - (end.failed + 1);
    V->has_f0 = end.failed == V->attempt.n - 1;
    return false;
}

/* A run of components of the positions, and with it the same run of the velocities. */
typedef struct stretch {
    dem_index at, size;
} stretch;

/* x1 = x0 + h (v0 + h/2 a0), and v1 = v0 + h a0, the extrapolated velocity. */
static void drift_stretch(const ode_problem *p, const ode_fused_step *step, stretch s)
{
    const dem_index n = state_velocities(&p->layout);
    const double *const start[3] = {step->y0 + s.at, step->y0 + n + s.at, step->f0 + n + s.at};
    p->ops->drift(step->y1 + s.at, step->y1 + n + s.at, start, step->h, s.size);
}

/* v1 += h/2 (a1 - a0): of the extrapolated v0 + h a0 this makes v' + h/2 a1. */
static void kick_stretch(const ode_problem *p, const ode_fused_step *step, stretch s)
{
    const dem_index at = state_velocities(&p->layout) + s.at;
    p->ops->kick(step->y1 + at, step->f0 + at, step->f1 + at, step->h, s.size);
}

/* They are behind the nodes and the padding. */
static stretch quadratures_of(const state_layout *l)
{
    const dem_index at = state_row(l, l->n_nodes);
    return (stretch){at, state_velocities(l) - at};
}

/* Drift or kick of all nodes in shares. */
typedef struct part {
    const ode_problem *problem;
    const ode_fused_step *step;
    int n_shares;
} part;

static stretch stretch_of(const part *p, int share)
{
    const dem_index n = state_velocities(&p->problem->layout), at = team_share(n, p->n_shares, share);
    return (stretch){at, team_share(n, p->n_shares, share + 1) - at};
}

static void drift_share(const void *context, int share, int thread)
{
    const part *p = context;
    (void)thread;
    drift_stretch(p->problem, p->step, stretch_of(p, share));
}

static void kick_share(const void *context, int share, int thread)
{
    const part *p = context;
    (void)thread;
    kick_stretch(p->problem, p->step, stretch_of(p, share));
}

/* The same where motions are prescribed. A component whose x' in the derivative differs from its extrapolated velocity
 * is prescribed, and gets that x'. For one that is not prescribed the caller has written v itself as x', so equality
 * tells. */
static void kick_free(verlet_integrator *V, double h)
{
    const dem_index n = state_velocities(&V->problem.layout);
    double *v1 = V->y1 + n;
    for (dem_index k = 0; k < n; k++)
        v1[k] = V->f1[k] != v1[k] ? V->f1[k] : v1[k] + 0.5 * h * (V->f1[n + k] - V->f0[n + k]);
}

/* The whole step as one sweep over the nodes, if the state allows it (docs/algorithms.md, Verlet in one pass); the
 * quadratures are drifted before it and kicked after it.
 *   \return 0, another flag of the derivative on failure, or -1 if the sweep is not possible */
static int take_fused_step(verlet_integrator *V, const ode_fused_step *step)
{
    const ode_problem *p = &V->problem;
    const stretch quadratures = quadratures_of(&p->layout);
    drift_stretch(p, step, quadratures);
    const int flag = attempt_take_fused_step(&V->attempt, step);
    if (flag < 0) return flag;
    V->counts.evaluations++;
    kick_stretch(p, step, quadratures);
    return flag;
}

/* Takes the step in one sweep or in parts, to the same bits.  \return 0, or not 0 if the derivative failed */
static int kick_drift_kick(verlet_integrator *V, double h)
{
    V->t1 = V->t + h;
    const ode_fused_step step = {.t1 = V->t1, .h = h, .y0 = V->y0, .f0 = V->f0, .y1 = V->y1, .f1 = V->f1};
    const int flag = take_fused_step(V, &step);
    if (flag >= 0) return flag;
    team *const t = V->problem.team;
    const part p = {&V->problem, &step, team_shares(t, V->problem.layout.n_nodes)};
    team_run(t, p.n_shares, drift_share, &p);
    if (evaluate(V, V->t1, V->y1, V->f1) != 0) return -1;
    if (V->problem.prescribes)
        kick_free(V, h);
    else
        team_run(t, p.n_shares, kick_share, &p);
    return 0;
}

/* ---- roots ---- */

/* The root function at `end` of a step: 1 at the start, 0 or less from the first event on. A NAN would let the search
 * run on without a bracket, so it is refused. */
static dem_status look(const verlet_integrator *V, const dense_output *step, double *g)
{
    *g = V->problem.root_function(step, V->problem.context);
    CHECK(isfinite(*g), DEM_ERROR_INTEGRATOR, "the root function is not finite at t = %.9g s", step->end);
    return DEM_OK;
}

/* Shortens the step to the first root, if its root function is not above 0 at the end. The bracket [low, high] keeps a
 * value above 0 at low, and one of 0 or less at high, the end returned, so that the event has certainly happened there.
 * Each trial is the secant's root, kept off both ends by half the final width; after a secant that did not halve the
 * bracket comes the middle, so every two trials halve the bracket at least, down to the width 100 eps (t + h). */
static dem_status find_root(const verlet_integrator *V, dense_output *step, bool *rooted)
{
    double low = step->t0, high = step->t1, above = 1.0, below = 1.0, trial;
    const double width = 100.0 * DBL_EPSILON * (fabs(high) + high - low);
    if (V->problem.root_function != NULL) TRY(look(V, step, &below));
    *rooted = below <= 0.0;
    for (bool secant = true; *rooted && high - low > width;) {
        const double share = secant ? above / (above - below) : 0.5, whole = high - low;
        step->end = fmin(fmax(low + share * whole, low + 0.5 * width), high - 0.5 * width);
        TRY(look(V, step, &trial));
        if (trial <= 0.0) {
            high = step->end;
            below = trial;
        } else {
            low = step->end;
            above = trial;
        }
        secant = high - low <= 0.5 * whole;
    }
    step->end = high;
    return DEM_OK;
}

/* ---- the step ---- */

/* One step; `step` refers to the arrays here, which hold until the next one. */
static dem_status verlet_integrator_step(void *self, dense_output *step, bool *rooted)
{
    verlet_integrator *V = self;
    go_on(V);
    if (V->problem.begin_roots != NULL) V->problem.begin_roots(V->t, V->y0, V->problem.context);
    attempt_begin(&V->attempt, &V->problem);
    if (!V->has_f0 && evaluate(V, V->t, V->y0, V->f0) != 0) return DEM_ERROR_INTEGRATOR; /* message: derivative's */
    V->has_f0 = true;
    if (kick_drift_kick(V, attempt_fixed_step(&V->attempt, V->y0, !V->resumed)) != 0) return DEM_ERROR_INTEGRATOR;
    if (!is_good(V)) return DEM_ERROR_INTEGRATOR;
    V->resumed = false;
    *step = (dense_output){.layout = V->problem.layout,
                           .parabolic = true,
                           .t0 = V->t,
                           .t1 = V->t1,
                           .end = V->t1,
                           .y0 = V->y0,
                           .f0 = V->f0,
                           .y1 = V->y1,
                           .f1 = V->f1};
    TRY(find_root(V, step, rooted));
    V->counts.steps++;
    V->at_end = true;
    return DEM_OK;
}

/* Evaluates the derivative at the start if need be. Where that fails the step by itself does, and counts it. */
static bool knows_start(verlet_integrator *V)
{
    if (V->has_f0) return true;
    V->has_f0 = evaluate(V, V->t, V->y0, V->f0) == 0;
    if (V->problem.domain != NULL) V->has_f0 = !reduce_any(V->problem.domain->ranks, V->attempt.failed != ATTEMPT_NONE);
    V->counts.evaluations -= !V->has_f0;
    return V->has_f0;
}

/* Ends of steps are in turn the state inside and the end, last that. */
static void lay_out(const verlet_integrator *V, ode_fused_step *steps, int n)
{
    const double h = V->problem.fixed_step;
    ode_fused_step before = {.t1 = V->t, .y1 = V->y0, .f1 = V->f0};
    for (int k = 0; k < n; k++) {
        const bool at_end = (n - 1 - k) % 2 == 0;
        steps[k] = (ode_fused_step){.t1 = before.t1 + h,
                                    .h = h,
                                    .y0 = before.y1,
                                    .f0 = before.f1,
                                    .y1 = at_end ? V->y1 : V->state,
                                    .f1 = at_end ? V->f1 : V->f_state};
        before = steps[k];
    }
}

/* Quadratures come after all steps, as their rates are the same at every end. */
static bool verlet_integrator_take_unseen(void *self, int n, double *ends, dense_output *last)
{
    verlet_integrator *V = self;
    const ode_problem *p = &V->problem;
    ode_fused_step steps[ODE_FUSED_STEPS];
    go_on(V);
    if (p->fused_steps == NULL || p->root_function != NULL) return false;
    attempt_begin(&V->attempt, p);
    if (!knows_start(V) || attempt_fixed_step(&V->attempt, V->y0, !V->resumed) < p->fixed_step) return false;
    lay_out(V, steps, n);
    if (p->domain != NULL) p->domain->fill_start(V->y0, V->f0, p->context);
    if (!p->fused_steps(steps, n, p->context)) return false;
    for (int k = 0; k < n; k++) {
        drift_stretch(p, &steps[k], quadratures_of(&p->layout));
        kick_stretch(p, &steps[k], quadratures_of(&p->layout));
        ends[k] = steps[k].t1;
    }
    V->counts.steps += n;
    V->counts.evaluations += n;
    V->t1 = ends[n - 1];
    V->at_end = true;
    V->resumed = false;
    if (p->domain != NULL) attempt_end_at_rest(&V->attempt);
    *last = (dense_output){.layout = p->layout,
                           .parabolic = true,
                           .t0 = steps[n - 1].t1 - p->fixed_step,
                           .t1 = V->t1,
                           .end = V->t1,
                           .y1 = V->y1,
                           .f1 = V->f1};
    go_on(V);
    return true;
}

static dem_counts verlet_integrator_counts(const void *self)
{
    const verlet_integrator *V = self;
    return V->counts;
}

/* Fixed steps have no bound. */
static dem_status verlet_integrator_bound(void *self, double longest)
{
    (void)self;
    (void)longest;
    return DEM_OK;
}

/* The end of the step, as the caller has changed it, is what the next step starts from; there is nothing to renew. */
static dem_status verlet_integrator_resume(void *self)
{
    verlet_integrator *V = self;
    V->resumed = true;
    V->attempt.knows_stiffening = false;
    return DEM_OK;
}

static double verlet_integrator_next_step(const void *self)
{
    (void)self;
    return 0.0;
}

const integrator_ops verlet_integrator_ops = {.create = verlet_integrator_create,
                                              .destroy = verlet_integrator_destroy,
                                              .step = verlet_integrator_step,
                                              .take_unseen = verlet_integrator_take_unseen,
                                              .end = verlet_integrator_end,
                                              .settle = verlet_integrator_settle,
                                              .state = verlet_integrator_state,
                                              .bound = verlet_integrator_bound,
                                              .resume = verlet_integrator_resume,
                                              .restart = verlet_integrator_restart,
                                              .next_step = verlet_integrator_next_step,
                                              .renew = verlet_integrator_renew,
                                              .counts = verlet_integrator_counts};
