/* SPDX-License-Identifier: BSD-3-Clause */
/* The one list of the arrays of a lattice, for what is done with all of them: freeing, selecting, hashing, sending. */
#ifndef DEM_LATTICE_LATTICE_ARRAYS_H
#define DEM_LATTICE_LATTICE_ARRAYS_H

#include <stdbool.h>

#include <dem/dem.h>

typedef enum lattice_items { LATTICE_NODES, LATTICE_SPRINGS, LATTICE_TRIANGLES, LATTICE_ITEMS } lattice_items;

typedef struct lattice_array {
    size_t offset;    /* of the pointer to it in a dem_lattice */
    lattice_items of; /* what it has an item for */
    size_t size;      /* bytes of an item */
} lattice_array;

enum { LATTICE_ARRAYS = 22 };
extern const lattice_array lattice_arrays[LATTICE_ARRAYS];

/** An array; NULL: there is none, as in a lattice whose struct is older than it. */
void *lattice_array_of(const dem_lattice *lattice, const lattice_array *array);

/** Makes this memory that array. The lattice has the struct of this version. */
void lattice_array_put(dem_lattice *lattice, const lattice_array *array, void *items);

/** Whether its items are nodes: the ends of springs, and the corners of triangles. */
bool lattice_array_is_corners(const lattice_array *array);

/** How many nodes, springs or triangles a lattice has. */
dem_index lattice_count(const dem_lattice *lattice, lattice_items of);

/** A number that hardly any two lattices have which differ in some array. */
uint64_t lattice_arrays_hash(const dem_lattice *lattice);

/** The same where arrays are not all here at once: first the counts, then each array in the order of lattice_arrays,
 *  which may come chunk by chunk, of 8 k items each but for the last.
 *  \param items  n of array k; NULL: there is no such array */
uint64_t lattice_arrays_hash_counts(const dem_lattice *lattice);
uint64_t lattice_arrays_hash_next(uint64_t hash, int k, const void *items, dem_index n);

#endif
