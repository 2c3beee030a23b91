/* SPDX-License-Identifier: BSD-3-Clause */
/* What a simulation is refused for, where the model is there already. */
#ifndef DEM_REFUSAL_H
#define DEM_REFUSAL_H

#include "deck.h"

/** Lists the library's last message, with the key of the deck that it is about and what helps.
 *  \param model, options  which dem_simulation_create() has just refused by DEM_ERROR_MODEL */
void refusal_explain(namelist_errors *errors, const deck *d, const dem_model *model, const dem_options *options);

#endif
