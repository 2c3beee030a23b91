/* SPDX-License-Identifier: BSD-3-Clause */
/* A slab that ranks make a model of: checked, with what the absence of arrays stands for. */
#ifndef DEM_MODEL_SLAB_LATTICE_H
#define DEM_MODEL_SLAB_LATTICE_H

#include <dem/dem.h>

typedef struct slab_lattice {
    dem_slab slab; /* whose flags, bodies and velocities are those below */
    unsigned char *flags;
    int32_t *body;
    double *velocity;
} slab_lattice;

/** Reads a slab, whose other arrays are borrowed. Free with slab_lattice_free(), after a failure, too.
 *  \return DEM_ERROR_MODEL for what cannot move, for nodes without springs, and for what slabs cannot be of: several
 *          bodies, rigid ones, those that may break, those without triangles; DEM_ERROR_ARGUMENT, DEM_ERROR_MEMORY */
dem_status slab_lattice_create(slab_lattice *out, const dem_slab *slab);
void slab_lattice_free(slab_lattice *s);

#endif
