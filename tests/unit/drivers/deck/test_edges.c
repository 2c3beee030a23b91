/* SPDX-License-Identifier: BSD-3-Clause */
/* edges.c: nodes of rectangles and discs, turned, beside what their places say. */
#include "unit/reading.h"

#include <math.h>
#include <stdio.h>

#include "ask.h"
#include "edges.h"

/* Of one body; nodes on the boundary may touch. */
static dem_model *make_model(double (*size)[2], double radius, double angle)
{
    const dem_material solid =
        SIZED(dem_material, .youngs_modulus = 1.0, .poissons_ratio = 0.3, .density = 1.0, .thickness = 1.0);
    dem_lattice l = dem_lattice_empty();
    dem_model *model;
    if (size != NULL)
        assert_int_equal(dem_lattice_rectangle(&l, (*size)[0], (*size)[1], 0.1), DEM_OK);
    else
        assert_int_equal(dem_lattice_disc(&l, radius, 0.1), DEM_OK);
    assert_int_equal(dem_lattice_assemble(&l, &solid), DEM_OK);
    dem_lattice_move(&l, angle, (const double[2]){3.0, -2.0});
    assert_int_equal(dem_model_create(&model, &l, NULL, 0), DEM_OK);
    dem_lattice_free(&l);
    return model;
}

/* Nodes that are on a stepped edge, and those on the boundary. */
typedef struct counts {
    dem_index stepped, boundary;
} counts;

static counts count(const char *body, const dem_model *model)
{
    resolved r = resolve(body);
    const dem_lattice *l = dem_model_lattice(model);
    counts n = {0, 0};
    for (dem_index i = 0; i < l->n_nodes; i++) {
        n.stepped += edges_stepped(&r.deck, l, ask_sizes(model).n_bodies, i);
        n.boundary += (l->flags[i] & DEM_NODE_CONTACT) != 0;
    }
    drop_resolved(&r);
    return n;
}

#define DISC "&body shape = 'disc', radius = 1, spacing = 0.1 /\n"

TEST(a_disc_has_a_stepped_edge_and_a_mesh_has_none)
{
    CLEANUP(free_model) dem_model *model = make_model(NULL, 1.0, 0.0);
    const counts n = count(DISC, model);
    assert_int_equal(n.stepped, n.boundary);
    assert_true(n.boundary > 20);
    assert_int_equal(count("&body shape = 'mesh', file = 'a.msh' /\n", model).stepped, 0);
    assert_int_equal(count("&body shape = 'file', file = 'a.h5' /\n", model).stepped, 0);
}

/* Rows of 0.0866 m, of which 0.8 m has 10 with 11 and 10 nodes by turns: the lower and the upper side have 21 of them,
 * and 8 rows between have both their ends on the zigzag sides. */
TEST(of_a_rectangle_of_triangles_the_sides_along_the_rows_are_straight)
{
    double size[2] = {1.0, 0.8};
    const double angle = 30.0;
    CLEANUP(free_model) dem_model *model = make_model(&size, 0.0, angle * 3.14159265358979323846 / 180.0);
    const counts n = count("&body shape = 'rectangle', size = 1, 0.8, spacing = 0.1, angle = 30 /\n", model);
    assert_true(n.stepped > 0 && n.stepped < n.boundary);
    assert_int_equal(n.boundary - n.stepped, 21);
    const counts wrong = count("&body shape = 'rectangle', size = 1, 0.8, spacing = 0.1, angle = 20 /\n", model);
    assert_int_equal(wrong.boundary - wrong.stepped, 2); /* two corners */
}

TEST(nothing_is_said_of_bodies_that_are_not_those_of_the_deck)
{
    CLEANUP(free_model) dem_model *model = make_model(NULL, 1.0, 0.0);
    assert_int_equal(count(DISC DISC, model).stepped, 0);
}
