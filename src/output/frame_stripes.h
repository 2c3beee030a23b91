/* SPDX-License-Identifier: BSD-3-Clause */
/* The stripes of frames: their arrays in n_stripes files, of which each has one of equal ranges of nodes, springs and
 * triangles, all frames one behind the other. */
#ifndef DEM_OUTPUT_FRAME_STRIPES_H
#define DEM_OUTPUT_FRAME_STRIPES_H

#include "output/frame_arrays.h"

/** The frames of stripe k, 0 <= k < f->n_stripes, which are all in one file. */
frames frame_stripes_get(const frames *f, int k);

/** Makes the arrays in the file of a stripe, without frames. */
dem_status frame_stripes_create(const frames *stripe, const hdf5_file *file);

/** Copies frames of a file of the whole into that of stripe k. */
dem_status frame_stripes_copy(const frames *f, int k, const hdf5_file *from, const hdf5_file *to, hdf5_span span);

/** How many frames a file has of stripes. */
typedef struct frame_stripes_mapped {
    bool grow;      /**< as many as there are */
    hsize_t frames; /**< 0 where they grow */
} frame_stripes_mapped;

/** Lets a file have frames of arrays whose rows are in stripes; and an upper bound of the bytes that this adds.
 *  \param names  [n_stripes] of their files */
dem_status frame_stripes_map(const frames *f, const hdf5_file *file, frame_stripes_mapped n,
                             const char (*names)[HDF5_STRIPES_NAME]);
hsize_t frame_stripes_map_bytes(const frames *f);

#endif
