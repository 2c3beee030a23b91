/* SPDX-License-Identifier: BSD-3-Clause */
/* Stress of nodes from springs and triangles. A triangle's stress is what its share of its springs' r x f, and its own
 * energy, make of its rest volume; a node's stress is the mean of its triangles' by volume. Where the strain is uniform
 * it is therefore exact on boundaries, too. docs/method.md has the formulas. */
#ifndef DEM_MODEL_STRESS_H
#define DEM_MODEL_STRESS_H

#include "base/on_demand.h"
#include "elastic/couplings.h"
#include "elastic/springs.h"
#include "elastic/triangles.h"

typedef struct stress_rows stress_rows;

/** What makes rows and volumes in another way than from all of a lattice, and is ended with them. */
typedef struct stress_maker {
    void *self;
    dem_status (*make)(void *self, stress_rows *rows); /* volume, row, spring and share, to be freed with free() */
    void (*end)(void *self);
} stress_maker;

/** Which springs make up the stress of which node. Rows and volumes are made when they are first asked for. */
struct stress_rows {
    on_demand made, weighed;    /* rows, for which there have to be volumes; volumes */
    stress_maker maker;         /* of both; without `make` there is none, but */
    const dem_lattice *lattice; /* borrowed, as springs are */
    const springs *springs;
    double *volume;  /* [n_nodes] m^3, a third of the triangles at rest; 0 of a node in no triangle, without stress */
    int32_t *row;    /* [n_nodes + 1] */
    int32_t *spring; /* slots row[i] .. row[i + 1] - 1: springs of the lattice */
    double *share;   /* of their r x f, over the node's volume, 1/m^3 */
};

typedef struct stress_map {
    stress_rows *rows;
    const couplings *couplings; /* borrowed */
} stress_map;

/** Borrows what it is given. Free with stress_free(). */
dem_status stress_compile(stress_map *out, const dem_lattice *lattice, const springs *s, const couplings *c);
void stress_free(stress_map *map);

/** A map whose rows are made in another way.  \return DEM_ERROR_MEMORY; then the maker is not ended. Free with
 *  stress_free(). */
dem_status stress_create(stress_map *out, const stress_maker *maker, const couplings *c);

/** Makes the rows unless they are there; from several threads at once, too.  \return DEM_ERROR_MEMORY;
 *  DEM_ERROR_MODEL for 2^31 shares */
dem_status stress_prepare(const stress_map *map);

/** Frees the rows until they are asked for again; while nobody else looks at them. Not those of a maker. */
void stress_forget(const stress_map *map);

/** The volumes alone, made likewise; NULL without memory. */
const double *stress_volumes(const stress_map *map);

/** Stress of node i at positions x [n][2], Pa: xx, yy, xy, by a map that is prepared.
 *  \param lattice, t  from which the map was compiled */
void stress_of_node(const stress_map *map, const dem_lattice *lattice, const triangles *t, dem_index i, const double *x,
                    double stress[3]);

/** The square of the von Mises stress of plane stress, Pa^2. */
static inline double stress_square(const double stress[3])
{
    const double xx = stress[0], yy = stress[1], xy = stress[2];
    return xx * xx - xx * yy + yy * yy + 3.0 * xy * xy;
}

#endif
