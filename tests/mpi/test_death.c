/* SPDX-License-Identifier: BSD-3-Clause */
/* A rank that is killed in a run takes all others with it: this program never returns. `mpirun -n N test_death`, which
 * has to fail, and soon. */
#define _POSIX_C_SOURCE 200809L
#include <signal.h>

#include "mpi_body.h"

typedef struct victim {
    bool dies;
    dem_index steps;
} victim;

static dem_status die(void *context, const dem_simulation *s)
{
    victim *v = context;
    (void)s;
    if (++v->steps == 5 && v->dies) (void)raise(SIGKILL);
    return DEM_OK;
}

int main(int argc, char **argv)
{
    const team t = rank_test_begin(&argc, &argv);
    dem_lattice l = mpi_body_make(1.0);
    dem_options options = dem_options_default();
    dem_model *model = NULL;
    dem_simulation *s = NULL;
    victim v = {.dies = t.rank == t.size - 1};
    const dem_observer observer = {.struct_size = sizeof observer, .context = &v, .step = die};
    INSIST(dem_model_create_mpi(&model, &l, NULL, 0, MPI_COMM_WORLD) == DEM_OK);
    INSIST(dem_simulation_create(&s, model, &options) == DEM_OK && dem_simulation_observe(s, &observer) == DEM_OK);
    (void)dem_simulation_advance(s, 1.0);
    (void)MPI_Finalize();
    return 0;
}
