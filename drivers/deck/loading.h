/* SPDX-License-Identifier: BSD-3-Clause */
/* What the groups &boundary mean: which nodes, and what is done to them. */
#ifndef DEM_LOADING_H
#define DEM_LOADING_H

#include <dem/dem.h>

#include "placement.h"
#include "schema.h"

/* Faults that can be found without geometry. */
void loading_check_all(const schema_deck *groups, namelist_errors *errors);

/* Takes the defaults of keys away that a group does not use. */
void loading_drop_unused(schema_deck *groups);

/* Finds the nodes and makes the boundaries, in the order of the deck; takes nodes with prescribed motion from contact.
 * Faults are appended to `errors`. Returns false only when memory runs out. Free with loading_free in any case.
 * \param bodies    [number of &body]
 * \param[out] list  [number of &boundary] */
bool loading_build(dem_boundary **list, dem_index *n, dem_lattice *lattice, const placement *bodies,
                   const schema_deck *groups, namelist_errors *errors);

/* The force that group k, a traction on a side of a rectangle, asks for, N: over the side of the true shape, where the
 * lattice may be shorter. False for other groups, and where there is no such group. */
bool loading_asked(double force[2], const schema_deck *groups, size_t k);

void loading_free(dem_boundary *list, dem_index n);

#endif
