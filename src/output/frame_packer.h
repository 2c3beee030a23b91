/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays of a frame, slice by slice: who has rows of a field makes a portion of them (base/field_order.h), which has
 * the rows of all arrays that are made of the field, packed where the file has them so; who writes takes the portions,
 * and at the end has of each array what goes to the file. */
#ifndef DEM_OUTPUT_FRAME_PACKER_H
#define DEM_OUTPUT_FRAME_PACKER_H

#include "output/deflated_chunk.h"
#include "output/deflater.h"
#include "output/frame_arrays.h"

/** Arrays of one field, one behind the other, as a file has them: all rows, or those of a stripe. */
typedef struct field_arrays {
    frames frames;
    int first, end; /* arrays */
} field_arrays;

/** Kept from one frame to the next. Zero at first. */
typedef struct frame_packer {
    deflater deflater;
    unsigned char *converted, *portion;     /* rows of an array, and all of a portion */
    dem_index converted_room, portion_room; /* bytes */
    deflated_chunk chunks[FRAME_ARRAYS];    /* that have been begun, and not been written */
} frame_packer;

/** Whether the file has rows of its arrays packed, as it has those of all or of none. */
bool frame_packer_packs(const field_arrays *a);

/** An upper bound of the bytes that they take in the file. */
hsize_t frame_packer_bytes(const field_arrays *a);

/** Makes a portion.
 *  \param rows             of the field, portion->n of them
 *  \param[in,out] portion  its rows are known; bytes are valid up to the next call
 *  \return DEM_ERROR_MEMORY */
dem_status frame_packer_make(frame_packer *p, const field_arrays *a, const void *rows, field_portion *portion, team *t);

/** Begins to take packed portions, takes one, aligned as memory of malloc(), and writes what has been taken.
 *  \return DEM_ERROR_MEMORY, and the last one DEM_ERROR_IO */
dem_status frame_packer_begin(frame_packer *p, const field_arrays *a, int n_shares);
dem_status frame_packer_take(frame_packer *p, const field_arrays *a, const field_portion *portion);
dem_status frame_packer_end(frame_packer *p, const field_arrays *a, const hdf5_file *file);

/** Makes room in a file for plain rows, and writes those of a portion.  \return DEM_ERROR_IO */
dem_status frame_packer_extend(const field_arrays *a, const hdf5_file *file);
dem_status frame_packer_put(const field_arrays *a, const hdf5_file *file, const field_portion *portion);

void frame_packer_free(frame_packer *p);

#endif
