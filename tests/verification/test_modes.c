/* SPDX-License-Identifier: BSD-3-Clause */
/* Small bodies of equal springs k and equal masses m swing in their modes with the frequencies that an independent
 * program has found: the triangle of 3 nodes and the hexagon of 7. */
#include <stdlib.h>

#include <gsl/gsl_eigen.h>

#include "dense.h"
#include "harness/motion.h"
#include "harness/cleanup_gsl.h"

static const double k = 50.0, m = 2.0, amplitude = 1e-6; /* N/m, kg; m, of springs of 1 m */

/* omega^2 m/k, ascending, without the three rigid motions. */
static const double of_triangle[] = {1.5, 1.5, 3.0};
static const double of_hexagon[] = {0.848612181, 0.848612181, 1.0, 1.22930937, 1.22930937, 2.0,
                                    2.65138782,  2.65138782,  3.0, 4.27069063, 4.27069063};

/* Every pair of nodes that is 1 m apart has a spring. */
static void make_body(dem_lattice *out, dem_index n, const double *x)
{
    double mass[7];
    dem_index ends[24], n_springs = 0;
    for (dem_index i = 0; i < n; i++) {
        mass[i] = m;
        for (dem_index j = 0; j < i; j++) {
            if (fabs(hypot(x[2 * i] - x[2 * j], x[2 * i + 1] - x[2 * j + 1]) - 1.0) > 1e-9) continue;
            ends[2 * n_springs] = j;
            ends[2 * n_springs++ + 1] = i;
        }
    }
    *out = support_lattice(n, x, mass, n_springs, ends, 1.0, k, NULL);
}

/* The largest displacement a quarter of a period after the start in a mode, when it should be 0, over the amplitude. */
static double swing(dem_lattice *body, const gsl_matrix *modes, size_t mode, double omega)
{
    support_run run;
    dem_options options = support_options();
    double start[14], worst = 0.0;
    for (size_t q = 0; q < modes->size1; q++) start[q] = body->x[q] + amplitude * gsl_matrix_get(modes, q, mode);
    support_start(body, start, NULL);
    options.gravity[1] = 0.0;
    options.rtol = 1e-12;
    options.v_scale = amplitude * omega;
    support_open(&run, body, NULL, 0, &options);
    const motion state = support_at(&run, 0.5 * M_PI / omega);
    for (size_t q = 0; q < modes->size1; q++) worst = fmax(worst, fabs(state.x[q] - body->x[q]));
    support_close(&run);
    free(body->position);
    body->position = NULL;
    return worst / amplitude;
}

/* Eigenvalues to the nine digits of the table; 1e-5 of the frequency is asked of the motion, in which springs turn by
 * 1e-6: pi/2 times that is left after a quarter of a period. */
static void check_modes(dem_lattice *body, const double *expected, size_t n_modes)
{
    const size_t n = 2 * (size_t)body->n_nodes;
    CLEANUP(free_model) dem_model *model = support_model(body, NULL, 0);
    CLEANUP(free_matrix) gsl_matrix *stiffness = dense_stiffness(model, body->x, 1e-4), *modes = gsl_matrix_alloc(n, n);
    CLEANUP(free_vector) gsl_vector *values = gsl_vector_alloc(n);
    gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(n);
    assert_int_equal(gsl_eigen_symmv(stiffness, values, modes, work), 0);
    assert_int_equal(gsl_eigen_symmv_sort(values, modes, GSL_EIGEN_SORT_VAL_ASC), 0);
    assert_int_equal(n, n_modes + 3);
    for (size_t j = 0; j < n; j++) {
        const double value = gsl_vector_get(values, j) / k, omega = sqrt(value * k / m);
        assert_close(value, j < 3 ? 0.0 : expected[j - 3], 2e-8);
        if (j >= 3) assert_close(swing(body, modes, j, omega), 0.0, 1e-5 * 0.5 * M_PI);
    }
    gsl_eigen_symmv_free(work);
}

TEST(a_triangle_has_its_three_modes)
{
    const double x[6] = {0.0, 0.0, 1.0, 0.0, 0.5, sqrt(3.0) / 2.0};
    CLEANUP(dem_lattice_free) dem_lattice body = dem_lattice_empty();
    make_body(&body, 3, x);
    check_modes(&body, of_triangle, 3);
}

TEST(a_hexagon_has_its_eleven_modes)
{
    double x[14] = {0.0};
    CLEANUP(dem_lattice_free) dem_lattice body = dem_lattice_empty();
    for (int i = 0; i < 6; i++) {
        x[2 * i + 2] = cos(M_PI / 3.0 * i);
        x[2 * i + 3] = sin(M_PI / 3.0 * i);
    }
    make_body(&body, 7, x);
    check_modes(&body, of_hexagon, 11);
}
