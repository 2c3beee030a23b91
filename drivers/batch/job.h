/* SPDX-License-Identifier: BSD-3-Clause */
/* One case: from a deck to its result. */
#ifndef DEM_JOB_H
#define DEM_JOB_H

#include "command.h"
#include "outcome.h"

/** Checks, echoes or runs a deck, as the command says.
 *  \param part  what is done of a run, 0 to 1, is written there for another process; NULL: none asks */
exit_code job_do(const command *c, const char *path, volatile double *part);

/** Says of a deck that it has not been begun because another was stopped. */
exit_code job_leave(const command *c, const char *path);

#endif
