/* SPDX-License-Identifier: BSD-3-Clause */
/* Breaks as they are reported to observers, in the order of time. */
#ifndef DEM_FRACTURE_BREAK_LIST_H
#define DEM_FRACTURE_BREAK_LIST_H

#include <dem/observer.h>

#include "model/element_state.h"
#include "model/model.h"

typedef struct break_list {
    dem_index n, capacity;
    dem_break *list;   /* [n] */
    dem_index *split;  /* [n] the fragment that each has split off, by the numbers of the whole; -1: none
                          (break_list_find_split()) */
    dem_index *parent; /* [n_nodes] its room, fragments_begin(); NULL: nothing has been noted yet */
    dem_index *lowest; /* [n_nodes] likewise */
    dem_index split_capacity;
} break_list;

void break_list_destroy(break_list *b);

/** Appends an element of the lattice that is about to break at positions x [n][2].
 *  \param elements  the state before what breaks at the same instant; NULL: all are whole
 *  \return DEM_ERROR_MEMORY */
dem_status break_list_note(break_list *b, const dem_model *model, const element_state *elements, dem_index element,
                           double t, const double *x);

/** Breaks the k-th in `elements`, and notes the energy that it has there. */
void break_list_break(break_list *b, dem_index k, const dem_model *model, element_state *elements, const double *x);

/** Finds which fragments the breaks from number `from` on have split off. What is noted of these anew, when events are
 *  resolved again, keeps that.
 *  \param elements  the state after all in the list, and before anything else has broken */
void break_list_find_split(break_list *b, dem_index from, const dem_model *model, const element_state *elements);

/** The k-th with what it has split off, by the numbers of the whole lattice, of which the model may have a part. */
dem_break break_list_at(const break_list *b, dem_index k, const dem_model *model);

/** Energy of the springs and triangles of which all nodes are among these, J; of others the part of these nodes. */
double break_list_energy(const dem_index *nodes, dem_index n, const dem_model *model, const element_state *elements,
                         const double *x);

#endif
