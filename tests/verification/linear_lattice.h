/* SPDX-License-Identifier: BSD-3-Clause */
/* The linear stiffness of a lattice without area term, summed over springs and couplings, and statics by conjugate
 * gradients. */
#ifndef DEM_TEST_LINEAR_LATTICE_H
#define DEM_TEST_LINEAR_LATTICE_H

#include <stddef.h>

#include <dem/dem.h>

/** f = K u about the rest places, [n_nodes][2]. */
void linear_lattice_multiply(const dem_lattice *l, const double *u, double *f);

double linear_lattice_product(const double *a, const double *b, size_t n);

/** K u = f to a residual of 1e-8; f has no resultant, so that rigid motions do not come in. To be freed. */
double *linear_lattice_solve(const dem_lattice *l, const double *f);

/** Stresses under the loads f, N, [n_nodes][3], Pa: displacements times `scale` are small enough for a linear lattice,
 *  and large enough for rounding. To be freed; the lattice starts there from now on. */
double *linear_lattice_stress(dem_lattice *l, const double *f, double scale);

#endif
