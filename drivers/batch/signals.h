/* SPDX-License-Identifier: BSD-3-Clause */
/* What the system asks of a run: handlers only take a note. */
#ifndef DEM_SIGNALS_H
#define DEM_SIGNALS_H

#include <stdbool.h>

/** From now on SIGTERM, SIGINT and SIGXCPU ask for the end, SIGUSR1 for a checkpoint; what whoever started the program
 *  wants ignored stays so. Without a reader of its log a run goes on all the same, and a limit on file sizes is a full
 *  disk. */
void signals_catch(void);

/** The name of the signal that asked for the end; NULL: none has. */
const char *signals_end(void);

/** Whether a checkpoint was asked for since the last call. */
bool signals_checkpoint(void);

#endif
