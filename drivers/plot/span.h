/* SPDX-License-Identifier: BSD-3-Clause */
/* From which value to which the colours go. */
#ifndef DEM_SPAN_H
#define DEM_SPAN_H

#include <stdbool.h>
#include <stddef.h>

typedef struct span {
    double lo, hi;     /* lo < hi */
    bool below, above; /* values lie outside */
} span;

/** What is known of the values that are to be shown. */
typedef struct span_reach {
    double least, most; /* all lie between */
    double usual;       /* the largest of the frames: 99.5 % of the values of one are no larger in size */
} span_reach;

/** Of no values. */
span_reach span_reach_none(void);

/** Of the values of one frame. \param size  [n], to work in */
span_reach span_reach_of(size_t n, const double *value, double *size);

span_reach span_reach_join(span_reach a, span_reach b);

/** Round limits that hold what is usual, and no less than a tenth of the largest, beside which the rest may be nothing:
 *  the same on both sides of 0, or from 0. */
span span_around(span_reach reach, bool both_sides);

/** Limits as given. */
span span_given(double lo, double hi, span_reach reach);

/** The k-th smallest, from 0; reorders them. */
double span_kth(size_t n, double *value, size_t k);

#endif
