/* SPDX-License-Identifier: BSD-3-Clause */
/* slab_survey.c: the strip that is collected slab by slab has the boundary nodes of the whole, in their order, and all
 * triangles at them, and the shortest side; and parts and hinges are seen wherever the slabs are cut. */
#include "slab_survey.h"

#include "harness/test.h"
#include "unit/close.h"

enum { MOST_SLABS = 6 };

static const double round_void[] = {0.011, 0.035}, far_void[] = {0.03, 0.06}, low_void[] = {0.03, 0.03};

/* A block of 0.06 by 0.09 m, less voids: a disc, and rectangles from side to side but for some of it. */
static const dem_outline block = {
    .struct_size = sizeof block, .kind = DEM_OUTLINE_RECTANGLE, .size = {0.06, 0.09}, .centre = {0.03, 0.045}};

static dem_shape shape_of(const dem_outline *voids, dem_index n_voids)
{
    return (dem_shape){.struct_size = sizeof(dem_shape),
                       .spacing = 3e-3,
                       .grid = DEM_GRID_TRIANGLES,
                       .outline = &block,
                       .voids = voids,
                       .n_voids = n_voids,
                       .name = "block"};
}

static slab_survey look(const dem_shape *shape, dem_index n, double jitter)
{
    const dem_material rubber = {.struct_size = sizeof rubber,
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 0.3,
                                 .density = 1000.0,
                                 .thickness = 1.0};
    slab_survey s = {0};
    for (dem_index part = 0; part < n; part++) {
        CLEANUP(dem_slab_free) dem_slab slab = dem_slab_empty();
        assert_int_equal(dem_slab_shape(&slab, shape, part, n), DEM_OK);
        assert_int_equal(dem_slab_jitter(&slab, jitter, 5), DEM_OK);
        assert_true(slab_survey_add_strip(&s, &slab));
        assert_int_equal(dem_lattice_assemble(&slab.lattice, &rubber), DEM_OK);
        assert_true(slab_survey_add_parts(&s, &slab));
    }
    return s;
}

/* Triangles with a node on the boundary. */
static dem_index count_triangles(const dem_lattice *l, const dem_index *rims)
{
    dem_index n = 0;
    for (dem_index t = 0; t < l->n_triangles; t++)
        n += rims[l->triangles[3 * t]] > 0 || rims[l->triangles[3 * t + 1]] > 0 || rims[l->triangles[3 * t + 2]] > 0;
    return n;
}

static double shortest_side(const dem_lattice *l)
{
    double least = (double)INFINITY;
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
        const double *a = l->x + 2 * l->triangles[k], *b = l->x + 2 * l->triangles[k % 3 == 2 ? k - 2 : k + 1];
        least = fmin(least, hypot(b[0] - a[0], b[1] - a[1]));
    }
    return least;
}

static void check_strip(const dem_shape *shape, dem_index n_slabs, double jitter)
{
    CLEANUP(dem_lattice_free) dem_lattice whole = dem_lattice_empty();
    CLEANUP(dem_lattice_free) dem_lattice strip = dem_lattice_empty();
    CLEANUP(slab_survey_free) slab_survey s = look(shape, n_slabs, jitter);
    assert_int_equal(dem_shape_lattice(&whole, shape, NULL), DEM_OK);
    assert_int_equal(dem_lattice_jitter(&whole, jitter, 5), DEM_OK);
    CLEANUP(free_memory) dem_index *rims = calloc((size_t)whole.n_nodes, sizeof *rims);
    assert_int_equal(dem_lattice_rims(&whole, rims), DEM_OK);
    assert_true(slab_survey_take_strip(&strip, &s));
    assert_int_equal(strip.n_triangles, count_triangles(&whole, rims) + 1);
    assert_close(shortest_side(&strip), shortest_side(&whole), 0.0);
    dem_index k = 0;
    for (dem_index i = 0; i < whole.n_nodes; i++) {
        if (rims[i] == 0) continue;
        while (k < strip.n_nodes && strip.flags[k] == 0) k++;
        assert_true(k < strip.n_nodes);
        assert_memory_equal(strip.x + 2 * k, whole.x + 2 * i, 2 * sizeof *strip.x);
        k++;
    }
    while (k < strip.n_nodes && strip.flags[k] == 0) k++;
    assert_int_equal(k, strip.n_nodes);
}

TEST(the_strip_has_the_boundary_of_the_whole)
{
    const dem_outline voids[] = {{.struct_size = sizeof *voids,
                                  .kind = DEM_OUTLINE_DISC,
                                  .radius = 0.008,
                                  .centre = {round_void[0], round_void[1]}},
                                 {.struct_size = sizeof *voids,
                                  .kind = DEM_OUTLINE_RECTANGLE,
                                  .size = {0.03, 0.004},
                                  .centre = {far_void[0], far_void[1]}},
                                 {.struct_size = sizeof *voids,
                                  .kind = DEM_OUTLINE_RECTANGLE,
                                  .size = {0.02, 0.004},
                                  .centre = {low_void[0], low_void[1]}}};
    for (dem_index n_voids = 0; n_voids <= 3; n_voids++) {
        const dem_shape shape = shape_of(voids, n_voids);
        for (dem_index n = 1; n <= MOST_SLABS; n++) check_strip(&shape, n, 0.0);
    }
}

/* Which is inside of the body then. */
TEST(a_strip_of_moved_nodes_has_the_shortest_side_of_the_whole)
{
    const dem_shape shape = shape_of(NULL, 0);
    for (dem_index n = 1; n <= MOST_SLABS; n++) check_strip(&shape, n, 0.3 * shape.spacing);
}

TEST(the_shortest_spring_of_all_slabs_is_known)
{
    const dem_shape shape = shape_of(NULL, 0);
    CLEANUP(slab_survey_free) slab_survey whole = look(&shape, 1, 0.2 * shape.spacing);
    CLEANUP(dem_lattice_free) dem_lattice strip = dem_lattice_empty();
    assert_true(slab_survey_take_strip(&strip, &whole));
    assert_close(whole.rest_length, shortest_side(&strip), 1e-15);
    for (dem_index n = 2; n <= MOST_SLABS; n++) {
        CLEANUP(slab_survey_free) slab_survey s = look(&shape, n, 0.2 * shape.spacing);
        assert_close(s.rest_length, whole.rest_length, 0.0);
    }
}

TEST(a_body_in_two_parts_is_seen_to_be)
{
    const dem_outline cut = {
        .struct_size = sizeof cut, .kind = DEM_OUTLINE_RECTANGLE, .size = {0.2, 0.008}, .centre = {0.03, 0.05}};
    const dem_shape one = shape_of(NULL, 0), two = shape_of(&cut, 1);
    for (dem_index n = 1; n <= MOST_SLABS; n++) {
        CLEANUP(slab_survey_free) slab_survey whole = look(&one, n, 0.0);
        CLEANUP(slab_survey_free) slab_survey parts = look(&two, n, 0.0);
        assert_true(slab_survey_is_one(&whole));
        assert_false(slab_survey_is_one(&parts));
    }
}
