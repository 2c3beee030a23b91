/* SPDX-License-Identifier: BSD-3-Clause */
/* The history of a run as a picture: charts one below the other over one axis of time. */
#ifndef DEM_TIMELINE_H
#define DEM_TIMELINE_H

#include <dem/reader.h>

#include "outcome.h"
#include "request.h"

/** Energies, reactions of obstacles, forces of boundaries, contacts and steps, of those that the trajectory has; what
 *  was drawn is written to `log`. False after a fault, which is reported. */
bool timeline_draw(const dem_reader *reader, const request *asked, FILE *log, outcome *o);

#endif
