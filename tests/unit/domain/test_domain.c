/* SPDX-License-Identifier: BSD-3-Clause */
/* domain.c and ghost_rings.c against the definition: own and common nodes, those that a spring or a triangle joins to
 * one, and further rings of them. */
#include "unit/domain/shared_lattice.h"

#include <string.h>

#include "domain/common_nodes.h"
#include "domain/domain.h"

enum { N_RANKS = 5 };

static bool is_integrated(const domain_shares *s, int rank, dem_index i)
{
    return s->owner[i] == rank || (s->is_common != NULL && s->is_common[i]);
}

static void mark_next(unsigned char *mark, int ring, dem_index from, dem_index to)
{
    if (mark[from] == ring && mark[to] == 0) mark[to] = (unsigned char)(ring + 1);
}

/* In which ring a node is in the domain of a rank, and one: by a look at all springs and triangles for each ring. */
static void mark(const dem_lattice *l, const domain_shares *s, int rank, unsigned char *mark)
{
    memset(mark, 0, (size_t)l->n_nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) mark[i] = is_integrated(s, rank, i);
    for (int ring = 1; ring <= (s->n_rings > 0 ? s->n_rings : 1); ring++) {
        for (dem_index k = 0; k < 2 * l->n_springs; k++) mark_next(mark, ring, l->ends[k], l->ends[k ^ 1]);
        for (dem_index k = 0; k < 3 * l->n_triangles; k++)
            for (int c = 0; c < 3; c++) mark_next(mark, ring, l->triangles[k], l->triangles[k / 3 * 3 + c]);
    }
}

static const domain_neighbour *find(const domain *d, int rank)
{
    for (int k = 0; k < d->n_neighbours; k++)
        if (d->neighbours[k].rank == rank) return &d->neighbours[k];
    return NULL;
}

static void assert_nodes_are_right(const domain *d, const dem_lattice *l, const domain_shares *s, int rank)
{
    CLEANUP(free_memory) unsigned char *is_there = malloc((size_t)l->n_nodes);
    mark(l, s, rank, is_there);
    dem_index n = 0;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        assert_int_equal(domain_node(d, i), is_integrated(s, rank, i) ? n : -1);
        if (!is_there[i]) continue;
        assert_true(n < d->n_nodes && d->number[n] == i);
        assert_int_equal(d->is_own[n], s->owner[i] == rank);
        assert_int_equal(d->is_ghost[n], !is_integrated(s, rank, i));
        assert_int_equal(d->is_outer[n], is_there[i] == d->n_rings + 1);
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
        assert_true(from->is_own[sent->sent[k]] && to->is_ghost[received->received[k]]);
        assert_int_equal(from->number[sent->sent[k]], to->number[received->received[k]]);
    }
}

static void check_rings(const dem_lattice *l, int n_rings, const int32_t *owner, const unsigned char *is_common)
{
    domain d[N_RANKS];
    const domain_shares shares = {.n_ranks = N_RANKS,
                                  .owner = owner,
                                  .is_common = is_common,
                                  .n_rings = n_rings,
                                  .most_ghosts = l->n_nodes * N_RANKS};
    for (int k = 0; k < N_RANKS; k++) assert_ok(domain_create(&d[k], l, &shares, k));
    for (int k = 0; k < N_RANKS; k++) {
        assert_nodes_are_right(&d[k], l, &shares, k);
        dem_index n_ghosts = 0, n_received = 0;
        for (dem_index i = 0; i < d[k].n_nodes; i++) n_ghosts += d[k].is_ghost[i];
        for (int q = 0; q < d[k].n_neighbours; q++) n_received += d[k].neighbours[q].n_received;
        assert_int_equal(n_received, n_ghosts);
        for (int q = 0; q < N_RANKS; q++) assert_lists_agree(&d[k], k, &d[q], q);
    }
    for (int k = 0; k < N_RANKS; k++) domain_free(&d[k]);
}

static void check(const dem_lattice *l, const int32_t *owner, const unsigned char *is_common)
{
    check_rings(l, 0, owner, is_common);
    check_rings(l, 3, owner, is_common);
}

TEST(domains_have_own_nodes_and_those_next_to_them)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    check(&l, owner, NULL);
    for (dem_index i = 0; i < l.n_nodes; i++) owner[i] = (int32_t)(7 * i % N_RANKS);
    check(&l, owner, NULL);
}

/* As far from what may touch as the rings say, by a look at all springs again and again. */
static void assert_rings(const dem_lattice *l, int n_rings, const unsigned char *is_common)
{
    CLEANUP(free_memory) int *ring = malloc((size_t)l->n_nodes * sizeof *ring);
    for (dem_index i = 0; i < l->n_nodes; i++) ring[i] = l->flags[i] & DEM_NODE_CONTACT ? 0 : 1000;
    for (bool changes = true; changes;) {
        changes = false;
        for (dem_index k = 0; k < 2 * l->n_springs; k++) {
            if (ring[l->ends[k]] <= ring[l->ends[k ^ 1]] + 1) continue;
            ring[l->ends[k]] = ring[l->ends[k ^ 1]] + 1;
            changes = true;
        }
    }
    for (dem_index i = 0; i < l->n_nodes; i++) assert_int_equal(is_common[i] != 0, ring[i] <= n_rings);
}

/* With as many rings as make all nodes common there are no ghosts. */
TEST(common_nodes_are_in_all_domains)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    CLEANUP(free_memory) unsigned char *is_common = malloc((size_t)l.n_nodes);
    l.flags = calloc((size_t)l.n_nodes, sizeof *l.flags);
    for (dem_index i = 0; i < l.n_nodes; i++)
        if (l.x[2 * i + 1] < -0.03) l.flags[i] = DEM_NODE_CONTACT;
    for (int n_rings = 0; n_rings < 20; n_rings += 3) {
        for (dem_index i = 0; i < l.n_nodes; i++) is_common[i] = (l.flags[i] & DEM_NODE_CONTACT) != 0;
        common_nodes_add_rings(&l, n_rings, is_common);
        assert_rings(&l, n_rings, is_common);
        check(&l, owner, is_common);
    }
}

/* A triangle whose corners no spring joins: the force of its area term depends on all three. */
TEST(corners_of_triangles_are_ghosts_without_springs)
{
    double x[] = {0.0, 0.0, 1.0, 0.0, 0.0, 1.0};
    dem_index corners[] = {0, 1, 2};
    const dem_lattice l = SIZED(dem_lattice, .dim = 2, .n_nodes = 3, .n_triangles = 1, .x = x, .triangles = corners);
    const int32_t owner[] = {0, 1, 1};
    domain d;
    assert_ok(domain_create(&d, &l, &(domain_shares){.n_ranks = 2, .owner = owner}, 0));
    assert_int_equal(d.n_nodes, 3);
    assert_int_equal(d.neighbours[0].n_received, 2);
    assert_int_equal(d.neighbours[0].n_sent, 1);
    domain_free(&d);
}

/* Of all domains together. */
static dem_index count_ghosts(const dem_lattice *l, const domain_shares *shares, int *n_rings)
{
    dem_index n = 0;
    domain d;
    for (int k = 0; k < N_RANKS; k++) {
        assert_ok(domain_create(&d, l, shares, k));
        for (dem_index i = 0; i < d.n_nodes; i++) n += d.is_ghost[i];
        *n_rings = d.n_rings;
        domain_free(&d);
    }
    return n;
}

/* Of four rings, where so many fit: with three, four steps are two and two, which two rings are enough for. */
static int fitting_rings(int fit, int least)
{
    const int even = fit == 3 ? 2 : fit;
    return even >= least ? even : 1;
}

TEST(there_are_as_many_rings_as_have_not_too_many_ghosts)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    dem_index n_ghosts[5] = {0};
    domain_shares shares = {.n_ranks = N_RANKS, .owner = owner, .most_ghosts = INT64_MAX};
    int n_rings;
    for (shares.n_rings = 1; shares.n_rings < 5; shares.n_rings++) {
        n_ghosts[shares.n_rings] = count_ghosts(&l, &shares, &n_rings);
        assert_int_equal(n_rings, shares.n_rings);
        assert_true(n_ghosts[n_rings] > n_ghosts[n_rings - 1]);
    }
    shares.n_rings = 4;
    for (int ring = 1; ring < 5; ring++)
        for (shares.least_rings = 0; shares.least_rings < 5; shares.least_rings++) {
            shares.most_ghosts = n_ghosts[ring];
            const int fit = fitting_rings(ring, shares.least_rings);
            assert_int_equal(count_ghosts(&l, &shares, &n_rings), n_ghosts[fit]);
            assert_int_equal(n_rings, fit);
            shares.most_ghosts--;
            const int fewer = fitting_rings(ring > 1 ? ring - 1 : 1, shares.least_rings);
            assert_int_equal(count_ghosts(&l, &shares, &n_rings), n_ghosts[fewer]);
            assert_int_equal(n_rings, fewer);
        }
}

TEST(a_rank_without_nodes_is_refused)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = calloc((size_t)l.n_nodes, sizeof *owner);
    domain d;
    assert_int_equal(domain_create(&d, &l, &(domain_shares){.n_ranks = 2, .owner = owner}, 1), DEM_ERROR_MODEL);
    assert_string_equal(dem_status_message(), "rank 1 has no node of its own");
}

TEST(no_domain_is_the_whole_lattice)
{
    assert_int_equal(domain_node(NULL, 5), 5);
    assert_int_equal(domain_number(NULL, 5), 5);
}
