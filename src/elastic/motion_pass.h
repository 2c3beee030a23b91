/* SPDX-License-Identifier: BSD-3-Clause */
/* Passes over nodes, eight at a time, that measure how they move: kinetic energy, weight, momenta. Nodes are in their
 * own order, not in that of a layout. Every instruction set gives the same bits. */
#ifndef DEM_ELASTIC_MOTION_PASS_H
#define DEM_ELASTIC_MOTION_PASS_H

#include "base/exact_sum.h"
#include "base/vec2.h"

typedef struct motion_pass {
    const double *mass;  /* [n_nodes] kg */
    const double *x, *v; /* [n_nodes][2] */
    vec2 gravity;        /* m/s^2 */
} motion_pass;

/** Sums over nodes. */
typedef struct motion_sums {
    exact_sum kinetic, weight;       /* J: m v^2/2, -m g.x */
    exact_sum place[2], momentum[2]; /* m x, m v */
    exact_sum spin;                  /* m (x - x_c) x (v - v_c), which takes a pass of its own */
} motion_sums;

/** Adds the nodes `first` to `last` - 1 to all but the spin. */
typedef void motion_pass_function(const motion_pass *p, dem_index first, dem_index last, motion_sums *out);

motion_pass_function motion_pass_portable, motion_pass_avx2, motion_pass_avx512;

/** Adds to the spin alone.  \param mean  x_c, v_c */
typedef void motion_spin_function(const motion_pass *p, dem_index first, dem_index last, const vec2 mean[2],
                                  motion_sums *out);

motion_spin_function motion_pass_spin_portable, motion_pass_spin_avx2, motion_pass_spin_avx512;

#endif
