/* SPDX-License-Identifier: BSD-3-Clause */
/* Callers' figures as outlines: of any version of the struct, in their ranges and places. */
#ifndef DEM_SHAPE_OUTLINE_INPUT_H
#define DEM_SHAPE_OUTLINE_INPUT_H

#include <dem/shape.h>

#include "shape/outline.h"

/* All but whether a polygon meets itself, which takes long. The last point of a polygon is left out where it is the
 * first; one that is turned or shifted, and a rectangle that is turned, become polygons in their place. Free with
 * outline_free(); after a failure *out is empty.
 * \return DEM_ERROR_ARGUMENT, DEM_ERROR_MEMORY */
dem_status outline_input_read(outline *out, const dem_outline *theirs);

/* The same of all, of n >= 0.
 * \param what  names one of them in messages, "void"
 * \param[out] out  [n] from malloc, each to be freed; NULL for n = 0 and after a failure */
dem_status outline_input_read_all(outline **out, const dem_outline *theirs, dem_index n, const char *what);

/* Whether a polygon meets itself; other figures do not.  \return DEM_ERROR_ARGUMENT */
dem_status outline_input_check_edges(const outline *o);

#endif
