/* SPDX-License-Identifier: BSD-3-Clause */
/* The exchange of ghosts: each rank sends rows of its own nodes to the ranks that have them as ghosts. */
#ifndef DEM_DOMAIN_HALO_H
#define DEM_DOMAIN_HALO_H

#include "base/ranks.h"
#include "domain/domain.h"

/** What one simulation exchanges. */
typedef struct halo {
    const ranks *ranks;
    const domain *domain;
    int dim;                        /* components of a row */
    double *rows;                   /* of all messages */
    ranks_message *sent, *received; /* [neighbours] */
} halo;

/** For as many arrays of rows at once as `most_arrays`. Borrows ranks and domain. Free with halo_destroy().
 *  \return DEM_ERROR_MEMORY */
dem_status halo_create(halo *out, const ranks *r, const domain *d, int dim, int most_arrays);
void halo_destroy(halo *h);

/** Puts into the ghosts of each array [n_nodes][dim] what their owners have there. Collective. */
void halo_exchange(halo *h, double *const *arrays, int n_arrays);

#endif
