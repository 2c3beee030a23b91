/* SPDX-License-Identifier: BSD-3-Clause */
/* trajectory_rows.c: rows of every kind are counted, placed and copied; test_trajectory_parts.c has what becomes of
 * runs. */
#include "unit/output/stored.h"

#include <stdio.h>

#include "output/trajectory_rows.h"
#include "ask.h"
#include "unit/solids.h"

static const dem_probe probes[] = {{"node", DEM_PROBE_NODE, {0, 0}, 1}, {"gauge", DEM_PROBE_GAUGE, {0, 3}, 2}};
enum { n_kinds = ROWS_PROBES + 2 };

typedef struct shot {
    support_run run;
    stored stored;
    trajectory_rows rows;
} shot;

/* A block that flies, seen at its start: one frame, one row of all else but events, of which there are two. */
static shot *shoot(void)
{
    shot *s = calloc(1, sizeof *s);
    assert_non_null(s);
    const dem_options options = dem_options_default();
    const dem_event event = {.normal = {0.0, 1.0}, .other = -1};
    dem_lattice lattice = make_solid(0.03, 0.04, 0.01);
    dem_trajectory_options what = dem_trajectory_options_default();
    what.frame_interval = 1.0, what.events = 1, what.breaks = true, what.n_probes = 2, what.probes = probes;
    support_open(&s->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    stored_open(&s->stored);
    assert_ok(trajectory_rows_init(&s->rows, s->run.simulation, &what));
    assert_ok(trajectory_rows_create(&s->rows, &s->stored.file));
    assert_ok(history_record(&s->rows.history, s->run.simulation));
    break_table_record(&s->rows.breaks, &(dem_break){.spring = -1});
    for (int k = 0; k < 2; k++) {
        assert_ok(probe_record(&s->rows.probes[k], s->run.simulation));
        event_table_record(&s->rows.events, &event);
    }
    assert_ok(trajectory_rows_flush(&s->rows, &s->stored.file));
    assert_ok(frames_append(&s->rows.frames, &s->stored.file, s->run.simulation));
    s->rows.frames.n++;
    return s;
}

static void put_away(shot *s)
{
    stored_close(&s->stored);
    trajectory_rows_free(&s->rows);
    support_close(&s->run);
    free(s);
}

TEST(rows_are_those_of_the_file_and_of_files_before)
{
    static const hsize_t rows[n_kinds] = {1, 1, 2, 1, 1, 1};
    static const char *const names[n_kinds] = {"frames", "history", "events", "breaks", "node", "gauge"};
    shot *s = shoot();
    hdf5_span spans[n_kinds] = {{0, 0, 0}};
    assert_int_equal(s->rows.n_kinds, n_kinds);
    assert_ok(trajectory_rows_count(&s->rows, &s->stored.file, spans));
    assert_ok(trajectory_rows_verify(&s->rows, &s->stored.file, spans));
    for (int k = 0; k < n_kinds; k++) {
        assert_string_equal(trajectory_rows_name(&s->rows, k), names[k]);
        assert_int_equal(spans[k].count, rows[k]);
        assert_int_equal(trajectory_rows_written(&s->rows, k), rows[k]);
        assert_int_equal(trajectory_rows_total(&s->rows, k), rows[k]);
        trajectory_rows_place(&s->rows, k, 10 + (hsize_t)k, 5);
        assert_int_equal(trajectory_rows_written(&s->rows, k), 5);
        assert_int_equal(trajectory_rows_total(&s->rows, k), 15 + k);
        spans[k].count++;
        assert_int_equal(trajectory_rows_verify(&s->rows, &s->stored.file, spans), DEM_ERROR_IO);
        spans[k].count--;
    }
    put_away(s);
}

/* Twice the same rows, one behind the other: the second frame begins behind the first. */
TEST(rows_go_behind_those_that_are_there)
{
    shot *s = shoot();
    stored other;
    hdf5_span spans[n_kinds];
    stored_open(&other);
    assert_ok(trajectory_rows_create(&s->rows, &other.file));
    for (hsize_t copy = 0; copy < 2; copy++) {
        assert_ok(trajectory_rows_count(&s->rows, &s->stored.file, spans));
        for (int k = 0; k < n_kinds; k++) {
            spans[k].first = 0;
            spans[k].at = copy * spans[k].count;
        }
        assert_ok(trajectory_rows_copy(&s->rows, &s->stored.file, &other.file, spans));
    }
    assert_ok(trajectory_rows_count(&s->rows, &other.file, spans));
    for (int k = 0; k < n_kinds; k++) assert_int_equal(spans[k].count, k == ROWS_EVENTS ? 4 : 2);
    const hsize_t n = (hsize_t)ask_sizes(s->run.model).n_nodes;
    assert_close(stored_values(&other, "/VTKHDF/Steps/PointOffsets", 2, 1, 8)[1], (double)n, 0.0);
    const double *points = stored_values(&other, "/VTKHDF/Points", 2 * n, 3, 8);
    for (hsize_t k = 0; k < 3 * n; k++) assert_close(points[3 * n + k], points[k], 0.0);
    stored_close(&other);
    put_away(s);
}
