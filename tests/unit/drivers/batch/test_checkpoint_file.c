/* SPDX-License-Identifier: BSD-3-Clause */
/* checkpoint.c: what a later run may go on from. What runs write, tests/deck/test_resume.py looks at. */
#include "verification/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "checkpoint_file.h"
#include "preview.h"
#include "unit/scratch.h"
#include "wall_clock.h"

static const char *output, *path, *before, *damaged;

static char course[] = "&run\n    gravity = 0, -9.81\n/\n&material\n    density = 1000\n/\n";
static const deck mine = {.course = course, .t_end = 2.0};

static void leave(const char *text, const char *lineage, double t)
{
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint;
    assert_ok(dem_checkpoint_create(&checkpoint));
    assert_ok(dem_checkpoint_put(checkpoint, "driver.course", text, strlen(text) + 1));
    assert_ok(dem_checkpoint_put(checkpoint, "driver.lineage", lineage, strlen(lineage) + 1));
    assert_ok(dem_checkpoint_put(checkpoint, "driver.time", &t, sizeof t));
    assert_ok(dem_checkpoint_write(checkpoint, path));
}

static const char *versions(void)
{
    static char text[256];
    preview_versions(text, sizeof text);
    return text;
}

static void expect(checkpoint_state expected, bool anyway, const char *why)
{
    CLEANUP(checkpoint_file_source_free) checkpoint_source source;
    char reason[OUTPUT_REASON] = "";
    assert_int_equal(checkpoint_file_find(&source, output, &mine, anyway, reason), expected);
    if (strstr(reason, why) == NULL) fail_msg("'%s' is not in '%s'", why, reason);
}

TEST_WITH(none_is_found_where_there_is_none, NULL, scratch_sweep)
{
    expect(CHECKPOINT_NONE, false, "");
}

TEST_WITH(that_of_the_same_course_is_found, NULL, scratch_sweep)
{
    checkpoint_source source;
    char reason[OUTPUT_REASON];
    leave(course, versions(), 1.5);
    assert_int_equal(checkpoint_file_find(&source, output, &mine, false, reason), CHECKPOINT_FOUND);
    assert_non_null(source.checkpoint);
    assert_close(source.t, 1.5, 0.0);
    assert_string_equal(source.lineage, versions());
    checkpoint_file_source_free(&source);
    assert_null(source.checkpoint);
    leave(course, versions(), 2.0);
    expect(CHECKPOINT_FOUND, false, "");
    leave(course, versions(), 2.5);
    expect(CHECKPOINT_OTHER, false, "the run is at 2.5 s already, beyond t_end = 2 s");
}

TEST_WITH(the_first_difference_is_named, NULL, scratch_sweep)
{
    leave("&run\n    gravity = 0, -9.81\n/\n&material\n    density = 1001\n/\n", versions(), 1.0);
    expect(CHECKPOINT_OTHER, true, "it is of has density = 1001 in &material, this one has density = 1000; move");
    leave("&run\n    gravity = 0, -9.81\n/\n", versions(), 1.0);
    expect(CHECKPOINT_OTHER, false, "has nothing in &run, this one has &material");
    leave("&run\n    gravity = 0, -9.81\n/\n&material\n    density = 1000\n/\n&body\n/\n", versions(), 1.0);
    expect(CHECKPOINT_OTHER, false, "has &body in &material, this one has nothing");
}

TEST_WITH(another_version_is_refused_unless_it_will_do, NULL, scratch_sweep)
{
    CLEANUP(checkpoint_file_source_free) checkpoint_source source;
    char reason[OUTPUT_REASON], lineage[512];
    leave(course, "dem 0.0.1\ndem 0.0.2", 1.0);
    expect(CHECKPOINT_OTHER, false, "it is of 'dem 0.0.2', this is 'dem ");
    assert_int_equal(checkpoint_file_find(&source, output, &mine, true, reason), CHECKPOINT_FOUND);
    (void)snprintf(lineage, sizeof lineage, "dem 0.0.1\ndem 0.0.2\n%s", versions());
    assert_string_equal(source.lineage, lineage);
    leave(course, source.lineage, 1.0);
    expect(CHECKPOINT_FOUND, false, "");
}

TEST_WITH(a_damaged_one_gives_way_to_the_one_before, NULL, scratch_sweep)
{
    CLEANUP(checkpoint_file_source_free) checkpoint_source source;
    char reason[OUTPUT_REASON];
    leave(course, versions(), 1.0);
    leave(course, versions(), 1.5);
    assert_int_equal(truncate(path, 100), 0);
    assert_int_equal(checkpoint_file_find(&source, output, &mine, false, reason), CHECKPOINT_FOUND);
    assert_close(source.t, 1.0, 0.0);
    assert_int_equal(access(before, F_OK), 0);
    assert_int_equal(rename(damaged, path), 0); /* where a new one cannot push it in the place of the one before */
    assert_int_equal(truncate(before, 100), 0);
    expect(CHECKPOINT_DAMAGED, false, "a.checkpoint");
    assert_int_equal(access(path, F_OK), 0);
    assert_int_equal(unlink(path), 0);
    leave(course, versions(), 1.0);
    assert_int_equal(rename(path, before), 0); /* as when the machine stopped between the two renames */
    expect(CHECKPOINT_FOUND, false, "");
}

TEST_WITH(a_checkpoint_of_another_program_is_refused, NULL, scratch_sweep)
{
    dem_checkpoint *checkpoint;
    assert_ok(dem_checkpoint_create(&checkpoint));
    assert_ok(dem_checkpoint_put(checkpoint, "driver.course", course, 5)); /* without its end */
    assert_ok(dem_checkpoint_write(checkpoint, path));
    dem_checkpoint_destroy(checkpoint);
    expect(CHECKPOINT_OTHER, true, "it is not of this program");
}

/* Before and after the call the clock is read: the time between the two is all that is not known. */
TEST_WITH(the_first_is_due_after_30_seconds_at_the_latest, NULL, scratch_sweep)
{
    static const double interval[2] = {600.0, 2.5}, expected[2] = {30.0, 2.5};
    const checkpoint_source source = {0};
    const host nobody = {0};
    for (int k = 0; k < 2; k++) {
        const command c = {.host = &nobody, .checkpoint_interval = interval[k]};
        const double earliest = wall_clock();
        const checkpoint_file started = checkpoint_file_start(&c, output, &mine, &source);
        const double latest = wall_clock();
        assert_true(started.wall_next >= earliest + expected[k] && started.wall_next <= latest + expected[k]);
        assert_close(started.interval, interval[k], 0.0);
    }
}

SCRATCH_GROUP({&output, "a.vtkhdf"}, {&path, "a.checkpoint"}, {&before, "a.checkpoint.prev"},
              {&damaged, "a.checkpoint.damaged"});
