/* SPDX-License-Identifier: BSD-3-Clause */
/* cleanup.h for what GSL allocates. */
#ifndef DEM_TEST_CLEANUP_GSL_H
#define DEM_TEST_CLEANUP_GSL_H

#include <gsl/gsl_matrix.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_vector.h>

static inline void free_rng(gsl_rng **rng)
{
    gsl_rng_free(*rng);
}

static inline void free_vector(gsl_vector **vector)
{
    gsl_vector_free(*vector);
}

static inline void free_matrix(gsl_matrix **matrix)
{
    gsl_matrix_free(*matrix);
}

#endif
