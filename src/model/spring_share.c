/* SPDX-License-Identifier: BSD-3-Clause */
/* Shares of a spring in proportion to what its triangles gave to its stiffness. The lattice does not keep these
 * numbers; they follow from modulus, thickness and shape as long as the lattice has been assembled by
 * lattice/assemble.c. Of other lattices they are a choice, which stresses (stress.c) and the bound of frequencies
 * (coupled_bound.c) make alike. */
#include "model/spring_share.h"

#include "base/vec2.h"
#include "lattice/triangle_share.h"

/* An array that is missing stands for 1. */
static double one_or(const double *array, dem_index k)
{
    return array != NULL ? array[k] : 1.0;
}

double spring_share_volume(const dem_lattice *lattice, dem_index triangle)
{
    return one_or(lattice->thickness, triangle) * vec2_area_of(lattice->x, &lattice->triangles[3 * triangle]);
}

/* A spring that is no edge of the triangle is a diagonal of cells, which have no couplings. */
static double weight_of(const dem_lattice *l, dem_index triangle, dem_index spring)
{
    const dem_index *c = &l->triangles[3 * triangle], *ends = &l->ends[2 * spring];
    const double *coupling = l->coupling != NULL ? &l->coupling[3 * triangle] : NULL;
    if (coupling == NULL || (coupling[0] == 0.0 && coupling[1] == 0.0 && coupling[2] == 0.0)) return 1.0;
    const triangle_share share =
        triangle_share_coupled((const vec2[]){vec2_at(l->x, c[0]), vec2_at(l->x, c[1]), vec2_at(l->x, c[2])});
    for (int q = 0; q < 3; q++)
        if (c[(q + 2) % 3] != ends[0] && c[(q + 2) % 3] != ends[1]) return share.weight[q];
    return 1.0;
}

double spring_share_given(const dem_lattice *lattice, dem_index triangle, dem_index spring)
{
    return one_or(lattice->modulus, triangle) * spring_share_volume(lattice, triangle) *
           weight_of(lattice, triangle, spring);
}
