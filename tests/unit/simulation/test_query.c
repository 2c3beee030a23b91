/* SPDX-License-Identifier: BSD-3-Clause */
/* query.c: what is seen of a simulation, and when. */
#include "runs.h"

#include <stdlib.h>

static void a_new_simulation_shows_the_initial_state(void **state)
{
    const double v[2] = {3.0, 4.0};
    const dem_options options = point_options();
    dem_state now = {.struct_size = sizeof now};
    (void)state;
    dem_model *model = make_point(v, 0.5);
    dem_simulation *simulation = simulate(model, &options);
    dem_simulation_state(simulation, &now);
    assert_close(now.t, 0.0, 0.0);
    assert_close(now.x[1], 1.0, 0.0);
    assert_close(now.v[0], 3.0, 0.0);
    assert_int_equal(now.n_contacts, 0);
    assert_close(now.energy.kinetic, 25.0, 0.0);
    assert_close(now.energy.gravity, 2.0 * 9.81, 0.0);
    assert_int_equal(dem_simulation_counts(simulation).steps, 0);
    end_run(simulation, model);
}

/* A caller of an older header has a shorter struct, allocated here with its size so that a memory checker sees what is
 * written beyond. */
static void a_state_is_written_as_far_as_the_callers_struct_goes(void **state)
{
    const dem_options options = point_options();
    dem_state now = {.struct_size = sizeof now};
    (void)state;
    dem_model *model = make_point(NULL, 0.5);
    dem_simulation *simulation = simulate(model, &options);
    assert_ok(dem_simulation_advance(simulation, 0.1));
    assert_ok(dem_simulation_state(simulation, &now));
    for (size_t size = 2 * sizeof(double); size < sizeof now; size += sizeof(double)) {
        dem_state *shorter = malloc(size);
        assert_non_null(shorter);
        memcpy(shorter, &size, sizeof size);
        assert_ok(dem_simulation_state(simulation, shorter));
        assert_memory_equal(shorter, &size, sizeof size);
        assert_memory_equal((char *)shorter + sizeof size, (char *)&now + sizeof size, size - sizeof size);
        free(shorter);
    }
    end_run(simulation, model);
}

static void a_state_without_a_size_is_refused_and_left_alone(void **state)
{
    const dem_options options = point_options();
    dem_state now = {.struct_size = 15, .t = 7.0};
    (void)state;
    dem_model *model = make_point(NULL, 0.5);
    dem_simulation *simulation = simulate(model, &options);
    assert_int_equal(dem_simulation_state(simulation, &now), DEM_ERROR_ARGUMENT);
    assert_string_equal(dem_status_message(), "dem_state: struct_size is 15, at least 16 expected");
    now.struct_size = 0;
    assert_int_equal(dem_simulation_state(simulation, &now), DEM_ERROR_ARGUMENT);
    assert_string_equal(dem_status_message(), "dem_state: struct_size is 0, at least 16 expected");
    assert_close(now.t, 7.0, 0.0);
    assert_int_equal(dem_simulation_state(simulation, NULL), DEM_ERROR_ARGUMENT);
    assert_string_equal(dem_status_message(), "dem_simulation_state: state is NULL");
    assert_int_equal(dem_simulation_state(NULL, &now), DEM_ERROR_ARGUMENT);
    assert_string_equal(dem_status_message(), "dem_simulation_state: simulation is NULL");
    end_run(simulation, model);
}

/* At rest on the floor after the plastic impact: m g, and m g t of impulse from the beginning on, up to the step in
 * hand. */
static void an_obstacle_feels_the_weight_that_rests_on_it(void **state)
{
    const dem_options options = point_options();
    dem_state now = {.struct_size = sizeof now};
    (void)state;
    dem_model *model = make_point(NULL, 0.0);
    dem_simulation *simulation = simulate(model, &options);
    assert_ok(dem_simulation_advance(simulation, 2.0));
    const dem_obstacle_load load = dem_simulation_obstacle(simulation, 0);
    dem_simulation_state(simulation, &now);
    assert_int_equal(load.contacts, 1);
    assert_int_equal(now.n_contacts, 1);
    assert_int_equal(now.contacts[0].nodes[0], 0);
    assert_close(load.reaction[0], 0.0, 0.0);
    assert_close(load.reaction[1], 2.0 * 9.81, 1e-14);
    assert_close(load.impulse[1], 2.0 * 9.81 * 2.0, 2.0 * 9.81 * 0.031);
    end_run(simulation, model);
}

/* One step of 0.8 s, in the middle of which the node hits the floor, after sqrt(2 / 9.81) = 0.45 s. A look at any time
 * in it sees what has happened until then, in whatever order one looks. */
typedef struct look {
    double t[2];
    dem_index impacts[2];
    double lost[2];
    int n;
} look;

static dem_status see(void *context, const dem_simulation *simulation)
{
    look *seen = context;
    dem_state now = {.struct_size = sizeof now};
    dem_simulation_state(simulation, &now);
    assert_true(seen->n < 2);
    seen->t[seen->n] = now.t;
    seen->impacts[seen->n] = dem_simulation_counts(simulation).impacts;
    seen->lost[seen->n++] = now.energy.impact;
    return DEM_OK;
}

/* Frames at 0 and 0.4 s are before the impact, the end at 0.6 s is after it; eta = 0.5 leaves a quarter of the energy
 * m g h, to the penetration tolerance of 1e-6 m. */
static void what_is_seen_within_a_step_is_without_later_events(void **state)
{
    dem_options options = point_options();
    look seen = {.n = 0};
    const dem_observer observer = {.interval = 0.4, .frame = see, .context = &seen};
    (void)state;
    options.method = DEM_METHOD_RK4;
    options.max_step = options.fixed_step = 0.8;
    dem_model *model = make_point(NULL, 0.5);
    dem_simulation *simulation = simulate(model, &options);
    assert_ok(dem_simulation_observe(simulation, &observer));
    assert_ok(dem_simulation_advance(simulation, 0.6));
    assert_int_equal(seen.n, 2);
    assert_close(seen.t[1], 0.4, 0.0);
    assert_int_equal(seen.impacts[1], 0);
    assert_close(seen.lost[1], 0.0, 0.0);
    assert_int_equal(dem_simulation_counts(simulation).impacts, 1);
    assert_int_equal(dem_simulation_counts(simulation).steps, 1);
    assert_close(dem_simulation_energy(simulation).impact, 0.75 * 2.0 * 9.81, 1e-4);
    end_run(simulation, model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_simulation_shows_the_initial_state),
        cmocka_unit_test(a_state_is_written_as_far_as_the_callers_struct_goes),
        cmocka_unit_test(a_state_without_a_size_is_refused_and_left_alone),
        cmocka_unit_test(an_obstacle_feels_the_weight_that_rests_on_it),
        cmocka_unit_test(what_is_seen_within_a_step_is_without_later_events),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
