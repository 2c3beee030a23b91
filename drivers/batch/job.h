/* SPDX-License-Identifier: BSD-3-Clause */
/* One case: from a deck to its result. */
#ifndef DEM_JOB_H
#define DEM_JOB_H

#include "command.h"
#include "outcome.h"

/** Checks, echoes or runs a deck, as the command says. */
exit_code job_do(const command *c, const char *path);

/** Says of a deck that it has not been begun because another was stopped. */
exit_code job_leave(const command *c, const char *path);

#endif
