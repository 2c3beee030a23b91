/* SPDX-License-Identifier: BSD-3-Clause */
#include "holed_plate.h"

#include "harness/cleanup_gsl.h"
#include "support.h"

#include <complex.h>
#include <gsl/gsl_multifit.h>
#include <stdbool.h>

typedef double _Complex number;

enum { terms = HOLED_PLATE_TERMS, unknowns = HOLED_PLATE_UNKNOWNS, points = 150 };

/* Adds what a_n alone makes at z. */
static void add_term(double a, int n, number z, double stress[3])
{
    const number power = cpow(z, 2 * n), f = a * power, slope = 2.0 * n * f / z;
    const number g = a * ((1.0 - 2.0 * n) * power + 1.0 / power) / (z * z);
    const number sum = 4.0 * creal(f), difference = 2.0 * (conj(z) * slope + g);
    stress[0] += 0.5 * creal(sum - difference);
    stress[1] += 0.5 * creal(sum + difference);
    stress[2] += 0.5 * cimag(difference);
}

/* Makes the terms of order 1 at the corner. */
static double unit_of(const holed_plate *p, int n)
{
    return pow(hypot(p->length, p->height), n < 0 ? 2 * n + 2 : -2 * n);
}

/* The two tractions at point k: on the end, where one is 1, then on the long edge, which is free. */
static void set_rows(const holed_plate *p, int k, gsl_matrix *m, gsl_vector *right)
{
    const double s = (k % points + 0.5) / points;
    const bool end = k < points;
    const number z = end ? p->length + I * s * p->height : s * p->length + I * p->height;
    for (int n = -terms; n <= terms; n++) {
        double stress[3] = {0.0, 0.0, 0.0};
        add_term(unit_of(p, n), n, z, stress);
        gsl_matrix_set(m, 2 * (size_t)k, (size_t)(n + terms), end ? stress[0] : stress[1]);
        gsl_matrix_set(m, 2 * (size_t)k + 1, (size_t)(n + terms), stress[2]);
    }
    gsl_vector_set(right, 2 * (size_t)k, end ? 1.0 : 0.0);
    gsl_vector_set(right, 2 * (size_t)k + 1, 0.0);
}

holed_plate holed_plate_solve(double length, double height)
{
    const size_t n = 4 * points;
    holed_plate p = {.length = length, .height = height};
    CLEANUP(free_matrix)
    gsl_matrix *m = gsl_matrix_alloc(n, unknowns), *covariance = gsl_matrix_alloc(unknowns, unknowns);
    CLEANUP(free_vector)
    gsl_vector *right = gsl_vector_alloc(n), *left = gsl_vector_alloc(n), *a = gsl_vector_alloc(unknowns);
    gsl_multifit_linear_workspace *work = gsl_multifit_linear_alloc(n, unknowns);
    double square;
    for (int k = 0; k < 2 * points; k++) set_rows(&p, k, m, right);
    assert_int_equal(gsl_multifit_linear(m, right, a, covariance, &square, work), 0);
    assert_int_equal(gsl_multifit_linear_residuals(m, right, a, left), 0);
    for (int k = 0; k < unknowns; k++) p.a[k] = gsl_vector_get(a, (size_t)k) * unit_of(&p, k - terms);
    p.error = fmax(gsl_vector_max(left), -gsl_vector_min(left));
    gsl_multifit_linear_free(work);
    return p;
}

double holed_plate_stress(const holed_plate *p, double y)
{
    double stress[3] = {0.0, 0.0, 0.0};
    for (int n = -terms; n <= terms; n++) add_term(p->a[n + terms], n, I * y, stress);
    return stress[0];
}
