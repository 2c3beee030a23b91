/* SPDX-License-Identifier: BSD-3-Clause */
/* The file of a *stripe*: the rows of one of W equal ranges of nodes, springs and triangles in the arrays of some
 * frames, which another file has as virtual datasets. Any rank can be ordered to write it (rank_work.c). Between two
 * orders it is whole in the file system, and closed, or paused for the next frame. */
#ifndef DEM_OUTPUT_STRIPE_FILE_H
#define DEM_OUTPUT_STRIPE_FILE_H

#include "base/numbered_file.h"
#include "output/frame_stripes.h"

typedef enum stripe_order_kind {
    STRIPE_CREATE, /* the file, without frames, in place of one of that name */
    STRIPE_CLOSE,  /* the file that is open, before anybody reads it */
    STRIPE_LINK,   /* a file of the same stripe, which has just so many frames, gets a second name */
    STRIPE_COPY,   /* frames from another file, which has all rows */
    STRIPE_PUBLISH /* the file, under another name or its own */
} stripe_order_kind;

typedef struct stripe_order {
    stripe_order_kind kind;
    frames whole; /* what frames have, of all rows; no pointers */
    int stripe;
    int64_t run; /* whose it is */
    hdf5_span frames;
    char path[HDF5_PATH], other[HDF5_PATH];
} stripe_order;

/** The files of a number of stripes, those of a segment. */
typedef struct stripe_name {
    char path[HDF5_PATH]; /* NAME.vtkhdf */
    dem_index number;     /* of the segment */
    int n;                /* stripes; 0: there are none */
} stripe_name;

/** Characters of NAME in NAME.vtkhdf. */
int stripe_file_stem(const char *whole);

/** The path of a file of NAME.  \param whole  NAME.vtkhdf  \return DEM_ERROR_IO if it is too long */
dem_status stripe_file_path(char out[HDF5_PATH], const char *whole, numbered_file file);

/** A file that a rank has, paused. */
typedef struct open_stripe open_stripe;

/** Opens or resumes it to add up to about `bytes`.
 *  \param kept  what this rank has, NULL at first; another file is closed */
dem_status stripe_file_enter(open_stripe **kept, const stripe_name *name, int stripe, hsize_t bytes);

/** The file, from there to stripe_file_leave(). */
const hdf5_file *stripe_file_entered(const open_stripe *s);

/** Pauses or closes it.  \return `status` if that is a failure already */
dem_status stripe_file_leave(open_stripe **kept, bool stays_open, dem_status status);

/** Closes what this rank has. */
dem_status stripe_file_close(open_stripe **kept);

/** Carries an order out, after what this rank has is closed. */
dem_status stripe_file_obey(open_stripe **kept, const stripe_order *o);

/** Whether a file was begun as a stripe of a run, be it torn now; or holds nothing, as one does for a moment. */
bool stripe_file_is_of(const char *path, int64_t run);

#endif
