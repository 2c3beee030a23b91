/* SPDX-License-Identifier: BSD-3-Clause */
/* How much of the bodies is broken at the end of a run, and into what. */
#ifndef DEM_FRACTURE_REPORT_H
#define DEM_FRACTURE_REPORT_H

#include <stdio.h>

#include <dem/simulation.h>

typedef struct fracture_report {
    dem_index triangles, springs; /* that are broken */
    dem_index fragments;          /* pieces of all bodies */
    double largest, debris;       /* shares of the mass: of the largest fragment, of all that are single nodes */
    double median; /* kg, mass of the fragment with which, from the smallest on, half of all is reached */
} fracture_report;

/* Of what is seen of the simulation. Without memory all of it is 0. */
fracture_report fracture_report_of(const dem_simulation *simulation);

/* The lines of the log; none where nothing is broken. */
void fracture_report_print(FILE *out, const dem_simulation *simulation);

#endif
