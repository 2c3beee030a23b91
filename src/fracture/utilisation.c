/* SPDX-License-Identifier: BSD-3-Clause */
/* What drives a triangle is the largest principal value of the mean of its corners' stresses, those that pictures
 * show. By the triangle's own stress, which may be chosen where it softens, the toughness of a brittle crack would
 * depend on its direction by a factor of 1.63; by the mean it does by 1.03. Where it has a compressive strength the
 * smallest principal value takes part, by the law of Mohr and Coulomb: of three principal stresses the largest over
 * the strength less the smallest over the compressive strength. Out of the plane the third is 0 in plane stress; in
 * plane strain it is the middle one where the law can break a triangle at all, if nu is not less than the ratio of
 * both strengths. Isotropic tension is no stronger than tension along one direction. A spring that has a critical
 * stretch is driven by its strain. */
#include "fracture/utilisation.h"

#include <math.h>

#include "model/node_stress.h"

utilisation_limits utilisation_limits_of(const dem_lattice *l, const element_state *elements, dem_index triangle)
{
    const int level = element_state_level(elements, triangle);
    utilisation_limits limits = {.tension = l->strength[triangle], .pressure = (double)INFINITY};
    if (level > 0) limits.tension *= softening_limit(l->softening[triangle], level);
    if (l->compressive_strength != NULL) limits.pressure = l->compressive_strength[triangle];
    if (l->confinement != NULL) limits.confinement = l->confinement[triangle];
    return limits;
}

double utilisation_of_stress(utilisation_limits limits, const double a[3], const double b[3], const double c[3])
{
    double mean[3];
    for (int k = 0; k < 3; k++) mean[k] = (a[k] + b[k] + c[k]) / 3.0;
    const double middle = 0.5 * (mean[0] + mean[1]), half = 0.5 * (mean[0] - mean[1]);
    const double radius = sqrt(half * half + mean[2] * mean[2]), largest = middle + radius, least = middle - radius;
    if (isinf(limits.pressure)) return largest / limits.tension;
    const double pressed = (limits.confinement * fmin(largest, 0.0) - fmin(least, 0.0)) / limits.pressure;
    return fmax(largest, 0.0) / limits.tension + pressed;
}

double utilisation_of(const dem_model *model, const element_state *elements, dem_index element, const double *x)
{
    const dem_lattice *l = &model->lattice;
    const dem_index spring = element - l->n_triangles;
    double stress[3][3];
    if (spring >= 0) return springs_strain_of(l, spring, x) / l->critical_stretch[spring];
    const dem_index *corner = &l->triangles[3 * element];
    const utilisation_limits limits = utilisation_limits_of(l, elements, element);
    if (utilisation_by_own_stress(l, element)) {
        node_stress_of_triangle(model, elements, element, x, stress[0]);
        return utilisation_of_stress(limits, stress[0], stress[0], stress[0]);
    }
    for (int c = 0; c < 3; c++) node_stress(model, elements, NODE_STRESS_EFFECTIVE, corner[c], x, stress[c]);
    return utilisation_of_stress(limits, stress[0], stress[1], stress[2]);
}
