/* SPDX-License-Identifier: BSD-3-Clause */
/* Where a body is weaker than its materials: in the shapes and along the lines of &weakness, and at the edges of
 * inclusions with an `interface`. */
#ifndef DEM_WEAKNESS_H
#define DEM_WEAKNESS_H

#include <dem/dem.h>

#include "schema.h"

/* How many are weakened: of those that break at all. */
typedef struct weakness_counts {
    dem_index n_triangles, n_springs;
} weakness_counts;

typedef struct weakness_report {
    weakness_counts weaknesses, interfaces;
} weakness_report;

/* The body, and its lattice as it is assembled, in the body's own coordinates. */
typedef struct weakness_body {
    const schema_deck *groups;
    size_t k;            /* from 0 */
    double spacing;      /* m */
    size_t n_inclusions; /* of the body */
    const dem_index *of; /* [n_triangles] which inclusion has the triangle, from 1; 0: none */
} weakness_body;

/* Multiplies strengths and critical stretches: several factors of &weakness multiply each other, of several interfaces
 * the smallest counts. A group that touches nothing that can break is a fault, appended to `errors`.
 * \return DEM_OK, DEM_ERROR_MEMORY, or another status after a fault; the lattice is of no use then */
dem_status weakness_apply(weakness_report *out, dem_lattice *lattice, const weakness_body *body,
                          namelist_errors *errors);

#endif
