/* SPDX-License-Identifier: BSD-3-Clause */
/* How thick the walls of a body are between its outline and its voids, by the keys of the deck. */
#ifndef DEM_WALLS_H
#define DEM_WALLS_H

#include "schema.h"

/** The thinnest wall of body k, from 0, m: of a ring, between a round void and the outline, between two round voids;
 *  infinite where there is none of these, as for meshes, images and lattice files. Random pores are left out. */
double walls_thinnest(const schema_deck *groups, size_t k);

#endif
