/* SPDX-License-Identifier: BSD-3-Clause */
/* options.c: what is refused, and what stands for a default. */
#include "unit/simulation/runs.h"

#include <stdio.h>
#include <stdlib.h>

#include "harness/message.h"
#include "simulation/options.h"

static const boundary_conditions no_boundaries = {0};

/* A small rectangle of rubber in flight; `damping` s, `speed` m/s. */
static dem_model *make_rubber(double damping, double speed)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .damping_time = damping);
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(0.03, 0.04, 0.01, &rubber);
    assert_ok(dem_lattice_launch(&lattice, (const double[2]){0.6 * speed, 0.8 * speed}));
    dem_model *model = support_model(&lattice, NULL, 0);
    return model;
}

/* ---- validity ---- */

static void refuse(const dem_options *options, const char *message)
{
    assert_int_equal(options_check(options), DEM_ERROR_ARGUMENT);
    assert_message_parts(message);
}

/* What an older or newer header gives is test_struct_size.c's business. */
TEST(options_of_a_size_that_no_version_has_are_refused)
{
    char message[128];
    dem_options own, options = point_options();
    options.struct_size = 3;
    (void)snprintf(message, sizeof message, "dem_options: struct_size is 3, at least %zu expected",
                   offsetof(dem_options, bodies));
    assert_int_equal(options_read(&own, &options), DEM_ERROR_ARGUMENT);
    assert_message_parts(message);
    options.struct_size = sizeof options;
    options.rtol = 0.2;
    assert_int_equal(options_read(&own, &options), DEM_ERROR_ARGUMENT);
    assert_message_parts("rtol * [1e-13, 0.1] * 0.2");
}

TEST(lengths_times_and_speeds_are_finite_and_not_negative)
{
    static const char *const names[7] = {
        "spacing", "v_scale", "max_step", "fixed_step", "penetration_tolerance", "rest_speed", "contact_thickness"};
    char message[128];
    for (int k = 0; k < 7; k++) {
        dem_options options = point_options();
        double *const lengths[7] = {&options.spacing,
                                    &options.v_scale,
                                    &options.max_step,
                                    &options.fixed_step,
                                    &options.penetration_tolerance,
                                    &options.rest_speed,
                                    &options.contact_thickness};
        *lengths[k] = -1.0;
        (void)snprintf(message, sizeof message, "%s must be >= 0, got -1", names[k]);
        refuse(&options, message);
        *lengths[k] = (double)INFINITY;
        (void)snprintf(message, sizeof message, "%s must be >= 0, got inf", names[k]);
        refuse(&options, message);
        *lengths[k] = 0.25;
        assert_ok(options_check(&options));
    }
}

/* One option of those of a point is wrong. */
#define REFUSE(option, wrong, message)                                                                                 \
    do {                                                                                                               \
        dem_options options = point_options();                                                                         \
        options.option = wrong;                                                                                        \
        refuse(&options, message);                                                                                     \
    } while (0)

TEST(options_outside_their_ranges_are_named)
{
    const dem_options good = point_options();
    assert_ok(options_check(&good));
    REFUSE(gravity[0], fabs((double)NAN), "gravity (nan, -9.81) * not finite");
    REFUSE(gravity[2], -9.81, "gravity * third component * -9.81");
    REFUSE(rtol, 0.2, "rtol * [1e-13, 0.1] * 0.2");
    REFUSE(rtol, 0.0, "rtol * [1e-13, 0.1] * 0");
    REFUSE(rtol, fabs((double)NAN), "rtol * [1e-13, 0.1] * nan");
    REFUSE(mass_damping, -2.0, "mass_damping * >= 0 * -2");
    REFUSE(window, (double)INFINITY, "window * finite * inf");
    REFUSE(max_impacts, 0, "max_impacts * >= 1 * 0");
    REFUSE(contact, (dem_contact_method)7, "method 7");
    REFUSE(threads, 0, "threads * [1, 1024] * 0");
    REFUSE(thread_nodes, -1, "thread_nodes * >= 0 * -1");
    REFUSE(threads, 1025, "threads * [1, 1024] * 1025");
}

static void refuse_filling(const dem_model *model, dem_options options, const char *message)
{
    assert_int_equal(options_fill(&options, model, &no_boundaries), DEM_ERROR_ARGUMENT);
    assert_message_parts(message);
}

TEST(a_model_without_springs_needs_its_scales)
{
    CLEANUP(free_model) dem_model *model = make_point(NULL, 0.0);
    dem_options options = point_options();
    options.spacing = 0.0;
    refuse_filling(model, options, "a model without springs needs the option spacing, in m");
    options = point_options();
    options.max_step = 0.0;
    refuse_filling(model, options, "a model without springs needs the option max_step, in s");
    options = point_options();
    options.gravity[1] = 0.0;
    refuse_filling(model, options, "nothing sets a scale of speed: the option v_scale is needed, in m/s");
    options = point_options();
    options.method = (dem_method)99;
    refuse_filling(model, options, "method 99");
}

/* ---- defaults ---- */

TEST(defaults_come_from_the_model)
{
    CLEANUP(free_model) dem_model *model = make_rubber(0.0, 4.0);
    dem_options options = dem_options_default();
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_int_equal(options.struct_size, sizeof options);
    assert_int_equal(options.method, DEM_METHOD_FEHLBERG45);
    assert_int_equal(options.contact, DEM_CONTACT_LOCAL);
    assert_close(options.gravity[0], 0.0, 0.0);
    assert_close(options.gravity[1], -9.81, 0.0);
    assert_close(options.rtol, 1e-6, 0.0);
    assert_close(options.spacing, dem_model_spacing(model), 0.0);
    assert_close(options.max_step, 0.5 / dem_model_omega_max(model), 0.0);
    assert_close(options.fixed_step, 0.0, 0.0);
    assert_close(options.penetration_tolerance, 1e-6 * dem_model_spacing(model), 0.0);
    assert_close(options.v_scale, 4.0, 1e-14);
    assert_int_equal(options.max_impacts, 10000);
}

TEST(friction_of_bodies_is_checked)
{
    const double frictions[2] = {0.5, -0.1};
    dem_options options = dem_options_default();
    options.contact_friction = 0.1;
    refuse(&options, "contact_friction and body_friction are of bodies that touch, but the option bodies is none");
    options.bodies = DEM_BODIES_ALL;
    assert_ok(options_check(&options));
    options.contact_friction = -0.1;
    refuse(&options, "contact_friction must be >= 0, got -0.1");
    options.contact_friction = (double)INFINITY;
    refuse(&options, "contact_friction must be >= 0, got inf");
    options.contact_friction = 0.0;
    options.n_body_frictions = 2;
    refuse(&options, "n_body_frictions is 2, body_friction is NULL");
    options.body_friction = frictions;
    refuse(&options, "body_friction of body 1 must be >= 0, got -0.1");
    options.n_body_frictions = 1;
    assert_ok(options_check(&options));
    options.bodies = DEM_BODIES_NONE;
    refuse(&options, "the option bodies is none");
}

TEST(what_is_given_counts)
{
    CLEANUP(free_model) dem_model *model = make_rubber(0.0, 4.0);
    dem_options options = dem_options_default();
    options.spacing = 0.125;
    options.v_scale = 0.25;
    options.max_step = 3e-5;
    options.penetration_tolerance = 1e-3;
    options.rest_speed = 0.1;
    options.window = 2e-6;
    options.contact_stiffness = 3.0;
    options.thread_nodes = 70;
    const dem_options asked = options;
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_memory_equal(&options, &asked, sizeof options);
    options.fixed_step = 0.01;
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_close(options.max_step, 0.01, 0.0);
}

/* An eighth of the stability bound where omega_max is known. */
TEST(methods_without_error_estimate_take_steps_of_one_length)
{
    static const dem_method methods[3] = {DEM_METHOD_RK4, DEM_METHOD_KNOTHWOLKE3, DEM_METHOD_VERLET};
    CLEANUP(free_model) dem_model *model = make_rubber(0.0, 4.0);
    for (int k = 0; k < 3; k++) {
        dem_options options = dem_options_default();
        dem_method_traits traits = {.struct_size = sizeof traits};
        options.method = methods[k];
        assert_ok(dem_method_describe(&traits, options.method));
        assert_ok(options_fill(&options, model, &no_boundaries));
        const double step = traits.stable / 8.0 / dem_model_omega_max(model);
        assert_close(options.fixed_step, step, 1e-15 * step);
        assert_close(options.max_step, step, 1e-15 * step);
        options.max_step = 0.01;
        assert_ok(options_fill(&options, model, &no_boundaries));
        assert_close(options.fixed_step, step, 1e-15 * step);
        options.max_step = 0.01;
        options.fixed_step = 0.0;
        assert_ok(options_fill(&options, model, &no_boundaries));
        assert_close(options.fixed_step, 0.01, 0.0);
    }
}

/* How many threads are used of five. */
static int used_of_five(const dem_model *model, dem_index thread_nodes)
{
    dem_options options = dem_options_default();
    options.threads = 5;
    options.thread_nodes = thread_nodes;
    assert_ok(options_fill(&options, model, &no_boundaries));
    return options.threads;
}

TEST(as_many_threads_are_used_as_have_nodes_enough)
{
    CLEANUP(free_model) dem_model *model = make_rubber(0.0, 4.0);
    const dem_index n = model->lattice.n_nodes;
    assert_int_equal(used_of_five(model, 1), n < 5 ? n : 5);
    assert_int_equal(used_of_five(model, n / 2), 2);
    assert_int_equal(used_of_five(model, n / 2 + 1), 1);
    assert_int_equal(used_of_five(model, 2 * n), 1);
    assert_int_equal(used_of_five(model, 0), 1);
}

/* Where damping is faster than the springs it sets the longest step, 1/(2 (rate + mass damping)). */
TEST(strong_damping_shortens_the_longest_step)
{
    CLEANUP(free_model) dem_model *model = make_rubber(1e-2, 4.0);
    dem_options options = dem_options_default();
    assert_ok(options_fill(&options, model, &no_boundaries));
    const double rate = 0.5 / options.max_step;
    assert_true(rate > 2.0 * dem_model_omega_max(model));
    options.max_step = 0.0;
    options.mass_damping = rate;
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_close(options.max_step, 0.25 / rate, 1e-14 / rate);
}

/* Contacts taken where they happen need no window; the whole body's stops are as long as a tenth of 1/omega_max, or of
 * twice the longest step. */
TEST(the_window_is_for_stops_of_the_whole_body)
{
    CLEANUP(free_model) dem_model *model = make_rubber(0.0, 4.0);
    dem_options options = dem_options_default();
    const double omega = dem_model_omega_max(model);
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_close(options.window, 0.0, 0.0);
    options = dem_options_default();
    options.contact = DEM_CONTACT_EXACT;
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_close(options.window, 0.1 / omega, 1e-16 / omega);
    options = dem_options_default();
    options.contact = DEM_CONTACT_EXACT;
    options.max_step = 0.125 / omega;
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_close(options.window, 0.025 / omega, 1e-16 / omega);
}

/* Without an initial speed: the drop of 1 m to the floor; a body at rest without obstacles: a thousandth of
 * omega_max a/2; what a boundary drives: its speed. */
TEST(the_scale_of_speed_is_the_largest_at_hand)
{
    const double v[2] = {30.0, 40.0};
    const dem_index first = 0;
    const dem_boundary driven = SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_X,
                                      .n_nodes = 1, .nodes = &first, .value = {70.0});
    CLEANUP(boundary_conditions_free) boundary_conditions b;
    CLEANUP(free_model) dem_model *model = make_point(NULL, 0.0);
    dem_options options = point_options();
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_close(options.v_scale, sqrt(2.0 * 9.81 * 1.0), 1e-15);
    dem_model_destroy(model);
    model = make_point(v, 0.0);
    options = point_options();
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_close(options.v_scale, 50.0, 1e-14);
    dem_model_destroy(model);
    model = make_rubber(0.0, 0.0);
    options = dem_options_default();
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_close(options.v_scale, 1e-3 * 0.5 * dem_model_omega_max(model) * dem_model_spacing(model), 1e-15);
    options = dem_options_default();
    assert_ok(boundary_conditions_compile(&b, &driven, 1, dem_model_lattice(model), NULL, 0));
    assert_ok(options_fill(&options, model, &b));
    assert_close(options.v_scale, 70.0, 0.0);
}

/* omega_max is that of the rectangle; an obstacle that wants ten times as many steps gets them. */
TEST(steps_follow_obstacles_that_oscillate_or_turn)
{
    char message[200];
    CLEANUP(free_model) dem_model *model = make_rubber(0.0, 4.0);
    const double rate = 10.0 * dem_model_omega_max(model);
    dem_options options = dem_options_default();
    model->obstacles.bounds.step_rate = rate;
    assert_ok(options_fill(&options, model, &no_boundaries));
    assert_close(options.max_step, 1.0 / rate, 0.0);
    options = dem_options_default();
    options.max_step = 1.0 / rate;
    assert_ok(options_fill(&options, model, &no_boundaries));
    options.max_step = 1.5 / rate;
    (void)snprintf(message, sizeof message,
                   "obstacles * oscillate or turn * at most %g s * max_step and fixed_step * got %g s", 1.0 / rate,
                   options.max_step);
    refuse_filling(model, options, message);
}
