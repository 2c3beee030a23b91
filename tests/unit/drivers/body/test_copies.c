/* SPDX-License-Identifier: BSD-3-Clause */
/* copies.c: how many copies there are, where they are, and which keys do not go together. */
#include "unit/reading.h"

#include "copies.h"

#define RUN  "&run t_end = 1 /\n"
#define DISC "&body shape = 'disc', radius = 1, spacing = 0.25, position = 3, 4"

static const schema_instance *first_body(const resolved *r)
{
    return schema_get(&r->deck, "body", 0);
}

TEST(copies_stand_in_columns_and_rows)
{
    CLEANUP(drop_resolved) resolved r = resolve_clean(RUN DISC ", copies = 3, 2, pitch = 0.5, 0.75 /\n" DISC " /");
    double shift[2];
    assert_int_equal(copies_count(first_body(&r)), 6);
    assert_true(copies_shift(shift, first_body(&r), 0));
    assert_true(shift[0] == 0.0 && shift[1] == 0.0);
    assert_true(copies_shift(shift, first_body(&r), 5));
    assert_true(shift[0] == 1.0 && shift[1] == 0.75);
    assert_int_equal(copies_total(&r.deck), 7);
    const copies_origin expected[3] = {{0, 0}, {0, 5}, {1, 0}};
    for (size_t k = 0; k < 3; k++) {
        const copies_origin found = copies_find(&r.deck, (const size_t[]){0, 5, 6}[k]);
        assert_int_equal(found.group, expected[k].group);
        assert_int_equal(found.copy, expected[k].copy);
    }
}

/* MT19937 with seed 5489, as in the C++ standard's mt19937, begins 3499211612, 581869302, 3890346734, 3586334585. */
TEST(scatter_takes_the_numbers_of_the_published_generator)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(RUN DISC ", copies = 1, 2, pitch = 3, 3, scatter = 0.25, seed = 5489 /");
    const double scale = 4294967296.0;
    double shift[2];
    assert_true(copies_shift(shift, first_body(&r), 0));
    assert_close(shift[0], 0.25 * (2.0 * 3499211612.0 / scale - 1.0), 1e-15);
    assert_close(shift[1], 0.25 * (2.0 * 581869302.0 / scale - 1.0), 1e-15);
    assert_true(copies_shift(shift, first_body(&r), 1));
    assert_close(shift[0], 0.25 * (2.0 * 3890346734.0 / scale - 1.0), 1e-15);
    assert_close(shift[1], 3.0 + 0.25 * (2.0 * 3586334585.0 / scale - 1.0), 1e-15);
}

static void expect(const char *text, int line, const char *word)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    CLEANUP(drop_resolved) resolved r = resolve_clean(text);
    copies_check(&r.deck, &errors);
    assert_one_fault(&errors, text, line, word);
}

TEST(keys_that_do_not_go_together_are_reported)
{
    expect(RUN DISC " /", 0, NULL);
    expect(RUN DISC ", copies = 2, 1, pitch = 3, 3 /", 0, NULL);
    expect(RUN DISC ", copies = 2, 1 /", 2, "'pitch'");
    expect(RUN DISC ", pitch = 3, 3 /", 2, "'pitch' in &body is not used without 'copies'");
    expect(RUN DISC ", scatter = 0.5 /", 2, "'scatter' in &body is not used without 'copies'");
    expect(RUN DISC ", copies = 1000, 11, pitch = 3, 3 /", 2, "11000 bodies; the limit is 10000");
    expect(RUN DISC ", copies = 2, 1, pitch = 3, 3, clearance = 1 /", 2, "'clearance'");
}

/* Neither says which copy is meant. But a node has a number of its own. */
TEST(boundaries_and_places_of_probes_want_one_body)
{
    const char *two = RUN DISC ", copies = 2, 1, pitch = 3, 3 /\n" DISC " /\n";
    static const struct {
        const char *group, *word;
    } cases[] = {{"&boundary where = 'all' /", "&boundary is for body 1, of which there are 2 copies"},
                 {"&boundary body = 2, where = 'all' /", NULL},
                 {"&probe name = 'a', body = 1, place = 0, 0 /", "&probe is for body 1, of which there are 2 copies"},
                 {"&probe name = 'a', number = 3 /", NULL}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[512];
        (void)snprintf(text, sizeof text, "%s%s", two, cases[k].group);
        expect(text, 4, cases[k].word);
    }
}
