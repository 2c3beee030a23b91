/* SPDX-License-Identifier: BSD-3-Clause */
/* The candidates for contact between surfaces: all pairs nearer than the contact thickness and a margin. The list holds
 * as long as no two nodes have moved by more than the margin relative to each other. It is only a filter: a pair beyond
 * the thickness adds nothing, so that no result depends on the margin, or on when and why the list was made. */
#ifndef DEM_SURFACE_CONTACT_PAIR_LIST_H
#define DEM_SURFACE_CONTACT_PAIR_LIST_H

#include "surface_contact/cell_search.h"
#include "surface_contact/pair_rows.h"
#include "surface_contact/surface_ways.h"

/** A node and an edge that the search has found. */
typedef struct found_pair {
    dem_index node, edge; /* the node's number among those of the surface */
} found_pair;

typedef struct pair_list {
    const contact_surface *surface;
    bool within_bodies; /* whether a body touches itself */
    double margin;      /* m */
    pair_rows pairs;
    bool made;         /* else there are none */
    dem_index n_made;  /* how often the list has been made */
    surface_ways ways; /* from the state for which it was made */
    dem_index points_capacity, rank_capacity;
    double *points; /* [surface nodes][2] m, among which is searched */
    cell_search cells;
    dem_index n_found, found_capacity;
    found_pair *found, *sorted; /* [n_found] in the order of the search, and of (node, edge) */
    dem_index sorted_capacity;
    dem_index *rank; /* [surface nodes + 1] of the counting sort */
} pair_list;

/** Empty. Borrows the surface. Free with pair_list_destroy(). */
dem_status pair_list_create(pair_list *out, const contact_surface *of, bool within_bodies, double margin);
void pair_list_destroy(pair_list *l);

/** Empties the list, for another surface in the same place. It is made anew at the next call. */
void pair_list_clear(pair_list *l);

/** Makes the list anew if it does not hold for positions x [n][2] with a part of the margin to spare, 0 to 1: all pairs
 *  nearer than the thickness and that part of the margin are in it then.
 *  \return DEM_ERROR_INTEGRATOR if an edge is stretched beyond all measure, DEM_ERROR_MEMORY; the list is empty then,
 *          and is made anew at the next call */
dem_status pair_list_follow(pair_list *l, const double *x, double spare);

/** Counts the pairs of nodes and edges of one body that never touch because they are nearer than the thickness in the
 *  rest shape: those of a notch that is narrower than the surfaces are thick. Called while the list is empty.
 *  \return DEM_ERROR_MEMORY */
dem_status pair_list_count_left_out(pair_list *l, dem_index *out);

#endif
