/* SPDX-License-Identifier: BSD-3-Clause */
/* The frames that a command line asks for. */
#ifndef DEM_CHOICE_H
#define DEM_CHOICE_H

#include <dem/reader.h>

#include "frame_list.h"
#include "outcome.h"
#include "request.h"

/** Those of --frames or --times; none where neither is given. False after a fault, which is reported: a run without
 *  frames, too. Free with frame_list_free(). */
bool choice_find(frame_list *out, const dem_reader *reader, const request *asked, outcome *o);

#endif
