/* SPDX-License-Identifier: BSD-3-Clause */
/* edges.c: the lattices of decks, turned, beside what is known of their nodes: a row has so many of them. */
#include "unit/reading.h"

#include <math.h>
#include <stdlib.h>

#include "body_geometry.h"
#include "edges.h"

static const double degree = 3.14159265358979323846 / 180.0;

#define RUN     "&run t_end = 1 /\n&material youngs_modulus = 1e7, density = 1000 /\n"
#define FINE    ", spacing = 0.1"
#define SPACING FINE ", outline = 'lattice'"
#define SQUARES SPACING ", lattice = 'square'"
#define TURNED  ", angle = 30"
#define DISC    "&body shape = 'disc', radius = 1" SPACING " /\n"
#define RING    "&body shape = 'ring', radius = 1, inner_radius = 0.5" SPACING " /\n"
#define BLOCK   "&body shape = 'rectangle', size = 1, 0.8"

static const dem_material rubber = {
    .struct_size = sizeof rubber, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1e3, .thickness = 1.0};

/* The first body of a text after the groups of RUN, as it is in a run. */
typedef struct built {
    resolved deck;
    dem_lattice lattice;
} built;

static built build(const char *text)
{
    char all[1024];
    body_geometry geometry;
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    assert_true((size_t)snprintf(all, sizeof all, RUN "%s", text) < sizeof all);
    built b = {.deck = resolve_clean(all)};
    if (body_geometry_triangulate(&b.lattice, &geometry, &b.deck.deck, 0, "", &errors) != DEM_OK)
        fail_msg("'%s' gives '%s'", text, errors.n > 0 ? errors.list[0].text : "no memory");
    const double angle = degree * schema_real(schema_get(&b.deck.deck, "body", 0), "angle");
    dem_lattice_move(&b.lattice, angle, (const double[2]){3.0, -2.0});
    free(body_geometry_take_numbers(&b.lattice));
    assert_int_equal(dem_lattice_assemble(&b.lattice, &rubber), DEM_OK);
    return b;
}

static void drop_built(built *b)
{
    drop_resolved(&b->deck);
    dem_lattice_free(&b->lattice);
}

/* Nodes that are on a stepped edge, and those on the boundary. */
typedef struct counts {
    dem_index stepped, boundary;
} counts;

static counts count_nodes(const schema_deck *deck, const dem_lattice *l)
{
    CLEANUP(free_model) dem_model *model;
    CLEANUP(free_memory) dem_index *n_edges = malloc((size_t)l->n_nodes * sizeof *n_edges);
    counts n = {0, 0};
    assert_non_null(n_edges);
    assert_int_equal(dem_lattice_rims(l, n_edges), DEM_OK);
    assert_int_equal(dem_model_create(&model, l, NULL, 0), DEM_OK);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const bool stepped = edges_stepped(deck, model, i);
        if (stepped && n_edges[i] == 0) fail_msg("node %lld is inside", (long long)i);
        n.stepped += stepped;
        n.boundary += n_edges[i] > 0;
    }
    return n;
}

static counts count(const char *text)
{
    CLEANUP(drop_built) built b = build(text);
    return count_nodes(&b.deck.deck, &b.lattice);
}

static void expect_straight(const char *text, dem_index straight)
{
    const counts n = count(text);
    if (n.boundary - n.stepped != straight)
        fail_msg("'%s' has %lld nodes of %lld on no stepped edge, not %lld", text, (long long)(n.boundary - n.stepped),
                 (long long)n.boundary, (long long)straight);
}

/* Whether the node at a place of the body, in its own coordinates, is on a stepped edge. */
static bool is_stepped_at(const built *b, double x, double y)
{
    CLEANUP(free_model) dem_model *model;
    const dem_lattice *l = &b->lattice;
    const double angle = degree * schema_real(schema_get(&b->deck.deck, "body", 0), "angle");
    const double at[2] = {3.0 + cos(angle) * x - sin(angle) * y, -2.0 + sin(angle) * x + cos(angle) * y};
    assert_int_equal(dem_model_create(&model, l, NULL, 0), DEM_OK);
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (hypot(l->x[2 * i] - at[0], l->x[2 * i + 1] - at[1]) < 1e-9) return edges_stepped(&b->deck.deck, model, i);
    fail_msg("no node at (%g, %g) m", x, y);
    return false;
}

TEST(the_edges_of_a_disc_and_of_a_ring_are_stepped)
{
    expect_straight(DISC, 0);
    expect_straight(RING, 0);
    expect_straight("&body shape = 'disc', radius = 1" SQUARES " /\n", 0);
    expect_straight("&body shape = 'ring', radius = 1, inner_radius = 0.5" SQUARES TURNED " /\n", 0);
    assert_true(count(RING).boundary > count(DISC).boundary && count(DISC).boundary > 20);
}

TEST(meshes_and_files_have_no_stepped_edges)
{
    CLEANUP(drop_built) built b = build(RING);
    CLEANUP(drop_resolved) resolved mesh = resolve("&body shape = 'mesh', file = 'a.msh' /\n");
    CLEANUP(drop_resolved) resolved file = resolve("&body shape = 'file', file = 'a.h5' /\n");
    assert_int_equal(count_nodes(&mesh.deck, &b.lattice).stepped, 0);
    assert_int_equal(count_nodes(&file.deck, &b.lattice).stepped, 0);
}

/* Cracks are as wide as a row of triangles, and their faces are steps. */
TEST(smooth_outlines_have_stepped_edges_at_cracks_only)
{
    const char *ring = "&body shape = 'ring', radius = 1, inner_radius = 0.5, outline = 'smooth'" FINE " /\n";
    char cracked[512];
    assert_int_equal(count(ring).stepped, 0);
    assert_int_equal(count(BLOCK FINE ", outline = 'smooth' /\n&void centre = 0, 0.4, radius = 0.2 /\n").stepped, 0);
    (void)snprintf(cracked, sizeof cracked, "%s&crack points = 0.6, 0, 0.9, 0.1 /\n", ring);
    assert_true(count(cracked).stepped > 0);
}

/* Rows of 0.0866 m, of which 0.8 m has 10 with 11 and 10 nodes by turns: the lower and the upper side have 21 of them,
 * and their corners are the ends of the zigzag sides, too. */
TEST(of_a_rectangle_of_triangles_the_sides_along_the_rows_are_straight)
{
    expect_straight(BLOCK SPACING " /\n", 21 - 4);
    expect_straight(BLOCK SPACING TURNED " /\n", 21 - 4);
}

/* 10 times 8 cells. */
TEST(a_rectangle_of_squares_has_no_stepped_edge)
{
    expect_straight(BLOCK SQUARES " /\n", 2 * (10 + 8));
    expect_straight(BLOCK SQUARES TURNED " /\n", 2 * (10 + 8));
}

/* It has the boundary of the block without it, and its own. */
TEST(the_edge_of_a_void_is_stepped)
{
    static const char *const voids[] = {"radius = 0.25", "shape = 'ring', radius = 0.28, inner_radius = 0.15",
                                        "shape = 'rectangle', size = 0.4, 0.4",
                                        "shape = 'polygon', points = -0.3, -0.3, 0.3, -0.3, 0, 0.2"};
    for (size_t k = 0; k < sizeof voids / sizeof *voids; k++) {
        char text[512];
        (void)snprintf(text, sizeof text,
                       BLOCK SQUARES TURNED ", disconnected = 'keep' /\n&void centre = 0, 0.4, %s /\n", voids[k]);
        assert_true(count(text).boundary > 36 + 8);
        expect_straight(text, 36);
        (void)snprintf(text, sizeof text,
                       BLOCK SPACING TURNED ", disconnected = 'keep' /\n&void centre = 0, 0.4, %s /\n", voids[k]);
        assert_true(count(text).boundary > count(BLOCK SPACING " /\n").boundary + 6);
        expect_straight(text, 21 - 4);
    }
}

/* A quarter of a plate: its peak is where the hole meets a line of symmetry, whose nodes are held and may not touch.
 * The hole takes the cells below 0.3 m on the left, and those before -0.2 m at the bottom. */
TEST(a_hole_is_stepped_where_it_meets_a_side_that_is_held)
{
    CLEANUP(drop_built) built b = build(BLOCK SQUARES TURNED " /\n&void centre = -0.5, 0, radius = 0.25 /\n");
    for (int held = 0; held < 2; held++) {
        assert_true(is_stepped_at(&b, -0.5, 0.3) && is_stepped_at(&b, -0.2, 0.0) && is_stepped_at(&b, -0.4, 0.3));
        assert_false(is_stepped_at(&b, -0.5, 0.4) || is_stepped_at(&b, -0.1, 0.0) || is_stepped_at(&b, 0.5, 0.8));
        for (dem_index i = 0; i < b.lattice.n_nodes; i++)
            assert_int_equal(dem_lattice_exclude(&b.lattice, &i, 1), DEM_OK);
    }
}

/* Of triangles the hole takes the row of 0.1732 m up to -0.3 m; the next one, of 0.2598 m, begins at -0.45 m. */
TEST(a_hole_in_triangles_is_stepped_where_it_meets_a_side)
{
    CLEANUP(drop_built) built b = build(BLOCK SPACING " /\n&void centre = -0.5, 0, radius = 0.25 /\n");
    assert_true(is_stepped_at(&b, -0.2, 0.0) && is_stepped_at(&b, -0.45, 0.15 * sqrt(3.0)));
    assert_false(is_stepped_at(&b, -0.1, 0.0));
}

/* Columns of nodes are at 0.075 m, 0.175 m and so on, so that the lowest row and the first column have 8 cells.
 * The last node of each is the end of a step, too: 8 and 8 nodes with one in common are left. */
TEST(a_polygon_has_straight_sides_along_rows_and_stepped_ones_elsewhere)
{
    expect_straight("&body shape = 'polygon', points = 0, 0, 1.05, 0, 0, 1.05" SQUARES TURNED " /\n", 15);
    expect_straight("&body shape = 'polygon', points = 0, 0, 0, 1.05, 1.05, 0" SQUARES " /\n", 15);
}

/* Of a crack the lattice is without the cells that it crosses. */
TEST(a_crack_is_stepped)
{
    CLEANUP(drop_built)
    built b = build(BLOCK SQUARES " /\n&crack points = -0.6, 0.45, 0, 0.45 /\n");
    assert_true(is_stepped_at(&b, -0.5, 0.5) && is_stepped_at(&b, -0.2, 0.4));
    assert_false(is_stepped_at(&b, -0.5, 0.6) || is_stepped_at(&b, 0.5, 0.4));
}

TEST(of_two_bodies_each_node_counts_with_its_own)
{
    CLEANUP(drop_built) built b = build(BLOCK SQUARES " /\n" DISC);
    CLEANUP(drop_built) built disc = build(DISC);
    assert_int_equal(dem_lattice_append(&b.lattice, &disc.lattice), DEM_OK);
    const counts n = count_nodes(&b.deck.deck, &b.lattice);
    assert_int_equal(n.stepped, count(DISC).stepped);
    assert_int_equal(n.boundary - n.stepped, 36);
}

TEST(nothing_is_said_of_bodies_that_are_not_those_of_the_deck)
{
    CLEANUP(drop_built) built b = build(DISC DISC);
    assert_int_equal(count_nodes(&b.deck.deck, &b.lattice).stepped, 0);
}
