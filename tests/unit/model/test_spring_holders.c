/* SPDX-License-Identifier: BSD-3-Clause */
/* spring_holders.c: every triangle holds its springs, and the shares of each spring are all of it. */
#include "verification/support.h"

#include <stdlib.h>

#include "model/spring_holders.h"
#include "unit/solids.h"

typedef struct tally {
    double *sum;   /* [n_springs] of shares */
    dem_index *of; /* [n_triangles] springs that it holds */
    dem_index last, n_visits, n_returns;
    unsigned char *seen;
} tally;

/* Counts visits of a spring after one of another spring has come between. */
static void note(void *context, dem_index spring, dem_index triangle, double share)
{
    tally *t = context;
    t->sum[spring] += share;
    if (triangle >= 0) t->of[triangle]++;
    t->n_visits++;
    t->n_returns += t->seen[spring] && spring != t->last;
    t->seen[spring] = 1;
    t->last = spring;
}

static void check_holders(dem_lattice *lattice, dem_index per_triangle)
{
    CLEANUP(springs_free) springs s;
    CLEANUP(spring_holders_free) spring_holders h;
    assert_ok(springs_compile(&s, lattice));
    assert_ok(spring_holders_create(&h, lattice, &s));
    for (int twice = 0; twice < 2; twice++) {
        tally t = {.sum = calloc((size_t)lattice->n_springs, sizeof *t.sum),
                   .of = calloc((size_t)lattice->n_triangles, sizeof *t.of),
                   .seen = calloc((size_t)lattice->n_springs, 1),
                   .last = -1};
        assert_true(t.sum && t.of && t.seen);
        spring_holders_visit(&h, note, &t);
        for (dem_index k = 0; k < lattice->n_springs; k++) assert_close(t.sum[k], 1.0, 1e-15);
        for (dem_index k = 0; k < lattice->n_triangles; k++) assert_int_equal(t.of[k], per_triangle);
        assert_int_equal(t.n_visits, per_triangle * lattice->n_triangles);
        assert_int_equal(t.n_returns, 0);
        free(t.sum);
        free(t.of);
        free(t.seen);
    }
}

TEST(a_triangle_holds_its_sides)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.1, 0.1, 0.01);
    check_holders(&lattice, 3);
}

/* Its two sides of the cell, and both diagonals. */
TEST(a_triangle_of_a_cell_holds_both_diagonals)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_squares(&lattice, 0.1, 0.1, 0.01));
    assert_ok(dem_lattice_assemble_squares(&lattice, &rubber, 0.5));
    check_holders(&lattice, 4);
}

static void note_loose(void *context, dem_index spring, dem_index triangle, double share)
{
    dem_index *n = context;
    assert_int_equal(spring, 0);
    assert_int_equal(triangle, -1);
    assert_close(share, 0.5, 0.0);
    (*n)++;
}

TEST(a_spring_in_no_triangle_is_visited_for_each_of_its_nodes)
{
    dem_index ends[2] = {0, 1}, n = 0;
    double x[4] = {0.0, 0.0, 1.0, 0.0}, ones[2] = {1.0, 1.0};
    const dem_lattice bar = {.dim = 2,
                             .n_nodes = 2,
                             .n_springs = 1,
                             .x = x,
                             .ends = ends,
                             .rest_length = ones,
                             .stiffness = ones,
                             .mass = ones};
    CLEANUP(springs_free) springs s;
    CLEANUP(spring_holders_free) spring_holders h;
    assert_ok(springs_compile(&s, &bar));
    assert_ok(spring_holders_create(&h, &bar, &s));
    spring_holders_visit(&h, note_loose, &n);
    assert_int_equal(n, 2);
}
