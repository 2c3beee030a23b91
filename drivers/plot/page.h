/* SPDX-License-Identifier: BSD-3-Clause */
/* A run as one HTML file, which needs no other and no network. */
#ifndef DEM_PAGE_H
#define DEM_PAGE_H

#include <dem/reader.h>

#include "outcome.h"
#include "request.h"

/** As asked for; what was written is said in `log`. False after a fault, which is reported; an older page of that name
 *  is left then. */
bool page_draw(const dem_reader *reader, const request *asked, FILE *log, outcome *o);

#endif
