/* SPDX-License-Identifier: BSD-3-Clause */
/* estimate.c: what a deck says of its run before anything is built, beside what the run then is. */
#include "unit/close.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "estimate.h"
#include "unit/scratch.h"

#define HEAD  "&run t_end = 0.1 /\n&output frame_interval = 0.01 /\n"
#define SOLID HEAD "&material youngs_modulus = 1e7, density = 1000 /\n"

static const char *path, *image;

static deck parse(const char *text)
{
    namelist_errors errors = {0};
    deck d;
    file_put(path, text, strlen(text));
    const deck_status status = deck_parse(&d, path, NULL, 0, &errors);
    if (status != DECK_OK) fail_msg("%s", errors.n > 0 ? errors.list[0].text : "no message");
    return d;
}

static estimate of(const char *text)
{
    estimate e;
    CLEANUP(deck_free) deck d = parse(text);
    assert_true(estimate_deck(&e, &d));
    return e;
}

/* What the deck tells, and what then comes of it. */
static void measure(const char *text, estimate *before, estimate *found)
{
    namelist_errors errors = {0};
    CLEANUP(free_model) dem_model *model;
    CLEANUP(free_simulation) dem_simulation *simulation;
    CLEANUP(deck_free) deck d = parse(text);
    assert_true(estimate_deck(before, &d));
    if (deck_build(&d, &errors) != DECK_OK) fail_msg("%s", errors.list[0].text);
    assert_int_equal(dem_model_create(&model, &d.lattice, NULL, 0), DEM_OK);
    d.options.v_scale = 1.0;
    assert_int_equal(dem_simulation_create(&simulation, model, &d.options), DEM_OK);
    *found = estimate_run(&d, simulation, estimate_duration(&d));
}

/* ---- nodes ---- */

/* By a share of the nodes, which are few. */
static void expect_nodes(const char *text, double tolerance)
{
    estimate before, found;
    measure(text, &before, &found);
    assert_close(before.nodes, found.nodes, tolerance * found.nodes);
    assert_close(before.springs, found.springs, 2.0 * tolerance * found.springs);
    assert_close(before.frames, found.frames, 0.0);
    assert_true(before.cover >= found.nodes);
}

#define BODY "spacing = 0.01 /\n"

TEST(nodes_of_every_shape_are_known_from_its_area)
{
    expect_nodes(SOLID "&body shape = 'rectangle', size = 1, 0.5, " BODY, 0.04);
    expect_nodes(SOLID "&body shape = 'rectangle', size = 1, 0.5, lattice = 'square', " BODY, 0.04);
    expect_nodes(SOLID "&body shape = 'disc', radius = 0.5, " BODY, 0.04);
    expect_nodes(SOLID "&body shape = 'ring', radius = 0.5, inner_radius = 0.2, " BODY, 0.04);
    expect_nodes(SOLID "&body shape = 'polygon', points = 0,0, 1,0, 0.5,0.8, " BODY, 0.08);
}

/* A smooth outline keeps what is half beyond an edge. */
TEST(voids_and_pores_take_nodes)
{
    expect_nodes(SOLID "&void body = 1, centre = 0,0.25, radius = 0.2 /\n"
                       "&body shape = 'rectangle', size = 1, 0.5, " BODY,
                 0.05);
    expect_nodes(SOLID "&pores porosity = 0.1, radius = 0.02, 0.02 /\n"
                       "&body shape = 'rectangle', size = 1, 0.5, " BODY,
                 0.08);
    expect_nodes(SOLID "&pores number = 20, radius = 0.02, 0.02 /\n"
                       "&body shape = 'rectangle', size = 1, 0.5, " BODY,
                 0.08);
}

TEST(bodies_add_up_and_the_one_of_most_nodes_is_reported)
{
    const estimate e = of(SOLID "&body shape = 'disc', radius = 1, spacing = 0.1 /\n"
                                "&body shape = 'rectangle', size = 30, 40, spacing = 0.1, lattice = 'square' /\n");
    assert_int_equal(e.largest, 1);
    assert_close(e.cover, 301.0 * 401.0, 1e-6);
    assert_close(e.nodes, 120000.0 + 314.159265 / 0.866025, 0.01);
}

/* Only its size is known of a mask before it is read, and only its bytes of a mesh. */
TEST(files_are_recognized_by_their_first_bytes_and_their_size)
{
    char text[512];
    file_put(image, "P2 # 30 by 20\n30 20 255\n", 24);
    (void)snprintf(text, sizeof text, SOLID "&body shape = 'mask', file = '%s', scale = 1, spacing = 0.5 /\n", image);
    estimate e = of(text);
    assert_close(e.cover, 61.0 * (20.0 / (0.5 * sqrt(0.75)) + 1.0), 1e-6);
    assert_close(e.nodes, 0.0, 0.0);
    assert_close(e.memory, 64.0 * e.cover, 1e-6);
    (void)snprintf(text, sizeof text, SOLID "&body shape = 'mesh', file = '%s', scale = 1 /\n", image);
    e = of(text);
    assert_close(e.memory, 24.0, 0.0);
    assert_true(isinf(e.step));
    assert_close(e.steps, 0.0, 0.0);
    assert_int_equal(unlink(image), 0);
    e = of(text);
    assert_close(e.memory, 0.0, 0.0);
}

/* ---- memory, whatever the numbers are ---- */

TEST(memory_grows_with_nodes_and_method_and_is_no_more_than_measured)
{
    const estimate pairs = of(SOLID "&body shape = 'rectangle', size = 10, 10, lattice = 'square', " BODY);
    const estimate verlet = of(SOLID "&solver method = 'verlet' /\n"
                                     "&body shape = 'rectangle', size = 10, 10, lattice = 'square', " BODY);
    assert_close(pairs.memory, 0.6e9, 1.0); /* docs/performance.md: 0.70e9 resident */
    assert_close(verlet.memory, 0.5e9, 1.0);
}

TEST(a_lattice_that_is_cut_is_there_before)
{
    const estimate e = of(SOLID "&void centre = 0,500, radius = 1e6 /\n"
                                "&body shape = 'rectangle', size = 1000, 1000, lattice = 'square', spacing = 1 /\n");
    assert_close(e.nodes, 0.0, 0.0);
    assert_close(e.memory, 64.0 * 1001.0 * 1001.0, 1.0);
}

TEST(products_that_overflow_are_large_and_finite)
{
    estimate e = of(SOLID "&body shape = 'rectangle', size = 1e9, 1e9, spacing = 1, lattice = 'square' /\n");
    assert_close(e.memory, 6e20, 1e10);
    e = of(SOLID "&body shape = 'rectangle', size = 1e300, 1e300, spacing = 1 /\n");
    assert_close(e.memory, 6e252, 1e240);
    assert_true(isfinite(e.output));
    e = of(SOLID "&body shape = 'disc', radius = 1e200, spacing = 1e-100 /\n");
    assert_close(e.memory, 6e252, 1e240);
}

/* Nothing is said of what cannot be computed with: that is refused when it is built. */
TEST(what_underflows_is_not_estimated)
{
    estimate e = of(SOLID "&body shape = 'rectangle', size = 1, 1, spacing = 1e-200 /\n");
    assert_close(e.memory, 0.0, 0.0);
    assert_close(e.steps, 0.0, 0.0);
    e = of(HEAD "&material youngs_modulus = 1e7, density = 1e-308 /\n&body shape = 'rectangle', size = 1, 1, " BODY);
    assert_close(e.steps, 0.0, 0.0);
}

/* ---- steps ---- */

/* No run makes fewer; where it is all of one kind hardly more. */
static void expect_steps(const char *text, double most)
{
    estimate before, found;
    measure(text, &before, &found);
    if (!(before.steps <= found.steps && found.steps <= most * before.steps))
        fail_msg("%g steps estimated, %g found: %s", before.steps, found.steps, text);
}

#define BLOCK  "&body shape = 'rectangle', size = 0.2, 0.1, spacing = 0.01"
#define JAGGED BLOCK ", outline = 'lattice'"

TEST(steps_are_bounded_by_stiffness_and_mass)
{
    static const struct {
        const char *keys;
        double most; /* of nu beyond 1/3 the area term adds to the springs, and is not counted */
    } materials[] = {{"youngs_modulus = 1e7, density = 1000", 1.3},
                     {"youngs_modulus = 1e7, density = 1000, poissons_ratio = -0.9", 1.3},
                     {"youngs_modulus = 1e7, density = 1000, poissons_ratio = 0.99, thickness = 2", 13.0},
                     {"youngs_modulus = 1e9, density = 2000, poissons_ratio = 0.1, plane = 'strain'", 1.3},
                     {"youngs_modulus = 1e9, density = 2000, poissons_ratio = 0.49, plane = 'strain'", 10.0},
                     {"bond_stiffness = 1e5, density = 1000, thickness = 0.01", 2.5}};
    static const char *const lattices[] = {", outline = 'lattice'", ", lattice = 'square'", ", jitter = 0.3, seed = 3",
                                           ", jitter = 0.3, lattice = 'square', seed = 5", ""};
    static const char *const methods[] = {"", "&solver method = 'rk4' /\n", "&solver method = 'verlet' /\n",
                                          "&solver max_step = 1e-6 /\n", "&solver fixed_step = 1e-6 /\n"};
    char text[1024];
    for (size_t m = 0; m < sizeof materials / sizeof *materials; m++)
        for (size_t l = 0; l < sizeof lattices / sizeof *lattices; l++)
            for (size_t s = 0; s < sizeof methods / sizeof *methods; s++) {
                if (m == 1 && l % 2 == 1) continue; /* squares would warp */
                (void)snprintf(text, sizeof text, HEAD "%s&material %s /\n" BLOCK "%s /\n", methods[s],
                               materials[m].keys, lattices[l]);
                expect_steps(text, (l < 2 ? 1.0 : 2.2) * materials[m].most); /* one squeezed triangle decides */
            }
}

TEST(steps_are_bounded_where_shapes_are_cut_and_materials_mixed)
{
    expect_steps(SOLID BLOCK " /\n&void centre = 0,0.05, radius = 0.02 /\n&crack points = 0,0.06, 0,0.2 /\n", 3.0);
    expect_steps(SOLID JAGGED " /\n&void centre = 0,0.05, radius = 0.02 /\n&crack points = 0,0.06, 0,0.2 /\n", 1.6);
    expect_steps(SOLID BLOCK ", lattice = 'square', diagonal = 0.2 /\n&void centre = 0,0.05, radius = 0.02 /\n", 1.6);
    expect_steps(SOLID "&material name = 'soft', youngs_modulus = 1e6, density = 4000 /\n" JAGGED
                       " /\n&inclusion material = 'soft', centre = 0,0.05, radius = 0.03 /\n",
                 11.0);
    expect_steps(SOLID "&material name = 'soft', youngs_modulus = 1e6, density = 4000 /\n" JAGGED
                       " /\n&inclusion material = 'soft', centre = 0,0.05, radius = 1 /\n",
                 1.3); /* all of it */
    expect_steps(SOLID "&material name = 'hard', youngs_modulus = 1e9, density = 4000 /\n" JAGGED
                       " /\n&body shape = 'disc', radius = 0.1, spacing = 0.02, position = 1, 0, material = 'hard',\n"
                       "outline = 'lattice' /\n",
                 1.6);
}

/* ---- output ---- */

/* 11 frames of x, displacement, velocity, 6 stresses and von Mises in f32, of strain, force and `broken`; a history of
 * 35 numbers, 5 for the body, 9 for the obstacle and 4 for the boundary. */
TEST(output_is_frames_and_tables)
{
    const estimate e = of(SOLID "&solver max_step = 1e-3 /\n"
                                "&obstacle points = -9, -9, 9, -9 /\n&boundary where = 'side', side = 'top' /\n"
                                "&body shape = 'rectangle', size = 1, 1, lattice = 'square', " BODY);
    assert_close(e.steps, 100.0, 1e-9);
    assert_close(e.frames, 11.0, 0.0);
    assert_close(e.output, 11.0 * (10000.0 * (24.0 + 4.0 * 13.0) + 40000.0 * (1.0 + 8.0)) + 8.0 * 1024.0 * 53.0, 1.0);
}

/* Large bodies have a row of every eighth step by Fehlberg's pair, but where they may break of each: of 10,000 steps 2
 * and 10 chunks of 1024 rows of 35 numbers, and 5 for the body. */
TEST(what_may_break_has_all_rows)
{
    static const char *const fracture[] = {"", ", fracture = 'stretch', critical_stretch = 0.1"};
    double output[2];
    for (int k = 0; k < 2; k++) {
        char text[512];
        (void)snprintf(text, sizeof text,
                       HEAD "&material youngs_modulus = 1e7, density = 1000%s /\n&solver max_step = 1e-5 /\n"
                            "&body shape = 'rectangle', size = 1, 1, lattice = 'square', " BODY,
                       fracture[k]);
        const estimate e = of(text);
        assert_close(e.steps, 1e4, 1e-9);
        output[k] = e.output;
    }
    assert_close(output[1] - output[0], 8.0 * 8.0 * 1024.0 * 40.0, 1.0);
}

/* What lasts until it is at rest lasts at least until its loads have grown; t_end is only its limit. */
TEST(a_run_that_ends_at_rest_is_counted_by_its_ramps)
{
    const estimate e = of("&run t_end = 100, residual = 1e-3 /\n&output frame_interval = 0.01 /\n"
                          "&material youngs_modulus = 1e7, density = 1000 /\n&solver max_step = 1e-3 /\n"
                          "&boundary where = 'side', side = 'top' /\n"
                          "&boundary where = 'side', side = 'bottom', kind = 'force', force = 1, 0, ramp = 0.2 /\n"
                          "&body shape = 'rectangle', size = 1, 1, lattice = 'square', " BODY);
    assert_close(e.steps, 200.0, 1e-9);
    assert_close(e.frames, 21.0, 0.0);
}

/* By the rule of damping: with tau omega_max = 100 the step is tau omega_max times as short, about. */
TEST(a_step_that_damping_has_shortened_is_known)
{
    static const char body[] = "&body shape = 'rectangle', size = 1, 1, spacing = 0.1 /\n";
    char text[600];
    estimate before, without, with, given;
    (void)snprintf(text, sizeof text, SOLID "%s", body);
    measure(text, &before, &without);
    assert_close(without.undamped, 0.0, 0.0);
    (void)snprintf(text, sizeof text, HEAD "&material youngs_modulus = 1e7, density = 1000, damping_time = %g /\n%s",
                   200.0 * without.step, body);
    measure(text, &before, &with);
    assert_close(with.undamped, without.step, 1e-12 * without.step);
    assert_true(with.step < 0.1 * without.step);
    (void)snprintf(text + strlen(text), sizeof text - strlen(text), "&solver max_step = %g /\n", with.step);
    measure(text, &before, &given);
    assert_close(given.undamped, 0.0, 0.0); /* it is the deck's */
}

/* ---- what is refused ---- */

#define TWO                                                                                                            \
    "&run t_end = 1 /\n&material youngs_modulus = 1, density = 1 /\n"                                                  \
    "&body shape = 'rectangle', size = 1, 1, spacing = 1 /\n"                                                          \
    "&body shape = 'rectangle', size = 1, 1,\n spacing = 1 /\n&output\n frame_interval = 0.1 /\n"

static const estimate needed = {
    .nodes = 5e6, .largest = 1, .memory = 6e9, .step = 1e-6, .steps = 1e6, .frames = 11.0, .output = 3e9};

static void expect_message(limits most, estimate_breach expected, const char *message)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    char all[1024] = "";
    size_t n = 0;
    CLEANUP(deck_free) deck d = parse(TWO);
    assert_int_equal(estimate_check(&needed, &most, &d, &errors), expected);
    for (size_t k = 0; k < errors.n; k++)
        n += (size_t)snprintf(all + n, sizeof all - n, "%d:%d %s\n", errors.list[k].place.line,
                              errors.list[k].place.column, errors.list[k].text);
    assert_string_equal(all, message);
}

TEST(damping_that_makes_a_run_long_is_named)
{
    const estimate damped = {.step = 1e-9, .steps = 1e9, .undamped = 1e-6};
    const limits most = {INFINITY, 1e8, INFINITY};
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    CLEANUP(deck_free) deck d = parse(TWO);
    assert_int_equal(estimate_check(&damped, &most, &d, &errors), ESTIMATE_STEPS);
    assert_string_equal(errors.list[0].text,
                        "'t_end' in &run, 1 s, takes at least 1e+09 steps of 1e-09 s; the limit is 1e+08, and "
                        "--max-steps sets it; 'damping_time' or 'mass_damping' has shortened the steps from 1e-06 s");
}

TEST(what_keeps_within_its_limits_gets_no_message)
{
    expect_message((limits){6e9, 1e6, 6e9}, ESTIMATE_KEPT, "");
    expect_message((limits){INFINITY, INFINITY, INFINITY}, ESTIMATE_KEPT, "");
}

TEST(what_exceeds_one_gets_a_message_with_limit_place_and_option)
{
    expect_message(
        (limits){5e9, 1e6, 6e9}, ESTIMATE_MEMORY,
        "5:2 the run takes at least 6 GB of memory for its 5e+06 nodes; the limit is 5 GB, and --max-memory sets "
        "it\n");
    expect_message(
        (limits){6e9, 5e5, 6e9}, ESTIMATE_STEPS,
        "1:6 't_end' in &run, 1 s, takes at least 1e+06 steps of 1e-06 s; the limit is 5e+05, and --max-steps sets "
        "it\n");
    expect_message(
        (limits){6e9, 1e6, 5.9e9}, ESTIMATE_DISK,
        "7:2 the output takes about 3 GB, 11 frames and 1e+06 steps until 't_end', twice while it is put together; "
        "the limit is 5.9 GB, and --max-disk sets it\n");
}

SCRATCH_GROUP({&path, "a.nml"}, {&image, "a.pgm"});
