/* SPDX-License-Identifier: BSD-3-Clause */
/* enclosed.c: which triangles and springs lie in an outline. */
#include "unit/solids.h"

#include <stdlib.h>

#include <dem/shape.h>

#include "harness/message.h"

static const dem_outline disc = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .centre = {0.1, 2.3}, .radius = 1.7);

/* Whether the middle of n nodes is at most the radius from the centre. */
static bool is_inside(const dem_lattice *l, const dem_index *nodes, int n)
{
    double x = -disc.centre[0], y = -disc.centre[1];
    for (int k = 0; k < n; k++) {
        x += l->x[2 * nodes[k]] / n;
        y += l->x[2 * nodes[k] + 1] / n;
    }
    return hypot(x, y) <= disc.radius;
}

static dem_index count(const bool *flags, dem_index n)
{
    dem_index sum = 0;
    for (dem_index k = 0; k < n; k++) sum += flags[k];
    return sum;
}

TEST(triangles_are_inside_by_their_centres)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(8.0, 6.0, 0.5);
    bool inside[1000];
    assert_true(lattice.n_triangles <= 1000);
    assert_int_equal(dem_lattice_inside(&lattice, &disc, 1, inside, NULL), DEM_OK);
    for (dem_index t = 0; t < lattice.n_triangles; t++)
        assert_int_equal(inside[t], is_inside(&lattice, lattice.triangles + 3 * t, 3));
    assert_true(count(inside, lattice.n_triangles) > 50);
}

TEST(cells_are_inside_as_a_whole)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    bool inside[1000];
    assert_int_equal(dem_lattice_squares(&lattice, 8.0, 6.0, 0.5), DEM_OK);
    assert_true(lattice.n_triangles <= 1000);
    assert_int_equal(dem_lattice_inside(&lattice, &disc, 2, inside, NULL), DEM_OK);
    for (dem_index t = 0; t < lattice.n_triangles; t += 2) {
        assert_int_equal(inside[t], is_inside(&lattice, lattice.triangles + 3 * t, 6));
        assert_int_equal(inside[t], inside[t + 1]);
    }
    assert_true(count(inside, lattice.n_triangles) > 50);
}

TEST(springs_are_inside_by_their_middles)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(8.0, 6.0, 0.5);
    bool inside[2000];
    assert_true(lattice.n_springs <= 2000);
    assert_int_equal(dem_lattice_inside(&lattice, &disc, 1, NULL, inside), DEM_OK);
    for (dem_index k = 0; k < lattice.n_springs; k++)
        assert_int_equal(inside[k], is_inside(&lattice, lattice.ends + 2 * k, 2));
    assert_true(count(inside, lattice.n_springs) > 50);
}

TEST(what_is_no_figure_is_refused)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(8.0, 6.0, 0.5);
    const dem_outline point = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC);
    assert_int_equal(dem_lattice_inside(&lattice, &point, 1, NULL, NULL), DEM_ERROR_ARGUMENT);
    assert_message_parts("radius * 0 m");
    assert_int_equal(dem_lattice_inside(&lattice, &disc, 3, NULL, NULL), DEM_ERROR_ARGUMENT);
    assert_message_parts("step * 3");
    assert_int_equal(dem_lattice_inside(&lattice, NULL, 1, NULL, NULL), DEM_ERROR_ARGUMENT);
}
