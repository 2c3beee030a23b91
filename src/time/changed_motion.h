/* SPDX-License-Identifier: BSD-3-Clause */
/* How events inside a step have changed the motion of nodes from the last of them on: a polynomial for each of these
 * nodes, and the state at the end of the step. */
#ifndef DEM_TIME_CHANGED_MOTION_H
#define DEM_TIME_CHANGED_MOTION_H

#include <stdbool.h>

#include "base/vec2.h"

enum { TRAIL_TERMS = 6 };

/** Motion of a node from a time to the end of the step: coefficients of powers of s = (t - from)/(end - from) for its
 *  position, m, and its velocity, m/s: x, y, x', y' of each power side by side, for vector instructions. */
typedef struct trail_motion {
    double from; /* s */
    double c[TRAIL_TERMS][4];
} trail_motion;

/** Change of a state at one node: of position, velocity and acceleration. */
typedef struct trail_jump {
    vec2 x, v, a;
} trail_jump;

/** A node that has been changed, and its end of the step before that. */
typedef struct trail_node {
    dem_index node;
    trail_motion motion; /* from the last event that has changed it */
    vec2 x, v, u, a;
} trail_node;

typedef struct trail {
    dem_index n_nodes;
    double end;       /* s, of the step */
    double *y1, *f1;  /* [4 n] state there and its derivative, the engine's */
    dem_index *place; /* [n_nodes] of a node in the list, -1: its motion has not changed */
    dem_index n, capacity;
    trail_node *list; /* [n] those whose motion has changed, and those that are kept */
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
    return tr->place[node] >= 0;
}

static inline const trail_motion *trail_of(const trail *tr, dem_index node)
{
    return &tr->list[tr->place[node]].motion;
}

/** Makes a motion that of a node from motion->from on. */
dem_status trail_turn(trail *tr, dem_index node, const trail_motion *motion);

/** Keeps the end of the step of a node, which is about to change though its motion has not. */
dem_status trail_keep(trail *tr, dem_index node);

/** Adds a change to the state at the end and its derivative. */
void trail_move_end(trail *tr, dem_index node, const trail_jump *jump);

/** Of a node whose motion has changed, from its last change on. */
vec2 trail_position(const trail *tr, double t, dem_index node);
vec2 trail_velocity(const trail *tr, double t, dem_index node);

/** Position and velocity of a motion at s, 0 to 1: x, y, x', y'. */
static inline void trail_at(const trail_motion *m, double s, double out[4])
{
    for (int q = 0; q < 4; q++) out[q] = m->c[TRAIL_TERMS - 1][q];
    for (int k = TRAIL_TERMS - 2; k >= 0; k--)
        for (int q = 0; q < 4; q++) out[q] = m->c[k][q] + s * out[q];
}

/** The same motion written from a later time on. */
trail_motion trail_later(const trail_motion *m, double from, double end);

/** Adds to a motion the quintic of a change that is `at` its start and grows by `by` until the end. */
void trail_bend(trail_motion *m, double end, const trail_jump *at, const trail_jump *by);

#endif
