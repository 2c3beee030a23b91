/* SPDX-License-Identifier: BSD-3-Clause */
/* The nodes on which the stress of a node depends: those of its triangles, and of all springs that these hold. Whether
 * elements are broken does not matter. Where all edges of triangles have springs, which most lattices are made of, they
 * are the node and its neighbours. */
#ifndef DEM_FRACTURE_STRESS_NODES_H
#define DEM_FRACTURE_STRESS_NODES_H

#include "model/element_state.h"
#include "model/model.h"

/** Called with the context for a node. */
typedef void stress_nodes_visitor(void *context, dem_index node);

/** Visits the nodes on which the stress of node i depends, itself among them, some more than once. Stresses of the
 *  model are prepared. */
void stress_nodes_visit(const dem_model *model, const element_state *elements, dem_index i, stress_nodes_visitor *visit,
                        void *context);

#endif
