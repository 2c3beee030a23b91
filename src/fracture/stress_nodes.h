/* SPDX-License-Identifier: BSD-3-Clause */
/* The nodes on which the stress of a node depends: those of its triangles, and of all springs that these hold. Whether
 * elements are broken does not matter. They are listed for some nodes, each when it is first asked for: a search asks
 * for the same few nodes again and again. */
#ifndef DEM_FRACTURE_STRESS_NODES_H
#define DEM_FRACTURE_STRESS_NODES_H

#include "model/element_state.h"
#include "model/model.h"

enum { STRESS_NODES_MOST = 14 };

/** Called with the context for a node. */
typedef void stress_nodes_visitor(void *context, dem_index node);

typedef struct stress_nodes_slot {
    int32_t node;                    /* -1: none */
    int32_t n;                       /* > STRESS_NODES_MOST: they are not listed */
    int32_t list[STRESS_NODES_MOST]; /* [n] */
} stress_nodes_slot;

typedef struct stress_nodes {
    const dem_model *model;
    const element_state *elements;
    stress_nodes_slot *slots;
} stress_nodes;

/** Borrows both.  \return DEM_ERROR_MEMORY. Free with stress_nodes_destroy() */
dem_status stress_nodes_create(stress_nodes *out, const dem_model *model, const element_state *elements);
void stress_nodes_destroy(stress_nodes *s);

/** The nodes on which the stress of node i depends, itself among them, each once; good until the next is asked for.
 *  Stresses of the model are prepared. */
const stress_nodes_slot *stress_nodes_find(stress_nodes *s, dem_index i);

/** Visits these nodes, some more than once, of a node with any number of them. */
void stress_nodes_visit(const stress_nodes *s, dem_index i, stress_nodes_visitor *visit, void *context);

#endif
