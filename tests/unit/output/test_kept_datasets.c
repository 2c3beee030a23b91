/* SPDX-License-Identifier: BSD-3-Clause */
/* kept_datasets.c: which datasets are open is asked of HDF5. */
#include "verification/support.h"

#include <stdio.h>
#include <string.h>

#include <unistd.h>

#include "harness/cleanup_hdf5.h"
#include "output/hdf5_rows.h"
#include "output/kept_datasets.h"
#include "unit/scratch.h"

static const char *path;

/* A file of n empty datasets /0, /1, ... */
static hdf5_file begin(int n)
{
    hdf5_file file;
    assert_ok(hdf5_open_new(&file, path, 0));
    for (int k = 0; k < n; k++) {
        char name[16];
        (void)snprintf(name, sizeof name, "/%d", k);
        const hdf5_rows rows = {name, HDF5_F64, 1, {0, 0}, 1, 0};
        assert_ok(hdf5_create(&file, &rows));
    }
    return file;
}

static void expect_open(const hdf5_file *file, int n)
{
    assert_int_equal(H5Fget_obj_count(file->id, H5F_OBJ_DATASET), n);
}

TEST_WITH(a_kept_dataset_is_opened_once_and_closed_in_the_end, NULL, scratch_sweep)
{
    hdf5_file file = begin(2);
    kept_datasets *kept = kept_datasets_create();
    assert_non_null(kept);
    const hid_t first = kept_datasets_open(kept, file.id, "/0"), second = kept_datasets_open(kept, file.id, "/1");
    assert_true(first >= 0 && second >= 0 && first != second);
    assert_true(kept_datasets_leave(kept, first) >= 0);
    assert_int_equal(kept_datasets_open(kept, file.id, "/1"), second);
    assert_int_equal(kept_datasets_open(kept, file.id, "/0"), first);
    expect_open(&file, 2);
    assert_true(kept_datasets_close(kept) >= 0);
    expect_open(&file, 0);
    assert_ok(hdf5_close(&file, DEM_OK));
}

TEST_WITH(without_a_list_a_dataset_is_closed_where_it_is_left, NULL, scratch_sweep)
{
    hdf5_file file = begin(1);
    const hid_t dataset = kept_datasets_open(NULL, file.id, "/0");
    assert_true(dataset >= 0);
    assert_true(kept_datasets_leave(NULL, dataset) >= 0);
    expect_open(&file, 0);
    assert_true(kept_datasets_open(NULL, file.id, "/none") < 0);
    assert_ok(hdf5_close(&file, DEM_OK));
}

/* More than the list takes: 256. */
TEST_WITH(what_does_not_fit_is_closed_where_it_is_left, NULL, scratch_sweep)
{
    enum { N = 300, KEPT = 256 };
    hdf5_file file = begin(N);
    kept_datasets *kept = kept_datasets_create();
    for (int turn = 0; turn < 2; turn++)
        for (int k = 0; k < N; k++) {
            char name[16];
            (void)snprintf(name, sizeof name, "/%d", k);
            const hid_t dataset = kept_datasets_open(kept, file.id, name);
            assert_true(dataset >= 0 && kept_datasets_leave(kept, dataset) >= 0);
        }
    expect_open(&file, KEPT);
    assert_true(kept_datasets_close(kept) >= 0);
    assert_ok(hdf5_close(&file, DEM_OK));
}

SCRATCH_GROUP({&path, "a.h5"});
