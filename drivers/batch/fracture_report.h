/* SPDX-License-Identifier: BSD-3-Clause */
/* How much of the bodies is broken at the end of a run. */
#ifndef DEM_FRACTURE_REPORT_H
#define DEM_FRACTURE_REPORT_H

#include <stdio.h>

#include <dem/simulation.h>

typedef struct fracture_report {
    dem_index triangles, springs; /* that are broken */
} fracture_report;

/* Of what is seen of the simulation. Without memory nothing is said to be broken. */
fracture_report fracture_report_of(const dem_simulation *simulation);

/* The line of the log; none where nothing is broken. */
void fracture_report_print(FILE *out, const dem_simulation *simulation);

#endif
