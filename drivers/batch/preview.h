/* SPDX-License-Identifier: BSD-3-Clause */
/* What is known before a run: the upper part of its log, and all of --check. */
#ifndef DEM_PREVIEW_H
#define DEM_PREVIEW_H

#include <stdio.h>

#include "deck.h"

/** Versions, sizes, bodies, rules of contact, scales, steps, constants and frequency as measured, estimates.
 *  `output`: the file that will be written, NULL: none. */
void preview_print(FILE *out, const deck *d, const dem_simulation *simulation, const char *output);

/** The versions of program, compiler and libraries in one line. */
void preview_versions(char *text, size_t size);

#endif
