/* SPDX-License-Identifier: BSD-3-Clause */
/* What has broken in a run: the first break, how much is broken at the end, and into what. */
#ifndef DEM_FRACTURE_REPORT_H
#define DEM_FRACTURE_REPORT_H

#include <stdio.h>

#include <dem/observer.h>

/** To be set to 0. */
typedef struct fracture_report {
    dem_index breaks;
    double first_t, first_x[2]; /* s, m, of the first of them */
} fracture_report;

/** To be called at every break. */
void fracture_report_note(fracture_report *r, const dem_break *what);

/** The lines of the log; none where nothing is broken. */
void fracture_report_print(FILE *out, const fracture_report *r, const dem_simulation *simulation);

#endif
