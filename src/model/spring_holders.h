/* SPDX-License-Identifier: BSD-3-Clause */
/* Which triangles hold which springs, and what share each of them has. */
#ifndef DEM_MODEL_SPRING_HOLDERS_H
#define DEM_MODEL_SPRING_HOLDERS_H

#include "elastic/springs.h"
#include "lattice/mesh_edges.h"

/** What is needed to go through them. */
typedef struct spring_holders {
    const dem_lattice *lattice;
    const springs *springs;
    mesh_edges sides;
    bool *placed;       /* [n_springs] visited before */
    dem_index n_placed; /* how many are */
    bool counts;        /* nobody asks for shares */
} spring_holders;

/** Borrows both. Free with spring_holders_free().  \return DEM_ERROR_MEMORY */
dem_status spring_holders_create(spring_holders *out, const dem_lattice *lattice, const springs *s);
void spring_holders_free(spring_holders *h);

/** \param share  of the spring's stiffness that the triangle has given; 1 in sum over its triangles */
typedef void spring_holders_visitor(void *context, dem_index spring, dem_index triangle, double share);

/** Visits every pair of a spring and a triangle that holds it. A triangle holds its sides, and in a cell the second
 *  diagonal, too. All triangles of a spring are visited in one go; one that no triangle holds is visited for its first
 *  node and for its second one, with the triangle -1 and the share 0.5. */
void spring_holders_visit(spring_holders *h, spring_holders_visitor *visitor, void *context);

/** The same in less time, with the share 0 for all that triangles hold. */
void spring_holders_count(spring_holders *h, spring_holders_visitor *visitor, void *context);

#endif
