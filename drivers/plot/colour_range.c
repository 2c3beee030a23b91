/* SPDX-License-Identifier: BSD-3-Clause */
#include "colour_range.h"

#include <math.h>

#include "ticks.h"

static const double least_side = 0.05; /* of the limit: what is smaller has next to the colour of 0 */

colour_range_extent colour_range_extent_none(void)
{
    return (colour_range_extent){(double)INFINITY, -(double)INFINITY, 0.0};
}

static void swap(double *a, double *b)
{
    const double kept = *a;
    *a = *b;
    *b = kept;
}

/* Hoare's selection, about the median of three. */
double colour_range_kth(size_t n, double *value, size_t k)
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

colour_range_extent colour_range_extent_of(size_t n, const double *value, double *size)
{
    colour_range_extent reach = colour_range_extent_none();
    size_t finite = 0;
    for (size_t k = 0; k < n; k++) {
        if (!isfinite(value[k])) continue;
        reach.least = fmin(reach.least, value[k]);
        reach.most = fmax(reach.most, value[k]);
        size[finite++] = fabs(value[k]);
    }
    if (finite > 0) reach.usual = colour_range_kth(finite, size, (size_t)(0.995 * (double)(finite - 1)));
    return reach;
}

colour_range_extent colour_range_extent_join(colour_range_extent a, colour_range_extent b)
{
    return (colour_range_extent){fmin(a.least, b.least), fmax(a.most, b.most), fmax(a.usual, b.usual)};
}

colour_range colour_range_given(double lo, double hi, colour_range_extent reach)
{
    return (colour_range){lo, hi, reach.least<lo, reach.most> hi};
}

colour_range colour_range_around(colour_range_extent reach, bool both_sides)
{
    const double most = fmax(fabs(reach.least), fabs(reach.most)), usual = fmax(reach.usual, 0.1 * most);
    const double limit = usual > 0.0 && isfinite(usual) ? ticks_above(usual) : 1.0;
    if (!both_sides) return colour_range_given(0.0, limit, reach);
    const bool is_above = reach.most > least_side * limit, is_below = reach.least < -least_side * limit;
    return colour_range_given(is_above && !is_below ? 0.0 : -limit, is_below && !is_above ? 0.0 : limit, reach);
}
