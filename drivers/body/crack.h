/* SPDX-License-Identifier: BSD-3-Clause */
/* Cracks: which triangles of a lattice a polyline crosses. */
#ifndef DEM_CRACK_H
#define DEM_CRACK_H

#include <stdbool.h>

#include <dem/dem.h>

/* Sets keep[t] = 0 for the triangles that the crack crosses, shifted to its left by `shift`, m: what runs along edges
 * then takes the triangles on its left, and nodes on it belong to its right face.
 * \param keep    [n_triangles]
 * \param points  [n_points][2], m, n_points >= 2, consecutive ones distinct
 * \return the number of triangles crossed, also where keep was 0; -1 when memory runs out */
dem_index crack_mark(bool *keep, const dem_lattice *lattice, const double *points, size_t n_points, double shift);

#endif
