/* SPDX-License-Identifier: BSD-3-Clause */
/* What the system asks of the program: handlers only take a note. */
#ifndef DEM_SIGNALS_H
#define DEM_SIGNALS_H

#include "requests.h"

/** From now on SIGUSR1 asks for a checkpoint. Without a reader of its log a run goes on all the same, and a limit on
 *  file sizes is a full disk. What whoever started the program wants ignored stays so, here and below. */
void signals_catch(void);

/** From now on SIGTERM, SIGINT, SIGXCPU and SIGUSR2 ask for the end. What only looks at a deck ends by them at once. */
void signals_catch_end(void);

/** What they have noted, and note. */
requests *signals_requests(void);

/** From now on signals_wait() returns when a process that this one has begun ends. */
void signals_catch_children(void);

/** Called in such a process: there it is no more so. */
void signals_leave_children(void);

/** Waits for the end of a process, another signal, or until so many seconds have passed. */
void signals_wait(double seconds);

#endif
