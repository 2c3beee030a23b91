/* SPDX-License-Identifier: BSD-3-Clause */
/* The results of a run as one number: a hash of the bits of all that the library shows of it. */
#ifndef DEM_TEST_TRACE_H
#define DEM_TEST_TRACE_H

#include <stdint.h>

#include <dem/dem.h>

typedef struct trace {
    uint64_t hash;
    dem_index n_events;
} trace;

trace trace_begin(void);

/** Adds the time and the length of each step, each event, and all there is to see at frames that are `interval` apart,
 *  s; borrows the trace. */
dem_observer trace_observer(trace *t, double interval);

/** Adds all there is to see of a simulation now. */
void trace_add_all(trace *t, const dem_simulation *simulation);

/** Adds what a trajectory's file says: lattice, times, arrays of all frames and tables, as decoded. */
void trace_add_frames(trace *t, const char *path);

#endif
