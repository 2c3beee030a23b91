/* SPDX-License-Identifier: BSD-3-Clause */
/* Which springs, or triangles, are at which nodes: so those of a part are found without a look at all of them. */
#ifndef DEM_LATTICE_NODE_ROWS_H
#define DEM_LATTICE_NODE_ROWS_H

#include <dem/dem.h>

/** Numbers have 32 bits, as those of a model, for all springs or triangles of which there are such rows. */
typedef struct node_rows {
    int32_t *row;  /* [n_nodes + 1] slots row[i] .. row[i + 1] - 1 of a node: */
    int32_t *list; /* what has it for an end or a corner, ascending */
} node_rows;

/** Lists n tuples of nodes, whose numbers are known to be valid, each at all of its nodes.
 *  \param node  [n][arity] ends of springs (2), or corners of triangles (3)
 *  \return DEM_ERROR_MEMORY. Free with node_rows_free(), after a failure, too */
dem_status node_rows_create(node_rows *out, const dem_index *node, int arity, dem_index n, dem_index n_nodes);
void node_rows_free(node_rows *r);

#endif
