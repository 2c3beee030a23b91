/* SPDX-License-Identifier: BSD-3-Clause */
/* obstacle_input.c: callers' obstacles become the library's, whatever the version of their header. */
#include "unit/close.h"

#include <stdlib.h>

#include <dem/model.h>

#include "base/struct_size.h"
#include "harness/message.h"
#include "obstacle/obstacle_input.h"

TEST(an_obstacle_is_read_with_its_points_where_they_are)
{
    const double points[4] = {0.0, 1.0, 2.0, 3.0};
    const dem_obstacle theirs = {.struct_size = sizeof theirs, .n_points = 2, .points = points, .velocity = {1.0, 2.0}};
    dem_obstacle ours;
    assert_int_equal(obstacle_input_read(&ours, &theirs), DEM_OK);
    assert_memory_equal(&ours, &theirs, sizeof ours);
    assert_int_equal(obstacle_input_read(&ours, NULL), DEM_ERROR_ARGUMENT);
}

TEST(several_are_read_into_an_array_of_their_own)
{
    const dem_obstacle theirs[2] = {{.struct_size = sizeof(dem_obstacle), .n_points = 2},
                                    {.struct_size = sizeof(dem_obstacle), .n_points = 3, .velocity = {0.0, 1.0}}};
    CLEANUP(free_memory) void *ours = NULL;
    assert_int_equal(obstacle_input_read_all(&ours, theirs, 2), DEM_OK);
    assert_memory_equal(ours, theirs, sizeof theirs);
}

/* The first version ended with `velocity`. */
TEST(a_struct_shorter_than_the_first_version_is_refused)
{
    dem_obstacle theirs = {.struct_size = STRUCT_SIZE_WITH(dem_obstacle, velocity)}, ours;
    assert_int_equal(obstacle_input_read(&ours, &theirs), DEM_OK);
    assert_int_equal(ours.struct_size, sizeof ours);
    theirs.struct_size--;
    assert_int_equal(obstacle_input_read(&ours, &theirs), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_obstacle: struct_size");
}
