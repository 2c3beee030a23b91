/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts of a body that springs do not connect to its largest one. */
#ifndef DEM_PARTS_H
#define DEM_PARTS_H

#include <dem/dem.h>

enum { PARTS_LISTED = 6 };

typedef struct parts_loose {
    dem_index n;                     /* loose parts */
    dem_index n_nodes[PARTS_LISTED]; /* of the first ones: body by body, by falling size */
    dem_index node;                  /* the lowest of the first one */
} parts_loose;

/* Finds the loose parts of every body of a lattice. Of equally large ones that with the lowest node is the main part.
 * \param[out] kept  [n_nodes] 1 for nodes of the main part of their body, else 0 */
dem_status parts_find(parts_loose *loose, unsigned char *kept, const dem_lattice *lattice);

#endif
