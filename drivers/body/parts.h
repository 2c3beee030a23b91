/* SPDX-License-Identifier: BSD-3-Clause */
/* How a body hangs together: parts apart from its largest one, and hinges. */
#ifndef DEM_PARTS_H
#define DEM_PARTS_H

#include <dem/dem.h>

enum { PARTS_LISTED = 6, PARTS_LIST = 480 /* bytes of a list of as many */ };

typedef struct parts_loose {
    dem_index n;                  /* loose parts */
    dem_index size[PARTS_LISTED]; /* of the first ones: body by body, by falling size */
    double x[PARTS_LISTED][2];    /* m, where they have their lowest node */
} parts_loose;

/* Finds the loose parts of every body of a lattice: of nodes that springs connect, in a lattice without springs of
 * triangles that share edges. Of equally large ones that with the lowest member is the main part.
 * \param[out] kept  [n_nodes], without springs [n_triangles]: 1 for members of the main part of their body, else 0 */
dem_status parts_find(parts_loose *loose, bool *kept, const dem_lattice *lattice);

/* Prints "9 nodes at (0, 1), 3 at (2, 0)": the first ones, "..." behind them if there are more.
 * \param[out] text  [PARTS_LIST]
 * \param what       "node" or "triangle" */
void parts_print(char *text, const parts_loose *loose, const char *what);

/* Nodes in which triangles meet that share no edge, so that they can turn against each other. */
typedef struct parts_hinges {
    dem_index n;
    double x[2]; /* m, of the first one */
} parts_hinges;

dem_status parts_find_hinges(parts_hinges *hinges, const dem_lattice *lattice);

#endif
