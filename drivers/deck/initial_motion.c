/* SPDX-License-Identifier: BSD-3-Clause */
#include "initial_motion.h"

#include <stdbool.h>
#include <stddef.h>

void initial_motion_add(initial_motion *motion, const dem_lattice *lattice, dem_index node)
{
    const bool fixed = lattice->flags != NULL && (lattice->flags[node] & DEM_NODE_FIXED);
    motion->mass += lattice->mass[node];
    for (int c = 0; c < 2 && lattice->velocity != NULL && !fixed; c++)
        motion->momentum[c] += lattice->mass[node] * lattice->velocity[2 * node + c];
}

void initial_motion_velocity(double v[2], const initial_motion *motion)
{
    for (int c = 0; c < 2; c++) v[c] = motion->momentum[c] / motion->mass;
}
