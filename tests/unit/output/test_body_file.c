/* SPDX-License-Identifier: BSD-3-Clause */
/* body_file.c: where it leads, looked at through HDF5 itself; test_trajectory.c has that of a run. */
#include "verification/support.h"

#include <unistd.h>

#include "output/body_file.h"
#include "output/frames.h"
#include "output/hdf5_rows.h"
#include "unit/output/found.h"
#include "unit/scratch.h"

/* A file that has something in the group of triangles. */
static void write_run(const char *path)
{
    hdf5_file file;
    assert_ok(hdf5_open_new(&file, path, 4096));
    const hdf5_rows rows = {FRAMES_BODIES "/Types", HDF5_F64, 1, {0}, 0, 0};
    assert_ok(hdf5_write(&file, rows, 2, (const double[]){5.0, 5.0}));
    assert_ok(hdf5_close(&file, DEM_OK));
}

static void expect_types(const char *path)
{
    hdf5_file file;
    assert_ok(hdf5_open_read(&file, path));
    found_reals(&file, "/VTKHDF/Types", (const double[]){5.0, 5.0}, 2);
    assert_ok(hdf5_close(&file, DEM_OK));
}

/* Wherever the two of them are. */
TEST(it_leads_to_the_triangles_of_the_file_beside_it)
{
    scratch_folder one, other;
    folder_open(&one);
    folder_open(&other);
    const char *run = folder_file(&one, "a.vtkhdf"), *body = folder_file(&one, "a.body.vtkhdf");
    const char *run_moved = folder_file(&other, "a.vtkhdf"), *moved = folder_file(&other, "a.body.vtkhdf");
    write_run(run);
    assert_ok(body_file_publish(folder_at(&one, "a.body.part.vtkhdf"), body, run));
    expect_types(body);
    assert_int_equal(rename(run, run_moved), 0);
    assert_int_equal(rename(body, moved), 0);
    expect_types(moved);
    folder_close(&one);
    folder_close(&other);
}

/* As it is for a moment at the end of a run. */
TEST(the_file_beside_it_need_not_be_there)
{
    scratch_folder folder;
    folder_open(&folder);
    const char *body = folder_file(&folder, "a.body.vtkhdf");
    assert_ok(body_file_publish(folder_at(&folder, "a.body.part.vtkhdf"), body, "a.vtkhdf"));
    write_run(folder_file(&folder, "a.vtkhdf"));
    expect_types(body);
    folder_close(&folder);
}

/* The folder checks that it is empty. */
TEST(what_cannot_be_published_leaves_nothing)
{
    scratch_folder folder;
    folder_open(&folder);
    const char *part = folder_at(&folder, "a.part.vtkhdf"), *none = folder_at(&folder, "none/a.vtkhdf");
    assert_int_equal(body_file_publish(part, none, "a.vtkhdf"), DEM_ERROR_IO);
    assert_int_equal(body_file_publish(none, part, "a.vtkhdf"), DEM_ERROR_IO);
    folder_close(&folder);
}
