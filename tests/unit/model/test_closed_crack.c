/* SPDX-License-Identifier: BSD-3-Clause */
/* closed_crack.c: what a coupled triangle keeps under pressure is nowhere more than the whole triangle. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>

#include "harness/cleanup_gsl.h"
#include "model/closed_crack.h"

/* A triangle of these corners, with area term of a Poisson's ratio. */
static dem_lattice triangle_of(const double x[6], double nu)
{
    const dem_material solid = {.struct_size = sizeof(dem_material),
                                .youngs_modulus = 1.0,
                                .poissons_ratio = nu,
                                .density = 1.0,
                                .thickness = 1.0,
                                .springs = DEM_SPRINGS_COUPLED};
    dem_lattice l = dem_lattice_empty();
    l.n_nodes = 3;
    l.n_triangles = 1;
    l.x = malloc(6 * sizeof *l.x);
    l.triangles = malloc(3 * sizeof *l.triangles);
    assert_true(l.x != NULL && l.triangles != NULL);
    for (int c = 0; c < 6; c++) l.x[c] = x[c];
    for (int c = 0; c < 3; c++) l.triangles[c] = c;
    assert_ok(dem_lattice_assemble(&l, &solid));
    return l;
}

/* Stiffness of the spring between two corners, N/m. */
static double rate_of(const dem_lattice *l, dem_index i, dem_index j)
{
    for (dem_index k = 0; k < l->n_springs; k++)
        if (l->ends[2 * k] + l->ends[2 * k + 1] == i + j) return l->stiffness[k] / l->rest_length[k];
    return 0.0;
}

/* Twice the energy of the whole triangle at small stretches, with what a negative area term takes: by the moduli of its
 * material, from the strain that has these stretches. In e = (xx, yy, 2 xy) stretches over lengths are
 * n_x^2 xx + n_y^2 yy + n_x n_y 2 xy. */
static double energy(const dem_lattice *l, double nu, const double s[3])
{
    double A[3][3], b[3], e[3];
    const double *x = l->x, area = 0.5 * ((x[2] - x[0]) * (x[5] - x[1]) - (x[4] - x[0]) * (x[3] - x[1]));
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1) % 3;
        const double dx = x[2 * d] - x[2 * c], dy = x[2 * d + 1] - x[2 * c + 1], length = hypot(dx, dy);
        const double n[2] = {dx / length, dy / length};
        A[c][0] = n[0] * n[0], A[c][1] = n[1] * n[1], A[c][2] = n[0] * n[1];
        b[c] = s[c] / length;
    }
    const double det = A[0][0] * (A[1][1] * A[2][2] - A[1][2] * A[2][1]) -
                       A[0][1] * (A[1][0] * A[2][2] - A[1][2] * A[2][0]) +
                       A[0][2] * (A[1][0] * A[2][1] - A[1][1] * A[2][0]);
    for (int k = 0; k < 3; k++) { /* Cramer */
        double M[3][3];
        for (int q = 0; q < 9; q++) M[q / 3][q % 3] = q % 3 == k ? b[q / 3] : A[q / 3][q % 3];
        e[k] = (M[0][0] * (M[1][1] * M[2][2] - M[1][2] * M[2][1]) - M[0][1] * (M[1][0] * M[2][2] - M[1][2] * M[2][0]) +
                M[0][2] * (M[1][0] * M[2][1] - M[1][1] * M[2][0])) /
               det;
    }
    /* Without the positive area term, lambda is G: that of nu = 1/3. */
    const double G = 0.5 / (1.0 + nu), lambda = nu < 1.0 / 3.0 ? nu / (1.0 - nu * nu) : G, trace = e[0] + e[1];
    return area * (lambda * trace * trace + 2.0 * G * (e[0] * e[0] + e[1] * e[1] + 0.5 * e[2] * e[2]));
}

/* Of any shape, down to flat ones, and of any stretches; 1e-12 is rounding of numbers that flat triangles cancel. */
TEST(it_resists_nowhere_more_than_the_whole_triangle)
{
    static const double ratios[] = {0.0, 0.2, 1.0 / 3.0, 0.45};
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    int n_coupled = 0;
    for (int k = 0; k < 4000; k++) {
        const double nu = ratios[k % 4];
        const double x[6] = {0.0, 0.0, 1.0, 0.0, gsl_rng_uniform(r) * 2.0 - 0.5, 0.1 + gsl_rng_uniform(r)};
        CLEANUP(dem_lattice_free) dem_lattice l = triangle_of(x, nu);
        if (l.coupling == NULL) continue;
        const double share[3] = {rate_of(&l, 0, 1), rate_of(&l, 1, 2), rate_of(&l, 2, 0)};
        double part[3];
        closed_crack_parts(&l, 0, share, part);
        n_coupled++;
        for (int q = 0; q < 30; q++) {
            double s[3], kept = 0.0;
            for (int c = 0; c < 3; c++) s[c] = gsl_rng_uniform(r) - 0.5;
            for (int c = 0; c < 3; c++) kept += part[c] * share[c] * s[c] * s[c];
            const double whole = energy(&l, nu, s);
            assert_true(kept > 0.0 && kept <= whole * (1.0 + 1e-12));
        }
        for (int c = 0; c < 3; c++) assert_true(part[c] > 0.0 && part[c] <= 1.0);
    }
    assert_true(n_coupled > 3000);
}

/* Nearly equilateral it keeps nearly all, where there is no area term. */
TEST(an_equilateral_triangle_keeps_all)
{
    const double x[6] = {0.0, 0.0, 1.0, 0.0, 0.5 + 1e-6, 0.5 * sqrt(3.0)};
    CLEANUP(dem_lattice_free) dem_lattice l = triangle_of(x, 1.0 / 3.0);
    const double share[3] = {rate_of(&l, 0, 1), rate_of(&l, 1, 2), rate_of(&l, 2, 0)};
    double part[3];
    assert_non_null(l.coupling);
    closed_crack_parts(&l, 0, share, part);
    for (int c = 0; c < 3; c++) assert_close(part[c], 1.0, 1e-5);
}
