/* SPDX-License-Identifier: BSD-3-Clause */
#include "driving.h"

#include <stdlib.h>

#include "support.h"

static double driving_of(const dem_index *corner, const double *stress)
{
    double mean[3] = {0.0, 0.0, 0.0}, value[2], direction[2];
    for (int j = 0; j < 9; j++) mean[j % 3] += stress[3 * corner[j / 3] + j % 3] / 3.0;
    dem_stress_principal(mean, value, direction);
    return fmax(value[0], value[1]);
}

double driving_most(const dem_simulation *simulation, const dem_lattice *l, dem_index *triangle)
{
    double *stress = calloc((size_t)(3 * l->n_nodes), sizeof *stress), most = 0.0;
    unsigned char *broken = calloc((size_t)l->n_triangles, 1);
    assert_true(stress != NULL && broken != NULL);
    assert_ok(dem_simulation_stress(simulation, stress));
    assert_ok(dem_simulation_broken(simulation, broken, NULL));
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const double found = broken[t] ? 0.0 : driving_of(&l->triangles[3 * t], stress);
        if (found > most) *triangle = t;
        most = fmax(most, found);
    }
    free(stress);
    free(broken);
    return most;
}
