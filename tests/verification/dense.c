/* SPDX-License-Identifier: BSD-3-Clause */
/* See dense.h. */
#include "dense.h"

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_sort_vector.h>

#include "forces/forces.h"

gsl_matrix *dense_stiffness(const dem_model *model, const double *x, double step)
{
    const size_t n = 2 * (size_t)model->lattice.n_nodes;
    const forces acting = {.model = model};
    gsl_matrix *stiffness = gsl_matrix_alloc(n, n);
    CLEANUP(free_memory) double *at = malloc(n * sizeof *at), *still = calloc(n, sizeof *still);
    assert_true(stiffness != NULL && at != NULL && still != NULL);
    memcpy(at, x, n * sizeof *at);
    for (size_t q = 0; q < n; q++) {
        for (size_t i = 0; i < n / 2; i++) {
            at[q] = x[q] + step;
            const vec2 above = forces_of_elements(&acting, (dem_index)i, at, still);
            at[q] = x[q] - step;
            const vec2 below = forces_of_elements(&acting, (dem_index)i, at, still);
            gsl_matrix_set(stiffness, 2 * i, q, (below.x - above.x) / (2.0 * step));
            gsl_matrix_set(stiffness, 2 * i + 1, q, (below.y - above.y) / (2.0 * step));
        }
        at[q] = x[q];
    }
    return stiffness;
}

gsl_vector *dense_frequencies(const dem_model *model, gsl_matrix *stiffness)
{
    const double *mass = model->lattice.mass;
    const size_t n = stiffness->size1;
    gsl_vector *values = gsl_vector_alloc(n);
    gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(n);
    assert_true(values != NULL && work != NULL);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            gsl_matrix_set(stiffness, i, j, gsl_matrix_get(stiffness, i, j) / sqrt(mass[i / 2] * mass[j / 2]));
    assert_int_equal(gsl_eigen_symm(stiffness, values, work), 0);
    gsl_sort_vector(values);
    gsl_eigen_symm_free(work);
    gsl_matrix_free(stiffness);
    return values;
}
