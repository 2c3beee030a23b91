/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks of an MPI communicator. */
#ifndef DEM_MPI_MPI_RANKS_H
#define DEM_MPI_MPI_RANKS_H

#include <mpi.h>

#include "base/ranks.h"

/** The table of functions of this rank, with a communicator of its own. Collective. To be ended by its `end`, before
 *  MPI_Finalize() if that is to free the communicator.
 *  \return NULL, on all ranks, if one of them is out of memory */
ranks *mpi_ranks_create(MPI_Comm communicator);

/** Lets the rank know from now on how long it is busy. */
void mpi_ranks_measure(ranks *r);

#endif
