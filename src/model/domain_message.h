/* SPDX-License-Identifier: BSD-3-Clause */
/* What rank 0 sends to another rank of a model that it has cut for it. */
#ifndef DEM_MODEL_DOMAIN_MESSAGE_H
#define DEM_MODEL_DOMAIN_MESSAGE_H

#include "model/domain_cut.h"

/** Sends a cut from rank 0 to rank `to`, where there is an empty one. Collective; other ranks pass NULL.
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status domain_message_send(const ranks *r, int to, domain_cut *c);

#endif
