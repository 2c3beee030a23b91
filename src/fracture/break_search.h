/* SPDX-License-Identifier: BSD-3-Clause */
/* When in a step elements are at their limits. Whether those that are asked after together grow at the end of the step
 * is seen of all at once, as neighbours share the stresses of nodes; the others are searched one by one. */
#ifndef DEM_FRACTURE_BREAK_SEARCH_H
#define DEM_FRACTURE_BREAK_SEARCH_H

#include "fracture/due_elements.h"
#include "fracture/stress_cache.h"
#include "model/stress_stencil.h"
#include "time/dense_output.h"

enum { BREAK_SEARCH_SAMPLES = 8 };

/** An element that is searched for a time. */
typedef struct break_candidate {
    dem_index element;
    double margin[BREAK_SEARCH_SAMPLES + 1]; /* 1 - utilisation at the start, and then at samples, of which the last one
                                                is the end of the step; not a number: not known */
} break_candidate;

typedef struct break_search {
    const dem_model *model;
    const element_state *elements;
    const dense_output *step;
    double *state;           /* [2 dim n_rows] scratch, not the search's: positions at the present time */
    stress_cache end;        /* stresses at the end of the step */
    stress_cache within;     /* and at the present time; */
    bool by_neighbours;      /* whether a stress depends on its node and the neighbours of that alone */
    stress_stencil *stencil; /* of the corners of an element that is searched for its time */
    double t;                /* s, the present time; not a number: none */
    uint8_t look;            /* its number */
    uint8_t *placed;         /* [n_nodes] the time at which a node was put into `state` last */
    dem_index n, capacity;
    break_candidate *list; /* [n] those that are searched next */
    due_elements due;      /* those that have been found */
} break_search;

/** At the end of a step of h omega = 0.5 a utilisation may be smaller than in it by (h omega)^2/8, 3 %: an element that
 *  is nearer to its limit, and falls, is searched for a time before. */
#define BREAK_SEARCH_NEAR 0.97

/** Borrows both. It is not known that stresses depend on neighbours alone.
 *  \return DEM_ERROR_MEMORY. Free with break_search_destroy() */
dem_status break_search_create(break_search *out, const dem_model *model, const element_state *elements);
void break_search_destroy(break_search *s);

/** A step in which nothing has been found yet. Borrows both.  \param state  [2 dim n_rows] scratch */
void break_search_begin(break_search *s, const dense_output *step, double *state);

/** The motion or the elements have changed, or others have used the scratch; and so may stresses at the end of the step
 *  have at the n nodes of a list. */
void break_search_renew(break_search *s, const dem_index *list, dem_index n);

/** Effective stress of node i at the end of the step, Pa. */
void break_search_stress(break_search *s, dem_index i, double stress[3]);

/** Whether an element is at or beyond its limit at t. */
bool break_search_is_over(break_search *s, dem_index element, double t);

/** Notes an element if it may be at its limit before the end of the step or at it. Without room for it `due` has a
 *  status. */
void break_search_note(break_search *s, dem_index element);

/** Enters those that have been noted, and are at their limits in the step after `from`, into `due`. */
void break_search_find(break_search *s, double from);

#endif
