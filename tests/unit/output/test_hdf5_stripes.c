/* SPDX-License-Identifier: BSD-3-Clause */
/* hdf5_stripes.c, and what hdf5_rows.c and hdf5_untrusted.c make of it: rows that stand in other files are found there,
 * and nowhere else. */
#include "unit/output/stored.h"

#include <math.h>

#include "output/hdf5_rows.h"
#include "output/hdf5_untrusted.h"

#define REFUSED(call, reason)                                                                                          \
    do {                                                                                                               \
        assert_int_equal((call), DEM_ERROR_IO);                                                                        \
        if (strstr(dem_status_message(), reason) == NULL) fail_msg("'%s', not '%s'", dem_status_message(), reason);    \
    } while (0)

/* Three frames of five rows, of which the first stripe has two and the second three. */
enum { ROWS = 5, FRAMES = 3, FIRST = 2 };
static const hdf5_rows whole = {"/g/x", HDF5_F64, 2, {2}, 0, 0};
static const hdf5_stripe stripes[2] = {{"b.h5", 0, ROWS, FRAMES, FIRST, false},
                                       {"c.h5", FIRST, ROWS, FRAMES, ROWS - FIRST, false}};

static double value_of(hsize_t row, int column)
{
    return 10.0 * (double)row + column;
}

/* The rows of a stripe, and more behind them. */
static void write_stripe(const hdf5_stripe *stripe, const char *path)
{
    hdf5_file file;
    double values[2 * (FRAMES + 1) * ROWS];
    const hsize_t n = stripe->rows * (FRAMES + 1);
    for (hsize_t k = 0; k < n; k++)
        for (int c = 0; c < 2; c++)
            values[2 * k + (hsize_t)c] =
                value_of(k / stripe->rows * stripe->stride + stripe->first + k % stripe->rows, c);
    assert_ok(hdf5_open_new(&file, path, 1 << 16));
    assert_ok(hdf5_close(&file, hdf5_write(&file, whole, n, values)));
}

static int open_all(void **state)
{
    stored *s = calloc(1, sizeof *s);
    assert_non_null(s);
    stored_open(s);
    write_stripe(&stripes[0], folder_file(&s->folder, "b.h5"));
    write_stripe(&stripes[1], folder_file(&s->folder, "c.h5"));
    assert_ok(hdf5_map(&s->file, &whole, (hsize_t)ROWS * FRAMES, stripes, 2));
    s->file.takes_stripes = true;
    *state = s;
    return 0;
}

static int close_all(void **state)
{
    stored_close(*state);
    free(*state);
    return 0;
}

TEST_WITH(rows_are_found_in_their_files, open_all, close_all)
{
    stored *s = *test_state;
    hdf5_untrusted_shape shape;
    double found[2 * ROWS * FRAMES];
    const double *by_hdf5 = stored_values(s, whole.name, (hsize_t)ROWS * FRAMES, 2, 8);
    for (hsize_t k = 0; k < 2 * ROWS * FRAMES; k++) assert_true(by_hdf5[k] == value_of(k / 2, (int)(k % 2)));
    assert_ok(hdf5_untrusted_measure(&s->file, whole.name, HDF5_F64, &shape));
    assert_true(shape.rank == 2 && shape.extent[0] == ROWS * FRAMES && shape.extent[1] == 2);
    for (hsize_t first = 0; first < ROWS * FRAMES; first++)
        for (hsize_t n = 1; first + n <= ROWS * FRAMES; n++) {
            assert_ok(hdf5_untrusted_read(&s->file, whole.name, HDF5_F64, (hdf5_untrusted_rows){first, n, 0}, found));
            for (hsize_t k = 0; k < 2 * n; k++) assert_true(found[k] == value_of(first + k / 2, (int)(k % 2)));
            assert_ok(hdf5_untrusted_read(&s->file, whole.name, HDF5_F64, (hdf5_untrusted_rows){first, n, 1}, found));
            for (hsize_t k = 0; k < n; k++) assert_true(found[k] == value_of(first + k, 0));
        }
    assert_ok(hdf5_expect_rows(&s->file, &whole, (hsize_t)ROWS * FRAMES));
}

TEST_WITH(one_frame_and_a_stripe_that_has_all_are_found_too, open_all, close_all)
{
    stored *s = *test_state;
    const hdf5_stripe one[2] = {{"b.h5", 0, ROWS, 1, FIRST, false}, {"c.h5", FIRST, ROWS, 1, ROWS - FIRST, false}},
                      all[2] = {{"c.h5", 0, 3, FRAMES, 0, false}, {"c.h5", 0, 3, FRAMES, 3, false}};
    double found[2 * ROWS * FRAMES];
    assert_ok(hdf5_map(&s->file, &whole, ROWS, one, 2));
    assert_ok(hdf5_expect_rows(&s->file, &whole, ROWS));
    assert_ok(hdf5_untrusted_read(&s->file, whole.name, HDF5_F64, (hdf5_untrusted_rows){0, ROWS, 0}, found));
    for (hsize_t k = 0; k < 2 * ROWS; k++) assert_true(found[k] == value_of(k / 2, (int)(k % 2)));
    assert_ok(hdf5_map(&s->file, &whole, 9, all, 2));
    assert_ok(hdf5_expect_rows(&s->file, &whole, 9));
    assert_ok(hdf5_untrusted_read(&s->file, whole.name, HDF5_F64, (hdf5_untrusted_rows){0, 9, 0}, found));
    assert_true(found[0] == value_of(FIRST, 0) && found[6] == value_of(ROWS + FIRST, 0));
}

/* Files have a frame more than the others, which count, too; then one has another one, which does not. */
TEST_WITH(stripes_that_grow_have_what_is_in_their_files, open_all, close_all)
{
    stored *s = *test_state;
    hdf5_file other;
    hdf5_untrusted_shape shape;
    double found[2 * ROWS * (FRAMES + 1)], more[2 * FIRST] = {0.0};
    const hdf5_stripe grow[2] = {{"b.h5", 0, ROWS, 0, FIRST, true}, {"c.h5", FIRST, ROWS, 0, ROWS - FIRST, true}};
    const hsize_t rows = (hsize_t)ROWS * (FRAMES + 1);
    assert_ok(hdf5_map(&s->file, &whole, 0, grow, 2));
    assert_ok(hdf5_untrusted_measure(&s->file, whole.name, HDF5_F64, &shape));
    assert_int_equal(shape.extent[0], rows);
    assert_ok(hdf5_expect_rows(&s->file, &whole, rows));
    assert_ok(hdf5_untrusted_read(&s->file, whole.name, HDF5_F64, (hdf5_untrusted_rows){0, rows, 0}, found));
    for (hsize_t k = 0; k < 2 * rows; k++) assert_true(found[k] == value_of(k / 2, (int)(k % 2)));
    assert_ok(hdf5_open_write(&other, folder_at(&s->folder, "b.h5"), 0));
    assert_ok(hdf5_close(&other, hdf5_append(&other, &whole, (hsize_t)FIRST * (FRAMES + 1), FIRST, more)));
    assert_ok(hdf5_untrusted_measure(&s->file, whole.name, HDF5_F64, &shape));
    assert_ok(hdf5_untrusted_read(&s->file, whole.name, HDF5_F64, (hdf5_untrusted_rows){0, rows, 0}, found));
    for (hsize_t k = 0; k < 2 * rows; k++) assert_true(found[k] == value_of(k / 2, (int)(k % 2)));
}

TEST_WITH(a_name_with_a_percent_sign_is_no_pattern, open_all, close_all)
{
    stored *s = *test_state;
    const hdf5_stripe named[2] = {{"%b.h5", 0, ROWS, FRAMES, FIRST, false},
                                  {"c.h5", FIRST, ROWS, FRAMES, ROWS - FIRST, false}};
    assert_int_equal(rename(folder_at(&s->folder, "b.h5"), folder_file(&s->folder, "%b.h5")), 0);
    assert_ok(hdf5_map(&s->file, &whole, (hsize_t)ROWS * FRAMES, named, 2));
    assert_ok(hdf5_expect_rows(&s->file, &whole, (hsize_t)ROWS * FRAMES));
    assert_true(stored_values(s, whole.name, (hsize_t)ROWS * FRAMES, 2, 8)[0] == value_of(0, 0));
}

TEST_WITH(a_stripe_that_is_missing_or_short_is_named, open_all, close_all)
{
    stored *s = *test_state;
    double found[2 * ROWS];
    const hdf5_untrusted_rows rows = {0, ROWS, 0};
    const hdf5_stripe more[2] = {{"b.h5", 0, ROWS, FRAMES + 2, FIRST, false},
                                 {"c.h5", FIRST, ROWS, FRAMES + 2, ROWS - FIRST, false}};
    assert_ok(hdf5_map(&s->file, &whole, (hsize_t)ROWS * (FRAMES + 2), more, 2));
    REFUSED(hdf5_expect_rows(&s->file, &whole, (hsize_t)ROWS * (FRAMES + 2)), "b.h5");
    REFUSED(hdf5_untrusted_read(&s->file, whole.name, HDF5_F64, rows, found), "b.h5");
    assert_ok(hdf5_map(&s->file, &whole, (hsize_t)ROWS * FRAMES, stripes, 2));
    assert_int_equal(unlink(folder_at(&s->folder, "c.h5")), 0);
    REFUSED(hdf5_expect_rows(&s->file, &whole, (hsize_t)ROWS * FRAMES), "c.h5");
    REFUSED(hdf5_untrusted_read(&s->file, whole.name, HDF5_F64, rows, found), "c.h5");
    assert_true(isnan(stored_values(s, whole.name, (hsize_t)ROWS * FRAMES, 2, 8)[2 * FIRST]));
}

TEST_WITH(other_virtual_storage_is_refused, open_all, close_all)
{
    stored *s = *test_state;
    double found[2];
    hdf5_untrusted_shape shape;
    const hdf5_stripe away[1] = {{"../b.h5", 0, ROWS, 1, ROWS, false}}, itself[1] = {{"a.h5", 0, ROWS, 1, ROWS, false}},
                      dot[1] = {{".", 0, ROWS, 1, ROWS, false}}, half[1] = {{"b.h5", 0, ROWS, FRAMES, FIRST, false}};
    assert_ok(hdf5_map(&s->file, &whole, ROWS, away, 1));
    REFUSED(hdf5_untrusted_measure(&s->file, whole.name, HDF5_F64, &shape), "has a virtual or unknown layout");
    assert_ok(hdf5_map(&s->file, &whole, ROWS, dot, 1));
    REFUSED(hdf5_untrusted_measure(&s->file, whole.name, HDF5_F64, &shape), "has a virtual or unknown layout");
    assert_ok(hdf5_map(&s->file, &whole, (hsize_t)ROWS * FRAMES, half, 1));
    REFUSED(hdf5_untrusted_measure(&s->file, whole.name, HDF5_F64, &shape), "has rows that stand in no file");
    assert_ok(hdf5_map(&s->file, &whole, ROWS, itself, 1));
    REFUSED(hdf5_untrusted_read(&s->file, whole.name, HDF5_F64, (hdf5_untrusted_rows){0, 1, 0}, found),
            "has a virtual or unknown layout");
    s->file.takes_stripes = false;
    assert_ok(hdf5_map(&s->file, &whole, (hsize_t)ROWS * FRAMES, stripes, 2));
    REFUSED(hdf5_untrusted_measure(&s->file, whole.name, HDF5_F64, &shape), "has a virtual or unknown layout");
}

int main(void)
{
    return test_run();
}
