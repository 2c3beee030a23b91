/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbering of nodes such that neighbours are near in memory. */
#ifndef DEM_ELASTIC_RENUMBER_H
#define DEM_ELASTIC_RENUMBER_H

#include <stdbool.h>
#include <stdint.h>

#include "elastic/springs.h"

/** The largest difference between the numbers of two neighbours.
 *  \param place  [n_nodes] number of each node; NULL: its own */
dem_index renumber_span(const springs *s, const int32_t *place);

/** Whether nodes are numbered along rows: most springs have one beside them, between the nodes before theirs. */
bool renumber_is_by_rows(const springs *s);

/** Numbers nodes by their distance from one at the rim (Cuthill and McKee), connected parts one after the other.
 *  \param[out] order  [n_nodes] the node at each place
 *  \param[out] place  [n_nodes] the place of each node */
void renumber_by_distance(const springs *s, int32_t *order, int32_t *place);

#endif
