/* SPDX-License-Identifier: BSD-3-Clause */
/* least_angle.c: triangles whose angles are known. */
#include "unit/close.h"

#include "shape/least_angle.h"

static const double degree = 0.017453292519943295769; /* pi/180 */

/* The cotangent is cos/sin of sides as long as a few units: rounding. */
TEST(the_least_angle_is_found_at_any_corner)
{
    const double x[] = {0.0, 0.0, 4.0, 0.0, 4.0, 3.0}; /* cot of the least angle is 4/3 */
    for (dem_index k = 0; k < 3; k++) {
        const dem_index corner[3] = {k, (k + 1) % 3, (k + 2) % 3}, turned_over[3] = {k, (k + 2) % 3, (k + 1) % 3};
        assert_close(least_angle_cotangent(x, corner), 4.0 / 3.0, 1e-15);
        assert_true(least_angle_cotangent(x, turned_over) == (double)INFINITY);
    }
}

TEST(a_triangle_without_area_counts_as_turned_over)
{
    const double x[] = {0.0, 0.0, 1.0, 0.0, 2.0, 0.0};
    assert_true(least_angle_cotangent(x, (dem_index[]){0, 1, 2}) == (double)INFINITY);
}

static double least_angle_of(const dem_lattice *lattice)
{
    double angle;
    assert_int_equal(dem_lattice_least_angle(lattice, &angle), DEM_OK);
    return angle / degree;
}

TEST(the_flattest_of_all_triangles_counts)
{
    double x[] = {0.0, 0.0, 2.0, 0.0, 1.0, sqrt(3.0), 1.0, -tan(10.0 * degree)};
    dem_index triangles[] = {0, 1, 2, 1, 0, 3};
    dem_lattice l = dem_lattice_empty();
    l.n_nodes = 4, l.x = x, l.triangles = triangles;
    l.n_triangles = 1;
    assert_close(least_angle_of(&l), 60.0, 1e-13);
    l.n_triangles = 2;
    assert_close(least_angle_of(&l), 10.0, 1e-13);
    triangles[4] = 3, triangles[5] = 0;
    assert_close(least_angle_of(&l), 0.0, 0.0);
}
