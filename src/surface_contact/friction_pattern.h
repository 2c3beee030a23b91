/* SPDX-License-Identifier: BSD-3-Clause */
/* The pattern of friction: how the friction of a pair spreads over its nodes. What a surface pushes a node with, N, and
 * friction, T, have the same way to the nodes: each force of the pair is turned by a right angle and scaled by T/N. */
#ifndef DEM_SURFACE_CONTACT_FRICTION_PATTERN_H
#define DEM_SURFACE_CONTACT_FRICTION_PATTERN_H

#include "surface_contact/contact_pair.h"

typedef struct friction_pattern {
    dem_index nodes[CONTACT_PAIR_NODES];
    vec2 at[CONTACT_PAIR_NODES]; /* N at these nodes; friction is -T/N times this */
} friction_pattern;

/** The pattern of a pair that pushes, at positions x. Its vectors sum up to 0, and so do their moments. */
friction_pattern friction_pattern_make(const contact_push *push, const double *x);

/** Every vector times a factor. */
friction_pattern friction_pattern_scale(double factor, const friction_pattern *p);

/** The sum of its vectors times those of its nodes in v [n][2]. */
double friction_pattern_dot(const friction_pattern *p, const double *v);

/** The sum of its vectors times the ways of its nodes from x0 to x. */
double friction_pattern_way(const friction_pattern *p, const double *x0, const double *x);

#endif
