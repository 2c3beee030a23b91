/* SPDX-License-Identifier: BSD-3-Clause */
/* What has broken in a run: the first break and under which load, how much is broken at the end, and into what. */
#ifndef DEM_FRACTURE_REPORT_H
#define DEM_FRACTURE_REPORT_H

#include <stdio.h>

#include <dem/observer.h>

/** The largest force on the bodies by a boundary or by the lasting contacts of an obstacle. */
typedef struct fracture_report_load {
    double force[2];              /* N */
    dem_index boundary, obstacle; /* whose it is, from 1; 0: none of these */
} fracture_report_load;

/** To be set to 0. */
typedef struct fracture_report {
    dem_index breaks;
    double first_t, first_x[2]; /* s, m, of the first of them */
    fracture_report_load load;  /* of the last step before it */
} fracture_report;

/** To be called after every accepted step, and after the breaks in it: what breaks takes load off at once. */
void fracture_report_follow(fracture_report *r, const dem_simulation *simulation);

/** To be called at every break. */
void fracture_report_note(fracture_report *r, const dem_break *what);

/** The lines of the log; none where nothing is broken. */
void fracture_report_print(FILE *out, const fracture_report *r, const dem_simulation *simulation);

#endif
