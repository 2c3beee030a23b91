/* SPDX-License-Identifier: BSD-3-Clause */
/* The observers of a simulation: which are called for what, and which has the next frame. */
#ifndef DEM_SIMULATION_OBSERVERS_H
#define DEM_SIMULATION_OBSERVERS_H

#include <stdbool.h>

#include <dem/dem.h>

enum { OBSERVERS_MOST = 8 };

typedef struct observer_entry {
    dem_observer observer;
    dem_index next_frame; /* the frame at next_frame * interval comes next */
} observer_entry;

typedef struct observers {
    int n;
    observer_entry members[OBSERVERS_MOST];
} observers;

/** \param shown_until  s, frames up to then have been shown; < 0: none
 *  \return DEM_ERROR_ARGUMENT if there are too many, or the interval is not finite, or too short for `shown_until` */
dem_status observers_add(observers *a, const dem_observer *observer, double shown_until);

bool observers_want_events(const observers *a);
bool observers_want_steps(const observers *a);
bool observers_want_breaks(const observers *a);

/** Call every observer of this rank; the first status other than DEM_OK is returned. */
dem_status observers_event(const observers *a, const dem_simulation *simulation, const dem_event *event);
dem_status observers_broken(const observers *a, const dem_simulation *simulation, const dem_break *what);
dem_status observers_step(const observers *a, const dem_simulation *simulation);
dem_status observers_checkpoint(const observers *a, const dem_simulation *simulation, dem_checkpoint *checkpoint);

/** The observer whose frame is due first until `end` and t_end (s), and when; a frame at t_end is not lost to rounding.
 *  -1: none. */
int observers_due(const observers *a, double end, double t_end, double *t);

/** Calls observer k for its frame. */
dem_status observers_frame(observers *a, int k, const dem_simulation *simulation);

#endif
