/* SPDX-License-Identifier: BSD-3-Clause */
/* in.NAME: an input of LAMMPS that goes on from NAME.data to the last frame. */
#ifndef DEM_SCRIPT_H
#define DEM_SCRIPT_H

#include "molecule.h"

/** False, and the outcome, if it cannot be written. */
bool script_write(const molecule *m);

#endif
