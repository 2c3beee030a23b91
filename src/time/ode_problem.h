/* SPDX-License-Identifier: BSD-3-Clause */
/* What an integrator integrates: x' = u, v' = a(t, x, v), for a state y = (x, v). u is v but where a motion is
 * prescribed. The integrators know no physics: forces, contacts and boundary conditions are behind these functions,
 * which src/simulation/right_hand_side.c fills in. */
#ifndef DEM_TIME_ODE_PROBLEM_H
#define DEM_TIME_ODE_PROBLEM_H

#include "base/array_ops.h"
#include "base/ranks.h"
#include "base/team.h"
#include "time/dense_output.h"

/** A step of Verlet's method from y0 with derivative f0 to y1 with f1. Of the derivatives only the accelerations are
 *  used, the second halves. */
typedef struct ode_fused_step {
    double t1, h; /* s */
    const double *y0, *f0;
    double *y1, *f1;
} ode_fused_step;

enum { ODE_FUSED_STEPS = 16 }; /* at once, at most */

/** Consecutive rows of a state whose derivative is evaluated while no more is known of the state than the bands beside
 *  it: bands are so long that positions further away have no part in it. x, v and a are where row 0 of the state would
 *  be, but hold, of x, this band and those beside it, and of v and a this band alone. */
typedef struct ode_band {
    double t;             /* s */
    dem_index first, end; /* rows; `end` is behind. What stands behind the nodes belongs to the last band */
    int stage;            /* of the step */
    bool is_own;          /* no other thread has this band as its own, too, but it may evaluate it */
    bool goes_on;         /* the scratch was last used for the band before it, of the same state */
    const double *x, *v;
    double *a; /* filled */
    double *scratch;
} ode_band;

/** The nodes of a problem that ranks integrate together, each some of them and the ghosts of others. */
typedef struct ode_domain {
    const ranks *ranks;
    state_layout whole;          /* of a state with all nodes */
    const unsigned char *is_own; /* [n_nodes] 0: a ghost, whose error is that of another rank */
    bool once_a_step; /* ghosts are integrated here, too, and are good enough for all stages of a step from a state in
                         which they were filled before its derivative was evaluated */
    /** Puts into y what other ranks have of it. Called before every derivative, or where it is `once_a_step` only
     *  before those where steps begin and end, and once more at the end of a step that is written anew, as the scale
     *  of its error has changed; a fused step does so itself. */
    void (*fill_ghosts)(double *y, void *context);
    /** Puts into y and its derivative f what other ranks have of them, before several steps are taken at once. */
    void (*fill_start)(double *y, double *f, void *context);
    /** Takes part, with nothing of its own, in what other ranks sum in a derivative that this rank leaves out after a
     *  failure. */
    void (*take_part)(void *context);
    /** Sets the message of a derivative that has failed. Collective.
     *  \param is_first  whether the last failure of this rank is one of those that a single process would have met
     *  first */
    void (*name_failure)(bool is_first, void *context);
    /** Whether something on this rank asks for the run to stop; and called on all ranks if it is so on any, at the end
     *  of the next attempt at a step. */
    bool (*wants_stop)(void *context);
    void (*stop)(void *context);
} ode_domain;

typedef struct ode_problem {
    state_layout layout;      /* of y; what stands behind the nodes is integrated along, and has no part in the error */
    const ode_domain *domain; /* NULL: all nodes are here */
    bool prescribes;          /* whether some x' are given, so that they are not v */
    /** Derivative of y at t: x' into u, unless it is NULL, and accelerations into a. An integrator that knows v may
     *  leave u out if nothing is prescribed. Returns 0; 1 if something here is not finite, which a shorter step may
     *  mend; or 2 if nothing may. Ranks need not agree. */
    int (*derivative)(double t, const double *y, double *u, double *a, void *context);
    /** Takes the step of all nodes at once, and fills the rates of the quadratures, whose positions and velocities at
     *  its end are given: with the bits of kick, drift, fill_ghosts, derivative and kick in turn. Returns as
     *  `derivative`, or -1 if it cannot from this state, which ranks need not agree about. NULL: it never can. */
    int (*fused_step)(const ode_fused_step *step, void *context);
    /** Takes so many steps at once, each from the end of the one before, to the bits of one after the other, where the
     *  rates of the quadratures are the same at every end: fills these, too. y1 and f1 may be the same arrays at every
     *  other step, and are those of no start.
     *  \return false if it cannot: y1 and f1 are undefined then, and nothing else has changed. NULL: it never can */
    bool (*fused_steps)(const ode_fused_step *steps, int n, void *context);
    dem_index band_rows; /* rows of a band, but the last: a multiple of a cache line; 0: there are no bands */
    size_t band_scratch; /* numbers, 0 at the start */
    /** Begins a step from the present state with so many stages besides it: whether their derivatives may be evaluated
     *  by bands, with x' = v. NULL: never, as without bands. */
    bool (*has_bands)(int n_stages, void *context);
    /** Called when all bands have been evaluated: whether they have the bits of `derivative`, which may depend on more
     *  than a band shows. If not the step is evaluated anew, by that. */
    bool (*bands_hold)(int n_stages, void *context);
    /** The accelerations of a band, as `derivative` has them.  \return a sum that is not finite if one of them is not,
     *  or if they are not to be had by bands */
    double (*band_derivative)(const ode_band *band, void *context);
    /** Called with the state from which a step goes, before root_function() in the step. */
    void (*begin_roots)(double t, const double *y, void *context);
    /** Value at `end` of a step: 1 at its start, and 0 or less after the first event in it. NULL, with begin_roots():
     *  no events end a step. */
    double (*root_function)(const dense_output *step, void *context);
    /** Bound of the highest frequency of the nodes here in units of that about the rest shape, >= 1. NULL: it is 1.
     *  \param is_known  the last call of derivative() was for just this state */
    double (*stiffening)(const double *y, bool is_known, void *context);
    void *context;
    dem_method method;
    double position_error, velocity_error; /* m, m/s: what counts as an error of 1 */
    double max_step;                       /* s */
    double fixed_step;                     /* s; > 0: steps of this length without error control */
    const array_ops *ops;                  /* arithmetic on the states */
    team *team;                            /* whose threads do it; NULL: the caller */
} ode_problem;

/** Where an integrator begins anew. */
typedef struct integrator_start {
    double t, next_step; /* s */
    const double *y;     /* [2 dim n_rows] */
    dem_counts counts;   /* of which steps, rejections, evaluations and retries are read */
} integrator_start;

/** The ranks that integrate the nodes. */
static inline const ranks *ode_problem_ranks(const ode_problem *p)
{
    return p->domain != NULL ? p->domain->ranks : &ranks_alone;
}

/** The layout of a state with all nodes. */
static inline const state_layout *ode_problem_whole(const ode_problem *p)
{
    return p->domain != NULL ? &p->domain->whole : &p->layout;
}

/** Whether node i is integrated here. */
static inline bool ode_problem_is_own(const ode_problem *p, dem_index i)
{
    return p->domain == NULL || p->domain->is_own[i];
}

/** Puts into y what the derivative needs of other ranks. */
static inline void ode_problem_fill_ghosts(const ode_problem *p, double *y)
{
    if (p->domain != NULL) p->domain->fill_ghosts(y, p->context);
}

#endif
