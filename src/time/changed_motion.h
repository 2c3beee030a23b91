/* SPDX-License-Identifier: BSD-3-Clause */
/* How events inside a step have changed the motion of nodes: for each of these nodes a polynomial, from the last event
 * that has changed it to the end of the step, and what the end of the step was before. Quadratures are changed by
 * events everywhere: what these add to a row of them is kept one by one, and summed exactly when it is asked for, so
 * that the order of events does not matter. All changes can be taken back. */
#ifndef DEM_TIME_CHANGED_MOTION_H
#define DEM_TIME_CHANGED_MOTION_H

#include <stdbool.h>

#include "base/row_pair.h"
#include "base/state.h"

enum { MOTION_TERMS = 6, MOTION_SLOPES = MOTION_TERMS - 1, MOTION_PARABOLA = 3 };

/** Motion of a node from a time to the end of the step: coefficients of powers of s = (t - from)/(end - from). A
 *  velocity has one less than a position, whose derivative it is; where both are parabolas of their own,
 *  MOTION_PARABOLA of each are written and read. */
typedef struct motion_polynomial {
    double from; /* s */
    int dim;
    bool parabolic;
    double x[MOTION_TERMS][STATE_DIM_MOST], v[MOTION_SLOPES][STATE_DIM_MOST]; /* [][dim] m, m/s */
} motion_polynomial;

/** Change of a state at one node: of position, velocity and acceleration. Two components of each are written and read
 *  together: without the alignment compilers write across the ends of rows, and to read a pair then has to wait. */
typedef struct motion_change {
    _Alignas(16) double x[STATE_DIM_MOST];
    _Alignas(16) double v[STATE_DIM_MOST];
    _Alignas(16) double a[STATE_DIM_MOST];
} motion_change;

/** A node, or a row of quadratures, that has been changed, and its end of the step before that. */
typedef struct changed_motion_node {
    dem_index node;
    double x[STATE_DIM_MOST], v[STATE_DIM_MOST], u[STATE_DIM_MOST], a[STATE_DIM_MOST];
} changed_motion_node;

/** The motion of a node from the last event on that has changed it. */
typedef struct changed_motion_interpolant {
    motion_polynomial motion;
    double now[STATE_DIM_MOST]; /* its acceleration by forces in the state at the end, as it is now, */
    bool is_known;              /* if they have been evaluated there */
} changed_motion_interpolant;

/** What an event adds to a row of quadratures, from its time on and in the end. */
typedef struct changed_motion_part {
    dem_index row;
    motion_polynomial motion;
    motion_change end;
} changed_motion_part;

typedef struct changed_motion {
    state_layout layout;
    double end;      /* s, of the step */
    double *y1, *f1; /* state there and its derivative, the integrator's */
    int32_t *place; /* [n_rows] of a node among the interpolants, of a quadrature in the list, -1: it has not changed */
    dem_index n, capacity;
    changed_motion_node *list; /* [n] those whose motion has changed, and those that are kept */
    dem_index n_interpolants, interpolant_capacity;
    changed_motion_interpolant *interpolants; /* [n_interpolants] apart, as those that are kept have none */
    dem_index n_parts, part_capacity;
    changed_motion_part *parts; /* [n_parts] */
} changed_motion;

/** Free with changed_motion_destroy(). */
dem_status changed_motion_create(changed_motion *out, const state_layout *layout);
void changed_motion_destroy(changed_motion *tr);

/** Begins a step that ends in y1, with derivative f1: nothing has changed. */
void changed_motion_start(changed_motion *tr, double end, double *y1, double *f1);

/** Takes all changes back. */
void changed_motion_undo(changed_motion *tr);

static inline bool changed_motion_has(const changed_motion *tr, dem_index node)
{
    return tr->place[node] >= 0;
}

static inline const motion_polynomial *changed_motion_of(const changed_motion *tr, dem_index node)
{
    return &tr->interpolants[tr->place[node]].motion;
}

/** Where the motion of a node from an event on is to be written, at once; it may have had one before. */
dem_status changed_motion_take(changed_motion *tr, dem_index node, motion_polynomial **out);

/** Copies the end of the step of a node for changed_motion_undo(), before the caller changes it there without changing
 *  the motion inside the step. */
dem_status changed_motion_keep(changed_motion *tr, dem_index node);

/** Notes the acceleration of a node whose motion has changed, in the state that the end of the step has now; or that it
 *  is another one now, of any node. */
static inline void changed_motion_know(changed_motion *tr, dem_index node, const double *a)
{
    changed_motion_interpolant *interpolant = &tr->interpolants[tr->place[node]];
    interpolant->is_known = true;
    state_copy_row(&tr->layout, interpolant->now, a);
}

static inline void changed_motion_doubt(changed_motion *tr, dem_index node)
{
    if (tr->place[node] >= 0) tr->interpolants[tr->place[node]].is_known = false;
}

/** What has been noted; NULL: nothing. */
static inline const double *changed_motion_known(const changed_motion *tr, dem_index node)
{
    const dem_index place = tr->place[node];
    return place >= 0 && tr->interpolants[place].is_known ? tr->interpolants[place].now : NULL;
}

/** Adds a change to the state at the end and its derivative. */
void changed_motion_move_end(changed_motion *tr, dem_index node, const motion_change *jump);

/** Adds to the motion of a row of quadratures. Its end changes with changed_motion_end_rows(). */
dem_status changed_motion_add(changed_motion *tr, const changed_motion_part *part);

/** Adds all that has been added to a row to its position and velocity [dim] at t, either of which may be NULL; t is not
 *  before the last event. */
void changed_motion_row_at(const changed_motion *tr, double t, dem_index row, double *x, double *v);

/** Adds it to the state at the end and its derivative, when there are no more events. */
void changed_motion_end_rows(changed_motion *tr);

/** Position and velocity [dim] at t of a node whose motion has changed; t is not before its last change. */
void changed_motion_position(const changed_motion *tr, double t, dem_index node, double *out);
void changed_motion_velocity(const changed_motion *tr, double t, dem_index node, double *out);

/** Sums of n coefficients times powers of s. */
INLINE void motion_terms_at(const double (*c)[STATE_DIM_MOST], int n, int dim, double s, double *out)
{
    for (int d = 0; d < dim; d += 2) {
        row_pair at = row_pair_at(c[n - 1], d);
        for (int k = n - 2; k >= 0; k--) at = row_pair_at(c[k], d) + s * at;
        row_pair_put(out, d, at);
    }
}

/** Position and velocity [dim] of a motion at s, 0 to 1. */
static inline void motion_polynomial_position(const motion_polynomial *m, double s, double *x)
{
    if (m->parabolic)
        motion_terms_at(m->x, MOTION_PARABOLA, m->dim, s, x);
    else
        motion_terms_at(m->x, MOTION_TERMS, m->dim, s, x);
}

static inline void motion_polynomial_velocity(const motion_polynomial *m, double s, double *v)
{
    if (m->parabolic)
        motion_terms_at(m->v, MOTION_PARABOLA, m->dim, s, v);
    else
        motion_terms_at(m->v, MOTION_SLOPES, m->dim, s, v);
}

INLINE void motion_terms_copy(double (*to)[STATE_DIM_MOST], const double (*from)[STATE_DIM_MOST], int n, int dim)
{
    for (int d = 0; d < dim; d += 2)
        for (int k = 0; k < n; k++) row_pair_put(to[k], d, row_pair_at(from[k], d));
}

/** Copies the components and terms that there are. */
static inline void motion_polynomial_copy(motion_polynomial *to, const motion_polynomial *from)
{
    to->from = from->from;
    to->dim = from->dim;
    to->parabolic = from->parabolic;
    if (from->parabolic) {
        motion_terms_copy(to->x, from->x, MOTION_PARABOLA, from->dim);
        motion_terms_copy(to->v, from->v, MOTION_PARABOLA, from->dim);
    } else {
        motion_terms_copy(to->x, from->x, MOTION_TERMS, from->dim);
        motion_terms_copy(to->v, from->v, MOTION_SLOPES, from->dim);
    }
}

/** Writes the same motion from a later time on. */
void motion_polynomial_restart(motion_polynomial *m, double from, double end);

/** Writes the sum of a motion and the quintic of a change that is `at` its start and grows by `by` until the end into
 *  `to`, which may be the motion. */
void motion_polynomial_add(const motion_polynomial *m, double end, const motion_change *at, const motion_change *by,
                           motion_polynomial *to);

/** Adds the parabolas of such a change instead, the way of a dense output that is parabolic: positions through x, v and
 *  the x at the end, velocities through v, a and the v at the end. */
void motion_polynomial_add_parabolas(const motion_polynomial *m, double end, const motion_change *at,
                                     const motion_change *by, motion_polynomial *to);

#endif
