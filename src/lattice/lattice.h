/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files about lattices share: checks of numbers and checks that keep loops inside the arrays, and arrays of
 * zeros. */
#ifndef DEM_LATTICE_LATTICE_H
#define DEM_LATTICE_LATTICE_H

#include <math.h>
#include <stdbool.h>

#include <dem/dem.h>

/* Whether struct_size is one that this library knows, and whether springs and triangles stay inside the arrays: numbers
 * not negative, arrays present, node indices in range. */
dem_status lattice_check(const dem_lattice *lattice);

/** Whether n tuples of nodes, springs (of 2) or triangles (of 3) from number `first` on, name nodes that there are.
 *  \param what    "spring" or "triangle", for messages
 *  \param corner  [n][arity] */
dem_status lattice_check_corners(const char *what, int arity, const dem_index *corner, dem_index first, dem_index n,
                                 dem_index n_nodes);

/* Copies a caller's lattice struct, of whatever version; members that it does not have are NULL. Arrays are not
 * copied. */
dem_status lattice_read(dem_lattice *ours, const dem_lattice *theirs);

/* Whether a caller's struct has the member `coupling`, which came after the first version. A lattice of an older struct
 * has no couplings. */
bool lattice_has_couplings(const dem_lattice *lattice);

/** The same of strengths and critical stretches. */
bool lattice_has_limits(const dem_lattice *lattice);

/** And of softening. */
bool lattice_has_softening(const dem_lattice *lattice);

/** And of what limits pressure. */
bool lattice_has_pressure_limits(const dem_lattice *lattice);

/** And of which stress breaks triangles. */
bool lattice_has_own_stress(const dem_lattice *lattice);

/* Whether a lattice can be written: not NULL, and struct_size is that of some version.  \return DEM_ERROR_ARGUMENT */
dem_status lattice_check_out(const dem_lattice *out);

/* Hands a lattice over to a caller, as far as the caller's struct goes. */
void lattice_give(dem_lattice *out, const dem_lattice *made);

/* Of a length, a mass or the like: neither infinite nor NAN. */
static inline bool lattice_is_positive(double value)
{
    return isfinite(value) && value > 0.0;
}

/** How many bodies there are: they are numbered from 0, and a lattice without numbers is one. */
dem_index lattice_count_bodies(const dem_lattice *lattice);

/* An array of n items that are all zero; it has memory for n = 0, too. NULL if there is no memory. */
void *lattice_zeros(dem_index n, size_t size);

#endif
