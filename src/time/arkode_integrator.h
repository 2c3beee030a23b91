/* SPDX-License-Identifier: BSD-3-Clause */
/* ARKODE behind a few functions: explicit Runge-Kutta methods with root functions, in adaptive steps or fixed ones. */
#ifndef DEM_TIME_ARKODE_INTEGRATOR_H
#define DEM_TIME_ARKODE_INTEGRATOR_H

#include "time/integrator_ops.h"

extern const integrator_ops arkode_integrator_ops;

#endif
