/* SPDX-License-Identifier: BSD-3-Clause */
/* whole_lattice.c, and domain_cut.c by it: the domain of a rank that is cut from a part of the lattice is the one that
 * is cut from the whole, to the last number. */
#include "unit/domain/shared_lattice.h"

#include <string.h>

#include "domain/adjacency.h"
#include "harness/rank_threads.h"
#include "lattice/lattice_cut.h"
#include "model/domain_cut.h"

enum { N_RANKS = 5, TEXT = 200 };

typedef struct shared {
    const dem_model *whole;
    const int32_t *owner;
    domain_model_shares shares; /* of the whole */
    const char *difference[N_RANKS];
} shared;

/* ---- a part of the lattice ---- */

typedef struct part {
    dem_lattice lattice;
    dem_index n[LATTICE_ITEMS];
    dem_index *number[LATTICE_ITEMS], *local; /* in the whole, and of its nodes in the part */
    int32_t *owner;
} part;

static void free_part(part *p)
{
    dem_lattice_free(&p->lattice);
    for (int k = 0; k < LATTICE_ITEMS; k++) free(p->number[k]);
    free(p->local);
    free(p->owner);
}

/* Own and common nodes, and those so many rings about them. */
static unsigned char *mark(const dem_lattice *l, const int32_t *owner, const unsigned char *is_common, int rank,
                           int n_rings)
{
    unsigned char *marks = malloc((size_t)l->n_nodes);
    CLEANUP(free_memory) unsigned char *before = malloc((size_t)l->n_nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) marks[i] = owner[i] == rank || is_common[i];
    for (int ring = 0; ring < n_rings; ring++) {
        memcpy(before, marks, (size_t)l->n_nodes);
        for (dem_index k = 0; k < adjacency_pairs(l); k++) {
            dem_index pair[2];
            adjacency_pair(l, k, pair);
            for (int e = 0; e < 2; e++) marks[pair[e]] |= before[pair[1 - e]];
        }
    }
    return marks;
}

/* Which tuples have all of their nodes among the marked ones. */
static void list(part *p, lattice_items of, const dem_index *node, int arity, dem_index n, const unsigned char *marks)
{
    p->number[of] = malloc(((size_t)n + 1) * sizeof *p->number[of]);
    for (dem_index k = 0; k < n; k++) {
        bool is_in = true;
        for (int c = 0; c < arity; c++) is_in = is_in && marks[node != NULL ? node[arity * k + c] : k];
        if (is_in) p->number[of][p->n[of]++] = k;
    }
}

static part make_part(const dem_lattice *l, const int32_t *owner, const unsigned char *is_common, int rank, int n_rings)
{
    CLEANUP(free_memory) unsigned char *marks = mark(l, owner, is_common, rank, n_rings);
    part p = {.local = malloc((size_t)l->n_nodes * sizeof *p.local)};
    list(&p, LATTICE_NODES, NULL, 1, l->n_nodes, marks);
    list(&p, LATTICE_SPRINGS, l->ends, 2, l->n_springs, marks);
    list(&p, LATTICE_TRIANGLES, l->triangles, 3, l->n_triangles, marks);
    p.owner = malloc(((size_t)p.n[LATTICE_NODES] + 1) * sizeof *p.owner);
    for (dem_index k = 0; k < p.n[LATTICE_NODES]; k++) {
        p.local[p.number[LATTICE_NODES][k]] = k;
        p.owner[k] = owner[p.number[LATTICE_NODES][k]];
    }
    lattice_cut cut = {.node = p.local};
    memcpy(cut.n, p.n, sizeof cut.n);
    for (int k = 0; k < LATTICE_ITEMS; k++) cut.numbers[k] = p.number[k];
    if (lattice_cut_create(&p.lattice, l, &cut) != DEM_OK) p.lattice = dem_lattice_empty();
    return p;
}

/* ---- comparison ---- */

static bool same(const void *a, const void *b, dem_index n, size_t size)
{
    return memcmp(a, b, (size_t)n * size) == 0;
}

static bool same_neighbours(const domain *a, const domain *b)
{
    if (a->n_neighbours != b->n_neighbours) return false;
    for (int k = 0; k < a->n_neighbours; k++) {
        const domain_neighbour *p = &a->neighbours[k], *q = &b->neighbours[k];
        if (p->rank != q->rank || p->n_sent != q->n_sent || p->n_received != q->n_received ||
            !same(p->sent, q->sent, p->n_sent, sizeof *p->sent) ||
            !same(p->received, q->received, p->n_received, sizeof *p->received))
            return false;
    }
    return true;
}

static bool same_lattice(const dem_lattice *a, const dem_lattice *b)
{
    if (a->n_nodes != b->n_nodes || a->n_springs != b->n_springs || a->n_triangles != b->n_triangles) return false;
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const void *p = lattice_array_of(a, &lattice_arrays[k]), *q = lattice_array_of(b, &lattice_arrays[k]);
        if ((p == NULL) != (q == NULL)) return false;
        if (p != NULL && !same(p, q, lattice_count(a, lattice_arrays[k].of), lattice_arrays[k].size)) return false;
    }
    return true;
}

static bool same_rigid(const rigid_bodies *a, const rigid_bodies *b, dem_index n_nodes)
{
    return a->n == b->n && a->n_nodes == b->n_nodes &&
           (a->n == 0 || (same(a->nodes, b->nodes, a->n_nodes, sizeof *a->nodes) &&
                          same(a->of_node, b->of_node, n_nodes, sizeof *a->of_node) &&
                          same(a->shapes, b->shapes, 2 * a->n_nodes, sizeof *a->shapes)));
}

/* \return the first thing in which they differ; NULL: in nothing */
static const char *compare(const domain_cut *a, const domain_cut *b)
{
    const domain *d = a->model->domain, *e = b->model->domain;
    const dem_index n = d->n_nodes;
    if (n != e->n_nodes || !same(d->number, e->number, n, sizeof *d->number)) return "nodes";
    if (d->n_whole != e->n_whole || d->n_springs != e->n_springs || d->n_triangles != e->n_triangles) return "counts";
    if (d->n_rings != e->n_rings) return "rings";
    if (!same(d->is_own, e->is_own, n, 1) || !same(d->is_ghost, e->is_ghost, n, 1) ||
        !same(d->is_common, e->is_common, n, 1) || !same(d->is_outer, e->is_outer, n, 1))
        return "marks";
    if (!same_neighbours(d, e)) return "neighbours";
    if (!same_lattice(&a->around, &b->around)) return "lattices";
    if (!same(d->spring, e->spring, a->around.n_springs, sizeof *d->spring)) return "springs";
    if (!same(a->triangle, b->triangle, a->around.n_triangles, sizeof *a->triangle)) return "triangles";
    if (!same(a->place, b->place, n, sizeof *a->place)) return "places";
    return same_rigid(&a->model->rigid, &b->model->rigid, n) ? NULL : "rigid bodies";
}

/* ---- cuts ---- */

/* Where the motion starts at x a part that ends with its cut has no positions. */
static void drop_positions(dem_lattice *of_part, const dem_lattice *whole)
{
    if (whole->position != whole->x) return;
    free(of_part->position);
    of_part->position = NULL;
}

static const char *cut_part(const ranks *r, const shared *s, const whole_lattice *whole, const domain_cut *expected)
{
    const int most = s->shares.n_rings > 0 ? s->shares.n_rings : s->shares.use.most;
    part p = make_part(whole->of.lattice, s->owner, whole->is_common, r->rank, most + 1);
    rigid_bodies rigid = {0};
    whole_lattice w = {.of = whole->of};
    domain_cut c = {0};
    whole_parts of = whole->of;
    of.lattice = &p.lattice;
    of.rigid = &rigid;
    of.counting = r;
    for (int k = 0; k < LATTICE_ITEMS; k++) of.number[k] = p.number[k];
    domain_model_shares shares = s->shares;
    shares.owner = p.owner;
    dem_status status = rigid_bodies_compile(&rigid, &p.lattice);
    drop_positions(&p.lattice, whole->of.lattice);
    const bool is_whole = p.lattice.n_nodes == whole->of.lattice->n_nodes;
    const dem_status opened = whole_lattice_open(&w, &of, r->size, &shares);
    if (status == DEM_OK) status = opened;
    if (status == DEM_OK) status = domain_cut_open(&c);
    if (status == DEM_OK) status = domain_cut_take(&c, &w, r->rank, &p.lattice);
    const char *difference = status != DEM_OK ? "a failure" : compare(&c, expected);
    if (is_whole && r->size > 2) difference = "the part is the whole";
    if (p.lattice.x != NULL) difference = "the part is still there";
    domain_cut_close(&c, false);
    whole_lattice_close(&w);
    rigid_bodies_free(&rigid);
    free_part(&p);
    return difference;
}

static void cut_both(const ranks *r, void *context)
{
    shared *s = context;
    const whole_parts of = whole_parts_of(s->whole);
    whole_lattice w;
    domain_cut c = {0};
    dem_status status = whole_lattice_open(&w, &of, r->size, &s->shares);
    if (status == DEM_OK) status = domain_cut_open(&c);
    if (status == DEM_OK) status = domain_cut_fill(&c, &w, r->rank);
    s->difference[r->rank] = status == DEM_OK ? cut_part(r, s, &w, &c) : "a failure of the whole";
    domain_cut_close(&c, false);
    whole_lattice_close(&w);
}

static void check(const dem_model *whole, domain_model_shares shares)
{
    CLEANUP(free_memory) int32_t *owner = shared_owners(&whole->lattice, N_RANKS);
    shared s = {.whole = whole, .owner = owner, .shares = shares};
    s.shares.owner = owner;
    rank_threads_run(N_RANKS, cut_both, &s);
    for (int k = 0; k < N_RANKS; k++)
        if (s.difference[k] != NULL) fail_msg("rank %d: %s", k, s.difference[k]);
}

static dem_lattice make_disc(void)
{
    const dem_material solid =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1050.0, .thickness = 1.0);
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&l, 0.06, 2.5e-3));
    assert_ok(dem_lattice_assemble(&l, &solid));
    return l;
}

/* Rings are given, or as many as all ranks together have room for. */
TEST(a_domain_cut_from_a_part_is_that_of_the_whole)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_disc();
    CLEANUP(free_model) dem_model *whole = support_model(&l, NULL, 0);
    check(whole, (domain_model_shares){.n_rings = 1});
    check(whole, (domain_model_shares){.n_rings = 3});
    for (int share = 1; share <= 4; share++) {
        const ring_use use = {3, 2, {1, share}, {1, share}};
        check(whole, (domain_model_shares){.use = use});
    }
}

static const double floor_points[] = {-1.0, -1.0, 1.0, -1.0};

/* Beside a rigid body, where what may touch is common. */
TEST(common_nodes_and_rigid_bodies_are_those_of_the_whole)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_disc();
    CLEANUP(dem_lattice_free) dem_lattice other = shared_disc();
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 1.0);
    assert_ok(dem_lattice_stiffen(&other, DEM_GUIDE_Y));
    dem_lattice_move(&other, 0.2, (const double[2]){0.12, 0.01});
    assert_ok(dem_lattice_append(&l, &other));
    CLEANUP(free_model) dem_model *whole = support_model(&l, &floor, 1);
    check(whole, (domain_model_shares){.n_rings = 1});
    check(whole, (domain_model_shares){.n_rings = 2});
}
