/* SPDX-License-Identifier: BSD-3-Clause */
/* Any bytes may come as a lattice file. What HDF5 itself does with damaged files is not ours: docs/fuzzing.md. */
#include <dem/trajectory.h>

#include "bytes.h"
#include "scratch.h"
#include "slabs.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *path = scratch_path("lattice.h5");
    dem_lattice lattice = dem_lattice_empty();
    scratch_write(path, data, size);
    const dem_status status = dem_lattice_read(&lattice, path);
    require(status == DEM_OK || status == DEM_ERROR_IO || status == DEM_ERROR_MODEL || status == DEM_ERROR_MEMORY);
    require(status == DEM_OK || (lattice.x == NULL && strstr(dem_status_message(), "lattice.h5") != NULL));
    require(status != DEM_OK || (lattice.n_nodes > 0 && lattice.x != NULL && lattice.mass != NULL));
    slabs_check(path, status == DEM_OK ? &lattice : NULL);
    dem_lattice_free(&lattice);
    return 0;
}
