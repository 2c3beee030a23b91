/* SPDX-License-Identifier: BSD-3-Clause */
/* Velocity Verlet, (5) as kick, drift and kick, with root functions; in fixed steps. */
#ifndef DEM_TIME_VERLET_INTEGRATOR_H
#define DEM_TIME_VERLET_INTEGRATOR_H

#include "time/integrator_ops.h"

extern const integrator_ops verlet_integrator_ops;

#endif
