/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact of bodies with each other in the log of a run: what it begins with, and how near surfaces have come. */
#ifndef DEM_SURFACE_REPORT_H
#define DEM_SURFACE_REPORT_H

#include <stdbool.h>
#include <stdio.h>

#include <dem/dem.h>

#include "run_log.h"

/** The first time that surfaces were so near that the log warns. */
typedef struct surface_report_warning {
    bool given;
    dem_index node, body;
    double x[2], t, share; /* m, s, over the contact thickness */
} surface_report_warning;

/** Extremes over t = 0 and all accepted steps; all but `most` are known if that is not 0. To be set to 0. */
typedef struct surface_report {
    double nearest, nearest_t; /* smallest distance over thickness, and when, s */
    double pressure;           /* over the contact modulus, the largest: that at the smallest distance over thickness */
    double gap, gap_t;         /* smallest distance, m, and when, s */
    double first_t;            /* s, of the first push */
    dem_index most;            /* pairs that pushed at once */
    double energy;             /* J, of contact, the largest */
    surface_report_warning warning;
} surface_report;

/** The line before the run; none without contact of bodies. */
void surface_report_print(FILE *out, const dem_simulation *simulation);

/** To be called at t = 0 and after every accepted step.  \return whether the log has to warn now */
bool surface_report_follow(surface_report *p, const dem_simulation *simulation, double t);

/** To be called at t = 0 and after accepted steps: looks for the largest energy of their contact. */
void surface_report_look(surface_report *p, const dem_simulation *simulation);

/** Warns that surfaces have come very near, where and when they first did. */
void surface_report_warn(const surface_report *p, run_log *log);

/** The line behind the run; none if nothing pushed. */
void surface_report_print_nearest(FILE *out, const surface_report *p);

#endif
