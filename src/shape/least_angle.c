/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/least_angle.h"

#include <math.h>

#include <dem/shape.h>

#include "base/status.h"
#include "lattice/lattice.h"

double least_angle_cotangent(const double *x, const dem_index *corner)
{
    double largest = -(double)INFINITY;
    for (int c = 0; c < 3; c++) {
        const double *a = x + 2 * corner[c], *b = x + 2 * corner[(c + 1) % 3], *e = x + 2 * corner[(c + 2) % 3];
        const double ux = b[0] - a[0], uy = b[1] - a[1], vx = e[0] - a[0], vy = e[1] - a[1];
        const double cross = ux * vy - uy * vx;
        if (!(cross > 0.0)) return (double)INFINITY;
        largest = fmax(largest, (ux * vx + uy * vy) / cross);
    }
    return largest;
}

dem_status dem_lattice_least_angle(const dem_lattice *lattice, double *angle)
{
    double worst = 0.0;
    TRY(lattice_check(lattice));
    CHECK(angle != NULL, DEM_ERROR_ARGUMENT, "angle is NULL");
    for (dem_index t = 0; t < lattice->n_triangles; t++)
        worst = fmax(worst, least_angle_cotangent(lattice->x, lattice->triangles + 3 * t));
    *angle = atan(1.0 / worst);
    return DEM_OK;
}
