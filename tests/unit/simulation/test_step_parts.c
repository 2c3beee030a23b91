/* SPDX-License-Identifier: BSD-3-Clause */
/* step_parts.c: what is left of a simulation without them. */
#include <string.h>

#include "runs.h"
#include "simulation/step_parts.h"

/* Stresses and forces are of the model and of the state that is seen. */
TEST(a_state_is_measured_without_what_steps_are_taken_with)
{
    const dem_options options = dem_options_default();
    CLEANUP(free_model) dem_model *model = make_falling(0.5);
    CLEANUP(free_simulation) dem_simulation *s = simulate(model, &options);
    const size_t n = (size_t)dem_model_lattice(model)->n_nodes;
    const size_t n_springs = (size_t)dem_model_lattice(model)->n_springs;
    CLEANUP(free_memory) double *before = malloc(2 * (3 * n + n_springs) * sizeof *before);
    double *after = before + 3 * n + n_springs;
    for (size_t k = 0; k < 2 * n; k++) s->y[k] *= 1.0 + 0.01 * sin((double)k);
    assert_ok(dem_simulation_stress(s, before));
    assert_ok(dem_simulation_forces(s, before + 3 * n));
    memcpy(s->frame, s->y, (size_t)state_size(&s->layout) * sizeof *s->y);
    step_parts_destroy(s);
    assert_null(s->y);
    assert_null(s->integrator.self);
    assert_null(s->kernel.rings);
    assert_ok(dem_simulation_stress(s, after));
    assert_ok(dem_simulation_forces(s, after + 3 * n));
    assert_memory_equal(after, before, (3 * n + n_springs) * sizeof *before);
}
