/* SPDX-License-Identifier: BSD-3-Clause */
/* report.c: runs with closed forms, and the numbers their logs give. */
#include <stdbool.h>

#include <dem/trajectory.h>

#include "ask.h"
#include "unit/drivers/batch/logged.h"

static const double g = 9.81, four_digits = 6e-5;

/* Stand-ins for what the simulation tells, where a test wants other numbers; the linker wraps report.c's calls. */
dem_status __real_dem_simulation_energy(const dem_simulation *simulation, dem_energy *out);
dem_status __real_dem_simulation_counts(const dem_simulation *simulation, dem_counts *out);
dem_status __wrap_dem_simulation_energy(const dem_simulation *simulation, dem_energy *out);
dem_status __wrap_dem_simulation_counts(const dem_simulation *simulation, dem_counts *out);

static const dem_energy *other_energy;
static const dem_counts *other_counts;

dem_status __wrap_dem_simulation_energy(const dem_simulation *simulation, dem_energy *out)
{
    if (other_energy == NULL) return __real_dem_simulation_energy(simulation, out);
    *out = *other_energy;
    return DEM_OK;
}

dem_status __wrap_dem_simulation_counts(const dem_simulation *simulation, dem_counts *out)
{
    if (other_counts == NULL) return __real_dem_simulation_counts(simulation, out);
    *out = *other_counts;
    return DEM_OK;
}

/* ---- contact ---- */

static double first_touch(void)
{
    return sqrt(2.0 * drop / g);
}

TEST(one_bounce_is_first_and_last_contact)
{
    const double t1 = first_touch(), v1 = g * t1, t_end = t1 + 0.5 * eta * v1 / g;
    CLEANUP(free_logged) logged *l = drop_node(false, t_end);
    finish(l, t_end);
    assert_close(number_in(l->text, "contact", "first"), t1, six_digits * t1);
    assert_close(number_in(l->text, "contact", "last"), t1, six_digits * t1);
    assert_close(number_in(l->text, "rebound", "velocity"), eta * v1, four_digits * eta * v1);
    const char *end = strstr(strstr(l->text, "rebound    vertical"), "contact");
    assert_close(strtod(end + strcspn(end, "+-0123456789"), NULL), eta * v1 - g * (t_end - t1), four_digits);
    assert_close(number_before(l->text, " impacts,"), 1.0, 0.0);
    assert_null(strstr(l->text, "still"));
}

TEST(two_bounces_are_first_and_last_contact)
{
    const double t1 = first_touch(), v1 = g * t1, t2 = t1 + 2.0 * eta * v1 / g, v2 = eta * eta * v1;
    CLEANUP(free_logged) logged *l = drop_node(false, t2 + v2 / g);
    finish(l, t2 + v2 / g);
    assert_close(number_in(l->text, "contact", "first"), t1, six_digits * t1);
    assert_close(number_in(l->text, "contact", "last"), t2, six_digits * t2);
    assert_close(number_in(l->text, "rebound", "velocity"), v2, four_digits * v2);
    assert_close(number_before(l->text, " impacts,"), 2.0, 0.0);
}

TEST(without_a_touch_there_is_no_contact)
{
    CLEANUP(free_logged) logged *l = drop_node(false, 0.9 * first_touch());
    finish(l, 0.9 * first_touch());
    assert_true(has_line(l->text, "contact"));
    assert_non_null(strstr(l->text, "none"));
    assert_false(has_line(l->text, "rebound"));
    assert_close(number_before(l->text, " impacts,"), 0.0, 0.0);
}

TEST(what_rests_at_the_end_is_still_touching)
{
    const double x[2] = {0.0, 0.0};
    CLEANUP(free_logged) logged *l = make_logged();
    support_point(&l->run, mass, x, NULL, floor_points, 2, 0.0);
    follow(l, false, 1.0);
    finish(l, 1.0);
    assert_close(number_in(l->text, "contact", "first"), 0.0, 0.0);
    assert_close(number_in(l->text, "contact", "last"), 1.0, 0.011); /* a step of at most 10 ms, and rounding */
    assert_non_null(strstr(l->text, "still touching"));
}

/* Gravity to the left, a wall at x = 0: upwards is to the right. */
TEST(the_rebound_is_measured_against_gravity)
{
    const double wall[4] = {0.0, 9.0, 0.0, -9.0}, x[4] = {drop, 0.0, 50.0, 1.0}, m[2] = {1.0, 3.0};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = wall, .restitution = eta);
    const double t1 = sqrt(2.0 * drop / 4.0), v1 = 4.0 * t1, centre = (m[0] * eta * v1 - m[1] * v1) / 4.0;
    dem_options options = dem_options_default();
    CLEANUP(free_logged) logged *l = make_logged();
    options.spacing = 1.0, options.max_step = 0.01, options.rtol = 1e-12, options.penetration_tolerance = 1e-13,
    options.v_scale = 1.0;
    options.gravity[0] = -4.0, options.gravity[1] = 0.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(2, x, m, 0, NULL, 0.0, 0.0, NULL);
    lattice.body = calloc(2, sizeof *lattice.body);
    assert_non_null(lattice.body);
    lattice.body[1] = 1;
    support_open(&l->run, &lattice, &obstacle, 1, &options);
    follow(l, false, 1.01 * t1);
    finish(l, 1.01 * t1);
    assert_close(number_in(l->text, "rebound", "velocity"), centre, four_digits * fabs(centre));
}

/* ---- energy ---- */

TEST(the_ledger_closes)
{
    const double t1 = first_touch(), v1 = g * t1, t_end = t1 + 0.25 * v1 / g, v = eta * v1 - g * (t_end - t1);
    const double start = mass * g * drop + 0.5 * mass * 0.25 * 0.25, taken = 0.5 * mass * (1.0 - eta * eta) * v1 * v1;
    CLEANUP(free_logged) logged *l = drop_node(false, t_end);
    finish(l, t_end);
    const double kinetic = 0.5 * mass * (v * v + 0.25 * 0.25);
    assert_close(number_in(l->text, "energy", "kinetic"), kinetic, 1e-5 * kinetic); /* six digits in all */
    assert_close(number_in(l->text, "ledger", "start"), start, 1e-8 * start);       /* nine digits */
    assert_close(number_in(l->text, "ledger", "impacts"), taken, 1e-3 * taken);     /* four digits */
    assert_close(number_in(l->text, "ledger", "now"), start - taken, 1e-8 * start);
    assert_close(number_in(l->text, "ledger", "closure"), 0.0, 1e-10); /* a hundred steps of rtol 1e-12 */
}

TEST(what_friction_damping_and_fracture_took_is_reported_if_they_did)
{
    const dem_energy e = {.ledger = 9.625,
                          .motion = 5.0,
                          .kinetic = 5.0,
                          .impact = 1.0,
                          .friction = 2.5,
                          .damping = 0.75,
                          .fracture = 0.5,
                          .projection = 0.125};
    CLEANUP(free_logged) logged *l = drop_node(false, 0.1);
    l->report.so_far.energy_start = 9.625, l->report.so_far.energy_max = 10.0;
    other_energy = &e;
    report_summary(&l->report, l->run.simulation);
    other_energy = NULL;
    report_summary(&l->report, l->run.simulation);
    read_log(l);
    assert_non_null(strstr(l->text,
                           "\nledger     start 9.625 J = now 5 + taken by impacts 1, friction 2.5, damping 0.75, "
                           "fracture 0.5 - projection 0.125; closure +0.00e+00\n"));
    assert_non_null(strstr(l->text, " + taken by impacts 0 - projection 0; closure "));
}

TEST(the_balance_is_the_ledger_in_plain_words)
{
    const dem_energy e = {.kinetic = 5.0,
                          .motion = 5.0,
                          .impact = 1.0,
                          .friction = 2.5,
                          .damping = 0.75,
                          .boundary = 0.125,
                          .obstacle = 0.25,
                          .ledger = 8.875};
    CLEANUP(free_logged) logged *l = drop_node(false, 0.1);
    l->log.verbose = false;
    l->report.so_far.energy_start = 9.0, l->report.so_far.energy_max = 10.0;
    other_energy = &e;
    report_summary(&l->report, l->run.simulation);
    other_energy = NULL;
    read_log(l);
    assert_non_null(strstr(l->text,
                           "\nbalance    9 J at the start, 5 J now; impacts took 1, friction 2.5, damping 0.75, "
                           "boundaries gave 0.125, obstacles gave 0.25 J; error -1.3e-02 of the largest energy\n"));
}

/* ---- obstacles ---- */

/* m g t in all, of which the impacts and the reaction are parts. */
TEST(an_obstacle_tells_its_impulse)
{
    const double t1 = first_touch(), v1 = g * t1;
    CLEANUP(free_logged) logged *l = drop_node(false, 1.1 * t1);
    finish(l, 1.1 * t1);
    const double up = mass * (1.0 + eta) * v1;
    const char *line = strstr(l->text, "\nobstacle   1: impulse (0, ");
    assert_non_null(line);
    assert_close(strtod(line + strlen("\nobstacle   1: impulse (0, "), NULL), up, 1e-5 * up); /* six digits in all */
    assert_non_null(strstr(l->text, " N s, by friction (0, 0) N s, 0 contacts\n"));
}

TEST(an_obstacle_in_contact_tells_its_resultant)
{
    const double x[2] = {0.0, 0.0};
    CLEANUP(free_logged) logged *l = make_logged();
    support_point(&l->run, mass, x, NULL, floor_points, 2, 0.0);
    follow(l, false, 0.5);
    finish(l, 0.5);
    assert_non_null(strstr(l->text, " N s, 1 contact, (0, 19.62) N at ("));
}

/* ---- strains ---- */

/* Two nodes of mass m pulled apart by a tenth: strain 0.1 cos(omega t), omega^2 = 2 E/(m d0). */
TEST(strains_have_the_extremes_of_a_vibration)
{
    const double x[4] = {0.0, 0.0, 1.0, 0.0}, pulled[4] = {-0.05, 0.0, 1.05, 0.0}, m[2] = {2.0, 2.0};
    const double omega = 10.0, period = 2.0 * M_PI / omega;
    const dem_index ends[2] = {0, 1};
    dem_options options = dem_options_default();
    CLEANUP(free_logged) logged *l = make_logged();
    options.rtol = 1e-9, options.max_step = period / 400.0, options.v_scale = 1.0;
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = support_lattice(2, x, m, 1, ends, 1.0, 0.5 * omega * omega * m[0], NULL);
    support_start(&lattice, pulled, NULL);
    support_open(&l->run, &lattice, NULL, 0, &options);
    follow(l, false, 0.75 * period);
    finish(l, 0.75 * period);
    /* between steps 0.1 (pi/400)^2/2 = 3e-6 may be missed, the time is off by half a step; four digits are printed */
    assert_close(number_in(l->text, "strain", "smallest"), -0.1, 6e-5);
    assert_close(number_in(l->text, "strain", "largest"), 0.1, 6e-5);
    const char *at = strstr(strstr(l->text, "smallest"), "at ");
    assert_close(strtod(at + 3, NULL), 0.5 * period, period / 400.0);
    assert_false(has_line(l->text, "triangles"));
}

TEST(without_springs_there_is_no_strain)
{
    CLEANUP(free_logged) logged *l = drop_node(false, 0.1);
    finish(l, 0.1);
    assert_false(has_line(l->text, "strain"));
    assert_false(has_line(l->text, "triangles"));
}

/* Pressed together to nine tenths, it only expands at first. */
TEST(the_smallest_triangle_is_reported)
{
    CLEANUP(free_logged) logged *l = press(1e-5);
    finish(l, 1e-5);
    assert_close(number_in(l->text, "triangles", "area"), 0.9, 6e-5);
    assert_false(has_line(l->text, "stressed")); /* nobody has kept peaks */
}

static int count_lines(const char *text, const char *topic)
{
    int n = 0;
    for (const char *at = strstr(text, topic); at != NULL; at = strstr(at + 1, topic)) n += at[-1] == '\n';
    return n;
}

/* Pressed as above: a stretch of 0.9 along y, by the law of the patch test sqrt(3) of its springs too, one of 3: the
 * stress is largest at the start, of all nodes alike, so that the first ones are reported. With l^2 = 0.25 + 0.75 0.81
 * of the slanting springs and c = E (l - 1)/l: xx = 2 c 0.25, yy = 2 c 0.75 0.81. */
TEST(the_most_stressed_are_reported_with_place_and_time)
{
    const double stretch = sqrt(0.25 + 0.75 * 0.81), c = 1e7 * (stretch - 1.0) / stretch;
    const double xx = 0.5 * c, yy = 1.5 * 0.81 * c, size = sqrt(xx * xx - xx * yy + yy * yy);
    CLEANUP(free_peaks) dem_peaks *peaks;
    CLEANUP(free_logged) logged *l = press(1e-4);
    assert_ok(dem_peaks_create(&peaks, l->run.model, 1));
    const dem_observer observer = ask_peaks_observer(peaks);
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
}

/* ---- progress ---- */

TEST(in_a_file_progress_is_a_line_every_twentieth)
{
    CLEANUP(free_logged) logged *l = drop_node(false, 1.0);
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
}

TEST(on_a_terminal_progress_is_rewritten_in_place)
{
    CLEANUP(free_logged) logged *l = drop_node(true, 1.0);
    l->report.wall_shown -= 10.0; /* as if it had been shown long ago */
    assert_ok(dem_simulation_advance(l->run.simulation, 0.5));
    read_log(l);
    assert_non_null(strchr(l->text, '\r'));
    assert_null(strchr(l->text, '\n'));
    report_summary(&l->report, l->run.simulation);
    read_log(l);
    assert_non_null(strstr(l->text, "\ncontact ")); /* in a line of its own */
}

TEST(of_many_obstacles_only_the_first_are_listed)
{
    dem_obstacle floors[20];
    for (int o = 0; o < 20; o++) floors[o] = (dem_obstacle){.struct_size = sizeof(dem_obstacle), .friction = 0.25};
    const dem_options options = dem_options_default();
    CLEANUP(free_logged) logged *l = new_floors(20, floors, &options);
    finish(l, 0.1);
    assert_non_null(strstr(l->text, "\nobstacle   16: "));
    assert_non_null(strstr(l->text, "\nobstacle   17 to 20: see /history\n"));
}

/* ---- counts ---- */

TEST(an_open_ledger_is_warned_of_once)
{
    for (int terminal = 0; terminal < 2; terminal++) {
        CLEANUP(free_logged) logged *l = drop_node(terminal, 0.5);
        l->report.closure = 1e-11;
        assert_ok(dem_simulation_advance(l->run.simulation, 0.25));
        dem_energy open = ask_energy(l->run.simulation);
        open.ledger += 9e-11 * open.motion; /* beyond rounding, and what the integrator is off by */
        other_energy = &open;
        finish(l, 0.5);
        other_energy = NULL;
        const char *warning = strstr(l->text, "warning    the energy ledger is open by ");
        assert_non_null(warning);
        assert_true(warning == l->text || warning[-1] == '\n');
        assert_int_equal(l->log.n_warnings, 1);
        assert_memory_equal(l->log.warnings[0], warning + strlen("warning    "), strlen(l->log.warnings[0]));
        assert_null(strstr(warning + 1, "\nwarning "));
        assert_true(fabs(number_in(l->text, "warning", "open by")) < 1e-10);
    }
}

/* At a height of 100 km the potential energy is rounded by 2e-10 J, and after some steps of a microsecond the kinetic
 * energy is as small. */
TEST(a_ledger_that_is_open_by_rounding_is_not_warned_of)
{
    const double x[2] = {0.0, 1e5};
    dem_options options = dem_options_default();
    CLEANUP(free_logged) logged *l = make_logged();
    options.spacing = 1.0, options.max_step = 1e-6, options.v_scale = 1.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_open(&l->run, &lattice, NULL, 0, &options);
    follow(l, false, 5e-6);
    finish(l, 5e-6);
    assert_true(fabs(report_closure(&l->report, ask_energy(l->run.simulation))) > l->report.closure);
    assert_int_equal(l->log.n_warnings, 0);
}

/* A run that goes on lists the warnings of before once more, in the order of time, and prints none. */
TEST(warnings_of_before_are_listed_in_their_order)
{
    for (int first = 0; first < 2; first++) {
        CLEANUP(free_logged) logged *l = drop_node(0, 0.5);
        report_progress *p = &l->report.so_far;
        p->warned = true, p->warned_t = 2e-3;
        p->surface_report.warning = (surface_report_warning){.given = true, .node = 7, .t = first ? 1e-3 : 3e-3};
        report_warn_again(&l->report, l->run.simulation);
        assert_int_equal(l->log.n_warnings, 2);
        assert_non_null(strstr(l->log.warnings[first], "ledger is open"));
        assert_non_null(strstr(l->log.warnings[1 - first], "at node 7 of body 0"));
        read_log(l);
        assert_null(strstr(l->text, "warning"));
    }
}

/* While a force grows the first steps may miss all of the little energy there is: that is reported only if it lasts. */
TEST(a_ledger_is_not_judged_while_a_ramp_grows)
{
    static const dem_index node[] = {0};
    const dem_boundary push =
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 1, .nodes = node, .value = {1.0, 0.0}, .ramp = 0.2);
    const double x[2] = {0.0, 0.0};
    for (int after = 0; after < 2; after++) {
        const double t_end = after ? 0.3 : 0.1;
        dem_options options = dem_options_default();
        CLEANUP(free_logged) logged *l = make_logged();
        options.n_boundaries = 1, options.boundaries = &push;
        options.spacing = 1.0, options.max_step = 0.01, options.v_scale = 1.0;
        CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
        support_open(&l->run, &lattice, NULL, 0, &options);
        follow(l, false, t_end);
        const deck d = {.t_end = t_end, .closure = 1e-300, .options = options}; /* rounding is enough */
        report_start(&l->report, &l->log, &d);
        finish(l, t_end);
        assert_int_equal(strstr(l->text, "warning ") != NULL, after);
        if (after) assert_true(number_in(l->text, "warning", "at") >= push.ramp);
    }
}

TEST(of_many_boundaries_only_the_first_are_listed)
{
    CLEANUP(free_logged) logged *l = new_held();
    finish(l, 0.1);
    assert_non_null(strstr(l->text, "\nboundary   16: force (0, 9.81) N, moved by (0, 0) m\n"));
    assert_non_null(strstr(l->text, "\nboundary   17 to 20: see /history\n"));
}

TEST(counts_are_those_of_the_simulation)
{
    CLEANUP(free_logged) logged *l = drop_node(false, 1.0);
    finish(l, 1.0);
    const dem_counts n = ask_counts(l->run.simulation);
    const char *last = strstr(l->text, "\nrun ");
    assert_non_null(last);
    assert_true(n.impacts > 2 && n.steps > 50);
    assert_close(number_before(last, " steps"), (double)n.steps, 0.0);
    assert_close(number_before(last, " rejected"), (double)n.rejected, 0.0);
    assert_close(number_before(last, " evaluations"), (double)n.evaluations, 0.0);
    assert_close(number_before(l->text, " impacts,"), (double)n.impacts, 0.0);
}

TEST(details_are_left_out_unless_they_are_wanted)
{
    static const char *const details[] = {"energy", "ledger",  "elastic",  "events", "lasting",
                                          "force",  "formula", "obstacle", "run"};
    static const char *const results[] = {"contact", "rebound", "normal"};
    for (int verbose = 0; verbose < 2; verbose++) {
        CLEANUP(free_logged) logged *l = drop_node(false, 0.5);
        l->log.verbose = verbose;
        finish(l, 0.5);
        for (size_t k = 0; k < sizeof details / sizeof *details; k++)
            assert_int_equal(has_line(l->text, details[k]), verbose);
        assert_int_equal(has_line(l->text, "balance"), !verbose);
        for (size_t k = 0; k < sizeof results / sizeof *results; k++) assert_true(has_line(l->text, results[k]));
    }
}

/* A run that ends at rest: its residual, known once the loads have grown, at every twentieth of the time expected. */
TEST(progress_of_a_run_to_rest_is_its_residual)
{
    relaxation rest = {.residual = 1e-3, .reached = (double)INFINITY, .settled = 0.25};
    CLEANUP(free_logged) logged *l = drop_node(false, 100.0);
    report_expect_rest(&l->report, &rest, 1.0);
    l->report.settled = 0.25;
    assert_ok(dem_simulation_advance(l->run.simulation, 0.25));
    rest.reached = 0.125;
    assert_ok(dem_simulation_advance(l->run.simulation, 0.5));
    read_log(l);
    int n_lines = 0;
    for (const char *line = l->text; *line != '\0'; line += strcspn(line, "\n") + 1) n_lines++;
    assert_in_range(n_lines, 8, 10); /* steps of 1 % pass a twentieth by one at most */
    assert_memory_equal(l->text, "loads grow until 2.50e-01 s  t ", strlen("loads grow until 2.50e-01 s  t "));
    assert_non_null(strstr(l->text, "\nresidual 1.2e-01, at rest below 1.0e-03  t "));
    assert_null(strstr(l->text, "%"));
    assert_null(strstr(l->text, "left"));
}

TEST(nodes_that_touched_are_known)
{
    CLEANUP(free_logged) logged *l = drop_node(false, 0.9 * first_touch());
    assert_int_equal(report_touched(&l->report, 0), 0);
    assert_ok(dem_simulation_advance(l->run.simulation, 1.1 * first_touch()));
    assert_int_equal(report_touched(&l->report, 0), 1);
}

TEST(progress_is_a_line_every_fifth_without_details)
{
    CLEANUP(free_logged) logged *l = drop_node(false, 1.0);
    l->log.verbose = false;
    assert_ok(dem_simulation_advance(l->run.simulation, 1.0));
    read_log(l);
    int n_lines = 0;
    for (const char *line = l->text; *line != '\0'; line += strcspn(line, "\n") + 1) n_lines++;
    assert_int_equal(n_lines, 4); /* steps of 1 % pass a fifth by one at most, and the end is none */
}

TEST(every_kind_of_event_is_reported)
{
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
    CLEANUP(free_logged) logged *l = drop_node(false, 0.1);
    other_counts = &n;
    report_summary(&l->report, l->run.simulation);
    other_counts = NULL;
    read_log(l);
    assert_non_null(strstr(l->text, "\nevents     11 times: 12 impacts, 13 on vertices, 14 early, 20 late, 21 behind\n"
                                    "lasting    15 closings, 16 releases, 17 slips, 18 sticks, 19 ends passed\n"));
    assert_non_null(strstr(l->text, " 22 retried, "));
}
