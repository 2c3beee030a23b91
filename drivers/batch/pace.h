/* SPDX-License-Identifier: BSD-3-Clause */
/* How fast a run may go and goes: its method and step, stability, and (6), which says nothing about that. */
#ifndef DEM_PACE_H
#define DEM_PACE_H

#include <stdio.h>

#include <dem/dem.h>

/** The largest value of (6),  (|v_x| + |v_y|) h/spacing  over nodes and accepted steps. To be set to 0. */
typedef struct pace {
    double largest, t; /* t: s, when */
} pace;

/** The method of a simulation; it exists, so that the method is known. */
dem_method_traits pace_method(const dem_simulation *simulation);

/** What is known before the run: method, step, stability bound, (6) at v_scale. */
void pace_print(FILE *out, double t_end, const dem_simulation *simulation);

/** To be called after every accepted step. */
void pace_follow(pace *p, const dem_simulation *simulation, const dem_state *state);

void pace_print_largest(FILE *out, const pace *p);

#endif
