/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that are threads of the test's process. Packets are joined in another order on each rank, so that a join whose
 * result depends on it shows; a rank that calls something else than the others ends the test with a message. */
#ifndef DEM_TEST_RANK_THREADS_H
#define DEM_TEST_RANK_THREADS_H

#include "base/ranks.h"

/** What one rank does. A failing assertion here would leave the others waiting: results go into the context. */
typedef void rank_threads_work(const ranks *r, void *context);

/** How often ranks have talked to each other. */
typedef struct rank_threads_counts {
    int reductions, exchanges;
} rank_threads_counts;

/** Runs the work on n ranks at once, and returns when all are done. */
void rank_threads_run(int n, rank_threads_work *work, void *context);

/** Ranks that run from now on say that they have been busy for a time, rank k seconds[k] for each of its calls. NULL:
 *  they do not know for how long.
 *  \param seconds  [n] outlives the ranks; rank 0 may change them between its calls */
void rank_threads_pretend(const double *seconds);

/** Calls by this rank so far. */
rank_threads_counts rank_threads_count(const ranks *r);

#endif
