/* SPDX-License-Identifier: BSD-3-Clause */
/* A rectangle or a disc with voids, in its own coordinates: how deep a point lies in its material, and its lattice. */
#ifndef DEM_SHAPE_H
#define DEM_SHAPE_H

#include <stdbool.h>

#include <dem/dem.h>

#include "pores.h"

/* A rectangle stands on its origin (the middle of its lower edge), as a void about its centre, like a disc. */
typedef struct shape_outline {
    bool disc;
    double size[2], radius; /* m; of a rectangle, of a disc */
} shape_outline;

typedef struct shape_void {
    shape_outline outline;
    double centre[2]; /* m */
} shape_void;

typedef struct shape {
    shape_outline outline;
    double spacing; /* m */
    size_t n_voids;
    shape_void *voids; /* owned */
} shape;

void shape_free(shape *s);

/* Returns false when memory runs out. */
bool shape_add_void(shape *s, const shape_void *v);

/* Signed distance to the nearest edge, of the outline or of a void, m: > 0 in the material. */
double shape_depth(const shape *s, const double x[2]);

/* The same of the outline alone. */
double shape_outline_depth(const shape *s, const double x[2]);

/* Whether one of its voids takes a node of a lattice. */
bool shape_takes(const shape *s, const shape_void *hole, const dem_lattice *lattice);

/* Adds pores as voids; the recipe's box is set here. Failures as of pores_place(); *radius is that of the pore without
 * a place, *n_placed the number of pores before it. */
dem_status shape_add_pores(shape *s, pores_recipe *recipe, size_t *n_placed, double *radius);

/* Triangulation of its outline, without voids. Caller owns *out. */
dem_status shape_mesh(dem_lattice *out, const shape *s);

/* Takes the voids out of it: nodes on the rim of one stay.
 * \return DEM_ERROR_MODEL if nothing is left */
dem_status shape_cut(dem_lattice *lattice, const shape *s);

#endif
