/* SPDX-License-Identifier: BSD-3-Clause */
/* lattice_cut.c: a cut is what dem_lattice_select() leaves. */
#include "unit/domain/shared_lattice.h"

#include <string.h>

#include "lattice/lattice.h"
#include "lattice/lattice_cut.h"

/* By the definition: all corners are kept. */
static dem_index list_kept(const dem_index *corner, int arity, dem_index n, const bool *keep, dem_index *list)
{
    dem_index kept = 0;
    for (dem_index k = 0; k < n; k++) {
        bool all = true;
        for (int c = 0; c < arity; c++) all = all && keep[corner[arity * k + c]];
        if (all) list[kept++] = k;
    }
    return kept;
}

static void assert_same(const dem_lattice *a, const dem_lattice *b)
{
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *array = &lattice_arrays[k];
        const void *here = lattice_array_of(a, array), *there = lattice_array_of(b, array);
        assert_int_equal(lattice_count(a, array->of), lattice_count(b, array->of));
        assert_int_equal(here != NULL, there != NULL);
        if (here != NULL) assert_memory_equal(here, there, (size_t)lattice_count(a, array->of) * array->size);
    }
}

TEST(a_cut_is_what_a_selection_leaves)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(dem_lattice_free) dem_lattice cut = dem_lattice_empty();
    CLEANUP(free_memory) bool *keep = calloc((size_t)l.n_nodes, sizeof *keep);
    CLEANUP(free_memory) dem_index *place = malloc((size_t)l.n_nodes * sizeof *place);
    CLEANUP(free_memory) dem_index *node = malloc((size_t)l.n_nodes * sizeof *node);
    CLEANUP(free_memory) dem_index *spring = malloc((size_t)l.n_springs * sizeof *spring);
    CLEANUP(free_memory) dem_index *triangle = malloc((size_t)l.n_triangles * sizeof *triangle);
    lattice_cut list = {.numbers = {node, spring, triangle}, .node = place};
    for (dem_index i = 0; i < l.n_nodes; i++) {
        keep[i] = l.x[2 * i] + l.x[2 * i + 1] < 0.01;
        place[i] = keep[i] ? list.n[LATTICE_NODES] : -1;
        if (keep[i]) node[list.n[LATTICE_NODES]++] = i;
    }
    list.n[LATTICE_SPRINGS] = list_kept(l.ends, 2, l.n_springs, keep, spring);
    list.n[LATTICE_TRIANGLES] = list_kept(l.triangles, 3, l.n_triangles, keep, triangle);
    assert_ok(lattice_cut_create(&cut, &l, &list));
    assert_ok(dem_lattice_select(&l, keep));
    assert_same(&cut, &l);
}
