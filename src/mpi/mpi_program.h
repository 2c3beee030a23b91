/* SPDX-License-Identifier: BSD-3-Clause */
/* What dem_batch, which knows no MPI, finds in libdem_mpi by name when it needs it. Its own declarations are in
 * drivers/batch/rank_group.c. No other program may call these. */
#ifndef DEM_MPI_MPI_PROGRAM_H
#define DEM_MPI_MPI_PROGRAM_H

#include <signal.h>

#include "base/slab_recipe.h"

/** Initialises MPI, with the ranks of its world. Collective.
 *  \param requests  [2] where this rank's signal handlers note that the end and that a checkpoint is asked for; rank 0
 *  gets there what any rank is asked for
 *  \param maker  of slabs on this rank, for dem_private_program_slabs()
 *  \param lacks_memory  called for a rank that is out of memory while others wait for it: has to end all of them
 *  \return what the other functions work on; NULL if memory is short, or libdem has another version, and MPI is over */
DEM_API void *dem_private_program_begin(int *rank, int *size, volatile sig_atomic_t *const *requests,
                                        const slab_maker *maker, void (*lacks_memory)(void *program), void *program);

/** Ends all ranks at once, with this exit code. */
DEM_API void dem_private_program_abort(int code);

/** Makes a model of slabs that all ranks make by a recipe of rank 0: dem_private_lead_slabs(). */
DEM_API dem_status dem_private_program_slabs(const void *group, dem_model **out, const slab_recipe *recipe);

/** Makes a simulation the leader of one that all ranks have a part of: dem_private_lead(). */
DEM_API dem_status dem_private_program_lead(const void *group, dem_simulation *whole, const dem_options *options,
                                            const dem_checkpoint *checkpoint);

/** What the ranks have of a simulation that rank 0 leads, by dem_private_shares().
 *  \param[out] least, most  [4] of one rank: own nodes, ghosts, common nodes of others, and bytes of memory so far */
DEM_API void dem_private_program_shares(const dem_simulation *whole, double *least, double *most);

/** On rank 0, dismisses the others with a number; these take part in its runs until then.  \return that number */
DEM_API dem_index dem_private_program_end(void *group, dem_index number);

#endif
