/* SPDX-License-Identifier: BSD-3-Clause */
/* The model of a domain from its cut, as its rank compiles it. */
#ifndef DEM_MODEL_DOMAIN_COMPILE_H
#define DEM_MODEL_DOMAIN_COMPILE_H

#include "model/domain_cut.h"

/** Completes the model of a cut, which takes its lattice over, but for the ranks and model_find_scales().
 *  \param touching  whether bodies may touch each other, or themselves
 *  \return DEM_ERROR_MEMORY; the model is then as far as dem_model_destroy() can end it */
dem_status domain_compile(domain_cut *c, const dem_obstacle *obstacles, dem_index n_obstacles, bool touching);

#endif
