/* SPDX-License-Identifier: BSD-3-Clause */
/* See triplets.h. */
#include "triplets.h"

#include <gsl/gsl_errno.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

int triplets_derivative(double t, const double y[], double f[], void *lattice)
{
    const dem_lattice *l = lattice;
    const dem_index n = 2 * l->n_nodes;
    (void)t;
    memcpy(f, y + n, (size_t)n * sizeof *f);
    memset(f + n, 0, (size_t)n * sizeof *f);
    for (dem_index k = 0; k < l->n_springs; k++) {
        const dem_index i = l->ends[2 * k], j = l->ends[2 * k + 1];
        const double dx = y[2 * j] - y[2 * i], dy = y[2 * j + 1] - y[2 * i + 1], d = hypot(dx, dy);
        const double force = l->stiffness[k] * (d - l->rest_length[k]) / l->rest_length[k];
        f[n + 2 * i] += force * dx / d / l->mass[i];
        f[n + 2 * i + 1] += force * dy / d / l->mass[i];
        f[n + 2 * j] -= force * dx / d / l->mass[j];
        f[n + 2 * j + 1] -= force * dy / d / l->mass[j];
    }
    return GSL_SUCCESS;
}

void triplets_start(const dem_lattice *l, double *y)
{
    const size_t n = 2 * (size_t)l->n_nodes;
    memcpy(y, l->position != NULL ? l->position : l->x, n * sizeof *y);
    memset(y + n, 0, n * sizeof *y);
    if (l->velocity != NULL) memcpy(y + n, l->velocity, n * sizeof *y);
}

void triplets_steps(dem_lattice *lattice, const gsl_odeiv2_step_type *type, int n, double h, double *y)
{
    const size_t size = 4 * (size_t)lattice->n_nodes;
    gsl_odeiv2_system system = {triplets_derivative, NULL, size, lattice};
    gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(type, size);
    CLEANUP(free_memory) double *error = malloc(size * sizeof *error);
    assert_true(step != NULL && error != NULL);
    for (int k = 0; k < n; k++)
        assert_int_equal(gsl_odeiv2_step_apply(step, k * h, h, y, error, NULL, NULL, &system), GSL_SUCCESS);
    gsl_odeiv2_step_free(step);
}

void triplets_reach(dem_lattice *lattice, double t, double *y)
{
    gsl_odeiv2_system system = {triplets_derivative, NULL, 4 * (size_t)lattice->n_nodes, lattice};
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-6, 1e-13, 1e-13);
    double now = 0.0;
    assert_non_null(driver);
    assert_int_equal(gsl_odeiv2_driver_apply(driver, &now, t, y), GSL_SUCCESS);
    gsl_odeiv2_driver_free(driver);
}
