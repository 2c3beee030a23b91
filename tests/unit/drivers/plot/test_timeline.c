/* SPDX-License-Identifier: BSD-3-Clause */
/* timeline.c: a history becomes charts. */
#include "unit/drivers/plot/trajectory_fixture.h"

#include <string.h>

#include "timeline.h"

enum { MOST = 1 << 20 };

/* The file drawn, as text. */
static char *draw(const trajectory_fixture *f)
{
    const request asked = {
        .action = REQUEST_HISTORY, .input = f->path, .output = trajectory_fixture_beside(f, "h.svg"), .width = 800.0};
    outcome o = {0};
    FILE *log = tmpfile(), *file;
    char *text = calloc(1, MOST);
    assert_true(timeline_draw(f->reader, &asked, log, &o));
    (void)fclose(log);
    file = fopen(asked.output, "r");
    assert_non_null(file);
    assert_true(fread(text, 1, MOST - 1, file) < MOST - 1);
    (void)fclose(file);
    assert_int_equal(remove(asked.output), 0);
    return text;
}

TEST(energies_reaction_contacts_and_steps_have_charts)
{
    CLEANUP(free_memory) char *text = draw(*test_state);
    static const char *const words[] = {">energy, J<", ">energy, mJ<", ">sum<",      ">kinetic<", ">springs<",
                                        ">along x<",   ">along y<",    ">contacts<", ">step, "};
    int n = 0, charts = 0;
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) n += strstr(text, words[k]) != NULL;
    assert_int_equal(n, 8); /* one unit of energy */
    for (const char *at = strstr(text, "class=\"chart\""); at != NULL; at = strstr(at + 1, "class=\"chart\"")) charts++;
    assert_int_equal(charts, 4);
}

/* The run has no friction, no damping, no boundaries, and loses nothing by them. */
TEST(what_never_is_has_no_line)
{
    CLEANUP(free_memory) char *text = draw(*test_state);
    assert_null(strstr(text, "friction"));
    assert_null(strstr(text, "damping"));
    assert_null(strstr(text, "boundar"));
}

TEST(the_same_frames_have_the_same_hash)
{
    CLEANUP(free_memory) char *a = draw(*test_state), *b = draw(*test_state);
    assert_string_equal(a, b);
    assert_non_null(strstr(a, "<metadata>data "));
}

TEST_GROUP(trajectory_fixture_begin, trajectory_fixture_end);
