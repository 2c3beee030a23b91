/* SPDX-License-Identifier: BSD-3-Clause */
/* Marks are the number of the ring and one. */
#include "domain/common_nodes.h"

#include "domain/adjacency.h"

static void mark_next(unsigned char *mark, int ring, const dem_index pair[2])
{
    for (int e = 0; e < 2; e++)
        if (mark[pair[e]] == ring + 1 && mark[pair[1 - e]] == 0) mark[pair[1 - e]] = (unsigned char)(ring + 2);
}

void common_nodes_add_rings(const dem_lattice *lattice, int n_rings, unsigned char *is_common)
{
    dem_index pair[2];
    for (int ring = 0; ring < n_rings; ring++)
        for (dem_index k = 0; k < adjacency_pairs(lattice); k++) {
            adjacency_pair(lattice, k, pair);
            mark_next(is_common, ring, pair);
        }
}
