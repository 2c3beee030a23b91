/* SPDX-License-Identifier: BSD-3-Clause */
/* For programs of several ranks: what does not hold ends all of them, and is said with the place and the rank. */
#ifndef DEM_TEST_RANK_TEST_H
#define DEM_TEST_RANK_TEST_H

#include <stdio.h>
#include <string.h>

#include <dem/mpi.h>

typedef struct team {
    int rank, size;
} team;

static inline team rank_test_begin(int *argc, char ***argv)
{
    team t;
    (void)MPI_Init(argc, argv);
    (void)MPI_Comm_rank(MPI_COMM_WORLD, &t.rank);
    (void)MPI_Comm_size(MPI_COMM_WORLD, &t.size);
    return t;
}

static inline void rank_test_insist(int holds, const char *what, int line)
{
    int rank;
    if (holds) return;
    (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    (void)fprintf(stderr, "rank %d, line %d: %s does not hold; the last message is '%s'\n", rank, line, what,
                  dem_status_message());
    (void)MPI_Abort(MPI_COMM_WORLD, 1);
}

#define INSIST(condition) rank_test_insist(condition, #condition, __LINE__)

#endif
