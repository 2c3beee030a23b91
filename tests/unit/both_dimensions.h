/* SPDX-License-Identifier: BSD-3-Clause */
/* Tests that run in two dimensions and in three. */
#ifndef DEM_TEST_BOTH_DIMENSIONS_H
#define DEM_TEST_BOTH_DIMENSIONS_H

#include "harness/test.h"

static int dim; /* of the test that runs */

static int in_two_dimensions(void **state)
{
    (void)state;
    dim = 2;
    return 0;
}

static int in_three_dimensions(void **state)
{
    (void)state;
    dim = 3;
    return 0;
}

#define TEST_IN_BOTH(name) TEST_TWICE(name, in_two_dimensions, in_three_dimensions)

#endif
