/* SPDX-License-Identifier: BSD-3-Clause */
/* What is broken where ranks share a model: every rank has all that may break, and its state. Checkpoints have it by
 * the numbers of the whole lattice, and so has the simulation of the whole that leads a run. */
#ifndef DEM_SIMULATION_SHARED_BREAKS_H
#define DEM_SIMULATION_SHARED_BREAKS_H

#include "simulation/private.h"

/* Entries of a checkpoint: a byte for each triangle, or spring, of the model. */
#define SHARED_BREAKS_TRIANGLES "broken triangles"
#define SHARED_BREAKS_SPRINGS   "broken springs"
#define SHARED_BREAKS_LEVELS    "softened triangles"

/** Makes a checkpoint's flags of the part those of the whole; on any rank, by itself.  \return DEM_ERROR_MEMORY */
dem_status shared_breaks_expand(const dem_simulation *s, dem_checkpoint *checkpoint);

/** The other way round.  \return DEM_ERROR_IO for other sizes than those of the whole; DEM_ERROR_MODEL if something is
 *  broken that does not break by itself, which not all ranks have; DEM_ERROR_MEMORY */
dem_status shared_breaks_cut(const dem_simulation *s, dem_checkpoint *checkpoint);

/** Makes what is broken in a simulation of the whole what is so in a part.  \return DEM_ERROR_MEMORY */
dem_status shared_breaks_show(dem_simulation *whole, const dem_simulation *part);

#endif
