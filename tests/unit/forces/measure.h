/* SPDX-License-Identifier: BSD-3-Clause */
/* Measures a state with a survey of its own. */
#ifndef DEM_TEST_FORCES_MEASURE_H
#define DEM_TEST_FORCES_MEASURE_H

#include "forces/diagnostics.h"
#include "unit/free_team.h"
#include "verification/support.h"

enum { MEASURE_BODIES = 8 };

typedef struct measures {
    dem_energy energy;
    dem_strain strain;
    dem_body_motion body[MEASURE_BODIES];
    double inertia[MEASURE_BODIES];
} measures;

static inline measures measure_with(const forces *f, const double *x, const double *v, dem_kernel kind, int n_threads)
{
    measures m;
    CLEANUP(free_team) team *t = team_create(n_threads, 1);
    CLEANUP(kernel_destroy) kernel k;
    CLEANUP(survey_destroy) survey s;
    assert_true(f->model->n_bodies <= MEASURE_BODIES);
    assert_ok(kernel_create(&k, f->model, kind, t));
    assert_ok(survey_create(&s, &k));
    survey_take(&s, f, x, v);
    m.energy = diagnostics_energy(f, &s, x, v);
    m.strain = s.strain;
    survey_bodies(&s, x, v, m.body);
    survey_inertia(&s, x, m.body, m.inertia);
    return m;
}

static inline measures measure_state(const forces *f, const double *x, const double *v)
{
    return measure_with(f, x, v, DEM_KERNEL_AUTO, 1);
}

#endif
