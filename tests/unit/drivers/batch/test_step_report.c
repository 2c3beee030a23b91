/* SPDX-License-Identifier: BSD-3-Clause */
/* step_report.c: what it says of a pair of masses on a spring, whose highest frequency is known, and a thrown node. */
#include "step_report.h"

#include <stdlib.h>
#include <string.h>

#include "verification/support.h"

static const double omega = 10.0, length = 1.0;
static char text[4096];
static char why[STEP_REPORT_WHY];

/* Two masses of 2 kg: omega^2 = 2 k/m. */
static void open_pair(support_run *run, const dem_options *options)
{
    const double x[4] = {0.0, 0.0, length, 0.0}, m[2] = {2.0, 2.0};
    const dem_index ends[2] = {0, 1};
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = support_lattice(2, x, m, 1, ends, length, 0.5 * omega * omega * m[0] * length, NULL);
    support_open(run, &lattice, NULL, 0, options);
}

static FILE *open_log(void)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    return file;
}

static void read_log(FILE *file)
{
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    assert_int_equal(fclose(file), 0);
}

static void print_plan(const dem_options *options)
{
    support_run run;
    FILE *file = open_log();
    open_pair(&run, options);
    step_report_print(file, "t_end 7 s, at least", 140.0, 0.0, run.simulation);
    step_report_print_details(file, run.simulation);
    const bool is_long = step_report_is_long(run.simulation, why);
    assert_int_equal(is_long, why[0] != '\0');
    support_close(&run);
    read_log(file);
}

TEST(the_bound_is_that_of_the_method)
{
    dem_options options = dem_options_default();
    options.kernel = DEM_KERNEL_PORTABLE;
    print_plan(&options);
    assert_string_equal(
        text, "time       t_end 7 s, at least 140 steps of fehlberg45; largest step 0.05 s (safe up to 0.109 s)\n"
              "method     fehlberg45 of order 5, 6 evaluations a step, rtol 1e-06\n"
              "stability  omega_max h = 0.5; with fehlberg45 undamped oscillations grow at any step, here by "
              "up to 1.3e-05 in one\n"
              "kernel     portable, 1 thread\n"
              "formula 6  (|v_x| + |v_y|) h/spacing = 0.00025 at v_scale along x; it does not bound the step\n");
    options.method = DEM_METHOD_VERLET;
    options.v_scale = 3.0;
    options.threads = 2;
    options.thread_nodes = 1;
    print_plan(&options);
    assert_string_equal(
        text, "time       t_end 7 s, at least 140 steps of verlet; fixed step 0.025 s (safe up to 0.2 s)\n"
              "method     verlet of order 2, 1 evaluation a step, rtol 1e-06\n"
              "stability  omega_max h = 0.25; verlet is stable up to 2, h = 0.2 s\n"
              "kernel     portable, 2 threads\n"
              "formula 6  (|v_x| + |v_y|) h/spacing = 0.075 at v_scale along x; it does not bound the step\n");
}

/* A fixed step above the bound: reported whatever (6) says. */
TEST(a_step_beyond_the_bound_is_warned_of)
{
    dem_options options = dem_options_default();
    options.method = DEM_METHOD_VERLET;
    for (int above = 0; above < 2; above++) {
        options.fixed_step = above ? 0.2001 : 0.1999;
        print_plan(&options);
        assert_string_equal(
            why, above ? "the fixed step of 0.2 s is 1 times the 0.2 s up to which verlet is safe here; give "
                         "'fixed_step' in &solver at most that, or leave it out"
                       : "");
    }
}

/* At 2.7 the fastest is damped with Fehlberg's weights, but slower ones grow: at 2 as in the closed form of |R|,
 * R the exponential series to z^5/120 and z^6/2080. */
TEST(the_growth_is_that_of_the_worst_oscillation)
{
    dem_options options = dem_options_default();
    double largest = 0.0;
    for (double z = 0.0; z < 2.7; z += 1e-3) {
        const double z2 = z * z, re = 1.0 - z2 / 2.0 + z2 * z2 / 24.0 - z2 * z2 * z2 / 2080.0;
        largest = fmax(largest, hypot(re, z * (1.0 - z2 / 6.0 + z2 * z2 / 120.0)) - 1.0);
    }
    assert_true(dem_method_growth(DEM_METHOD_FEHLBERG45, 2.7) < 1.0);
    options.fixed_step = 0.27;
    print_plan(&options);
    const char *found = strstr(text, "here by up to ");
    assert_non_null(found);
    assert_close(strtod(found + strlen("here by up to "), NULL), largest, 0.06 * largest); /* two digits */
    assert_non_null(
        strstr(why, "the fixed step of 0.27 s is 2.48 times the 0.109 s up to which fehlberg45 is safe here"));
}

TEST(without_springs_nothing_bounds_the_step)
{
    const double x[2] = {0.0, 1.0}, v[2] = {1.0, 0.0};
    support_run run;
    FILE *file = open_log();
    support_point(&run, 1.0, x, v, (const double[4]){-1.0, 0.0, 1.0, 0.0}, 2, 0.5);
    step_report_print(file, "t_end 1 s, at least", 100.0, 0.0, run.simulation);
    step_report_print_details(file, run.simulation);
    assert_false(step_report_is_long(run.simulation, why));
    support_close(&run);
    read_log(file);
    assert_null(strstr(text, "stability"));
    assert_null(strstr(text, "safe"));
    assert_non_null(strstr(text, "formula 6"));
}

static dem_status follow(void *context, const dem_simulation *simulation)
{
    dem_progress now = {.struct_size = sizeof now};
    dem_simulation_progress(simulation, &now);
    step_report_follow(context, simulation, &now);
    return DEM_OK;
}

/* Thrown up, so that the first step is the fastest. */
TEST(the_largest_value_of_6_is_that_of_the_fastest_step)
{
    const double x[2] = {0.0, 0.0}, v[2] = {-3.0, 4.0}, mass = 2.0, h = 0.01, g = 9.81;
    dem_options options = dem_options_default();
    support_run run;
    step_report p = {0};
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .step = follow, .context = &p};
    options.fixed_step = h, options.spacing = 0.5;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&lattice, NULL, v);
    support_open(&run, &lattice, NULL, 0, &options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    assert_ok(dem_simulation_advance(run.simulation, 0.5));
    assert_close(p.largest, (3.0 + 4.0 - g * h) * h / 0.5, 1e-14);
    assert_close(p.t, h, 1e-15);
    support_close(&run);
    FILE *file = open_log();
    step_report_print_largest(file, &p);
    read_log(file);
    assert_string_equal(text, "formula 6  (|v_x| + |v_y|) h/spacing was 0.138 at most, at 1.0000e-02 s\n");
}
