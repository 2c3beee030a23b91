/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields where ranks share a model: each rank computes the rows of what it owns, and rank 0 gets all of them, in the
 * order of the whole lattice, or those who write files what ranks make of them. */
#ifndef DEM_SIMULATION_SHARED_FIELD_H
#define DEM_SIMULATION_SHARED_FIELD_H

#include "base/field_order.h"

/** Fills a field with what the getter of this name has. Collective.
 *  \param part      of each rank
 *  \param[out] out  of the whole, on rank 0; not looked at elsewhere
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status shared_field_gather(const dem_simulation *part, field_kind field, void *out);

/** Carries an order out for the parts. Collective.
 *  \param o  what and target of rank 0 alone are looked at
 *  \return as field_order_give(), on all ranks */
dem_status shared_field_obey(const dem_simulation *part, const field_order *o);

#endif
