/* SPDX-License-Identifier: BSD-3-Clause */
#include "unit/exported.h"

#include "sheet.h"

static void a_file_has_its_name_when_it_is_whole(void **state)
{
    exported *e = *state;
    sheet s;
    assert_true(sheet_open(&s, &e->task, "in.", ".txt"));
    sheet_print(&s, "%d and ", 7);
    sheet_write(&s, "more", 4);
    sheet_write(&s, NULL, 0);
    assert_false(exported_has(e, "in.run.txt"));
    assert_true(sheet_close(&s, true));
    assert_string_equal(exported_text(e, "in.run.txt"), "7 and more");
    assert_false(exported_has(e, "in.run.txt.new"));
}

static void what_is_not_good_is_removed(void **state)
{
    exported *e = *state;
    sheet s;
    exported_put(e, "run.txt", "old");
    assert_true(sheet_open(&s, &e->task, "", ".txt"));
    assert_false(sheet_close(&s, false));
    assert_int_equal(e->outcome.code, EXIT_DONE); /* the fault is the caller's */
    assert_string_equal(exported_text(e, "run.txt"), "old");
    assert_false(exported_has(e, "run.txt.new"));
}

static void a_file_in_the_way_is_the_outcome(void **state)
{
    exported *e = *state;
    exported_put(e, "run.txt", "old");
    assert_true(sheet_is_free(&e->task, "", ".csv"));
    assert_false(sheet_is_free(&e->task, "", ".txt"));
    assert_int_equal(e->outcome.code, EXIT_TAKEN);
    assert_non_null(strstr(e->outcome.message, "/run.txt: is there already; --overwrite replaces it"));
    e->task.overwrite = true;
    assert_true(sheet_is_free(&e->task, "", ".txt"));
}

static void numbers_have_the_digits_they_need(void **state)
{
    exported *e = *state;
    sheet s;
    assert_true(sheet_open(&s, &e->task, "", ".txt"));
    sheet_number(&s, 0.1, DEM_READER_F64);
    sheet_print(&s, " ");
    sheet_number(&s, (double)0.1F, DEM_READER_F32);
    sheet_print(&s, " ");
    sheet_number(&s, 123456789012.0, DEM_READER_I64);
    assert_true(sheet_close(&s, true));
    assert_string_equal(exported_text(e, "run.txt"), "0.10000000000000001 0.100000001 123456789012");
}

static void what_cannot_be_written_is_the_outcome(void **state)
{
    exported *e = *state;
    sheet s;
    e->task.folder = "none/";
    assert_false(sheet_open(&s, &e->task, "", ".txt"));
    assert_int_equal(e->outcome.code, EXIT_IO);
    assert_non_null(strstr(e->outcome.message, "none/run.txt: cannot be written (No such file or directory)"));
}

/* A device that is always full in the place of the file. */
static void a_full_disk_is_the_outcome(void **state)
{
    exported *e = *state;
    sheet s;
    assert_true(sheet_open(&s, &e->task, "", ".txt"));
    (void)fclose(s.file);
    s.file = fopen("/dev/full", "wb");
    assert_non_null(s.file);
    sheet_print(&s, "text");
    assert_false(sheet_close(&s, true));
    assert_int_equal(e->outcome.code, EXIT_IO);
    assert_non_null(strstr(e->outcome.message, "/run.txt: cannot be written (No space left on device)"));
    assert_false(exported_has(e, "run.txt"));
}

#define OF_RUN(test) cmocka_unit_test_setup_teardown(test, exported_begin, exported_end)

int main(void)
{
    const struct CMUnitTest tests[] = {
        OF_RUN(a_file_has_its_name_when_it_is_whole),  OF_RUN(what_is_not_good_is_removed),
        OF_RUN(a_file_in_the_way_is_the_outcome),      OF_RUN(numbers_have_the_digits_they_need),
        OF_RUN(what_cannot_be_written_is_the_outcome), OF_RUN(a_full_disk_is_the_outcome),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
