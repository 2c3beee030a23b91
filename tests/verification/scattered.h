/* SPDX-License-Identifier: BSD-3-Clause */
/* Shares of a lattice as ranks may have them that are not compact. */
#ifndef DEM_TEST_SCATTERED_H
#define DEM_TEST_SCATTERED_H

#include <math.h>

#include <dem/dem.h>

/** Tiles with this side, dealt out in turn: every domain has many ends and corners.
 *  \param side  0, of a lattice without springs: one tile  \param[out] owner  [n_nodes] */
static inline void scatter(const dem_lattice *l, double side, int n_ranks, int32_t *owner)
{
    for (dem_index i = 0; i < l->n_nodes; i++) {
        owner[i] = 0;
        if (!(side > 0.0)) continue;
        const int column = (int)floor(l->x[2 * i] / side) + 100, row = (int)floor(l->x[2 * i + 1] / side) + 100;
        owner[i] = (column + 3 * row) % n_ranks;
    }
}

#endif
