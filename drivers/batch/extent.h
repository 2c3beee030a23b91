/* SPDX-License-Identifier: BSD-3-Clause */
/* How large bodies are at rest. */
#ifndef DEM_EXTENT_H
#define DEM_EXTENT_H

#include <math.h>

#include <dem/lattice.h>

/** The diagonal of the box of all nodes, m: no body is longer. */
static inline double extent_diagonal(const dem_lattice *l)
{
    double low[2] = {l->x[0], l->x[1]}, high[2] = {l->x[0], l->x[1]};
    for (dem_index k = 2; k < 2 * l->n_nodes; k++) {
        low[k % 2] = fmin(low[k % 2], l->x[k]);
        high[k % 2] = fmax(high[k % 2], l->x[k]);
    }
    return hypot(high[0] - low[0], high[1] - low[1]);
}

#endif
