/* SPDX-License-Identifier: BSD-3-Clause */
/* Several cases at once, in processes of their own. */
#ifndef DEM_CASE_POOL_H
#define DEM_CASE_POOL_H

#include "cases.h"

/** Does all cases, up to c->jobs at once. What they print comes in the order of the cases, and is as from one process
 *  that does them one after the other. None is begun any more once one of them was stopped, or the command was; one
 *  whose process is killed holds up no other.
 *  \return the largest code */
exit_code case_pool_do(const command *c, const cases *all);

#endif
