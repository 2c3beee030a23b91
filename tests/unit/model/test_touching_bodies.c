/* SPDX-License-Identifier: BSD-3-Clause */
/* touching_bodies.c: the boundary and the sums over bodies. */
#include "model/touching_bodies.h"

#include "base/vec2.h"
#include "harness/rank_threads.h"
#include "verification/support.h"

enum { N_RANKS = 3, N_BODIES = 11 };

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);

/* Of two squares. */
TEST(bodies_have_their_boundary_and_their_sums)
{
    CLEANUP(dem_lattice_free) dem_lattice l = support_squares(0.02, 0.01, &rubber, (const double[2]){0.05, 0.0});
    CLEANUP(touching_bodies_free) touching_bodies o;
    double sums[2] = {0.0, 0.0};
    for (dem_index k = 0; k < l.n_springs; k++) sums[l.body[l.ends[2 * k]]] += l.stiffness[k] * l.rest_length[k];
    assert_ok(touching_bodies_create(&o, &l));
    assert_int_equal(o.n_bodies, 2);
    assert_true(o.boundary.n > 0);
    for (dem_index k = 0; k < o.boundary.n; k++) {
        const mesh_boundary_edge *e = &o.boundary.list[k];
        assert_int_equal(l.body[e->lower], l.body[l.triangles[3 * e->triangle]]);
    }
    for (int b = 0; b < 2; b++) {
        double area = 0.0;
        for (dem_index k = 0; k < l.n_triangles; k++)
            if (l.body[l.triangles[3 * k]] == b) area += vec2_area_of(l.x, &l.triangles[3 * k]);
        assert_close(o.bodies[b].area, area, 1e-15 * (double)l.n_triangles * area);
        assert_close(o.bodies[b].springs, sums[b], 1e-15 * (double)l.n_springs * sums[b]);
        assert_true(area > 0.0);
    }
}

/* More than are reduced at once, in a row; stiffnesses of springs are up to 1e8 apart, so that most sums in another
 * order have other bits. */
static dem_lattice make_row(void)
{
    dem_lattice row = dem_lattice_empty();
    for (int b = 0; b < N_BODIES; b++) {
        CLEANUP(dem_lattice_free) dem_lattice one = support_rectangle(0.02, 0.01, 2e-3, &rubber);
        dem_lattice_move(&one, 0.1 * b, (const double[2]){0.05 * b, 0.0});
        assert_ok(dem_lattice_append(&row, &one));
    }
    for (dem_index k = 0; k < row.n_springs; k++) row.stiffness[k] *= exp(10.0 * sin(12.9898 * (double)k));
    return row;
}

/* What each rank finds. */
typedef struct shared {
    const dem_lattice *lattice;
    touching_bodies bodies[N_RANKS];
    dem_status status[N_RANKS];
} shared;

/* Nodes are shared out in turn. */
static void sum_up(const ranks *r, void *context)
{
    shared *s = context;
    const dem_index n = s->lattice->n_nodes;
    CLEANUP(free_memory) unsigned char *is_own = malloc((size_t)n);
    for (dem_index i = 0; i < n; i++) is_own[i] = i % r->size == r->rank;
    s->status[r->rank] = touching_bodies_sum_up(&s->bodies[r->rank], s->lattice, r, is_own);
}

TEST(sums_over_bodies_do_not_depend_on_who_adds_them)
{
    CLEANUP(dem_lattice_free) dem_lattice row = make_row();
    CLEANUP(touching_bodies_free) touching_bodies alone;
    shared s = {.lattice = &row};
    assert_ok(touching_bodies_sum_up(&alone, &row, &ranks_alone, NULL));
    assert_int_equal(alone.n_bodies, N_BODIES);
    rank_threads_run(N_RANKS, sum_up, &s);
    for (int k = 0; k < N_RANKS; k++) {
        assert_ok(s.status[k]);
        assert_int_equal(s.bodies[k].n_bodies, N_BODIES);
        assert_memory_equal(s.bodies[k].bodies, alone.bodies, N_BODIES * sizeof *alone.bodies);
        touching_bodies_free(&s.bodies[k]);
    }
}

TEST(nodes_of_a_part_have_their_numbers_in_the_whole)
{
    dem_index number[] = {3, 7};
    const domain d = {.n_nodes = 2, .number = number};
    const touching_bodies whole = {.domain = NULL}, part = {.domain = &d};
    assert_int_equal(touching_bodies_node(NULL, 1), 1);
    assert_int_equal(touching_bodies_node(&whole, 1), 1);
    assert_int_equal(touching_bodies_node(&part, 1), 7);
}
