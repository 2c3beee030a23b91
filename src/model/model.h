/* SPDX-License-Identifier: BSD-3-Clause */
/* The compiled, immutable problem: nodes, springs in CSR, triangles, obstacles. */
#ifndef DEM_MODEL_MODEL_H
#define DEM_MODEL_MODEL_H

#include "elastic/layout.h"
#include "elastic/springs.h"
#include "elastic/triangles.h"
#include "model/stress.h"
#include "model/surface.h"
#include "obstacle/obstacle.h"

struct dem_model {
    dem_lattice lattice; /* own copy; flags, body, position and velocity always filled */
    springs springs;
    triangles triangles;
    surface surface; /* edges that may touch */
    stress_map stress;
    layout layout; /* of springs and triangles, for sweeps over all nodes */
    obstacle_set obstacles;
    double *inverse_mass; /* [n_nodes] 1/kg; 0 where the node is fixed */
    dem_index n_contact_nodes;
    dem_index *contact_nodes; /* [n_contact_nodes] nodes that may touch, ascending */
    dem_index n_bodies;
    double spacing;   /* m */
    double omega_max; /* rad/s */
    double mass;      /* kg */
};

#endif
