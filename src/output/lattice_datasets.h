/* SPDX-License-Identifier: BSD-3-Clause */
/* The datasets of the group /lattice of an HDF5 file (docs/output.md, /lattice), and what readers of all of it and of a
 * slab of it share. A file may come from anywhere, so it is read in this order:
 *   1. the names in the group: an unknown one is refused
 *   2. each dataset's link, type and shape (hdf5_untrusted.c), and that its rows agree with those of earlier ones
 *   3. numbers, into arrays of the size of what is taken
 *   4. node numbers in springs, triangles and the list of contact nodes, before anything uses them
 * Whether the lattice can move is not checked here but in model/model_rules.c. */
#ifndef DEM_OUTPUT_LATTICE_DATASETS_H
#define DEM_OUTPUT_LATTICE_DATASETS_H

#include "base/rows_taker.h"
#include "lattice/lattice_arrays.h"
#include "output/hdf5_untrusted.h"

enum {
    LATTICE_X,
    LATTICE_MASS,
    LATTICE_ENDS,
    LATTICE_REST_LENGTH,
    LATTICE_STIFFNESS,
    LATTICE_VISCOSITY,
    LATTICE_CRITICAL_STRETCH,
    LATTICE_CORNERS,
    LATTICE_GUARD,
    LATTICE_AREA_STIFFNESS,
    LATTICE_THICKNESS,
    LATTICE_MODULUS,
    LATTICE_COUPLING,
    LATTICE_STRENGTH,
    LATTICE_SOFTENING,
    LATTICE_COMPRESSIVE_STRENGTH,
    LATTICE_CONFINEMENT,
    LATTICE_OWN_STRESS,
    LATTICE_BODY,
    LATTICE_POSITION,
    LATTICE_VELOCITY,
    LATTICE_FIXED, /* this and what follows are made into flags; those before are arrays of a lattice */
    LATTICE_RIGID,
    LATTICE_CONTACT_NODES,
    LATTICE_DATASETS
};

typedef struct lattice_dataset {
    const char *name;
    hdf5_kind kind;
    lattice_items of; /* what it has a row of; LATTICE_ITEMS: a length of its own */
    hsize_t width;
    bool required;
    size_t offset; /* of the array in a dem_lattice; 0: none, as it is made into flags */
} lattice_dataset;

/** In the order in which they are read. The first one of each length decides it, and later ones must agree. Without
 *  springs all their datasets may be absent. */
extern const lattice_dataset lattice_dataset_list[LATTICE_DATASETS];

/** What the numbers of the dataset of rigid bodies stand for. */
enum { LATTICE_RIGID_KINDS = 4 };
extern const unsigned char lattice_rigid_flags[LATTICE_RIGID_KINDS];

/** Rows of a chunk, at most, and of what is read at a time where not all is taken, but for files with larger chunks. */
enum { LATTICE_PIECE = ROWS_CHUNK };

/** A file that is read, and what is taken of it. */
typedef struct lattice_datasets {
    hdf5_file file;
    bool has_springs;                /* one of their datasets is there */
    bool present[LATTICE_DATASETS];  /* whether a dataset is there */
    hsize_t unit[LATTICE_DATASETS];  /* its rows that are unpacked together, as hdf5_untrusted_shape has them */
    bool known[LATTICE_ITEMS + 1];   /* whether there is a dataset of nodes, springs, triangles, or another length, */
    hsize_t rows[LATTICE_ITEMS + 1]; /* which then has so many rows */
    dem_index n[LATTICE_ITEMS];      /* rows that are taken: */
    const dem_index *taken[LATTICE_ITEMS]; /* [n] their numbers, ascending, borrowed; NULL: all */
    void *data[LATTICE_DATASETS];          /* of what is taken; NULL: not read */
} lattice_datasets;

/** Opens a file, and makes all checks of names and shapes; then all rows are to be taken.
 *  \param d  all zero
 *  \return DEM_ERROR_IO, DEM_ERROR_MODEL; then the file is closed. Otherwise to be closed with hdf5_close() */
dem_status lattice_datasets_open(lattice_datasets *d, const char *path);

/** Frees the arrays that are not given to a lattice. */
void lattice_datasets_free(lattice_datasets *d);

/** Reads what is taken of all datasets that are there and have not been read yet, but for contact nodes. */
dem_status lattice_datasets_read(lattice_datasets *d);

/** Gives the arrays that have been read to a lattice, which is empty. */
void lattice_datasets_give(lattice_datasets *d, dem_lattice *lattice);

/** Makes the flags of a lattice with these arrays, whose node numbers are known to be valid. Without the datasets there
 *  are none, which stands for the boundary and nothing fixed or rigid. Where not all is taken the boundary is that of
 *  the triangles that are, but none where only others have triangles. */
dem_status lattice_datasets_flags(const lattice_datasets *d, dem_lattice *lattice);

/** Rows that are read at a time, one piece behind the other: the next one, false behind the last.
 *  \param piece  at first no rows from 0 on */
bool lattice_datasets_next(const lattice_datasets *d, int a, hdf5_untrusted_rows *piece);

/** Room for rows that are read at a time; NULL without memory. To be freed. */
void *lattice_datasets_room(const lattice_datasets *d, int a);

/** Puts the file in front of a message about the lattice: DEM_ERROR_MODEL. */
dem_status lattice_datasets_refuse(const lattice_datasets *d);

#endif
