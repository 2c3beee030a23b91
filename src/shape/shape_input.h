/* SPDX-License-Identifier: BSD-3-Clause */
/* Callers' shapes: of any version of the struct, in their ranges, with their pores as voids behind the others. */
#ifndef DEM_SHAPE_SHAPE_INPUT_H
#define DEM_SHAPE_SHAPE_INPUT_H

#include <dem/shape.h>

#include "shape/shape.h"

/* A shape of this version of the struct, whose arrays are the caller's.  \return DEM_ERROR_ARGUMENT */
dem_status shape_input_read(dem_shape *ours, const dem_shape *theirs);

/* Makes a shape of it; free with shape_free(). After a failure *out is empty. Whether polygons meet themselves is not
 * looked at.
 * \param ours  of shape_input_read()
 * \return DEM_ERROR_ARGUMENT, DEM_ERROR_MEMORY */
dem_status shape_input_make(shape *out, const dem_shape *ours);

/* Whether no polygon of a shape meets itself.  \return DEM_ERROR_ARGUMENT */
dem_status shape_input_check_edges(const shape *s);

/* By which messages call it. */
const char *shape_input_name(const dem_shape *ours);

/* The failure that void k, one of the caller's, takes nothing of the body. */
dem_status shape_input_refuse_void(const dem_shape *ours, const shape *s, dem_index k);

/* Names the shape where it would have too many nodes.
 * \param made  what shape_find_grid(), or shape_mesh(), has returned \return the same, or DEM_ERROR_ARGUMENT */
dem_status shape_input_check_size(const dem_shape *ours, dem_status made);

#endif
