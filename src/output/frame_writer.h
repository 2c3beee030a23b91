/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes the arrays of a frame, those of one field after the other, by orders that all ranks of a run carry out
 * (base/field_order.h, rank_work.c). */
#ifndef DEM_OUTPUT_FRAME_WRITER_H
#define DEM_OUTPUT_FRAME_WRITER_H

#include "output/frame_packer.h"
#include "output/stripe_file.h"

/** What an order is about. */
typedef struct frame_order {
    frames whole; /**< of all rows */
    int first, end;
    bool ends_frame;     /**< these are the last ones */
    stripe_name stripes; /**< where it writes; of no stripes: a file of rank 0 */
    bool stays_open;     /**< the file of a stripe, for what comes next */
} frame_order;

/** Writes all arrays of the present state as frame f->n of an open file. */
dem_status frame_writer_append(const frames *f, const hdf5_file *file, const dem_simulation *simulation);

/** The same in the files of stripes, which nobody has open. */
dem_status frame_writer_append_stripes(const frames *f, const stripe_name *name, bool stays_open,
                                       const dem_simulation *simulation);

#endif
