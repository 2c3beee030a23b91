/* SPDX-License-Identifier: BSD-3-Clause */
/* ARKODE behind the table of an integrator: explicit Runge-Kutta methods with a root function, in adaptive steps or
 * fixed ones. How a step passes through ARKODE is in the .c file; who calls it, in integrator.h. */
#ifndef DEM_TIME_ARKODE_INTEGRATOR_H
#define DEM_TIME_ARKODE_INTEGRATOR_H

#include "time/integrator_ops.h"

extern const integrator_ops arkode_integrator_ops;

#endif
