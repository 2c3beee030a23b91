/* SPDX-License-Identifier: BSD-3-Clause */
/* page_facts.c: what a page says of its run. */
#include "unit/drivers/plot/trajectory_fixture.h"

#include <string.h>

#include "page_facts.h"

/* A text of a program's own file has no notes of dem_batch. */
TEST(notes_that_are_not_there_are_null)
{
    trajectory_fixture *f = *test_state;
    outcome o = {0};
    CLEANUP(free_memory) char *text = NULL;
    assert_true(page_facts_notes(f->path, &text, &o));
    assert_non_null(strstr(text, "{\"title\":null,\"versions\":null,"));
    assert_non_null(strstr(text, ",\"deck\":null}"));
}

static void expect_summary(const trajectory_fixture *f, const char *run, const char *expected)
{
    outcome o = {0};
    CLEANUP(free_memory) char *text = NULL;
    assert_true(page_facts_summary(trajectory_fixture_beside(f, run), &text, &o));
    assert_string_equal(text, expected);
}

TEST(the_summary_is_the_json_beside_the_file)
{
    trajectory_fixture *f = *test_state;
    char path[SCRATCH_PATH];
    (void)snprintf(path, sizeof path, "%s", trajectory_fixture_beside(f, "run.json"));
    expect_summary(f, "run.vtkhdf", "null");
    file_put(path, "{\"t\":1}\n", 8);
    expect_summary(f, "run.vtkhdf", "{\"t\":1}\n");
    expect_summary(f, "run.part.vtkhdf", "{\"t\":1}\n");
    expect_summary(f, "run.00001.vtkhdf", "null");
    expect_summary(f, "other.vtkhdf", "null");
    assert_int_equal(remove(path), 0);
}

TEST(frames_quantities_and_charts_are_listed)
{
    static const char *const words[] = {"\"file\":\"run.vtkhdf\",",
                                        "\"frames_in_file\":6,\"frames_asked\":6,",
                                        "\"frames\":[{\"number\":0,\"t\":0,\"box\":[",
                                        "{\"number\":5,\"t\":0.001,",
                                        "{\"name\":\"von_mises\",\"label\":\"von Mises stress\",\"unit\":\"",
                                        "\"left_out\":[\"",
                                        "\"moves\":[false]",
                                        "{\"label\":\"energy\",\"unit\":\"J\",\"by_decades\":false,",
                                        "\"lines\":[{\"name\":\"sum\",\"ink\":\"#1a1a1a\",\"block\":0}"};
    trajectory_fixture *f = *test_state;
    const request asked = {.input = f->path};
    outcome o = {0};
    page_content p;
    CLEANUP(free_memory) char *text = NULL;
    assert_true(page_content_open(&p, f->reader, &asked, &o));
    p.n_quantities--;
    assert_true(page_content_survey(&p, &o));
    assert_true(page_facts_content(&p, &text, &o));
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (strstr(text, words[k]) == NULL) fail_msg("no %s in %s", words[k], text);
    page_content_close(&p);
}

TEST(nothing_ends_the_script_that_a_text_stands_in)
{
    static const char text[] = "{\"a\":\"</script><!--\"}", expected[] = "{\"a\":\"\\u003c/script>\\u003c!--\"}";
    char *bytes;
    size_t size;
    FILE *out = open_memstream(&bytes, &size);
    assert_non_null(out);
    page_facts_write(text, out);
    assert_int_equal(fclose(out), 0);
    assert_string_equal(bytes, expected);
    assert_close(page_facts_length(text), (double)size, 0.0);
    free(bytes);
}

TEST_GROUP(trajectory_fixture_begin, trajectory_fixture_end);
