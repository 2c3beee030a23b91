/* SPDX-License-Identifier: BSD-3-Clause */
/* break_table.c: a body that breaks by itself and by the program, and what is in its trajectory then. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "harness/message.h"
#include "unit/scratch.h"

#include <dem/reader.h>
#include <dem/trajectory.h>

static const char *path, *part, *beside;

/* What was heard while the file was written. */
enum { MOST = 1024 };
static dem_break heard[MOST];
static dem_index fragment[MOST];
static dem_fracture fracture;
static dem_index n_heard;

static dem_status on_break(void *context, const dem_simulation *simulation, const dem_break *what)
{
    (void)context;
    (void)simulation;
    assert_true(n_heard < MOST);
    heard[n_heard++] = *what;
    return DEM_OK;
}

/* Strengths differ, so that the block does not break everywhere at once. */
static void open_block(support_run *run)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 0.2,
                                 .density = 1050.0,
                                 .thickness = 1.0};
    dem_options options = dem_options_default();
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.04, 0.08, 0.005, &rubber);
    assert_ok(dem_lattice_launch(&block, (const double[2]){0.0, 0.0}));
    for (dem_index i = 0; i < block.n_nodes; i++) block.velocity[2 * i + 1] = 250.0 * (block.x[2 * i + 1] - 0.04);
    block.strength = malloc((size_t)block.n_triangles * sizeof *block.strength);
    assert_non_null(block.strength);
    for (dem_index t = 0; t < block.n_triangles; t++)
        block.strength[t] = 8e5 * (1.0 + 0.5 * fmod((double)t * 0.6180339887498949, 1.0));
    options.rtol = 1e-6;
    support_open(run, &block, NULL, 0, &options);
}

static void watch(support_run *run, dem_trajectory *trajectory)
{
    const dem_observer own = SIZED(dem_observer, .broken = on_break);
    dem_observer theirs = {.struct_size = sizeof theirs};
    n_heard = 0;
    assert_ok(dem_trajectory_observer(trajectory, &theirs));
    assert_ok(dem_simulation_observe(run->simulation, &theirs));
    assert_ok(dem_simulation_observe(run->simulation, &own));
}

/* The whole run into a file: until 0.4 ms, then one triangle by the program, until 1 ms. */
static void write_run(bool breaks)
{
    const dem_index which[1] = {0};
    CLEANUP(support_close) support_run run;
    dem_trajectory *trajectory = NULL;
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = 2e-4, options.breaks = breaks, options.fields = DEM_FIELD_FRAGMENT;
    open_block(&run);
    assert_ok(dem_trajectory_create(&trajectory, path, run.simulation, &options));
    watch(&run, trajectory);
    (void)support_at(&run, 4e-4);
    assert_ok(dem_simulation_break(run.simulation, which, 1, NULL, 0));
    (void)support_at(&run, 1e-3);
    fracture = ask_fracture(run.simulation);
    assert_ok(dem_simulation_fragments(run.simulation, &fracture.fragments, fragment));
    assert_ok(dem_trajectory_finish(trajectory));
    dem_trajectory_destroy(trajectory);
}

/* The number at `offset` bytes of a break, real or whole. */
static double number_of(const dem_break *b, size_t offset, bool whole)
{
    double real;
    dem_index integer;
    memcpy(&real, (const char *)b + offset, sizeof real);
    memcpy(&integer, (const char *)b + offset, sizeof integer);
    return whole ? (double)integer : real;
}

static void expect(const dem_reader *reader, const char *name, const char *unit, size_t offset, dem_index components)
{
    static double values[3 * MOST];
    const dem_reader_column *column = dem_reader_column_find(reader, "breaks", name);
    const bool whole = strcmp(unit, "") == 0;
    if (column == NULL) fail_msg("there is no breaks/%s", name);
    assert_int_equal(column->n_rows, n_heard);
    assert_int_equal(column->components, components);
    assert_string_equal(column->unit, unit);
    assert_ok(dem_reader_read_column(reader, column, values));
    for (dem_index k = 0; k < n_heard; k++)
        for (dem_index c = 0; c < components; c++)
            assert_close(values[k * components + c], number_of(&heard[k], offset + (size_t)c * sizeof(double), whole),
                         0.0);
}

TEST(the_table_has_every_break)
{
    dem_reader *reader = NULL;
    write_run(true);
    assert_true(n_heard > 10);
    assert_ok(dem_reader_open(&reader, path));
    expect(reader, "t", "s", offsetof(dem_break, t), 1);
    expect(reader, "x", "m", offsetof(dem_break, x), 2);
    expect(reader, "stress", "Pa", offsetof(dem_break, stress), 3);
    expect(reader, "energy", "J", offsetof(dem_break, energy), 1);
    expect(reader, "body", "", offsetof(dem_break, body), 1);
    expect(reader, "triangle", "", offsetof(dem_break, triangle), 1);
    expect(reader, "spring", "", offsetof(dem_break, spring), 1);
    expect(reader, "fragment_new", "", offsetof(dem_break, fragment_new), 1);
    dem_reader_close(reader);
}

/* The last frame is at the end. */
TEST(frames_show_fragments)
{
    static double values[MOST];
    dem_reader *reader = NULL;
    dem_index n_frames;
    write_run(true);
    assert_true(fracture.fragments > 1);
    assert_ok(dem_reader_open(&reader, path));
    const dem_reader_array *array = dem_reader_array_find(reader, "fragment");
    const dem_index n = dem_reader_lattice(reader)->n_nodes;
    assert_non_null(array);
    assert_true(!array->of_springs && array->type == DEM_READER_I64 && !array->constant && n <= MOST);
    (void)dem_reader_times(reader, &n_frames);
    assert_int_equal(n_frames, 6);
    assert_ok(dem_reader_read(reader, array, 0, values));
    for (dem_index i = 0; i < n; i++) assert_close(values[i], 0.0, 0.0);
    assert_ok(dem_reader_read(reader, array, 5, values));
    for (dem_index i = 0; i < n; i++) assert_close(values[i], (double)fragment[i], 0.0);
    dem_reader_close(reader);
}

static void expect_last(const dem_reader *reader, const char *name, const char *unit, double expected)
{
    double value;
    const dem_reader_column *column = dem_reader_column_find(reader, "history", name);
    if (column == NULL) fail_msg("there is no history/%s", name);
    assert_string_equal(column->unit, unit);
    assert_ok(dem_reader_read_rows(reader, column, column->n_rows - 1, 1, &value));
    assert_close(value, expected, 0.0);
}

/* Nothing breaks in the step in which the run ends. */
TEST(the_history_knows_how_much_is_broken)
{
    dem_reader *reader = NULL;
    write_run(true);
    assert_true(fracture.triangles > 10 && fracture.springs > 1 && fracture.largest < 1.0);
    assert_ok(dem_reader_open(&reader, path));
    expect_last(reader, "broken_triangles", "", (double)fracture.triangles);
    expect_last(reader, "broken_springs", "", (double)fracture.springs);
    expect_last(reader, "fragments", "", (double)fracture.fragments);
    expect_last(reader, "largest_fragment", "1", fracture.largest);
    expect_last(reader, "debris", "1", fracture.debris);
    expect_last(reader, "median_fragment", "kg", fracture.median);
    expect_last(reader, "crack_length", "m", fracture.crack_length);
    dem_reader_close(reader);
}

TEST(without_the_option_there_is_no_table)
{
    dem_reader *reader = NULL;
    write_run(false);
    assert_true(n_heard > 10);
    assert_ok(dem_reader_open(&reader, path));
    assert_null(dem_reader_column_find(reader, "breaks", "t"));
    assert_null(dem_reader_column_find(reader, "history", "fragments"));
    dem_reader_close(reader);
}

/* The library's functions are called as the simulation would. */
TEST(breaks_reach_the_file_with_a_full_buffer)
{
    enum { FULL = 1024 };
    CLEANUP(support_close) support_run run;
    dem_trajectory *trajectory = NULL;
    dem_reader *reader = NULL;
    dem_trajectory_options options = dem_trajectory_options_default();
    dem_observer observer = {.struct_size = sizeof observer};
    options.frame_interval = 1.0, options.breaks = true;
    open_block(&run);
    assert_ok(dem_trajectory_create(&trajectory, path, run.simulation, &options));
    assert_ok(dem_trajectory_observer(trajectory, &observer));
    for (int k = 0; k <= FULL; k++)
        assert_ok(observer.broken(observer.context, run.simulation, &(dem_break){.t = k, .triangle = k}));
    assert_ok(dem_reader_open(&reader, part));
    assert_int_equal(dem_reader_column_find(reader, "breaks", "t")->n_rows, FULL);
    dem_reader_close(reader);
    assert_ok(dem_trajectory_finish(trajectory));
    assert_int_equal(observer.broken(observer.context, run.simulation, &(dem_break){.t = 1e9}), DEM_ERROR_ARGUMENT);
    assert_message_parts("is finished and takes no more breaks");
    dem_trajectory_destroy(trajectory);
    assert_ok(dem_reader_open(&reader, path));
    assert_int_equal(dem_reader_column_find(reader, "breaks", "t")->n_rows, FULL + 1);
    dem_reader_close(reader);
}

SCRATCH_GROUP({&path, "run.vtkhdf"}, {&part, "run.part.vtkhdf"}, {&beside, "run.body.vtkhdf"});
