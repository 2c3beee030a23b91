/* SPDX-License-Identifier: BSD-3-Clause */
/* surface_report.c: what the log says of two squares that run into each other. */
#include "surface_report.h"

#include <string.h>

#include "ask.h"
#include "harness/message.h"
#include "verification/support.h"

static char text[4096];

static void read_log(FILE *file)
{
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    assert_int_equal(fclose(file), 0);
}

/* Two squares of 30 mm with a spacing of 5 mm, 2 mm apart; the second one comes with 10 m/s. */
static void open_squares(support_run *run, dem_bodies bodies)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
    CLEANUP(dem_lattice_free) dem_lattice left = support_rectangle(0.03, 0.03, 5e-3, &rubber);
    CLEANUP(dem_lattice_free) dem_lattice right = support_rectangle(0.03, 0.03, 5e-3, &rubber);
    dem_options options = dem_options_default();
    options.bodies = bodies;
    dem_lattice_move(&right, 0.0, (const double[2]){0.032, 0.0});
    assert_ok(dem_lattice_launch(&right, (const double[2]){-10.0, 0.0}));
    assert_ok(dem_lattice_append(&left, &right));
    support_open(run, &left, NULL, 0, &options);
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
        surface_report_follow(&p, run.simulation, t_end * k / 100.0);
    }
    surface_report_print_nearest(log, &p);
    read_log(log);
}

TEST(the_log_says_when_surfaces_have_met_and_how_near_they_came)
{
    report(DEM_BODIES_ALL, 5e-4);
    assert_line_parts(
        text, "surfaces * all push each other off * edges, thickness 0.001 m; 0 pairs push at the start\n"
              "surfaces * first push at * s; nearest * of the thickness at * pairs at most, energy up to * J\n");
}

TEST(the_log_says_nothing_of_surfaces_that_do_not_meet)
{
    report(DEM_BODIES_OTHERS, 1e-5);
    assert_line_parts(text, "surfaces * those of different bodies push each other off * 0 pairs push at the start\n");
    report(DEM_BODIES_NONE, 1e-5);
    assert_string_equal(text, "");
}
