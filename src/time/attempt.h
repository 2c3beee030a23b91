/* SPDX-License-Identifier: BSD-3-Clause */
/* An attempt at a step, whose derivatives may fail. A process alone gives it up with the first that does. Ranks that
 * integrate together would have to ask each other after every evaluation; instead a rank whose derivative has failed
 * goes on with derivatives of 0, of which nothing comes, and at the end of the attempt all ranks tell each other in one
 * reduction what they have to know. */
#ifndef DEM_TIME_ATTEMPT_H
#define DEM_TIME_ATTEMPT_H

#include <limits.h>

#include "time/ode_problem.h"

enum { ATTEMPT_NONE = INT_MAX };

typedef struct attempt {
    const ode_problem *problem;
    int n;                 /* evaluations so far */
    int failed;            /* the number of the one that has failed here; ATTEMPT_NONE: none has */
    bool refused;          /* and that no shorter step may mend */
    bool knows_stiffening; /* of the state from which the next step goes: */
    double stiffening;     /* of all ranks */
} attempt;

/** What ranks tell each other at the end of an attempt: first what one of them has, then what all have. */
typedef struct attempt_end {
    int failed; /* as in an attempt: the first */
    bool refused;
    bool stops; /* whether a rank wants the run to stop */
    double stiffening;
    array_ops_sum error, state; /* sums of squares of the error and of the state at the end; or 0 */
} attempt_end;

/** Begins with no evaluations. What is known of the stiffening remains. */
void attempt_begin(attempt *a, const ode_problem *problem);

/** Evaluates u, unless that is NULL, and accelerations at t of y, whose ghosts are filled.
 *  \return 0, or what the derivative returns if the attempt is over with it: ranks go on to its end */
int attempt_evaluate(attempt *a, double t, const double *y, double *u, double *accelerations);

/** Counts evaluations made otherwise, none of which has failed. */
static inline void attempt_count(attempt *a, int n)
{
    a->n += n;
}

/** Takes a step of Verlet's method at once, with the evaluation at its end.
 *  \return as attempt_evaluate(); -1 if that is not possible from this state, and nothing has been done */
int attempt_take_fused_step(attempt *a, const ode_fused_step *step);

/** What this rank has to tell at the end of an attempt. With fixed steps that is also how stiff the bodies are there.
 *  \param end  the state, of which the last evaluation was; not read with error control */
attempt_end attempt_own_end(const attempt *a, const double *end);

/** What all ranks have, in place of what this one has. Collective. */
void attempt_tell(attempt *a, attempt_end *end);

/** Sets the message of a failure on all ranks, that of a process alone. Collective. */
void attempt_name_failure(const attempt *a, const attempt_end *end);

/** Notes that at the end of steps taken at once nothing is stiffer than at rest, on all ranks. */
static inline void attempt_end_at_rest(attempt *a)
{
    a->stiffening = 1.0;
    a->knows_stiffening = true;
}

/** Length of a fixed step from y, s: halved until its product with the highest frequency is no larger than about the
 *  rest shape. Collective.
 *  \param is_known  as for `stiffening` of the problem */
double attempt_fixed_step(attempt *a, const double *y, bool is_known);

#endif
