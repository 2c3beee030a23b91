/* SPDX-License-Identifier: BSD-3-Clause */
/* Cracks: which triangles and springs of a lattice a polyline crosses. */
#ifndef DEM_CRACK_H
#define DEM_CRACK_H

#include <stdbool.h>

#include <dem/dem.h>

#define CRACK_ASIDE 1e-6 /* of the spacing: how far cracks run beside their points */

/* Sets keep[t] = 0 for the triangles that the crack crosses, shifted to its left by `shift`, m: what runs along edges
 * then takes the triangles on its left, and nodes on it belong to its right face.
 * \param keep    [n_triangles]
 * \param points  [n_points][2], m, n_points >= 2, consecutive ones distinct
 * \return the number of triangles crossed, also where keep was 0; -1 when memory runs out */
dem_index crack_mark(bool *keep, const dem_lattice *lattice, const double *points, size_t n_points, double shift);

/* The same of springs, of a lattice that has them.  \param keep [n_springs] */
dem_index crack_mark_springs(bool *keep, const dem_lattice *lattice, const double *points, size_t n_points,
                             double shift);

#endif
