/* SPDX-License-Identifier: BSD-3-Clause */
/* breakable_nodes.c: which elements may break, and what is joined to them. */
#include "model/breakable_nodes.h"

#include <stdlib.h>
#include <string.h>

#include "verification/support.h"

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);

/* Marks of the first and the second of two squares; else 2: nodes of one differ. */
static void assert_marked(const dem_lattice *lattice, int first, int second)
{
    CLEANUP(free_model) dem_model *m = support_model(lattice, NULL, 0);
    const dem_lattice *l = dem_model_lattice(m);
    CLEANUP(free_memory) unsigned char *marked = malloc((size_t)l->n_nodes);
    memset(marked, 7, (size_t)l->n_nodes);
    assert_ok(breakable_nodes_mark(l, marked));
    for (dem_index i = 0; i < l->n_nodes; i++) assert_int_equal(marked[i], l->body[i] == 0 ? first : second);
}

/* One triangle, or one spring, of the second square, if any. */
TEST(what_is_joined_to_an_element_with_a_limit_is_marked)
{
    CLEANUP(dem_lattice_free) dem_lattice l = support_squares(0.02, 0.005, &rubber, (const double[2]){0.05, 0.0});
    assert_marked(&l, 0, 0);
    l.strength = malloc((size_t)l.n_triangles * sizeof *l.strength);
    for (dem_index t = 0; t < l.n_triangles; t++) l.strength[t] = (double)INFINITY;
    assert_marked(&l, 0, 0);
    l.strength[l.n_triangles - 1] = 1e5;
    assert_marked(&l, 0, 1);
    l.strength[l.n_triangles - 1] = (double)INFINITY;
    l.critical_stretch = malloc((size_t)l.n_springs * sizeof *l.critical_stretch);
    for (dem_index k = 0; k < l.n_springs; k++) l.critical_stretch[k] = (double)INFINITY;
    l.critical_stretch[0] = 0.1;
    assert_marked(&l, 1, 0);
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
