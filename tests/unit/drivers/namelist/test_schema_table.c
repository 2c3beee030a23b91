/* SPDX-License-Identifier: BSD-3-Clause */
/* schema_table.c: the table keeps the rules that its readers rely on. */
#include "unit/reading.h"

#include <ctype.h>
#include <stdlib.h>

#define LENGTH(array) (sizeof(array) / sizeof(array)[0])

/* Calls `look` for every key of the table. */
static void for_each_key(void (*look)(const schema_group *group, const schema_key *key))
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    assert_true(n_groups > 0);
    for (int g = 0; g < n_groups; g++)
        for (int k = 0; k < groups[g].n_keys; k++) look(&groups[g], &groups[g].keys[k]);
}

static int is_listed(const char *word, const char *const *words, size_t n)
{
    for (size_t k = 0; k < n; k++)
        if (strcmp(word, words[k]) == 0) return 1;
    return 0;
}

static int has_default(const schema_key *key)
{
    return key->initial != NULL && key->initial[0] != '\0';
}

/* ---- names ---- */

/* As design.md 7 has them, in the order of a deck. */
static const char *const designed[] = {"run",      "material", "body",     "void",    "pores",  "crack",  "inclusion",
                                       "weakness", "boundary", "obstacle", "contact", "solver", "output", "probe"};

TEST(groups_are_those_of_the_design_in_its_order)
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    size_t next = 0;
    for (int g = 0; g < n_groups; g++) {
        while (next < LENGTH(designed) && strcmp(designed[next], groups[g].name) != 0) next++;
        if (next == LENGTH(designed)) fail_msg("&%s is not designed, or not in its place", groups[g].name);
        next++;
        assert_true(groups[g].n_keys > 0);
    }
}

TEST(every_deck_has_one_run_and_bodies)
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    for (int g = 0; g < n_groups; g++) {
        const int run = strcmp(groups[g].name, "run") == 0, body = strcmp(groups[g].name, "body") == 0;
        assert_int_equal(groups[g].required, run || body);
        if (run) assert_false(groups[g].repeated);
        if (body) assert_true(groups[g].repeated);
    }
}

static void check_name(const char *name)
{
    assert_in_range(strlen(name), 1, 40); /* what messages show of a word */
    assert_true(islower((unsigned char)name[0]));
    for (const char *c = name; *c != '\0'; c++)
        if (!islower((unsigned char)*c) && !isdigit((unsigned char)*c) && *c != '_') fail_msg("'%s'", name);
}

/* The reader turns names into lower case; one spelt otherwise would never be found. */
TEST(names_are_in_lower_case_and_unique)
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    for (int g = 0; g < n_groups; g++) {
        check_name(groups[g].name);
        assert_string_not_equal(groups[g].name, "end");
        for (int h = 0; h < g; h++) assert_string_not_equal(groups[g].name, groups[h].name);
        for (int k = 0; k < groups[g].n_keys; k++) {
            check_name(groups[g].keys[k].name);
            for (int j = 0; j < k; j++) assert_string_not_equal(groups[g].keys[k].name, groups[g].keys[j].name);
        }
    }
}

/* ---- words ---- */

static void check_sentence(const char *sentence)
{
    const size_t n = strlen(sentence);
    assert_in_range(n, 10, 114); /* a line of the template has at most 120 characters */
    if ((!isupper((unsigned char)sentence[0]) && strncmp(sentence, "x and y ", 8) != 0) || sentence[n - 1] != '.')
        fail_msg("'%s'", sentence);
    if (strpbrk(sentence, "|\n") != NULL) fail_msg("'%s' breaks the reference", sentence);
}

static void check_sentence_of_key(const schema_group *group, const schema_key *key)
{
    (void)group;
    check_sentence(key->sentence);
}

TEST(groups_and_keys_have_sentences)
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    for (int g = 0; g < n_groups; g++) check_sentence(groups[g].sentence);
    for_each_key(check_sentence_of_key);
}

static void check_unit(const schema_group *group, const schema_key *key)
{
    static const char *const units[] = {"-",  "m",       "s", "m/s", "m/s^2", "Pa",  "kg/m^3", "N",    "N/m",
                                        "kg", "degrees", "J", "Hz",  "rad/s", "1/s", "m^3",    "J/m^2"};
    if (!is_listed(key->unit, units, LENGTH(units)))
        fail_msg("%s in &%s: unit '%s'", key->name, group->name, key->unit);
    if (key->type != SCHEMA_REAL) assert_string_equal(key->unit, "-");
}

TEST(reals_have_a_unit_and_nothing_else_has)
{
    for_each_key(check_unit);
}

/* ---- numbers of values, ranges, choices ---- */

static void check_counts(const schema_group *group, const schema_key *key)
{
    (void)group;
    assert_true(key->min_count >= 1);
    assert_true(key->max_count == 0 || key->max_count >= key->min_count);
    if (key->type == SCHEMA_STRING || key->type == SCHEMA_LOGICAL) assert_int_equal(key->max_count, 1);
}

TEST(numbers_of_values_make_sense)
{
    for_each_key(check_counts);
}

/* A range, read here once more: from..to, the ends belonging to it or not. */
typedef struct range {
    double from, to;
    int open;
} range;

static range read_range(const schema_key *key)
{
    range r = {-INFINITY, INFINITY, 0};
    char end = '\0';
    if (strcmp(key->range, "") == 0) return r;
    if (sscanf(key->range, "> %lf%c", &r.from, &end) == 1) {
        r.open = 1;
        return r;
    }
    if (sscanf(key->range, ">= %lf%c", &r.from, &end) == 1) return r;
    if (sscanf(key->range, "[%lf, %lf%c", &r.from, &r.to, &end) == 3 && end == ']') return r;
    if (sscanf(key->range, "(%lf, %lf%c", &r.from, &r.to, &end) == 3 && end == ')') {
        r.open = 1;
        return r;
    }
    fail_msg("'%s': range '%s'", key->name, key->range);
    return r;
}

static void check_range(const schema_group *group, const schema_key *key)
{
    (void)group;
    const range r = read_range(key);
    assert_true(r.from < r.to);
    if (key->type != SCHEMA_REAL && key->type != SCHEMA_INTEGER) assert_string_equal(key->range, "");
    if (key->type == SCHEMA_INTEGER) assert_true(r.from >= 0); /* they count or choose */
}

TEST(ranges_can_be_read_and_are_not_empty)
{
    for_each_key(check_range);
}

static void check_choices(const schema_group *group, const schema_key *key)
{
    char all[256];
    const char *seen[32];
    size_t n = 0;
    assert_int_equal(key->type == SCHEMA_CHOICE, key->choices != NULL);
    if (key->choices == NULL) return;
    assert_true(strlen(key->choices) < sizeof all);
    (void)strcpy(all, key->choices);
    for (char *word = all, *next; word != NULL; word = next) {
        next = strchr(word, '|');
        if (next != NULL) *next++ = '\0';
        if (*word == '\0') fail_msg("%s in &%s: an empty choice in '%s'", key->name, group->name, key->choices);
        if (is_listed(word, seen, n)) fail_msg("%s in &%s: '%s' twice", key->name, group->name, word);
        assert_true(n < LENGTH(seen));
        seen[n++] = word;
    }
}

TEST(choices_are_not_empty_and_distinct)
{
    for_each_key(check_choices);
}

/* ---- defaults and examples ---- */

static void add_group(char *text, size_t size, const schema_group *group, const schema_key *key, const char *value)
{
    size_t n = strlen(text);
    n += (size_t)snprintf(text + n, size - n, "&%s", group->name);
    for (int k = 0; k < group->n_keys; k++) {
        const schema_key *other = &group->keys[k];
        if (other != key && other->initial == NULL)
            n += (size_t)snprintf(text + n, size - n, " %s = %s", other->name, other->example);
    }
    if (key != NULL) n += (size_t)snprintf(text + n, size - n, " %s = %s", key->name, value);
    (void)snprintf(text + n, size - n, " /\n");
}

/* A deck with what must be given, and a key with a value; the key's values. */
static resolved resolve_with(const schema_group *group, const schema_key *key, const char *value)
{
    char text[2048] = "";
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    for (int g = 0; g < n_groups; g++)
        if (&groups[g] == group || groups[g].required)
            add_group(text, sizeof text, &groups[g], &groups[g] == group ? key : NULL, value);
    return resolve_clean(text);
}

static void expect_value_passes(const schema_group *group, const schema_key *key, const char *spelling)
{
    CLEANUP(drop_resolved) resolved r = resolve_with(group, key, spelling);
    const schema_value *value = schema_value_of(schema_get(&r.deck, group->name, 0), key->name);
    const range limits = read_range(key);
    assert_true(value->given);
    assert_true(value->count >= key->min_count && (key->max_count == 0 || value->count <= key->max_count));
    assert_int_equal(value->reals != NULL, key->type != SCHEMA_STRING && key->type != SCHEMA_CHOICE);
    for (int j = 0; value->reals != NULL && j < value->count; j++) {
        const double x = value->reals[j];
        if (!(x >= limits.from && x <= limits.to) || (limits.open && (x == limits.from || x == limits.to)))
            fail_msg("%s in &%s: %g is not %s", key->name, group->name, x, key->range);
    }
}

static void check_default(const schema_group *group, const schema_key *key)
{
    if (has_default(key)) expect_value_passes(group, key, key->initial);
}

TEST(defaults_pass_their_own_checks)
{
    for_each_key(check_default);
}

/* Stated or left out, a default is the same. */
static void check_default_is_its_value(const schema_group *group, const schema_key *key)
{
    if (!has_default(key)) return;
    CLEANUP(drop_resolved)
    resolved stated = resolve_with(group, key, key->initial), left_out = resolve_with(group, NULL, NULL);
    const schema_value *a = schema_value_of(schema_get(&stated.deck, group->name, 0), key->name);
    const schema_value *b = schema_value_of(schema_get(&left_out.deck, group->name, 0), key->name);
    assert_false(b->given);
    assert_int_equal(a->count, b->count);
    for (int j = 0; j < a->count; j++) {
        if (a->texts != NULL)
            assert_string_equal(a->texts[j], b->texts[j]);
        else
            assert_memory_equal(&a->reals[j], &b->reals[j], sizeof a->reals[j]);
    }
}

TEST(defaults_are_what_stands_in_the_table)
{
    for_each_key(check_default_is_its_value);
}

static void check_example(const schema_group *group, const schema_key *key)
{
    if (key->initial == NULL && key->example == NULL)
        fail_msg("%s in &%s must be given and has no example", key->name, group->name);
    if (key->example != NULL && key->example[0] != '\0') expect_value_passes(group, key, key->example);
}

TEST(what_must_be_given_has_an_example_and_examples_resolve)
{
    for_each_key(check_example);
}

/* ---- what makes the problem ---- */

static void check_physics(const schema_group *group, const schema_key *key)
{
    static const char *const runs[] = {"title",  "t_end",   "max_impacts",
                                       "kernel", "threads", "thread_nodes"}; /* how long, how reported and how made */
    const int run = strcmp(group->name, "output") == 0 || strcmp(group->name, "probe") == 0;
    if (key->physics != !(run || is_listed(key->name, runs, LENGTH(runs))))
        fail_msg("%s in &%s: physics is %d", key->name, group->name, key->physics);
}

TEST(all_keys_make_the_problem_but_those_of_the_run_and_its_output)
{
    for_each_key(check_physics);
}
