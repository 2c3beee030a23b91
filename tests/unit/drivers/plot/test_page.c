/* SPDX-License-Identifier: BSD-3-Clause */
/* page.c: a run becomes a page. How that looks and works, test_page.py tries in a browser. */
#include "unit/drivers/plot/trajectory_fixture.h"

#include <string.h>

#include "page.h"

static const char *first_of(const char *path)
{
    static char text[64];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(text, sizeof text, file));
    (void)fclose(file);
    return text;
}

static request asking(const trajectory_fixture *f, double max_size)
{
    return (request){
        .action = REQUEST_PAGE, .input = f->path, .page = trajectory_fixture_beside(f, "a.html"), .max_size = max_size};
}

static double size_of(const char *path)
{
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const double size = (double)ftell(file);
    (void)fclose(file);
    return size;
}

TEST(a_page_is_written_and_said_to_be)
{
    trajectory_fixture *f = *test_state;
    const request r = asking(f, 1e6);
    char said[256] = "";
    outcome o = {0};
    FILE *log = tmpfile();
    assert_non_null(log);
    assert_true(page_draw(f->reader, &r, log, &o));
    rewind(log);
    assert_non_null(fgets(said, sizeof said, log));
    (void)fclose(log);
    assert_memory_equal(said, r.page, strlen(r.page));
    assert_non_null(strstr(said, " MB, 6 frames, coloured by "));
    assert_null(strstr(said, "the rest"));
    assert_string_equal(first_of(r.page), "<!DOCTYPE html>\n");
    assert_true(size_of(r.page) < 1e6);
    assert_int_equal(remove(r.page), 0);
}

TEST(a_fault_leaves_an_older_page)
{
    trajectory_fixture *f = *test_state;
    request r = asking(f, 2e4);
    outcome o = {0};
    file_put(r.page, "old\n", 4);
    assert_false(page_draw(f->reader, &r, NULL, &o));
    assert_int_equal(o.code, EXIT_INVALID);
    assert_non_null(strstr(o.message, "--max-size"));
    assert_string_equal(first_of(r.page), "old\n");
    assert_int_equal(remove(r.page), 0);
    r.page = trajectory_fixture_beside(f, "no/a.html");
    r.max_size = 1e6;
    o = (outcome){0};
    assert_false(page_draw(f->reader, &r, NULL, &o));
    assert_int_equal(o.code, EXIT_IO);
}

TEST_GROUP(trajectory_fixture_begin, trajectory_fixture_end);
