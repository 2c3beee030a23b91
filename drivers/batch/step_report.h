/* SPDX-License-Identifier: BSD-3-Clause */
/* How fast a run may go and goes: its method and step, stability, and (6), which says nothing about that. */
#ifndef DEM_STEP_REPORT_H
#define DEM_STEP_REPORT_H

#include <stdbool.h>
#include <stdio.h>

#include <dem/dem.h>

enum { STEP_REPORT_WHY = 320 }; /* bytes */

/** The largest value of (6),  (|v_x| + |v_y|) h/spacing  over nodes and accepted steps. To be set to 0. */
typedef struct step_report {
    double largest, t; /* t: s, when */
} step_report;

/** The method of a simulation; it exists, so that the method is known. */
dem_method_traits step_report_method(const dem_simulation *simulation);

/** What is known before the run: its steps, and up to which step it is safe: up to there no undamped oscillation grows
 *  by more than a thousandth in a step.
 *  \param until     the end of the run in words, which "N steps" follows
 *  \param undamped  s, the step that damping has shortened; 0: it has not */
void step_report_print(FILE *out, const char *until, double steps, double undamped, const dem_simulation *simulation);

/** Order and cost of the method, stability bound, kernel, (6) at v_scale. */
void step_report_print_details(FILE *out, const dem_simulation *simulation);

/** Whether a fixed step is longer than that, and what to do about it.
 *  \param[out] why  [STEP_REPORT_WHY], "" if it is not */
bool step_report_is_long(const dem_simulation *simulation, char *why);

/** To be called after accepted steps: the largest is that of these. */
void step_report_follow(step_report *p, const dem_simulation *simulation, const dem_progress *now);

void step_report_print_largest(FILE *out, const step_report *p);

#endif
