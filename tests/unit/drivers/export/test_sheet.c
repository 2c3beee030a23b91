/* SPDX-License-Identifier: BSD-3-Clause */
#include "unit/drivers/export/exported.h"

#include "sheet.h"

TEST_WITH(a_file_has_its_name_when_it_is_whole, exported_begin, exported_end)
{
    exported *e = *test_state;
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

TEST_WITH(what_is_not_good_is_removed, exported_begin, exported_end)
{
    exported *e = *test_state;
    sheet s;
    exported_put(e, "run.txt", "old");
    assert_true(sheet_open(&s, &e->task, "", ".txt"));
    assert_false(sheet_close(&s, false));
    assert_int_equal(e->outcome.code, EXIT_DONE); /* the fault is the caller's */
    assert_string_equal(exported_text(e, "run.txt"), "old");
    assert_false(exported_has(e, "run.txt.new"));
}

TEST_WITH(a_file_in_the_way_is_the_outcome, exported_begin, exported_end)
{
    exported *e = *test_state;
    exported_put(e, "run.txt", "old");
    assert_true(sheet_is_free(&e->task, "", ".csv"));
    assert_false(sheet_is_free(&e->task, "", ".txt"));
    assert_int_equal(e->outcome.code, EXIT_TAKEN);
    assert_non_null(strstr(e->outcome.message, "/run.txt: is there already; --overwrite replaces it"));
    e->task.overwrite = true;
    assert_true(sheet_is_free(&e->task, "", ".txt"));
}

TEST_WITH(numbers_have_the_digits_they_need, exported_begin, exported_end)
{
    exported *e = *test_state;
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

TEST_WITH(what_cannot_be_written_is_the_outcome, exported_begin, exported_end)
{
    exported *e = *test_state;
    sheet s;
    e->task.folder = "none/";
    assert_false(sheet_open(&s, &e->task, "", ".txt"));
    assert_int_equal(e->outcome.code, EXIT_IO);
    assert_non_null(strstr(e->outcome.message, "none/run.txt: cannot be written (No such file or directory)"));
}

/* A device that is always full in the place of the file. */
TEST_WITH(a_full_disk_is_the_outcome, exported_begin, exported_end)
{
    exported *e = *test_state;
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
