/* SPDX-License-Identifier: BSD-3-Clause */
/* A step of an embedded pair by ERKStep is a series of calls: for each stage a linear combination, z = y + h sum of
 * a_ij f_j, and its derivative; then two combinations in a row, the end of the step and its error; then the norm. It
 * begins with a stage that has two terms, one of them y itself. Each call is recorded with its vectors. With the second
 * of two combinations in a row the step is complete: it is taken as a wave, or, where that is not possible, the calls
 * are made one after the other, just as they came. There a failed derivative is reported, as the sum's failure. Calls
 * that come in any other order are made, too, as soon as something else needs their vectors.
 *
 * A wave leaves only the end of the step and the norm, or, where ranks are still to judge it, this rank's sum of
 * squares in one scale: for another scale the calls are made after all. The stages' derivatives and the error stay due;
 * ARKODE does not read them, but if it did, the calls would be made after all. They are forgotten when one of the
 * vectors that they read or write gets another meaning, mostly with the next step. Of a step that is rejected the error
 * may be asked for when all its vectors are gone, so that then the calls are made at once. */
#include "time/deferral.h"

#include <stdlib.h>

enum { MOST_CALLS = STAGE_WAVE_RATES + STAGE_WAVE_SUMS };

/* result = sum of factor_k x_k, or, with n = 0, the derivative at (t, x_0). */
typedef struct deferred_call {
    N_Vector result;
    double t;
    int n;
    double factor[STAGE_WAVE_TERMS];
    N_Vector x[STAGE_WAVE_TERMS];
} deferred_call;

struct deferral {
    deferral_owner owner;
    nvector_deferral seen; /* by the space */
    stage_wave *wave;
    int n_stages; /* of its steps */
    deferred_call calls[MOST_CALLS];
    int n_calls;
    bool is_done;          /* the calls have been taken as a wave */
    array_ops_sum squares; /* of the last wave, of this rank, */
    double scale, norm;    /* with this scale; and the norm, where there are no other ranks */
};

/* ---- the list ---- */

static void forget(deferral *d)
{
    for (int k = 0; k < d->n_calls; k++) {
        const deferred_call *c = &d->calls[k];
        nvector_set_use(c->result, NVECTOR_FREE);
        for (int p = 0; p < c->n; p++) nvector_set_use(c->x[p], NVECTOR_FREE);
    }
    d->n_calls = 0;
    d->is_done = false;
}

/* Makes the calls in the order in which they came, up to the first that fails. */
static int make_calls(deferral *d)
{
    const int n = d->n_calls;
    int failed = 0;
    forget(d);
    for (int k = 0; k < n && failed == 0; k++) {
        deferred_call *c = &d->calls[k];
        if (c->n > 0)
            failed = nvector_combine(c->n, c->factor, c->x, c->result);
        else
            failed = d->owner.derivative(c->t, c->x[0], c->result, d->owner.context);
    }
    return failed;
}

/* A failure shows in what follows: the vectors that are left out keep other numbers. */
static void before_read(void *self)
{
    (void)make_calls(self);
}

static void before_write(void *self)
{
    deferral *d = self;
    if (d->is_done)
        forget(d);
    else
        (void)make_calls(d);
}

static bool is_sum(const deferral *d, int k)
{
    return k >= 0 && k < d->n_calls && d->calls[k].n > 0;
}

static bool is_waiting(const deferral *d)
{
    return d->n_calls > 0 && !d->is_done;
}

static void record(deferral *d, const deferred_call *c)
{
    d->calls[d->n_calls++] = *c;
    for (int p = 0; p < c->n; p++)
        if (nvector_get_use(c->x[p]) == NVECTOR_FREE) nvector_set_use(c->x[p], NVECTOR_READ);
    nvector_set_use(c->result, NVECTOR_DUE);
}

/* ---- the wave ---- */

/* The end of the step that the calls are. */
static N_Vector end_of(const deferral *d)
{
    return d->calls[d->n_calls - 2].result;
}

/* The operand of a vector: a derivative of an earlier stage, or one that was there.  \return -1 if it is none of
 * these, or there is no room */
static int operand_of(const deferral *d, int call, N_Vector v, stage_program *p)
{
    if (v == end_of(d)) return -1;
    for (int k = call - 1; k >= 0; k--)
        if (d->calls[k].result == v) return is_sum(d, k) ? -1 : STAGE_WAVE_GIVEN + k / 2;
    const double *values = nvector_values(v);
    for (int k = 0; k < STAGE_WAVE_GIVEN; k++) {
        if (p->given[k] == NULL) p->given[k] = values;
        if (p->given[k] == values) return k;
    }
    return -1;
}

static bool describe_sum(const deferral *d, int call, stage_sum *out, stage_program *p)
{
    const deferred_call *c = &d->calls[call];
    out->n = c->n;
    for (int k = 0; k < c->n; k++) {
        out->factor[k] = c->factor[k];
        out->operand[k] = operand_of(d, call, c->x[k], p);
        if (out->operand[k] < 0) return false;
    }
    return true;
}

/* The calls as a program: sum, derivative, sum, derivative, ..., sum, sum.  \return whether they are one */
static bool describe(const deferral *d, stage_program *p)
{
    *p = (stage_program){.n_stages = d->n_calls / 2 - 1, .weights = d->owner.weights, .scale = d->scale};
    for (int k = 0; k < d->n_calls; k++) {
        const bool is_stage = k < 2 * p->n_stages;
        if (is_sum(d, k) != (!is_stage || k % 2 == 0)) return false;
        if (is_sum(d, k) && !describe_sum(d, k, &p->sums[is_stage ? k / 2 : k - p->n_stages], p)) return false;
        if (!is_sum(d, k) && d->calls[k].x[0] != d->calls[k - 1].result) return false;
        if (!is_sum(d, k)) p->t[k / 2] = d->calls[k].t;
    }
    return true;
}

/* The norm is good if its scale was that of the largest error; else the next wave has a better one.
 * \return whether the step has been taken, and, unless ranks are still to judge it, is accepted */
static bool run_wave(deferral *d)
{
    stage_program p;
    if (d->n_calls % 2 != 0 || !describe(d, &p)) return false;
    nvector_set_use(end_of(d), NVECTOR_FREE);
    p.end = nvector_fresh(end_of(d));
    if (!stage_wave_run(d->wave, &p, &d->squares)) return false;
    if (d->owner.problem->domain != NULL) return true;
    return nvector_norm_of_sum(d->owner.space, &d->squares, &d->scale, &d->norm) && d->norm <= 1.0;
}

/* \return -1 if a derivative has failed */
static int take_step(deferral *d)
{
    if (!run_wave(d)) return make_calls(d) == 0 ? 0 : -1;
    d->is_done = true;
    d->owner.count(d->n_calls / 2 - 1, d->owner.context);
    return 0;
}

/* ---- what is deferred ---- */

/* Terms of 0 are left out.  \return whether there is room */
static bool describe_call(int n, const double *factor, N_Vector *x, N_Vector z, deferred_call *out)
{
    out->result = z;
    out->n = 0;
    for (int k = 0; k < n; k++) {
        if (factor[k] == 0.0) continue;
        if (out->n == STAGE_WAVE_TERMS) return false;
        out->factor[out->n] = factor[k];
        out->x[out->n++] = x[k];
    }
    return out->n > 0;
}

static bool begins_step(const deferral *d, const deferred_call *c)
{
    return c->n == 2 && (c->factor[0] == 1.0 || c->factor[1] == 1.0) && c->x[0] != c->result && c->x[1] != c->result &&
           d->owner.problem->has_bands(d->n_stages, d->owner.problem->context);
}

static bool take_sum(void *self, int n, const double *factor, N_Vector *x, N_Vector z, int *status)
{
    deferral *d = self;
    deferred_call c;
    *status = 0;
    if (!describe_call(n, factor, x, z, &c) || d->n_calls == MOST_CALLS) return false;
    if (!is_waiting(d)) {
        if (!begins_step(d, &c)) return false;
        for (int k = 0; k < c.n; k++) (void)nvector_values(c.x[k]); /* what is due is carried out */
        forget(d);
    }
    const bool completes = is_sum(d, d->n_calls - 1);
    record(d, &c);
    if (completes) *status = take_step(d);
    return true;
}

bool deferral_take_derivative(deferral *d, double t, N_Vector y, N_Vector f)
{
    if (d == NULL || !is_waiting(d) || !is_sum(d, d->n_calls - 1) || d->n_calls == MOST_CALLS) return false;
    if (d->calls[d->n_calls - 1].result != y) return false;
    record(d, &(deferred_call){.result = f, .t = t, .x = {y}});
    return true;
}

static bool take_norm(void *self, N_Vector x, double *norm)
{
    const deferral *d = self;
    if (!d->is_done || d->calls[d->n_calls - 1].result != x) return false;
    *norm = d->norm;
    return true;
}

bool deferral_has_squares(const deferral *d, double scale, array_ops_sum *squares)
{
    if (d == NULL || !d->is_done || scale != d->scale) return false;
    *squares = d->squares;
    return true;
}

void deferral_set_scale(deferral *d, double scale)
{
    if (d != NULL) d->scale = scale;
}

void deferral_make_up(deferral *d)
{
    if (d != NULL && d->is_done) (void)make_calls(d);
}

/* ---- making and freeing ---- */

deferral *deferral_create(const deferral_owner *owner, int n_stages)
{
    if (owner->problem->has_bands == NULL) return NULL;
    deferral *d = calloc(1, sizeof *d);
    if (d == NULL) return NULL;
    d->owner = *owner;
    d->n_stages = n_stages;
    d->scale = 1.0;
    d->seen = (nvector_deferral){d, take_sum, take_norm, before_read, before_write};
    d->wave = stage_wave_create(owner->problem, n_stages);
    if (d->wave == NULL) {
        free(d);
        return NULL;
    }
    nvector_space_defer(owner->space, &d->seen);
    return d;
}

void deferral_free(deferral *d)
{
    if (d == NULL) return;
    nvector_space_defer(d->owner.space, NULL);
    stage_wave_free(d->wave);
    free(d);
}

const nvector_deferral *deferral_seen(const deferral *d)
{
    return &d->seen;
}
