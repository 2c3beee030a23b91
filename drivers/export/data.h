/* SPDX-License-Identifier: BSD-3-Clause */
/* NAME.data: a LAMMPS data file of atom_style bond. */
#ifndef DEM_DATA_H
#define DEM_DATA_H

#include "molecule.h"

/** False, and the outcome, if it cannot be written. */
bool data_write(const molecule *m);

#endif
