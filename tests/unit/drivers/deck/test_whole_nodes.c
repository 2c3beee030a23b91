/* SPDX-License-Identifier: BSD-3-Clause */
/* whole_nodes.c: two blocks of two rows, of 4 and 3 nodes 1 m apart, the second one 5 m higher and 2 m farther right.
 * Nodes of a row are numbered from left to right. */
#include "unit/close.h"

#include <math.h>
#include <stdlib.h>

#include "unit/solids.h"
#include "whole_nodes.h"

static const double row = 0.86602540378443865; /* m, from one to the next */

static dem_lattice make_blocks(void)
{
    CLEANUP(dem_lattice_free) dem_lattice second = make_solid(3.0, 1.0, 1.0);
    dem_lattice both = make_solid(3.0, 1.0, 1.0);
    assert_int_equal(both.n_nodes, 7);
    dem_lattice_move(&second, 0.0, (const double[2]){2.0, 5.0});
    assert_int_equal(dem_lattice_append(&both, &second), DEM_OK);
    return both;
}

static dem_model *make_model(const dem_lattice *l)
{
    dem_model *model;
    assert_int_equal(dem_model_create(&model, l, NULL, 0), DEM_OK);
    return model;
}

static dem_model *make(void)
{
    CLEANUP(dem_lattice_free) dem_lattice blocks = make_blocks();
    return make_model(&blocks);
}

static void expect(const double x[2], double expected_x, double expected_y)
{
    assert_close(x[0], expected_x, 1e-14);
    assert_close(x[1], expected_y, 1e-14);
}

TEST(a_node_has_a_body_and_a_place)
{
    CLEANUP(free_model) dem_model *model = make();
    double x[2];
    whole_nodes_place(x, model, 5);
    expect(x, 0.0, row);
    whole_nodes_place(x, model, 7);
    expect(x, 0.5, 5.0);
    assert_int_equal(whole_nodes_body(model, 6), 0);
    assert_int_equal(whole_nodes_body(model, 7), 1);
}

/* Of two springs that make a corner. */
TEST(a_spring_has_a_middle_and_a_stiffness)
{
    double x[6] = {0.0, 0.0, 4.0, 0.0, 4.0, 2.0}, masses[3] = {1.0, 1.0, 1.0};
    double lengths[2] = {4.0, 2.0}, stiffnesses[2] = {100.0, 300.0};
    dem_index ends[4] = {0, 1, 1, 2};
    dem_lattice l = dem_lattice_empty();
    l.n_nodes = 3, l.n_springs = 2, l.x = x, l.mass = masses;
    l.ends = ends, l.rest_length = lengths, l.stiffness = stiffnesses;
    CLEANUP(free_model) dem_model *model = make_model(&l);
    const whole_spring first = whole_nodes_spring(model, 0), second = whole_nodes_spring(model, 1);
    expect(first.middle, 2.0, 0.0);
    expect(second.middle, 4.0, 1.0);
    assert_close(second.stiffness, 300.0, 0.0);
}

/* Node 1 has three triangles, and its neighbours in the row are the next nodes of the boundary. */
TEST(the_edges_of_the_boundary_at_a_node_are_those_of_one_triangle)
{
    CLEANUP(free_model) dem_model *model = make();
    double ends[WHOLE_NODES_SIDES][2];
    assert_int_equal(whole_nodes_rim(ends, model, 1), 2);
    const int left = ends[0][0] < ends[1][0] ? 0 : 1;
    expect(ends[left], -1.5, 0.0);
    expect(ends[1 - left], 0.5, 0.0);
}

/* Of three rows node 5 is the middle one. */
TEST(a_node_inside_has_no_edge_of_the_boundary)
{
    CLEANUP(dem_lattice_free) dem_lattice block = make_solid(3.0, 2.0, 1.0);
    CLEANUP(free_model) dem_model *model = make_model(&block);
    double ends[WHOLE_NODES_SIDES][2];
    assert_int_equal(block.n_nodes, 11);
    assert_int_equal(whole_nodes_rim(ends, model, 5), 0);
}

TEST(only_nodes_of_the_same_body_are_ahead)
{
    CLEANUP(free_model) dem_model *model = make();
    const double up[2] = {0.0, 1.0}, down[2] = {0.0, -1.0};
    assert_true(whole_nodes_any_ahead(model, 1, up, 0.99 * row));
    assert_false(whole_nodes_any_ahead(model, 1, up, 1.01 * row));
    assert_false(whole_nodes_any_ahead(model, 5, up, 1e-9));
    assert_false(whole_nodes_any_ahead(model, 8, down, 1e-9));
}
