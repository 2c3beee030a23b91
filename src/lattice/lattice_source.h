/* SPDX-License-Identifier: BSD-3-Clause */
/* The arrays of a lattice for those who look at one after the other: they may be those of a whole of which ranks have
 * the parts, and then come from them (model/whole_of_parts.h). */
#ifndef DEM_LATTICE_LATTICE_SOURCE_H
#define DEM_LATTICE_LATTICE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>

#include <dem/dem.h>

#include "base/rows_taker.h"

typedef struct lattice_source {
    const dem_lattice *lattice; /* its counts, and the arrays that are here */
    const dem_model *whole;     /* of which ranks have the arrays; NULL: all are here */
} lattice_source;

/** Of the lattice of a model. Defined in model/lattice_source.c, as the next ones are: those who write files see no
 *  more of a model than its public headers. What is exported is for dem_batch; no other program may call it. */
DEM_API lattice_source dem_private_lattice_source(const dem_model *model);

/** Hands an array over, ROWS_CHUNK items at a time, so that nobody needs memory for all; nothing of one that the
 *  lattice does not have. On rank 0 where ranks have parts, while the others wait for what it asks of them.
 *  \param member  offset of the array's pointer in a dem_lattice
 *  \return DEM_ERROR_MEMORY, and the failure of `take`, which is not called again then */
DEM_API dem_status dem_private_lattice_visit(const lattice_source *from, size_t member, rows_taker *take,
                                             void *context);

/** Whether there is such an array. */
bool dem_private_lattice_has(const lattice_source *from, size_t member);

typedef struct source_array {
    const void *items; /* NULL: the lattice has no such array */
    void *gathered;    /* the same, if it has come from ranks; NULL: it is the lattice's */
} source_array;

/** Gets all of an array. Close it, after a failure, too.  \return DEM_ERROR_MEMORY */
dem_status dem_private_lattice_open(source_array *out, const lattice_source *from, size_t member);
void dem_private_lattice_close(source_array *a);

/** Gets the items of n nodes, springs or triangles from an array that there is.
 *  \param list      [n] their numbers
 *  \param[out] out  [n] items */
DEM_API dem_status dem_private_lattice_pick(const lattice_source *from, size_t member, const dem_index *list,
                                            dem_index n, void *out);

#endif
