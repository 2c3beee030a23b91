/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields, which are numbers of all nodes or springs, where ranks share a model: each rank computes those of what it
 * owns, and rank 0 gets all of them, in the order of the whole lattice. What is broken each rank knows of all
 * (simulation/shared_breaks.h). */
#ifndef DEM_SIMULATION_SHARED_FIELD_H
#define DEM_SIMULATION_SHARED_FIELD_H

#include <dem/dem.h>

typedef enum shared_field_kind {
    SHARED_FIELD_POSITIONS, /* [nodes][2] doubles, as the next ones are */
    SHARED_FIELD_VELOCITIES,
    SHARED_FIELD_STRESS,  /* [nodes][3] doubles */
    SHARED_FIELD_STRAINS, /* [springs] doubles, as the next one is */
    SHARED_FIELD_FORCES
} shared_field_kind;

/** Fills a field with what the getter of this name has. Collective.
 *  \param part      of each rank
 *  \param[out] out  of the whole, on rank 0; not looked at elsewhere
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status shared_field_gather(const dem_simulation *part, shared_field_kind field, void *out);

#endif
