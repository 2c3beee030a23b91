/* SPDX-License-Identifier: BSD-3-Clause */
/* looks.c: how often runs of few nodes and of many are looked at, by the decks of both. */
#include "unit/close.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "looks.h"
#include "unit/scratch.h"

static const char *path;

/* What is settled for a plate of 0.2 x 0.2 m. */
typedef struct settled {
    double interval, omega; /* s, 1/s */
    dem_index every;
} settled;

static settled settle(const char *spacing, const char *groups)
{
    char text[512];
    namelist_errors errors = {0};
    CLEANUP(free_model) dem_model *model;
    CLEANUP(free_simulation) dem_simulation *simulation;
    CLEANUP(deck_free) deck d;
    (void)snprintf(text, sizeof text,
                   "&run t_end = 1 /\n&body shape = 'rectangle', size = 0.2, 0.2, spacing = %s /\n%s%s", spacing,
                   strstr(groups, "&material") == NULL ? "&material youngs_modulus = 1e7, density = 1000 /\n" : "",
                   groups);
    file_put(path, text, strlen(text));
    if (deck_parse(&d, path, NULL, 0, &errors) != DECK_OK) fail_msg("%s", errors.list[0].text);
    if (deck_build(&d, &errors) != DECK_OK) fail_msg("%s", errors.list[0].text);
    assert_int_equal(dem_model_create(&model, &d.lattice, NULL, 0), DEM_OK);
    assert_int_equal(dem_simulation_create(&simulation, model, &d.options), DEM_OK);
    looks_settle(&d, simulation);
    return (settled){d.history_interval, dem_model_omega_max(model), d.peak_every};
}

#define FEW  "2.2e-2" /* some hundred nodes */
#define MANY "2.9e-3" /* 5,500 */

TEST(few_nodes_have_a_row_each_step)
{
    const settled of = settle(FEW, ""), verlet = settle(FEW, "&solver method = 'verlet' /\n");
    assert_close(of.interval, 0.0, 0.0);
    assert_close(verlet.interval, 0.0, 0.0);
    assert_int_equal(of.every, 4);
    assert_int_equal(verlet.every, 4);
}

/* Steps are 0.5/omega_max long of pairs, 0.25/omega_max of Verlet's method. */
TEST(rows_of_many_are_as_many_evaluations_apart_by_all_methods)
{
    const settled pair = settle(MANY, ""), verlet = settle(MANY, "&solver method = 'verlet' /\n");
    assert_close(pair.interval, 8.0 * 0.5 / pair.omega, 1e-12 * pair.interval);
    assert_close(verlet.interval, 64.0 * 0.25 / verlet.omega, 1e-12 * verlet.interval);
    assert_int_equal(pair.every, 32);
    assert_int_equal(verlet.every, 256);
}

TEST(what_the_deck_says_holds)
{
    const settled all = settle(MANY, "&output history_interval = 0, peak_every = 4 /\n");
    const settled other = settle(MANY, "&output history_interval = 0.25, peak_every = 0 /\n");
    const settled one = settle(MANY, "&output history_interval = 0 /\n");
    assert_close(all.interval, 0.0, 0.0);
    assert_int_equal(all.every, 4);
    assert_close(other.interval, 0.25, 0.0);
    assert_int_equal(other.every, 0);
    assert_close(one.interval, 0.0, 0.0);
    assert_int_equal(one.every, 32);
}

/* The error test takes shorter steps than such a `max_step`. */
TEST(a_longest_step_beyond_what_is_stable_leaves_no_gaps)
{
    const settled of = settle(MANY, "&solver max_step = 1 /\n");
    assert_close(of.interval, 8.0 * 2.0 / of.omega, 1e-12 * of.interval);
}

TEST(what_may_break_has_all_rows)
{
    const settled of = settle(MANY, "&material youngs_modulus = 1e7, density = 1000, fracture = 'stress',\n"
                                    "strength = 1e6 /\n");
    assert_close(of.interval, 0.0, 0.0);
    assert_int_equal(of.every, 4);
}

/* From the first size on that has it. */
TEST(the_rule_goes_by_nodes_method_and_step)
{
    assert_close(looks_row_interval(DEM_METHOD_VERLET, 4999.0, 1e-6), 0.0, 0.0);
    assert_close(looks_row_interval(DEM_METHOD_VERLET, 5000.0, 1e-6), 64e-6, 1e-18);
    assert_close(looks_row_interval(DEM_METHOD_VERLET, 1e7, 1e-6), 64e-6, 1e-18);
    assert_close(looks_row_interval(DEM_METHOD_RK4, 5000.0, 1e-6), 16e-6, 1e-18);
    assert_close(looks_row_interval(DEM_METHOD_FEHLBERG45, 5000.0, INFINITY), 0.0, 0.0);
    assert_int_equal(looks_peak_every(DEM_METHOD_RK4, 4999.0), 4);
    assert_int_equal(looks_peak_every(DEM_METHOD_RK4, 5000.0), 64);
}

SCRATCH_GROUP({&path, "a.nml"});
