/* SPDX-License-Identifier: BSD-3-Clause */
/* The frames and colours that a command line asks for. */
#ifndef DEM_CHOICE_H
#define DEM_CHOICE_H

#include <dem/reader.h>

#include "colour_range.h"
#include "frame_list.h"
#include "outcome.h"
#include "quantity.h"
#include "request.h"

/** Those of --frames or --times; none where neither is given. False after a fault, which is reported: a run without
 *  frames, too. Free with frame_list_free(). */
bool choice_find(frame_list *out, const dem_reader *reader, const request *asked, outcome *o);

/** The limits of the colours: those of --range, else around the values; of what has no order, places in the palette. */
colour_range choice_range(const request *asked, palette_kind scale, colour_range_extent reach);

/** The palette of a quantity between these limits; grey where there is none. */
palette choice_palette(const quantity *shown, colour_range range);

#endif
