/* SPDX-License-Identifier: BSD-3-Clause */
/* Elements that break or soften at one instant, and their nodes. A triangle takes the other triangle of its cell along,
 * and a spring the triangles that hold it: a spring breaks alone only if none does. */
#ifndef DEM_FRACTURE_FAILING_ELEMENTS_H
#define DEM_FRACTURE_FAILING_ELEMENTS_H

#include "fracture/break_list.h"

typedef struct failing_elements {
    dem_index n, capacity;
    dem_index *list; /* [n] elements, ascending when complete */
    dem_index n_forced, forced_capacity;
    dem_index *forced; /* [n_forced] triangles that a spring takes along, ascending when complete: they do not soften */
    dem_index n_breaking, breaks_capacity;
    bool *breaks; /* [n] whether each breaks; others soften */
    dem_index n_nodes, node_capacity;
    dem_index *nodes;  /* [n_nodes] theirs, ascending */
    dem_status status; /* DEM_ERROR_MEMORY: the lists are not complete */
} failing_elements;

void failing_elements_destroy(failing_elements *f);
void failing_elements_clear(failing_elements *f);

/** Adds an element that is whole, with those that break with it. */
void failing_elements_add(failing_elements *f, const element_state *s, dem_index element);

/** Sorts the elements, finds their nodes, and which of them break. */
void failing_elements_complete(failing_elements *f, const element_state *s);

/** Breaks or softens them.
 *  \param noted  ends with those that break, and gets their energies
 *  \return the energy that all lose at positions x [n][2], J */
double failing_elements_fail(const failing_elements *f, const dem_model *model, element_state *s, const double *x,
                             break_list *noted);

#endif
