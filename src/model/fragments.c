/* SPDX-License-Identifier: BSD-3-Clause */
/* The pieces that springs join which are not broken, and numbers of the whole of them. */
#include "model/fragments.h"

#include <stdlib.h>

#include "base/status.h"
#include "base/union_find.h"
#include "elastic/springs.h"
#include "model/crack_energy.h"

/* ---- which nodes belong together ---- */

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

/* ---- how much is broken, and into what ---- */

static int compare(const void *a, const void *b)
{
    const double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

/* From the masses of fragments, each at its lowest node, and 0 at the others. They are sorted, so that the sums have
 * the same bits however nodes are numbered. */
static void weigh(dem_fracture *out, double *mass, dem_index n)
{
    double sum = 0.0, part = 0.0;
    qsort(mass, (size_t)n, sizeof *mass, compare);
    for (dem_index k = 0; k < n; k++) sum += mass[k];
    for (dem_index k = 0; k < n && part < 0.5 * sum; k++) {
        part += mass[k];
        out->median = mass[k];
    }
    out->largest = sum > 0.0 ? mass[n - 1] / sum : 0.0;
    out->debris = sum > 0.0 ? out->debris / sum : 0.0;
}

/* `mass` is 0, and so is `nodes`: how many nodes a fragment has. All are [n_nodes]. */
static void measure(dem_fracture *out, const dem_lattice *l, const dem_index *fragment, double *mass, dem_index *nodes)
{
    for (dem_index i = 0; i < l->n_nodes; i++) {
        mass[fragment[i]] += l->mass[i];
        nodes[fragment[i]]++;
    }
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (nodes[i] == 1) out->debris += mass[i];
    weigh(out, mass, l->n_nodes);
}

static void count(dem_fracture *out, const dem_lattice *l, const element_state *elements)
{
    for (dem_index k = 0; k < l->n_springs; k++) out->springs += springs_is_broken(element_state_springs(elements), k);
    for (dem_index k = 0; elements != NULL && k < l->n_triangles; k++) {
        if (!elements->triangle[k]) continue;
        out->triangles++;
        out->crack_length += crack_length(l, k);
    }
}

dem_status fragments_measure(const dem_lattice *l, const element_state *elements, dem_fracture *out)
{
    const size_t n = (size_t)l->n_nodes;
    dem_index *fragment = calloc(n, sizeof *fragment), *nodes = calloc(n, sizeof *nodes);
    double *mass = calloc(n, sizeof *mass);
    dem_fracture own = {.struct_size = sizeof own};
    const bool good = fragment != NULL && nodes != NULL && mass != NULL;
    if (good) {
        own.fragments = fragments_find(l, element_state_springs(elements).pushed, fragment);
        measure(&own, l, fragment, mass, nodes);
        count(&own, l, elements);
        *out = own;
    }
    free(fragment);
    free(nodes);
    free(mass);
    CHECK(good, DEM_ERROR_MEMORY, "out of memory for the fragments of %zu nodes", n);
    return DEM_OK;
}
