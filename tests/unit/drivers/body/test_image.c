/* SPDX-License-Identifier: BSD-3-Clause */
/* image.c: memory of an image. */
#include "unit/close.h"

#include "image.h"

TEST(an_image_is_black_at_first_and_empty_at_last)
{
    CLEANUP(image_free) image picture = {.width = 3, .height = 2, .white = 9};
    assert_true(image_create(&picture));
    for (int k = 0; k < 6; k++) assert_int_equal(picture.grey[k], 0);
    image_free(&picture);
    assert_null(picture.grey);
    assert_int_equal(picture.width, 0);
}
