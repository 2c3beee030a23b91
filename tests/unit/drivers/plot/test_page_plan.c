/* SPDX-License-Identifier: BSD-3-Clause */
/* page_plan.c: what does not fit is left out, quantities first. */
#include "unit/drivers/plot/trajectory_fixture.h"

#include <string.h>

#include "page_blocks.h"
#include "page_plan.h"

static double least_megabytes; /* of the last fault */

/* What is left of a page of so many bytes; whether anything fits. */
static bool fit(const trajectory_fixture *f, double texts, double most, page_content *p)
{
    static request asked;
    outcome o = {0};
    asked = (request){.input = f->path};
    assert_true(page_content_open(p, f->reader, &asked, &o));
    const bool fits = page_plan_fit(p, texts, most, &o);
    assert_int_equal(o.code, fits ? EXIT_DONE : EXIT_INVALID);
    const char *least = strstr(o.message, "'--max-size' has to be ");
    assert_true(fits || least != NULL);
    if (!fits) least_megabytes = strtod(least + strlen("'--max-size' has to be "), NULL);
    return fits;
}

static double size_of(const page_content *p)
{
    return page_blocks_fixed(p) + (double)p->frames.n * page_blocks_per_frame(p) +
           (double)p->n_rows * page_blocks_per_row(p);
}

TEST(all_is_kept_where_there_is_room)
{
    page_content p;
    assert_true(fit(*test_state, 1e5, 1e6, &p));
    assert_int_equal(p.frames.n, p.n_asked);
    assert_int_equal(p.n_quantities, p.n_found);
    assert_int_equal(p.n_rows, p.history->n);
    page_content_close(&p);
}

/* Whatever the room is, more of it never shows less, and what is planned fits. */
TEST(quantities_are_left_out_before_frames)
{
    size_t frames = 1, quantities = 1;
    for (double most = 7e3; most < 1.2e5; most *= 1.05) {
        page_content p;
        if (fit(*test_state, 1e3, most, &p)) {
            assert_true(1e3 + size_of(&p) <= most);
            assert_true(p.frames.n == p.n_asked || p.n_quantities == 1);
            assert_true(p.frames.n >= frames && p.n_quantities >= quantities);
            frames = p.frames.n, quantities = p.n_quantities;
        } else {
            assert_int_equal(frames, 1);
        }
        page_content_close(&p);
    }
    assert_int_equal(frames, TRAJECTORY_FIXTURE_FRAMES);
    assert_true(quantities > 8);
}

TEST(the_history_has_a_quarter_at_most)
{
    page_content p;
    assert_true(fit(*test_state, 0.0, 1e6, &p));
    const double room = 2.0 * (double)p.history->n * page_blocks_per_row(&p);
    page_content_close(&p);
    (void)fit(*test_state, 0.0, room, &p);
    assert_in_range(p.n_rows, 2, p.history->n / 2);
    assert_true((double)p.n_rows * page_blocks_per_row(&p) <= 0.25 * room);
    assert_int_equal(p.n_rows % 2, 0);
    page_content_close(&p);
}

/* With what the message asks for it fits, and not with less. */
TEST(too_little_room_for_a_frame_is_a_fault)
{
    for (double texts = 2e4; texts < 1e6; texts *= 1.7) {
        page_content p;
        assert_false(fit(*test_state, texts, texts, &p));
        page_content_close(&p);
        const double asked_for = least_megabytes;
        assert_true(fit(*test_state, texts, 1e6 * asked_for, &p));
        page_content_close(&p);
        assert_false(fit(*test_state, texts, 1e6 * (asked_for - 0.1), &p));
        page_content_close(&p);
    }
}

TEST_GROUP(trajectory_fixture_begin, trajectory_fixture_end);
