/* SPDX-License-Identifier: BSD-3-Clause */
/* How far an element is from breaking or softening: its utilisation is what drives it over what it stands as it is, and
 * it breaks, or softens once more, at 1 (docs/method.md, Fracture). Elements are numbered: first the triangles of a
 * lattice, then its springs. */
#ifndef DEM_FRACTURE_UTILISATION_H
#define DEM_FRACTURE_UTILISATION_H

#include <math.h>

#include "model/breakable_nodes.h"
#include "model/element_state.h"
#include "model/model.h"

/** What a triangle stands. */
typedef struct utilisation_limits {
    double tension;     /* Pa: its strength, or more if it has softened, as effective stress is what drives it */
    double pressure;    /* Pa: its compressive strength; infinity: pressure alone does not break it */
    double confinement; /* by how much that rises with pressure across */
} utilisation_limits;

utilisation_limits utilisation_limits_of(const dem_lattice *lattice, const element_state *elements, dem_index triangle);

/** Of a triangle whose corners have these effective stresses, Pa, by the principal values s1 >= s3 of their mean:
 *  s1/tension, and where pressure is limited
 *      max(s1, 0)/tension - min(s3, 0)/pressure + confinement min(s1, 0)/pressure. */
double utilisation_of_stress(utilisation_limits limits, const double a[3], const double b[3], const double c[3]);

/** Whether the utilisation of a stress is below a bound > 0 by a bound of it that needs no root: a principal stress is
 *  not larger than the mean of xx and yy and the sizes of half their difference and of xy. */
static inline bool utilisation_is_below(utilisation_limits limits, const double stress[3], double bound)
{
    const double middle = 0.5 * (stress[0] + stress[1]), half = 0.5 * (stress[0] - stress[1]);
    return isinf(limits.pressure) && middle + fabs(half) + fabs(stress[2]) < bound * limits.tension;
}

/** Whether it is not the mean of its corners' stresses that breaks a triangle, but its own. */
static inline bool utilisation_by_own_stress(const dem_lattice *l, dem_index triangle)
{
    return l->own_stress != NULL && l->own_stress[triangle] != 0;
}

/** Of an element that is whole, at positions x [n][2]: of a triangle by its corners' stresses, or its own, of a spring
 *  its strain over the critical one. */
double utilisation_of(const dem_model *model, const element_state *elements, dem_index element, const double *x);

/** How many elements have numbers: triangles, and springs where some of these have a critical stretch. */
static inline dem_index utilisation_n_elements(const dem_lattice *l)
{
    return l->n_triangles + (l->critical_stretch != NULL ? l->n_springs : 0);
}

#endif
