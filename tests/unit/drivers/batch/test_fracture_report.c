/* SPDX-License-Identifier: BSD-3-Clause */
/* fracture_report.c: a chain of six masses, 1 to 6 kg, broken behind the first and behind the third; a hexagon of
 * triangles about an obstacle; and a spring that is pulled until it breaks. */
#include "verification/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fracture_report.h"

enum { N = 6 };

static void open_chain(support_run *run)
{
    double x[2 * N], masses[N];
    dem_index ends[2 * (N - 1)];
    for (dem_index i = 0; i < N; i++) {
        x[2 * i] = (double)i;
        x[2 * i + 1] = 0.0;
        masses[i] = (double)(i + 1);
    }
    for (dem_index k = 0; k < 2 * (N - 1); k++) ends[k] = (k + 1) / 2;
    CLEANUP(dem_lattice_free) dem_lattice chain = support_lattice(N, x, masses, N - 1, ends, 1.0, 1.0, NULL);
    const dem_options options = dem_options_default();
    support_open(run, &chain, NULL, 0, &options);
}

/* What is printed, to be freed. */
static char *print(const fracture_report *r, const dem_simulation *simulation)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    fracture_report_print(out, r, simulation);
    assert_int_equal(fclose(out), 0);
    return text;
}

TEST(what_is_whole_has_no_lines)
{
    CLEANUP(support_close) support_run run;
    const fracture_report none = {0};
    open_chain(&run);
    char *text = print(&none, run.simulation);
    assert_string_equal(text, "");
    free(text);
}

/* Pieces of 1, 5 and 15 of 21 kg: half of that is reached with the last one. */
TEST(the_lines_have_the_first_break_and_the_fragments)
{
    const dem_index which[] = {0, 2};
    CLEANUP(support_close) support_run run;
    fracture_report report = {0};
    open_chain(&run);
    assert_ok(dem_simulation_break(run.simulation, NULL, 0, which, 2));
    fracture_report_note(&report, &(dem_break){.t = 0.25, .x = {0.5, 2.0}});
    fracture_report_note(&report, &(dem_break){.t = 0.75, .x = {2.5, 2.0}});
    assert_int_equal(report.breaks, 2);
    char *text = print(&report, run.simulation);
    assert_string_equal(text, "fracture   0 of 0 triangles and 2 of 5 springs are broken, which took 0 J for 0 m of "
                              "cracks; the first at 2.5000e-01 s, (0.5, 2) m\n"
                              "fragments  3; the largest has 0.714 of the mass, single nodes 0.0476; half is in those "
                              "up to 15 kg\n");
    free(text);
}

/* Of six triangles that are strained by 1 % one had 3/2 E A h (1 %)^2, 64.95 J, and takes 3.4 strength^2 a/E over the
 * half of its side and the thickness, 17 kJ. */
TEST(what_was_taken_is_a_share_of_the_fracture_energy)
{
    static const dem_material material = {.struct_size = sizeof material,
                                          .youngs_modulus = 1e6,
                                          .poissons_ratio = 1.0 / 3.0,
                                          .density = 1e3,
                                          .thickness = 1.0,
                                          .strength = 1e5};
    const dem_index first[1] = {0};
    const fracture_report report = {.breaks = 1};
    const dem_options options = dem_options_default();
    double x[14];
    CLEANUP(dem_lattice_free) dem_lattice hexagon = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&hexagon, 1.1, 1.0));
    assert_ok(dem_lattice_assemble(&hexagon, &material));
    assert_int_equal(hexagon.n_nodes, 7);
    for (int c = 0; c < 14; c++) x[c] = 1.01 * hexagon.x[c];
    support_start(&hexagon, x, NULL);
    CLEANUP(support_close) support_run run;
    support_open(&run, &hexagon, NULL, 0, &options);
    assert_ok(dem_simulation_break(run.simulation, first, 1, NULL, 0));
    char *text = print(&report, run.simulation);
    assert_non_null(strstr(text, ", which took 64.95 J for 0.5 m of cracks, 0.00382 of their fracture energy; the"));
    free(text);
}

/* A square around the middle node of six triangles, which comes to the surface with the first of them that breaks. */
TEST(a_node_that_was_buried_has_a_line)
{
    static const dem_material material = {
        .struct_size = sizeof material, .youngs_modulus = 1e6, .density = 1e3, .thickness = 1.0};
    static const double square[10] = {0.1, 0.0, 0.0, -0.1, -0.1, 0.0, 0.0, 0.1, 0.1, 0.0};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 5, .points = square);
    const dem_index first[1] = {0};
    const fracture_report report = {.breaks = 1};
    CLEANUP(dem_lattice_free) dem_lattice hexagon = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&hexagon, 1.1, 1.0));
    assert_ok(dem_lattice_assemble(&hexagon, &material));
    assert_int_equal(hexagon.n_triangles, 6);
    dem_options options = dem_options_default();
    options.vertices = false;
    options.gravity[1] = 0.0;
    CLEANUP(support_close) support_run run;
    support_open(&run, &hexagon, &obstacle, 1, &options);
    assert_ok(dem_simulation_break(run.simulation, first, 1, NULL, 0));
    (void)support_at(&run, 0.0);
    char *text = print(&report, run.simulation);
    assert_non_null(strstr(text, "\nburied     nodes inside obstacles when they came to the surface, which they touch "
                                 "only once they are out: 1; the first, node 3, at 0.0000e+00 s, (0, 0) m\n"));
    free(text);
}

/* ---- the load ---- */

static const double speed = 1e-3, limit = 0.01, step = 0.03, weight = 49.05; /* m/s, 1, s, N */

static dem_status follow(void *context, const dem_simulation *simulation)
{
    fracture_report_follow(context, simulation);
    return DEM_OK;
}

static dem_status note(void *context, const dem_simulation *simulation, const dem_break *what)
{
    (void)simulation;
    fracture_report_note(context, what);
    return DEM_OK;
}

/* A spring of 1 m and 1 N between a fixed node and one that is pulled along x, and beside them a third node of 5 kg,
 * which rests on a floor if there is one. */
static void open_spring(support_run *run, fracture_report *report, bool floor, dem_contact_method way)
{
    static const double x[] = {0.0, 1.0, 1.0, 1.0, 3.0, 0.0}, masses[] = {1.0, 1.0, 5.0};
    static const double line[] = {2.0, 0.0, 4.0, 0.0};
    static const dem_index ends[] = {0, 1}, pulled[] = {1};
    static const unsigned char fixed[] = {1, 0, 0};
    const dem_obstacle ground = {.struct_size = sizeof ground, .n_points = 2, .points = line};
    const dem_boundary pull = {.struct_size = sizeof pull,
                               .kind = DEM_BOUNDARY_VELOCITY,
                               .components = DEM_COMPONENT_X | DEM_COMPONENT_Y,
                               .n_nodes = 1,
                               .nodes = pulled,
                               .value = {speed, 0.0}};
    CLEANUP(dem_lattice_free) dem_lattice l = support_lattice(3, x, masses, 1, ends, 1.0, 1.0, fixed);
    dem_options options = dem_options_default();
    options.max_step = step;
    if (!floor) options.gravity[1] = 0.0;
    options.contact = way;
    options.n_boundaries = 1;
    options.boundaries = &pull;
    l.critical_stretch = malloc(sizeof *l.critical_stretch);
    l.body = calloc(3, sizeof *l.body);
    assert_true(l.critical_stretch != NULL && l.body != NULL);
    l.body[2] = 1;
    l.critical_stretch[0] = limit;
    assert_ok(dem_lattice_exclude(&l, pulled, 1));
    support_open(run, &l, floor ? &ground : NULL, floor, &options);
    *report = (fracture_report){0};
    const dem_observer observer = {.struct_size = sizeof observer, .step = follow, .context = report, .broken = note};
    assert_ok(dem_simulation_observe(run->simulation, &observer));
}

/* The force is the strain in newtons, speed times time; a step before the break it is less by what a step adds. */
TEST(the_load_is_that_of_the_last_step_before_the_first_break)
{
    const dem_contact_method ways[] = {DEM_CONTACT_LOCAL, DEM_CONTACT_EXACT};
    for (int way = 0; way < 2; way++) {
        CLEANUP(support_close) support_run run;
        fracture_report report;
        open_spring(&run, &report, false, ways[way]);
        assert_ok(dem_simulation_advance(run.simulation, 12.0));
        assert_int_equal(report.breaks, 1);
        assert_close(report.first_t, limit / speed, 1e-6);
        assert_true(report.load.force[0] < limit && report.load.force[0] >= limit - speed * step - 1e-12);
        assert_close(report.load.force[1], 0.0, 1e-12);
        assert_int_equal(report.load.boundary, 1);
        assert_int_equal(report.load.obstacle, 0);
    }
}

TEST(the_load_is_the_largest_of_all_boundaries_and_obstacles)
{
    CLEANUP(support_close) support_run run;
    fracture_report report;
    open_spring(&run, &report, true, DEM_CONTACT_LOCAL);
    assert_ok(dem_simulation_advance(run.simulation, 12.0));
    assert_int_equal(report.breaks, 1);
    assert_close(report.load.force[1], weight, 1e-9); /* the solver's, of 5 kg times 9.81 m/s^2 */
    assert_int_equal(report.load.boundary, 0);
    assert_int_equal(report.load.obstacle, 1);
    char *text = print(&report, run.simulation);
    assert_non_null(strstr(text, " m, under (0, 49.05) N of obstacle 1\nfragments  3; "));
    free(text);
}
