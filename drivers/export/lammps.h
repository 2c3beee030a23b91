/* SPDX-License-Identifier: BSD-3-Clause */
/* For LAMMPS, OVITO and MDAnalysis: a data file, an input, and dumps of atoms and bonds. */
#ifndef DEM_LAMMPS_H
#define DEM_LAMMPS_H

#include "task.h"

/** False, and the outcome, if it fails. */
bool lammps_export(const task *t);

#endif
