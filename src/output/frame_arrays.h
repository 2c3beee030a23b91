/* SPDX-License-Identifier: BSD-3-Clause */
/* The arrays in which a frame has a row for each node, spring or triangle: which there are, where they are in a file,
 * and what fills them. They are numbered 0 to FRAME_ARRAYS - 1. */
#ifndef DEM_OUTPUT_FRAME_ARRAYS_H
#define DEM_OUTPUT_FRAME_ARRAYS_H

#include <dem/trajectory.h>

#include "base/field_order.h"
#include "output/hdf5_rows.h"

enum { FRAME_ARRAYS = 16 };

/** The dataset of the flags of triangles, 1: broken, frame by frame. Files of older versions, and those of lattices
 *  without triangles, do not have it. */
#define FRAMES_BROKEN_TRIANGLES "/fracture/triangles"

/** The array of cells by which VTK does not draw some of them, of springs and of triangles. */
#define FRAMES_HIDDEN "vtkGhostType"

/** The grid of triangles, which body_file.c leads VTK to. Lattices without triangles do not have it. */
#define FRAMES_BODIES "/bodies"

/** Its times, and where the data of each begin. */
#define FRAMES_BODY_STEPS FRAMES_BODIES "/Steps"

/** Frames of a lattice, or of some of its nodes, springs and triangles, as they are written to a file. */
typedef struct frames {
    dem_index n_nodes, n_springs, n_triangles;
    uint32_t fields; /* DEM_FIELD_... */
    hdf5_kind real;  /* of most arrays in the file: HDF5_F32 or HDF5_F64 */
    int deflate;
    int n_stripes;    /* files that have the rows of arrays, a range of each (stripe_file.h); 0: the file itself */
    dem_index before; /* frames in the files before this one */
    dem_index n;      /* frames in this file */
    double last;      /* time of the last frame, s */
} frames;

/** What an array has a row of: nothing, each frame, each node, spring or triangle of a frame. */
typedef enum frame_of {
    FRAME_OF_NONE,
    FRAME_OF_ONE,
    FRAME_OF_NODES,
    FRAME_OF_SPRINGS,
    FRAME_OF_TRIANGLES,
    FRAME_OFS
} frame_of;

/** Whether frames have arrays of these; and the rows of one frame. */
bool frame_arrays_has(const frames *f, frame_of of);
dem_index frame_arrays_count(const frames *f, frame_of of);

/** Whether frames have this array. */
bool frame_arrays_is_wanted(const frames *f, int array);

frame_of frame_arrays_of(int array);

/** The dataset of an array; and the name of the one that says where its frames begin, NULL: none does. */
hdf5_rows frame_arrays_rows(const frames *f, int array);
const char *frame_arrays_offset(int array);

/** Bytes of a row in memory. */
size_t frame_arrays_row_bytes(int array);

/** The field of which it is made. Arrays of one field come one behind the other. */
field_kind frame_arrays_field(int array);

/** Makes rows of an array from n rows of its field.
 *  \param room  [n][components]
 *  \return `room`, or `rows` where they are the same */
const void *frame_arrays_convert(int array, dem_index n, const void *rows, void *room);

/** An upper bound of the bytes of all arrays of a frame. */
hsize_t frame_arrays_bytes(const frames *f);

/** Frames of a file of the whole that go to one of a range of each of its arrays, or of all rows. */
typedef struct frame_arrays_copying {
    const frames *whole, *target;
    dem_index first[FRAME_OFS]; /* row of the whole at which those of the target begin */
    const hdf5_file *from, *to;
} frame_arrays_copying;

/** Copies arrays. What a file of an older version does not have is made from what is broken. */
dem_status frame_arrays_copy(const frame_arrays_copying *c, hdf5_span span);

/** DEM_ERROR_IO unless every array has n frames.
 *  \param older  the file may be of a version before some of them, which frame_arrays_copy() makes from others */
dem_status frame_arrays_check(const frames *f, const hdf5_file *file, hsize_t n, bool older);

/** Turns stresses xx, yy, xy [n][3] into VTK's symmetric tensors xx, yy, zz, xy, yz, xz [n][6]; zz is 0. */
void frame_arrays_spread_stress(double *out, dem_index n, const double *stress);

#endif
