/* SPDX-License-Identifier: BSD-3-Clause */
/* region.c and slab_rows.c: what a rank gathers from slabs is what is cut from the whole lattice about its nodes, to
 * the bit. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "domain/adjacency.h"
#include "domain/region.h"
#include "harness/cleanup.h"
#include "harness/message.h"
#include "harness/rank_threads.h"
#include "lattice/lattice.h"
#include "lattice/lattice_cut.h"

enum { MOST = 5 };
static const double spacing = 0.01;

/* ---- a lattice, whole and in slabs ---- */

static const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1050.0,
                                         .thickness = 0.1, .guard = 0.02, .springs = DEM_SPRINGS_COUPLED);

/* Flags and numbers of bodies are there. */
static void complete(dem_lattice *l)
{
    assert_ok(dem_lattice_assemble(l, &rubber));
    assert_ok(dem_lattice_exclude(l, NULL, 0));
    l->body = lattice_zeros(l->n_nodes, sizeof *l->body);
}

static dem_lattice make_whole(double height)
{
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&l, 12.0 * spacing, height, spacing));
    assert_ok(dem_lattice_jitter(&l, 0.2 * spacing, 3));
    complete(&l);
    return l;
}

static void make_slabs(dem_slab *list, double height, int n)
{
    for (int k = 0; k < n; k++) {
        list[k] = dem_slab_empty();
        assert_ok(dem_slab_rectangle(&list[k], 12.0 * spacing, height, spacing, k, n));
        assert_ok(dem_slab_jitter(&list[k], 0.2 * spacing, 3));
        complete(&list[k].lattice);
    }
}

/* ---- ranks ---- */

typedef struct recipe {
    bool has_common; /* whether nodes are marked */
    int common_rings, rings;
} recipe;

typedef struct scene {
    dem_slab slabs[MOST];
    recipe extent;
    region found[MOST];
    dem_status status[MOST];
    char message[MOST][256];
} scene;

/* Whether a node of the whole is marked: those on the boundary, and some others. */
static bool is_marked(const dem_lattice *l, dem_index i, dem_index number)
{
    return (l->flags[i] & DEM_NODE_CONTACT) != 0 || number % 17 == 3;
}

/* All of the rim is marked, which counts for nothing. */
static unsigned char *make_marks(const dem_slab *s)
{
    const dem_lattice *l = &s->lattice;
    unsigned char *marks = malloc((size_t)l->n_nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const bool is_own = i >= s->first_own && i < s->first_own + s->n_own;
        marks[i] = !is_own || is_marked(l, i, s->first_node + i - s->first_own);
    }
    return marks;
}

static void gather(const ranks *r, void *context)
{
    scene *s = context;
    const recipe *e = &s->extent;
    CLEANUP(free_memory) unsigned char *marks = e->has_common ? make_marks(&s->slabs[r->rank]) : NULL;
    const region_extent extent = {marks, e->common_rings, e->rings};
    slab_rows rows;
    s->found[r->rank] = (region){.lattice = dem_lattice_empty()};
    s->status[r->rank] = slab_rows_create(&rows, r, &s->slabs[r->rank]);
    if (s->status[r->rank] == DEM_OK) s->status[r->rank] = region_create(&s->found[r->rank], &rows, &extent);
    (void)strncpy(s->message[r->rank], dem_status_message(), sizeof s->message[0] - 1);
    slab_rows_free(&rows);
}

static void free_scene(scene *s, int n)
{
    for (int k = 0; k < n; k++) {
        dem_slab_free(&s->slabs[k]);
        region_free(&s->found[k]);
    }
}

/* ---- expected ---- */

static void add_ring(const dem_lattice *l, bool *marked)
{
    bool *before = malloc((size_t)l->n_nodes * sizeof *before);
    dem_index pair[2];
    memcpy(before, marked, (size_t)l->n_nodes * sizeof *before);
    for (dem_index k = 0; k < adjacency_pairs(l); k++) {
        adjacency_pair(l, k, pair);
        if (before[pair[0]]) marked[pair[1]] = true;
        if (before[pair[1]]) marked[pair[0]] = true;
    }
    free(before);
}

/* Own nodes and common ones, with their rings. */
static void mark_region(const dem_lattice *l, const dem_slab *s, const recipe *e, bool *marked)
{
    const dem_index begin = s->first_node;
    for (dem_index i = 0; i < l->n_nodes; i++) marked[i] = e->has_common && is_marked(l, i, i);
    for (int ring = 0; ring < e->common_rings; ring++) add_ring(l, marked);
    for (dem_index i = begin; i < begin + s->n_own; i++) marked[i] = true;
    for (int ring = 0; ring < e->rings; ring++) add_ring(l, marked);
}

static void list_entire(lattice_cut *c, dem_index *list, lattice_items of, const dem_lattice *l, const bool *marked)
{
    const int arity = of == LATTICE_SPRINGS ? 2 : 3;
    const dem_index *corner = of == LATTICE_SPRINGS ? l->ends : l->triangles;
    for (dem_index k = 0; k < lattice_count(l, of); k++) {
        bool entire = true;
        for (int q = 0; q < arity; q++) entire = entire && marked[corner[arity * k + q]];
        if (entire) list[c->n[of]++] = k;
    }
    c->numbers[of] = list;
}

static void assert_marks(const region *g, bool has_common)
{
    assert_int_equal(g->is_common != NULL, has_common);
    for (dem_index i = 0; has_common && i < g->lattice.n_nodes; i++)
        assert_int_equal(g->is_common[i], is_marked(&g->lattice, i, g->number[LATTICE_NODES][i]));
}

static void assert_same(const region *g, const dem_lattice *expected, const lattice_cut *c)
{
    for (int of = 0; of < LATTICE_ITEMS; of++) {
        assert_int_equal(lattice_count(&g->lattice, (lattice_items)of), c->n[of]);
        assert_memory_equal(g->number[of], c->numbers[of], (size_t)c->n[of] * sizeof *g->number[of]);
    }
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        const void *here = lattice_array_of(&g->lattice, a), *there = lattice_array_of(expected, a);
        assert_int_equal(here != NULL, there != NULL);
        if (here != NULL) assert_memory_equal(here, there, (size_t)c->n[a->of] * a->size);
    }
}

static void check(const dem_lattice *whole, const scene *s, int rank)
{
    CLEANUP(free_memory) bool *marked = malloc((size_t)whole->n_nodes * sizeof *marked);
    CLEANUP(free_memory) dem_index *node = malloc((size_t)whole->n_nodes * sizeof *node);
    CLEANUP(free_memory) dem_index *place = malloc((size_t)whole->n_nodes * sizeof *place);
    CLEANUP(free_memory) dem_index *spring = malloc((size_t)whole->n_springs * sizeof *spring);
    CLEANUP(free_memory) dem_index *triangle = malloc((size_t)whole->n_triangles * sizeof *triangle);
    CLEANUP(dem_lattice_free) dem_lattice expected = dem_lattice_empty();
    lattice_cut c = {.numbers = {node}, .node = place};
    mark_region(whole, &s->slabs[rank], &s->extent, marked);
    for (dem_index i = 0; i < whole->n_nodes; i++) {
        place[i] = c.n[LATTICE_NODES];
        if (marked[i]) node[c.n[LATTICE_NODES]++] = i;
    }
    list_entire(&c, spring, LATTICE_SPRINGS, whole, marked);
    list_entire(&c, triangle, LATTICE_TRIANGLES, whole, marked);
    assert_ok(lattice_cut_create(&expected, whole, &c));
    assert_same(&s->found[rank], &expected, &c);
    assert_marks(&s->found[rank], s->extent.has_common);
}

/* ---- tests ---- */

static void compare(double height, recipe extent)
{
    CLEANUP(dem_lattice_free) dem_lattice whole = make_whole(height);
    for (int n = 1; n <= MOST; n++) {
        scene s = {.extent = extent};
        make_slabs(s.slabs, height, n);
        rank_threads_run(n, gather, &s);
        for (int k = 0; k < n; k++) {
            assert_int_equal(s.status[k], DEM_OK);
            check(&whole, &s, k);
        }
        free_scene(&s, n);
    }
}

TEST(a_region_has_own_nodes_and_rings_about_them)
{
    for (int rings = 0; rings < 4; rings++) compare(0.3, (recipe){.rings = rings});
}

TEST(a_region_has_nodes_that_are_marked_on_any_rank)
{
    compare(0.3, (recipe){.has_common = true});
    compare(0.3, (recipe){.has_common = true, .rings = 2});
    compare(0.3, (recipe){.has_common = true, .common_rings = 2, .rings = 1});
}

/* Of 8 rows. */
TEST(rings_go_over_several_slabs)
{
    compare(0.06, (recipe){.has_common = true, .common_rings = 4, .rings = 5});
}

static void expect_refusal(scene *s, int n, const char *message)
{
    rank_threads_run(n, gather, s);
    for (int k = 0; k < n; k++) {
        assert_int_equal(s->status[k], DEM_ERROR_ARGUMENT);
        assert_true(message_has_parts(s->message[k], message));
    }
}

TEST(slabs_that_do_not_make_a_whole_are_refused_on_all_ranks)
{
    scene s = {.extent = {.rings = 1}};
    make_slabs(s.slabs, 0.3, 3);
    s.slabs[1].first_node++;
    expect_refusal(&s, 3, "the slab of rank 1 begins with node");
    s.slabs[1].first_node--;
    expect_refusal(&s, 2, "the slabs of 2 ranks have");
    free(s.slabs[2].lattice.modulus);
    s.slabs[2].lattice.modulus = NULL;
    expect_refusal(&s, 3, "the slabs do not have the same arrays");
    free_scene(&s, 3);
}
