/* SPDX-License-Identifier: BSD-3-Clause */
/* What each rank knows of a whole lattice beside its own part: a few numbers, extremes and sums over all of it. */
#ifndef DEM_MODEL_WHOLE_SCALES_H
#define DEM_MODEL_WHOLE_SCALES_H

#include <stdbool.h>

#include "lattice/lattice_arrays.h"

typedef struct whole_scales {
    dem_index n[LATTICE_ITEMS]; /* nodes, springs, triangles */
    dem_index n_surface_nodes;  /* that may touch obstacles */
    dem_index n_bodies;
    bool edges_are_springs; /* whether triangles have springs along all of their edges */
    bool is_slack;          /* whether no triangle has an area term or couplings */
    double spacing;         /* m */
    double omega_max;       /* rad/s */
    double mass;            /* kg */
} whole_scales;

#endif
