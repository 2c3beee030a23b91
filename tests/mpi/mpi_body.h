/* SPDX-License-Identifier: BSD-3-Clause */
/* A body for ranks: a disc of jittered triangles that is sheared, and may be held at its left and pulled. */
#ifndef DEM_TEST_MPI_BODY_H
#define DEM_TEST_MPI_BODY_H

#include <math.h>
#include <stdlib.h>

#include "rank_test.h"

static inline dem_lattice mpi_body_make(double speed)
{
    const dem_material solid = {.struct_size = sizeof solid,
                                .youngs_modulus = 1e7,
                                .poissons_ratio = 0.3,
                                .density = 1050.0,
                                .thickness = 1.0,
                                .guard = 0.02,
                                .springs = DEM_SPRINGS_COUPLED};
    dem_lattice l = dem_lattice_empty();
    INSIST(dem_lattice_disc(&l, 0.04, 4e-3) == DEM_OK && dem_lattice_jitter(&l, 8e-4, 7) == DEM_OK &&
           dem_lattice_assemble(&l, &solid) == DEM_OK);
    if (l.velocity == NULL) l.velocity = calloc(2 * (size_t)l.n_nodes, sizeof *l.velocity);
    INSIST(l.velocity != NULL);
    for (dem_index i = 0; i < l.n_nodes; i++) {
        l.velocity[2 * i] = speed * sin(60.0 * l.x[2 * i + 1]);
        l.velocity[2 * i + 1] = speed * cos(40.0 * l.x[2 * i]);
    }
    return l;
}

/* Nodes at the left end, to be freed. */
static inline dem_index *mpi_body_left(const dem_lattice *l, dem_index *n)
{
    dem_index *list = malloc((size_t)l->n_nodes * sizeof *list);
    INSIST(list != NULL);
    *n = 0;
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->x[2 * i] < -0.03) list[(*n)++] = i;
    return list;
}

#endif
