/* SPDX-License-Identifier: BSD-3-Clause */
/* outline_input.c: figures of callers in their places, what is no figure, distances, boxes and corners. */
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>

#include <dem/shape.h>

#include "harness/message.h"
#include "shape/outline_input.h"

static const double pi = 3.14159265358979323846;
static const double corner[] = {0.0, 0.0, 4.0, 0.0, 0.0, 3.0, 0.0, 0.0}; /* the last is the first once more */

static double distance_to(const dem_outline *o, double x, double y)
{
    double distance;
    assert_int_equal(dem_outline_distance(o, (const double[]){x, y}, 1, &distance), DEM_OK);
    return distance;
}

TEST(figures_are_turned_and_shifted)
{
    const dem_outline plate =
        SIZED(dem_outline, .centre = {1.0, 2.0}, .angle = 0.5 * pi, .size = {4.0, 2.0}); /* 2 m wide, 4 m high */
    const dem_outline ring =
        SIZED(dem_outline, .kind = DEM_OUTLINE_RING, .centre = {1.0, 0.0}, .radius = 3.0, .inner_radius = 1.0);
    const dem_outline triangle = SIZED(dem_outline, .kind = DEM_OUTLINE_POLYGON, .centre = {10.0, 0.0},
                                       .angle = 0.5 * pi, .n_points = 4, .points = corner);
    assert_close(distance_to(&plate, 1.0, 2.0), -1.0, 1e-15);
    assert_close(distance_to(&plate, 1.0, 5.0), 1.0, 1e-15);
    assert_close(distance_to(&ring, 1.0, 0.25), 0.75, 1e-15);
    assert_close(distance_to(&ring, 3.0, 0.0), -1.0, 1e-15);
    assert_close(distance_to(&triangle, 10.0, 5.0), 1.0, 1e-14); /* beyond its corner (4, 0), turned to (0, 4) */
    assert_close(distance_to(&triangle, 9.0, 1.0), -1.0, 1e-14); /* the centre of its inscribed circle */
}

TEST(boxes_and_corners_are_those_of_the_figure_in_its_place)
{
    const dem_outline plate = SIZED(dem_outline, .centre = {1.0, 2.0}, .size = {4.0, 2.0});
    const dem_outline disc = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .centre = {1.0, 2.0}, .radius = 0.5);
    dem_outline triangle = SIZED(dem_outline, .kind = DEM_OUTLINE_POLYGON, .n_points = 4, .points = corner);
    double box[4], x[2];
    assert_int_equal(dem_outline_box(&disc, box), DEM_OK);
    assert_true(box[0] == 0.5 && box[1] == 1.5 && box[2] == 1.5 && box[3] == 2.5);
    assert_int_equal(dem_outline_corners(&disc), 0);
    assert_int_equal(dem_outline_corners(&plate), 4);
    assert_int_equal(dem_outline_corners(&triangle), 3);
    assert_int_equal(dem_outline_corner(&plate, 2, x), DEM_OK);
    assert_true(x[0] == 3.0 && x[1] == 3.0);
    triangle.centre[0] = 10.0, triangle.angle = 0.5 * pi;
    assert_int_equal(dem_outline_corner(&triangle, 1, x), DEM_OK);
    assert_close(x[0], 10.0, 1e-15);
    assert_close(x[1], 4.0, 0.0);
    assert_int_equal(dem_outline_corner(&triangle, 3, x), DEM_ERROR_ARGUMENT);
    assert_message_parts("corner 3");
    assert_int_equal(dem_outline_corners(NULL), 0);
}

static void expect_refused(const dem_outline *o, const char *pattern)
{
    assert_int_equal(dem_outline_check(o), DEM_ERROR_ARGUMENT);
    assert_message_parts(pattern);
}

TEST(what_is_no_figure_is_refused_by_its_numbers)
{
    static const double bow[] = {0.0, 0.0, 2.0, 2.0, 2.0, 0.0, 0.0, 2.0}, still[] = {0.0, 0.0, 1.0, 0.0, 1.0, 0.0};
    static const double lost[] = {0.0, 0.0, 1.0, (double)NAN, 1.0, 1.0};
    dem_outline o = SIZED(dem_outline, .size = {1.0, 0.0});
    expect_refused(&o, "1 m x 0 m");
    o.size[1] = 1.0;
    assert_int_equal(dem_outline_check(&o), DEM_OK);
    o.centre[0] = (double)INFINITY;
    expect_refused(&o, "centre * (inf, 0) m");
    o = (dem_outline)SIZED(dem_outline, .kind = DEM_OUTLINE_RING, .radius = 1.0, .inner_radius = 1.0);
    expect_refused(&o, "inner radius * 1 m");
    o.kind = (dem_outline_kind)7;
    expect_refused(&o, "kind * 7");
    o = (dem_outline)SIZED(dem_outline, .kind = DEM_OUTLINE_POLYGON, .n_points = 4, .points = bow);
    expect_refused(&o, "meets itself * edge 1 * edge 3");
    o.points = still, o.n_points = 3;
    expect_refused(&o, "from point 2, (1, 0) m");
    o.points = lost;
    expect_refused(&o, "from point 1");
    o.points = corner, o.n_points = 2;
    expect_refused(&o, "at least 3 points * 2");
    o.n_points = DEM_OUTLINE_MAX_POINTS + 2;
    expect_refused(&o, "at most 10000 points * 10002");
    o.struct_size = 8;
    expect_refused(&o, "dem_outline * 8");
    assert_int_equal(dem_outline_check(NULL), DEM_ERROR_ARGUMENT);
}

/* Callers of a newer version have larger structs, of which an array's steps follow. */
TEST(structs_of_another_version_are_read)
{
    struct {
        dem_outline o;
        double unknown;
    } newer[2] = {{SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .radius = 1.0), 0.0},
                  {SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .radius = 2.0), 0.0}};
    outline *all;
    for (int k = 0; k < 2; k++) newer[k].o.struct_size = sizeof newer[k];
    assert_int_equal(outline_input_read_all(&all, &newer[0].o, 2, "void"), DEM_OK);
    assert_true(all[0].radius == 1.0 && all[1].radius == 2.0);
    free(all);
    newer[1].o.radius = -1.0;
    assert_int_equal(outline_input_read_all(&all, &newer[0].o, 2, "void"), DEM_ERROR_ARGUMENT);
    assert_message_parts("void 1 * -1 m");
    assert_null(all);
    newer[1].o.radius = 2.0, newer[1].unknown = 1.0;
    assert_int_equal(outline_input_read_all(&all, &newer[0].o, 2, "void"), DEM_ERROR_ARGUMENT);
}
