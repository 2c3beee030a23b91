/* SPDX-License-Identifier: BSD-3-Clause */
/* surface.c: boundary edges that may touch, which way they run, in which order, and where they are listed. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "base/vec2.h"
#include "lattice/mesh_edges.h"
#include "model/surface.h"

enum { MOST_NODES = 64 };

/* A triangulation from literal arrays, every node of which may touch. */
typedef struct body {
    double x[2 * MOST_NODES];
    dem_index corners[3 * MOST_NODES];
    unsigned char flags[MOST_NODES];
    dem_lattice lattice;
} body;

static void body_open(body *b, dem_index n_nodes, const double *x, dem_index n_triangles, const dem_index *corners)
{
    memcpy(b->x, x, 2 * (size_t)n_nodes * sizeof *x);
    memcpy(b->corners, corners, 3 * (size_t)n_triangles * sizeof *corners);
    memset(b->flags, DEM_NODE_CONTACT, sizeof b->flags);
    b->lattice = (dem_lattice){.struct_size = sizeof(dem_lattice),
                               .dim = 2,
                               .n_nodes = n_nodes,
                               .n_triangles = n_triangles,
                               .x = b->x,
                               .triangles = b->corners,
                               .flags = b->flags};
}

/* The unit square 0 1 2 3, the second triangle numbered from another corner. */
static void open_square(body *b)
{
    static const double x[8] = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0};
    static const dem_index corners[6] = {0, 1, 2, 3, 0, 2};
    body_open(b, 4, x, 2, corners);
}

static void check_ends(const surface *s, dem_index n, const dem_index *ends)
{
    assert_int_equal(s->n_edges, n);
    for (dem_index k = 0; k < 2 * n; k++) assert_int_equal(s->ends[k], ends[k]);
}

/* Where an edge is listed: at both its nodes, nowhere else, ascending at each. */
static void check_lists(const surface *s, dem_index n_nodes)
{
    int listed[4 * MOST_NODES] = {0};
    assert_int_equal(s->row[0], 0);
    assert_int_equal(s->row[n_nodes], 2 * s->n_edges);
    for (dem_index i = 0; i < n_nodes; i++)
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
            const dem_index e = s->at[p];
            assert_true(e >= 0 && e < s->n_edges);
            assert_true(s->ends[2 * e] == i || s->ends[2 * e + 1] == i);
            if (p > s->row[i]) assert_true(e > s->at[p - 1]);
            listed[e]++;
        }
    for (dem_index e = 0; e < s->n_edges; e++) assert_int_equal(listed[e], 2);
}

/* Number of closed walks, each of edges one after another; none is left before it closes. */
static int count_loops(const surface *s)
{
    int n = 0;
    dem_index start = 0;
    for (dem_index e = 0; e < s->n_edges; e++) {
        const dem_index to = s->ends[2 * e + 1];
        const bool goes_on = e + 1 < s->n_edges && s->ends[2 * e + 2] == to;
        if (goes_on) continue;
        assert_int_equal(to, s->ends[2 * start]);
        start = e + 1;
        n++;
    }
    return n;
}

/* Twice the area on the left of edges first .. last-1. */
static double swept(const surface *s, const double *x, dem_index first, dem_index last)
{
    double sum = 0.0;
    for (dem_index e = first; e < last; e++)
        sum += vec2_cross(vec2_at(x, s->ends[2 * e]), vec2_at(x, s->ends[2 * e + 1]));
    return sum;
}

TEST(a_square_has_its_four_sides_in_the_order_of_a_walk)
{
    static const dem_index ends[8] = {0, 1, 1, 2, 2, 3, 3, 0};
    static const int32_t row[5] = {0, 2, 4, 6, 8};
    static const dem_index at[8] = {0, 3, 0, 1, 1, 2, 2, 3};
    body b;
    surface s;
    open_square(&b);
    assert_ok(surface_compile(&s, &b.lattice, SURFACE_TOUCHING));
    check_ends(&s, 4, ends);
    assert_memory_equal(s.row, row, sizeof row);
    assert_memory_equal(s.at, at, sizeof at);
    surface_free(&s);
    assert_null(s.ends);
    assert_null(s.row);
    assert_null(s.at);
    assert_int_equal(s.n_edges, 0);
}

/* Every numbering of the corners of one triangle that turns counter-clockwise gives edges that do. */
TEST(an_edge_has_the_body_on_its_left)
{
    static const double at[6] = {0.0, 0.0, 2.0, 0.5, 0.5, 1.0};
    static const dem_index names[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int k = 0; k < 6; k++) {
        double x[6];
        body b;
        CLEANUP(surface_free) surface s;
        for (int q = 0; q < 3; q++) vec2_put(x, names[k][q], vec2_at(at, q));
        body_open(&b, 3, x, 1, names[k]);
        assert_ok(surface_compile(&s, &b.lattice, SURFACE_TOUCHING));
        assert_int_equal(s.n_edges, 3);
        for (dem_index e = 0; e < 3; e++) {
            const vec2 from = vec2_at(x, s.ends[2 * e]), to = vec2_at(x, s.ends[2 * e + 1]);
            const vec2 apex = vec2_at(x, 3 - s.ends[2 * e] - s.ends[2 * e + 1]);
            /* twice the area, 1.75: rounding of products of order 1 */
            assert_close(vec2_cross(vec2_sub(to, from), vec2_sub(apex, from)), 1.75, 1e-15);
        }
    }
}

/* A disc of 18 triangles with sides 1 round a hexagonal hole: the rim encloses 24 triangles, the hole 6 of them, run
 * round the other way. */
static bool away_from_the_middle(void *context, const double *x)
{
    (void)context;
    return hypot(x[0], x[1]) > 0.5;
}

TEST(a_ring_has_two_boundaries_that_run_opposite_ways)
{
    const double hexagon = 1.5 * sqrt(3.0);
    unsigned char flags[18];
    CLEANUP(dem_lattice_free) dem_lattice ring = dem_lattice_empty();
    CLEANUP(surface_free) surface s;
    assert_ok(dem_lattice_disc(&ring, 2.0, 1.0));
    assert_ok(dem_lattice_cut(&ring, away_from_the_middle, NULL));
    assert_ok(mesh_edges_contact_flags(flags, &ring));
    ring.flags = flags;
    assert_ok(surface_compile(&s, &ring, SURFACE_TOUCHING));
    assert_int_equal(s.n_edges, 18);
    assert_int_equal(count_loops(&s), 2);
    check_lists(&s, 18);
    dem_index rim = 1; /* edges of the first boundary */
    while (s.ends[2 * rim - 1] != s.ends[0]) rim++;
    assert_int_equal(rim == 12 ? 6 : 12, 18 - rim);
    const dem_index first = rim == 12 ? 0 : rim, hole = rim == 12 ? rim : 0;
    /* sums of 18 products of order 1 */
    assert_close(swept(&s, ring.x, first, first + 12), 2.0 * 4.0 * hexagon, 1e-13);
    assert_close(swept(&s, ring.x, hole, hole + 6), -2.0 * hexagon, 1e-13);
    ring.flags = NULL;
}

/* Two squares whose nodes are numbered in turns: the boundary of one comes wholly before that of the other. */
TEST(the_boundaries_of_two_bodies_follow_one_another)
{
    static const double x[16] = {0, 0, 5, 0, 1, 0, 6, 0, 1, 1, 6, 1, 0, 1, 5, 1};
    static const dem_index corners[12] = {0, 2, 4, 1, 3, 5, 0, 4, 6, 1, 5, 7};
    static const dem_index ends[16] = {0, 2, 2, 4, 4, 6, 6, 0, 1, 3, 3, 5, 5, 7, 7, 1};
    body b;
    CLEANUP(surface_free) surface s;
    body_open(&b, 8, x, 4, corners);
    assert_ok(surface_compile(&s, &b.lattice, SURFACE_TOUCHING));
    check_ends(&s, 8, ends);
    check_lists(&s, 8);
    assert_int_equal(count_loops(&s), 2);
}

/* Two triangles that share node 2 only: it has four edges, two that end there and two that start there, and the walks
 * close whichever they take. */
TEST(at_a_pinch_node_two_boundaries_meet)
{
    static const double x[10] = {-1, 1, -1, -1, 0, 0, 1, -1, 1, 1};
    static const dem_index corners[6] = {0, 1, 2, 3, 4, 2};
    int starts = 0, stops = 0;
    body b;
    CLEANUP(surface_free) surface s;
    body_open(&b, 5, x, 2, corners);
    assert_ok(surface_compile(&s, &b.lattice, SURFACE_TOUCHING));
    assert_int_equal(s.n_edges, 6);
    check_lists(&s, 5);
    assert_int_equal(s.row[3] - s.row[2], 4);
    for (dem_index p = s.row[2]; p < s.row[3]; p++) {
        starts += s.ends[2 * s.at[p]] == 2;
        stops += s.ends[2 * s.at[p] + 1] == 2;
    }
    assert_int_equal(starts, 2);
    assert_int_equal(stops, 2);
    assert_true(count_loops(&s) >= 1);
    assert_close(swept(&s, x, 0, 6), 4.0, 0.0); /* two triangles of area 1: small integers */
}

TEST(an_edge_between_two_fixed_nodes_is_left_out_and_one_with_one_is_not)
{
    static const dem_index base[6] = {1, 2, 2, 3, 3, 0};
    body b;
    CLEANUP(surface_free) surface s;
    open_square(&b);
    b.flags[1] |= DEM_NODE_FIXED;
    assert_ok(surface_compile(&s, &b.lattice, SURFACE_TOUCHING));
    assert_int_equal(s.n_edges, 4);
    surface_free(&s);
    b.flags[0] |= DEM_NODE_FIXED;
    assert_ok(surface_compile(&s, &b.lattice, SURFACE_TOUCHING));
    assert_int_equal(s.n_edges, 3);
    for (dem_index e = 0; e < 3; e++) {
        int found = 0;
        for (dem_index k = 0; k < 3; k++) found += s.ends[2 * e] == base[2 * k] && s.ends[2 * e + 1] == base[2 * k + 1];
        assert_int_equal(found, 1);
    }
    check_lists(&s, 4);
}

TEST(an_edge_needs_two_nodes_that_may_touch)
{
    static const dem_index ends[4] = {0, 1, 1, 2};
    body b;
    CLEANUP(surface_free) surface s;
    open_square(&b);
    b.flags[3] = 0;
    assert_ok(surface_compile(&s, &b.lattice, SURFACE_TOUCHING));
    check_ends(&s, 2, ends);
    assert_int_equal(s.row[4] - s.row[3], 0);
    check_lists(&s, 4);
    surface_free(&s);
    memset(b.flags, 0, 4);
    assert_ok(surface_compile(&s, &b.lattice, SURFACE_TOUCHING));
    check_ends(&s, 0, ends);
    for (int i = 0; i <= 4; i++) assert_int_equal(s.row[i], 0);
}

TEST(nodes_without_triangles_have_no_edges)
{
    body b;
    CLEANUP(surface_free) surface s;
    open_square(&b);
    b.lattice.n_triangles = 0;
    assert_ok(surface_compile(&s, &b.lattice, SURFACE_TOUCHING));
    assert_int_equal(s.n_edges, 0);
    for (int i = 0; i <= 4; i++) assert_int_equal(s.row[i], 0);
}

/* A fixed edge and one between nodes that may not touch obstacles are edges of the whole surface. */
TEST(the_whole_surface_has_all_boundary_edges)
{
    static const dem_index ends[8] = {0, 1, 1, 2, 2, 3, 3, 0};
    CLEANUP(surface_free) surface s;
    body b;
    open_square(&b);
    b.flags[0] = b.flags[1] = DEM_NODE_FIXED | DEM_NODE_CONTACT;
    b.flags[3] = 0;
    assert_ok(surface_compile(&s, &b.lattice, SURFACE_WHOLE));
    check_ends(&s, 4, ends);
}

/* ---- where triangles are broken ---- */

/* Somewhere in the plate. */
static dem_index inner_node(const dem_lattice *l)
{
    return l->n_nodes / 2 + 5;
}

/* Many triangles here and there, and all those at one node inside. */
static bool is_broken(const dem_lattice *l, dem_index triangle)
{
    const dem_index *corner = &l->triangles[3 * triangle], inner = inner_node(l);
    return triangle * triangle % 11 < 4 || corner[0] == inner || corner[1] == inner || corner[2] == inner;
}

/* A plate and the same one cut, with what may touch: their boundaries. Nodes keep their order. */
typedef struct broken_plate {
    dem_lattice plate, cut;
    unsigned char *broken;
    dem_index *number; /* [n_nodes] in the cut one; -1: it is not there */
} broken_plate;

static void open_plate(broken_plate *b)
{
    *b = (broken_plate){.plate = dem_lattice_empty(), .cut = dem_lattice_empty()};
    assert_ok(dem_lattice_rectangle(&b->plate, 10.0, 8.0, 1.0));
    assert_ok(dem_lattice_rectangle(&b->cut, 10.0, 8.0, 1.0));
    b->broken = calloc((size_t)b->plate.n_triangles, 1);
    b->number = calloc((size_t)b->plate.n_nodes, sizeof *b->number);
    CLEANUP(free_memory) bool *keep = calloc((size_t)b->plate.n_triangles, sizeof *keep);
    assert_true(b->broken && b->number && keep);
    for (dem_index k = 0; k < b->plate.n_triangles; k++) keep[k] = !(b->broken[k] = is_broken(&b->plate, k));
    assert_ok(dem_lattice_trim(&b->cut, keep));
    for (dem_index i = 0, at = 0; i < b->plate.n_nodes; i++) {
        const bool is_there = at < b->cut.n_nodes && memcmp(b->plate.x + 2 * i, b->cut.x + 2 * at, 16) == 0;
        b->number[i] = is_there ? at++ : -1;
    }
    assert_ok(dem_lattice_exclude(&b->plate, NULL, 0)); /* fills the flags */
    assert_ok(dem_lattice_exclude(&b->cut, NULL, 0));
}

/* What may touch of the plate. */
static dem_status compile_broken(surface *out, const broken_plate *b, const unsigned char *excluded)
{
    CLEANUP(mesh_boundary_free) mesh_boundary boundary;
    assert_ok(mesh_boundary_create(&boundary, &b->plate, b->broken));
    const dem_status status = surface_compile_broken(out, &boundary, b->broken, excluded);
    return status;
}

static void close_plate(broken_plate *b)
{
    dem_lattice_free(&b->plate);
    dem_lattice_free(&b->cut);
    free(b->broken);
    free(b->number);
}

static bool has_node(const surface *s, dem_index i)
{
    for (dem_index k = 0; k < s->n_nodes; k++)
        if (s->nodes[k] == i) return true;
    return false;
}

TEST(what_breaks_open_may_touch_like_what_was_cut_before)
{
    CLEANUP(close_plate) broken_plate b;
    CLEANUP(surface_free) surface s, of_cut;
    dem_index n_lone = 0, n_new = 0;
    open_plate(&b);
    assert_ok(compile_broken(&s, &b, NULL));
    assert_ok(surface_compile(&of_cut, &b.cut, SURFACE_TOUCHING));
    assert_int_equal(s.n_edges, of_cut.n_edges);
    for (dem_index k = 0; k < 2 * s.n_edges; k++) assert_int_equal(b.number[s.ends[k]], of_cut.ends[k]);
    for (dem_index k = 0; k < s.n_edges; k++) assert_int_equal(s.next[k], of_cut.next[k]);
    for (dem_index i = 0; i < b.plate.n_nodes; i++) {
        /* A node that has lost all of its triangles is a point that may touch. */
        assert_int_equal(has_node(&s, i), b.number[i] < 0 || has_node(&of_cut, b.number[i]));
        n_lone += b.number[i] < 0;
        n_new += has_node(&s, i) && !(b.plate.flags[i] & DEM_NODE_CONTACT);
    }
    assert_true(n_lone > 0 && n_new > 20);
    assert_false(b.plate.flags[inner_node(&b.plate)] & DEM_NODE_CONTACT);
    assert_int_equal(b.number[inner_node(&b.plate)], -1);
}

/* Fixed nodes, those that are excluded by the caller, and those on the old boundary that were without a flag. */
TEST(some_nodes_never_touch)
{
    CLEANUP(close_plate) broken_plate b;
    CLEANUP(surface_free) surface s, all;
    dem_index kept_out[3] = {-1, -1, -1};
    open_plate(&b);
    assert_ok(compile_broken(&all, &b, NULL));
    CLEANUP(free_memory) unsigned char *excluded = calloc((size_t)b.plate.n_nodes, 1);
    assert_non_null(excluded);
    for (dem_index k = 0; k < all.n_nodes; k++) {
        const dem_index i = all.nodes[k];
        if (b.plate.flags[i] & DEM_NODE_CONTACT)
            kept_out[0] = i;
        else
            kept_out[k % 2 + 1] = i;
    }
    assert_true(kept_out[0] >= 0 && kept_out[1] >= 0 && kept_out[2] >= 0);
    b.plate.flags[kept_out[0]] = 0;
    b.plate.flags[kept_out[1]] = DEM_NODE_FIXED;
    excluded[kept_out[2]] = 1;
    assert_ok(compile_broken(&s, &b, excluded));
    for (int k = 0; k < 3; k++) assert_false(has_node(&s, kept_out[k]));
    assert_int_equal(s.n_nodes, all.n_nodes - 3);
}

/* Nothing is broken: the surface is that of the model. */
TEST(a_whole_body_keeps_its_surface)
{
    CLEANUP(close_plate) broken_plate b;
    CLEANUP(surface_free) surface s, before;
    open_plate(&b);
    memset(b.broken, 0, (size_t)b.plate.n_triangles);
    assert_ok(compile_broken(&s, &b, NULL));
    assert_ok(surface_compile(&before, &b.plate, SURFACE_TOUCHING));
    assert_int_equal(s.n_nodes, before.n_nodes);
    assert_int_equal(s.n_edges, before.n_edges);
    assert_memory_equal(s.nodes, before.nodes, (size_t)s.n_nodes * sizeof *s.nodes);
    assert_memory_equal(s.ends, before.ends, 2 * (size_t)s.n_edges * sizeof *s.ends);
}
