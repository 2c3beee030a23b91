/* SPDX-License-Identifier: BSD-3-Clause */
/* An attempt at a step by ARKODE that ranks make together, each for its nodes: whether it succeeds is known to all by
 * one reduction. */
#ifndef DEM_TIME_SHARED_ATTEMPT_H
#define DEM_TIME_SHARED_ATTEMPT_H

#include "time/attempt.h"
#include "time/butcher.h"
#include "time/deferral.h"
#include "time/nvector.h"

/** What belongs to the integrator. */
typedef struct shared_attempt_owner {
    attempt *attempt;
    const butcher_table *table;
    nvector_space *space;
    deferral *deferral; /* of stages that need nothing of other ranks; NULL: none are deferred */
    N_Vector y0, f1;    /* the state from which the step goes; the derivative at its end, written */
} shared_attempt_owner;

typedef struct shared_attempt {
    shared_attempt_owner owner;
    nvector_deferral seen;    /* by the space */
    bool is_over;             /* the ranks know each other's ends: */
    attempt_end outcome;      /* what all have */
    bool has_failed;          /* a derivative that ARKODE has asked for has failed on some rank */
    int n_asked;              /* derivatives that ARKODE has asked for in the attempt, */
    int n_stages;             /* those among them that are not at the start of the step */
    int n_superfluous;        /* and, if it has failed, those that a process alone would not have made */
    N_Vector last;            /* result of the last sum with the state in it: the end of the step at last */
    double t0, t1;            /* s, start of the step, and its end, once a stage was there */
    bool has_f1;              /* whether f1 is the derivative at the end, which ARKODE has not asked for yet */
    N_Vector error;           /* of the attempt; NULL: not known */
    double norm[2], scale[2]; /* of the error and of the end of the step, and the scales of these sums of squares */
    double usual_scale;       /* of the error of the last step that was accepted */
    double norm_of_start;     /* of y0, */
    bool knows_start;         /* if that is known */
} shared_attempt;

/** Takes part in the operations on the vectors of the space from now on. Borrows what the owner refers to, and must
 *  stay where it is. */
void shared_attempt_create(shared_attempt *out, const shared_attempt_owner *owner);

/** Begins with an attempt at a step from y0 at t0. */
void shared_attempt_begin(shared_attempt *s, double t0);

/** Evaluates f = f(t, y) for ARKODE.  \return 0, or -1 if this or an earlier one has failed on some rank, whose message
 *  is set then */
int shared_attempt_evaluate(shared_attempt *s, double t, N_Vector y, N_Vector f);

/** Evaluates the derivative at a stage that was deferred. */
void shared_attempt_evaluate_stage(shared_attempt *s, double t, N_Vector y, N_Vector f);

/** The end of the step has become y0, or y0 is another state. */
void shared_attempt_go_on(shared_attempt *s);
void shared_attempt_forget(shared_attempt *s);

#endif
