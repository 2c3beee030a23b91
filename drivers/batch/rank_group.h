/* SPDX-License-Identifier: BSD-3-Clause */
/* The processes that mpirun or srun has started, as the ranks of one run: rank 0 reads, writes and logs, and the others
 * take part in its simulations. MPI is loaded only then, with libdem_mpi. */
#ifndef DEM_RANK_GROUP_H
#define DEM_RANK_GROUP_H

#include <stdbool.h>
#include <stdio.h>

#include <dem/dem.h>

#include "base/slab_recipe.h"
#include "host.h"

enum { RANK_GROUP_REASON = 256 };

/** A rank that runs out of memory while others wait for it says so in a line, and ends all, with EXIT_MEMORY. */
typedef struct rank_group {
    int rank, size;
    const host *host;
    void *self, *library;
    dem_status (*slabs)(const void *self, dem_model **out, const slab_recipe *recipe);
    dem_status (*lead)(const void *self, dem_simulation *whole, const dem_options *options,
                       const dem_checkpoint *checkpoint);
    void (*shares)(const dem_simulation *whole, double *least, double *most);
    void (*abort)(int code);
    dem_index (*end)(void *self, dem_index number);
} rank_group;

/** Initialises MPI; all processes have to.
 *  \param h  outlives them; while rank 0 leads a run its requests there are what is asked of any rank
 *  \return whether they are ranks; else `why` says what is missing */
bool rank_group_begin(rank_group *g, const host *h, char why[RANK_GROUP_REASON]);

/** Makes a model of slabs that all ranks make by a recipe (deck_slabs.h). On rank 0. */
dem_status rank_group_slabs(const rank_group *g, dem_model **out, const slab_recipe *recipe);

/** Lets all ranks make the run of a simulation, which shows it as one of a process alone. On rank 0.
 *  \param checkpoint  from which the simulation was resumed; NULL: it was not */
dem_status rank_group_lead(const rank_group *g, dem_simulation *whole, const dem_options *options,
                           const dem_checkpoint *checkpoint);

/** Prints how many nodes the ranks have of a run that rank 0 leads, and what memory they take, the least and the most.
 *  On rank 0. */
void rank_group_print(const rank_group *g, const dem_simulation *whole, bool of_slabs, FILE *out);

/** Ends MPI. On rank 0 when all is done, with an exit code; on the others at once: they take part in all runs of rank 0
 *  meanwhile.  \return the exit code of rank 0 */
int rank_group_end(rank_group *g, int code);

#endif
