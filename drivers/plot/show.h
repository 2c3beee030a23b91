/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames of a trajectory as pictures: a strip of some, or numbered files of all. */
#ifndef DEM_SHOW_H
#define DEM_SHOW_H

#include <dem/reader.h>

#include "outcome.h"
#include "request.h"

/** As asked for; what was drawn is written to `log`. False after a fault, which is reported. */
bool show_strip(const dem_reader *reader, const request *asked, FILE *log, outcome *o);
bool show_animation(const dem_reader *reader, const request *asked, FILE *log, outcome *o);

#endif
