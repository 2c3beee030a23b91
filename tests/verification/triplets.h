/* SPDX-License-Identifier: BSD-3-Clause */
/* Free lattices in the hands of GSL: forces are summed spring by spring from the triplets, not row by row from CSR. */
#ifndef DEM_TEST_TRIPLETS_H
#define DEM_TEST_TRIPLETS_H

#include <gsl/gsl_odeiv2.h>

#include <dem/dem.h>

/** Derivative of y = (x, v), [4 n], of a lattice without area term, guard and damping: a gsl_odeiv2_system's function,
 *  whose context is the lattice. */
int triplets_derivative(double t, const double y[], double f[], void *lattice);

/** Where the lattice starts.  \param[out] y  [4 n] */
void triplets_start(const dem_lattice *lattice, double *y);

/** n steps of length h from y.  \param y  [4 n] */
void triplets_steps(dem_lattice *lattice, const gsl_odeiv2_step_type *type, int n, double h, double *y);

/** From y at 0 to t, to 1e-13 of each unknown and as much m or m/s.  \param y  [4 n] */
void triplets_reach(dem_lattice *lattice, double t, double *y);

#endif
