/* SPDX-License-Identifier: BSD-3-Clause */
/* A random field of force over a scene. */
#ifndef DEM_TEST_FIELD_H
#define DEM_TEST_FIELD_H

#include "scene.h"

/** m (a + B (x - c) - d v + w J v + f cos(o t + node)), J a quarter turn; it may fail, once. */
typedef struct field {
    double mass, a[2], b[2][2], c[2], d, w, f[2], o;
    long calls, fails_at;       /* the call at which it does; 0: at none */
    long alone, fails_at_alone; /* the same of calls about one node */
    dem_status status;          /* then; DEM_OK: with a number that is none */
} field;

/** The same for the same scene and seed. */
void field_random(field *out, const scene *sc, unsigned long seed);

/** It as options want it, with a `field` for context. */
dem_status field_act(void *context, const dem_force_query *q, double *force);

/** Uniform in -most to most. */
double field_uniform(gsl_rng *rng, double most);

#endif
