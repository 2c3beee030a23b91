/* SPDX-License-Identifier: BSD-3-Clause */
/* history.c: rows of two nodes in free flight, which have closed forms. The integrator is exact for parabolas, so
 * tolerances of 1e-13 are the rounding of its steps. */
#include "verification/support.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <unistd.h>

#include "harness/cleanup_hdf5.h"
#include "ask.h"
#include "output/history.h"
#include "unit/scratch.h"

enum { most_cells = 1 << 14 };

static const double mass[2] = {2.0, 3.0}, x0[4] = {0.25, 1.0, 4.0, 2.0}, v0[4] = {1.0, 0.5, 0.0, 0.0}, g = 10.0;
static const double floor_points[4] = {-9.0, -5.0, 9.0, -5.0}, table_points[4] = {3.0, 2.0, 5.0, 2.0};
static const char *path;

/* Two bodies of one node; the second rests on the second obstacle if there are obstacles. */
typedef struct flight {
    support_run run;
    history history;
    hdf5_file file;
    dem_counts counts; /* at the last row that record_step() made */
    dem_energy energy;
    dem_obstacle_load load[2];
} flight;

static void begin(flight *f, dem_index n_obstacles)
{
    const dem_obstacle obstacles[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor_points, .restitution = 0.0},
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = table_points, .restitution = 0.0}};
    dem_options options = dem_options_default();
    options.spacing = 1.0, options.max_step = 0.01, options.v_scale = 1.0, options.gravity[1] = -g;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(2, x0, mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&lattice, NULL, v0);
    lattice.body = malloc(2 * sizeof *lattice.body);
    assert_non_null(lattice.body);
    lattice.body[0] = 0, lattice.body[1] = 1;
    support_open(&f->run, &lattice, obstacles, n_obstacles, &options);
    assert_ok(history_init(&f->history, f->run.simulation, false));
    assert_ok(hdf5_open_new(&f->file, path, table_bytes(&f->history.table)));
    assert_ok(table_create(&f->history.table, &f->file));
}

static void end(flight *f)
{
    assert_ok(hdf5_close(&f->file, DEM_OK));
    history_free(&f->history);
    support_close(&f->run);
    assert_int_equal(unlink(path), 0);
}

static flight *new_flight(dem_index n_obstacles)
{
    flight *f = malloc(sizeof *f); /* a recorded run is large */
    assert_non_null(f);
    begin(f, n_obstacles);
    return f;
}

static void drop(flight *f)
{
    end(f);
    free(f);
}

static void record_at(flight *f, double t)
{
    (void)support_at(&f->run, t);
    assert_ok(history_record(&f->history, f->run.simulation));
}

/* ---- looking into the file ---- */

typedef struct contents {
    int rank;
    hsize_t extent[3];
    int is_integer;
    double value[most_cells];
} contents;

static const contents *look(const flight *f, const char *column)
{
    static contents t;
    char name[64];
    (void)snprintf(name, sizeof name, "/history/%s", column);
    CLEANUP(free_h5) const hid_t dataset = H5Dopen2(f->file.id, name, H5P_DEFAULT);
    if (dataset < 0) fail_msg("there is no %s", name);
    CLEANUP(free_h5) const hid_t space = H5Dget_space(dataset), type = H5Dget_type(dataset);
    t.extent[0] = t.extent[1] = t.extent[2] = 1;
    t.rank = H5Sget_simple_extent_dims(space, t.extent, NULL);
    t.is_integer = H5Tget_class(type) == H5T_INTEGER;
    assert_in_range(H5Sget_simple_extent_npoints(space), 0, most_cells);
    assert_true(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, t.value) >= 0);
    return &t;
}

static void expect_row(const flight *f, const char *column, hsize_t row, const double *expected, hsize_t n)
{
    const contents *t = look(f, column);
    assert_int_equal(t->extent[1] * t->extent[2], n);
    assert_true(row < t->extent[0]);
    for (hsize_t k = 0; k < n; k++)
        if (!(fabs(t->value[row * n + k] - expected[k]) <= 1e-13 * (1.0 + fabs(expected[k]))))
            fail_msg("%s, row %d, value %d: %.17g, expected %.17g", column, (int)row, (int)k, t->value[row * n + k],
                     expected[k]);
}

static void expect_number(const flight *f, const char *column, hsize_t row, double expected)
{
    expect_row(f, column, row, &expected, 1);
}

/* ---- rows ---- */

TEST(a_row_has_the_numbers_of_its_instant)
{
    flight *f = new_flight(0);
    for (int k = 0; k < 4; k++) record_at(f, 0.1 * k);
    assert_ok(table_flush(&f->history.table, &f->file));
    for (hsize_t k = 0; k < 4; k++) {
        const double t = 0.1 * (double)k, fall = 0.5 * g * t * t, v = 0.5 - g * t;
        const double centre[4] = {0.25 + t, 1.0 + 0.5 * t - fall, 4.0, 2.0 - fall};
        const double velocity[4] = {1.0, v, 0.0, -g * t}, spin[2] = {0.0, 0.0};
        expect_number(f, "t", k, t);
        expect_number(f, "kinetic", k, 0.5 * mass[0] * (1.0 + v * v) + 0.5 * mass[1] * g * t * g * t);
        expect_number(f, "gravity", k, g * (mass[0] * centre[1] + mass[1] * centre[3]));
        expect_number(f, "elastic", k, 0.0);
        expect_number(f, "area_min", k, 1.0);
        expect_row(f, "body_centre", k, centre, 4);
        expect_row(f, "body_velocity", k, velocity, 4);
        expect_row(f, "body_angular_momentum", k, spin, 2);
    }
    drop(f);
}

static dem_status record_step(void *context, const dem_simulation *simulation)
{
    flight *f = context;
    assert_ok(history_record(&f->history, simulation));
    f->counts = ask_counts(simulation);
    f->energy = ask_energy(simulation);
    for (dem_index o = 0; o < 2; o++) f->load[o] = ask_obstacle(simulation, o);
    return DEM_OK;
}

/* As a trajectory does it, at accepted steps. */
TEST(a_row_has_the_loads_of_its_obstacles)
{
    flight *f = new_flight(2);
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .step = record_step, .context = f};
    assert_ok(dem_simulation_observe(f->run.simulation, &observer));
    (void)support_at(&f->run, 0.25);
    assert_ok(table_flush(&f->history.table, &f->file));
    const hsize_t last = f->history.table.written - 1;
    const double weight = mass[1] * g, reaction[4] = {0.0, 0.0, 0.0, weight}, contacts[2] = {0.0, 1.0};
    const double impulse[4] = {0.0, 0.0, 0.0, weight * look(f, "t")->value[last]};
    assert_in_range(last, 25, TABLE_ROWS);
    expect_row(f, "obstacle_reaction", last, reaction, 4);
    expect_row(f, "obstacle_impulse", last, impulse, 4);
    expect_row(f, "obstacle_contacts", last, contacts, 2);
    expect_number(f, "contacts", last, 1.0);
    expect_number(f, "impacts", last, 0.0);
    for (hsize_t k = 0; k <= last; k++) expect_number(f, "steps", k, (double)k);
    assert_true(look(f, "evaluations")->value[last] >= 6.0 * (double)last); /* six stages a step */
    drop(f);
}

/* Where the first node has hit the floor, and the second rests. */
static flight *new_landing(void)
{
    flight *f = new_flight(2);
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .step = record_step, .context = f};
    assert_ok(dem_simulation_observe(f->run.simulation, &observer));
    (void)support_at(&f->run, 1.5);
    assert_ok(table_flush(&f->history.table, &f->file));
    assert_true(f->counts.impacts >= 1 && f->counts.closings >= 2 && f->energy.impact > 0.0);
    return f;
}

TEST(every_energy_has_its_column)
{
    flight *f = new_landing();
    const dem_energy *e = &f->energy;
    const struct {
        const char *column;
        double value;
    } columns[] = {{"kinetic", e->kinetic},   {"elastic", e->elastic}, {"area", e->area},
                   {"guard", e->guard},       {"gravity", e->gravity}, {"impact", e->impact},
                   {"friction", e->friction}, {"damping", e->damping}, {"projection", e->projection},
                   {"boundary", e->boundary}};
    for (size_t k = 0; k < sizeof columns / sizeof columns[0]; k++)
        expect_number(f, columns[k].column, f->history.table.written - 1, columns[k].value);
    drop(f);
}

TEST(every_count_has_its_column)
{
    flight *f = new_landing();
    const dem_counts *n = &f->counts;
    const struct {
        const char *column;
        dem_index value;
    } columns[] = {{"steps", n->steps},        {"rejected", n->rejected}, {"evaluations", n->evaluations},
                   {"events", n->events},      {"impacts", n->impacts},   {"vertex_impacts", n->vertex_impacts},
                   {"early", n->early},        {"closings", n->closings}, {"releases", n->releases},
                   {"slips", n->slips},        {"sticks", n->sticks},     {"passings", n->passings},
                   {"late", n->late},          {"retries", n->retries},   {"behind", n->behind},
                   {"crossings", n->crossings}};
    for (size_t k = 0; k < sizeof columns / sizeof columns[0]; k++)
        expect_number(f, columns[k].column, f->history.table.written - 1, (double)columns[k].value);
    drop(f);
}

/* Two blocks with flat sides, the upper one shifted: nearer than a fifth of the spacing they push from the start. */
TEST(contact_of_bodies_has_its_columns)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
    const double gaps[2] = {0.3e-3, 3e-3};
    for (int k = 0; k < 2; k++) {
        flight *f = calloc(1, sizeof *f);
        CLEANUP(dem_lattice_free) dem_lattice lower = support_rectangle(0.03, 0.026, 5e-3, &rubber);
        CLEANUP(dem_lattice_free) dem_lattice upper = support_rectangle(0.03, 0.026, 5e-3, &rubber);
        dem_lattice_move(&upper, 0.0, (const double[2]){0.37 * 5e-3, support_top(&lower) + gaps[k]});
        assert_ok(dem_lattice_append(&lower, &upper));
        dem_options options = dem_options_default();
        options.bodies = DEM_BODIES_ALL;
        support_open(&f->run, &lower, NULL, 0, &options);
        assert_ok(history_init(&f->history, f->run.simulation, false));
        assert_ok(hdf5_open_new(&f->file, path, table_bytes(&f->history.table)));
        assert_ok(table_create(&f->history.table, &f->file));
        assert_ok(history_record(&f->history, f->run.simulation));
        assert_ok(table_flush(&f->history.table, &f->file));
        if (k == 0) expect_number(f, "gap_min", 0, gaps[0]);
        if (k == 1) assert_true(look(f, "gap_min")->value[0] > DBL_MAX);
        expect_number(f, "pairs", 0, k == 0 ? 12.0 : 0.0); /* 6 of the 7 nodes of each flat side are above the other */
        expect_number(f, "crossings", 0, 0.0);
        drop(f);
    }
}

/* Steps of 0.01 s: the first behind each multiple of 0.025 s has a row. */
TEST(rows_are_an_interval_apart)
{
    static const double rows[] = {0.0, 0.03, 0.05, 0.08, 0.1};
    flight *f = new_flight(1);
    f->history.interval = 0.025;
    for (int k = 0; k <= 12; k++) record_at(f, 0.01 * k);
    record_at(f, 0.12);
    assert_int_equal(table_total(&f->history.table), 5);
    assert_ok(table_flush(&f->history.table, &f->file));
    for (dem_index k = 0; k < 5; k++) expect_number(f, "t", (hsize_t)k, rows[k]);
    drop(f);
}

TEST(every_part_of_a_load_has_its_column)
{
    flight *f = new_landing();
    const dem_obstacle_load *a = &f->load[0], *b = &f->load[1];
    const struct {
        const char *column;
        double value[4];
    } columns[] = {{"obstacle_reaction", {a->reaction[0], a->reaction[1], b->reaction[0], b->reaction[1]}},
                   {"obstacle_point", {a->point[0], a->point[1], b->point[0], b->point[1]}},
                   {"obstacle_impulse", {a->impulse[0], a->impulse[1], b->impulse[0], b->impulse[1]}},
                   {"obstacle_friction_impulse",
                    {a->friction_impulse[0], a->friction_impulse[1], b->friction_impulse[0], b->friction_impulse[1]}}};
    for (size_t k = 0; k < sizeof columns / sizeof columns[0]; k++)
        expect_row(f, columns[k].column, f->history.table.written - 1, columns[k].value, 4);
    drop(f);
}

/* One index for what a row tells of, one for the components of a vector; counts are integers. */
TEST(columns_have_the_shapes_of_what_they_tell)
{
    static const struct {
        const char *column;
        int is_integer, rank;
        hsize_t extent[3];
    } shapes[] = {
        {"t", 0, 1, {1, 1, 1}},
        {"guarded", 1, 1, {1, 1, 1}},
        {"inverted", 1, 1, {1, 1, 1}},
        {"late", 1, 1, {1, 1, 1}},
        {"body_centre", 0, 3, {1, 2, 2}},
        {"body_angular_momentum", 0, 2, {1, 2, 1}},
        {"obstacle_reaction", 0, 3, {1, 1, 2}},
        {"obstacle_point", 0, 3, {1, 1, 2}},
        {"obstacle_contacts", 1, 2, {1, 1, 1}},
        {"obstacle_displacement", 0, 3, {1, 1, 2}},
        {"obstacle_angle", 0, 2, {1, 1, 1}},
        {"obstacle_power", 0, 2, {1, 1, 1}},
    };
    flight *f = new_flight(1);
    record_at(f, 0.0);
    assert_ok(table_flush(&f->history.table, &f->file));
    for (size_t k = 0; k < sizeof shapes / sizeof shapes[0]; k++) {
        const contents *t = look(f, shapes[k].column);
        assert_int_equal(t->is_integer, shapes[k].is_integer);
        assert_int_equal(t->rank, shapes[k].rank);
        assert_memory_equal(t->extent, shapes[k].extent, sizeof t->extent);
    }
    drop(f);
}

TEST(without_obstacles_there_are_no_columns_of_them)
{
    flight *f = new_flight(0);
    record_at(f, 0.0);
    assert_ok(table_flush(&f->history.table, &f->file));
    assert_int_equal(H5Lexists(f->file.id, "/history/obstacle_reaction", H5P_DEFAULT), 0);
    assert_int_equal(H5Lexists(f->file.id, "/history/obstacle_contacts", H5P_DEFAULT), 0);
    assert_ok(table_verify(&f->history.table, &f->file, f->history.table.written));
    drop(f);
}

/* Between two nodes 1 m apart, of 2 and 3 kg, is a spring that the program breaks: what is known of it is measured anew
 * when the history knows of it, not before. */
TEST(what_is_broken_is_measured_when_something_has_broken)
{
    flight *f = calloc(1, sizeof *f);
    const double x[4] = {0.0, 0.0, 1.0, 0.0};
    const dem_index ends[2] = {0, 1}, which[1] = {0};
    const dem_options options = dem_options_default();
    CLEANUP(dem_lattice_free) dem_lattice pair = support_lattice(2, x, mass, 1, ends, 1.0, 8.0, NULL);
    assert_non_null(f);
    support_open(&f->run, &pair, NULL, 0, &options);
    assert_ok(history_init(&f->history, f->run.simulation, true));
    assert_ok(hdf5_open_new(&f->file, path, table_bytes(&f->history.table)));
    assert_ok(table_create(&f->history.table, &f->file));
    assert_ok(history_record(&f->history, f->run.simulation));
    assert_ok(dem_simulation_break(f->run.simulation, NULL, 0, which, 1));
    for (int k = 1; k <= 2; k++) {
        assert_ok(dem_simulation_advance(f->run.simulation, 1e-3 * k));
        assert_ok(history_record(&f->history, f->run.simulation));
        history_forget(&f->history);
    }
    assert_ok(table_flush(&f->history.table, &f->file));
    for (int row = 0; row < 3; row++) {
        expect_number(f, "broken_springs", (hsize_t)row, row == 2 ? 1.0 : 0.0);
        expect_number(f, "broken_triangles", (hsize_t)row, 0.0);
        expect_number(f, "fragments", (hsize_t)row, row == 2 ? 2.0 : 1.0);
        expect_number(f, "largest_fragment", (hsize_t)row, row == 2 ? 0.6 : 1.0);
        expect_number(f, "debris", (hsize_t)row, row == 2 ? 1.0 : 0.0);
        expect_number(f, "median_fragment", (hsize_t)row, row == 2 ? 3.0 : 5.0);
        expect_number(f, "crack_length", (hsize_t)row, 0.0);
    }
    drop(f);
}

TEST(without_the_option_there_are_no_columns_of_what_is_broken)
{
    flight *f = new_flight(0);
    assert_int_equal(H5Lexists(f->file.id, "/history/fragments", H5P_DEFAULT), 0);
    assert_int_equal(H5Lexists(f->file.id, "/history/crack_length", H5P_DEFAULT), 0);
    drop(f);
}

TEST(an_instant_has_one_row)
{
    flight *f = new_flight(0);
    for (int k = 0; k < 3; k++) assert_ok(history_record(&f->history, f->run.simulation));
    assert_int_equal(f->history.table.buffered, 1);
    record_at(f, 0.1);
    assert_ok(table_flush(&f->history.table, &f->file));
    assert_ok(history_record(&f->history, f->run.simulation)); /* is in the file already */
    assert_int_equal(f->history.table.buffered, 0);
    assert_int_equal(f->history.table.written, 2);
    drop(f);
}

/* The interval is 0.25 s, so that all quotients are exact. */
TEST(a_row_is_due_once_an_instant_and_where_a_multiple_of_the_interval_is_new)
{
    const double none = -(double)INFINITY;
    assert_true(dem_history_row_due(0.0, none, 0.0) && dem_history_row_due(0.25, none, 0.0));
    assert_true(dem_history_row_due(0.0, 0.1, 0.2) && !dem_history_row_due(0.0, 0.2, 0.2));
    assert_false(dem_history_row_due(0.25, 0.0, 0.2) || dem_history_row_due(0.25, 0.3, 0.49));
    assert_true(dem_history_row_due(0.25, 0.0, 0.25) && dem_history_row_due(0.25, 0.2, 0.8));
    assert_false(dem_history_row_due(0.25, 0.5, 0.5));
}

SCRATCH_GROUP({&path, "a.h5"});
