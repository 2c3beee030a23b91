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

static bool has_both(const dem_index *corner, const dem_index *ends)
{
    int n = 0;
    for (int j = 0; j < 6; j++) n += corner[j / 2] == ends[j % 2];
    return n == 2;
}

double driving_most_strain(const dem_simulation *simulation, const dem_lattice *l, dem_index *n, dem_index *triangle)
{
    double *strain = calloc((size_t)l->n_springs, sizeof *strain);
    unsigned char *spring_broken = calloc((size_t)l->n_springs, 1), *broken = calloc((size_t)l->n_triangles, 1);
    dem_index most = -1;
    assert_true(strain != NULL && spring_broken != NULL && broken != NULL);
    assert_ok(dem_simulation_strains(simulation, strain));
    assert_ok(dem_simulation_broken(simulation, broken, spring_broken));
    for (dem_index k = 0; k < l->n_springs; k++)
        if (!spring_broken[k] && (most < 0 || strain[k] > strain[most])) most = k;
    *n = 0;
    for (dem_index t = 0; t < l->n_triangles; t++)
        if (!broken[t] && has_both(&l->triangles[3 * t], &l->ends[2 * most])) triangle[(*n)++] = t;
    const double found = strain[most];
    free(strain);
    free(spring_broken);
    free(broken);
    return found;
}
