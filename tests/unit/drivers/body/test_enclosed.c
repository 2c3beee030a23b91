/* SPDX-License-Identifier: BSD-3-Clause */
/* enclosed.c: which triangles and springs lie in an outline. */
#include "unit/solids.h"

#include <stdlib.h>

#include "enclosed.h"

static const outline disc = {.kind = OUTLINE_DISC, .centre = {0.1, 2.3}, .radius = 1.7};

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

TEST(triangles_are_inside_by_their_centres_and_the_others_keep_what_they_have)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(8.0, 6.0, 0.5);
    dem_index of[1000], n = 0;
    assert_true(lattice.n_triangles <= 1000);
    for (dem_index t = 0; t < lattice.n_triangles; t++) of[t] = -t;
    const dem_index inside = enclosed_triangles(of, &lattice, &disc, 7, 1);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        const bool is_in = is_inside(&lattice, lattice.triangles + 3 * t, 3);
        assert_int_equal(of[t], is_in ? 7 : -t);
        n += is_in;
    }
    assert_int_equal(inside, n);
    assert_true(n > 50);
}

TEST(cells_are_inside_as_a_whole)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    dem_index of[1000] = {0}, n = 0;
    assert_int_equal(dem_lattice_squares(&lattice, 8.0, 6.0, 0.5), DEM_OK);
    assert_true(lattice.n_triangles <= 1000);
    const dem_index inside = enclosed_triangles(of, &lattice, &disc, 1, 2);
    for (dem_index t = 0; t < lattice.n_triangles; t += 2) {
        assert_int_equal(of[t], is_inside(&lattice, lattice.triangles + 3 * t, 6));
        assert_int_equal(of[t], of[t + 1]);
        n += 2 * of[t];
    }
    assert_int_equal(inside, n);
}

TEST(springs_are_inside_by_their_middles)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(8.0, 6.0, 0.5);
    bool springs[2000] = {false};
    assert_true(lattice.n_springs <= 2000);
    springs[0] = true; /* which is not inside */
    enclosed_springs(springs, &lattice, &disc);
    for (dem_index k = 0; k < lattice.n_springs; k++)
        assert_int_equal(springs[k], k == 0 || is_inside(&lattice, lattice.ends + 2 * k, 2));
    assert_false(is_inside(&lattice, lattice.ends, 2));
}
