/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /VTKHDF of a trajectory: the lattice as a grid of lines, and what is shown on it at every frame; the group
 * /bodies, the same as a grid of triangles; and beside them which triangles are broken then. */
#ifndef DEM_OUTPUT_FRAMES_H
#define DEM_OUTPUT_FRAMES_H

#include <dem/trajectory.h>

#include "output/hdf5_rows.h"

/** The dataset of the flags of triangles, 1: broken, frame by frame. Files of older versions, and those of lattices
 *  without triangles, do not have it. */
#define FRAMES_BROKEN_TRIANGLES "/fracture/triangles"

/** The array of cells by which VTK does not draw some of them, of springs and of triangles. */
#define FRAMES_HIDDEN "vtkGhostType"

/** The grid of triangles, which body_file.c leads VTK to. Lattices without triangles do not have it. */
#define FRAMES_BODIES "/bodies"

/** The dataset of the first rows of frames in the table of fragments, and behind them of the number of its rows. */
#define FRAMES_FRAGMENT_OFFSETS "/fragments/frame_offset"

typedef struct frames {
    dem_index n_nodes, n_springs, n_triangles;
    uint32_t fields; /* DEM_FIELD_... */
    hdf5_kind real;  /* of most arrays in the file: HDF5_F32 or HDF5_F64 */
    int deflate;
    int n_stripes;    /* files that have the rows of arrays, a range of each (stripe_file.h); 0: the file itself */
    dem_index before; /* frames in the files before this one */
    dem_index n;      /* frames in this file */
    double last;      /* time of the last frame, s */
    double *scratch;  /* the array that is being written: [6 n_nodes], [n_springs] or [n_triangles] */
    double *stress;   /* [n_nodes][3] */
    double *pressure; /* [n_nodes] of contact; NULL: not wanted */
} frames;

/** An array that is the same in all frames. */
typedef struct frames_constant {
    const char *set; /* "PointData": of nodes, "CellData": of springs */
    const char *name;
    hdf5_kind kind;
    int components;
} frames_constant;

/** Free with frames_free(). */
dem_status frames_init(frames *out, const dem_model *model, const dem_trajectory_options *options);
void frames_free(frames *f);

/** Makes the group with the grid and no frame. */
dem_status frames_create(const frames *f, const hdf5_file *file, const dem_lattice *lattice);

/** An upper bound of the bytes that frames_append() adds. */
hsize_t frames_bytes(const frames *f);

/** Adds the present state of the simulation as frame f->n. It counts when the caller has closed the file and raised
 *  f->n. Arrays in stripes have been written, and mapped, before. */
dem_status frames_append(const frames *f, const hdf5_file *file, const dem_simulation *simulation);

/* ---- stripes ---- */

/** Takes array number `array` of a frame, [rows of the whole][components]. */
typedef dem_status frames_taker(void *context, int array, const void *data);

/** Hands all arrays of the present state of the simulation over, one after the other. */
dem_status frames_hand_out(const frames *f, const dem_simulation *simulation, frames_taker *take, void *context);

/** The frames of stripe k, 0 <= k < f->n_stripes, which are all in one file. */
frames frames_of_stripe(const frames *f, int k);

/** Where its rows of an array begin, and how many bytes they are: in memory. */
size_t frames_first_byte(const frames *f, int array, int k);

/** Makes the arrays in the file of a stripe, without frames; and an upper bound of the bytes of n frames. */
dem_status frames_create_stripe(const frames *stripe, const hdf5_file *file);
hsize_t frames_stripe_bytes(const frames *stripe, hsize_t n);

/** Writes an array as that of a frame. */
dem_status frames_write_stripe(const frames *stripe, const hdf5_file *file, int array, hsize_t frame, const void *data);

/** Copies frames of a file of the whole into that of stripe k. */
dem_status frames_copy_stripe(const frames *f, int k, const hdf5_file *from, const hdf5_file *to, hdf5_span span);

/** How many frames a file has of stripes. */
typedef struct frames_mapped {
    bool grow;      /**< as many as there are */
    hsize_t frames; /**< 0 where they grow */
} frames_mapped;

/** Lets a file have frames of arrays whose rows are in stripes.
 *  \param names  [n_stripes] of their files */
dem_status frames_map(const frames *f, const hdf5_file *file, frames_mapped n, const char (*names)[HDF5_STRIPES_NAME]);

/** Adds an array that is the same in all frames, to a file made by frames_create().
 *  \param values  [number of nodes or springs][components] */
dem_status frames_write_constant(const frames *f, const hdf5_file *file, const frames_constant *constant,
                                 const double *values);

/** Turns stresses xx, yy, xy [n][3] into VTK's symmetric tensors xx, yy, zz, xy, yz, xz [n][6]; zz is 0. */
void frames_spread_stress(double *out, dem_index n, const double *stress);

/** Copies frames of another file; in this one they begin at frame span.at. What a file of an older version does not
 *  have is made from what is broken. Arrays in stripes are left out. */
dem_status frames_copy(const frames *f, const hdf5_file *from, const hdf5_file *to, hdf5_span span);

/** The number of frames of a file; DEM_ERROR_IO unless every array has as many, but for those that frames_copy()
 *  makes. */
dem_status frames_count(const frames *f, const hdf5_file *file, hsize_t *n);

/** DEM_ERROR_IO unless every array has n frames. */
dem_status frames_verify(const frames *f, const hdf5_file *file, hsize_t n);

#endif
