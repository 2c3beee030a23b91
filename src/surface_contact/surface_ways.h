/* SPDX-License-Identifier: BSD-3-Clause */
/* How far surfaces have moved relative to each other since some state. What they have in common, as the flight of a
 * body, brings nothing nearer, and neither do bodies that are far apart, until they have come closer by what is between
 * them. So a list of what is near holds for as long as nothing has moved far that is near it. */
#ifndef DEM_SURFACE_CONTACT_SURFACE_WAYS_H
#define DEM_SURFACE_CONTACT_SURFACE_WAYS_H

#include "surface_contact/contact_surface.h"
#include "surface_contact/pair_rows.h"
#include "surface_contact/way_box.h"

typedef struct surface_ways {
    const contact_surface *surface;
    const pair_rows *of; /* only the nodes of these pairs; NULL: all */
    int n_groups;        /* one of each body, or of all where they are many; 0: none listed */
    dem_index *begin;    /* [n_groups + 2] the twos of each group */
    box *boxes;          /* [n_groups] of positions or of ways, as they were last looked at */
    dem_index *at;       /* twos by groups: where in x a node is; the next one is behind it */
    double *places;      /* [twos][2][2] m, in the state noted */
    int n_near;          /* pairs of groups that are near each other */
    unsigned char *near; /* [n_near][2] */
    double between;      /* m, other pairs of groups are apart by the reach and this at least */
} surface_ways;

/** Those of a surface, or of its nodes in some pairs, no state noted, are {.surface = it, .of = them}. Free with
 *  surface_ways_destroy(). */
void surface_ways_destroy(surface_ways *w);

/** Notes no state, for another surface or other pairs in the same place. */
void surface_ways_clear(surface_ways *w);

/** Notes the positions x [n][2].
 *  \param reach  m: pairs that have come as near as this are asked about
 *  \return DEM_ERROR_MEMORY */
dem_status surface_ways_note(surface_ways *w, double reach, const double *x);

/** Whether no node and edge have come nearer to each other by more than `most`, m, since the state noted, unless they
 *  are still further apart than the reach less `most`. A coordinate that is not a number is passed over: the forces on
 *  such a node are no numbers either. */
bool surface_ways_within(const surface_ways *w, double most, const double *x);

/** The least of all `most` for which this is so, m. */
double surface_ways_longest(const surface_ways *w, const double *x);

/** By how much values at these nodes, as velocities v [n][2], differ at most: the diagonal of their box. */
double surface_ways_spread(const surface_ways *w, const double *v);

/** The same where x has the twos alone, in their order: at[k] is where two k is. */
bool surface_ways_within_at(const surface_ways *w, double most, const double *x, const dem_index *at);

#endif
