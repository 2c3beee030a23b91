/* SPDX-License-Identifier: BSD-3-Clause */
/* A run that ranks make for a simulation of the whole, which rank 0 alone has, or nobody has: the *leader*. Whoever
 * uses that sees no ranks: observers are called, and asked and answered, on rank 0, while the *followers*, the other
 * ranks, take part in what the leader asks for. Rank 0 has the memory of the whole, besides its part, or, where each
 * rank makes a slab, of what is shown and written. */
#ifndef DEM_SIMULATION_LED_RUN_H
#define DEM_SIMULATION_LED_RUN_H

#include "base/field_order.h"
#include "simulation/private.h"
#include "simulation/rank_call.h"
#include "simulation/shared_slabs.h"

/** Makes a simulation that has not been advanced the leader of one that all ranks have a part of. On rank 0, while the
 *  others are in dem_private_follow(). No program may call this. While it leads there is no other simulation of its
 *  model, which gives up what that would be advanced with (model_rows_give_up()).
 *  \param r           outlives the simulation
 *  \param options     with which the simulation was created; outlive it, with what they refer to
 *  \param checkpoint  from which it was resumed; NULL: it was not
 *  \return as domain_model_create() and dem_simulation_create(); then it leads nobody, and has to be destroyed, as what
 *  it would have been advanced with is gone (simulation/step_parts.h). Likewise where rank 0 has a function that the
 *  others have not: after DEM_ERROR_MODEL, that of an obstacle's motion, or DEM_ERROR_ARGUMENT, an external force */
DEM_API dem_status dem_private_lead(dem_simulation *whole, const ranks *r, const dem_options *options,
                                    const dem_checkpoint *checkpoint);

/** Makes a model of slabs that each rank makes by a recipe of rank 0: of the whole, for a simulation that leads a run
 *  with its parts, and does nothing else. On rank 0, while the others are in dem_private_follow(). No program may call
 *  this.
 *  \param r      outlives the model
 *  \param maker  of rank 0
 *  \return as shared_slabs_create() */
DEM_API dem_status dem_private_lead_slabs(dem_model **out, const ranks *r, const slab_maker *maker,
                                          const slab_recipe *recipe);

/** Measures what the ranks of a run that rank 0 leads have of it. On rank 0. No program may call this.
 *  \param[out] least, most  [4] of one rank, in the order of simulation/rank_shares.h */
DEM_API void dem_private_shares(const dem_simulation *whole, double *least, double *most);

/** Takes part in the runs of the leader, on the other ranks, until it dismisses them.
 *  \param maker  of slabs on this rank  \return its number */
DEM_API dem_index dem_private_follow(const ranks *r, const slab_maker *maker);

/** Dismisses the followers. On rank 0, when it leads none of its simulations any more. */
DEM_API void dem_private_dismiss(const ranks *r, dem_index number);

/** Advances, as dem_simulation_advance() does, all parts. */
dem_status led_run_advance(dem_simulation *whole, double t_end);

/** Asks all parts, and writes what they answer. */
dem_status led_run_ask(const dem_simulation *whole, rank_call_kind what, dem_index number, void *out);

/** Has an order carried out by all parts. */
dem_status led_run_order(const dem_simulation *whole, const field_order *o);

/** Rank 0's part, which every contact and event is in, as it is in every other one: to be asked without a call. */
const dem_simulation *led_run_part(const led_run *l);

/** Fills an array [nodes of the whole][n_components] with what a getter says of the nodes of that part, and 0. */
typedef dem_status led_run_getter(const dem_simulation *part, double *out);
dem_status led_run_spread(const dem_simulation *whole, led_run_getter *get, int n_components, double *out);

/** Puts the state that is seen into `frame`. */
void led_run_gather(dem_simulation *whole);

/** Ends what the simulation leads. */
void led_run_destroy(led_run *l);

#endif
