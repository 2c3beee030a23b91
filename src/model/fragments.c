/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/fragments.h"

#include "base/union_find.h"
#include "elastic/springs.h"

/* Roots are the lowest nodes of fragments. In the last pass those of lower nodes are known already, and no node points
 * above itself. */
dem_index fragments_find(const dem_lattice *lattice, const double *integrity, dem_index *fragment)
{
    dem_index n_fragments = 0;
    union_find_start(fragment, lattice->n_nodes);
    for (dem_index k = 0; k < lattice->n_springs; k++)
        if (integrity == NULL || integrity[k] != 0.0)
            union_find_unite(fragment, lattice->ends[2 * k], lattice->ends[2 * k + 1]);
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        n_fragments += fragment[i] == i;
        fragment[i] = fragment[fragment[i]];
    }
    return n_fragments;
}
