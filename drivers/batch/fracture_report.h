/* SPDX-License-Identifier: BSD-3-Clause */
/* How much of the bodies is broken at the end of a run, and into what. */
#ifndef DEM_FRACTURE_REPORT_H
#define DEM_FRACTURE_REPORT_H

#include <stdio.h>

#include <dem/simulation.h>

/* The lines of the log; none where nothing is broken. */
void fracture_report_print(FILE *out, const dem_simulation *simulation);

#endif
