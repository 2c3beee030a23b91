/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of failed evaluations are those of a process alone, which would have made the same ones up to the first that
 * has failed on any rank: by them it is known which failure counts, and how many evaluations. */
#include "time/attempt.h"

#include <string.h>

#include "base/reduce.h"

void attempt_begin(attempt *a, const ode_problem *problem)
{
    a->problem = problem;
    a->n = 0;
    a->failed = ATTEMPT_NONE;
    a->refused = false;
}

/* Derivatives of 0, as those that are not finite would go from rank to rank. */
static void clear(const ode_problem *p, double *u, double *accelerations)
{
    const size_t size = (size_t)state_velocities(&p->layout) * sizeof *accelerations;
    if (u != NULL) memset(u, 0, size);
    memset(accelerations, 0, size);
}

/* Notes the flag of another evaluation.  \return that of attempt_evaluate() */
static int note(attempt *a, int flag, double *u, double *accelerations)
{
    if (flag != 0) {
        a->failed = a->n;
        a->refused = flag > 1;
    }
    a->n++;
    if (a->problem->domain == NULL) return flag;
    if (a->failed != ATTEMPT_NONE) clear(a->problem, u, accelerations);
    return 0;
}

int attempt_evaluate(attempt *a, double t, const double *y, double *u, double *accelerations)
{
    const ode_problem *p = a->problem;
    int flag = 0;
    if (a->failed == ATTEMPT_NONE || p->domain == NULL)
        flag = p->derivative(t, y, u, accelerations, p->context);
    else
        p->domain->take_part(p->context);
    return note(a, flag, u, accelerations);
}

int attempt_take_fused_step(attempt *a, const ode_fused_step *step)
{
    const ode_problem *p = a->problem;
    if (p->fused_step == NULL || a->failed != ATTEMPT_NONE) return -1;
    const int flag = p->fused_step(step, p->context);
    return flag < 0 ? flag : note(a, flag, NULL, step->f1 + state_velocities(&p->layout));
}

attempt_end attempt_own_end(const attempt *a, const double *end)
{
    const ode_problem *p = a->problem;
    const bool is_stiff = p->fixed_step > 0.0 && p->stiffening != NULL && a->failed == ATTEMPT_NONE;
    return (attempt_end){.failed = a->failed,
                         .refused = a->refused,
                         .stops = p->domain != NULL && p->domain->wants_stop(p->context),
                         .stiffening = is_stiff ? p->stiffening(end, true, p->context) : 1.0};
}

static void join(void *packet, const void *other)
{
    attempt_end *own = packet;
    const attempt_end *theirs = other;
    if (theirs->failed == own->failed) own->refused = own->refused || theirs->refused;
    if (theirs->failed < own->failed) {
        own->failed = theirs->failed;
        own->refused = theirs->refused;
    }
    own->stops = own->stops || theirs->stops;
    own->stiffening = reduce_larger(own->stiffening, theirs->stiffening);
    array_ops_add(&own->error, &theirs->error);
    array_ops_add(&own->state, &theirs->state);
}

void attempt_tell(attempt *a, attempt_end *end)
{
    const ode_problem *p = a->problem;
    const ranks *r = ode_problem_ranks(p);
    r->reduce(r->self, end, sizeof *end, join);
    a->stiffening = end->stiffening;
    a->knows_stiffening = p->fixed_step > 0.0 && end->failed == ATTEMPT_NONE;
    if (end->stops) p->domain->stop(p->context);
}

void attempt_name_failure(const attempt *a, const attempt_end *end)
{
    const ode_problem *p = a->problem;
    p->domain->name_failure(a->failed == end->failed, p->context);
}

double attempt_fixed_step(attempt *a, const double *y, bool is_known)
{
    enum { most_halvings = 30 }; /* positions that blow up have no bound; time must go on until they are reported */
    const ode_problem *p = a->problem;
    double h = p->fixed_step, stiffening = 1.0;
    if (a->knows_stiffening)
        stiffening = a->stiffening;
    else if (p->stiffening != NULL)
        stiffening = reduce_max(ode_problem_ranks(p), p->stiffening(y, is_known, p->context));
    for (int k = 0; k < most_halvings && h * stiffening > p->fixed_step; k++) h *= 0.5;
    return h;
}
