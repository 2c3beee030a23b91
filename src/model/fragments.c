/* SPDX-License-Identifier: BSD-3-Clause */
/* The pieces are found by union and find in the array of the answer: fragment[i] is a node of the piece of i that is
 * not above i, and i itself at the lowest one. As a lower node never gets a higher one, the last pass finds the
 * number of the lower node settled, and the answer depends on what is broken alone, not on the order of springs. */
#include "model/fragments.h"

#include "elastic/springs.h"

/* The lowest node known so far of the piece of i; every other node on the way there is skipped next time. */
static dem_index lowest(dem_index *fragment, dem_index i)
{
    while (fragment[i] != i) {
        fragment[i] = fragment[fragment[i]];
        i = fragment[i];
    }
    return i;
}

static void unite(dem_index *fragment, dem_index i, dem_index j)
{
    const dem_index p = lowest(fragment, i), q = lowest(fragment, j);
    if (p < q)
        fragment[q] = p;
    else
        fragment[p] = q;
}

dem_index fragments_find(const dem_lattice *lattice, const double *integrity, dem_index *fragment)
{
    dem_index n_fragments = 0;
    for (dem_index i = 0; i < lattice->n_nodes; i++) fragment[i] = i;
    for (dem_index k = 0; k < lattice->n_springs; k++)
        if (!springs_is_broken(integrity, k)) unite(fragment, lattice->ends[2 * k], lattice->ends[2 * k + 1]);
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        n_fragments += fragment[i] == i;
        fragment[i] = fragment[fragment[i]];
    }
    return n_fragments;
}
