/* SPDX-License-Identifier: BSD-3-Clause */
/* report.c: runs with closed forms, and the numbers their logs give. A number of n digits after the point of its
 * mantissa is off by half of the last at most; the runs themselves are better by orders (rtol 1e-12). */
#include "../verification/support.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <dem/trajectory.h>

#include "report.h"

static const double g = 9.81, mass = 2.0, drop = 0.5, eta = 0.5, six_digits = 6e-7, four_digits = 6e-5;
static const double floor_points[4] = {-9.0, 0.0, 9.0, 0.0};

/* Stand-ins for what the simulation tells, where a test wants other numbers; the linker wraps report.c's calls. */
dem_energy __real_dem_simulation_energy(const dem_simulation *simulation);
dem_counts __real_dem_simulation_counts(const dem_simulation *simulation);
dem_energy __wrap_dem_simulation_energy(const dem_simulation *simulation);
dem_counts __wrap_dem_simulation_counts(const dem_simulation *simulation);

static const dem_energy *other_energy;
static const dem_counts *other_counts;

dem_energy __wrap_dem_simulation_energy(const dem_simulation *simulation)
{
    return other_energy != NULL ? *other_energy : __real_dem_simulation_energy(simulation);
}

dem_counts __wrap_dem_simulation_counts(const dem_simulation *simulation)
{
    return other_counts != NULL ? *other_counts : __real_dem_simulation_counts(simulation);
}

/* A run with its log. */
typedef struct logged {
    support_run run;
    report report;
    FILE *file;
    char text[1 << 16];
} logged;

static void follow(logged *l, bool terminal, double t_end)
{
    l->file = tmpfile();
    assert_non_null(l->file);
    const deck d = {.t_end = t_end, .closure = 1e-2};
    report_start(&l->report, l->file, terminal, &d);
    const dem_observer observer = report_observer(&l->report);
    assert_ok(dem_simulation_observe(l->run.simulation, &observer));
}

static void read_log(logged *l)
{
    rewind(l->file);
    const size_t n = fread(l->text, 1, sizeof l->text - 1, l->file);
    assert_true(n < sizeof l->text - 1);
    l->text[n] = '\0';
}

static void finish(logged *l, double t_end)
{
    assert_ok(dem_simulation_advance(l->run.simulation, t_end));
    report_summary(&l->report, l->run.simulation);
    read_log(l);
}

static void drop_logged(logged *l)
{
    assert_int_equal(fclose(l->file), 0);
    support_close(&l->run);
    free(l);
}

/* One node dropped from rest onto a floor. */
static logged *drop_node(bool terminal, double t_end)
{
    const double x[2] = {0.0, drop}, v[2] = {0.25, 0.0};
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    support_point(&l->run, mass, x, v, floor_points, 2, eta);
    follow(l, terminal, t_end);
    return l;
}

/* The line of a topic that has `word`; its first number behind the word. */
static double number_in(const char *text, const char *topic, const char *word)
{
    const size_t n = strlen(topic);
    for (const char *line = text; line != NULL && *line != '\0';) {
        const char *end = strchr(line, '\n'), *at = strstr(line, word);
        if (strncmp(line, topic, n) == 0 && line[n] == ' ' && at != NULL && end != NULL && at < end) {
            at += strlen(word);
            at += strcspn(at, "+-0123456789");
            assert_true(at < end);
            return strtod(at, NULL);
        }
        line = end != NULL ? end + 1 : NULL;
    }
    fail_msg("there is no '%s' with '%s' in\n%s", topic, word, text);
    return NAN;
}

/* The number that stands before a word: "3 impacts". */
static double number_before(const char *text, const char *word)
{
    const char *at = strstr(text, word);
    if (at == NULL) fail_msg("there is no '%s' in\n%s", word, text);
    while (at > text && strchr("+-0123456789.e", at[-1]) != NULL) at--;
    return strtod(at, NULL);
}

static int has_line(const char *text, const char *topic)
{
    char start[32];
    (void)snprintf(start, sizeof start, "\n%s ", topic);
    return strncmp(text, start + 1, strlen(start + 1)) == 0 || strstr(text, start) != NULL;
}

/* ---- contact ---- */

static double first_touch(void)
{
    return sqrt(2.0 * drop / g);
}

static void one_bounce_is_first_and_last_contact(void **state)
{
    (void)state;
    const double t1 = first_touch(), v1 = g * t1, t_end = t1 + 0.5 * eta * v1 / g;
    logged *l = drop_node(false, t_end);
    finish(l, t_end);
    assert_close(number_in(l->text, "contact", "first"), t1, six_digits * t1);
    assert_close(number_in(l->text, "contact", "last"), t1, six_digits * t1);
    assert_close(number_in(l->text, "rebound", "velocity"), eta * v1, four_digits * eta * v1);
    const char *end = strstr(strstr(l->text, "rebound"), "contact");
    assert_close(strtod(end + strcspn(end, "+-0123456789"), NULL), eta * v1 - g * (t_end - t1), four_digits);
    assert_close(number_before(l->text, " impacts,"), 1.0, 0.0);
    assert_null(strstr(l->text, "still"));
    drop_logged(l);
}

static void two_bounces_are_first_and_last_contact(void **state)
{
    (void)state;
    const double t1 = first_touch(), v1 = g * t1, t2 = t1 + 2.0 * eta * v1 / g, v2 = eta * eta * v1;
    logged *l = drop_node(false, t2 + v2 / g);
    finish(l, t2 + v2 / g);
    assert_close(number_in(l->text, "contact", "first"), t1, six_digits * t1);
    assert_close(number_in(l->text, "contact", "last"), t2, six_digits * t2);
    assert_close(number_in(l->text, "rebound", "velocity"), v2, four_digits * v2);
    assert_close(number_before(l->text, " impacts,"), 2.0, 0.0);
    drop_logged(l);
}

static void without_a_touch_there_is_no_contact(void **state)
{
    (void)state;
    logged *l = drop_node(false, 0.9 * first_touch());
    finish(l, 0.9 * first_touch());
    assert_true(has_line(l->text, "contact"));
    assert_non_null(strstr(l->text, "none"));
    assert_false(has_line(l->text, "rebound"));
    assert_close(number_before(l->text, " impacts,"), 0.0, 0.0);
    drop_logged(l);
}

static void what_rests_at_the_end_is_still_touching(void **state)
{
    (void)state;
    const double x[2] = {0.0, 0.0};
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    support_point(&l->run, mass, x, NULL, floor_points, 2, 0.0);
    follow(l, false, 1.0);
    finish(l, 1.0);
    assert_close(number_in(l->text, "contact", "first"), 0.0, 0.0);
    assert_close(number_in(l->text, "contact", "last"), 1.0, 0.011); /* a step of at most 10 ms, and rounding */
    assert_non_null(strstr(l->text, "still touching"));
    drop_logged(l);
}

/* Gravity to the left, a wall at x = 0: upwards is to the right. */
static void the_rebound_is_measured_against_gravity(void **state)
{
    (void)state;
    const double wall[4] = {0.0, 9.0, 0.0, -9.0}, x[4] = {drop, 0.0, 50.0, 1.0}, m[2] = {1.0, 3.0};
    const dem_obstacle obstacle = {.n_points = 2, .points = wall, .restitution = eta};
    const double t1 = sqrt(2.0 * drop / 4.0), v1 = 4.0 * t1, centre = (m[0] * eta * v1 - m[1] * v1) / 4.0;
    dem_options options = dem_options_default();
    dem_lattice lattice;
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    options.spacing = 1.0, options.max_step = 0.01, options.rtol = 1e-12, options.skin = 1e-13, options.v_scale = 1.0;
    options.gravity[0] = -4.0, options.gravity[1] = 0.0;
    support_lattice(&lattice, 2, x, m, 0, NULL, 0.0, 0.0, NULL);
    lattice.body = calloc(2, sizeof *lattice.body);
    assert_non_null(lattice.body);
    lattice.body[1] = 1;
    support_open(&l->run, &lattice, &obstacle, 1, &options);
    dem_lattice_free(&lattice);
    follow(l, false, 1.01 * t1);
    finish(l, 1.01 * t1);
    assert_close(number_in(l->text, "rebound", "velocity"), centre, four_digits * fabs(centre));
    drop_logged(l);
}

/* ---- energy ---- */

static void the_ledger_closes(void **state)
{
    (void)state;
    const double t1 = first_touch(), v1 = g * t1, t_end = t1 + 0.25 * v1 / g, v = eta * v1 - g * (t_end - t1);
    const double start = mass * g * drop + 0.5 * mass * 0.25 * 0.25, taken = 0.5 * mass * (1.0 - eta * eta) * v1 * v1;
    logged *l = drop_node(false, t_end);
    finish(l, t_end);
    const double kinetic = 0.5 * mass * (v * v + 0.25 * 0.25);
    assert_close(number_in(l->text, "energy", "kinetic"), kinetic, 1e-5 * kinetic); /* six digits in all */
    assert_close(number_in(l->text, "ledger", "start"), start, 1e-8 * start);       /* nine digits */
    assert_close(number_in(l->text, "ledger", "impacts"), taken, 1e-3 * taken);     /* four digits */
    assert_close(number_in(l->text, "ledger", "now"), start - taken, 1e-8 * start);
    assert_close(number_in(l->text, "ledger", "closure"), 0.0, 1e-10); /* a hundred steps of rtol 1e-12 */
    drop_logged(l);
}

static void what_friction_and_damping_took_is_told_if_they_did(void **state)
{
    (void)state;
    const dem_energy e = {.kinetic = 5.0, .impact = 1.0, .friction = 2.5, .damping = 0.75, .projection = 0.125};
    logged *l = drop_node(false, 0.1);
    l->report.energy_start = 9.125, l->report.energy_max = 10.0;
    other_energy = &e;
    report_summary(&l->report, l->run.simulation);
    other_energy = NULL;
    report_summary(&l->report, l->run.simulation);
    read_log(l);
    assert_non_null(strstr(l->text,
                           "\nledger     start 9.125 J = now 5 + taken by impacts 1, friction 2.5, damping 0.75 "
                           "- projection 0.125; closure +0.00e+00\n"));
    assert_non_null(strstr(l->text, " + taken by impacts 0 - projection 0; closure "));
    drop_logged(l);
}

/* ---- obstacles ---- */

/* m g t in all, of which the impacts and the reaction are parts. */
static void an_obstacle_tells_its_impulse(void **state)
{
    (void)state;
    const double t1 = first_touch(), v1 = g * t1;
    logged *l = drop_node(false, 1.1 * t1);
    finish(l, 1.1 * t1);
    const double up = mass * (1.0 + eta) * v1;
    const char *line = strstr(l->text, "\nobstacle   1: impulse (0, ");
    assert_non_null(line);
    assert_close(strtod(line + strlen("\nobstacle   1: impulse (0, "), NULL), up, 1e-5 * up); /* six digits in all */
    assert_non_null(strstr(l->text, " N s, by friction (0, 0) N s, 0 contacts\n"));
    drop_logged(l);
}

static void an_obstacle_in_contact_tells_its_resultant(void **state)
{
    (void)state;
    const double x[2] = {0.0, 0.0};
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    support_point(&l->run, mass, x, NULL, floor_points, 2, 0.0);
    follow(l, false, 0.5);
    finish(l, 0.5);
    assert_non_null(strstr(l->text, " N s, 1 contact, (0, 19.62) N at ("));
    drop_logged(l);
}

/* ---- strains ---- */

/* Two nodes of mass m pulled apart by a tenth: strain 0.1 cos(omega t), omega^2 = 2 E/(m d0). */
static void strains_have_the_extremes_of_a_vibration(void **state)
{
    (void)state;
    const double x[4] = {0.0, 0.0, 1.0, 0.0}, pulled[4] = {-0.05, 0.0, 1.05, 0.0}, m[2] = {2.0, 2.0};
    const double omega = 10.0, period = 2.0 * M_PI / omega;
    const dem_index ends[2] = {0, 1};
    dem_options options = dem_options_default();
    dem_lattice lattice;
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    options.rtol = 1e-9, options.max_step = period / 400.0, options.v_scale = 1.0;
    support_lattice(&lattice, 2, x, m, 1, ends, 1.0, 0.5 * omega * omega * m[0], NULL);
    support_start(&lattice, pulled, NULL);
    support_open(&l->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    follow(l, false, 0.75 * period);
    finish(l, 0.75 * period);
    /* between steps 0.1 (pi/400)^2/2 = 3e-6 may be missed, the time is off by half a step; four digits are printed */
    assert_close(number_in(l->text, "strain", "smallest"), -0.1, 6e-5);
    assert_close(number_in(l->text, "strain", "largest"), 0.1, 6e-5);
    const char *at = strstr(strstr(l->text, "smallest"), "at ");
    assert_close(strtod(at + 3, NULL), 0.5 * period, period / 400.0);
    assert_false(has_line(l->text, "triangles"));
    drop_logged(l);
}

static void without_springs_there_is_no_strain(void **state)
{
    (void)state;
    logged *l = drop_node(false, 0.1);
    finish(l, 0.1);
    assert_false(has_line(l->text, "strain"));
    assert_false(has_line(l->text, "triangles"));
    drop_logged(l);
}

static logged *press(double t_end)
{
    const dem_material rubber = {
        .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1000.0, .thickness = 1.0, .guard = 0.02};
    dem_options options = dem_options_default();
    dem_lattice lattice;
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    options.max_step = 1e-5, options.v_scale = 1.0;
    assert_ok(dem_lattice_rectangle(&lattice, 2.0, 2.0, 1.0));
    assert_ok(dem_lattice_assemble(&lattice, &rubber));
    support_start(&lattice, lattice.x, NULL);
    for (dem_index i = 0; i < lattice.n_nodes; i++) lattice.position[2 * i + 1] *= 0.9;
    support_open(&l->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    follow(l, false, t_end);
    return l;
}

/* Pressed together to nine tenths, it only expands at first. */
static void the_smallest_triangle_is_told(void **state)
{
    (void)state;
    logged *l = press(1e-5);
    finish(l, 1e-5);
    assert_close(number_in(l->text, "triangles", "area"), 0.9, 6e-5);
    assert_false(has_line(l->text, "stressed")); /* nobody has kept peaks */
    drop_logged(l);
}

static int count_lines(const char *text, const char *topic)
{
    int n = 0;
    for (const char *at = strstr(text, topic); at != NULL; at = strstr(at + 1, topic)) n += at[-1] == '\n';
    return n;
}

/* Pressed as above: a stretch of 0.9 along y, by the law of the patch test sqrt(3) of its springs too, one of 3: the
 * stress is largest at the start, of all nodes alike, so that the first ones are told. With l^2 = 0.25 + 0.75 0.81 of
 * the slanting springs and c = E (l - 1)/l: xx = 2 c 0.25, yy = 2 c 0.75 0.81. */
static void the_most_stressed_are_told_with_place_and_time(void **state)
{
    const double stretch = sqrt(0.25 + 0.75 * 0.81), c = 1e7 * (stretch - 1.0) / stretch;
    const double xx = 0.5 * c, yy = 1.5 * 0.81 * c, size = sqrt(xx * xx - xx * yy + yy * yy);
    dem_peaks *peaks;
    (void)state;
    logged *l = press(1e-4);
    assert_ok(dem_peaks_create(&peaks, l->run.model, 1));
    const dem_observer observer = dem_peaks_observer(peaks);
    assert_ok(dem_simulation_observe(l->run.simulation, &observer));
    l->report.peaks = peaks;
    l->report.most_stressed = 3;
    finish(l, 1e-4);
    assert_int_equal(count_lines(l->text, "stressed "), 3);
    assert_int_equal(count_lines(l->text, "strained "), 3);
    assert_close(number_in(l->text, "stressed", "Mises"), size, 5e-4 * size);
    assert_close(number_in(l->text, "stressed", "Pa at"), 0.0, 0.0);
    assert_close(number_in(l->text, "stressed", "principal"), xx, 5e-4 * fabs(xx));
    assert_close(number_in(l->text, "stressed", "degrees, "), yy, 5e-4 * fabs(yy));
    assert_close(number_in(l->text, "strained", "strain "), stretch - 1.0, 6e-5);
    assert_close(number_in(l->text, "strained", "N at"), 0.0, 0.0);
    dem_peaks_destroy(peaks);
    drop_logged(l);
}

/* ---- progress ---- */

static void in_a_file_progress_is_a_line_every_twentieth(void **state)
{
    (void)state;
    logged *l = drop_node(false, 1.0);
    assert_ok(dem_simulation_advance(l->run.simulation, 1.0));
    read_log(l);
    int n_lines = 0;
    double before = 0.0;
    assert_null(strchr(l->text, '\r'));
    for (const char *line = l->text; *line != '\0'; line += strcspn(line, "\n") + 1, n_lines++) {
        const char *percent = strchr(line, '%');
        const double done = strtod(line, NULL);
        assert_non_null(percent);
        assert_true(percent < strchr(line, '\n'));
        assert_true(done - before >= 5.0 - 0.051); /* one digit after the point */
        assert_true(done <= 100.0);
        before = done;
    }
    assert_in_range(n_lines, 16, 20); /* steps of 1 % pass a twentieth by one at most */
    drop_logged(l);
}

static void on_a_terminal_progress_is_rewritten_in_place(void **state)
{
    (void)state;
    logged *l = drop_node(true, 1.0);
    l->report.wall_shown -= 10.0; /* as if it had been shown long ago */
    assert_ok(dem_simulation_advance(l->run.simulation, 0.5));
    read_log(l);
    assert_non_null(strchr(l->text, '\r'));
    assert_null(strchr(l->text, '\n'));
    report_summary(&l->report, l->run.simulation);
    read_log(l);
    assert_non_null(strstr(l->text, "\ncontact ")); /* in a line of its own */
    drop_logged(l);
}

/* ---- header ---- */

static void the_header_tells_what_is_about_to_run(void **state)
{
    (void)state;
    char name[] = "drops/drop.nml", title[] = "A title";
    const deck d = {.path = name, .title = title, .hash = 0xabc, .t_end = 0.25, .frame_interval = 0.01};
    logged *l = drop_node(false, d.t_end);
    report_header(l->file, &d, l->run.simulation, "there/drop.vtkhdf");
    read_log(l);
    assert_non_null(strstr(l->text, "drops/drop.nml"));
    assert_non_null(strstr(l->text, "A title"));
    assert_non_null(strstr(l->text, "0000000000000abc"));
    assert_non_null(strstr(l->text, "there/drop.vtkhdf"));
    assert_close(number_before(l->text, " nodes, "), 1.0, 0.0);
    assert_close(number_before(l->text, " springs"), 0.0, 0.0);
    assert_close(number_before(l->text, " segments"), 1.0, 0.0);
    assert_close(number_in(l->text, "lattice", "mass"), mass, 0.0);
    assert_close(number_in(l->text, "time", "t_end"), 0.25, 0.0);
    assert_close(number_before(l->text, " frames"), 26.0, 0.0);       /* the one at 0 too */
    assert_close(number_in(l->text, "estimate", "least"), 25.0, 0.0); /* steps of 0.01 s */
    /* one chunk of 1024 rows of 49 numbers, and 26 frames of three */
    assert_close(number_in(l->text, "estimate", "about"), 1e-6 * (1024 * 49 * 8 + 26 * 24), 5e-4);
    drop_logged(l);
}

static void the_header_tells_what_is_probed_and_where(void **state)
{
    (void)state;
    char name[] = "a.nml", title[] = "";
    dem_probe probes[3] = {{"foot", DEM_PROBE_NODE, {2, 0}, 1},
                           {"strut", DEM_PROBE_SPRING, {1, 0}, 30},
                           {"span", DEM_PROBE_GAUGE, {0, 2}, 1}};
    const deck d = {
        .path = name, .title = title, .t_end = 0.25, .frame_interval = 0.01, .probes = probes, .n_probes = 3};
    logged *l = press(d.t_end);
    const dem_lattice *lattice = dem_model_lattice(l->run.model);
    const double *a = lattice->x + 2 * lattice->ends[2], *b = lattice->x + 2 * lattice->ends[3];
    report_header(l->file, &d, l->run.simulation, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, "\nprobe      foot: node 2 at (1, 0) m\n"));
    assert_non_null(strstr(l->text, "\nprobe      span: gauge from node 0 to 2 at (0, 0) m\n"));
    assert_close(number_in(l->text, "probe", "strut: spring"), 1.0, 0.0);
    assert_close(number_in(l->text, "probe", "strut: spring 1 at ("), 0.5 * (a[0] + b[0]), six_digits);
    /* 25000 steps: chunks of 1024 rows, of the history, foot and span, and one of the strut */
    assert_close(number_in(l->text, "estimate", "about"), 1e-6 * (25 * (40 + 9 + 3) + 3) * 1024 * 8, 0.05);
    drop_logged(l);
}

/* A block of nu = 0.1 and a node of its own: E, nu and waves of plane stress, and what cannot be measured. */
static void the_header_tells_what_was_measured_of_each_body(void **state)
{
    (void)state;
    const dem_material solid = {.youngs_modulus = 1e7, .poissons_ratio = 0.1, .density = 1000.0, .thickness = 0.5};
    char name[] = "a.nml", title[] = "";
    const deck d = {.path = name, .title = title, .t_end = 0.25, .frame_interval = 0.01};
    const double x[2] = {9.0, 9.0}, one = 1.0;
    dem_options options = dem_options_default();
    dem_lattice lattice, node;
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    options.v_scale = 1.0;
    assert_ok(dem_lattice_rectangle(&lattice, 4.0, 4.0, 1.0));
    assert_ok(dem_lattice_assemble(&lattice, &solid));
    support_lattice(&node, 1, x, &one, 0, NULL, 0.0, 0.0, NULL);
    assert_ok(dem_lattice_append(&lattice, &node));
    support_open(&l->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    dem_lattice_free(&node);
    follow(l, false, d.t_end);
    report_header(l->file, &d, l->run.simulation, NULL);
    read_log(l);
    assert_close(number_in(l->text, "constants", "E"), 1e7, 1.0);
    assert_close(number_in(l->text, "constants", "nu"), 0.1, 1e-6);
    assert_close(number_in(l->text, "constants", "anisotropy"), 1.0, 1e-4);
    assert_close(number_in(l->text, "constants", "waves"), 100.0 / sqrt(0.99), 1e-2);
    assert_close(number_in(l->text, "constants", "and"), 100.0 / sqrt(2.2), 1e-2);
    assert_non_null(strstr(l->text, "\nconstants  body 2: not measured: the body has no triangles, "));
    assert_close(number_in(l->text, "frequency", "highest") * number_in(l->text, "frequency", "is"),
                 dem_model_omega_max(l->run.model), 1e-3 * dem_model_omega_max(l->run.model));
    drop_logged(l);
}

/* A body with everything that there may be to tell, and one from a file. */
static void the_header_tells_how_bodies_came_out(void **state)
{
    (void)state;
    char name[] = "a.nml", title[] = "";
    body_facts bodies[2] = {
        {.mass = 2.5,
         .true_mass = 4.0,
         .form = {.area = 3.0, .pore_area = 1.0, .n_pores = 7, .n_cracked = 12},
         .loose = {.n = 2, .size = {5, 1}, .x = {{0.5, 2.0}, {3.0, 4.0}}},
         .removed = true,
         .hinges = {.n = 1, .x = {6.0, 7.0}}},
        {.mass = 1.0, .loose = {.n = 1, .size = {3}}},
    };
    const deck d = {
        .path = name, .title = title, .t_end = 0.25, .frame_interval = 0.01, .bodies = bodies, .n_bodies = 2};
    logged *l = drop_node(false, d.t_end);
    report_header(l->file, &d, l->run.simulation, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, "\nmass       body 1: 2.5 kg, of the true shape 4 kg (ratio 0.6250)\n"));
    assert_non_null(strstr(l->text, "\npores      body 1: 7, of porosity 0.2500\n"));
    assert_non_null(strstr(l->text, "\ncracks     body 1: through 12 triangles, which are taken away\n"));
    assert_non_null(strstr(l->text, "\nparts      body 1: 2 removed, of 5 triangles at (0.5, 2), 1 at (3, 4) m in its "
                                    "own coordinates\n"));
    assert_non_null(
        strstr(l->text, "\nhinges     body 1: 1 node between triangles that share no edge, one at (6, 7) m\n"));
    assert_non_null(strstr(l->text, "\nparts      body 2: 1 apart from the largest, of 3 nodes at (0, 0) m in its own "
                                    "coordinates\n"));
    assert_null(strstr(l->text, "mass       body 2"));
    drop_logged(l);
}

static void a_long_list_of_bodies_is_cut(void **state)
{
    (void)state;
    char name[] = "a.nml", title[] = "";
    body_facts bodies[17];
    for (int k = 0; k < 17; k++) bodies[k] = (body_facts){.mass = 1.0, .true_mass = 2.0};
    const deck d = {
        .path = name, .title = title, .t_end = 0.25, .frame_interval = 0.01, .bodies = bodies, .n_bodies = 17};
    logged *l = drop_node(false, d.t_end);
    report_header(l->file, &d, l->run.simulation, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, "mass       body 16: "));
    assert_null(strstr(l->text, "mass       body 17: "));
    assert_non_null(strstr(l->text, "\nbodies     of 17 the first 16 are listed\n"));
    drop_logged(l);
}

static void without_an_output_none_is_told(void **state)
{
    (void)state;
    char name[] = "a.nml", title[] = "";
    const deck d = {.path = name, .title = title, .t_end = 0.25, .frame_interval = 0.01};
    logged *l = drop_node(false, d.t_end);
    report_header(l->file, &d, l->run.simulation, NULL);
    read_log(l);
    assert_false(has_line(l->text, "output"));
    assert_true(has_line(l->text, "deck"));
    drop_logged(l);
}

static void versions_are_those_in_use(void **state)
{
    (void)state;
    char text[512], cut[16];
    report_versions(text, sizeof text);
    assert_null(strchr(text, '\n'));
    assert_non_null(strstr(text, dem_version()));
    assert_non_null(strstr(text, dem_version_sundials()));
    assert_non_null(strstr(text, dem_version_hdf5()));
    report_versions(cut, sizeof cut);
    assert_int_equal(strlen(cut), sizeof cut - 1);
}

/* A node above n floors, whose friction the caller sets. */
static logged *new_floors(dem_index n, dem_obstacle *floors, const dem_options *changed)
{
    const double x[2] = {0.0, drop};
    dem_options options = *changed;
    dem_lattice lattice;
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    options.spacing = 1.0, options.max_step = 0.01, options.v_scale = 1.0;
    double *points = calloc((size_t)n, 4 * sizeof *points);
    assert_non_null(points);
    for (dem_index o = 0; o < n; o++) {
        memcpy(points + 4 * o, floor_points, sizeof floor_points);
        points[4 * o + 1] = points[4 * o + 3] = -(double)o;
        floors[o].n_points = 2, floors[o].points = points + 4 * o;
    }
    support_lattice(&lattice, 1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_open(&l->run, &lattice, floors, n, &options);
    dem_lattice_free(&lattice);
    free(points);
    follow(l, false, 1.0);
    return l;
}

static void print_header(logged *l)
{
    char name[] = "a.nml", title[] = "";
    const deck d = {.path = name, .title = title, .t_end = 0.25, .frame_interval = 0.01};
    report_header(l->file, &d, l->run.simulation, NULL);
    read_log(l);
}

static void the_header_tells_the_rules_of_impact(void **state)
{
    (void)state;
    dem_obstacle floor = {0};
    dem_options options = dem_options_default();
    for (int on = 0; on <= 1; on++) {
        options.window = on ? 2.5e-5 : 0.0, options.vertices = on;
        logged *l = new_floors(1, &floor, &options);
        print_header(l);
        assert_non_null(strstr(l->text, on ? "\nimpacts    window 2.5e-05 s, vertices on: 0 may touch 0 edges\n"
                                           : "\nimpacts    window 0 s (each by itself), vertices off\n"));
        assert_false(has_line(l->text, "friction") || has_line(l->text, "damping"));
        drop_logged(l);
    }
}

static void the_header_tells_friction_and_damping(void **state)
{
    (void)state;
    dem_obstacle floors[4] = {{.friction = 0.3},
                              {.friction = 0.0},
                              {.friction = 0.5, .friction_law = DEM_FRICTION_PAPER},
                              {.friction = 1.0, .friction_law = DEM_FRICTION_PAPER}};
    dem_options options = dem_options_default();
    options.mass_damping = 0.75;
    logged *l = new_floors(4, floors, &options);
    print_header(l);
    assert_non_null(strstr(l->text, "\nfriction   obstacle 1: 0.3 (Coulomb)\nfriction   obstacle 3: 0.5 (paper)\n"
                                    "damping    of masses: 0.75 1/s\n"));
    drop_logged(l);
}

static void of_many_obstacles_only_the_first_are_listed(void **state)
{
    (void)state;
    dem_obstacle floors[20];
    for (int o = 0; o < 20; o++) floors[o] = (dem_obstacle){.friction = 0.25};
    const dem_options options = dem_options_default();
    logged *l = new_floors(20, floors, &options);
    print_header(l);
    assert_non_null(strstr(l->text, "\nfriction   obstacle 16: 0.25 (Coulomb)\nfriction   on 20 obstacles in all\n"));
    finish(l, 0.1);
    assert_non_null(strstr(l->text, "\nobstacle   16: "));
    assert_non_null(strstr(l->text, "\nobstacle   17 to 20: see /history\n"));
    drop_logged(l);
}

/* ---- counts ---- */

static void an_open_ledger_is_warned_of_once(void **state)
{
    (void)state;
    for (int terminal = 0; terminal < 2; terminal++) {
        logged *l = drop_node(terminal, 0.5);
        l->report.closure = 1e-300; /* rounding is enough */
        finish(l, 0.5);
        const char *warning = strstr(l->text, "\nwarning    the energy ledger is open by ");
        assert_non_null(warning);
        assert_null(strstr(warning + 1, "\nwarning "));
        assert_true(fabs(number_in(l->text, "warning", "open by")) < 1e-10);
        drop_logged(l);
    }
}

/* While a force grows the first steps may miss all of the little energy there is: that is told only if it lasts. */
static void a_ledger_is_not_judged_while_a_ramp_grows(void **state)
{
    (void)state;
    static const dem_index node[] = {0};
    const dem_boundary push = {
        .kind = DEM_BOUNDARY_FORCE, .n_nodes = 1, .nodes = node, .value = {1.0, 0.0}, .ramp = 0.2};
    const double x[2] = {0.0, 0.0};
    for (int after = 0; after < 2; after++) {
        const double t_end = after ? 0.3 : 0.1;
        dem_options options = dem_options_default();
        dem_lattice lattice;
        logged *l = calloc(1, sizeof *l);
        assert_non_null(l);
        options.n_boundaries = 1, options.boundaries = &push;
        options.spacing = 1.0, options.max_step = 0.01, options.v_scale = 1.0;
        support_lattice(&lattice, 1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
        support_open(&l->run, &lattice, NULL, 0, &options);
        dem_lattice_free(&lattice);
        follow(l, false, t_end);
        const deck d = {.t_end = t_end, .closure = 1e-300, .options = options}; /* rounding is enough */
        report_start(&l->report, l->file, false, &d);
        finish(l, t_end);
        assert_int_equal(strstr(l->text, "warning ") != NULL, after);
        if (after) assert_true(number_in(l->text, "warning", "at") >= push.ramp);
        drop_logged(l);
    }
}

/* E and nu of the deck, though the model is the plate of E/(1 - nu^2) and nu/(1 - nu); the speeds are of space. */
static void constants_in_plane_strain_are_read_in_plane_strain(void **state)
{
    (void)state;
    const double modulus = 1e7, nu = 0.45, density = 1000.0, shear = 0.5 * modulus / (1.0 + nu);
    const dem_material solid = {.youngs_modulus = modulus,
                                .poissons_ratio = nu,
                                .density = density,
                                .thickness = 1.0,
                                .plane = DEM_PLANE_STRAIN};
    char name[] = "a.nml", title[] = "";
    body_facts facts = {.plane_strain = true};
    const deck d = {
        .path = name, .title = title, .t_end = 0.25, .frame_interval = 0.01, .bodies = &facts, .n_bodies = 1};
    const dem_options options = dem_options_default();
    dem_lattice lattice;
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    assert_ok(dem_lattice_rectangle(&lattice, 4.0, 4.0, 1.0));
    assert_ok(dem_lattice_assemble(&lattice, &solid));
    support_open(&l->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    follow(l, false, d.t_end);
    report_header(l->file, &d, l->run.simulation, NULL);
    read_log(l);
    assert_non_null(strstr(l->text, "\nconstants  body 1: E 1e+07 Pa, nu 0.45 in plane strain, anisotropy 1.0000,"));
    assert_close(number_in(l->text, "constants", "waves"), sqrt(shear / density * (1.0 - nu) / (0.5 - nu)), 1e-2);
    assert_close(number_in(l->text, "constants", "and"), sqrt(shear / density), 1e-2);
    drop_logged(l);
}

static void the_header_tells_the_damping_of_springs(void **state)
{
    (void)state;
    const dem_material solid = {
        .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1000.0, .thickness = 1.0, .damping_time = 2e-6};
    const dem_options options = dem_options_default();
    dem_lattice lattice;
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    assert_ok(dem_lattice_rectangle(&lattice, 0.04, 0.04, 0.01));
    assert_ok(dem_lattice_assemble(&lattice, &solid));
    support_open(&l->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    follow(l, false, 1e-5);
    print_header(l);
    assert_non_null(strstr(l->text, "\ndamping    of springs: 2e-06 s\n"));
    drop_logged(l);
}

/* Twenty nodes, each a body that a boundary holds. */
static void of_many_bodies_and_boundaries_only_the_first_are_listed(void **state)
{
    enum { n = 20 };
    (void)state;
    double x[2 * n] = {0.0}, masses[n];
    dem_boundary held[n];
    dem_index nodes[n];
    dem_options options = dem_options_default();
    dem_lattice lattice;
    logged *l = calloc(1, sizeof *l);
    assert_non_null(l);
    for (dem_index k = 0; k < n; k++) {
        x[2 * k] = (double)k, masses[k] = 1.0, nodes[k] = k;
        held[k] = (dem_boundary){.kind = DEM_BOUNDARY_VELOCITY, .components = 3, .n_nodes = 1, .nodes = &nodes[k]};
    }
    support_lattice(&lattice, n, x, masses, 0, NULL, 0.0, 0.0, NULL);
    lattice.body = malloc(n * sizeof *lattice.body);
    assert_non_null(lattice.body);
    for (int k = 0; k < n; k++) lattice.body[k] = k;
    options.spacing = 1.0, options.max_step = 0.01, options.v_scale = 1.0;
    options.n_boundaries = n, options.boundaries = held;
    support_open(&l->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    follow(l, false, 0.1);
    print_header(l);
    assert_non_null(strstr(l->text, "\nconstants  bodies 17 to 20: not measured\n"));
    finish(l, 0.1);
    assert_non_null(strstr(l->text, "\nboundary   16: force (0, 9.81) N, moved by (0, 0) m\n"));
    assert_non_null(strstr(l->text, "\nboundary   17 to 20: see /history\n"));
    drop_logged(l);
}

static void counts_are_those_of_the_simulation(void **state)
{
    (void)state;
    logged *l = drop_node(false, 1.0);
    finish(l, 1.0);
    const dem_counts n = dem_simulation_counts(l->run.simulation);
    const char *last = strstr(l->text, "\nrun ");
    assert_non_null(last);
    assert_true(n.impacts > 2 && n.steps > 50);
    assert_close(number_before(last, " steps"), (double)n.steps, 0.0);
    assert_close(number_before(last, " rejected"), (double)n.rejected, 0.0);
    assert_close(number_before(last, " evaluations"), (double)n.evaluations, 0.0);
    assert_close(number_before(l->text, " impacts,"), (double)n.impacts, 0.0);
    drop_logged(l);
}

static void every_kind_of_event_is_told(void **state)
{
    (void)state;
    const dem_counts n = {.events = 11,
                          .impacts = 12,
                          .vertex_impacts = 13,
                          .early = 14,
                          .closings = 15,
                          .releases = 16,
                          .slips = 17,
                          .sticks = 18,
                          .passings = 19,
                          .late = 20,
                          .behind = 21,
                          .retries = 22};
    logged *l = drop_node(false, 0.1);
    other_counts = &n;
    report_summary(&l->report, l->run.simulation);
    other_counts = NULL;
    read_log(l);
    assert_non_null(strstr(l->text, "\nevents     11 stops: 12 impacts, 13 on vertices, 14 early, 20 late, 21 behind\n"
                                    "lasting    15 closings, 16 releases, 17 slips, 18 sticks, 19 ends passed\n"));
    assert_non_null(strstr(l->text, " 22 retried, "));
    drop_logged(l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_bounce_is_first_and_last_contact),
        cmocka_unit_test(two_bounces_are_first_and_last_contact),
        cmocka_unit_test(without_a_touch_there_is_no_contact),
        cmocka_unit_test(what_rests_at_the_end_is_still_touching),
        cmocka_unit_test(the_rebound_is_measured_against_gravity),
        cmocka_unit_test(the_ledger_closes),
        cmocka_unit_test(what_friction_and_damping_took_is_told_if_they_did),
        cmocka_unit_test(an_obstacle_tells_its_impulse),
        cmocka_unit_test(an_obstacle_in_contact_tells_its_resultant),
        cmocka_unit_test(strains_have_the_extremes_of_a_vibration),
        cmocka_unit_test(without_springs_there_is_no_strain),
        cmocka_unit_test(the_smallest_triangle_is_told),
        cmocka_unit_test(the_most_stressed_are_told_with_place_and_time),
        cmocka_unit_test(in_a_file_progress_is_a_line_every_twentieth),
        cmocka_unit_test(on_a_terminal_progress_is_rewritten_in_place),
        cmocka_unit_test(the_header_tells_what_is_about_to_run),
        cmocka_unit_test(the_header_tells_what_is_probed_and_where),
        cmocka_unit_test(the_header_tells_what_was_measured_of_each_body),
        cmocka_unit_test(the_header_tells_how_bodies_came_out),
        cmocka_unit_test(a_long_list_of_bodies_is_cut),
        cmocka_unit_test(without_an_output_none_is_told),
        cmocka_unit_test(versions_are_those_in_use),
        cmocka_unit_test(the_header_tells_the_rules_of_impact),
        cmocka_unit_test(the_header_tells_friction_and_damping),
        cmocka_unit_test(of_many_obstacles_only_the_first_are_listed),
        cmocka_unit_test(an_open_ledger_is_warned_of_once),
        cmocka_unit_test(a_ledger_is_not_judged_while_a_ramp_grows),
        cmocka_unit_test(constants_in_plane_strain_are_read_in_plane_strain),
        cmocka_unit_test(the_header_tells_the_damping_of_springs),
        cmocka_unit_test(of_many_bodies_and_boundaries_only_the_first_are_listed),
        cmocka_unit_test(counts_are_those_of_the_simulation),
        cmocka_unit_test(every_kind_of_event_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
