/* SPDX-License-Identifier: BSD-3-Clause */
/* With s the stretches of its edges a whole triangle has the energy (1/2) s.K s: shares and couplings, and where it is
 * negative the area term, which counts along with the couplings then. Its edges cannot keep their own shares under
 * pressure, which in a flat triangle are much larger than what it resists, as couplings take from them. Edge k alone,
 * the others giving way, has the stiffness c_k = 1/(K^-1)_kk. With r_kl = (K^-1)_kl sqrt(c_k c_l) the diagonal matrix
 * of c_k over the largest of the sums of |r_kl| over l is nowhere above K, as no eigenvalue of r is above that sum. So
 * a triangle that softens never gains energy, and bounds of frequencies hold. Without couplings it is K itself. */
#include "model/closed_crack.h"

#include <math.h>

#include "base/vec2.h"

/* The change of the area by the stretch of edge k is L cot/2, with the angle opposite to it. */
static void add_area(const dem_lattice *l, dem_index triangle, double K[3][3])
{
    const double kappa = l->area_stiffness != NULL ? fmin(l->area_stiffness[triangle], 0.0) : 0.0;
    vec2 edge[3];
    double slope[3];
    for (int c = 0; c < 3; c++) {
        const dem_index *corner = &l->triangles[3 * triangle];
        edge[c] = vec2_sub(vec2_at(l->x, corner[(c + 1) % 3]), vec2_at(l->x, corner[c]));
    }
    const double area = 0.5 * vec2_cross(edge[0], edge[1]);
    for (int k = 0; k < 3; k++)
        slope[k] = -0.25 * vec2_norm(edge[k]) * vec2_dot(edge[(k + 1) % 3], edge[(k + 2) % 3]) / area;
    for (int k = 0; k < 9; k++) K[k / 3][k % 3] += kappa / area * slope[k / 3] * slope[k % 3];
}

/* K^-1 times the determinant of K. */
static void adjugate(double K[3][3], double out[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            out[i][j] = K[a][c] * K[b][d] - K[a][d] * K[b][c];
        }
}

void closed_crack_parts(const dem_lattice *l, dem_index triangle, const double share[3], double part[3])
{
    const double *coupling = &l->coupling[3 * triangle];
    double K[3][3] = {{0.0}}, inverse[3][3], most = 0.0;
    for (int c = 0; c < 3; c++) {
        K[c][c] += share[c];
        K[c][(c + 2) % 3] += coupling[c];
        K[(c + 2) % 3][c] += coupling[c];
    }
    add_area(l, triangle, K);
    adjugate(K, inverse);
    const double determinant = K[0][0] * inverse[0][0] + K[0][1] * inverse[1][0] + K[0][2] * inverse[2][0];
    for (int i = 0; i < 3; i++) {
        double sum = 0.0;
        for (int j = 0; j < 3; j++) sum += fabs(inverse[i][j]) / sqrt(inverse[i][i] * inverse[j][j]);
        most = fmax(most, sum);
    }
    for (int k = 0; k < 3; k++) part[k] = determinant / (inverse[k][k] * most * share[k]);
}
