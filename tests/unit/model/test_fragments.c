/* SPDX-License-Identifier: BSD-3-Clause */
/* fragments.c: the same pieces as a fill that goes from node to node, named by their lowest nodes. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "model/fragments.h"

enum { max_nodes = 40, max_springs = 120, n_lattices = 500 };

typedef struct random_lattice {
    dem_lattice lattice;
    dem_index ends[2 * max_springs], fragment[max_nodes];
    double integrity[max_springs];
    uint64_t seed;
} random_lattice;

static dem_index draw(random_lattice *r, dem_index n)
{
    r->seed = r->seed * 6364136223846793005u + 1442695040888963407u;
    return (dem_index)((r->seed >> 33) % (uint64_t)n);
}

/* Any two nodes may have a spring, so that pieces are of all sizes; a spring is broken, softened or as it was. */
static void make_random(random_lattice *r)
{
    dem_lattice *l = &r->lattice;
    *l = (dem_lattice){.dim = 2, .n_nodes = 2 + draw(r, max_nodes - 1), .ends = r->ends};
    l->n_springs = draw(r, 3 * l->n_nodes + 1);
    for (dem_index k = 0; k < l->n_springs; k++) {
        r->ends[2 * k] = draw(r, l->n_nodes);
        r->ends[2 * k + 1] = (r->ends[2 * k] + 1 + draw(r, l->n_nodes - 1)) % l->n_nodes;
        r->integrity[k] = 0.25 * (double)(draw(r, 8) > 4 ? 1 + draw(r, 4) : 0);
    }
}

/* Sweeps over the springs until no number spreads any more. */
static void fill(const random_lattice *r, dem_index *number, dem_index from)
{
    number[from] = from;
    for (bool grows = true; grows;) {
        grows = false;
        for (dem_index k = 0; k < r->lattice.n_springs; k++) {
            const dem_index i = r->ends[2 * k], j = r->ends[2 * k + 1];
            if (r->integrity[k] == 0.0 || (number[i] == from) == (number[j] == from)) continue;
            number[i] = number[j] = from;
            grows = true;
        }
    }
}

static void check_against_fill(const random_lattice *r, dem_index n_fragments)
{
    dem_index number[max_nodes], n = 0;
    for (dem_index i = 0; i < r->lattice.n_nodes; i++) number[i] = -1;
    for (dem_index i = 0; i < r->lattice.n_nodes; i++) {
        if (number[i] >= 0) continue;
        fill(r, number, i);
        n++;
    }
    assert_int_equal(n_fragments, n);
    assert_memory_equal(r->fragment, number, (size_t)r->lattice.n_nodes * sizeof *number);
}

TEST(fragments_are_those_of_a_fill_and_have_the_number_of_their_lowest_node)
{
    random_lattice r = {.seed = 1};
    for (int k = 0; k < n_lattices; k++) {
        make_random(&r);
        check_against_fill(&r, fragments_find(&r.lattice, r.integrity, r.fragment));
    }
}

/* The springs in the reverse order, in an array that has numbers of other pieces. */
TEST(fragments_do_not_depend_on_the_order_of_springs_or_what_was_found_before)
{
    random_lattice r = {.seed = 2}, back;
    for (int k = 0; k < n_lattices; k++) {
        make_random(&r);
        back = r;
        back.lattice.ends = back.ends;
        const dem_index n = r.lattice.n_springs;
        for (dem_index q = 0; q < n; q++) {
            memcpy(&back.ends[2 * q], &r.ends[2 * (n - 1 - q)], 2 * sizeof *r.ends);
            back.integrity[q] = r.integrity[n - 1 - q];
        }
        const dem_index found = fragments_find(&r.lattice, r.integrity, r.fragment);
        assert_int_equal(fragments_find(&back.lattice, back.integrity, back.fragment), found);
        assert_memory_equal(back.fragment, r.fragment, (size_t)r.lattice.n_nodes * sizeof *r.fragment);
    }
}

/* A chain whose nodes are numbered from its far end is a long way to the lowest node. */
TEST(a_body_without_breaks_is_one_fragment)
{
    random_lattice r = {.lattice = {.dim = 2, .n_nodes = max_nodes, .n_springs = max_nodes - 1}};
    r.lattice.ends = r.ends;
    for (dem_index k = 0; k < max_nodes - 1; k++) {
        r.ends[2 * k] = max_nodes - 1 - k;
        r.ends[2 * k + 1] = max_nodes - 2 - k;
    }
    assert_int_equal(fragments_find(&r.lattice, NULL, r.fragment), 1);
    for (dem_index i = 0; i < max_nodes; i++) assert_int_equal(r.fragment[i], 0);
}
