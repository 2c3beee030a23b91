/* SPDX-License-Identifier: BSD-3-Clause */
/* An anchor: the friction of one body on one node, as a spring along the way that the two have slid on each other.
 * Within a step the spring depends on positions alone; how anchors change between steps is in anchor_set.c. */
#ifndef DEM_SURFACE_CONTACT_ANCHOR_H
#define DEM_SURFACE_CONTACT_ANCHOR_H

#include "base/vec2.h"

typedef struct anchor {
    dem_index node, body;  /* the node that is held, and the body that pushes it */
    double stiffness;      /* N/m, of the spring */
    double friction;       /* coefficient of friction of the two bodies */
    double force;          /* N, T after the last step */
    dem_index first, last; /* its patterns, g_0 in parts, are number `first` to `last` - 1 of its set */
} anchor;

/** What the body of an anchor does to its node. */
typedef struct anchor_load {
    double press; /* N, S: the force that presses them together */
    double way;   /* m, by which the node has come along the body since the last step */
} anchor_load;

/** Friction, N: at most the coefficient of friction times S. */
double anchor_force(const anchor *a, const anchor_load *load);

/** Friction over S; 0 where nothing presses. */
double anchor_ratio(const anchor *a, const anchor_load *load);

/** Energy that the spring gives back when it is relieved, J. */
double anchor_energy(const anchor *a, const anchor_load *load);

#endif
