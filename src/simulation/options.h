/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks the options of a simulation and fills in defaults. */
#ifndef DEM_SIMULATION_OPTIONS_H
#define DEM_SIMULATION_OPTIONS_H

#include "forces/boundary_conditions.h"
#include "model/model.h"

/** Copies a caller's options, of which what is missing has its default.  \return as options_check() */
dem_status options_read(dem_options *ours, const dem_options *theirs);

/** \return DEM_ERROR_ARGUMENT for a value that no model makes valid */
dem_status options_check(const dem_options *o);

/** Replaces every default by what it is for a model and its boundaries.  \return DEM_ERROR_ARGUMENT where there is none
 *  and a value is needed */
dem_status options_fill(dem_options *o, const dem_model *model, const boundary_conditions *b);

#endif
