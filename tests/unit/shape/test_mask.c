/* SPDX-License-Identifier: BSD-3-Clause */
/* mask.c: from the pixels of an image to where material is. */
#include "unit/close.h"

#include "shape/mask.h"

static const unsigned char pixels[12] = {9, 9, 0, 1, 1, 1, 0, 0, 1, 1, 1, 1};

/* 4 x 3 pixels of 0.5 m: x from -1 to 1, y from 0 to 1.5. The upper row has the pixels 0, 1 and 3. */
static mask make_steps(void)
{
    mask m;
    const dem_image image = SIZED(dem_image, .width = 4, .height = 3, .pixel = 0.5, .solid = pixels);
    assert_true(mask_create(&m, &image));
    return m;
}

TEST(the_top_row_comes_first)
{
    static const unsigned char expected[12] = {1, 1, 1, 1, 1, 1, 0, 0, 1, 1, 0, 1};
    mask m = make_steps();
    assert_memory_equal(m.solid, expected, sizeof expected);
    assert_int_equal(m.n_solid, 9);
    mask_free(&m);
    assert_null(m.solid);
}

static bool has(const mask *m, double x, double y)
{
    return mask_has(m, (const double[]){x, y}, 1e-9);
}

TEST(edges_of_pixels_belong_to_the_material)
{
    CLEANUP(mask_free) mask m = make_steps();
    assert_true(has(&m, 0.25, 0.25) && has(&m, -0.75, 1.25) && has(&m, 0.75, 1.25));
    assert_false(has(&m, 0.25, 0.75) || has(&m, 0.25, 1.25) || has(&m, 0.75, 0.75));
    assert_true(has(&m, 0.0, 0.75) && has(&m, 0.5, 1.25) && has(&m, 0.75, 1.0)); /* between bright and dark */
    assert_true(has(&m, -1.0, 0.0) && has(&m, 1.0, 1.5) && has(&m, 1.0 + 5e-10, 0.0) && has(&m, 0.0, -5e-10));
    assert_false(has(&m, 1.0 + 2e-9, 0.0) || has(&m, 0.0, -2e-9) || has(&m, -1e300, 0.0) || has(&m, 0.0, (double)NAN));
}

static bool fits(const mask *m, double x, double y, double radius)
{
    return mask_fits(m, (const double[]){x, y}, radius);
}

TEST(a_disc_fits_as_far_as_the_nearest_dark_pixel)
{
    CLEANUP(mask_free) mask m = make_steps();
    assert_true(fits(&m, -0.5, 0.75, 0.4999));
    assert_false(fits(&m, -0.5, 0.75, 0.5001)); /* the edge at x = 0, and that of the image */
    assert_true(fits(&m, -0.3, 0.1, 0.0999));
    assert_false(fits(&m, -0.3, 0.1, 0.1001));
    assert_true(fits(&m, -0.3, 0.45, 0.304)); /* the corner (0, 0.5) is 0.30414 away */
    assert_false(fits(&m, -0.3, 0.45, 0.3042));
    assert_false(fits(&m, 0.25, 0.75, 0.01));
}

TEST(rows_are_sliced_into_runs)
{
    double x[5];
    CLEANUP(mask_free) mask m = make_steps();
    assert_int_equal(mask_slice(&m, 0, x), 2);
    assert_close(x[0], -1.0, 0.0);
    assert_close(x[1], 1.0, 0.0);
    assert_int_equal(mask_slice(&m, 1, x), 2);
    assert_close(x[1], 0.0, 0.0);
    assert_int_equal(mask_slice(&m, 2, x), 4);
    assert_close(x[1], 0.0, 0.0);
    assert_close(x[2], 0.5, 0.0);
    assert_close(x[3], 1.0, 0.0);
}
