/* SPDX-License-Identifier: BSD-3-Clause */
/* The law of two surfaces near each other: at the distance d < delta they push each other apart with the pressure
 *   p = M (1 - u)^2/u,   u = d/delta,
 * the negative derivative of the potential psi(d). delta is the contact thickness, m, and M the contact modulus, N/m.
 * The pressure begins with value and slope 0 at d = delta and has no bound at d = 0, so that no finite energy brings
 * two surfaces together. Here all is without dimension; where the distance comes from is in contact_pair.c. */
#ifndef DEM_SURFACE_CONTACT_CONTACT_POTENTIAL_H
#define DEM_SURFACE_CONTACT_CONTACT_POTENTIAL_H

#include "base/natural_log.h"

/** p/M at 0 < u < 1. */
static inline double contact_potential_pressure(double u)
{
    return (1.0 - u) * (1.0 - u) / u;
}

/** -dp/dd delta/M at 0 < u < 1: 1/u^2 - 1. */
static inline double contact_potential_stiffness(double u)
{
    return (1.0 - u * u) / (u * u);
}

/** psi/(M delta) at 0 < u < 1: -ln u - 2 (1 - u) + (1 - u^2)/2. With w = 1 - u this is w^3/3 + w^4/4 + ..., which is
 *  summed where the logarithm would lose all digits. The terms left out are below 1e-17 of the sum. */
static inline double contact_potential_energy(double u)
{
    const double w = 1.0 - u;
    double series = 0.0;
    if (w > 0.125) return -natural_log(u) - w - 0.5 * w * w;
    for (int k = 21; k >= 3; k--) series = series * w + 1.0 / k;
    return w * w * w * series;
}

#endif
