/* SPDX-License-Identifier: BSD-3-Clause */
/* How events inside a step change the motion of nodes: polynomials of these nodes, each from an event to the end of
 * the step, and the state there. */
#ifndef DEM_TRAIL_H
#define DEM_TRAIL_H

#include <stdbool.h>

#include "vec2.h"

enum { TRAIL_TERMS = 6 };

/** Motion of a node from a time to the end of the step: coefficients of powers of s = (t - from)/(end - from). */
typedef struct trail_motion {
    double from;              /* s */
    double x[2][TRAIL_TERMS]; /* m */
    double v[2][TRAIL_TERMS]; /* m/s */
} trail_motion;

/** Change of a state at one node: of position, velocity and acceleration. */
typedef struct trail_jump {
    vec2 x, v, a;
} trail_jump;

typedef struct trail_piece {
    trail_motion motion;
    dem_index before; /* the piece until motion.from, -1: none */
} trail_piece;

/** A node's end of the step before any event changed it. */
typedef struct trail_end {
    dem_index node;
    vec2 x, v, u, a;
} trail_end;

typedef struct trail {
    dem_index n_nodes;
    double end;      /* s, of the step */
    double *y1, *f1; /* [4 n] state there and its derivative, the engine's */
    dem_index *last; /* [n_nodes] piece that goes to the end, -1: none */
    dem_index n, capacity;
    trail_piece *pieces; /* [n] */
    dem_index n_ends, end_capacity;
    trail_end *ends; /* [n_ends] one for each node that has pieces */
} trail;

/** Free with trail_destroy(). */
dem_status trail_create(trail *out, dem_index n_nodes);
void trail_destroy(trail *tr);

/** Begins a step that ends in y1, with derivative f1: nothing has changed. */
void trail_start(trail *tr, double end, double *y1, double *f1);

/** Takes all changes back. */
void trail_undo(trail *tr);

static inline bool trail_has(const trail *tr, dem_index node)
{
    return tr->last[node] >= 0;
}

/** The motion of a node that goes to the end: its last piece. */
const trail_motion *trail_last(const trail *tr, dem_index node);

/** Makes a motion that of a node from motion->from on; the first of a node is that of the whole step. */
dem_status trail_add(trail *tr, dem_index node, const trail_motion *motion);

/** Adds a change to the state at the end and its derivative. */
void trail_move_end(trail *tr, dem_index node, const trail_jump *jump);

vec2 trail_position(const trail *tr, double t, dem_index node);
vec2 trail_velocity(const trail *tr, double t, dem_index node);

/** The same motion written from a later time on. */
trail_motion trail_later(const trail_motion *m, double from, double end);

/** Adds to a motion the quintic of a change that is `at` its start and grows by `by` until the end. */
void trail_bend(trail_motion *m, double end, const trail_jump *at, const trail_jump *by);

#endif
