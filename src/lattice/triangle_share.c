/* SPDX-License-Identifier: BSD-3-Clause */
/* Three coupled springs for a triangle. The strains e_k of the three edges determine a uniform strain of the triangle,
 * and Hooke's law at nu = 1/3 (lambda = G) makes of them the energy (1/2) sum of K_kl e_k e_l. With cot_k the cotangent
 * of the angle opposite to edge k, of length L_k,
 *     K_kl = G h L_k^2 L_l^2 (3 cot_k cot_l -+ 1)/(4 A),   + for k = l.
 * All cotangents of an equilateral triangle are 1/sqrt(3): its K is diagonal, with (8/3) G h A. What other Poisson's
 * ratios add depends on the change of area alone and is the area term, as it is for equilateral triangles. Here are
 * only the numbers; lattice/assemble.c gives them to springs, and elastic/couplings.c computes the forces. */
#include "lattice/triangle_share.h"

#include <stdbool.h>

/* Squares of lengths that differ by less are those of an equilateral triangle: the coordinates of a regular lattice of
 * 1e5 rows are rounded so much. What is left out of the energy is as small. */
static const double rounding = 1e-10;

static bool is_equilateral(const double square[3])
{
    const double largest = fmax(square[0], fmax(square[1], square[2]));
    return largest - fmin(square[0], fmin(square[1], square[2])) <= rounding * largest;
}

/* K_kk/(L_k (8/3) G h A/L_k) is the weight of edge k, and K_kl/(L_k L_l (8/3) G h) the coupling of edges k and l. */
triangle_share triangle_share_coupled(const vec2 corner[3])
{
    triangle_share share = triangle_share_independent();
    const double area = vec2_triangle_area(corner[0], corner[1], corner[2]);
    vec2 edge[3];
    double square[3], cotangent[3]; /* of the angle at each corner */
    for (int c = 0; c < 3; c++) {
        edge[c] = vec2_sub(corner[(c + 1) % 3], corner[c]);
        square[c] = vec2_dot(edge[c], edge[c]);
    }
    if (is_equilateral(square)) return share;
    for (int c = 0; c < 3; c++) cotangent[c] = -vec2_dot(edge[c], edge[(c + 2) % 3]) / (2.0 * area);
    for (int c = 0; c < 3; c++) {
        const int next = (c + 1) % 3, last = (c + 2) % 3; /* opposite to the edges `last` and c at this corner */
        const double slender = square[c] / area;
        share.weight[c] = 0.09375 * slender * slender * (3.0 * cotangent[last] * cotangent[last] + 1.0);
        share.coupling[c] =
            0.09375 * sqrt(square[c] * square[last]) / area * (3.0 * cotangent[next] * cotangent[last] - 1.0);
    }
    return share;
}
