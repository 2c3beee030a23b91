/* SPDX-License-Identifier: BSD-3-Clause */
/* mesh_edges.c: the sides of triangles in order, and the nodes on the boundary. */
#include "verification/support.h"

#include <string.h>

#include "lattice/mesh_edges.h"

/* Two triangles on the diagonal 0-2 of a square, the second numbered from another corner. */
static double square_x[8] = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0};
static dem_index square_corners[6] = {0, 1, 2, 3, 0, 2};

static dem_lattice square(void)
{
    return (dem_lattice){.struct_size = sizeof(dem_lattice),
                         .dim = 2,
                         .n_nodes = 4,
                         .n_triangles = 2,
                         .x = square_x,
                         .triangles = square_corners};
}

TEST(sides_are_sorted_by_lower_node_then_upper_node_then_triangle)
{
    static const dem_index row[5] = {0, 4, 5, 6, 6}, upper[6] = {1, 2, 2, 3, 2, 3}, triangle[6] = {0, 0, 1, 1, 0, 1};
    const dem_lattice lattice = square();
    mesh_edges s;
    assert_ok(mesh_edges_create(&s, &lattice));
    assert_memory_equal(s.row, row, sizeof row);
    for (int p = 0; p < 6; p++) {
        assert_int_equal(s.list[p].upper, upper[p]);
        assert_int_equal(s.list[p].triangle, triangle[p]);
    }
    mesh_edges_free(&s);
    assert_null(s.list);
}

TEST(an_edge_between_two_triangles_begins_once)
{
    static const int begins[4] = {1, 1, 0, 1};
    const dem_lattice lattice = square();
    CLEANUP(mesh_edges_free) mesh_edges s;
    assert_ok(mesh_edges_create(&s, &lattice));
    for (int p = 0; p < 4; p++) assert_int_equal(mesh_edges_is_first(&s, 0, p), begins[p]);
    assert_true(mesh_edges_is_first(&s, 1, 4)); /* also where the row before ends with the same upper node */
    assert_true(mesh_edges_is_first(&s, 2, 5));
    for (int p = 0; p < 4; p++) assert_int_equal(mesh_edges_is_boundary(&s, 0, p), p == 0 || p == 3);
    assert_true(mesh_edges_is_boundary(&s, 1, 4) && mesh_edges_is_boundary(&s, 2, 5));
}

/* Slots counted as the documentation says: a hexagon of 6 triangles has 12 edges, 6 of them inside. */
TEST(every_triangle_has_its_three_sides_in_the_list)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    CLEANUP(mesh_edges_free) mesh_edges s;
    int slots = 0, edges = 0, of_triangle[6] = {0};
    assert_ok(dem_lattice_disc(&lattice, 1.0, 1.0));
    assert_int_equal(lattice.n_triangles, 6);
    assert_ok(mesh_edges_create(&s, &lattice));
    for (dem_index i = 0; i < lattice.n_nodes; i++)
        for (dem_index p = s.row[i]; p < s.row[i + 1]; p++) {
            slots++;
            edges += mesh_edges_is_first(&s, i, p);
            of_triangle[s.list[p].triangle]++;
            assert_true(s.list[p].upper > i);
        }
    assert_int_equal(slots, 18);
    assert_int_equal(edges, 12);
    for (int k = 0; k < 6; k++) assert_int_equal(of_triangle[k], 3);
}

TEST(the_nodes_of_boundary_edges_may_touch_and_those_inside_may_not)
{
    unsigned char flags[7];
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&lattice, 1.0, 1.0));
    memset(flags, 0xff, sizeof flags);
    assert_ok(mesh_edges_contact_flags(flags, &lattice));
    for (dem_index i = 0; i < 7; i++) {
        const int inside = hypot(lattice.x[2 * i], lattice.x[2 * i + 1]) < 0.5;
        assert_int_equal(flags[i], inside ? 0 : DEM_NODE_CONTACT);
    }
}

static bool away_from_the_middle(void *context, const double *x)
{
    (void)context;
    return hypot(x[0], x[1]) > 0.5;
}

/* Around a hole of one node the six neighbours come to lie on a boundary: all nodes of the second ring and the
 * first. */
TEST(the_rim_of_a_hole_is_boundary_too)
{
    unsigned char flags[19];
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&lattice, 2.0, 1.0));
    assert_int_equal(lattice.n_nodes, 19);
    assert_ok(mesh_edges_contact_flags(flags, &lattice));
    int boundary = 0;
    for (int i = 0; i < 19; i++) boundary += flags[i];
    assert_int_equal(boundary, 12 * DEM_NODE_CONTACT);
    assert_ok(dem_lattice_cut(&lattice, away_from_the_middle, NULL));
    assert_int_equal(lattice.n_nodes, 18);
    assert_ok(mesh_edges_contact_flags(flags, &lattice));
    for (int i = 0; i < 18; i++) assert_int_equal(flags[i], DEM_NODE_CONTACT);
}

TEST(a_node_of_no_triangle_may_not_touch_where_others_have_some)
{
    unsigned char flags[4] = {9, 9, 9, 9};
    dem_lattice lattice = square();
    lattice.n_triangles = 1;
    assert_ok(mesh_edges_contact_flags(flags, &lattice));
    for (int i = 0; i < 4; i++) assert_int_equal(flags[i], i == 3 ? 0 : DEM_NODE_CONTACT);
}

TEST(every_node_may_touch_where_there_are_no_triangles)
{
    unsigned char flags[4] = {9, 9, 9, 9};
    dem_lattice lattice = square();
    lattice.n_triangles = 0;
    assert_ok(mesh_edges_contact_flags(flags, &lattice));
    for (int i = 0; i < 4; i++) assert_int_equal(flags[i], DEM_NODE_CONTACT);
}
