/* SPDX-License-Identifier: BSD-3-Clause */
/* A sum of doubles with twice their digits: the second number has what additions to the first have rounded away,
 * without an error of its own as long as it fits into a double. Its value is that of the exact sum, rounded, unless
 * this lies within some 1e-15 of the rounding from the middle between two doubles. Terms are nevertheless added in an
 * order that does not depend on timing. The same for vectors is in elastic/lanes_twofold.h, to the same bits. */
#ifndef DEM_BASE_TWOFOLD_H
#define DEM_BASE_TWOFOLD_H

#include <math.h>

/** {0} is the empty sum. */
typedef struct twofold {
    double high, low;
} twofold;

/** What the sum of a and b is short of a + b, exactly (Knuth's TwoSum). */
static inline double twofold_rest(double a, double b, double sum)
{
    const double kept = sum - a;
    return (a - (sum - kept)) + (b - kept);
}

static inline void twofold_add(twofold *s, double term)
{
    const double sum = s->high + term;
    s->low += twofold_rest(s->high, term, sum);
    s->high = sum;
}

/** Adds another sum. */
static inline void twofold_join(twofold *s, twofold other)
{
    twofold_add(s, other.high);
    s->low += other.low;
}

/** The sum, rounded. If it is not finite it is what additions of doubles give, and there is no rest to it. */
static inline double twofold_value(twofold s)
{
    return isfinite(s.low) ? s.high + s.low : s.high;
}

#endif
