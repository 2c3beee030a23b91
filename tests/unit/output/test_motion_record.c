/* SPDX-License-Identifier: BSD-3-Clause */
/* motion_record.c: an obstacle that a function moves, read back from the trajectory of its run. */
#include "verification/support.h"

#include <stdlib.h>

#include <dem/reader.h>

#include "output/motion_record.h"
#include "unit/scratch.h"

static const double points[4] = {-1.0, 0.0, 1.0, 0.0}, other[4] = {-1.0, -9.0, 1.0, -9.0};
static const double step = 0.01, interval = 0.05;

static dem_status swing(void *context, double t, dem_pose *pose)
{
    const double *amplitude = context;
    pose->place[0] = 0.5;
    pose->place[1] = *amplitude * sin(t);
    pose->velocity[1] = *amplitude * cos(t);
    pose->acceleration[1] = -*amplitude * sin(t);
    pose->angle = 0.2 * t;
    pose->spin = 0.2;
    return DEM_OK;
}

/* A point that falls beside a resting obstacle and one that swings, for 1 s. */
static void write_run(const char *path, double *amplitude)
{
    const double x[2] = {5.0, 5.0}, mass = 1.0;
    const dem_obstacle obstacles[2] = {SIZED(dem_obstacle, .n_points = 2, .points = other),
                                       SIZED(dem_obstacle, .n_points = 2, .points = points, .motion = swing,
                                             .motion_context = amplitude, .most_speed = 1.0, .most_acceleration = 1.5,
                                             .longest_step = 0.5)};
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    CLEANUP(support_close) support_run run;
    dem_options options = support_options();
    options.spacing = options.v_scale = 1.0;
    options.max_step = step;
    support_open(&run, &lattice, obstacles, 2, &options);
    dem_trajectory_options how = dem_trajectory_options_default();
    how.frame_interval = interval;
    dem_trajectory *trajectory = NULL;
    dem_observer observer = {.struct_size = sizeof observer};
    assert_ok(dem_trajectory_create(&trajectory, path, run.simulation, &how));
    assert_ok(dem_trajectory_observer(trajectory, &observer));
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    assert_ok(dem_simulation_advance(run.simulation, 1.0));
    assert_ok(dem_trajectory_finish(trajectory));
    dem_trajectory_destroy(trajectory);
}

/* On the straight line between rows a step apart: off by step^2/8 of the acceleration, 1.2e-5 of the amplitude. */
TEST(a_motion_by_a_function_is_drawn_from_the_history)
{
    scratch_folder folder;
    double amplitude = 0.25;
    folder_open(&folder);
    const char *path = folder_file(&folder, "run.vtkhdf");
    (void)folder_file(&folder, "run.obstacle.vtkhdf");
    (void)folder_file(&folder, "run.body.vtkhdf");
    write_run(path, &amplitude);
    dem_reader *reader = NULL;
    assert_ok(dem_reader_open(&reader, path));
    const dem_obstacle *rest = dem_reader_obstacle(reader, 0), *moved = dem_reader_obstacle(reader, 1);
    assert_true(!dem_obstacle_moves(rest, NULL) && dem_obstacle_moves(moved, NULL));
    assert_true(moved->most_speed == 1.0 && moved->most_acceleration == 1.5 && moved->longest_step == 0.5);
    for (double t = 0.0; t < 1.0; t += 0.0437) {
        double found[4];
        assert_ok(dem_obstacle_points(moved, t, found));
        for (int k = 0; k < 2; k++) {
            const double x = points[2 * k];
            assert_close(found[2 * k], 0.5 + cos(0.2 * t) * x, 1e-6);
            assert_close(found[2 * k + 1], amplitude * sin(t) + sin(0.2 * t) * x, 4e-6);
        }
    }
    dem_reader_close(reader);
    folder_close(&folder);
}

TEST(beyond_its_rows_a_motion_stays_and_without_any_it_rests)
{
    double t[2] = {1.0, 2.0}, place[4] = {0.0, 1.0, 2.0, 5.0}, angle[2] = {0.0, 0.5};
    motion_record r = {2, t, place, angle}, none = {0, NULL, NULL, NULL};
    dem_pose before = {0}, within = {0}, after = {0}, rest = {0};
    assert_int_equal(motion_record_pose(&r, 0.5, &before), DEM_OK);
    assert_int_equal(motion_record_pose(&r, 1.25, &within), DEM_OK);
    assert_int_equal(motion_record_pose(&r, 9.0, &after), DEM_OK);
    assert_int_equal(motion_record_pose(&none, 1.0, &rest), DEM_OK);
    assert_true(before.place[1] == 1.0 && within.place[0] == 0.5 && within.place[1] == 2.0 && within.angle == 0.125);
    assert_true(after.place[0] == 2.0 && after.place[1] == 5.0 && after.angle == 0.5 && rest.place[0] == 0.0);
}
