/* SPDX-License-Identifier: BSD-3-Clause */
/* request.c: the command line of dem_plot. */
#include "unit/close.h"

#include <string.h>

#include "request.h"

enum { WORDS = 12 };

/* Words with blanks between. */
static exit_code parse(request *r, const char *line)
{
    static char text[256];
    char *argv[WORDS] = {NULL};
    (void)snprintf(text, sizeof text, "%s", line);
    char *word = strtok(text, " ");
    for (int k = 0; k < WORDS - 1 && word != NULL; k++, word = strtok(NULL, " ")) argv[k] = word;
    return request_parse(r, argv);
}

TEST(a_strip_by_default)
{
    request r;
    assert_int_equal(parse(&r, "a.vtkhdf -o b.svg"), EXIT_DONE);
    assert_int_equal(r.action, REQUEST_STRIP);
    assert_string_equal(r.input, "a.vtkhdf");
    assert_string_equal(r.output, "b.svg");
    assert_close(r.width, 1200.0, 0.0);
    assert_null(r.color);
    assert_false(r.has_range || r.has_zoom || r.prints_hash);
}

TEST(options_are_read)
{
    request r;
    assert_int_equal(parse(&r, "--zoom -1:2,-3:4 --range 0.1 -o b.PNG --color force a --columns 3"), EXIT_DONE);
    assert_close(r.zoom.x0, -1, 0);
    assert_close(r.zoom.x1, 2, 0);
    assert_close(r.zoom.y0, -3, 0);
    assert_close(r.zoom.y1, 4, 0);
    assert_true(r.has_range && r.hi == 0.1 && isinf(r.lo));
    assert_int_equal(r.columns, 3);
    assert_int_equal(parse(&r, "a -o b.pdf --range -2:1e3 --hash --width 640"), EXIT_DONE);
    assert_true(r.lo == -2.0 && r.hi == 1e3 && r.prints_hash && r.width == 640.0);
    assert_int_equal(parse(&r, "a --animate f --times 0,1"), EXIT_DONE);
    assert_int_equal(r.action, REQUEST_ANIMATION);
    assert_int_equal(parse(&r, "a --history -o b.svg"), EXIT_DONE);
    assert_int_equal(r.action, REQUEST_HISTORY);
    assert_int_equal(parse(&r, "a --fragments -o b.svg"), EXIT_DONE);
    assert_int_equal(r.action, REQUEST_SIZES);
    assert_int_equal(parse(&r, "a --html b.html --color speed --frames 0:9"), EXIT_DONE);
    assert_int_equal(r.action, REQUEST_PAGE);
    assert_string_equal(r.page, "b.html");
    assert_close(r.max_size, 20e6, 0.0);
    assert_int_equal(parse(&r, "--max-size 0.5 --html b.HTM a"), EXIT_DONE);
    assert_close(r.max_size, 5e5, 0.0);
    assert_false(r.has_cracks);
    assert_int_equal(parse(&r, "a --cracks --color fragment -o b.svg"), EXIT_DONE);
    assert_true(r.has_cracks);
    assert_int_equal(parse(&r, "--help"), EXIT_DONE);
    assert_int_equal(parse(&r, "--version"), EXIT_DONE);
}

TEST(what_makes_no_sense_is_refused)
{
    static const char *const lines[] = {"",
                                        "a",
                                        "-o b.svg",
                                        "a b -o c.svg",
                                        "a -o b.gif",
                                        "a -o",
                                        "a -o png",
                                        "a -o b.svg --color red",
                                        "a -o b.svg --range 0",
                                        "a -o b.svg --range 2:1",
                                        "a -o b.svg --range 1:nan",
                                        "a -o b.svg --range 1:2:3",
                                        "a -o b.svg --zoom 0:1",
                                        "a -o b.svg --zoom 1:0,0:1",
                                        "a -o b.svg --zoom 0:1,0:1x",
                                        "a -o b.svg --width 10",
                                        "a -o b.svg --width 1e9",
                                        "a -o b.svg --columns 0",
                                        "a -o b.svg --columns 1.5",
                                        "a -o b.svg --frames 0 --times 0",
                                        "a -o b.svg --animate f",
                                        "a --history --animate f",
                                        "a --animate f --history",
                                        "a --animate f --fragments",
                                        "a --fragments --history -o b.svg",
                                        "a -o b.svg --color fragment --range 1",
                                        "a --html",
                                        "a --html b.svg",
                                        "a --html .html",
                                        "a --html b.html -o c.svg",
                                        "a --html b.html --history",
                                        "a --animate f --html b.html",
                                        "a --html b.html --cracks",
                                        "a --html b.html --hash",
                                        "a --html b.html --columns 2",
                                        "a --html b.html --max-size 0.09",
                                        "a --html b.html --max-size 1001",
                                        "a --html b.html --max-size x",
                                        "a -o b.svg --max-size 3",
                                        "a -o b.svg --frobnicate"};
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        request r;
        if (parse(&r, lines[k]) != EXIT_USAGE) fail_msg("'%s' is taken", lines[k]);
    }
}
