/* SPDX-License-Identifier: BSD-3-Clause */
/* The stiffness of a small model as a dense matrix, and what GSL makes of it. */
#ifndef DEM_TEST_DENSE_H
#define DEM_TEST_DENSE_H

#include <gsl/gsl_matrix.h>

#include "support.h"

/** K about the positions x [n][2], from central differences of the forces over `step` m. Caller frees. */
gsl_matrix *dense_stiffness(const dem_model *model, const double *x, double step);

/** Eigenvalues of M^-1 K, ascending, 1/s^2, [2 n]; the matrix is freed. Caller frees the vector. */
gsl_vector *dense_frequencies(const dem_model *model, gsl_matrix *stiffness);

#endif
