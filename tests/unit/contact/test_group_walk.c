/* SPDX-License-Identifier: BSD-3-Clause */
/* group_walk.c: the order of the members of groups does not depend on where a boundary begins, nor on what else is on
 * it. */
#include "unit/close.h"

#include <gsl/gsl_rng.h>
#include <string.h>

#include "contact/group_walk.h"
#include "harness/cleanup_gsl.h"

enum { NODES = 40, CANDIDATES = 2 * NODES };

/* A ring of nodes with any numbers, and which of its nodes and edges are members. */
typedef struct ring {
    dem_index number[NODES];
    bool node[NODES], edge[NODES]; /* the edge that starts there */
} ring;

static void shuffle(gsl_rng *rng, dem_index *list, dem_index n)
{
    for (dem_index k = n - 1; k > 0; k--) {
        const dem_index j = (dem_index)gsl_rng_uniform_int(rng, (unsigned long)k + 1), kept = list[k];
        list[k] = list[j];
        list[j] = kept;
    }
}

static ring draw_ring(gsl_rng *rng, double density)
{
    ring r;
    for (dem_index i = 0; i < NODES; i++) {
        r.number[i] = i;
        r.node[i] = gsl_rng_uniform(rng) < density;
        r.edge[i] = gsl_rng_uniform(rng) < density;
    }
    shuffle(rng, r.number, NODES);
    return r;
}

/* The members' keys in their order, if the list of edges begins with the one at place `first`, and edges that are no
 * members are left out of it or not, as of a part of the boundary. */
static dem_index walk(gsl_rng *rng, const ring *r, dem_index first, bool part, contact_key *out)
{
    contact_candidate list[CANDIDATES];
    dem_index members[CANDIDATES], scratch[2][NODES], n = 0, n_members = 0;
    for (dem_index i = 0; i < NODES; i++) {
        list[n] = (contact_candidate){.node = i, .other = -1, .previous = -1, .next = -1};
        for (dem_index p = 0; p < NODES; p++)
            if (r->number[p] == i && r->node[p]) members[n_members++] = n;
        n++;
    }
    for (dem_index q = 0; q < NODES; q++) {
        const dem_index p = (first + q) % NODES;
        if (part && !r->edge[p]) continue;
        list[n] = (contact_candidate){.node = r->number[p],
                                      .other = r->number[(p + 1) % NODES],
                                      .previous = r->number[(p + NODES - 1) % NODES],
                                      .next = r->number[(p + 2) % NODES]};
        if (r->edge[p]) members[n_members++] = n;
        n++;
    }
    CLEANUP(group_walk_destroy) group_walk w;
    assert_int_equal(group_walk_create(&w, list, n, (dem_index *[]){scratch[0], scratch[1]}), DEM_OK);
    shuffle(rng, members, n_members);
    group_walk_take(&w, members, n_members);
    for (dem_index k = 0; k < n_members; k++) out[k] = candidate_key(&list[w.list[k]]);
    return n_members;
}

TEST(the_order_depends_on_the_members_alone)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int turn = 0; turn < 500; turn++) {
        const ring r = draw_ring(rng, turn % 10 == 0 ? 1.0 : 0.1 * (turn % 10));
        contact_key whole[CANDIDATES], other[CANDIDATES];
        const dem_index n = walk(rng, &r, 0, false, whole);
        for (int again = 0; again < 4; again++) {
            const dem_index first = (dem_index)gsl_rng_uniform_int(rng, NODES);
            assert_int_equal(walk(rng, &r, first, again % 2 == 0, other), n);
            for (dem_index k = 0; k < n; k++) assert_true(contact_key_equal(other[k], whole[k]));
        }
    }
}

/* Node 3, edges 3-0, 0-2 with node 2 at the end, and edge 1-4 by itself: its beginning has the lower number. */
TEST(members_come_along_the_boundary)
{
    static const dem_index numbers[NODES] = {0, 2, 5, 1, 4, 6, 7, 3};
    static const contact_key expected[6] = {{3, -1}, {3, 0}, {0, 2}, {2, -1}, {1, 4}, {5, -1}};
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    ring r = {.node = {false, true, true}, .edge = {true}};
    contact_key found[CANDIDATES];
    memcpy(r.number, numbers, sizeof numbers);
    for (dem_index i = 8; i < NODES; i++) r.number[i] = i;
    r.number[NODES - 1] = 3, r.number[7] = NODES - 1; /* the last of the list goes on with its first */
    r.node[NODES - 1] = r.edge[NODES - 1] = r.edge[3] = true;
    assert_int_equal(walk(rng, &r, 0, false, found), 6);
    for (int k = 0; k < 6; k++) assert_true(contact_key_equal(found[k], expected[k]));
}

/* All edges of the ring: it begins at edge 0-1 or 1-0, whichever there is, or else with the lowest that node 0 has. */
TEST(a_ring_begins_at_its_lowest_edge)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    const ring r = draw_ring(rng, 1.1);
    contact_key found[CANDIDATES];
    dem_index place = 0;
    assert_int_equal(walk(rng, &r, 7, false, found), CANDIDATES);
    while (r.number[place] != 0) place++;
    const dem_index before = r.number[(place + NODES - 1) % NODES], after = r.number[(place + 1) % NODES];
    const contact_key lowest = before < after ? (contact_key){before, 0} : (contact_key){0, after};
    assert_true(contact_key_equal(found[0], (contact_key){lowest.node, -1}));
    assert_true(contact_key_equal(found[1], lowest));
    for (int k = 3; k < CANDIDATES; k += 2) assert_int_equal(found[k].node, found[k - 2].other);
}
