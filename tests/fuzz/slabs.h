/* SPDX-License-Identifier: BSD-3-Clause */
/* Slabs of the lattice of a file that may be damaged: where the whole can be read, they can, or are refused for what
 * slabs cannot be of. */
#ifndef DEM_FUZZ_SLABS_H
#define DEM_FUZZ_SLABS_H

#include <string.h>

#include <dem/trajectory.h>

#include "bytes.h"

static inline void slabs_check_lattice(const dem_slab *s)
{
    const dem_lattice *l = &s->lattice;
    require(s->n_own > 0 && s->first_own >= 0 && s->first_own + s->n_own <= l->n_nodes && l->n_nodes <= s->n_nodes);
    for (dem_index k = 0; k < 2 * l->n_springs; k++) require(l->ends[k] >= 0 && l->ends[k] < l->n_nodes);
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) require(l->triangles[k] >= 0 && l->triangles[k] < l->n_nodes);
    for (dem_index k = 1; k < l->n_nodes - s->n_own; k++) require(s->rim[k - 1] < s->rim[k]);
}

/** \param whole  NULL: it is refused */
static inline void slabs_check(const char *path, const dem_lattice *whole)
{
    enum { PARTS = 3 };
    dem_index n = 0;
    for (dem_index part = 0; part < PARTS; part++) {
        dem_slab slab = dem_slab_empty();
        const dem_status status = dem_slab_read(&slab, path, part, PARTS);
        require(status == DEM_OK || status == DEM_ERROR_IO || status == DEM_ERROR_MODEL || status == DEM_ERROR_MEMORY);
        require(status == DEM_OK || (slab.lattice.x == NULL && strstr(dem_status_message(), "lattice.h5") != NULL));
        require(whole == NULL || status == DEM_OK || strstr(dem_status_message(), "slabs") != NULL);
        if (status == DEM_OK) slabs_check_lattice(&slab);
        n += slab.n_own;
        dem_slab_free(&slab);
    }
    require(whole == NULL || n == 0 || n == whole->n_nodes);
}

#endif
