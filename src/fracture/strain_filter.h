/* SPDX-License-Identifier: BSD-3-Clause */
/* Strains below which nothing near a spring is near its limit: most elements need no other look at a step. */
#ifndef DEM_FRACTURE_STRAIN_FILTER_H
#define DEM_FRACTURE_STRAIN_FILTER_H

#include <math.h>

#include "fracture/utilisation.h"

typedef struct strain_filter {
    float *threshold; /* [n_springs] of |strain|, or a rounding less; infinity: nothing near the spring ever breaks */
    float *least;     /* [n_triangles] Pa, strength of the weakest triangle that shares a corner, or a rounding less;
                          infinity: none of them breaks */
    float *least_pressure; /* [n_triangles] the same of compressive strengths; NULL: pressure breaks none */
} strain_filter;

/** Limits that none of the triangles that share a corner with one is below, whatever the pressure across. */
static inline utilisation_limits strain_filter_weakest(const strain_filter *f, dem_index triangle)
{
    const double pressure = f->least_pressure != NULL ? (double)f->least_pressure[triangle] : (double)INFINITY;
    return (utilisation_limits){.tension = (double)f->least[triangle], .pressure = pressure};
}

/** \param near_limit  the utilisation that is not to be missed
 *  \return DEM_ERROR_MEMORY. Free with strain_filter_destroy() */
dem_status strain_filter_create(strain_filter *out, const dem_model *model, const element_state *elements,
                                double near_limit);
void strain_filter_destroy(strain_filter *f);

#endif
