/* SPDX-License-Identifier: BSD-3-Clause */
/* ARKODE evaluates the stages, then adds up the end of the step and its error, whose norm decides, and then evaluates
 * the derivative at the end. That is evaluated ahead here, before the norm, so that the squares of the error and all
 * failures of the attempt travel in one reduction; ARKODE gets it when it asks. Of an attempt that is rejected it is in
 * vain. ARKODE also asks for the norm of the state from which a step goes, to see whether rounding alone is more than
 * what is allowed: that is known from the squares at the end of the last step.
 *
 * Where ghosts are integrated here, too, stages need nothing of other ranks, so that a rank may defer them, and take
 * its step as a wave (deferral.h) or stage after stage: the others need not know which.
 *
 * The error is recognised as the one sum of several vectors without the state. With fixed steps there is none: then the
 * reduction is made with the derivative at the end of the step. */
#include "time/shared_attempt.h"

#include <math.h>

#include "base/status.h"

static const ode_problem *problem_of(const shared_attempt *s)
{
    return s->owner.attempt->problem;
}

/* Begins with another attempt at the same step. */
static void begin_again(shared_attempt *s)
{
    attempt_begin(s->owner.attempt, problem_of(s));
    s->is_over = s->has_failed = s->has_f1 = false;
    s->n_asked = s->n_stages = 0;
    s->last = s->error = NULL;
    s->scale[0] = s->usual_scale;
    deferral_set_scale(s->owner.deferral, s->usual_scale);
    s->t1 = NAN;
}

void shared_attempt_begin(shared_attempt *s, double t0)
{
    begin_again(s);
    s->t0 = t0;
}

static bool ends_in_stage(const shared_attempt *s)
{
    return butcher_ends_in_stage(s->owner.table);
}

/* ---- the end of an attempt ---- */

void shared_attempt_evaluate_stage(shared_attempt *s, double t, N_Vector y, N_Vector f)
{
    const ode_problem *p = problem_of(s);
    double *u = nvector_fresh(f);
    (void)attempt_evaluate(s->owner.attempt, t, nvector_values(y), u, u + state_velocities(&p->layout));
}

/* The same where a step begins or ends: with the ghosts as others have them. */
static void evaluate_end(shared_attempt *s, double t, N_Vector y, N_Vector f)
{
    ode_problem_fill_ghosts(problem_of(s), nvector_shared(y));
    shared_attempt_evaluate_stage(s, t, y, f);
}

/* Stages that a wave has taken, one by one after all: they have not failed, whatever has behind them, and have been
 * counted. */
static void make_up(const shared_attempt *s)
{
    const attempt now = *s->owner.attempt;
    s->owner.attempt->failed = ATTEMPT_NONE;
    deferral_make_up(s->owner.deferral);
    *s->owner.attempt = now;
}

/* Puts the sums of squares of this rank into the packet. A wave leaves no errors: where its own sum does not hold, its
 * stages are made up. */
static void add_squares(const shared_attempt *s, attempt_end *end)
{
    const bool has_error = s->error != NULL && !deferral_has_squares(s->owner.deferral, s->scale[0], &end->error);
    if (has_error) make_up(s);
    if (has_error) end->error = nvector_squares(s->error, s->scale[0]);
    end->state = nvector_squares(s->last, s->scale[1]);
}

/* Finds the norms of all ranks.  \return whether the scales hold; else there are better ones */
static bool find_norms(shared_attempt *s, const attempt_end *end)
{
    const bool holds = s->error == NULL || nvector_norm_of_sum(s->owner.space, &end->error, &s->scale[0], &s->norm[0]);
    return nvector_norm_of_sum(s->owner.space, &end->state, &s->scale[1], &s->norm[1]) && holds;
}

/* Ranks tell each other what they have.  \param y  the end of the step */
static void tell(shared_attempt *s, const double *y)
{
    do {
        s->outcome = attempt_own_end(s->owner.attempt, y);
        add_squares(s, &s->outcome);
        attempt_tell(s->owner.attempt, &s->outcome);
    } while (!find_norms(s, &s->outcome));
    s->is_over = true;
}

/* After a failure ARKODE ends its step, whatever was to come of it. */
static int fail(shared_attempt *s)
{
    attempt_name_failure(s->owner.attempt, &s->outcome);
    s->has_failed = true;
    s->n_superfluous = s->n_asked - (s->outcome.failed + 1);
    return -1;
}

/* A failure of the derivative at the end counts only if ARKODE asks for that. Where the sums have been taken with
 * another scale the end of the step has been written anew, without the ghosts of others. */
static int end_with_error(shared_attempt *s)
{
    if (!ends_in_stage(s) && !isnan(s->t1)) {
        evaluate_end(s, s->t1, s->last, s->owner.f1);
        s->has_f1 = true;
    }
    tell(s, NULL);
    if (!(s->norm[0] <= 1.0)) {
        make_up(s);
    } else if (s->scale[0] != s->usual_scale) {
        if (problem_of(s)->domain->once_a_step) ode_problem_fill_ghosts(problem_of(s), nvector_shared(s->last));
        s->usual_scale = s->scale[0];
    }
    return s->outcome.failed < s->n_asked ? fail(s) : 0;
}

/* ---- what ARKODE asks for ---- */

/* The state from which the step goes is not due. */
static bool is_start(const shared_attempt *s, N_Vector y)
{
    return nvector_get_use(y) != NVECTOR_DUE && nvector_values(y) == nvector_values(s->owner.y0);
}

/* Whether a sum is deferred, or was carried out with those that were. */
static bool defer_sum(const shared_attempt *s, int n, const double *factor, N_Vector *x, N_Vector z, int *status)
{
    if (s->owner.deferral == NULL) return false;
    const nvector_deferral *d = deferral_seen(s->owner.deferral);
    return d->take_sum(d->self, n, factor, x, z, status);
}

static bool take_sum(void *self, int n, const double *factor, N_Vector *x, N_Vector z, int *status)
{
    shared_attempt *s = self;
    int n_terms = 0;
    bool has_start = false;
    for (int k = 0; k < n; k++) {
        if (factor[k] == 0.0) continue;
        n_terms++;
        has_start = has_start || is_start(s, x[k]);
    }
    if (n_terms < 2) return defer_sum(s, n, factor, x, z, status);
    if (has_start) {
        if (s->error != NULL) begin_again(s);
        s->last = z;
        return defer_sum(s, n, factor, x, z, status);
    }
    if (!defer_sum(s, n, factor, x, z, status)) *status = nvector_combine(n, factor, x, z);
    s->error = z;
    if (*status == 0) *status = end_with_error(s);
    return true;
}

static bool take_norm(void *self, N_Vector x, double *norm)
{
    const shared_attempt *s = self;
    if (x == s->error) {
        *norm = s->norm[0];
        return true;
    }
    *norm = s->norm_of_start;
    return s->knows_start && is_start(s, x);
}

/* Only where something is deferred. */
static void before_read(void *self)
{
    const nvector_deferral *d = deferral_seen(((const shared_attempt *)self)->owner.deferral);
    d->before_read(d->self);
}

static void before_write(void *self)
{
    const nvector_deferral *d = deferral_seen(((const shared_attempt *)self)->owner.deferral);
    d->before_write(d->self);
}

/* The derivative at the end of the step, which has been evaluated ahead. */
static int give_f1(shared_attempt *s, N_Vector f)
{
    s->has_f1 = false;
    nvector_share(s->owner.f1, f);
    return s->outcome.failed != ATTEMPT_NONE ? fail(s) : 0;
}

/* Whether the derivative asked for last is that at the end of the step. */
static bool is_at_end(const shared_attempt *s)
{
    return s->n_stages == s->owner.table->stages - ends_in_stage(s);
}

/* Whether ranks have to tell each other of it, and have not done so when it was evaluated ahead. */
static bool is_last(const shared_attempt *s)
{
    return s->is_over || (problem_of(s)->fixed_step > 0.0 && is_at_end(s));
}

/* Where a step begins without a derivative ARKODE has no length for it yet: a failure is known to all at once. */
static int evaluate_start(shared_attempt *s, N_Vector y, N_Vector f)
{
    evaluate_end(s, s->t0, y, f);
    s->last = y;
    tell(s, nvector_values(y));
    s->is_over = false;
    s->norm_of_start = s->norm[1];
    s->knows_start = true;
    return s->outcome.failed != ATTEMPT_NONE ? fail(s) : 0;
}

int shared_attempt_evaluate(shared_attempt *s, double t, N_Vector y, N_Vector f)
{
    const butcher_table *table = s->owner.table;
    s->n_asked++;
    if (s->has_f1 && t == s->t1 && nvector_values(y) == nvector_values(s->last)) return give_f1(s, f);
    if (t == s->t0 && is_start(s, y)) return evaluate_start(s, y, f);
    s->n_stages++;
    if (s->n_stages < table->stages && table->c[s->n_stages] == 1.0) s->t1 = t;
    if (deferral_take_derivative(s->owner.deferral, t, y, f)) return 0;
    if (is_at_end(s) || !problem_of(s)->domain->once_a_step)
        evaluate_end(s, t, y, f);
    else
        shared_attempt_evaluate_stage(s, t, y, f);
    if (!is_last(s)) return 0;
    tell(s, nvector_values(y));
    return s->outcome.failed != ATTEMPT_NONE ? fail(s) : 0;
}

/* ---- from step to step ---- */

void shared_attempt_create(shared_attempt *out, const shared_attempt_owner *owner)
{
    *out = (shared_attempt){.owner = *owner, .scale[1] = 1.0, .usual_scale = 1.0, .t1 = NAN};
    out->seen = (nvector_deferral){.self = out,
                                   .take_sum = take_sum,
                                   .take_norm = take_norm,
                                   .before_read = before_read,
                                   .before_write = before_write};
    nvector_space_defer(owner->space, &out->seen);
}

void shared_attempt_go_on(shared_attempt *s)
{
    s->norm_of_start = s->norm[1];
    s->knows_start = s->is_over;
}

void shared_attempt_forget(shared_attempt *s)
{
    s->knows_start = false;
}
