/* SPDX-License-Identifier: BSD-3-Clause */
/* What is known before a run: the upper part of its log, and all of --check. */
#ifndef DEM_PREVIEW_H
#define DEM_PREVIEW_H

#include <stddef.h>

#include "deck.h"
#include "run_log.h"

/** Sizes, mass, constants as measured, steps, warnings, the `output` that will be written (NULL: none). A verbose log
 *  has versions, contact, details of the bodies, loads, probes, scales, stability, frequency and memory, too. */
void preview_print(run_log *log, const deck *d, const dem_simulation *simulation, const char *output);

/** The versions of program, compiler and libraries in one line. */
void preview_versions(char *text, size_t size);

#endif
