/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops over threads. The work of a loop is given out in shares that do not depend on timing, and each share writes its
 * own results, so the number of threads changes no bit. The thread that calls takes shares itself; the others, helpers,
 * take what it has not begun when they come. So nobody waits for a thread that has no core. */
#ifndef DEM_BASE_TEAM_H
#define DEM_BASE_TEAM_H

#include <dem/dem.h>

/** The helpers of one owner. NULL is a team without any: its loops run in the caller. */
typedef struct team team;

/** A team of at most `most` threads, the caller among them: of fewer if no more can be created, NULL if there is none
 *  but the caller or no memory. Helpers block all signals. Free with team_destroy().
 *  \param least  how much a share has at least, in nodes of a body */
team *team_create(int most, dem_index least);

/** Ends the helpers. In a process that was forked since, which has none of them, it only frees memory. */
void team_destroy(team *t);

/** Threads that may work at once, >= 1. */
int team_threads(const team *t);

/** Into how many shares a loop is worth dividing, >= 1: a few for each thread, so that they come out even.
 *  \param nodes  what it has to do, as a number of nodes */
int team_shares(const team *t, dem_index nodes);

/** Work of share number `share`. Threads that work at once have different numbers `thread`, from 0 to
 *  team_threads() - 1: for scratch. */
typedef void team_work(const void *context, int share, int thread);

/** Does all shares, 0 to n_shares - 1, each once, in any order, and returns when all are done. If the team is at work
 *  already, in another thread or further up, the caller does them all, as thread 0. */
void team_run(team *t, int n_shares, team_work *work, const void *context);

/** Where share k of n items begins when they are divided into n_shares; share k ends where share k + 1 begins. */
static inline dem_index team_share(dem_index n, int n_shares, int k)
{
    return n * k / n_shares;
}

#endif
