/* SPDX-License-Identifier: BSD-3-Clause */
/* breakable_nodes.c: which elements may break, and what is next to them. */
#include "model/breakable_nodes.h"

#include <stdlib.h>
#include <string.h>

#include "verification/support.h"

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);

/* Whether a node is in a triangle with another one that has such a mark. */
static bool is_next_to(const dem_lattice *l, dem_index node, const unsigned char *mark)
{
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const dem_index *corner = &l->triangles[3 * t];
        const bool has = corner[0] == node || corner[1] == node || corner[2] == node;
        if (has && (mark[corner[0]] || mark[corner[1]] || mark[corner[2]])) return true;
    }
    return false;
}

/* What is marked is what is next to some nodes, at most three.  \return how many nodes are */
static dem_index assert_marked(const dem_lattice *l, const dem_index *nodes, int n)
{
    CLEANUP(free_memory) unsigned char *marked = malloc((size_t)l->n_nodes), *seed = calloc((size_t)l->n_nodes, 1);
    dem_index n_marked = 0;
    memset(marked, 7, (size_t)l->n_nodes);
    for (int c = 0; c < n; c++) seed[nodes[c]] = 1;
    breakable_nodes_mark(l, marked);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        assert_int_equal(marked[i], is_next_to(l, i, seed));
        n_marked += marked[i];
    }
    return n_marked;
}

/* One triangle, or one spring, of the second square, if any. */
TEST(what_is_next_to_an_element_with_a_limit_is_marked)
{
    CLEANUP(dem_lattice_free) dem_lattice l = support_squares(0.02, 0.0025, &rubber, (const double[2]){0.05, 0.0});
    l.flags = calloc((size_t)l.n_nodes, sizeof *l.flags);
    assert_int_equal(assert_marked(&l, NULL, 0), 0);
    l.strength = malloc((size_t)l.n_triangles * sizeof *l.strength);
    for (dem_index t = 0; t < l.n_triangles; t++) l.strength[t] = (double)INFINITY;
    assert_int_equal(assert_marked(&l, NULL, 0), 0);
    l.strength[l.n_triangles - 1] = 1e5;
    assert_in_range(assert_marked(&l, &l.triangles[3 * l.n_triangles - 3], 3), 4, 12);
    l.strength[l.n_triangles - 1] = (double)INFINITY;
    l.critical_stretch = malloc((size_t)l.n_springs * sizeof *l.critical_stretch);
    for (dem_index k = 0; k < l.n_springs; k++) l.critical_stretch[k] = (double)INFINITY;
    l.critical_stretch[0] = 0.1;
    assert_in_range(assert_marked(&l, &l.ends[0], 2), 3, 10);
}

TEST(elements_that_may_break_have_a_limit_and_are_not_rigid)
{
    CLEANUP(dem_lattice_free) dem_lattice l = support_squares(0.02, 0.01, &rubber, (const double[2]){0.05, 0.0});
    l.flags = calloc((size_t)l.n_nodes, sizeof *l.flags);
    assert_false(breakable_element(&l, 0));
    l.strength = malloc((size_t)l.n_triangles * sizeof *l.strength);
    l.strength[0] = 1e5;
    assert_true(breakable_element(&l, 0));
    assert_false(breakable_element(&l, l.n_triangles));
    l.flags[l.triangles[0]] = DEM_NODE_RIGID;
    assert_false(breakable_element(&l, 0));
}
