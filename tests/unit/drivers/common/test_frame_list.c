/* SPDX-License-Identifier: BSD-3-Clause */
/* frame_list.c: which frames are shown. */
#include "unit/close.h"

#include <string.h>

#include "frame_list.h"

enum { FRAMES = 21 };

static void expect(frame_list *m, size_t n, const dem_index *frames)
{
    assert_int_equal(m->n, n);
    for (size_t k = 0; k < n; k++) assert_int_equal(m->frame[k], frames[k]);
    frame_list_free(m);
}

static void expect_parsed(const char *text, size_t n, const dem_index *frames)
{
    frame_list m;
    const char *fault = NULL;
    assert_true(frame_list_parse(&m, text, FRAMES, &fault));
    expect(&m, n, frames);
}

TEST(lists_and_ranges_are_taken_in_their_order)
{
    expect_parsed("7", 1, (const dem_index[]){7});
    expect_parsed("5,0,5", 3, (const dem_index[]){5, 0, 5});
    expect_parsed("0:2,-1", 4, (const dem_index[]){0, 1, 2, 20});
    expect_parsed("0:20:8", 3, (const dem_index[]){0, 8, 16});
    expect_parsed("-3:-1", 3, (const dem_index[]){18, 19, 20});
}

TEST(what_is_no_list_is_refused)
{
    static const char *const texts[] = {"",    "a",   "1,",    ",1",     "1,,2",
                                        "1;2", "0:",  "0:5:0", "0:5:-1", "5:0",
                                        "21",  "-22", "1.5",   "0:21",   "99999999999999999999"};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        frame_list m;
        const char *fault = NULL;
        if (frame_list_parse(&m, texts[k], FRAMES, &fault)) fail_msg("'%s' is taken", texts[k]);
        assert_non_null(fault);
    }
}

TEST(times_are_those_of_the_nearest_frames)
{
    const double t[] = {0.0, 1e-3, 2e-3, 4e-3};
    frame_list m;
    const char *fault = NULL;
    assert_true(frame_list_parse_times(&m, "0,1.4e-3,9,3.1e-3,-5", 4, t, &fault));
    expect(&m, 5, (const dem_index[]){0, 1, 3, 3, 0});
    assert_false(frame_list_parse_times(&m, "0,x", 4, t, &fault));
    assert_false(frame_list_parse_times(&m, "nan", 4, t, &fault));
    assert_false(frame_list_parse_times(&m, "1ms", 4, t, &fault));
}

static void expect_usual(dem_index n_frames, dem_index middle, size_t n, const dem_index *frames)
{
    frame_list m;
    assert_true(frame_list_usual(&m, n_frames, middle));
    expect(&m, n, frames);
}

TEST(usual_ones_mirror_about_the_greatest_compression)
{
    expect_usual(21, 4, 6, (const dem_index[]){0, 2, 4, 6, 8, 20});
    expect_usual(21, 3, 6, (const dem_index[]){0, 2, 3, 5, 6, 20});
    expect_usual(21, 9, 6, (const dem_index[]){0, 5, 9, 14, 18, 20});
    expect_usual(21, 14, 6, (const dem_index[]){0, 7, 14, 16, 18, 20});
    expect_usual(21, 1, 4, (const dem_index[]){0, 1, 2, 20});
    expect_usual(21, -1, 6, (const dem_index[]){0, 4, 8, 12, 16, 20});
    expect_usual(21, 20, 6, (const dem_index[]){0, 4, 8, 12, 16, 20});
    expect_usual(4, 2, 4, (const dem_index[]){0, 1, 2, 3});
    expect_usual(1, -1, 1, (const dem_index[]){0});
}

/* Whatever the trajectory: the first, the middle and the last, each once, in order. */
TEST(usual_ones_have_first_middle_and_last)
{
    for (dem_index n = 7; n < 60; n++)
        for (dem_index middle = 1; middle < n - 1; middle++) {
            CLEANUP(frame_list_free) frame_list m;
            bool has_middle = false;
            assert_true(frame_list_usual(&m, n, middle));
            assert_true(m.n <= FRAME_LIST_USUAL);
            assert_int_equal(m.frame[0], 0);
            assert_int_equal(m.frame[m.n - 1], n - 1);
            for (size_t k = 0; k < m.n; k++) {
                has_middle = has_middle || m.frame[k] == middle;
                if (k > 0) assert_true(m.frame[k] > m.frame[k - 1]);
            }
            assert_true(has_middle);
        }
}

TEST(all_are_all)
{
    frame_list m;
    assert_true(frame_list_all(&m, 3));
    expect(&m, 3, (const dem_index[]){0, 1, 2});
}
