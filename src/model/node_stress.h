/* SPDX-License-Identifier: BSD-3-Clause */
/* Stress of nodes of a body in which something may be broken: that of the triangles that are whole. */
#ifndef DEM_MODEL_NODE_STRESS_H
#define DEM_MODEL_NODE_STRESS_H

#include "model/element_state.h"
#include "model/model.h"

/** Of triangles that have softened. */
typedef enum node_stress_kind {
    NODE_STRESS_CARRIED,  /* what they carry */
    NODE_STRESS_EFFECTIVE /* what they would carry if they had not: a measure of their strain, which drives fracture */
} node_stress_kind;

/** Stress of node i at positions x [n][2], Pa: xx, yy, xy; 0 where no triangle is whole.
 *  \param state  NULL: all elements are whole */
void node_stress(const dem_model *model, const element_state *state, node_stress_kind kind, dem_index i,
                 const double *x, double stress[3]);

/** The own effective stress of a triangle, Pa: those of nodes are means of such by volume, where all springs are held
 *  by triangles.  \param state  prepared */
void node_stress_of_triangle(const dem_model *model, const element_state *state, dem_index triangle, const double *x,
                             double stress[3]);

#endif
