/* SPDX-License-Identifier: BSD-3-Clause */
/* What every program here needs: clocks, medians, and an end to what goes wrong. */
#ifndef BENCH_H
#define BENCH_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <dem/dem.h>

static inline void must(bool good, const char *what)
{
    if (good) return;
    (void)fprintf(stderr, "bench: %s\n", what);
    exit(1);
}

static inline void ask(dem_status status)
{
    must(status == DEM_OK, dem_status_message());
}

static inline double seconds(clockid_t clock)
{
    struct timespec now;
    (void)clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static inline int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/** Sorts the values; NAN if there are none. */
static inline double median(double *values, size_t n)
{
    qsort(values, n, sizeof *values, by_size);
    return n > 0 ? values[n / 2] : NAN;
}

#endif
