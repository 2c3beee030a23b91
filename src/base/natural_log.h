/* SPDX-License-Identifier: BSD-3-Clause */
/* A natural logarithm with the same bits on every machine, which the library's log() does not promise. Energies in
 * which one occurs are part of results that are compared to the bit. */
#ifndef DEM_BASE_NATURAL_LOG_H
#define DEM_BASE_NATURAL_LOG_H

/** ln(r) for 0 < r <= 1. With r = m 2^-k and 1/sqrt(2) <= m <= 1 it is ln m - k ln 2, where
 *  ln m = 2 artanh(s) = 2 (s + s^3/3 + s^5/5 + ...), s = (m - 1)/(m + 1). */
static inline double natural_log(double r)
{
    const double ln2 = 0.693147180559945309417;
    double m = r, halvings = 0.0;
    while (m < 0.70710678118654752) {
        m *= 2.0;
        halvings += 1.0;
    }
    const double s = (m - 1.0) / (m + 1.0), s2 = s * s; /* |s| < 0.1716: the first term left out is below 1e-17 */
    double series = 0.0;
    for (int k = 21; k >= 1; k -= 2) series = series * s2 + 1.0 / k;
    return 2.0 * s * series - halvings * ln2;
}

#endif
