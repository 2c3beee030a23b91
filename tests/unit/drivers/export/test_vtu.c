/* SPDX-License-Identifier: BSD-3-Clause */
/* vtu.c: which files there are, and the series. Their numbers are read by VTK in tests/deck/test_export.py. */
#include "unit/drivers/export/exported.h"

#include "vtu.h"

TEST(there_is_a_file_for_each_frame_and_the_series)
{
    CLEANUP(exported_close) exported e;
    exported_open(&e, exported_usual());
    e.task.frames.n = 2;
    e.task.frames.frame[0] = 2, e.task.frames.frame[1] = 0;
    assert_true(vtu_export(&e.task));
    assert_true(exported_has(&e, "run_0000.vtu") && exported_has(&e, "run_0002.vtu"));
    assert_false(exported_has(&e, "run_0001.vtu"));
    exported_expect(&e, "run.pvd",
                    "<Collection>\n<DataSet timestep=\"0.5\" part=\"0\" file=\"run_0002.vtu\"/>\n"
                    "<DataSet timestep=\"0\" part=\"0\" file=\"run_0000.vtu\"/>\n</Collection>\n");
    exported_expect(&e, "run_0002.vtu", "<Piece NumberOfPoints=\"3\" NumberOfCells=\"3\">");
    exported_expect(&e, "run.obstacle.vtu", "<Piece NumberOfPoints=\"3\" NumberOfCells=\"2\">");
}

TEST(without_obstacles_there_is_no_file_of_them)
{
    CLEANUP(exported_close) exported e;
    exported_how how = exported_usual();
    how.n_obstacles = 0;
    exported_open(&e, how);
    assert_true(vtu_export(&e.task));
    assert_false(exported_has(&e, "run.obstacle.vtu"));
}

static dem_status lost(void *context, double t, dem_pose *pose)
{
    (void)context, (void)t;
    pose->angle = (double)NAN;
    return DEM_OK;
}

/* As of a run whose record of a motion is damaged. */
TEST(an_obstacle_without_a_place_is_an_error)
{
    CLEANUP(exported_close) exported e;
    exported_open(&e, exported_usual());
    dem_obstacle *moved = (dem_obstacle *)(uintptr_t)dem_reader_obstacle(e.task.reader, 0);
    moved->motion = lost, moved->most_speed = moved->most_acceleration = 1.0;
    assert_false(vtu_export(&e.task));
    assert_non_null(strstr(e.outcome.message, "is not finite"));
}

TEST(files_in_the_way_stop_it_before_it_begins)
{
    CLEANUP(exported_close) exported e;
    exported_open(&e, exported_usual());
    exported_put(&e, "run_0002.vtu", "mine");
    assert_false(vtu_export(&e.task));
    assert_int_equal(e.outcome.code, EXIT_TAKEN);
    assert_false(exported_has(&e, "run_0000.vtu"));
}

TEST(a_run_without_frames_has_no_series)
{
    CLEANUP(exported_close) exported e;
    exported_how how = exported_usual();
    how.frame_interval = 0.0;
    exported_open(&e, how);
    assert_false(vtu_export(&e.task));
    assert_int_equal(e.outcome.code, EXIT_INVALID);
}
