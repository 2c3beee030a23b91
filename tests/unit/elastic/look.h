/* SPDX-License-Identifier: BSD-3-Clause */
/* What tests of other rooms may see of elastic's data that no other room of the library touches. */
#ifndef DEM_TEST_ELASTIC_LOOK_H
#define DEM_TEST_ELASTIC_LOOK_H

#include "elastic/layout.h"
#include "elastic/triangles.h"

/** Blocks up or down that springs reach at most. */
static inline dem_index look_reach(const layout *l)
{
    return l->reach;
}

/** dw/dJ of the guard's law. */
static inline double look_guard_slope(double area_ratio)
{
    return triangles_guard_law(area_ratio).slope;
}

#endif
