/* SPDX-License-Identifier: BSD-3-Clause */
/* result.c: the file, and the line of a case that never ran. What runs leave, tests/deck/test_sweep.py looks at. */
#include "unit/close.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "result.h"
#include "unit/scratch.h"

static const char *path;

TEST(a_case_without_a_deck_has_a_line)
{
    command c = {0};
    setting s = {.text = "run.title='\"'"};
    outcome o = {.code = EXIT_INVALID, .message = "a.nml:1:1: error: what"};
    const result r = {.deck = "a.nml", .command = &c, .outcome = &o, .seconds = 0.25};
    c.settings = &s, c.n_settings = 1;
    CLEANUP(free_memory) char *line = result_line(&r);
    assert_non_null(line);
    const char *begin =
        "{\"deck\":\"a.nml\",\"set\":[\"run.title='\\\"'\"],\"name\":null,\"output\":null,\"status\":\"failed\","
        "\"exit_code\":3,\"message\":\"a.nml:1:1: error: what\",\"versions\":\"dem ";
    const char *end = "\",\"wall_start\":\"1970-01-01T00:00:00Z\",\"wall_seconds\":0.25}\n";
    assert_memory_equal(line, begin, strlen(begin));
    assert_string_equal(line + strlen(line) - strlen(end), end);
}

TEST(only_a_run_that_is_done_is_found_again)
{
    static const struct {
        const char *line;
        int found;
    } all[] = {{"{\"status\":\"done\",\"run\":\"12\"}\n", 1},
               {"{\"status\":\"failed\",\"run\":\"12\"}\n", 0},
               {"{\"status\":\"done\",\"run\":\"13\"}\n", 0},
               {"{\"message\":\"\\\"status\\\":\\\"done\\\"\",\"run\":\"12\"}\n", 0},
               {"\n", 0}};
    assert_null(result_read_done(path, "12"));
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        outcome o = {0};
        result_write(path, all[k].line, &o);
        assert_int_equal(o.code, EXIT_DONE);
        CLEANUP(free_memory) char *line = result_read_done(path, "12");
        assert_int_equal(line != NULL, all[k].found);
        if (line != NULL) assert_string_equal(line, all[k].line);
    }
    assert_int_equal(unlink(path), 0);
}

TEST(what_cannot_be_written_is_reported)
{
    outcome o = {0};
    result_write("no/such/folder.json", "{}\n", &o);
    assert_int_equal(o.code, EXIT_IO);
    assert_string_equal(o.message, "no/such/folder.json.part: error: cannot be written (No such file or directory)");
}

SCRATCH_GROUP({&path, "a.json"});
