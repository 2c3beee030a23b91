/* SPDX-License-Identifier: BSD-3-Clause */
/* Powers with the same bits on every machine, which the library's pow() does not promise. Strengths that are drawn by
 * one are part of results that are compared to the bit. */
#ifndef DEM_BASE_NATURAL_POWER_H
#define DEM_BASE_NATURAL_POWER_H

#include <math.h>

#include "base/natural_log.h"

/** e^y, infinity or 0 where it is beyond the range of doubles. With y = k ln 2 + r, |r| <= (ln 2)/2, it is 2^k times
 *  the series of e^r, of which the first term left out is below 1e-17. */
static inline double natural_power_of_e(double y)
{
    const double ln2 = 0.693147180559945309417;
    if (y > 710.0) return (double)INFINITY;
    if (y < -746.0) return 0.0;
    const double k = floor(y / ln2 + 0.5), r = y - k * ln2;
    double series = 1.0;
    for (int n = 14; n >= 1; n--) series = 1.0 + series * r / n;
    return ldexp(series, (int)k);
}

/** x^p for x > 0. */
static inline double natural_power(double x, double p)
{
    return natural_power_of_e(p * (x <= 1.0 ? natural_log(x) : -natural_log(1.0 / x)));
}

#endif
