/* SPDX-License-Identifier: BSD-3-Clause */
/* The triangles that are whole, copied one behind the other. The boundary of a body that breaks is found from them just
 * as that of one that has been cut: model/surface.c, model/overlap.c, surface_contact/contact_surface.c. */
#include "model/whole_triangles.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

dem_status whole_triangles_of(dem_lattice *out, const dem_lattice *lattice, const unsigned char *broken)
{
    dem_lattice whole = *lattice;
    whole.n_triangles = 0;
    whole.triangles = malloc((3 * (size_t)lattice->n_triangles + 1) * sizeof *whole.triangles);
    CHECK(whole.triangles != NULL, DEM_ERROR_MEMORY, "out of memory for a surface of %lld triangles",
          (long long)lattice->n_triangles);
    for (dem_index k = 0; k < lattice->n_triangles; k++) {
        if (broken != NULL && broken[k]) continue;
        memcpy(whole.triangles + 3 * whole.n_triangles, lattice->triangles + 3 * k, 3 * sizeof *whole.triangles);
        whole.n_triangles++;
    }
    *out = whole;
    return DEM_OK;
}

void whole_triangles_free(dem_lattice *lattice)
{
    free(lattice->triangles);
    lattice->triangles = NULL;
}
