/* SPDX-License-Identifier: BSD-3-Clause */
/* surface_report.c: what the log says of two squares that run into each other. */
#include "surface_report.h"

#include <string.h>

#include "ask.h"
#include "harness/message.h"
#include "verification/support.h"

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
static char text[4096];

static void read_log(FILE *file)
{
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    assert_int_equal(fclose(file), 0);
}

/* Two squares of 30 mm with a spacing of 5 mm, 2 mm apart; the second one comes to the first. */
static void open_with(support_run *run, dem_bodies bodies, double stiffness, double speed)
{
    CLEANUP(dem_lattice_free)
    dem_lattice l = support_squares(0.03, 5e-3, &rubber, (const double[2]){0.032, 0.0});
    dem_options options = dem_options_default();
    options.bodies = bodies;
    options.contact_stiffness = stiffness;
    assert_ok(dem_lattice_launch(&l, (const double[2]){0.0, 0.0}));
    for (dem_index i = l.n_nodes / 2; i < l.n_nodes; i++) l.velocity[2 * i] = -speed;
    support_open(run, &l, NULL, 0, &options);
}

static void open_squares(support_run *run, dem_bodies bodies)
{
    open_with(run, bodies, 1.0, 10.0);
}

static void open_soft_squares(support_run *run)
{
    open_with(run, DEM_BODIES_OTHERS, 0.01, 20.0);
}

static void report(dem_bodies bodies, double t_end)
{
    CLEANUP(support_close) support_run run;
    surface_report p = {0};
    FILE *log = tmpfile();
    assert_non_null(log);
    open_squares(&run, bodies);
    surface_report_print(log, run.simulation);
    for (int k = 0; k <= 100; k++) {
        (void)support_at(&run, t_end * k / 100.0);
        assert_false(surface_report_follow(&p, run.simulation, t_end * k / 100.0));
    }
    surface_report_print_nearest(log, &p);
    read_log(log);
}

TEST(the_log_says_when_surfaces_have_met_and_how_near_they_came)
{
    report(DEM_BODIES_ALL, 5e-4);
    assert_line_parts(
        text,
        "surfaces * all push each other off * edges, thickness 0.001 m, modulus 1e+07 N/m; 0 pairs push at the "
        "start\n"
        "surfaces * first push at * s; nearest * of the thickness at * s, pressure there * of the modulus, * pairs "
        "at most, energy up to * J\n");
}

TEST(the_log_says_which_friction_bodies_have)
{
    CLEANUP(dem_lattice_free)
    dem_lattice l = support_rectangle(0.03, 0.03, 5e-3, &rubber);
    const double frictions[2] = {0.0, 0.25};
    for (int k = 0; k < 2; k++) {
        CLEANUP(support_close) support_run run;
        dem_options options = dem_options_default();
        FILE *log = tmpfile();
        options.bodies = DEM_BODIES_ALL;
        options.contact_friction = frictions[k];
        support_open(&run, &l, NULL, 0, &options);
        surface_report_print(log, run.simulation);
        read_log(log);
        assert_true((strstr(text, "m, friction 0.25; 0 pairs") != NULL) == (k == 1));
    }
}

TEST(the_log_says_nothing_of_surfaces_that_do_not_meet)
{
    report(DEM_BODIES_OTHERS, 1e-5);
    assert_line_parts(text, "surfaces * those of different bodies push each other off * 0 pairs push at the start\n");
    report(DEM_BODIES_NONE, 1e-5);
    assert_string_equal(text, "");
}

/* Two of them that begin to push each other where they are: nearer than the thickness, but not much. */
TEST(what_pushes_from_the_start_is_counted)
{
    CLEANUP(support_close) support_run run;
    surface_report p = {0};
    FILE *log = tmpfile();
    open_squares(&run, DEM_BODIES_ALL);
    (void)support_at(&run, 1.2e-4); /* 1.2 mm nearer */
    assert_false(surface_report_follow(&p, run.simulation, 0.0));
    p.most = 1;
    surface_report_print_nearest(log, &p);
    read_log(log);
    assert_line_parts(
        text, "surfaces * first push at 0.0000e+00 s; nearest * of the thickness at 0.0000e+00 s, pressure there "
              "* of the modulus, 1 pair at most, energy\n");
}

/* Surfaces that push with a hundredth of the usual pressure are run into each other: the log warns once, of the node
 * that is nearest. */
TEST(surfaces_that_come_too_near_are_warned_of_once)
{
    CLEANUP(support_close) support_run run;
    surface_report p = {0};
    run_log log = {.out = tmpfile()};
    dem_index n_warnings = 0;
    open_soft_squares(&run);
    for (int k = 0; k <= 300; k++) {
        (void)support_at(&run, 1e-6 * k);
        if (!surface_report_follow(&p, run.simulation, 1e-6 * k)) continue;
        n_warnings++;
        const dem_surfaces s = ask_surfaces(run.simulation);
        const double *x = ask_state(run.simulation).x + 2 * p.warning.node;
        assert_true(s.gap_share < 0.05);
        assert_close(p.warning.share, s.gap_share, 0.0);
        assert_close(p.warning.t, 1e-6 * k, 0.0);
        /* place of the edge, from which the node is a twentieth of the thickness at most */
        assert_true(hypot(x[0] - p.warning.x[0], x[1] - p.warning.x[1]) < 0.05 * s.thickness_max);
        surface_report_warn(&p, &log);
    }
    assert_int_equal(n_warnings, 1);
    assert_true(p.nearest < p.warning.share && p.nearest > 0.0);
    assert_close(p.gap, p.nearest * ask_surfaces(run.simulation).thickness_max, 1e-9); /* all have one thickness */
    assert_close(p.gap_t, p.nearest_t, 0.0);
    assert_close(p.pressure, pow(1.0 - p.nearest, 2.0) / p.nearest, 1e-12 * p.pressure);
    assert_int_equal(log.n_warnings, 1);
    read_log(log.out);
    assert_line_parts(text, "warning * surfaces are only * of the contact thickness apart at node * of body * m, * s: "
                            "they are pressed together harder than a lattice bears\n");
}
