/* SPDX-License-Identifier: BSD-3-Clause */
/* Callers' obstacles in this library's layout of the struct. Members beyond the end of the caller's struct are 0, which
 * is at rest. Whether the numbers make sense is checked where they are compiled: motion_law.c for the motion,
 * polyline.c for all else. */
#include "obstacle/obstacle_input.h"

#include "base/status.h"
#include "base/struct_size.h"

/* `velocity` is the last member of the first version. */
static const struct_kind kind_of_struct = {"dem_obstacle", STRUCT_SIZE_WITH(dem_obstacle, velocity),
                                           sizeof(dem_obstacle)};

dem_status obstacle_input_read(dem_obstacle *ours, const dem_obstacle *theirs)
{
    CHECK(theirs != NULL, DEM_ERROR_ARGUMENT, "obstacle is NULL");
    *ours = (dem_obstacle){0};
    return struct_size_read(&kind_of_struct, ours, theirs);
}

dem_status obstacle_input_read_all(void **ours, const dem_obstacle *theirs, dem_index n)
{
    return struct_size_read_array(&kind_of_struct, ours, theirs, n);
}
