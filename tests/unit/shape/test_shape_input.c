/* SPDX-License-Identifier: BSD-3-Clause */
/* shape_input.c: shapes of callers, and what is none. */
#include "unit/close.h"

#include "harness/message.h"
#include "shape/shape_input.h"

static const dem_outline plate = {.struct_size = sizeof plate, .centre = {0.0, 1.0}, .size = {3.0, 2.0}};
static const dem_outline disc = {.struct_size = sizeof disc, .kind = DEM_OUTLINE_DISC, .radius = 1.0};
static const unsigned char pixels[6] = {1, 1, 1, 1, 1, 0};

static dem_shape sound(void)
{
    const dem_shape s = SIZED(dem_shape, .outline = &plate, .spacing = 0.5);
    return s;
}

static dem_status make(const dem_shape *theirs)
{
    dem_shape ours;
    shape s = {0};
    dem_status status = shape_input_read(&ours, theirs);
    if (status == DEM_OK) status = shape_input_make(&s, &ours);
    shape_free(&s);
    return status;
}

TEST(pores_are_voids_behind_the_others)
{
    const double pores[] = {0.5, 0.25, 0.125, -1.0, 1.5, 0.25};
    dem_shape given = sound(), ours;
    CLEANUP(shape_free) shape s = {0};
    given.n_voids = 1, given.voids = &disc, given.n_pores = 2, given.pores = pores;
    assert_int_equal(shape_input_read(&ours, &given), DEM_OK);
    assert_int_equal(shape_input_make(&s, &ours), DEM_OK);
    assert_int_equal(s.n_voids, 3);
    assert_true(s.voids[0].radius == 1.0 && s.voids[1].centre[1] == 0.25 && s.voids[2].radius == 0.25);
}

TEST(an_image_stands_on_the_origin)
{
    const dem_image image = SIZED(dem_image, .width = 3, .height = 2, .pixel = 0.5, .solid = pixels);
    dem_shape given = sound(), ours;
    CLEANUP(shape_free) shape s = {0};
    given.outline = NULL, given.image = &image, given.spacing = 0.1;
    assert_int_equal(shape_input_read(&ours, &given), DEM_OK);
    assert_int_equal(shape_input_make(&s, &ours), DEM_OK);
    assert_true(s.outline.size[0] == 1.5 && s.outline.size[1] == 1.0 && s.outline.centre[1] == 0.5);
    assert_int_equal(s.mask.n_solid, 5);
    assert_false(shape_outline_has(&s, (double[]){0.5, 0.25})); /* the lower right one */
}

static void expect_refused(const dem_shape *s, const char *pattern)
{
    assert_int_equal(make(s), DEM_ERROR_ARGUMENT);
    assert_message_parts(pattern);
}

TEST(members_out_of_their_ranges_are_refused_by_name)
{
    const dem_image empty = SIZED(dem_image, .width = 0, .height = 2, .pixel = 0.5, .solid = pixels);
    const double pore[3] = {0.0, 0.0, 0.0};
    dem_shape s = sound();
    assert_int_equal(make(&s), DEM_OK);
    s.spacing = 2.5;
    s.name = "plate 7";
    expect_refused(&s, "plate 7 * 3 m x 2 m * spacing 2.5 m");
    s = sound();
    s.spacing = (double)NAN;
    expect_refused(&s, "the shape * spacing nan m");
    s = sound();
    s.image = &empty;
    expect_refused(&s, "outline or an image");
    s.outline = NULL;
    expect_refused(&s, "0 x 2");
    s = sound();
    s.grid = (dem_grid)2;
    expect_refused(&s, "grid * 2");
    s = sound();
    s.edge = DEM_EDGE_SMOOTH, s.grid = DEM_GRID_SQUARES;
    expect_refused(&s, "smooth edges");
    s = sound();
    s.n_voids = 1;
    expect_refused(&s, "1 of voids * NULL");
    s = sound();
    s.n_pores = 1, s.pores = pore;
    expect_refused(&s, "pore 0 * radius 0 m");
    expect_refused(NULL, "shape is NULL");
}

TEST(discs_and_rings_bound_the_spacing_by_their_radius_and_wall)
{
    const dem_outline ring = SIZED(dem_outline, .kind = DEM_OUTLINE_RING, .radius = 1.0, .inner_radius = 0.75);
    dem_shape s = sound();
    s.outline = &disc, s.spacing = 1.0;
    assert_int_equal(make(&s), DEM_OK);
    s.spacing = 1.1;
    expect_refused(&s, "1 m x 1 m * 1.1 m");
    s.outline = &ring, s.spacing = 0.25;
    assert_int_equal(make(&s), DEM_OK);
    s.spacing = 0.26;
    expect_refused(&s, "0.25 m x 0.25 m");
}
