/* SPDX-License-Identifier: BSD-3-Clause */
/* triangle_share.c: the energy of three coupled springs and the area term against Hooke's law. */
#include "unit/close.h"

#include <gsl/gsl_rng.h>
#include <stdbool.h>

#include "harness/cleanup_gsl.h"
#include "lattice/triangle_share.h"

static const double strains[6][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -1, 0}, {1, 1, 0}, {0.3, -0.7, 0.5}};

/* A random triangle whose area is not below 0.15 of its longest side squared; 0.43 is equilateral. */
static void draw(gsl_rng *r, vec2 corner[3])
{
    double area, longest;
    do {
        longest = 0.0;
        for (int c = 0; c < 3; c++) corner[c] = (vec2){gsl_rng_uniform(r), gsl_rng_uniform(r)};
        for (int c = 0; c < 3; c++) longest = fmax(longest, vec2_norm(vec2_sub(corner[c], corner[(c + 1) % 3])));
        area = vec2_triangle_area(corner[0], corner[1], corner[2]);
    } while (area < 0.15 * longest * longest);
}

/* Energy of the springs and the area term under the strain xx, yy, xy, of first order in every edge. */
static double energy_of(const vec2 corner[3], triangle_share share, double lambda, double G, const double e[3])
{
    const double area = vec2_triangle_area(corner[0], corner[1], corner[2]), modulus = 8.0 / 3.0 * G;
    double stretch[3], length[3], energy = 0.5 * (lambda - G) * area * (e[0] + e[1]) * (e[0] + e[1]);
    for (int c = 0; c < 3; c++) {
        const vec2 d = vec2_sub(corner[(c + 1) % 3], corner[c]);
        length[c] = vec2_norm(d);
        stretch[c] = (e[0] * d.x * d.x + e[1] * d.y * d.y + 2.0 * e[2] * d.x * d.y) / length[c];
    }
    for (int c = 0; c < 3; c++) {
        energy += 0.5 * modulus * area * share.weight[c] * stretch[c] * stretch[c] / (length[c] * length[c]);
        energy += modulus * share.coupling[c] * stretch[c] * stretch[(c + 2) % 3];
    }
    return energy;
}

/* The energy of Hooke's law, of plane stress (E, nu), or of the plate that a solid in plane strain is like. The
 * tolerance is 100 roundings of the largest term, which may be 30 times the energy. */
TEST(any_triangle_has_the_energy_of_hookes_law)
{
    static const double ratios[] = {0.0, 0.1, 0.2, 0.3, 1.0 / 3.0, 0.4, 0.45};
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < 1000; k++) {
        vec2 corner[3];
        draw(r, corner);
        const triangle_share share = triangle_share_coupled(corner);
        const double area = vec2_triangle_area(corner[0], corner[1], corner[2]);
        for (int n = 0; n < 14; n++) {
            const double nu = n < 7 ? ratios[n] : ratios[n - 7] / (1.0 - ratios[n - 7]);
            const double G = 0.5 / (1.0 + nu), lambda = nu / (1.0 - nu * nu);
            for (int s = 0; s < 6; s++) {
                const double *e = strains[s], trace = e[0] + e[1];
                const double squares = e[0] * e[0] + e[1] * e[1] + 2.0 * e[2] * e[2];
                const double expected = area * (0.5 * lambda * trace * trace + G * squares);
                assert_close(energy_of(corner, share, lambda, G, e) / expected, 1.0, 1e-12);
            }
        }
    }
}

/* By hand, of the corners (0, 0), (1, 0), (0, 1): cotangents 0, 1, 1, A = 1/2. Legs have 3/32 4 (3 + 1) = 1.5, the
 * hypotenuse 3/32 16 = 1.5; the legs' coupling is 3/32 2 (3 - 1), that of leg and hypotenuse -3/32 2 sqrt(2). */
TEST(a_right_triangle_has_the_numbers_found_by_hand)
{
    const vec2 corner[3] = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
    const triangle_share share = triangle_share_coupled(corner);
    for (int c = 0; c < 3; c++) assert_close(share.weight[c], 1.5, 1e-15);
    assert_close(share.coupling[0], 0.375, 1e-15);
    assert_close(share.coupling[1], -0.1875 * sqrt(2.0), 1e-15);
    assert_close(share.coupling[2], -0.1875 * sqrt(2.0), 1e-15);
}

/* Of any size and place at which a regular lattice has one; 1e-6 off they are coupled, by the order of that. */
TEST(an_equilateral_triangle_is_not_coupled)
{
    for (double at = 0.0; at < 2e5; at = 10.0 * at + 1.0)
        for (int off = 0; off < 2; off++) {
            const double a = 0.0025, x = at * a, y = at * a * sqrt(3.0) / 2.0;
            const vec2 corner[3] = {{x, y}, {x + a, y}, {x + 0.5 * a, y + a * (sqrt(3.0) / 2.0 + (off ? 1e-6 : 0.0))}};
            const triangle_share share = triangle_share_coupled(corner);
            for (int c = 0; c < 3; c++) {
                assert_close(share.weight[c], 1.0, off ? 1e-5 : 0.0);
                assert_close(share.coupling[c], 0.0, off ? 1e-5 : 0.0);
                assert_int_equal(share.coupling[c] != 0.0, off);
            }
        }
}
