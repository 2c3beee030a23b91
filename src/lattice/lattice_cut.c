/* SPDX-License-Identifier: BSD-3-Clause */
#include "lattice/lattice_cut.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

/* Moves items to the front of an array. Their places ascend, so that none is overwritten before it is moved. */
static void *shrink(void *array, size_t size, const dem_index *place, dem_index n)
{
    char *items = array;
    for (dem_index k = 0; k < n; k++)
        if (place[k] != k) memcpy(items + (size_t)k * size, items + (size_t)place[k] * size, size);
    void *smaller = realloc(array, (size_t)n * size + 1);
    return smaller != NULL ? smaller : array;
}

static dem_status copy(dem_lattice *out, const dem_lattice *whole, const lattice_array *a, const lattice_cut *cut)
{
    const char *from = lattice_array_of(whole, a);
    if (from == NULL) return DEM_OK;
    char *to = malloc((size_t)cut->n[a->of] * a->size + 1);
    CHECK(to != NULL, DEM_ERROR_MEMORY, "out of memory for a part of %lld nodes", (long long)cut->n[LATTICE_NODES]);
    lattice_array_put(out, a, to);
    for (dem_index k = 0; k < cut->n[a->of]; k++)
        memcpy(to + (size_t)k * a->size, from + (size_t)cut->numbers[a->of][k] * a->size, a->size);
    return DEM_OK;
}

static void renumber(dem_index *corner, dem_index n, const dem_index *node)
{
    for (dem_index k = 0; k < n && node != NULL; k++) corner[k] = node[corner[k]];
}

static void take_counts(dem_lattice *l, const lattice_cut *cut)
{
    l->n_nodes = cut->n[LATTICE_NODES];
    l->n_springs = cut->n[LATTICE_SPRINGS];
    l->n_triangles = cut->n[LATTICE_TRIANGLES];
    renumber(l->ends, 2 * l->n_springs, cut->node);
    renumber(l->triangles, 3 * l->n_triangles, cut->node);
}

dem_status lattice_cut_create(dem_lattice *out, const dem_lattice *whole, const lattice_cut *cut)
{
    dem_lattice l = dem_lattice_empty();
    dem_status status = DEM_OK;
    l.dim = whole->dim;
    for (int k = 0; k < LATTICE_ARRAYS && status == DEM_OK; k++) status = copy(&l, whole, &lattice_arrays[k], cut);
    if (status != DEM_OK) {
        dem_lattice_free(&l);
        return status;
    }
    take_counts(&l, cut);
    *out = l;
    return DEM_OK;
}

void lattice_cut_shrink(dem_lattice *whole, const lattice_cut *cut)
{
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        void *const array = lattice_array_of(whole, a);
        if (array != NULL) lattice_array_put(whole, a, shrink(array, a->size, cut->numbers[a->of], cut->n[a->of]));
    }
    take_counts(whole, cut);
}
