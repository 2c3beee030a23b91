/* SPDX-License-Identifier: BSD-3-Clause */
/* fragment_table.c: what is in the table of fragments, against the motion of the whole and against closed forms, and
 * what the reader refuses of it. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "harness/cleanup_hdf5.h"
#include "harness/message.h"
#include "unit/scratch.h"

#include <dem/reader.h>
#include <dem/trajectory.h>

static const char *path, *part, *beside;

/* The state at the end of a run, which is that of its last frame. */
enum { MOST = 1024 };
static dem_index fragment[MOST], n_fragments;
static dem_energy energy;
static double x[2 * MOST], v[2 * MOST];

/* Runs a body with a frame every fifth of the time; frames are written as the options say. */
static void write_run(const dem_lattice *body, double t_end, bool fragments)
{
    CLEANUP(support_close) support_run run;
    dem_trajectory *trajectory = NULL;
    dem_trajectory_options what = dem_trajectory_options_default();
    dem_options options = dem_options_default();
    dem_observer observer = {.struct_size = sizeof observer};
    options.gravity[1] = 0.0, options.rtol = 1e-8;
    what.frame_interval = t_end / 5.0, what.fragments = fragments;
    support_open(&run, body, NULL, 0, &options);
    assert_ok(dem_trajectory_create(&trajectory, path, run.simulation, &what));
    assert_ok(dem_trajectory_observer(trajectory, &observer));
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    const motion s = support_at(&run, t_end);
    assert_true(body->n_nodes <= MOST);
    memcpy(x, s.x, 2 * (size_t)body->n_nodes * sizeof *x);
    memcpy(v, s.v, 2 * (size_t)body->n_nodes * sizeof *v);
    energy = s.energy;
    assert_ok(dem_simulation_fragments(run.simulation, &n_fragments, fragment));
    assert_ok(dem_trajectory_finish(trajectory));
    dem_trajectory_destroy(trajectory);
}

/* A block that is torn apart while it flies and turns; strengths differ, so that it does not break everywhere at
 * once. */
static void make_block(dem_lattice *block)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 0.2,
                                 .density = 1050.0,
                                 .thickness = 1.0};
    *block = support_rectangle(0.04, 0.08, 0.005, &rubber);
    assert_ok(dem_lattice_launch(block, (const double[2]){3.0, 1.0}));
    for (dem_index i = 0; i < block->n_nodes; i++) {
        block->velocity[2 * i + 1] += 250.0 * (block->x[2 * i + 1] - 0.04) + 40.0 * block->x[2 * i];
        block->velocity[2 * i] -= 40.0 * (block->x[2 * i + 1] - 0.04);
    }
    block->strength = malloc((size_t)block->n_triangles * sizeof *block->strength);
    assert_non_null(block->strength);
    for (dem_index t = 0; t < block->n_triangles; t++)
        block->strength[t] = 8e5 * (1.0 + 0.5 * fmod((double)t * 0.6180339887498949, 1.0));
}

/* ---- reading ---- */

/* The rows of a frame in a column, [count][components], to be freed. */
static double *column_of(const dem_reader *reader, const char *name, dem_index frame, dem_index *count)
{
    dem_index first;
    const dem_reader_column *column = dem_reader_column_find(reader, "fragments", name);
    if (column == NULL) fail_msg("there is no fragments/%s", name);
    assert_ok(dem_reader_fragments(reader, frame, &first, count));
    double *values = calloc((size_t)(*count * column->width) + 1, sizeof *values);
    assert_non_null(values);
    assert_ok(dem_reader_read_rows(reader, column, first, *count, values));
    return values;
}

/* All columns of a frame. */
typedef struct view {
    dem_index n;
    double *t, *id, *nodes, *mass, *x, *v, *spin, *kinetic[3], *size;
} view;

static view see(const dem_reader *reader, dem_index frame)
{
    view f;
    f.t = column_of(reader, "t", frame, &f.n);
    f.id = column_of(reader, "id", frame, &f.n);
    f.nodes = column_of(reader, "nodes", frame, &f.n);
    f.mass = column_of(reader, "mass", frame, &f.n);
    f.x = column_of(reader, "x", frame, &f.n);
    f.v = column_of(reader, "v", frame, &f.n);
    f.spin = column_of(reader, "angular_momentum", frame, &f.n);
    f.kinetic[0] = column_of(reader, "kinetic_centre", frame, &f.n);
    f.kinetic[1] = column_of(reader, "kinetic_spin", frame, &f.n);
    f.kinetic[2] = column_of(reader, "kinetic_internal", frame, &f.n);
    f.size = column_of(reader, "size", frame, &f.n);
    return f;
}

static void forget(view *f)
{
    double *const all[] = {f->t, f->id, f->nodes, f->mass, f->x, f->v, f->spin, f->size};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) free(all[k]);
    for (int k = 0; k < 3; k++) free(f->kinetic[k]);
}

/* ---- against the whole ---- */

/* Mass, momentum, angular momentum about the origin, kinetic energy of all nodes. */
static void sum_nodes(const dem_lattice *l, double sum[5])
{
    memset(sum, 0, 5 * sizeof *sum);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double m = l->mass[i], *p = &x[2 * i], *u = &v[2 * i];
        sum[0] += m;
        sum[1] += m * u[0];
        sum[2] += m * u[1];
        sum[3] += m * (p[0] * u[1] - p[1] * u[0]);
        sum[4] += 0.5 * m * (u[0] * u[0] + u[1] * u[1]);
    }
}

static void sum_rows(const view *f, double sum[5])
{
    memset(sum, 0, 5 * sizeof *sum);
    for (dem_index k = 0; k < f->n; k++) {
        const double m = f->mass[k], *p = &f->x[2 * k], *u = &f->v[2 * k];
        sum[0] += m;
        sum[1] += m * u[0];
        sum[2] += m * u[1];
        sum[3] += f->spin[k] + m * (p[0] * u[1] - p[1] * u[0]);
        sum[4] += f->kinetic[0][k] + f->kinetic[1][k] + f->kinetic[2][k];
    }
}

/* 1e-12 of what the largest terms are: 10 m/s and 0.1 m times the mass. */
TEST(sums_over_fragments_are_those_of_the_whole)
{
    double of_nodes[5], of_rows[5];
    dem_reader *reader = NULL;
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    make_block(&block);
    write_run(&block, 1e-3, true);
    assert_ok(dem_reader_open(&reader, path));
    view f = see(reader, 5);
    assert_true(n_fragments > 3);
    assert_int_equal(f.n, n_fragments);
    sum_nodes(&block, of_nodes);
    sum_rows(&f, of_rows);
    const double m = of_nodes[0], scale[5] = {m, 10.0 * m, 10.0 * m, m, energy.kinetic};
    for (int k = 0; k < 5; k++) assert_close(of_rows[k], of_nodes[k], 1e-12 * scale[k]);
    assert_close(of_rows[4], energy.kinetic, 1e-12 * energy.kinetic);
    forget(&f);
    dem_reader_close(reader);
}

/* Numbers of nodes, boxes and times, and the energies of every frame beside those of the frames' own table. */
TEST(rows_are_those_of_the_fragments_of_their_frame)
{
    dem_reader *reader = NULL;
    dem_index n_frames;
    double kinetic[6];
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    make_block(&block);
    write_run(&block, 1e-3, true);
    assert_ok(dem_reader_open(&reader, path));
    const double *times = dem_reader_times(reader, &n_frames);
    assert_int_equal(n_frames, 6);
    assert_ok(dem_reader_read_column(reader, dem_reader_column_find(reader, "frames", "kinetic_energy"), kinetic));
    for (dem_index frame = 0; frame < n_frames; frame++) {
        double sum[5];
        view f = see(reader, frame);
        sum_rows(&f, sum);
        assert_close(sum[4], kinetic[frame], 1e-12 * kinetic[frame]);
        for (dem_index k = 0; k < f.n; k++) assert_close(f.t[k], times[frame], 0.0);
        if (frame == 0) assert_int_equal(f.n, 1);
        forget(&f);
    }
    view f = see(reader, 5);
    for (dem_index k = 0; k < f.n; k++) {
        double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
        dem_index nodes = 0;
        for (dem_index i = 0; i < block.n_nodes; i++) {
            if (fragment[i] != (dem_index)f.id[k]) continue;
            nodes++;
            for (int d = 0; d < 2; d++) low[d] = fmin(low[d], x[2 * i + d]), high[d] = fmax(high[d], x[2 * i + d]);
        }
        assert_close(f.nodes[k], (double)nodes, 0.0);
        for (int d = 0; d < 2; d++) assert_close(f.size[2 * k + d], high[d] - low[d], 0.0);
        assert_true(k == 0 || f.id[k] > f.id[k - 1]);
    }
    forget(&f);
    dem_reader_close(reader);
}

/* Nodes of 2 and 3 kg at rest length 1 m, joined by a stiff spring, fly with (2, 1) m/s, turn with 4/s and part with
 * 0.5 m/s; the reduced mass is 6/5 kg. At t = 0 the energies are closed forms, to rounding. */
TEST(kinetic_energies_are_of_centre_spin_and_the_rest)
{
    const double at[4] = {0.0, 0.0, 1.0, 0.0}, masses[2] = {2.0, 3.0}, reduced = 6.0 / 5.0;
    const double speeds[4] = {2.0 - 0.5 * 0.6, 1.0 - 4.0 * 0.6, 2.0 + 0.5 * 0.4, 1.0 + 4.0 * 0.4};
    const dem_index ends[2] = {0, 1};
    dem_reader *reader = NULL;
    CLEANUP(dem_lattice_free) dem_lattice pair = support_lattice(2, at, masses, 1, ends, 1.0, 8.0, NULL);
    support_start(&pair, NULL, speeds);
    write_run(&pair, 1e-3, true);
    assert_ok(dem_reader_open(&reader, path));
    view f = see(reader, 0);
    assert_int_equal(f.n, 1);
    assert_close(f.x[0], 0.6, 1e-15);
    assert_close(f.v[0], 2.0, 1e-15);
    assert_close(f.v[1], 1.0, 1e-15);
    assert_close(f.spin[0], reduced * 4.0, 1e-14);
    assert_close(f.kinetic[0][0], 0.5 * 5.0 * 5.0, 1e-14);
    assert_close(f.kinetic[1][0], 0.5 * reduced * 16.0, 1e-14);
    assert_close(f.kinetic[2][0], 0.5 * reduced * 0.25, 1e-14);
    assert_close(f.size[0], 1.0, 0.0);
    assert_close(f.size[1], 0.0, 0.0);
    forget(&f);
    dem_reader_close(reader);
}

/* ---- what is not there, and what is refused ---- */

TEST(without_the_option_there_are_no_rows)
{
    dem_reader *reader = NULL;
    dem_index first = -1, count = -1;
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    make_block(&block);
    write_run(&block, 1e-4, false);
    assert_ok(dem_reader_open(&reader, path));
    assert_null(dem_reader_column_find(reader, "fragments", "id"));
    assert_ok(dem_reader_fragments(reader, 5, &first, &count));
    assert_int_equal(first, 0);
    assert_int_equal(count, 0);
    assert_int_equal(dem_reader_fragments(reader, 6, &first, &count), DEM_ERROR_ARGUMENT);
    assert_message_parts("has no frame 6: there are 6");
    dem_reader_close(reader);
}

/* Writes a dataset of one number a row anew, n of them. */
static void damage(const char *dataset, hsize_t n, const int64_t *numbers)
{
    CLEANUP(free_h5) const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    CLEANUP(free_h5) const hid_t id = H5Dopen2(file, dataset, H5P_DEFAULT);
    assert_true(H5Dset_extent(id, &n) >= 0);
    assert_true(H5Dwrite(id, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) >= 0);
}

static void assert_refused(const char *reason)
{
    dem_reader *reader = NULL;
    assert_int_equal(dem_reader_open(&reader, path), DEM_ERROR_IO);
    assert_message_parts(reason);
}

TEST(tables_that_are_damaged_are_refused)
{
    static const char name[] = "/fragments/frame_offset";
    const int64_t good[7] = {0, 1, 2, 3, 4, 5, 6}, falling[7] = {0, 1, 2, 1, 4, 5, 6},
                  below[7] = {-1, 1, 2, 3, 4, 5, 6};
    const int64_t far[7] = {0, 1, 2, 3, 4, 5, 7};
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    make_block(&block);
    write_run(&block, 1e-5, true); /* nothing breaks yet: a row in each of six frames */
    dem_reader *reader = NULL;
    damage(name, 7, good);
    assert_ok(dem_reader_open(&reader, path));
    dem_reader_close(reader);
    damage(name, 7, falling);
    assert_refused("frame_offset: is not ascending");
    damage(name, 7, below);
    assert_refused("frame_offset: is not ascending");
    damage(name, 7, far);
    assert_refused("columns of 6 rows, of 7 fragments");
    damage(name, 6, good);
    assert_refused("frame_offset: is not of shape");
    damage(name, 7, good);
    damage("/fragments/mass", 5, good);
    assert_refused("fragments");
}

SCRATCH_GROUP({&path, "run.vtkhdf"}, {&part, "run.part.vtkhdf"}, {&beside, "run.body.vtkhdf"});
