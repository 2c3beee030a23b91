/* SPDX-License-Identifier: BSD-3-Clause */
/* Orders that rank 0 gives to the ranks of a run which it leads. */
#ifndef DEM_SIMULATION_SHARED_ORDERS_H
#define DEM_SIMULATION_SHARED_ORDERS_H

#include "base/rank_order.h"
#include "base/ranks.h"

/** Passes n orders on, at most one to each rank, and carries out that of this rank. Collective.
 *  \param kept    as rank_order_obey() has it
 *  \param orders  [n] on rank 0; not looked at elsewhere
 *  \return the failure of the lowest rank that has one, on all ranks */
dem_status shared_orders_pass(const ranks *r, void **kept, const rank_order *orders, int n);

#endif
