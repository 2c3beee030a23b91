/* SPDX-License-Identifier: BSD-3-Clause */
/* What a rank needs of a lattice that is in slabs so as to find its domain: own nodes, common ones, and those in rings
 * about them, with all springs and triangles between these. */
#ifndef DEM_DOMAIN_REGION_H
#define DEM_DOMAIN_REGION_H

#include "domain/slab_rows.h"

typedef struct region {
    dem_lattice lattice;              /* nodes, springs and triangles in the order of the whole */
    dem_index *number[LATTICE_ITEMS]; /* [n] their numbers in the whole, ascending */
    unsigned char *is_common;         /* [nodes] 1: its owner has marked it; NULL: nobody has any marks */
} region;

/** How far it goes. */
typedef struct region_extent {
    /* [nodes of the slab] not 0: an own node that is marked as common to all ranks; what the rim has is not looked at;
     * NULL: there are no marks, on no rank */
    const unsigned char *is_common;
    int common_rings; /* about marked nodes, which are common, too */
    int rings;        /* about own and common nodes */
} region_extent;

/** Gathers it from the slabs, ring by ring. The arrays of the slab of this rank become those of the region, so that the
 *  rows have no lattice afterwards. Collective; on each rank as many rings. Free with region_free(), after a failure,
 *  too.  \return DEM_ERROR_MEMORY */
dem_status region_create(region *out, slab_rows *rows, const region_extent *extent);
void region_free(region *g);

#endif
