/* SPDX-License-Identifier: BSD-3-Clause */
/* touching_bodies.c: the boundary and the sums over bodies. */
#include "model/touching_bodies.h"

#include "base/vec2.h"
#include "verification/support.h"

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);

/* Of two squares. Sums in the order of springs and triangles are off by a rounding for each of these at most. */
TEST(bodies_have_their_boundary_and_their_sums)
{
    CLEANUP(dem_lattice_free) dem_lattice l = support_squares(0.02, 0.01, &rubber, (const double[2]){0.05, 0.0});
    CLEANUP(touching_bodies_free) touching_bodies o;
    double sums[2] = {0.0, 0.0};
    for (dem_index k = 0; k < l.n_springs; k++) sums[l.body[l.ends[2 * k]]] += l.stiffness[k] * l.rest_length[k];
    assert_ok(touching_bodies_create(&o, &l));
    assert_int_equal(o.n_bodies, 2);
    assert_true(o.boundary.n > 0);
    for (dem_index k = 0; k < o.boundary.n; k++) {
        const mesh_boundary_edge *e = &o.boundary.list[k];
        assert_int_equal(l.body[e->lower], l.body[l.triangles[3 * e->triangle]]);
    }
    for (int b = 0; b < 2; b++) {
        double area = 0.0;
        for (dem_index k = 0; k < l.n_triangles; k++)
            if (l.body[l.triangles[3 * k]] == b) area += vec2_area_of(l.x, &l.triangles[3 * k]);
        assert_close(o.bodies[b].area, area, 1e-15 * (double)l.n_triangles * area);
        assert_close(o.bodies[b].springs, sums[b], 1e-15 * (double)l.n_springs * sums[b]);
        assert_true(area > 0.0);
    }
}

TEST(nodes_of_a_part_have_their_numbers_in_the_whole)
{
    dem_index number[] = {3, 7};
    const domain d = {.n_nodes = 2, .number = number};
    const touching_bodies whole = {.domain = NULL}, part = {.domain = &d};
    assert_int_equal(touching_bodies_node(NULL, 1), 1);
    assert_int_equal(touching_bodies_node(&whole, 1), 1);
    assert_int_equal(touching_bodies_node(&part, 1), 7);
}
