/* SPDX-License-Identifier: BSD-3-Clause */
/* stars.c: neighbours of triangles, the rim. */
#include "unit/close.h"

#include "shape/stars.h"

TEST(the_side_across_runs_the_other_way)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&l, 5.0, 4.0, 1.0), DEM_OK);
    stars s;
    assert_true(stars_create(&s, &l));
    dem_index n_rim = 0;
    for (dem_index side = 0; side < 3 * l.n_triangles; side++) {
        const dem_index other = stars_across(&s, &l, side);
        n_rim += other < 0;
        if (other < 0) continue;
        assert_true(other / 3 != side / 3);
        assert_int_equal(l.triangles[other], stars_end(&l, side));
        assert_int_equal(stars_end(&l, other), l.triangles[side]);
        assert_int_equal(stars_across(&s, &l, other), side);
    }
    /* Euler: nodes - edges + triangles = 1, and 3 triangles = 2 edges - rim. */
    assert_int_equal(n_rim, 2 * (l.n_nodes + l.n_triangles - 1) - 3 * l.n_triangles);
    stars_free(&s);
}

TEST(every_node_has_its_triangles)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    assert_int_equal(dem_lattice_disc(&l, 3.0, 1.0), DEM_OK);
    stars s;
    assert_true(stars_create(&s, &l));
    assert_int_equal(s.first[l.n_nodes], 3 * l.n_triangles);
    for (dem_index i = 0; i < l.n_nodes; i++)
        for (dem_index p = s.first[i]; p < s.first[i + 1]; p++) {
            const dem_index *corner = l.triangles + 3 * s.list[p];
            assert_true(corner[0] == i || corner[1] == i || corner[2] == i);
        }
    stars_free(&s);
}
