/* SPDX-License-Identifier: BSD-3-Clause */
/* Breaks as they are reported to observers, in the order of time. */
#ifndef DEM_FRACTURE_BREAK_LIST_H
#define DEM_FRACTURE_BREAK_LIST_H

#include <dem/observer.h>

#include "model/element_state.h"
#include "model/model.h"

typedef struct break_list {
    dem_index n, capacity;
    dem_break *list; /* [n] */
} break_list;

void break_list_destroy(break_list *b);

/** Appends an element of the lattice that is about to break at positions x [n][2].
 *  \param elements  the state before what breaks at the same instant; NULL: all are whole
 *  \return DEM_ERROR_MEMORY */
dem_status break_list_note(break_list *b, const dem_model *model, const element_state *elements, dem_index element,
                           double t, const double *x);

/** Breaks the k-th in `elements`, and notes the energy that it has there. */
void break_list_break(break_list *b, dem_index k, const dem_model *model, element_state *elements, const double *x);

/** Energy of the springs and triangles of which all nodes are among these, J; of others the part of these nodes. */
double break_list_energy(const dem_index *nodes, dem_index n, const dem_model *model, const element_state *elements,
                         const double *x);

#endif
