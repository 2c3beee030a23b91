/* SPDX-License-Identifier: BSD-3-Clause */
/* obstacle_file.c: two obstacles of different laws, looked at through HDF5 itself. */
#include "verification/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <unistd.h>

#include "output/hdf5_attribute.h"
#include "output/obstacle_file.h"
#include "unit/output/found.h"
#include "ask.h"
#include "unit/scratch.h"

static const double bent[6] = {-1.0, 0.0, 0.0, -0.5, 1.0, 0.0}, flat[4] = {3.0, -2.0, 4.0, -2.0};
static const char *path, *part;

static dem_model *make_model(void)
{
    const double x[2] = {0.0, 1.0}, mass = 1.0;
    const dem_obstacle obstacles[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = bent, .restitution = 0.5, .friction = 0.3},
        SIZED(dem_obstacle, .n_points = 2, .points = flat, .restitution = 0.25, .friction = 0.75,
              .friction_law = DEM_FRICTION_PAPER, .velocity = {1.5, -2.0})};
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    dem_model *model = support_model(&lattice, obstacles, 2);
    return model;
}

static void expect_number(const hdf5_file *file, const char *group, const char *name, double expected)
{
    double value = NAN;
    const hid_t id = H5Aopen_by_name(file->id, group, name, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(id >= 0 && H5Aread(id, H5T_NATIVE_DOUBLE, &value) >= 0);
    (void)H5Aclose(id);
    assert_close(value, expected, 0.0);
}

TEST(the_group_has_points_and_laws)
{
    CLEANUP(free_model) dem_model *model = make_model();
    hdf5_file file;
    assert_ok(hdf5_open_new(&file, path, 4096));
    assert_ok(obstacle_file_write(&file, model));
    found_reals(&file, "/obstacles/0/points", bent, 6);
    found_reals(&file, "/obstacles/1/points", flat, 4);
    expect_number(&file, "/obstacles/0", "restitution", 0.5);
    expect_number(&file, "/obstacles/1", "restitution", 0.25);
    expect_number(&file, "/obstacles/0", "friction", 0.3);
    expect_number(&file, "/obstacles/1", "friction", 0.75);
    found_text(&file, "/obstacles/0", "friction_law", "coulomb");
    found_text(&file, "/obstacles/1", "friction_law", "paper");
    found_reals(&file, "/obstacles/1/velocity", (const double[2]){1.5, -2.0}, 2);
    assert_true(H5Lexists(file.id, "/obstacles/0/velocity", H5P_DEFAULT) == 0); /* it is at rest */
    assert_ok(hdf5_close(&file, DEM_OK));
}

TEST(they_are_read_back)
{
    CLEANUP(free_model) dem_model *model = make_model();
    hdf5_file file;
    dem_obstacle *found = NULL;
    dem_index n = 0;
    assert_ok(hdf5_open_new(&file, path, 4096));
    assert_ok(obstacle_file_write(&file, model));
    assert_ok(obstacle_file_read(&file, &found, &n));
    assert_int_equal(n, ask_sizes(model).n_obstacles);
    for (dem_index o = 0; o < n; o++) {
        const dem_obstacle *given = dem_model_obstacle(model, o);
        assert_int_equal(found[o].n_points, given->n_points);
        assert_memory_equal(found[o].points, given->points, 2 * (size_t)found[o].n_points * sizeof(double));
        assert_close(found[o].restitution, given->restitution, 0.0);
        assert_memory_equal(found[o].velocity, given->velocity, sizeof found[o].velocity);
        assert_close(found[o].friction, given->friction, 0.0);
        assert_int_equal(found[o].friction_law, given->friction_law);
    }
    obstacle_file_free(found, n);
    assert_ok(hdf5_close(&file, DEM_OK));
}

TEST(what_is_no_obstacle_is_refused)
{
    CLEANUP(free_model) dem_model *model = make_model();
    hdf5_file file;
    dem_obstacle *found = NULL;
    dem_index n = 7;
    assert_ok(hdf5_open_new(&file, path, 4096));
    assert_ok(obstacle_file_write(&file, model));
    assert_true(H5Adelete_by_name(file.id, "/obstacles/1", "friction_law", H5P_DEFAULT) >= 0);
    assert_ok(hdf5_write_attribute_text(&file, "/obstacles/1", "friction_law", "dry"));
    assert_int_equal(obstacle_file_read(&file, &found, &n), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "/obstacles/1: friction_law is neither coulomb nor paper"));
    assert_int_equal(n, 7);
    assert_null(found);
    assert_ok(hdf5_close(&file, DEM_OK));
}

TEST(the_file_has_them_as_lines)
{
    const double points[15] = {-1.0, 0.0, 0.0, 0.0, -0.5, 0.0, 1.0, 0.0, 0.0, 3.0, -2.0, 0.0, 4.0, -2.0, 0.0};
    CLEANUP(free_model) dem_model *model = make_model();
    hdf5_file file;
    assert_ok(obstacle_file_publish(part, path, model, (obstacle_file_times){0, NULL}, 1));
    assert_int_not_equal(access(part, F_OK), 0);
    assert_ok(hdf5_open_read(&file, path));
    found_reals(&file, "/VTKHDF/Points", points, 15);
    found_reals(&file, "/VTKHDF/Connectivity", (const double[]){0, 1, 1, 2, 3, 4}, 6);
    found_reals(&file, "/VTKHDF/CellData/obstacle", (const double[]){0, 0, 1}, 3);
    assert_ok(hdf5_close(&file, DEM_OK));
}

/* The second obstacle moves with (1.5, -2) m/s. */
TEST(with_times_the_file_has_steps_with_points_of_their_own)
{
    const double times[2] = {0.5, 2.0};
    const double points[30] = {-1.0, 0.0, 0.0, 0.0, -0.5, 0.0, 1.0, 0.0, 0.0, 3.75, -3.0, 0.0, 4.75, -3.0, 0.0,
                               -1.0, 0.0, 0.0, 0.0, -0.5, 0.0, 1.0, 0.0, 0.0, 6.0,  -6.0, 0.0, 7.0,  -6.0, 0.0};
    CLEANUP(free_model) dem_model *model = make_model();
    hdf5_file file;
    assert_true(obstacle_file_moves(model));
    assert_ok(obstacle_file_publish(part, path, model, (obstacle_file_times){2, times}, 1));
    assert_ok(hdf5_open_read(&file, path));
    found_reals(&file, "/VTKHDF/Points", points, 30);
    found_reals(&file, "/VTKHDF/Connectivity", (const double[]){0, 1, 1, 2, 3, 4}, 6);
    found_reals(&file, "/VTKHDF/Steps/Values", times, 2);
    found_reals(&file, "/VTKHDF/Steps/PointOffsets", (const double[]){0, 5}, 2);
    found_reals(&file, "/VTKHDF/Steps/NumberOfParts", (const double[]){1, 1}, 2);
    found_reals(&file, "/VTKHDF/Steps/CellDataOffsets/obstacle", (const double[]){0, 0}, 2);
    assert_ok(hdf5_close(&file, DEM_OK));
}

TEST(a_part_that_cannot_be_published_is_taken_away)
{
    CLEANUP(free_model) dem_model *model = make_model();
    assert_int_equal(obstacle_file_publish(part, "no/such/folder/a.h5", model, (obstacle_file_times){0, NULL}, 1),
                     DEM_ERROR_IO);
    assert_int_not_equal(access(part, F_OK), 0);
}

SCRATCH_GROUP({&path, "a.h5"}, {&part, "a.part.h5"});
