/* SPDX-License-Identifier: BSD-3-Clause */
/* Effective stresses of nodes at one state, each computed when it is asked for. There is room for those of some nodes
 * only: looks go from node to neighbour, and what has been dropped is computed again, to the same bits. */
#ifndef DEM_FRACTURE_STRESS_CACHE_H
#define DEM_FRACTURE_STRESS_CACHE_H

#include <stdint.h>

#include "model/node_stress.h"

typedef struct stress_cache_slot {
    int32_t node;
    uint32_t number;  /* of the state; 0: none */
    double stress[3]; /* Pa */
} stress_cache_slot;

typedef struct stress_cache {
    const dem_model *model;
    const element_state *elements;
    const double *x; /* [n][2] the state */
    uint32_t number; /* its number */
    dem_index n;     /* a power of 2 */
    stress_cache_slot *slots;
} stress_cache;

/** Borrows both.  \param room  for so many nodes at least, if their numbers follow each other
 *  \return DEM_ERROR_MEMORY. Free with stress_cache_destroy() */
dem_status stress_cache_create(stress_cache *out, const dem_model *model, const element_state *elements,
                               dem_index room);
void stress_cache_destroy(stress_cache *c);

/** From now on stresses are those at positions x [n][2], which it borrows, and at no earlier ones. */
void stress_cache_begin(stress_cache *c, const double *x);

/** Whether it has the stress of node i. */
bool stress_cache_has(const stress_cache *c, dem_index i);

/** Effective stress of node i, Pa: xx, yy, xy. */
void stress_cache_find(stress_cache *c, dem_index i, double stress[3]);

/** Node i, or what its stress depends on, has changed. */
void stress_cache_forget(stress_cache *c, dem_index i);

#endif
