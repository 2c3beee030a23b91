/* SPDX-License-Identifier: BSD-3-Clause */
/* Softening of a triangle in tension, the crack band (docs/method.md, Softening). With U what drives it over its
 * strength, and q > 1 the U at which nothing is left, the stress over the strength is to be
 *     s(U) = (q - U)/(q - 1)   from U = 1 on,
 * and a saw-tooth takes its place: at the limits U_k = q^(k/32), k = 0 .. 32, what is left of the triangle falls to
 *     g_k = s(m)/m,   m = (U_k + U_(k+1))/2,
 * and to 0 at the last one. Between limits the triangle is linear elastic. Since the integral of g_k U from U_k to
 * U_(k+1) is that of s, a triangle that breaks has taken the energy of the law, and since the limits are in geometric
 * progression the stress is nowhere further from the law than by q ln q/(64 (q - 1)) of the strength: 0.022, 0.034
 * at q = 2, 6. The powers are products of square roots of square roots of q, which are rounded alike everywhere. */
#ifndef DEM_ELASTIC_SOFTENING_H
#define DEM_ELASTIC_SOFTENING_H

#include <math.h>

enum { SOFTENING_LEVELS = 32 };

/** How many times a triangle softens before it breaks; 0 of a brittle one, q = 1. */
static inline int softening_levels(double q)
{
    return q > 1.0 ? SOFTENING_LEVELS : 0;
}

/** U_k, at which a triangle softens or breaks that has softened k times before. */
static inline double softening_limit(double q, int k)
{
    double limit = 1.0, root = q;
    for (int bit = SOFTENING_LEVELS; bit > 0; bit /= 2) {
        if (k & bit) limit *= root;
        root = sqrt(root);
    }
    return limit;
}

/** What is left in tension after it has softened k times, in (0, 1]. */
static inline double softening_left(double q, int k)
{
    if (k == 0) return 1.0;
    const double middle = 0.5 * (softening_limit(q, k - 1) + softening_limit(q, k));
    return (q / middle - 1.0) / (q - 1.0);
}

#endif
