/* SPDX-License-Identifier: BSD-3-Clause */
/* What rank 0 sends to another rank of a model that it has cut for it: the lattice of the domain, and what depends on
 * more than that. The other rank compiles the rest. */
#ifndef DEM_MODEL_DOMAIN_MESSAGE_H
#define DEM_MODEL_DOMAIN_MESSAGE_H

#include "model/model.h"

/** A model that has been cut, and is still to be compiled (model/domain_model.c): its domain, lattice, boundary with
 *  the sums over bodies (`touching`), rigid bodies, stresses, masses and scales. */
typedef struct domain_cut {
    dem_model *model; /* on a rank that waits for it nothing but zeros */
    int32_t *order;   /* [n_nodes] the node at each place of the layout; NULL: places are node numbers */
} domain_cut;

/** Sends it from rank 0 to rank `to`. Collective; other ranks pass NULL.
 *  \return DEM_ERROR_MEMORY, on all ranks; what the other rank has then ends with the model and free() of the order */
dem_status domain_message_send(const ranks *r, int to, domain_cut *c);

#endif
