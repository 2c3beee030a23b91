/* SPDX-License-Identifier: BSD-3-Clause */
/* Effective stresses of some nodes near each other, at one state after another. What they depend on is listed once; at
 * each state a spring is evaluated once for all of the nodes. There is room for some nodes only. */
#ifndef DEM_MODEL_STRESS_STENCIL_H
#define DEM_MODEL_STRESS_STENCIL_H

#include "model/element_state.h"
#include "model/model.h"

enum {
    STRESS_STENCIL_NODES = 4,
    STRESS_STENCIL_SPRINGS = 96,
    STRESS_STENCIL_TERMS = 192,
    STRESS_STENCIL_AREAS = 96,
    STRESS_STENCIL_CELLS = 256 /* a power of 2 */
};

/** A spring, and r x f of it. */
typedef struct stress_stencil_spring {
    int32_t number;
    int32_t end[2]; /* nodes */
    double stiffness, rest_length;
    double virial[3]; /* xx, yy, xy, N m: scratch */
} stress_stencil_spring;

/** A share of it in the stress of a node. */
typedef struct stress_stencil_term {
    int place; /* of the spring */
    double share;
} stress_stencil_term;

/** The corners of a triangle that has a guard. */
typedef struct stress_stencil_area {
    int32_t corner[3];
} stress_stencil_area;

/** A node, and how many of the terms are its own and those of the nodes before it. */
typedef struct stress_stencil_node {
    int terms;
    double volume;    /* by which its sum is divided, m^3; 1: its shares are over it already */
    double stress[3]; /* xx, yy, xy, Pa, as it was found last */
} stress_stencil_node;

typedef struct stress_stencil {
    const dem_model *model;
    const element_state *elements;
    int n, n_springs, n_terms, n_areas;
    stress_stencil_node node[STRESS_STENCIL_NODES];       /* [n] */
    stress_stencil_spring spring[STRESS_STENCIL_SPRINGS]; /* [n_springs] each once */
    stress_stencil_term term[STRESS_STENCIL_TERMS];       /* [n_terms] */
    stress_stencil_area area[STRESS_STENCIL_AREAS];       /* [n_areas] */
    uint8_t cells[STRESS_STENCIL_CELLS]; /* 1 + the place of a spring, by the last digits of its number, or in the first
                                          free cell from there on; 0: empty */
} stress_stencil;

/** Borrows both.  \return DEM_ERROR_MEMORY. Free with stress_stencil_destroy() */
dem_status stress_stencil_create(stress_stencil **out, const dem_model *model, const element_state *elements);
void stress_stencil_destroy(stress_stencil *p);

/** Lists n nodes, all of them different, as elements are now. Stresses of the model are prepared.
 *  \return how many of the first ones have been listed: for others there was no room. 0 where triangles resist a change
 *  of their areas otherwise than by guards, or are coupled */
int stress_stencil_list(stress_stencil *p, const dem_index *nodes, dem_index n);

/** Finds the stresses of the nodes that are listed, to the bits of node_stress(), at positions x [n_nodes][2] of
 *  the ends of their springs, and of the corners of triangles.
 *  \return false: a guard may act, and they are not known */
bool stress_stencil_find(stress_stencil *p, const double *x);

#endif
