/* SPDX-License-Identifier: BSD-3-Clause */
/* What surfaces of bodies do to each other, for those who look at a run: the force and the pressure at each node, and
 * the pairs that push. Nothing here has a part in the motion. */
#ifndef DEM_SURFACE_CONTACT_SURFACE_LOAD_H
#define DEM_SURFACE_CONTACT_SURFACE_LOAD_H

#include "surface_contact/surface_contact.h"

/** A pair that pushes, as a copy: the lists of the contact may change meanwhile. */
typedef struct surface_load_entry {
    contact_pair pair;
    double ratio; /* of friction to the force, 0: none */
    bool slides;
} surface_load_entry;

/** Pairs that push each other. An empty one is {0}. */
typedef struct surface_load {
    dem_index n, capacity;
    surface_load_entry *pairs; /* [n] in the order of (node, edge) */
} surface_load;

void surface_load_free(surface_load *l);

/** Force on each node, N.  \param[out] force  [n_nodes][2] */
void surface_load_forces(const surface_contact *c, const double *x, double *force);

/** The part of it along the normals of pairs, over the node's length of surface at rest and the thickness of the plate
 *  there, Pa; 0 at nodes that are on no surface.
 *  \param[out] pressure  [n_nodes]
 *  \return DEM_ERROR_MEMORY */
dem_status surface_load_pressures(const surface_contact *c, const double *x, double *pressure);

/** Lists the pairs that push each other at positions x.  \return DEM_ERROR_MEMORY */
dem_status surface_load_list(surface_load *l, const surface_contact *c, const double *x);

/** One of the list, at these positions. */
dem_pair surface_load_pair(const surface_load *l, dem_index k, const contact_surface *of, const double *x);

#endif
