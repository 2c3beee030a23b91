/* SPDX-License-Identifier: BSD-3-Clause */
/* What the log asks of single nodes and springs, as of those that were stressed most. For nothing else dem_batch looks
 * at the arrays of a model's lattice. */
#ifndef DEM_WHOLE_NODES_H
#define DEM_WHOLE_NODES_H

#include <stdbool.h>

#include <dem/dem.h>

enum { WHOLE_NODES_SIDES = 32 }; /* at a node, two for each of its triangles: 6 of a triangular lattice, 8 of squares */

/* The body of a node, and where it is at rest, m. */
dem_index whole_nodes_body(const dem_model *model, dem_index node);
void whole_nodes_place(double x[2], const dem_model *model, dem_index node);

/* The middle of a spring at rest, m, and its stiffness, N. */
typedef struct whole_spring {
    double middle[2], stiffness;
} whole_spring;

whole_spring whole_nodes_spring(const dem_model *model, dem_index spring);

/* Places of the other ends of the edges of the boundary at a node, m: of those that only one triangle has.
 * \return how many there are */
int whole_nodes_rim(double ends[WHOLE_NODES_SIDES][2], const dem_model *model, dem_index node);

/* Whether a node of its body lies farther along a unit vector than this one does, by more than `slack`, m. */
bool whole_nodes_any_ahead(const dem_model *model, dem_index node, const double along[2], double slack);

#endif
