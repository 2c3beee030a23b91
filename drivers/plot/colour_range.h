/* SPDX-License-Identifier: BSD-3-Clause */
/* From which value to which the colours go. */
#ifndef DEM_COLOUR_RANGE_H
#define DEM_COLOUR_RANGE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct colour_range {
    double lo, hi;     /* lo < hi */
    bool below, above; /* values lie outside */
} colour_range;

/** What is known of the values that are to be shown. */
typedef struct colour_range_extent {
    double least, most; /* all lie between */
    double usual;       /* the largest of the frames: 99.5 % of the values of one are no larger in size */
} colour_range_extent;

/** Of no values. */
colour_range_extent colour_range_extent_none(void);

/** Of the values of one frame. \param size  [n], to work in */
colour_range_extent colour_range_extent_of(size_t n, const double *value, double *size);

colour_range_extent colour_range_extent_join(colour_range_extent a, colour_range_extent b);

/** Round limits that hold what is usual, and no less than a tenth of the largest, beside which the rest may be nothing:
 *  the same on both sides of 0, or from 0. One of both sides is left out where no value on it reaches a twentieth of
 *  the limit. */
colour_range colour_range_around(colour_range_extent reach, bool both_sides);

/** Limits as given. */
colour_range colour_range_given(double lo, double hi, colour_range_extent reach);

/** The k-th smallest, from 0; reorders them. */
double colour_range_kth(size_t n, double *value, size_t k);

#endif
