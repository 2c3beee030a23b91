/* SPDX-License-Identifier: BSD-3-Clause */
/* Strains below which nothing near a spring is near its limit: most elements need no other look at a step. */
#ifndef DEM_FRACTURE_STRAIN_FILTER_H
#define DEM_FRACTURE_STRAIN_FILTER_H

#include <math.h>

#include "forces/kernel.h"
#include "fracture/utilisation.h"

typedef struct strain_filter {
    kernel_threshold *threshold; /* [n_springs] strains, or a rounding less; infinity: nothing near the spring ever
                                    breaks by such; NULL: forgotten */
    dem_index n_always;
    dem_index *always;          /* [n_always] nodes of which the stress has no bound by strains */
    bool have_edges;            /* whether all edges of triangles that are not rigid have springs */
    utilisation_limits weakest; /* the least limits of all triangles, whatever the pressure across */
} strain_filter;

/** \param near_limit  the utilisation that is not to be missed
 *  \return DEM_ERROR_MEMORY. Free with strain_filter_destroy() */
dem_status strain_filter_create(strain_filter *out, const dem_model *model, const element_state *elements,
                                double near_limit);
void strain_filter_destroy(strain_filter *f);

/** Frees the thresholds, and keeps the rest. */
void strain_filter_forget_thresholds(strain_filter *f);

#endif
