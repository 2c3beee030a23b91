/* SPDX-License-Identifier: BSD-3-Clause */
/* The sizes of fragments as a picture: for some frames, which share of the mass is in fragments up to a mass. */
#ifndef DEM_SIZES_H
#define DEM_SIZES_H

#include <dem/reader.h>

#include "outcome.h"
#include "request.h"

/** What was drawn is written to `log`. False after a fault, which is reported. */
bool sizes_draw(const dem_reader *reader, const request *asked, FILE *log, outcome *o);

/** The share of the sum of masses that those up to `most` have.
 *  \param mass  [n], ascending */
double sizes_share(dem_index n, const double *mass, double most);

/** An axis for masses from lo to hi, both > 0, as decimal logarithms: it has two powers of ten or more. */
void sizes_axis(double lo, double hi, double *begin, double *end);

#endif
