/* SPDX-License-Identifier: BSD-3-Clause */
/* The observers of a simulation: whom is told what, and whose frame comes next. */
#ifndef DEM_SIMULATION_OBSERVERS_H
#define DEM_SIMULATION_OBSERVERS_H

#include <stdbool.h>

#include <dem/dem.h>

enum { AUDIENCE_MOST = 8 };

typedef struct audience_member {
    dem_observer observer;
    dem_index next_frame; /* the frame at next_frame * interval comes next */
} audience_member;

typedef struct audience {
    int n;
    audience_member members[AUDIENCE_MOST];
} audience;

/** \param told  s, frames up to then have been shown; < 0: none
 *  \return DEM_ERROR_ARGUMENT if there are too many, or the interval is not finite, or too short for `told` */
dem_status audience_add(audience *a, const dem_observer *observer, double told);

bool audience_hears_events(const audience *a);

/** Tell everyone; the first status other than DEM_OK counts. */
dem_status audience_event(const audience *a, const dem_simulation *simulation, const dem_event *event);
dem_status audience_step(const audience *a, const dem_simulation *simulation);
dem_status audience_record(const audience *a, const dem_simulation *simulation, dem_record *record);

/** Whose frame is due first, up to t_end (s), and when; one at t_end is not lost to rounding. -1: nobody's. */
int audience_due(const audience *a, double end, double t_end, double *t);

/** Shows a member its frame. */
dem_status audience_frame(audience *a, int k, const dem_simulation *simulation);

#endif
