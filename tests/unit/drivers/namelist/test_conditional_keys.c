/* SPDX-License-Identifier: BSD-3-Clause */
/* conditional_keys.c: keys that a choice needs, and keys that it does not use. */
#include "unit/reading.h"

#include "conditional_keys.h"

#define HEAD "&run t_end = 1 /\n&body shape = 'disc' /\n"

static const conditional_key keys[] = {{"size", "rectangle", true}, {"radius", "disc", true}, {"body", "disc", false}};
static const conditional_keys table = {"void", "shape", sizeof keys / sizeof *keys, keys};

/* What is said of all voids, besides the faults of resolving. */
static void expect(const char *text, const char *expected)
{
    char got[1024];
    resolved r = resolve(text);
    for (size_t k = 0; k < schema_count(&r.deck, "void"); k++)
        conditional_keys_check(schema_get(&r.deck, "void", k), &table, &r.errors);
    namelist_errors_sort(&r.errors);
    list_faults(&r.errors, got, sizeof got);
    drop_resolved(&r);
    assert_string_equal(got, expected);
}

TEST(keys_that_are_needed_and_used_are_no_fault)
{
    expect(HEAD "&void centre = 0, 0, radius = 1 /\n&void shape = 'rectangle', centre = 0, 0, size = 1, 1 /\n", "");
    expect(HEAD "&void centre = 0, 0, radius = 1, body = 1 /\n", "");
}

TEST(what_a_choice_needs_and_what_it_does_not_use_is_named)
{
    expect(HEAD "&void centre = 0, 0, size = 1, 1 /\n", "3:1 'radius' in &void must be given for shape 'disc'\n"
                                                        "3:22 'size' in &void is not used by shape 'disc'");
}

TEST(a_key_at_fault_is_not_missed)
{
    expect(HEAD "&void centre = 0, 0, radius = -1 /\n", "3:31 'radius' in &void must be > 0, got -1");
    expect(HEAD "&void centre = 0, 0, radus = 1 /\n", "3:22 unknown key 'radus' in &void (did you mean 'radius'?)");
}

/* The default of the choice stands in, and was not meant. */
TEST(a_choice_at_fault_says_nothing_of_other_keys)
{
    expect(HEAD "&void centre = 0, 0, size = 1, 1, shape = 'rectangel' /\n",
           "3:43 'shape' in &void must be 'disc', 'rectangle', 'ring' or 'polygon', got 'rectangel' (did you mean "
           "'rectangle'?)");
}

TEST(defaults_that_are_not_used_are_dropped)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(HEAD "&void centre = 0, 0, radius = 1 /\n"
                                    "&void shape = 'rectangle', centre = 0, 0, size = 1, 1 /\n");
    conditional_keys_drop(&r.deck, &table);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "void", 0), "body")->count, 1);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "void", 0), "radius")->count, 1);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "void", 1), "body")->count, 0);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "void", 1), "size")->count, 2);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "body", 0), "position")->count, 2);
}
