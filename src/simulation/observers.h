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
    double seen_until;    /* s, of the last step that it has seen; < 0: none */
    dem_index seen;       /* the number of that step; -1: none */
} observer_entry;

/** An accepted step. */
typedef struct accepted_step {
    dem_index number; /* since the start of the run; 0: the start itself */
    double t;         /* s, its end */
    bool touches;     /* whether something has touched in it */
} accepted_step;

typedef struct observers {
    int n;
    observer_entry members[OBSERVERS_MOST];
} observers;

/** \param shown_until  s, frames up to then have been shown; < 0: none
 *  \return DEM_ERROR_ARGUMENT if there are too many, or the interval is not finite, or too short for `shown_until` */
dem_status observers_add(observers *a, const dem_observer *observer, double shown_until);

bool observers_want_events(const observers *a);
bool observers_want_touching(const observers *a);

/** Whether someone is to see the end of this step. */
bool observers_step_due(const observers *a, const accepted_step *step);
bool observers_want_breaks(const observers *a);

/** Call every observer of this rank; the first status other than DEM_OK is returned. */
dem_status observers_event(const observers *a, const dem_simulation *simulation, const dem_event *event);
dem_status observers_broken(const observers *a, const dem_simulation *simulation, const dem_break *what);
dem_status observers_checkpoint(const observers *a, const dem_simulation *simulation, dem_checkpoint *checkpoint);

/** Call those observers of this rank that are to see the end of this step; and those that want to see from where one
 *  goes in which something touches, if they have not. The first status other than DEM_OK is returned. */
dem_status observers_step(observers *a, const dem_simulation *simulation, const accepted_step *step);
dem_status observers_before_touching(observers *a, const dem_simulation *simulation, const accepted_step *step);

/** The observer whose frame is due first until `end` and t_end (s), and when; a frame at t_end is not lost to rounding.
 *  -1: none. */
int observers_due(const observers *a, double end, double t_end, double *t);

/** Calls observer k for its frame. */
dem_status observers_frame(observers *a, int k, const dem_simulation *simulation);

#endif
