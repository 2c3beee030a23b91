/* SPDX-License-Identifier: BSD-3-Clause */
#include "mpi/mpi_program.h"

#include <string.h>

#include "mpi/mpi_ranks.h"
#include "simulation/led_run.h"

void *dem_private_program_begin(int *rank, int *size, volatile sig_atomic_t *const *requests,
                                void (*lacks_memory)(void *program), void *program)
{
    int provided;
    if (strcmp(dem_version(), DEM_VERSION) != 0) return NULL;
    (void)MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    ranks *r = mpi_ranks_create(MPI_COMM_WORLD);
    if (r == NULL) {
        (void)MPI_Finalize();
        return NULL;
    }
    for (int k = 0; k < RANKS_REQUESTS; k++) r->requests[k] = requests[k];
    r->lacks_memory = lacks_memory;
    r->program = program;
    mpi_ranks_measure(r);
    *rank = r->rank;
    *size = r->size;
    return r;
}

void dem_private_program_abort(int code)
{
    (void)MPI_Abort(MPI_COMM_WORLD, code);
}

dem_status dem_private_program_lead(const void *group, dem_simulation *whole, const dem_options *options,
                                    const dem_checkpoint *checkpoint)
{
    return dem_private_lead(whole, group, options, checkpoint);
}

void dem_private_program_shares(const dem_simulation *whole, double *least, double *most)
{
    dem_private_shares(whole, least, most);
}

dem_index dem_private_program_end(void *group, dem_index number)
{
    ranks *r = group;
    if (r->rank == 0)
        dem_private_dismiss(r, number);
    else
        number = dem_private_follow(r);
    r->end(r->self);
    (void)MPI_Finalize();
    return number;
}
