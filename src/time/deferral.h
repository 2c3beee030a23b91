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

/** Who needs deferred operations. */
typedef struct deferral_owner {
    const ode_problem *problem;
    nvector_space *space;                /* whose operations are deferred from now on */
    deferral_derivative *derivative;     /* of operations carried out one by one, and */
    void (*count)(int n, void *context); /* how many a wave has evaluated */
    void *context;
} deferral_owner;

/** Of steps with so many derivatives before their end. NULL if it does not pay, or without memory. Borrows what the
 *  owner refers to. Free with deferral_free(), after all vectors. */
deferral *deferral_create(const deferral_owner *owner, int n_stages);
void deferral_free(deferral *d);

/** The weights of the norm, the same for all steps. */
void deferral_set_weights(deferral *d, N_Vector weights);

/** Whether f = f(t, y) is deferred: it is for states that are due themselves. NULL defers nothing. */
bool deferral_take_derivative(deferral *d, double t, N_Vector y, N_Vector f);

#endif
