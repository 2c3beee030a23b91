/* SPDX-License-Identifier: BSD-3-Clause */
/* doubts.c: bodies and speeds on both sides of the bounds. */
#include "doubts.h"

#include <stdlib.h>
#include <string.h>

#include "harness/message.h"
#include "unit/deck_text.h"
#include "verification/support.h"

static char text[4096];

static void read_log(run_log *log)
{
    rewind(log->out);
    text[fread(text, 1, sizeof text - 1, log->out)] = '\0';
    assert_int_equal(fclose(log->out), 0);
}

/* What is doubted of the lattices of a deck stands in `text` then.
 * \return how many warnings there are */
static size_t doubt_lattices(const deck *d)
{
    run_log log = {.out = tmpfile()};
    assert_non_null(log.out);
    doubts_of_lattices(&log, d);
    read_log(&log);
    return log.n_warnings;
}

TEST(a_light_body_is_doubted)
{
    body_facts bodies[4] = {{.mass = 0.971, .true_mass = 1.0},
                            {.mass = 0.9, .true_mass = 1.0},
                            {.mass = 0.1}, /* of a lattice file: nothing is known */
                            {.mass = 1.1, .true_mass = 1.0}};
    const deck d = {.bodies = bodies, .n_bodies = 4};
    assert_int_equal(doubt_lattices(&d), 1);
    assert_string_equal(text,
                        "warning    body 2 has 10.0 % less mass than its true shape: its stiffness is off, and "
                        "stresses at its edges do not converge; take a finer 'spacing' in &body, or a mesh (shape "
                        "= 'mesh')\n");
}

#define RING(outline, y)                                                                                               \
    "&body shape = 'ring', radius = 0.02, inner_radius = 0.01, spacing = 2e-3, outline = '" outline                    \
    "', position = 0, " y " /\n"

/* Rings with walls of five spacings, of which those with stepped edges are too light, too. */
TEST(a_smooth_outline_is_proposed_to_those_bodies_that_have_none)
{
    static const char rings[] = "&run t_end = 1 /\n&obstacle points = -9, -9, 9, -9 /\n"
                                "&material youngs_modulus = 1e7, density = 1000 /\n" RING("smooth", "0")
                                    RING("lattice", "0.1") RING("smooth", "0.2");
    CLEANUP(deck_free) deck d = deck_text_good(rings);
    assert_int_equal(doubt_lattices(&d), 3);
    assert_line_parts(text,
                      "warning * body 1 has a wall of 0.01 m, only 5 spacings: * take a finer 'spacing' in &body, or a "
                      "mesh\n"
                      "warning * body 2 has * less mass than its true shape and has a wall of 0.01 m, only 5 spacings: "
                      "* take a finer 'spacing' in &body, outline = 'smooth', or a mesh\n"
                      "warning * body 3 has a wall of 0.01 m, only 5 spacings: * take a finer 'spacing' in &body, or a "
                      "mesh\n");
}

/* A deck of a disc with these keys, on two floors, of which the second one has these. */
static size_t count_rigid_doubts(const char *body, const char *floor)
{
    char keys[512];
    run_log log = {.out = tmpfile()};
    assert_non_null(log.out);
    (void)snprintf(keys, sizeof keys,
                   "&run t_end = 1 /\n&material youngs_modulus = 1e7, density = 1000 /\n&solver max_step = 1e-3 /\n"
                   "&obstacle points = -9, -9, 9, -9 /\n&obstacle points = -9, -8, 9, -8%s /\n"
                   "&body shape = 'disc', radius = 0.02, spacing = 4e-3, position = 0, 0%s /\n",
                   floor, body);
    CLEANUP(deck_free) deck d = deck_text_good(keys);
    doubts_of_rigid(&log, &d);
    read_log(&log);
    return log.n_warnings;
}

TEST(laws_of_obstacles_that_do_not_act_on_rigid_bodies_are_doubted)
{
    const char *rigid = ", rigid = .true.";
    assert_int_equal(count_rigid_doubts(rigid, ", friction = 0.3"), 0);
    assert_int_equal(count_rigid_doubts("", ", friction = 0.3, restitution = 0.5, friction_law = 'paper'"), 0);
    assert_int_equal(count_rigid_doubts(rigid, ", friction = 0.3, restitution = 0.5"), 1);
    assert_string_equal(text, "warning    the restitution of obstacle 2 does not act on rigid bodies\n");
    assert_int_equal(count_rigid_doubts(rigid, ", friction = 0.3, friction_law = 'paper'"), 1);
    assert_string_equal(text, "warning    the friction_law of obstacle 2 does not act on rigid bodies\n");
}

/* A body of one node at 2 m/s along x, on floors at rest and moving. */
static size_t count_doubts(double wave_speed, double floor_speed, dem_index n_floors)
{
    static const double points[4] = {-9.0, -9.0, 9.0, -9.0};
    const double x[2] = {0.0, 0.0}, v[2] = {2.0, 0.0}, mass = 3.0;
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = points, .velocity = {floor_speed, 0.0});
    const lattice_body body = {.motion = {.mass = mass, .momentum = {mass * v[0], mass * v[1]}}};
    run_log log = {.out = tmpfile()};
    assert_non_null(log.out);
    dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    dem_model *model = support_model(&lattice, &floor, n_floors);
    dem_lattice_free(&lattice);
    doubts_of_speed(&log, model, &body, 0, wave_speed);
    dem_model_destroy(model);
    read_log(&log);
    return log.n_warnings;
}

TEST(a_speed_near_that_of_waves_is_doubted)
{
    assert_int_equal(count_doubts(20.1, 0.0, 1), 0);
    assert_int_equal(count_doubts(16.0, 0.0, 1), 1);
    assert_string_equal(text, "warning    body 1 moves at 2 m/s, 0.125 of its wave speed of 16 m/s (strains of that "
                              "size): is E in Pa (210e9, not 210e3)?\n");
    assert_int_equal(count_doubts(0.1, 0.0, 1), 1);
    assert_non_null(strstr(text, "moves at 2 m/s, 20 times its wave speed of 0.1 m/s (strains"));
}

TEST(a_speed_is_that_against_an_obstacle)
{
    assert_int_equal(count_doubts(16.0, 2.0, 1), 0);
    assert_int_equal(count_doubts(30.0, -2.0, 1), 1);
    assert_int_equal(count_doubts(1.0, 0.0, 0), 0); /* there is nothing to hit */
}

/* A rectangle that may break, or has no strength. */
static size_t count_pieces(bool breaks, dem_bodies bodies)
{
    const dem_material solid =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1000.0, .thickness = 1.0);
    const deck d = {.facts = {.may_break = breaks}};
    dem_options options = dem_options_default();
    run_log log = {.out = tmpfile()};
    support_run run;
    assert_non_null(log.out);
    options.bodies = bodies;
    CLEANUP(dem_lattice_free) dem_lattice body = support_rectangle(4.0, 4.0, 1.0, &solid);
    if (breaks) body.strength = malloc((size_t)body.n_triangles * sizeof *body.strength);
    assert_true((body.strength != NULL) == breaks);
    for (dem_index t = 0; breaks && t < body.n_triangles; t++) body.strength[t] = 1e6;
    support_open(&run, &body, NULL, 0, &options);
    doubts_of_pieces(&log, &d, run.simulation);
    support_close(&run);
    read_log(&log);
    return log.n_warnings;
}

TEST(pieces_that_touch_other_bodies_only_are_doubted)
{
    assert_int_equal(count_pieces(false, DEM_BODIES_OTHERS), 0);
    assert_int_equal(count_pieces(true, DEM_BODIES_ALL), 0);
    assert_int_equal(count_pieces(true, DEM_BODIES_NONE), 0);
    assert_int_equal(count_pieces(true, DEM_BODIES_OTHERS), 1);
    assert_string_equal(text, "warning    pieces of one body pass through each other with bodies = 'others', as do the "
                              "faces of a crack; bodies = 'all' in &contact lets them touch\n");
}

typedef void doubts_of_run(run_log *log, const dem_simulation *simulation);

/* Of two rectangles, of which the second one is moved by (x, 0.3), and both by a speed. */
static size_t count_doubts_of(doubts_of_run *find, dem_bodies bodies, double x, double speed)
{
    const dem_material solid =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1000.0, .thickness = 1.0);
    dem_options options = dem_options_default();
    run_log log = {.out = tmpfile()};
    support_run run;
    assert_non_null(log.out);
    options.v_scale = 1.0;
    options.bodies = bodies;
    CLEANUP(dem_lattice_free) dem_lattice both = support_rectangle(4.0, 4.0, 1.0, &solid);
    CLEANUP(dem_lattice_free) dem_lattice second = support_rectangle(4.0, 4.0, 1.0, &solid);
    for (dem_index i = 0; i < second.n_nodes; i++) { /* not along a row: nodes on edges are not inside */
        second.x[2 * i] += x;
        second.x[2 * i + 1] += 0.3;
    }
    assert_ok(dem_lattice_append(&both, &second));
    assert_ok(dem_lattice_launch(&both, (const double[2]){speed, 0.0}));
    support_open(&run, &both, NULL, 0, &options);
    find(&log, run.simulation);
    support_close(&run);
    read_log(&log);
    return log.n_warnings;
}

TEST(bodies_that_overlap_at_the_start_are_doubted)
{
    assert_int_equal(count_doubts_of(doubts_of_overlap, DEM_BODIES_NONE, 9.0, 0.0), 0);
    assert_int_equal(count_doubts_of(doubts_of_overlap, DEM_BODIES_NONE, 2.2, 0.0), 1);
    assert_non_null(strstr(text, "warning    bodies overlap at t = 0, which nothing undoes: node "));
    assert_non_null(strstr(text, " m; move a body by 'position' in &body\n"));
}

/* The contact thickness is a fifth of a spacing; with 3.9 the gap is a third of it. */
TEST(bodies_that_are_pressed_together_at_the_start_are_doubted)
{
    assert_int_equal(count_doubts_of(doubts_of_pressing, DEM_BODIES_OTHERS, 4.3, 0.0), 0);
    assert_int_equal(count_doubts_of(doubts_of_pressing, DEM_BODIES_OTHERS, 3.9, 1e4), 0);
    assert_int_equal(count_doubts_of(doubts_of_pressing, DEM_BODIES_OTHERS, 3.9, 0.0), 1);
    assert_non_null(strstr(text, "warning    surfaces are pressed together at t = 0 with "));
    assert_non_null(strstr(text, " J, and bodies move with 0 J: they start nearer than the contact thickness; "));
}

TEST_GROUP(scratch_make, scratch_remove);
