/* SPDX-License-Identifier: BSD-3-Clause */
/* How a model is shared out among ranks. */
#ifndef DEM_MODEL_DOMAIN_MODEL_SHARES_H
#define DEM_MODEL_DOMAIN_MODEL_SHARES_H

#include <stdbool.h>

#include "domain/ring_use.h"

/** The same on all ranks. */
typedef struct domain_model_shares {
    const int32_t *owner;         /* [n_nodes] the rank of each node */
    const unsigned char *is_near; /* [n_nodes] not 0: an event of an obstacle may concern it; NULL: any that may touch
                                     one. Nothing breaks then */
    bool touching; /* whether bodies may touch each other, or themselves: all ranks have their surfaces then */
    ring_use use;  /* of rings of ghosts; of 0 rings: not known */
    int n_rings;   /* of ghosts; 0: as many as there is a use for */
} domain_model_shares;

#endif
