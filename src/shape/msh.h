/* SPDX-License-Identifier: BSD-3-Clause */
/* Gmsh meshes: MSH 4.1, text, triangles in the plane z = 0. */
#ifndef DEM_SHAPE_MSH_H
#define DEM_SHAPE_MSH_H

#include <stdbool.h>

#include <dem/dem.h>

enum { MSH_FAULT = 240 }; /* bytes of a fault */

/* Reads nodes and triangles; points and lines among the elements are passed over, nodes of no triangle left out, and
 * triangles made counter-clockwise. Anything may come in: counts are held against the number of bytes before memory is
 * asked for.
 * \param[out] out    a triangulation with coordinates as they stand; empty unless DEM_OK is returned
 * \param[out] fault  [MSH_FAULT] "LINE: what is wrong" where DEM_ERROR_MODEL is returned
 * \param text        [size]
 * \return DEM_ERROR_MEMORY, DEM_ERROR_MODEL */
dem_status msh_parse(dem_lattice *out, char *fault, const char *text, size_t size);

#endif
