/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact of bodies with each other in the log of a run: what it begins with, and how near surfaces have come. */
#ifndef DEM_SURFACE_REPORT_H
#define DEM_SURFACE_REPORT_H

#include <stdio.h>

#include <dem/dem.h>

/** Extremes over accepted steps. To be set to 0. */
typedef struct surface_report {
    double nearest, nearest_t; /* smallest distance over thickness, and when, s; nearest_t is 0 if nothing pushed */
    double first_t;            /* s, of the first push */
    dem_index most;            /* pairs that pushed at once */
    double energy;             /* J, of contact, the largest */
} surface_report;

/** The line before the run; none without contact of bodies. */
void surface_report_print(FILE *out, const dem_simulation *simulation);

/** To be called after every accepted step. */
void surface_report_follow(surface_report *p, const dem_simulation *simulation, double t);

/** The line behind the run; none if nothing pushed. */
void surface_report_print_nearest(FILE *out, const surface_report *p);

#endif
