/* SPDX-License-Identifier: BSD-3-Clause */
/* Explicit Runge-Kutta methods by ARKODE's ERKStep, in one-step mode: ARKODE takes stages, estimates errors and chooses
 * steps; what is read off between the ends of a step is our own quintic (dense_output.c), and tables come from
 * butcher.c. Nothing is left to ARKODE's defaults, which differ between its versions. The bits of a run must not depend
 * on how it is cut into calls. Therefore this file keeps the accepted step itself, from (y0, f0) to (y1, f1), and
 * decides which derivative ARKODE may have without an evaluation. The stages of large bodies are deferred until their
 * step is complete (deferral.c). Differences between SUNDIALS 6 and 7 are in
 * arkode_compat.h. What is integrated is in ode_problem.h; nothing here knows of forces or contacts. */
#include "time/arkode_integrator.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/aligned.h"
#include "base/status.h"
#include "time/arkode_compat.h"
#include "time/butcher.h"
#include "time/deferral.h"
#include "time/shared_attempt.h"

enum {
    max_retries = 10, /* of a step whose derivative is not finite */
    most_vectors = 19 /* of ARKODE and here, but for the stages */
};

/* The life of a step: ARKODE returns it in y; fetch_step() puts its ends into y1, f0, f1; it is handed out (at_end);
 * the caller settles it, whole or cut, or takes it back; go_on() makes its end the start y0, f0 of the next. */
typedef struct arkode_integrator {
    ode_problem problem;
    butcher_table table;
    SUNContext sundials;
    void *arkode;
    arkode_controller controller;
    arkode_errors errors;
    error_weights *weights;
    nvector_space *space;
    deferral *deferral;      /* NULL: stages are evaluated when ARKODE asks for them */
    N_Vector y;              /* what ARKODE returns */
    N_Vector y0, y1, f0, f1; /* the accepted step for the dense output; y0 is the last accepted state */
    double root;             /* the root function at the end of the last step; 1 after a restart */
    double t;                /* last accepted time, of y0 */
    double t1;               /* end of the step that y1, f0, f1 hold */
    bool holds_step;         /* y1, f0, f1 are those of the step that ends at t1 */
    bool at_end;             /* the dense output was handed out: y1 is the start of the next step */
    double asked;            /* s, first step given to ARKODE after a restart; 0: its own */
    bool knows_f0;           /* f0 is that of y0, */
    bool gives_f0;           /* and what ARKODE is given when it asks for it */
    bool failed;             /* a derivative has failed in this attempt, */
    bool refused;            /* and cannot be computed for any step */
    attempt attempt;         /* at the present step, */
    shared_attempt shared;   /* by ranks together, where they share the nodes */
    dem_counts counts;
    char message[256]; /* ARKODE's last error */
} arkode_integrator;

/* ---- callbacks ---- */

/* The derivative, at once. Any failure is reported as one that ARKODE cannot recover from: arkode_integrator_step()
 * decides about another attempt itself. */
static int evaluate(double t, N_Vector y, N_Vector f, void *self)
{
    arkode_integrator *I = self;
    I->counts.evaluations++;
    const double *values = nvector_values(y);
    double *u = nvector_fresh(f);
    const int flag = attempt_evaluate(&I->attempt, t, values, u, u + state_velocities(&I->problem.layout));
    I->failed = flag != 0;
    I->refused = flag > 1;
    return flag == 0 ? 0 : -1;
}

/* ARKODE's right-hand side. After a restart from a state whose derivative is known ARKODE asks for that derivative
 * again: it is recognised by its time and its very buffer, and shared without an evaluation. */
static int call_derivative(sunrealtype t, N_Vector y, N_Vector f, void *user)
{
    arkode_integrator *I = user;
    if (I->problem.domain == NULL && deferral_take_derivative(I->deferral, t, y, f)) return 0;
    if (I->gives_f0 && t == I->t && nvector_values(y) == nvector_values(I->y0)) {
        nvector_share(I->f0, f);
        return 0;
    }
    if (I->problem.domain == NULL) return evaluate(t, y, f, I);
    I->counts.evaluations++;
    return shared_attempt_evaluate(&I->shared, t, y, f);
}

static void count_evaluations(int n, void *self)
{
    arkode_integrator *I = self;
    I->counts.evaluations += n;
}

/* The same of a step by ranks, which count what ARKODE has asked for. */
static int evaluate_stage(double t, N_Vector y, N_Vector f, void *self)
{
    arkode_integrator *I = self;
    shared_attempt_evaluate_stage(&I->shared, t, y, f);
    return 0;
}

static void count_stages(int n, void *self)
{
    arkode_integrator *I = self;
    attempt_count(&I->attempt, n);
}

/* Fetches both ends of the step that ARKODE has just accepted, and their derivatives. At the ends ARKODE's cubic
 * interpolant gives back the vectors that it has stored, by sharing: no number is copied, and none is rounded. */
static int fetch_step(arkode_integrator *I)
{
    double now;
    if (ARKodeGetCurrentTime(I->arkode, &now) != ARK_SUCCESS) return -1;
    if (I->holds_step && I->t1 == now) return 0;
    if (ARKodeGetDky(I->arkode, now, 0, I->y1) != ARK_SUCCESS) return -1;
    if (ARKodeGetDky(I->arkode, now, 1, I->f1) != ARK_SUCCESS) return -1;
    if (!I->knows_f0 && ARKodeGetDky(I->arkode, I->t, 1, I->f0) != ARK_SUCCESS) return -1;
    I->knows_f0 = true;
    I->t1 = now;
    I->holds_step = true;
    return 0;
}

/* The accepted step, whole, as the dense output that the caller sees. */
static dense_output held_path(const arkode_integrator *I)
{
    return (dense_output){.layout = I->problem.layout,
                          .t0 = I->t,
                          .t1 = I->t1,
                          .end = I->t1,
                          .y0 = nvector_values(I->y0),
                          .f0 = nvector_values(I->f0),
                          .y1 = nvector_values(I->y1),
                          .f1 = nvector_values(I->f1)};
}

/* ARKODE calls this at the end of a step and, while it brackets a root, inside the step. There the quintic of the dense
 * output replaces ARKODE's cubic, so that the root is one of the very state in which the event is resolved. At the
 * start of a step it gives the value from the end of the last. After a root ARKODE calls there once more, and gets the
 * same: computed anew, the value could differ from that in a run resumed in between, and so would the bits. */
static int call_root_function(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
    arkode_integrator *I = user;
    (void)y;
    *g = I->root;
    if (t <= I->t) return 0;
    if (fetch_step(I) != 0) return -1;
    dense_output step = held_path(I);
    step.end = t;
    *g = I->problem.root_function(&step, I->problem.context);
    if (t == step.t1) I->root = *g;
    return isfinite(*g) ? 0 : -1;
}

/* The vector stays as it is, without numbers: norms have theirs from the space. */
static int call_weights(N_Vector y, N_Vector weights, void *user)
{
    (void)y;
    (void)weights;
    (void)user;
    return 0;
}

/* Keeps ARKODE's message for our own status; without a listener it would be printed. */
static void keep_message(const char *message, void *user)
{
    arkode_integrator *I = user;
    (void)snprintf(I->message, sizeof I->message, "%s", message);
}

/* ---- set-up ---- */

/* The listener comes first, so that no error of SUNDIALS is printed. Room for all vectors is made here, so that no step
 * can run out of memory for one. */
static dem_status allocate(arkode_integrator *I)
{
    const dem_index n = state_size(&I->problem.layout);
    N_Vector *const vectors[] = {&I->y, &I->y0, &I->y1, &I->f0, &I->f1};
    CHECK(SUNContext_Create(SUN_COMM_NULL, &I->sundials) == 0, DEM_ERROR_MEMORY, "SUNDIALS gives no context");
    CHECK(arkode_listen_first(I->sundials, &I->errors) == 0, DEM_ERROR_MEMORY, "out of memory for SUNDIALS");
    I->weights = error_weights_create(&I->problem);
    CHECK(I->weights != NULL, DEM_ERROR_MEMORY, "out of memory for the weights of the error");
    I->space = nvector_space_create(&(nvector_shape){.ranks = ode_problem_ranks(&I->problem),
                                                     .length = n,
                                                     .n_whole = state_size(ode_problem_whole(&I->problem)),
                                                     .weights = I->weights,
                                                     .ops = I->problem.ops,
                                                     .team = I->problem.team},
                                    most_vectors + I->table.stages);
    bool complete = I->space != NULL;
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors && complete; k++) {
        *vectors[k] = nvector_create(I->space, I->sundials);
        complete = *vectors[k] != NULL;
    }
    CHECK(complete, DEM_ERROR_MEMORY, "out of memory for the state of %lld nodes",
          (long long)I->problem.layout.n_nodes);
    nvector_space_start(I->space, I->y0);
    return DEM_OK;
}

/* Without error control ARKODE asks for no norm. */
static void defer_stages(arkode_integrator *I)
{
    const bool shared = I->problem.domain != NULL;
    const deferral_owner owner = {.problem = &I->problem,
                                  .space = I->space,
                                  .weights = I->weights,
                                  .derivative = shared ? evaluate_stage : evaluate,
                                  .count = shared ? count_stages : count_evaluations,
                                  .context = I};
    if (I->problem.fixed_step > 0.0 || butcher_ends_in_stage(&I->table)) return;
    I->deferral = deferral_create(&owner, I->table.stages - 1);
}

/* Ranks that share the nodes see whether an attempt succeeds by way of what ARKODE adds up. */
static void watch_sums(arkode_integrator *I)
{
    if (I->problem.domain == NULL) return;
    shared_attempt_create(&I->shared, &(shared_attempt_owner){.attempt = &I->attempt,
                                                              .table = &I->table,
                                                              .space = I->space,
                                                              .deferral = I->deferral,
                                                              .y0 = I->y0,
                                                              .f1 = I->f1});
}

/* The state from which the next step goes; its derivative is not known. The root function is above 0 there: what has
 * happened up to it has been resolved. */
static void start_from(arkode_integrator *I, double t, const double *y)
{
    if (y != nvector_values(I->y0)) memcpy(nvector_fresh(I->y0), y, (size_t)state_size(&I->problem.layout) * sizeof *y);
    nvector_share(I->y0, I->y);
    I->t = t;
    I->at_end = I->holds_step = I->knows_f0 = I->gives_f0 = I->attempt.knows_stiffening = false;
    I->root = 1.0;
    shared_attempt_forget(&I->shared);
}

/* Gives ARKODE the method. The order given with a table limits the degree of ARKODE's interpolant, and nothing else
 * that is used here: below 4 it would not hold the derivatives at both ends of a step. */
static int set_table(arkode_integrator *I)
{
    butcher_table *t = &I->table;
    ARKodeButcherTable table = ARKodeButcherTable_Create(t->stages, t->order < 4 ? 4 : t->order, t->embedded_order,
                                                         t->c, t->a, t->b, t->embedded_order > 0 ? t->d : NULL);
    if (table == NULL) return -1;
    const int failed = ERKStepSetTable(I->arkode, table);
    ARKodeButcherTable_Free(table);
    return failed;
}

/* Sets the length of the first step after the restart that follows, s, and remembers it for
 * arkode_integrator_next_step(). */
static int ask_step(arkode_integrator *I, double h)
{
    I->asked = h;
    return ARKodeSetInitStep(I->arkode, h);
}

/* The control of steps: a PI controller, safety 0.9, factors between 0.1 and 10. From its second failure of the error
 * test on, a step is cut to 0.3 of its length or less. Fixed steps need none of it. */
static int set_adaptivity(arkode_integrator *I)
{
    void *a = I->arkode;
    const double h = I->problem.fixed_step;
    if (h > 0.0) return ARKodeSetFixedStep(a, h);
    int failed = arkode_use_pi(I->sundials, a, &I->controller);
    failed |= ARKodeSetSafetyFactor(a, 0.9);
    failed |= ARKodeSetErrorBias(a, 1.0);
    failed |= ARKodeSetMaxGrowth(a, 10.0);
    failed |= ARKodeSetMinReduction(a, 0.1);
    failed |= ARKodeSetFixedStepBounds(a, 1.0, 1.0); /* else growth below 1.5 is ignored and the step count jumps */
    failed |= ARKodeSetMaxFirstGrowth(a, 10.0);
    failed |= ARKodeSetMaxEFailGrowth(a, 0.3);
    failed |= ARKodeSetSmallNumEFails(a, 2);
    failed |= ARKodeSetMaxErrTestFails(a, 30);
    failed |= ask_step(I, 0.1 * I->problem.max_step);
    failed |= ARKodeSetMinStep(a, 1e-9 * I->problem.max_step);
    failed |= ARKodeSetMaxStep(a, I->problem.max_step);
    return failed;
}

/* One root function, whose falling through zero is an event; rising ones are none. */
static int set_root_function(arkode_integrator *I)
{
    if (I->problem.root_function == NULL) return 0;
    int falling = -1, failed = ARKodeRootInit(I->arkode, 1, call_root_function);
    failed |= ARKodeSetRootDirection(I->arkode, &falling);
    return failed;
}

static dem_status set_up(arkode_integrator *I, double t, const double *y)
{
    TRY(butcher_load(&I->table, I->problem.method));
    CHECK(I->table.embedded_order > 0 || I->problem.fixed_step > 0.0, DEM_ERROR_ARGUMENT,
          "a method without error estimate needs a fixed step");
    TRY(allocate(I));
    defer_stages(I);
    watch_sums(I);
    start_from(I, t, y);
    I->arkode = ERKStepCreate(call_derivative, t, I->y, I->sundials);
    CHECK(I->arkode != NULL, DEM_ERROR_MEMORY, "out of memory for ARKODE");
    int failed = arkode_listen(I->arkode, &I->errors);
    failed |= ARKodeSetUserData(I->arkode, I);
    failed |= set_table(I);
    failed |=
        ARKodeSetInterpolantDegree(I->arkode, 3); /* 4 and more would call the derivative at every root iteration */
    /* Weights are given, not tolerances: they depend on no state. */
    failed |= ARKodeWFtolerances(I->arkode, call_weights);
    /* No limit on the number of steps in a call, and no warnings of steps below rounding, which would be printed. */
    failed |= ARKodeSetMaxNumSteps(I->arkode, -1);
    failed |= ARKodeSetMaxHnilWarns(I->arkode, -1);
    failed |= set_adaptivity(I);
    failed |= set_root_function(I);
    CHECK(failed == 0, DEM_ERROR_INTEGRATOR, "ARKODE refuses its settings: %s", I->message);
    return DEM_OK;
}

/* ---- the functions of the table ---- */

static void arkode_integrator_destroy(void *self)
{
    arkode_integrator *I = self;
    if (I == NULL) return;
    if (I->arkode != NULL) ARKodeFree(&I->arkode);
    arkode_free_controller(I->controller);
    N_Vector const vectors[] = {I->y, I->y0, I->y1, I->f0, I->f1};
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
        if (vectors[k] != NULL) N_VDestroy(vectors[k]);
    deferral_free(I->deferral);
    nvector_space_free(I->space);
    error_weights_free(I->weights);
    if (I->sundials != NULL) SUNContext_Free(&I->sundials);
    free(I);
}

static dem_status arkode_integrator_create(void **out, const ode_problem *problem, double t, const double *y)
{
    arkode_integrator *I = calloc(1, sizeof *I);
    CHECK_MEMORY(I);
    I->problem = *problem;
    I->errors = (arkode_errors){keep_message, I};
    const dem_status status = set_up(I, t, y);
    if (status == DEM_OK)
        *out = I;
    else
        arkode_integrator_destroy(I);
    return status;
}

/* Restarts ARKODE from y0, keeping its memory of errors and step lengths. If f0 is known it is given to ARKODE, and the
 * restart costs no evaluation. */
static dem_status reset(arkode_integrator *I)
{
    nvector_share(I->y0, I->y);
    I->at_end = I->holds_step = I->attempt.knows_stiffening = false;
    I->gives_f0 = I->knows_f0;
    I->root = 1.0;
    CHECK(ARKodeReset(I->arkode, I->t, I->y) == ARK_SUCCESS, DEM_ERROR_INTEGRATOR,
          "ARKODE does not restart at t = %.9g s: %s", I->t, I->message);
    return DEM_OK;
}

static dem_status arkode_integrator_restart(void *self, double t, const double *y)
{
    arkode_integrator *I = self;
    start_from(I, t, y);
    return reset(I);
}

/* After a derivative that was not finite: once more from the last accepted state, with a tenth of the step. The first
 * time that is a tenth of the length ARKODE was trying. */
static dem_status retry(arkode_integrator *I, double *h)
{
    if (*h == 0.0 && ARKodeGetCurrentStep(I->arkode, h) != ARK_SUCCESS) *h = I->problem.max_step;
    *h *= 0.1;
    I->counts.retries++;
    CHECK(ask_step(I, *h) == ARK_SUCCESS, DEM_ERROR_INTEGRATOR, "ARKODE: %s", I->message);
    return arkode_integrator_restart(I, I->t, nvector_values(I->y0));
}

/* The node with the largest error in the last attempt, of its position and velocity in units of the tolerances. An
 * error that is not finite counts as the largest. */
static dem_index worst_node(const arkode_integrator *I)
{
    const state_layout *l = &I->problem.layout;
    const double *error = nvector_values(I->y1);
    dem_index worst = 0;
    double most = -1.0;
    for (dem_index k = 0; k < state_row(l, l->n_nodes) && most < INFINITY; k++) {
        const dem_index v = k + state_velocities(l);
        const double here =
            fabs(error[k] * error_weights_at(I->weights, k)) + fabs(error[v] * error_weights_at(I->weights, v));
        if (here <= most) continue;
        most = isfinite(here) ? here : (double)INFINITY;
        worst = k / l->dim;
    }
    return worst;
}

/* The error test has failed for every length of the step. Names where. The step has no end, so that the errors can
 * stand in the place of its state. */
static dem_status fail_error_test(arkode_integrator *I)
{
    CHECK(ARKodeGetEstLocalErrors(I->arkode, I->y1) == ARK_SUCCESS, DEM_ERROR_INTEGRATOR, "ARKODE: %s", I->message);
    const dem_index node = worst_node(I);
    const double *x = nvector_values(I->y0) + state_row(&I->problem.layout, node);
    return status_fail(DEM_ERROR_INTEGRATOR,
                       "the step from t = %.9g s fails: no step is short enough for rtol; the error is largest at node "
                       "%lld, at (%g, %g) m",
                       I->t, (long long)node, x[0], x[1]);
}

/* What to tell the user for a flag of ARKODE's; without a sentence of our own, its message. */
static const char *cause(const arkode_integrator *I, int flag)
{
    switch (flag) {
    case ARK_TOO_MUCH_ACC:
        return "rounding alone is more than rtol allows";
    case ARK_ERR_FAILURE:
        return "it may be too long";
    case ARK_RTFUNC_FAIL:
        return "the root function is not finite";
    default:
        return I->message;
    }
}

/* The last accepted state stays in force; the message has the time from which the step failed. */
static dem_status fail_step(arkode_integrator *I, int flag)
{
    if (flag == ARK_ERR_FAILURE && !(I->problem.fixed_step > 0.0)) return fail_error_test(I);
    return status_fail(DEM_ERROR_INTEGRATOR, "the step from t = %.9g s fails: %s", I->t, cause(I, flag));
}

/* Goes on from the end of the step that was handed out: by sharing, no number is copied. */
static void go_on(arkode_integrator *I)
{
    if (!I->at_end) return;
    nvector_share(I->y1, I->y0);
    nvector_share(I->f1, I->f0);
    I->t = I->t1;
    I->at_end = I->gives_f0 = false;
    shared_attempt_go_on(&I->shared);
}

static void arkode_integrator_end(void *self, double **y1, double **f1)
{
    arkode_integrator *I = self;
    *y1 = nvector_shared(I->y1);
    *f1 = nvector_shared(I->f1);
}

/* Rejects the step just taken, for an error that only the caller can see (that of events, docs/algorithms.md, Error
 * control). y0 and f0 still stand, so that the next try begins without an evaluation. */
static dem_status arkode_integrator_redo(void *self, double factor)
{
    arkode_integrator *I = self;
    I->counts.steps--;
    I->counts.rejected++;
    CHECK(ask_step(I, factor * (I->t1 - I->t)) == ARK_SUCCESS, DEM_ERROR_INTEGRATOR, "ARKODE: %s", I->message);
    return reset(I);
}

/* Accepts the step. If an event has cut it short, the state is that of the dense output there, and its derivative is
 * not known; the caller restarts, as velocities have jumped. */
static void arkode_integrator_settle(void *self, const dense_output *step)
{
    arkode_integrator *I = self;
    if (step->end == step->t1) {
        go_on(I);
        return;
    }
    dense_output_state(step, step->end, nvector_fresh(I->y));
    nvector_share(I->y, I->y0);
    I->t = step->end;
    I->at_end = I->knows_f0 = I->attempt.knows_stiffening = false;
    shared_attempt_forget(&I->shared);
}

static double *arkode_integrator_state(const void *self)
{
    const arkode_integrator *I = self;
    return nvector_shared(I->y0);
}

/* ARKODE evaluates the derivative at the start of a step after its length is given: what that depends on of other ranks
 * is not known before the first. */
static double fixed_step(arkode_integrator *I)
{
    const ode_problem *p = &I->problem;
    const bool asks = p->stiffening != NULL && !I->attempt.knows_stiffening;
    if (p->domain != NULL && asks) ode_problem_fill_ghosts(p, nvector_shared(I->y0));
    return attempt_fixed_step(&I->attempt, nvector_values(I->y0), false);
}

/* Begins with another attempt by a call of ARKODE. */
static void begin_attempt(arkode_integrator *I)
{
    I->holds_step = I->failed = false;
    attempt_begin(&I->attempt, &I->problem);
    if (I->problem.domain != NULL) shared_attempt_begin(&I->shared, I->t);
}

/* What ARKODE's attempt has come to on other ranks. */
static void take_failure(arkode_integrator *I)
{
    if (!I->shared.has_failed) return;
    I->failed = true;
    I->refused = I->shared.outcome.refused;
    I->counts.evaluations -= I->shared.n_superfluous;
}

/* An attempt at a step, whose ends are there if it is accepted. The time that ARKODE is to reach lies far beyond it: no
 * step is ever shortened for a frame or for t_end. Since SUNDIALS 7 the derivative at the end is not evaluated before
 * it is fetched: a failure there is one of the attempt.  \return ARKODE's flag */
static int evolve(arkode_integrator *I, double *reached)
{
    const int flag = ARKodeEvolve(I->arkode, I->t + 1e6 * I->problem.max_step, I->y, reached, ARK_ONE_STEP);
    if (flag != ARK_SUCCESS && flag != ARK_ROOT_RETURN) return flag;
    return fetch_step(I) == 0 ? flag : ARK_RHSFUNC_FAIL;
}

/* One accepted step. Failures of the derivative are tried again with shorter steps, unless the steps are fixed or no
 * step may mend it; their message is the derivative's own. */
static dem_status arkode_integrator_step(void *self, dense_output *step, bool *rooted)
{
    arkode_integrator *I = self;
    go_on(I);
    if (I->problem.begin_roots != NULL) I->problem.begin_roots(I->t, nvector_values(I->y0), I->problem.context);
    double reached, h = 0.0;
    int flag = ARK_SUCCESS;
    for (int tries = 0; tries <= max_retries; tries++) {
        begin_attempt(I);
        if (I->problem.fixed_step > 0.0) (void)ARKodeSetFixedStep(I->arkode, fixed_step(I));
        flag = evolve(I, &reached);
        take_failure(I);
        if (!I->failed) break;
        if (I->problem.fixed_step > 0.0 || tries == max_retries || I->refused)
            return DEM_ERROR_INTEGRATOR; /* message: derivative's */
        TRY(retry(I, &h));
    }
    if (flag != ARK_SUCCESS && flag != ARK_ROOT_RETURN) return fail_step(I, flag);
    I->counts.steps++;
    I->asked = 0.0;
    I->at_end = true;
    *rooted = flag == ARK_ROOT_RETURN;
    *step = held_path(I);
    if (*rooted) step->end = reached;
    return DEM_OK;
}

/* The first step that has been asked for, or the one that the controller has chosen. */
static double arkode_integrator_next_step(const void *self)
{
    const arkode_integrator *I = self;
    double next = 0.0;
    if (I->problem.fixed_step > 0.0) return 0.0;
    if (I->asked > 0.0) return I->asked;
    return ARKodeGetCurrentStep(I->arkode, &next) == ARK_SUCCESS ? next : 0.0;
}

/* Unlike a restart, forgets ARKODE's memory of errors as well: a run that passes a checkpoint and one that is resumed
 * from it go on to the same bits. */
static dem_status arkode_integrator_renew(void *self, const integrator_start *from)
{
    arkode_integrator *I = self;
    start_from(I, from->t, from->y);
    I->counts = (dem_counts){.steps = from->counts.steps,
                             .rejected = from->counts.rejected,
                             .evaluations = from->counts.evaluations,
                             .retries = from->counts.retries};
    int failed = ERKStepReInit(I->arkode, call_derivative, I->t, I->y);
    if (!(I->problem.fixed_step > 0.0)) failed |= ask_step(I, fmin(from->next_step, I->problem.max_step));
    CHECK(failed == 0, DEM_ERROR_INTEGRATOR, "ARKODE does not begin anew at t = %.9g s: %s", I->t, I->message);
    return DEM_OK;
}

/* Shortens the next first step only if it would be longer. */
static dem_status arkode_integrator_bound(void *self, double longest)
{
    arkode_integrator *I = self;
    double next;
    if (isfinite(longest) && ARKodeGetCurrentStep(I->arkode, &next) == ARK_SUCCESS && next > longest)
        CHECK(ask_step(I, longest) == ARK_SUCCESS, DEM_ERROR_INTEGRATOR, "ARKODE: %s", I->message);
    return DEM_OK;
}

static dem_status arkode_integrator_resume(void *self)
{
    arkode_integrator *I = self;
    shared_attempt_forget(&I->shared);
    return reset(I);
}

/* Rejections by ARKODE's error test are counted by ARKODE, those by redo() here. */
static dem_counts arkode_integrator_counts(const void *self)
{
    const arkode_integrator *I = self;
    dem_counts counts = I->counts;
    long rejected = 0;
    if (ARKodeGetNumErrTestFails(I->arkode, &rejected) == ARK_SUCCESS) counts.rejected += rejected;
    return counts;
}

const integrator_ops arkode_integrator_ops = {.create = arkode_integrator_create,
                                              .destroy = arkode_integrator_destroy,
                                              .step = arkode_integrator_step,
                                              .end = arkode_integrator_end,
                                              .redo = arkode_integrator_redo,
                                              .settle = arkode_integrator_settle,
                                              .state = arkode_integrator_state,
                                              .bound = arkode_integrator_bound,
                                              .resume = arkode_integrator_resume,
                                              .restart = arkode_integrator_restart,
                                              .next_step = arkode_integrator_next_step,
                                              .renew = arkode_integrator_renew,
                                              .counts = arkode_integrator_counts};

const char *dem_version_sundials(void)
{
    return SUNDIALS_VERSION;
}
