/* SPDX-License-Identifier: BSD-3-Clause */
/* setup.c: what is refused, what is in force, and that simulations of one model are independent. */
#include "ask.h"
#include "harness/message.h"
#include "runs.h"

static void refuse(const dem_model *model, const dem_options *options, const char *message)
{
    dem_simulation *simulation = NULL;
    assert_int_equal(dem_simulation_create(&simulation, model, options), DEM_ERROR_ARGUMENT);
    assert_message_parts(message);
    assert_null(simulation);
}

TEST(options_that_cannot_be_leave_no_simulation)
{
    CLEANUP(free_model) dem_model *model = make_point(NULL, 0.5);
    dem_options options = point_options();
    options.rtol = 0.2;
    refuse(model, &options, "rtol * [1e-13, 0.1] * 0.2");
    options = point_options();
    options.spacing = 0.0;
    refuse(model, &options, "a model without springs needs the option spacing, in m");
    options = point_options();
    options.kernel = (dem_kernel)99;
    refuse(model, &options, "kernel 99");
}

TEST(null_arguments_are_named)
{
    const dem_options options = point_options();
    dem_simulation *simulation;
    CLEANUP(free_model) dem_model *model = make_point(NULL, 0.5);
    assert_int_equal(dem_simulation_create(NULL, model, &options), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_simulation_create: out is NULL");
    refuse(NULL, &options, "dem_simulation_create: model is NULL");
    refuse(model, NULL, "dem_simulation_create: options is NULL");
    assert_int_equal(dem_simulation_advance(NULL, 1.0), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_simulation_advance: simulation is NULL");
    const dem_observer observer = {.struct_size = sizeof(dem_observer)};
    assert_int_equal(dem_simulation_observe(NULL, &observer), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_simulation_observe: simulation is NULL");
    simulation = simulate(model, &options);
    assert_int_equal(dem_simulation_observe(simulation, NULL), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_simulation_observe: observer is NULL");
    dem_simulation_destroy(simulation);
    dem_simulation_destroy(NULL);
}

TEST(a_start_deeper_than_the_penetration_tolerance_is_refused)
{
    const double x[2] = {0.25, -0.125}, mass = 2.0;
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.5);
    const dem_options options = point_options();
    dem_simulation *simulation = NULL;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    CLEANUP(free_model) dem_model *model = support_model(&lattice, &obstacle, 1);
    dem_options with_scale = options;
    with_scale.v_scale = 1.0;
    assert_int_equal(dem_simulation_create(&simulation, model, &with_scale), DEM_ERROR_MODEL);
    assert_message_parts("node 0 * (0.25, -0.125) m * 0.125 m inside obstacle 0 * penetration tolerance * 1e-06 m");
    assert_null(simulation);
}

TEST(the_options_in_force_have_no_defaults_left)
{
    const dem_options asked = dem_options_default();
    CLEANUP(free_model) dem_model *model = make_falling(0.5);
    CLEANUP(free_simulation) dem_simulation *simulation = simulate(model, &asked);
    const dem_options options = ask_options(simulation);
    assert_close(options.spacing, dem_model_spacing(model), 0.0);
    assert_close(options.max_step, 0.5 / dem_model_omega_max(model), 0.0);
    assert_close(options.v_scale, hypot(0.5, 4.0), 1e-14);
    assert_true(options.kernel != DEM_KERNEL_AUTO);
    assert_ptr_equal(dem_simulation_model(simulation), model);
}

TEST(methods_without_error_estimate_take_steps_of_one_length)
{
    static const dem_method methods[2] = {DEM_METHOD_RK4, DEM_METHOD_KNOTHWOLKE3};
    dem_options options = dem_options_default();
    CLEANUP(free_model) dem_model *model = make_falling(0.0);
    for (int k = 0; k < 2; k++) {
        dem_method_traits traits = {.struct_size = sizeof traits};
        options.method = methods[k];
        assert_ok(dem_method_describe(&traits, options.method));
        CLEANUP(free_simulation) dem_simulation *simulation = simulate(model, &options);
        const double step = ask_options(simulation).fixed_step;
        assert_ok(dem_simulation_advance(simulation, 20.5 * step));
        assert_int_equal(ask_counts(simulation).steps, 21);
        assert_int_equal(ask_counts(simulation).evaluations, 21 * traits.evaluations + 1);
    }
}

TEST(two_simulations_of_a_model_do_not_disturb_each_other)
{
    const dem_options options = dem_options_default();
    dem_options other_options = options;
    CLEANUP(free_model) dem_model *model = make_falling(0.5);
    const snapshot alone = run_whole(model);
    other_options.gravity[0] = 100.0;
    other_options.method = DEM_METHOD_BS23;
    CLEANUP(free_simulation)
    dem_simulation *simulation = simulate(model, &options), *other = simulate(model, &other_options);
    for (int k = 1; k <= 5; k++) {
        assert_ok(dem_simulation_advance(other, 0.15 * t_whole * k));
        assert_ok(dem_simulation_advance(simulation, t_whole * k / 5.0));
    }
    const snapshot beside = snap(simulation);
    assert_same(&beside, &alone);
}

TEST(there_are_at_most_8_observers_and_none_after_the_first_advance)
{
    const dem_options options = point_options();
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .interval = 0.1};
    CLEANUP(free_model) dem_model *model = make_point(NULL, 0.5);
    CLEANUP(free_simulation) dem_simulation *simulation = simulate(model, &options);
    for (int k = 0; k < 8; k++) assert_ok(dem_simulation_observe(simulation, &observer));
    assert_int_equal(dem_simulation_observe(simulation, &observer), DEM_ERROR_ARGUMENT);
    assert_message_parts("at most 8 observers");
    assert_ok(dem_simulation_advance(simulation, 0.0));
    assert_int_equal(dem_simulation_observe(simulation, &observer), DEM_ERROR_ARGUMENT);
    assert_message_parts("observers come before the first advance");
}
