/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of all nodes on rank 0, from the ranks that own them. */
#ifndef DEM_DOMAIN_GATHER_H
#define DEM_DOMAIN_GATHER_H

#include "base/ranks.h"
#include "domain/domain.h"

/** Puts what each rank has of its own nodes in an array into that of rank 0. Collective.
 *  \param from       [n_nodes of the domain][dim]
 *  \param[out] whole [n_whole][dim] on rank 0; not looked at elsewhere
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status gather_rows(const ranks *r, const domain *d, int dim, const double *from, double *whole);

#endif
