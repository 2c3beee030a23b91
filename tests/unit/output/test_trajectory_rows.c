/* SPDX-License-Identifier: BSD-3-Clause */
/* trajectory_rows.c: rows of every kind are counted, placed and copied; test_trajectory_parts.c has what becomes of
 * runs. */
#include "unit/stored.h"

#include <stdio.h>

#include "output/trajectory_rows.h"
#include "unit/solids.h"

static const dem_probe probes[] = {{"node", DEM_PROBE_NODE, {0, 0}, 1}, {"gauge", DEM_PROBE_GAUGE, {0, 3}, 2}};
enum { n_kinds = REEL_PROBES + 2 };

typedef struct shot {
    support_run run;
    stored stored;
    reel reel;
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
    what.frame_interval = 1.0, what.events = 1, what.n_probes = 2, what.probes = probes;
    support_open(&s->run, &lattice, NULL, 0, &options);
    dem_lattice_free(&lattice);
    stored_open(&s->stored);
    assert_ok(reel_init(&s->reel, s->run.simulation, &what));
    assert_ok(reel_create(&s->reel, &s->stored.file));
    history_record(&s->reel.history, s->run.simulation);
    for (int k = 0; k < 2; k++) {
        probe_record(&s->reel.probes[k], s->run.simulation);
        events_record(&s->reel.events, &event);
    }
    assert_ok(reel_flush(&s->reel, &s->stored.file));
    assert_ok(frames_append(&s->reel.frames, &s->stored.file, s->run.simulation));
    s->reel.frames.n++;
    return s;
}

static void put_away(shot *s)
{
    stored_close(&s->stored);
    reel_free(&s->reel);
    support_close(&s->run);
    free(s);
}

static void rows_are_those_of_the_file_and_of_files_before(void **state)
{
    (void)state;
    static const hsize_t rows[n_kinds] = {1, 1, 2, 1, 1};
    static const char *const names[n_kinds] = {"frames", "history", "events", "node", "gauge"};
    shot *s = shoot();
    hdf5_span spans[n_kinds] = {{0, 0, 0}};
    assert_int_equal(s->reel.n_kinds, n_kinds);
    assert_ok(reel_count(&s->reel, &s->stored.file, spans));
    assert_ok(reel_verify(&s->reel, &s->stored.file, spans));
    for (int k = 0; k < n_kinds; k++) {
        assert_string_equal(reel_name(&s->reel, k), names[k]);
        assert_int_equal(spans[k].count, rows[k]);
        assert_int_equal(reel_written(&s->reel, k), rows[k]);
        assert_int_equal(reel_total(&s->reel, k), rows[k]);
        reel_place(&s->reel, k, 10 + (hsize_t)k, 5);
        assert_int_equal(reel_written(&s->reel, k), 5);
        assert_int_equal(reel_total(&s->reel, k), 15 + k);
        spans[k].count++;
        assert_int_equal(reel_verify(&s->reel, &s->stored.file, spans), DEM_ERROR_IO);
        spans[k].count--;
    }
    put_away(s);
}

/* Twice the same rows, one behind the other: the second frame begins behind the first. */
static void rows_go_behind_those_that_are_there(void **state)
{
    (void)state;
    shot *s = shoot();
    stored other;
    hdf5_span spans[n_kinds];
    stored_open(&other);
    assert_ok(reel_create(&s->reel, &other.file));
    for (hsize_t copy = 0; copy < 2; copy++) {
        assert_ok(reel_count(&s->reel, &s->stored.file, spans));
        for (int k = 0; k < n_kinds; k++) {
            spans[k].first = 0;
            spans[k].at = copy * spans[k].count;
        }
        assert_ok(reel_copy(&s->reel, &s->stored.file, &other.file, spans));
    }
    assert_ok(reel_count(&s->reel, &other.file, spans));
    for (int k = 0; k < n_kinds; k++) assert_int_equal(spans[k].count, k == REEL_EVENTS ? 4 : 2);
    const hsize_t n = (hsize_t)dem_model_sizes(s->run.model).n_nodes;
    assert_close(stored_values(&other, "/VTKHDF/Steps/PointOffsets", 2, 1, 8)[1], (double)n, 0.0);
    const double *points = stored_values(&other, "/VTKHDF/Points", 2 * n, 3, 8);
    for (hsize_t k = 0; k < 3 * n; k++) assert_close(points[3 * n + k], points[k], 0.0);
    stored_close(&other);
    put_away(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_those_of_the_file_and_of_files_before),
        cmocka_unit_test(rows_go_behind_those_that_are_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
