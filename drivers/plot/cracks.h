/* SPDX-License-Identifier: BSD-3-Clause */
/* Where cracks are: the sides of whole triangles on whose other side there is a broken one. */
#ifndef DEM_CRACKS_H
#define DEM_CRACKS_H

#include <stdbool.h>

#include <dem/lattice.h>

/** A side that two triangles share. */
typedef struct cracks_side {
    dem_index node[2], triangle[2];
} cracks_side;

typedef struct cracks {
    dem_index n;
    cracks_side *side; /* [n] all sides that two triangles share */
} cracks;

/** False without memory. Free with cracks_free(). */
bool cracks_create(cracks *c, const dem_lattice *lattice);
void cracks_free(cracks *c);

/** Whether a crack runs along a side.  \param broken  [n_triangles] 1 where one is */
bool cracks_open(const cracks_side *side, const unsigned char *broken);

#endif
