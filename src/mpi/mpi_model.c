/* SPDX-License-Identifier: BSD-3-Clause */
/* The functions of dem/mpi.h. Of libdem's own functions only those are called that it exports, and of its structs none
 * is looked into but the table of ranks, which is this library's. */
#include <dem/mpi.h>

#include <stdio.h>
#include <string.h>

#include "base/status.h"
#include "mpi/mpi_ranks.h"
#include "simulation/shared_use.h"

/* What would leave nobody to talk to. */
static dem_status check(dem_model *const *out, MPI_Comm communicator)
{
    char message[STATUS_MESSAGE_SIZE];
    int is_initialised = 0;
    (void)MPI_Initialized(&is_initialised);
    if (!is_initialised)
        return dem_private_fail(DEM_ERROR_ARGUMENT, "dem_model_create_mpi: MPI has not been initialised");
    if (out == NULL || communicator == MPI_COMM_NULL)
        return dem_private_fail(DEM_ERROR_ARGUMENT, out == NULL ? "dem_model_create_mpi: out is NULL"
                                                                : "dem_model_create_mpi: no communicator");
    if (strcmp(dem_version(), DEM_VERSION) == 0) return DEM_OK;
    (void)snprintf(message, sizeof message, "libdem_mpi %s does not go with libdem %s", DEM_VERSION, dem_version());
    return dem_private_fail(DEM_ERROR_ARGUMENT, message);
}

static dem_status share(dem_model **out, const dem_private_whole *whole, MPI_Comm communicator)
{
    ranks *r = mpi_ranks_create(communicator);
    if (r == NULL) return dem_private_fail(DEM_ERROR_MEMORY, "out of memory for the ranks of a communicator");
    const dem_status status = dem_private_share_model(out, whole, r);
    if (status != DEM_OK) r->end(r->self);
    return status;
}

dem_status dem_model_create_mpi(dem_model **out, const dem_lattice *lattice, const dem_obstacle *obstacles,
                                dem_index n_obstacles, MPI_Comm communicator)
{
    TRY(check(out, communicator));
    const dem_private_whole whole = {.lattice = lattice, .obstacles = obstacles, .n_obstacles = n_obstacles};
    return share(out, &whole, communicator);
}

dem_status dem_model_create_mpi_for(dem_model **out, const dem_lattice *lattice, const dem_obstacle *obstacles,
                                    dem_index n_obstacles, const dem_options *options, MPI_Comm communicator)
{
    TRY(check(out, communicator));
    dem_private_whole whole = {.lattice = lattice, .obstacles = obstacles, .n_obstacles = n_obstacles};
    whole.refused = options != NULL ? dem_private_use_shared(&whole, options)
                                    : dem_private_fail(DEM_ERROR_ARGUMENT, "dem_model_create_mpi_for: options is NULL");
    return share(out, &whole, communicator);
}

static dem_status share_slab(dem_model **out, dem_slab *slab, dem_private_whole *whole, const dem_options *options,
                             MPI_Comm communicator)
{
    dem_slab none = dem_slab_empty();
    TRY(check(out, communicator));
    whole->slab = slab != NULL ? slab : &none;
    if (options != NULL) whole->refused = dem_private_use_shared(whole, options);
    if (slab == NULL) whole->refused = dem_private_fail(DEM_ERROR_ARGUMENT, "dem_model_create_mpi_slab: slab is NULL");
    return share(out, whole, communicator);
}

/* What has been refused before the slab was taken over ends here. */
dem_status dem_model_create_mpi_slab(dem_model **out, dem_slab *slab, const dem_obstacle *obstacles,
                                     dem_index n_obstacles, const dem_options *options, MPI_Comm communicator)
{
    dem_private_whole whole = {.obstacles = obstacles, .n_obstacles = n_obstacles};
    const dem_status status = share_slab(out, slab, &whole, options, communicator);
    dem_slab_free(slab);
    return status;
}

dem_status dem_model_create_mpi_f(dem_model **out, const dem_lattice *lattice, const dem_obstacle *obstacles,
                                  dem_index n_obstacles, MPI_Fint communicator)
{
    return dem_model_create_mpi(out, lattice, obstacles, n_obstacles, MPI_Comm_f2c(communicator));
}

dem_status dem_model_create_mpi_for_f(dem_model **out, const dem_lattice *lattice, const dem_obstacle *obstacles,
                                      dem_index n_obstacles, const dem_options *options, MPI_Fint communicator)
{
    return dem_model_create_mpi_for(out, lattice, obstacles, n_obstacles, options, MPI_Comm_f2c(communicator));
}

dem_status dem_model_create_mpi_slab_f(dem_model **out, dem_slab *slab, const dem_obstacle *obstacles,
                                       dem_index n_obstacles, const dem_options *options, MPI_Fint communicator)
{
    return dem_model_create_mpi_slab(out, slab, obstacles, n_obstacles, options, MPI_Comm_f2c(communicator));
}
