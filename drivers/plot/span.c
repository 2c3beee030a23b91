/* SPDX-License-Identifier: BSD-3-Clause */
#include "span.h"

#include <math.h>

#include "ticks.h"

span_reach span_reach_none(void)
{
    return (span_reach){(double)INFINITY, -(double)INFINITY, 0.0};
}

static void swap(double *a, double *b)
{
    const double kept = *a;
    *a = *b;
    *b = kept;
}

/* Hoare's selection, about the median of three. */
double span_kth(size_t n, double *value, size_t k)
{
    for (size_t lo = 0, hi = n - 1; lo < hi;) {
        double *first = &value[lo], *middle = &value[lo + (hi - lo) / 2], *last = &value[hi];
        if (*middle < *first) swap(middle, first);
        if (*last < *first) swap(last, first);
        if (*last < *middle) swap(last, middle);
        const double pivot = *middle;
        size_t i = lo, j = hi;
        for (;;) {
            while (value[i] < pivot) i++;
            while (pivot < value[j]) j--;
            if (i >= j) break;
            swap(&value[i++], &value[j--]);
        }
        if (k <= j)
            hi = j;
        else
            lo = j + 1;
    }
    return value[k];
}

span_reach span_reach_of(size_t n, const double *value, double *size)
{
    span_reach reach = span_reach_none();
    size_t finite = 0;
    for (size_t k = 0; k < n; k++) {
        if (!isfinite(value[k])) continue;
        reach.least = fmin(reach.least, value[k]);
        reach.most = fmax(reach.most, value[k]);
        size[finite++] = fabs(value[k]);
    }
    if (finite > 0) reach.usual = span_kth(finite, size, (size_t)(0.995 * (double)(finite - 1)));
    return reach;
}

span_reach span_reach_join(span_reach a, span_reach b)
{
    return (span_reach){fmin(a.least, b.least), fmax(a.most, b.most), fmax(a.usual, b.usual)};
}

span span_given(double lo, double hi, span_reach reach)
{
    return (span){lo, hi, reach.least<lo, reach.most> hi};
}

span span_around(span_reach reach, bool both_sides)
{
    const double most = fmax(fabs(reach.least), fabs(reach.most)), usual = fmax(reach.usual, 0.1 * most);
    const double limit = usual > 0.0 && isfinite(usual) ? ticks_above(usual) : 1.0;
    return span_given(both_sides ? -limit : 0.0, limit, reach);
}
