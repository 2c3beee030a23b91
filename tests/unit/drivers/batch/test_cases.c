/* SPDX-License-Identifier: BSD-3-Clause */
/* cases.c: lists and the pick of one. */
#include "unit/close.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "cases.h"
#include "unit/scratch.h"

static char listed[SCRATCH_PATH + 1];

static int make_list(void **state)
{
    if (scratch_make(state) != 0) return 1;
    const char *list = scratch_file("list");
    (void)snprintf(listed, sizeof listed, "@%s", list);
    FILE *file = fopen(list, "w");
    return file == NULL || fputs("#c\n b #1 \r\n\n/d\ne", file) < 0 || fclose(file) != 0;
}

static command ask(const char **decks, size_t n, long index)
{
    return (command){.decks = decks, .n_decks = n, .index = index};
}

TEST(lists_stand_for_their_decks)
{
    const char *decks[] = {"a", listed, "f"};
    char b[SCRATCH_PATH], e[SCRATCH_PATH];
    (void)snprintf(b, sizeof b, "%s/b #1", scratch.path);
    (void)snprintf(e, sizeof e, "%s/e", scratch.path);
    const char *const expected[] = {"a", b, "/d", e, "f"};
    for (long index = 0; index <= 5; index++) {
        const command c = ask(decks, 3, index);
        outcome o = {0};
        CLEANUP(cases_free) cases all;
        assert_true(cases_find(&all, &c, &o));
        assert_int_equal(all.n, index == 0 ? 5 : 1);
        for (size_t k = 0; k < all.n; k++)
            assert_string_equal(all.paths[k], expected[index == 0 ? (long)k : index - 1]);
    }
}

TEST(what_is_not_there_is_a_fault)
{
    const char *decks[] = {listed, "@/no/list"};
    const command past = ask(decks, 1, 4), missing = ask(decks, 2, 1);
    outcome o = {0};
    CLEANUP(cases_free) cases all;
    assert_false(cases_find(&all, &past, &o));
    assert_int_equal(o.code, EXIT_USAGE);
    cases_free(&all);
    o = (outcome){0};
    assert_false(cases_find(&all, &missing, &o));
    assert_int_equal(o.code, EXIT_INVALID);
}

TEST_GROUP(make_list, scratch_remove);
