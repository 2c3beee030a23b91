/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /VTKHDF of a trajectory: the lattice as a grid of lines, and what is shown on it at every frame; the group
 * /bodies, the same as a grid of triangles; and beside them which triangles are broken then. */
#ifndef DEM_OUTPUT_FRAMES_H
#define DEM_OUTPUT_FRAMES_H

#include "lattice/lattice_source.h"
#include "output/frame_arrays.h"

/** The dataset of the first rows of frames in the table of fragments, and behind them of the number of its rows. */
#define FRAMES_FRAGMENT_OFFSETS "/fragments/frame_offset"

/** An array that is the same in all frames. */
typedef struct frames_constant {
    const char *set; /* "PointData": of nodes, "CellData": of springs */
    const char *name;
    hdf5_kind kind;
    int components;
} frames_constant;

void frames_init(frames *out, const dem_model *model, const dem_trajectory_options *options);

/** Makes the group with the grid and no frame. */
dem_status frames_create(const frames *f, const hdf5_file *file, const lattice_source *lattice);

/** An upper bound of the bytes that frames_append() adds. */
hsize_t frames_bytes(const frames *f);

/** Adds the present state of the simulation as frame f->n. It counts when the caller has closed the file and raised
 *  f->n. Arrays in stripes have been written, and mapped, before. */
dem_status frames_append(const frames *f, const hdf5_file *file, const dem_simulation *simulation);

/** Adds an array that is the same in all frames, to a file made by frames_create(). Its rows are to be appended, one
 *  for each node or spring, ROWS_CHUNK at a time, doubles.
 *  \param[out] rows  have the name `name` */
enum { FRAMES_NAME = 96 };
dem_status frames_create_constant(const frames *f, const hdf5_file *file, const frames_constant *constant,
                                  hdf5_rows *rows, char name[FRAMES_NAME]);

/** Copies frames of another file; in this one they begin at frame span.at. What a file of an older version does not
 *  have is made from what is broken. Arrays in stripes are left out. */
dem_status frames_copy(const frames *f, const hdf5_file *from, const hdf5_file *to, hdf5_span span);

/** The number of frames of a file; DEM_ERROR_IO unless every array has as many, but for those that frames_copy()
 *  makes. */
dem_status frames_count(const frames *f, const hdf5_file *file, hsize_t *n);

/** DEM_ERROR_IO unless every array has n frames. */
dem_status frames_verify(const frames *f, const hdf5_file *file, hsize_t n);

#endif
