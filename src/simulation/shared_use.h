/* SPDX-License-Identifier: BSD-3-Clause */
/* What simulations with certain options have a use for in a model that ranks share, before it is shared out. */
#ifndef DEM_SIMULATION_SHARED_USE_H
#define DEM_SIMULATION_SHARED_USE_H

#include "model/shared_model.h"

/** Puts it into `whole`: rings of ghosts, and whether bodies touch. No program may call this.
 *  \return DEM_ERROR_ARGUMENT as options_read() */
DEM_API dem_status dem_private_use_shared(dem_private_whole *whole, const dem_options *options);

#endif
