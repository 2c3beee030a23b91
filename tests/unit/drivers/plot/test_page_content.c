/* SPDX-License-Identifier: BSD-3-Clause */
/* page_content.c: which frames and quantities a page has. */
#include "unit/drivers/plot/trajectory_fixture.h"

#include <string.h>

#include "page_content.h"

static page_content open_content(const trajectory_fixture *f, const request *asked)
{
    page_content p;
    outcome o = {0};
    assert_true(page_content_open(&p, f->reader, asked, &o));
    return p;
}

TEST(all_frames_and_quantities_are_found)
{
    trajectory_fixture *f = *test_state;
    const request asked = {.input = f->path};
    page_content p = open_content(f, &asked);
    assert_int_equal(p.frames.n, TRAJECTORY_FIXTURE_FRAMES);
    assert_string_equal(p.quantity[0].shown.name, "von_mises"); /* it fills triangles */
    assert_true(p.quantity[0].fills);
    assert_string_equal(p.quantity[1].shown.name, "strain");
    assert_false(p.quantity[1].fills);
    for (size_t k = 0; k < p.n_quantities; k++)
        for (size_t i = 0; i < k; i++) assert_string_not_equal(p.quantity[i].shown.name, p.quantity[k].shown.name);
    assert_int_equal(p.n_bare, 1); /* the loose node, which is the last */
    assert_int_equal(p.is_bare[p.lattice->n_nodes - 1], 1);
    assert_true(page_content_draws(&p, true) && page_content_draws(&p, false));
    p.n_quantities = 1;
    assert_true(page_content_draws(&p, true) && !page_content_draws(&p, false));
    assert_int_equal(p.n_rows, p.history->n);
    page_content_close(&p);
}

TEST(what_is_asked_for_comes_first)
{
    trajectory_fixture *f = *test_state;
    const request asked = {
        .input = f->path, .color = "speed", .frames = "4,2", .has_range = true, .lo = 1.0, .hi = 3.0};
    outcome o = {0};
    page_content p = open_content(f, &asked);
    assert_string_equal(p.quantity[0].shown.name, "speed");
    assert_int_equal(p.frames.n, 2);
    assert_int_equal(p.frames.frame[0], 4);
    assert_true(page_content_survey(&p, &o));
    assert_true(p.quantity[0].range.lo == 1.0 && p.quantity[0].range.hi == 3.0);
    assert_true(p.quantity[1].range.hi != 3.0); /* the range is of what was asked for */
    page_content_close(&p);
    const request nothing = {.input = f->path, .color = "none"};
    p = open_content(f, &nothing);
    assert_null(p.quantity[0].shown.source);
    assert_int_equal(p.quantity[0].n_cells, p.lattice->n_springs);
    page_content_close(&p);
    const request lacks = {.input = f->path, .color = "fragment"};
    assert_false(page_content_open(&p, f->reader, &lacks, &o));
    assert_int_equal(o.code, EXIT_INVALID);
    page_content_close(&p);
}

TEST(frames_are_thinned_evenly_between_the_first_and_the_last)
{
    trajectory_fixture *f = *test_state;
    static const dem_index left[][TRAJECTORY_FIXTURE_FRAMES] = {{0}, {0, 5}, {0, 3, 5}, {0, 2, 3, 5}};
    const request asked = {.input = f->path};
    for (size_t n = 1; n <= 4; n++) {
        page_content p = open_content(f, &asked);
        page_content_thin(&p, n);
        assert_int_equal(p.frames.n, n);
        assert_int_equal(p.n_asked, TRAJECTORY_FIXTURE_FRAMES);
        for (size_t k = 0; k < n; k++) assert_int_equal(p.frames.frame[k], left[n - 1][k]);
        page_content_thin(&p, 6);
        assert_int_equal(p.frames.n, n);
        page_content_close(&p);
    }
}

/* The block and the loose node fall; the boxes of the frames follow. */
TEST(boxes_hold_all_nodes)
{
    trajectory_fixture *f = *test_state;
    const request asked = {.input = f->path};
    outcome o = {0};
    page_content p = open_content(f, &asked);
    double *x = malloc(2 * (size_t)p.lattice->n_nodes * sizeof *x);
    assert_non_null(x);
    assert_true(page_content_survey(&p, &o));
    for (size_t k = 0; k < p.frames.n; k++) {
        trajectory_fixture_ok(dem_reader_positions(f->reader, (dem_index)k, x));
        const box b = box_around(p.lattice->n_nodes, x);
        assert_memory_equal(&b, &p.box[k], sizeof b);
        assert_true(b.x0 > p.view.x0 && b.x1 < p.view.x1 && b.y0 > p.view.y0 && b.y1 < p.view.y1);
    }
    free(x);
    page_content_close(&p);
}

TEST_GROUP(trajectory_fixture_begin, trajectory_fixture_end);
