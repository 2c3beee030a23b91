/* SPDX-License-Identifier: BSD-3-Clause */
/* domain.c against the definition: own nodes, and those that a spring or a triangle joins to one. */
#include "unit/domain/shared_lattice.h"

#include <string.h>

#include "domain/domain.h"

enum { N_RANKS = 5 };

/* Whether a node is in the domain of a rank, by a look at all springs and triangles. */
static void mark(const dem_lattice *l, const int32_t *owner, int rank, unsigned char *is_there)
{
    memset(is_there, 0, (size_t)l->n_nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) is_there[i] = owner[i] == rank;
    for (dem_index k = 0; k < 2 * l->n_springs; k++)
        if (owner[l->ends[k]] == rank) is_there[l->ends[k ^ 1]] = 1;
    for (dem_index k = 0; k < 3 * l->n_triangles; k++)
        for (int c = 0; c < 3 && owner[l->triangles[k]] == rank; c++) is_there[l->triangles[k / 3 * 3 + c]] = 1;
}

static const domain_neighbour *find(const domain *d, int rank)
{
    for (int k = 0; k < d->n_neighbours; k++)
        if (d->neighbours[k].rank == rank) return &d->neighbours[k];
    return NULL;
}

static void assert_nodes_are_right(const domain *d, const dem_lattice *l, const int32_t *owner, int rank)
{
    CLEANUP(free_memory) unsigned char *is_there = malloc((size_t)l->n_nodes);
    mark(l, owner, rank, is_there);
    dem_index n = 0;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        assert_int_equal(domain_own_node(d, i), owner[i] == rank ? n : -1);
        if (!is_there[i]) continue;
        assert_true(n < d->n_nodes && d->number[n] == i);
        assert_int_equal(d->is_own[n], owner[i] == rank);
        n++;
    }
    assert_int_equal(d->n_nodes, n);
    assert_int_equal(d->n_whole, l->n_nodes);
}

/* What one rank sends is what the other expects, node by node. */
static void assert_lists_agree(const domain *from, int sender, const domain *to, int receiver)
{
    const domain_neighbour *sent = find(from, receiver), *received = find(to, sender);
    assert_int_equal(sent == NULL, received == NULL);
    if (sent == NULL) return;
    assert_int_equal(sent->n_sent, received->n_received);
    for (dem_index k = 0; k < sent->n_sent; k++) {
        assert_true(from->is_own[sent->sent[k]] && !to->is_own[received->received[k]]);
        assert_int_equal(from->number[sent->sent[k]], to->number[received->received[k]]);
    }
}

static void check(const dem_lattice *l, const int32_t *owner)
{
    domain d[N_RANKS];
    for (int k = 0; k < N_RANKS; k++) assert_ok(domain_create(&d[k], l, owner, k));
    for (int k = 0; k < N_RANKS; k++) {
        assert_nodes_are_right(&d[k], l, owner, k);
        dem_index n_ghosts = 0, n_received = 0;
        for (dem_index i = 0; i < d[k].n_nodes; i++) n_ghosts += !d[k].is_own[i];
        for (int q = 0; q < d[k].n_neighbours; q++) n_received += d[k].neighbours[q].n_received;
        assert_int_equal(n_received, n_ghosts);
        for (int q = 0; q < N_RANKS; q++) assert_lists_agree(&d[k], k, &d[q], q);
    }
    for (int k = 0; k < N_RANKS; k++) domain_free(&d[k]);
}

TEST(domains_have_own_nodes_and_those_next_to_them)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    check(&l, owner);
    for (dem_index i = 0; i < l.n_nodes; i++) owner[i] = (int32_t)(7 * i % N_RANKS);
    check(&l, owner);
}

/* A triangle whose corners no spring joins: the force of its area term depends on all three. */
TEST(corners_of_triangles_are_ghosts_without_springs)
{
    double x[] = {0.0, 0.0, 1.0, 0.0, 0.0, 1.0};
    dem_index corners[] = {0, 1, 2};
    const dem_lattice l = SIZED(dem_lattice, .dim = 2, .n_nodes = 3, .n_triangles = 1, .x = x, .triangles = corners);
    const int32_t owner[] = {0, 1, 1};
    domain d;
    assert_ok(domain_create(&d, &l, owner, 0));
    assert_int_equal(d.n_nodes, 3);
    assert_int_equal(d.neighbours[0].n_received, 2);
    assert_int_equal(d.neighbours[0].n_sent, 1);
    domain_free(&d);
}

TEST(a_rank_without_nodes_is_refused)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = calloc((size_t)l.n_nodes, sizeof *owner);
    domain d;
    assert_int_equal(domain_create(&d, &l, owner, 1), DEM_ERROR_MODEL);
    assert_string_equal(dem_status_message(), "rank 1 has no node of its own");
}

TEST(no_domain_is_the_whole_lattice)
{
    assert_int_equal(domain_own_node(NULL, 5), 5);
    assert_int_equal(domain_number(NULL, 5), 5);
}
