/* SPDX-License-Identifier: BSD-3-Clause */
/* Profiles of the ground y(x), sampled to polylines: a smooth curve through points, or a rough one about straight lines
 * (GSL interpolation and random numbers). */
#ifndef DEM_PROFILE_H
#define DEM_PROFILE_H

#include <stdbool.h>

#include <dem/dem.h>

/* More segments than this are refused: the library checks and searches them one by one. */
#define PROFILE_MAX 100000
/* Segments of a correlation length: with fewer the profile would not have it, more take time and show nothing. */
#define PROFILE_COARSEST 2
#define PROFILE_FINEST   1000

typedef struct profile_recipe {
    const double *points; /* [n_points][2], m; x increases */
    size_t n_points;      /* >= 2 */
    size_t n_segments;    /* 1 to PROFILE_MAX, equally long along x */
    bool smooth;          /* else straight lines from point to point */
    double roughness;     /* m, root mean square height added, >= 0 */
    double correlation;   /* m, of PROFILE_COARSEST to PROFILE_FINEST segments; not used without roughness */
    unsigned long seed;
} profile_recipe;

/* Samples the mean line and adds the heights, also at its ends. The smooth curve is Steffen's: it goes through the
 * points with a continuous slope and has its highs and lows at points only, so it does not overshoot; two points are
 * joined by a straight line. The heights are a stationary Gaussian process of mean 0 and autocorrelation
 * exp(-(d/correlation)^2); the same seed gives the same ones on every machine. Sets no message.
 * \param[out] out  [n_segments + 1][2]
 * \return DEM_ERROR_ARGUMENT for a recipe outside the ranges above; DEM_ERROR_MEMORY */
dem_status profile_sample(double *out, const profile_recipe *recipe);

#endif
