/* SPDX-License-Identifier: BSD-3-Clause */
/* The candidates that are close: with these alone whole states are evaluated, until two nodes have moved relative to
 * each other. Like the list of candidates this one is only a filter, and no result depends on it. It also knows how
 * near any node was to any edge, so that most steps need no look for a crossing. */
#ifndef DEM_SURFACE_CONTACT_CLOSE_PAIRS_H
#define DEM_SURFACE_CONTACT_CLOSE_PAIRS_H

#include "surface_contact/pair_rows.h"
#include "surface_contact/surface_ways.h"

typedef struct close_pairs {
    bool chosen;        /* else there are none */
    dem_index n_chosen; /* how often they have been */
    double margin;      /* m */
    surface_ways ways;  /* from the state for which they were chosen */
    surface_ways apart; /* likewise of the nodes of the candidates, which alone may cross an edge */
    dem_index n_linked; /* of the candidates, for which the nodes of `apart` are listed */
    double least;       /* m, there no node was nearer than this to an edge that may touch it */
    dem_index n, capacity;
    contact_pair *list; /* [n] in the order of (node, edge) */
} close_pairs;

/** None. Borrows the surface, and the candidates among which they will be chosen. Free with close_pairs_destroy(). */
void close_pairs_create(close_pairs *out, const contact_surface *of, const pair_rows *candidates);
void close_pairs_destroy(close_pairs *c);

/** Removes all, for another surface in the same place. */
void close_pairs_clear(close_pairs *c);

/** Chooses those of the candidates that are nearer than the thickness and a margin, m, at positions x [n][2]. All pairs
 *  so near must be among them.  \return DEM_ERROR_MEMORY; there are none then */
dem_status close_pairs_choose(close_pairs *c, double margin, const double *x);

/** Whether all pairs nearer than the thickness at positions x are among them. */
bool close_pairs_hold(const close_pairs *c, const double *x);

/** Whether it is certain that no node crosses an edge when all move along straight lines from x0 to x1. */
bool close_pairs_stay_apart(const close_pairs *c, const double *x0, const double *x1);

#endif
