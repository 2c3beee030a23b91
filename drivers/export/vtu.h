/* SPDX-License-Identifier: BSD-3-Clause */
/* For ParaView of any version: a .vtu for each frame, a .pvd with their times, and a .vtu of the obstacles. */
#ifndef DEM_VTU_H
#define DEM_VTU_H

#include "task.h"

/** False, and the outcome, if it fails. */
bool vtu_export(const task *t);

#endif
