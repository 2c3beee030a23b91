/* SPDX-License-Identifier: BSD-3-Clause */
/* Triangulations of simple shapes, and holes cut into them (docs/method.md, Shapes). Their rows are made in grid.c,
 * springs and masses in assemble.c; other shapes are cut out of such grids by src/shape, and meshes come from the
 * programs (drivers/body). */
#include <dem/dem.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/status.h"
#include "lattice/grid.h"
#include "lattice/lattice.h"

static dem_status give(dem_lattice *out, const grid *g)
{
    dem_lattice lattice;
    TRY(grid_lattice(&lattice, g));
    lattice_give(out, &lattice);
    return DEM_OK;
}

/* ---- public ---- */

dem_status dem_lattice_rectangle(dem_lattice *out, double width, double height, double spacing)
{
    grid g;
    TRY(lattice_check_out(out));
    TRY(grid_of_rectangle(&g, width, height, spacing));
    return give(out, &g);
}

dem_status dem_lattice_squares(dem_lattice *out, double width, double height, double spacing)
{
    grid g;
    TRY(lattice_check_out(out));
    TRY(grid_of_squares(&g, width, height, spacing));
    return give(out, &g);
}

/* A grid around the disc, of which what is outside is cut. */
dem_status dem_lattice_disc(dem_lattice *out, double radius, double spacing)
{
    grid g;
    TRY(lattice_check_out(out));
    CHECK(lattice_is_positive(spacing) && spacing <= radius && isfinite(radius), DEM_ERROR_ARGUMENT,
          "a disc of radius %g m cannot have the spacing %g m", radius, spacing);
    double reach = radius + 1e-9 * spacing; /* a radius of whole spacings has its last nodes */
    TRY(grid_around_disc(&g, reach, spacing));
    dem_lattice lattice;
    TRY(grid_lattice(&lattice, &g));
    const dem_status status = dem_lattice_cut(&lattice, grid_disc_has, &reach);
    if (status == DEM_OK)
        lattice_give(out, &lattice);
    else
        dem_lattice_free(&lattice);
    return status;
}

/* A triangle stays if all its nodes do; nodes without a triangle go with the rest. */
dem_status dem_lattice_cut(dem_lattice *lattice, bool (*keep)(void *context, const double *x), void *context)
{
    TRY(lattice_check(lattice));
    CHECK(keep != NULL, DEM_ERROR_ARGUMENT, "keep is NULL");
    CHECK(lattice->n_springs == 0, DEM_ERROR_MODEL, "a lattice that has springs cannot be cut: %lld springs",
          (long long)lattice->n_springs);
    bool *stays = lattice_zeros(lattice->n_nodes, sizeof *stays);
    bool *whole = lattice_zeros(lattice->n_triangles, sizeof *whole);
    const bool complete = stays != NULL && whole != NULL;
    for (dem_index i = 0; complete && i < lattice->n_nodes; i++) stays[i] = keep(context, lattice->x + 2 * i);
    for (dem_index t = 0; complete && t < lattice->n_triangles; t++) {
        const dem_index *corner = lattice->triangles + 3 * t;
        whole[t] = stays[corner[0]] && stays[corner[1]] && stays[corner[2]];
    }
    const dem_status status =
        complete ? dem_lattice_trim(lattice, whole) : status_fail(DEM_ERROR_MEMORY, "out of memory");
    free(stays);
    free(whole);
    return status;
}
