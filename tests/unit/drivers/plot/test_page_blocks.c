/* SPDX-License-Identifier: BSD-3-Clause */
/* page_blocks.c: the numbers of a page. What is in them, test_page.py decodes. */
#include "unit/drivers/plot/trajectory_fixture.h"

#include <string.h>

#include "page_blocks.h"

/* The blocks of a run, as text. */
static char *write_all(page_content *p, const trajectory_fixture *f, const request *asked)
{
    outcome o = {0};
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_true(page_content_open(p, f->reader, asked, &o));
    assert_true(page_content_survey(p, &o));
    if (asked->columns > 0) p->n_rows = 2 * asked->columns; /* bins of rows */
    assert_true(page_blocks_write(p, out, &o));
    assert_int_equal(fclose(out), 0);
    return text;
}

/* How many letters a block has; it must be there once. */
static size_t letters_of(const char *text, const char *id)
{
    char begin[80];
    (void)snprintf(begin, sizeof begin, "<script type=\"text/plain\" id=\"%s\">", id);
    const char *at = strstr(text, begin);
    if (at == NULL) fail_msg("no block %s", id);
    assert_null(strstr(at + 1, begin));
    return strcspn(at + strlen(begin), "<");
}

static size_t base64_of(size_t bytes)
{
    return 4 * ((bytes + 2) / 3);
}

TEST(every_number_has_its_place)
{
    trajectory_fixture *f = *test_state;
    const request asked = {.input = f->path};
    page_content p;
    CLEANUP(free_memory) char *text = write_all(&p, f, &asked);
    const dem_lattice *l = p.lattice;
    const size_t n = p.frames.n, nodes = (size_t)l->n_nodes;
    assert_int_equal(letters_of(text, "places0"), base64_of(n * nodes * 4));
    assert_int_equal(letters_of(text, "triangles0"), base64_of(6 * (size_t)l->n_triangles));
    assert_int_equal(letters_of(text, "springs0"), base64_of(4 * (size_t)l->n_springs));
    assert_int_equal(letters_of(text, "bare0"), base64_of(2));
    assert_int_equal(letters_of(text, "shades0"), base64_of(n * ((size_t)l->n_triangles + 1)));
    assert_int_equal(letters_of(text, "shades1"), base64_of(n * ((size_t)l->n_springs + 1)));
    assert_int_equal(letters_of(text, "times0"), base64_of(8 * p.history->n));
    assert_int_equal(letters_of(text, "line0"), base64_of(4 * p.history->n));
    assert_in_range(letters_of(text, "obstacle0"), base64_of(40), base64_of(8 * (1 + 2 * 36)));
    page_content_close(&p);
}

TEST(sizes_known_before_are_no_smaller_and_close)
{
    trajectory_fixture *f = *test_state;
    for (size_t bins = 0; bins < 5; bins += 4) {
        const request asked = {.input = f->path, .columns = bins};
        page_content p;
        CLEANUP(free_memory) char *text = write_all(&p, f, &asked);
        const double planned = page_blocks_fixed(&p) + (double)p.frames.n * page_blocks_per_frame(&p) +
                               (double)p.n_rows * page_blocks_per_row(&p);
        assert_true((double)strlen(text) <= planned);
        assert_true((double)strlen(text) > 0.85 * planned);
        page_content_close(&p);
    }
}

/* Four bins of two rows each. */
TEST(rows_that_are_too_many_are_binned)
{
    trajectory_fixture *f = *test_state;
    const request asked = {.input = f->path, .columns = 4};
    page_content p;
    CLEANUP(free_memory) char *text = write_all(&p, f, &asked);
    assert_true(p.history->n > 8);
    assert_int_equal(letters_of(text, "times0"), base64_of(64));
    assert_int_equal(letters_of(text, "line0"), base64_of(32));
    page_content_close(&p);
}

/* Of what breaks behind frame 2 each triangle that is gone has the colour 255, in 3 frames. */
TEST(what_is_broken_has_no_colour)
{
    const request asked = {.color = "none", .input = ""};
    trajectory_fixture whole = trajectory_fixture_run(false), broken = trajectory_fixture_run(true);
    page_content p;
    size_t differ = 0;
    CLEANUP(free_memory) char *a = write_all(&p, &whole, &asked);
    page_content_close(&p);
    CLEANUP(free_memory) char *b = write_all(&p, &broken, &asked);
    page_content_close(&p);
    const char *from = strstr(a, "id=\"shades0\">"), *other = strstr(b, "id=\"shades0\">");
    assert_true(from != NULL && other != NULL);
    for (size_t k = 0; from[k] != '\n'; k++) differ += from[k] != other[k];
    assert_true(differ > 0);
    trajectory_fixture_close(&whole);
    trajectory_fixture_close(&broken);
}

TEST_GROUP(trajectory_fixture_begin, trajectory_fixture_end);
