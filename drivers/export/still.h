/* SPDX-License-Identifier: BSD-3-Clause */
/* One frame in memory: positions and some of its arrays, side by side. */
#ifndef DEM_STILL_H
#define DEM_STILL_H

#include "task.h"

typedef struct still_array {
    const dem_reader_array *what;
    double *values; /* [n_nodes or n_springs][components] of the frame */
} still_array;

typedef struct still {
    const task *task;
    dem_index n_nodes, n_springs;
    double *x; /* [n_nodes][2] m */
    dem_index n_arrays;
    still_array *arrays; /* in the order of `names` */
} still;

/** Which arrays are wanted. */
typedef struct still_choice {
    int of_springs;
    const char *const *names; /* [n_names] those that are there; NULL: all */
    dem_index n_names;
} still_choice;

/** Room for a frame; free with still_free(), after a failure too. */
bool still_open(still *out, const task *t, const still_choice *choice);
void still_free(still *s);

/** False, and the outcome, if the frame cannot be read. */
bool still_read(still *s, dem_index frame);

/** The values of an array of the frame; NULL if it is none of those chosen. */
const double *still_values(const still *s, const char *name);

#endif
