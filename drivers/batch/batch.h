/* SPDX-License-Identifier: BSD-3-Clause */
/* A command, from its words to its exit code: what dem_batch does, wherever it is done. */
#ifndef DEM_BATCH_H
#define DEM_BATCH_H

#include "cases.h"

/** Does several cases at once. */
typedef exit_code (*batch_pool)(const command *c, const cases *all);

/** \param pool  NULL, in the process of another program: cases are done in turn, whatever the command says of several
 *  at once, and there are no ranks */
exit_code batch_do(const command *c, batch_pool pool);

#endif
