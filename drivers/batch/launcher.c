/* SPDX-License-Identifier: BSD-3-Clause */
/* No MPI is started for this: launchers say in the environment what they have started. What sbatch alone sets
 * (SLURM_NTASKS, SLURM_PROCID) says what a job may start, not what it has started: srun's own variable is another
 * one. */
#include "launcher.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Open MPI gives each process a terminal of its own, as the C library holds back what is written elsewhere. */
static const char open_mpi[] = "OMPI_COMM_WORLD_SIZE";

/* In the order in which they decide. */
static const struct {
    const char *size, *rank;
} known[] = {{open_mpi, "OMPI_COMM_WORLD_RANK"},             /* Open MPI */
             {"PMI_SIZE", "PMI_RANK"},                       /* MPICH, Intel MPI */
             {"MV2_COMM_WORLD_SIZE", "MV2_COMM_WORLD_RANK"}, /* MVAPICH */
             {"SLURM_STEP_NUM_TASKS", "SLURM_PROCID"}};      /* srun */

/* Tells a rank and no number of processes. */
static const char *const pmix_rank = "PMIX_RANK";

/* < 0: it is not there, or no number. */
static long number_of(const char *variable)
{
    const char *text = getenv(variable);
    const size_t n = text == NULL ? 0 : strspn(text, "0123456789");
    return n == 0 || n > 9 || text[n] != '\0' ? -1 : strtol(text, NULL, 10);
}

launcher launcher_find(void)
{
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        const long size = number_of(known[k].size);
        if (size >= 1) return (launcher){known[k].size, size, number_of(known[k].rank) <= 0};
    }
    const long rank = number_of(pmix_rank);
    return rank >= 0 ? (launcher){pmix_rank, rank + 1, rank == 1} : (launcher){NULL, 1, true};
}

bool launcher_knows_all(const launcher *l)
{
    return l->variable != pmix_rank;
}

bool launcher_makes_terminal(const launcher *l)
{
    return l->variable != NULL && strcmp(l->variable, open_mpi) == 0;
}

void launcher_let_report(const launcher *l)
{
    const struct timespec while_it_does = {2, 0};
    if (!l->reports) (void)nanosleep(&while_it_does, NULL);
}
