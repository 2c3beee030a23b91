/* SPDX-License-Identifier: BSD-3-Clause */
/* Keeps some nodes or triangles of a lattice and drops the others. The arrays shrink in place and keep their order;
 * springs and triangles that lose a node go with it. Nodes on a new boundary keep the masses and springs they had: to
 * have those of a boundary, a lattice is cut before it is assembled (dem_lattice_trim() insists on that). */
#include "lattice/lattice.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "lattice/lattice_arrays.h"

/* Moves the items to keep to the front. An array that is NULL stays so. */
static void pack(void *array, size_t size, dem_index n, const bool *keep)
{
    unsigned char *bytes = array;
    dem_index kept = 0;
    for (dem_index i = 0; array != NULL && i < n; i++)
        if (keep[i]) memmove(bytes + size * (size_t)kept++, bytes + size * (size_t)i, size);
}

/* Drops tuples that are not wanted or have lost a node, and renumbers the nodes of the others.
 * \param whole  [n] in: wanted, out: stayed
 * \return how many stay */
static dem_index pack_corners(dem_index *corner, int arity, dem_index n, const dem_index *number, bool *whole)
{
    dem_index kept = 0;
    for (dem_index k = 0; k < n; k++) {
        for (int c = 0; c < arity; c++) whole[k] = whole[k] && number[corner[arity * k + c]] >= 0;
        if (!whole[k]) continue;
        for (int c = 0; c < arity; c++) corner[arity * kept + c] = number[corner[arity * k + c]];
        kept++;
    }
    return kept;
}

/* All arrays of nodes, springs or triangles, but for node numbers, which have been packed. */
static void pack_all(dem_lattice *lattice, lattice_items of, const bool *keep)
{
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        void *array = lattice_array_of(lattice, a);
        if (a->of == of && array != lattice->ends && array != lattice->triangles)
            pack(array, a->size, lattice_count(lattice, of), keep);
    }
}

/* `whole` tells the other arrays which springs have stayed. */
static void pack_springs(dem_lattice *lattice, const dem_index *number, bool *whole)
{
    const dem_index n = pack_corners(lattice->ends, 2, lattice->n_springs, number, whole);
    pack_all(lattice, LATTICE_SPRINGS, whole);
    lattice->n_springs = n;
}

static void pack_triangles(dem_lattice *lattice, const dem_index *number, bool *whole)
{
    const dem_index n = pack_corners(lattice->triangles, 3, lattice->n_triangles, number, whole);
    pack_all(lattice, LATTICE_TRIANGLES, whole);
    lattice->n_triangles = n;
}

/* Keeps nodes and, of the triangles among them, those for which wanted[t] != 0; NULL: all. A lattice without nodes is
 * refused. Memory is asked for before anything is changed. */
static dem_status select_both(dem_lattice *lattice, const bool *keep, const bool *wanted)
{
    const dem_index n_springs = lattice->n_springs, n_triangles = lattice->n_triangles;
    dem_index *number = lattice_zeros(lattice->n_nodes, sizeof *number), n = 0;
    bool *whole = lattice_zeros(n_springs + n_triangles, sizeof *whole);
    dem_status status = DEM_OK;
    if (number == NULL || whole == NULL) {
        status = status_fail(DEM_ERROR_MEMORY, "out of memory");
        goto out;
    }
    /* The new number of each node; -1: it goes. */
    for (dem_index i = 0; i < lattice->n_nodes; i++) number[i] = keep[i] ? n++ : -1;
    if (n == 0) {
        status = status_fail(DEM_ERROR_MODEL, "none of %lld nodes is left", (long long)lattice->n_nodes);
        goto out;
    }
    memset(whole, 1, (size_t)(n_springs + n_triangles));
    for (dem_index t = 0; wanted != NULL && t < n_triangles; t++) whole[n_springs + t] = wanted[t] != 0;
    pack_springs(lattice, number, whole);
    pack_triangles(lattice, number, whole + n_springs);
    pack_all(lattice, LATTICE_NODES, keep);
    lattice->n_nodes = n;
out:
    free(number);
    free(whole);
    return status;
}

dem_status dem_lattice_select(dem_lattice *lattice, const bool *keep)
{
    TRY(lattice_check(lattice));
    CHECK(keep != NULL, DEM_ERROR_ARGUMENT, "keep is NULL");
    return select_both(lattice, keep, NULL);
}

/* A node that is in none of the triangles to keep goes, too. */
dem_status dem_lattice_trim(dem_lattice *lattice, const bool *keep)
{
    TRY(lattice_check(lattice));
    CHECK(keep != NULL, DEM_ERROR_ARGUMENT, "keep is NULL");
    CHECK(lattice->n_springs == 0, DEM_ERROR_MODEL, "a lattice that has springs cannot be trimmed: %lld springs",
          (long long)lattice->n_springs);
    bool *used = lattice_zeros(lattice->n_nodes, sizeof *used);
    CHECK_MEMORY(used);
    for (dem_index k = 0; k < 3 * lattice->n_triangles; k++)
        if (keep[k / 3]) used[lattice->triangles[k]] = 1;
    const dem_status status = select_both(lattice, used, keep);
    free(used);
    return status;
}
