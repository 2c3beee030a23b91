/* SPDX-License-Identifier: BSD-3-Clause */
/* Which frames are shown. */
#ifndef DEM_FRAME_LIST_H
#define DEM_FRAME_LIST_H

#include <stdbool.h>
#include <stddef.h>

#include <dem/dem.h>

enum { FRAME_LIST_USUAL = 6 };

typedef struct frame_list {
    size_t n;
    dem_index *frame; /* [n] in the order asked for */
} frame_list;

void frame_list_free(frame_list *m);

/** "0,5,10" and ranges "FIRST:LAST" or "FIRST:LAST:STEP"; -1 is the last frame, -2 the one before. False if it is none
 *  of this, or without memory; *fault then says what is wrong.
 *  \param n_frames  > 0 */
bool frame_list_parse(frame_list *m, const char *text, dem_index n_frames, const char **fault);

/** "0,2.5e-3": for each instant, s, the frame nearest to it. As frame_list_parse().
 *  \param t  [n_frames], ascending */
bool frame_list_parse_times(frame_list *m, const char *text, dem_index n_frames, const double *t, const char **fault);

/** All of them. False without memory. */
bool frame_list_all(frame_list *m, dem_index n_frames);

/** Six, or all if there are not so many: the first, `middle` and the last; between them one half-way to `middle` and,
 *  where there is room, two that mirror it on the way back. `middle` < 0: evenly. False without memory. */
bool frame_list_usual(frame_list *m, dem_index n_frames, dem_index middle);

/** The frame nearest to an instant. */
dem_index frame_list_nearest(dem_index n_frames, const double *t, double instant);

#endif
