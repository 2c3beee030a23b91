/* SPDX-License-Identifier: BSD-3-Clause */
/* Operations of ARKODE that are recorded when it calls for them and carried out when their results are needed. Of a
 * step of an explicit Runge-Kutta method that is not before the error's norm: so all stages can be one pass
 * (stage_wave.h). Who reads a vector before gets what an operation at once would have given. */
#ifndef DEM_TIME_DEFERRAL_H
#define DEM_TIME_DEFERRAL_H

#include "time/nvector.h"
#include "time/stage_wave.h"

typedef struct deferral deferral;

/** Evaluates f = f(t, y) at once.  \return 0 or not */
typedef int deferral_derivative(double t, N_Vector y, N_Vector f, void *context);

/** Who needs deferred operations. Ranks that integrate together judge the error of a step when all have taken it. */
typedef struct deferral_owner {
    const ode_problem *problem;
    nvector_space *space;                /* whose operations are deferred from now on */
    const error_weights *weights;        /* of its norms */
    deferral_derivative *derivative;     /* of operations carried out one by one, and */
    void (*count)(int n, void *context); /* how many a wave has evaluated */
    void *context;
} deferral_owner;

/** Of steps with so many derivatives before their end. NULL if it does not pay, or without memory. Borrows what the
 *  owner refers to. Free with deferral_free(), after all vectors. */
deferral *deferral_create(const deferral_owner *owner, int n_stages);
void deferral_free(deferral *d);

/** What the space has to ask and to call, for who takes part in operations besides. */
const nvector_deferral *deferral_seen(const deferral *d);

/** Whether f = f(t, y) is deferred: it is for states that are due themselves. NULL defers nothing. */
bool deferral_take_derivative(deferral *d, double t, N_Vector y, N_Vector f);

/** Whether the present step has been taken as a wave, which leaves no vector with its error, but the sum of squares of
 *  weights and errors by this rank, with this scale. NULL has taken none. */
bool deferral_has_squares(const deferral *d, double scale, array_ops_sum *squares);

/** The scale of these sums from now on, which ranks have in common. NULL has none. */
void deferral_set_scale(deferral *d, double scale);

/** Evaluates the stages of such a step after all, if it is rejected: the vector with its end is written anew, too. */
void deferral_make_up(deferral *d);

#endif
