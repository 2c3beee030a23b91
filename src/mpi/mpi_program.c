/* SPDX-License-Identifier: BSD-3-Clause */
#include "mpi/mpi_program.h"

#include <stdlib.h>
#include <string.h>

#include "mpi/mpi_ranks.h"
#include "simulation/led_run.h"

typedef struct group {
    ranks *ranks;
    slab_maker maker;
} group;

static void end(group *g)
{
    if (g != NULL && g->ranks != NULL) g->ranks->end(g->ranks->self);
    free(g);
    (void)MPI_Finalize();
}

static group *make_group(const slab_maker *maker)
{
    group *g = calloc(1, sizeof *g);
    if (g == NULL) return NULL;
    *g = (group){.ranks = mpi_ranks_create(MPI_COMM_WORLD), .maker = *maker};
    return g;
}

void *dem_private_program_begin(int *rank, int *size, volatile sig_atomic_t *const *requests, const slab_maker *maker,
                                void (*lacks_memory)(void *program), void *program)
{
    int provided;
    if (strcmp(dem_version(), DEM_VERSION) != 0) return NULL;
    (void)MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    group *g = make_group(maker);
    if (g == NULL || g->ranks == NULL) {
        end(g);
        return NULL;
    }
    ranks *r = g->ranks;
    for (int k = 0; k < RANKS_REQUESTS; k++) r->requests[k] = requests[k];
    r->lacks_memory = lacks_memory;
    r->program = program;
    mpi_ranks_measure(r);
    *rank = r->rank;
    *size = r->size;
    return g;
}

void dem_private_program_abort(int code)
{
    (void)MPI_Abort(MPI_COMM_WORLD, code);
}

dem_status dem_private_program_slabs(const void *group_of_all, dem_model **out, const slab_recipe *recipe)
{
    const group *g = group_of_all;
    return dem_private_lead_slabs(out, g->ranks, &g->maker, recipe);
}

dem_status dem_private_program_lead(const void *group_of_all, dem_simulation *whole, const dem_options *options,
                                    const dem_checkpoint *checkpoint)
{
    return dem_private_lead(whole, ((const group *)group_of_all)->ranks, options, checkpoint);
}

void dem_private_program_shares(const dem_simulation *whole, double *least, double *most)
{
    dem_private_shares(whole, least, most);
}

dem_index dem_private_program_end(void *group_of_all, dem_index number)
{
    group *g = group_of_all;
    if (g->ranks->rank == 0)
        dem_private_dismiss(g->ranks, number);
    else
        number = dem_private_follow(g->ranks, &g->maker);
    end(g);
    return number;
}
