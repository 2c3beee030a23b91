/* SPDX-License-Identifier: BSD-3-Clause */
/* NAME.dump and NAME.local.dump: the frames as LAMMPS dumps them, atoms by `dump custom`, bonds by `dump local`. */
#ifndef DEM_DUMP_H
#define DEM_DUMP_H

#include "molecule.h"

/** False, and the outcome, if they cannot be written. */
bool dump_atoms(const molecule *m);
bool dump_bonds(const molecule *m);

#endif
