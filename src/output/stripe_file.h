/* SPDX-License-Identifier: BSD-3-Clause */
/* The file of a *stripe*: the rows of one of W equal ranges of nodes, springs and triangles in the arrays of some
 * frames, which another file has as virtual datasets. Any rank can be ordered to write it (base/rank_order.h). Between
 * two orders it is whole in the file system, and closed, or open for the next arrays. */
#ifndef DEM_OUTPUT_STRIPE_FILE_H
#define DEM_OUTPUT_STRIPE_FILE_H

#include "output/frame_stripes.h"

typedef enum stripe_order_kind {
    STRIPE_CREATE, /* the file, without frames, in place of one of that name */
    STRIPE_WRITE,  /* arrays of a frame: the data of the order */
    STRIPE_CLOSE,  /* the file that is open, before anybody reads it */
    STRIPE_LINK,   /* a file of the same stripe, which has just so many frames, gets a second name */
    STRIPE_COPY,   /* frames from another file, which has all rows */
    STRIPE_PUBLISH /* the file, under another name or its own */
} stripe_order_kind;

typedef struct stripe_order {
    stripe_order_kind kind;
    frames whole; /* what frames have, of all rows; no pointers */
    int stripe;
    int first, end;   /* arrays: those of STRIPE_WRITE */
    bool stays_open;  /* after STRIPE_WRITE */
    int64_t run;      /* whose it is */
    hdf5_span frames; /* of STRIPE_WRITE only the first */
    char path[HDF5_PATH], other[HDF5_PATH];
} stripe_order;

/** Whether a file was begun as a stripe of a run, be it torn now; or holds nothing, as one does for a moment. */
bool stripe_file_is_of(const char *path, int64_t run);

#endif
