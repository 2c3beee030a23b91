/* SPDX-License-Identifier: BSD-3-Clause */
/* mesh_boundary.c: what follows from break to break is what is found anew. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

#include "harness/cleanup_gsl.h"
#include "lattice/mesh_edges.h"
#include "unit/model/cut_solids.h"

#include "model/mesh_boundary.h"

static void check_equal(const mesh_boundary *a, const mesh_boundary *b)
{
    assert_int_equal(a->n, b->n);
    assert_memory_equal(a->list, b->list, (size_t)a->n * sizeof *a->list);
    assert_memory_equal(a->outer, b->outer, (size_t)a->lattice->n_nodes);
}

/* Up to five elements at a time, which may be side by side, until all have broken. */
static void check_breaking(const dem_lattice *l)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(springs_free) springs all;
    CLEANUP(element_state_destroy) element_state state;
    CLEANUP(mesh_boundary_free) mesh_boundary now;
    assert_ok(springs_compile(&all, l));
    assert_ok(element_state_create(&state, l, &all));
    assert_ok(mesh_boundary_create(&now, l, NULL));
    while (state.n_broken < l->n_triangles) {
        CLEANUP(mesh_boundary_free) mesh_boundary anew;
        dem_index list[5], n = 0, t = (dem_index)gsl_rng_uniform_int(rng, (unsigned long)l->n_triangles);
        for (dem_index k = 0; k < l->n_triangles && n < 5; k++, t = (t + 1) % l->n_triangles) {
            if (state.triangle[t]) continue;
            element_state_break(&state, t);
            list[n++] = t;
        }
        mesh_boundary next;
        assert_ok(mesh_boundary_follow(&next, &now, &state, list, n));
        mesh_boundary_free(&now);
        now = next;
        assert_ok(mesh_boundary_create(&anew, l, state.triangle));
        check_equal(&now, &anew);
    }
    assert_int_equal(now.n, 0);
}

TEST(what_follows_is_what_is_found_anew)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(dem_lattice_free) dem_lattice l = solid_of(kind);
        check_breaking(&l);
    }
}

/* A spring alone has no side. */
TEST(springs_change_no_boundary)
{
    CLEANUP(dem_lattice_free) dem_lattice l = solid_of(0);
    CLEANUP(springs_free) springs all;
    CLEANUP(element_state_destroy) element_state state;
    CLEANUP(mesh_boundary_free) mesh_boundary before, after;
    assert_ok(springs_compile(&all, &l));
    assert_ok(element_state_create(&state, &l, &all));
    assert_ok(mesh_boundary_create(&before, &l, NULL));
    const dem_index spring = l.n_triangles + 3;
    element_state_break(&state, spring);
    assert_ok(mesh_boundary_follow(&after, &before, &state, &spring, 1));
    check_equal(&before, &after);
}

/* Edges with their triangles, and the nodes that are marked, of two triangles and of one of them. */
TEST(an_edge_of_the_boundary_is_of_one_whole_triangle)
{
    const unsigned char first[2] = {1, 0};
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_squares(&l, 1.0, 1.0, 1.0));
    for (int k = 0; k < 2; k++) {
        CLEANUP(mesh_boundary_free) mesh_boundary b;
        unsigned char flags[4] = {0, 0, 0, 0};
        assert_ok(mesh_boundary_create(&b, &l, k == 0 ? NULL : first));
        assert_int_equal(b.n, k == 0 ? 4 : 3);
        mesh_boundary_mark(&b, flags, 8);
        int n_marked = 0;
        for (int i = 0; i < 4; i++) n_marked += flags[i] == 8;
        assert_int_equal(n_marked, k == 0 ? 4 : 3);
        for (dem_index e = 0; e < b.n; e++) {
            assert_true(b.list[e].lower < b.list[e].upper);
            assert_true(k == 0 || b.list[e].triangle == 1);
        }
        for (int i = 0; i < 4; i++) assert_int_equal(b.outer[i], 1);
    }
}
