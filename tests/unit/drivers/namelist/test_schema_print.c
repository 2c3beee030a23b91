/* SPDX-License-Identifier: BSD-3-Clause */
/* schema_print.c: the forms of the echo, the template and the reference of all keys. */
#include "unit/reading.h"

#include <stdlib.h>

#define MATERIAL "&material youngs_modulus = 1e7, density = 1050 /\n"
#define BODY     "&body shape = 'disc', radius = 0.1, spacing = 0.02 /\n"
#define RUN      "&run t_end = 1 /\n"

static char *echo_of(const char *text, schema_form form)
{
    char *echo;
    CLEANUP(drop_resolved) resolved r = resolve_clean(text);
    assert_true(schema_echo(&r.deck, form, &echo));
    return echo;
}

static char *printed(void (*print)(FILE *))
{
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    print(file);
    assert_int_equal(fclose(file), 0);
    return text;
}

static void assert_contains(const char *text, const char *part)
{
    if (strstr(text, part) == NULL) fail_msg("'%s' is not in\n%s", part, text);
}

static void assert_lacks(const char *text, const char *part)
{
    if (strstr(text, part) != NULL) fail_msg("'%s' is in\n%s", part, text);
}

/* Same groups, counts and bits; what is given may differ. */
static void assert_same_deck(const schema_deck *a, const schema_deck *b)
{
    assert_int_equal(a->n_instances, b->n_instances);
    for (size_t i = 0; i < a->n_instances; i++) {
        const schema_instance *p = &a->instances[i], *q = &b->instances[i];
        assert_ptr_equal(p->group, q->group);
        for (int k = 0; k < p->group->n_keys; k++) {
            const schema_value *v = &p->values[k], *w = &q->values[k];
            assert_int_equal(v->count, w->count);
            for (int j = 0; j < v->count; j++) {
                if (v->texts != NULL)
                    assert_string_equal(v->texts[j], w->texts[j]);
                else
                    assert_memory_equal(&v->reals[j], &w->reals[j], sizeof(double));
            }
        }
    }
}

static void assert_echo_reads_back(const char *text)
{
    CLEANUP(free_memory) char *echo = echo_of(text, SCHEMA_MARKED);
    CLEANUP(drop_resolved) resolved a = resolve_clean(text), b = resolve_clean(echo);
    assert_same_deck(&a.deck, &b.deck);
}

/* ---- echo ----------------------------------------------------------------------------------------------------- */

TEST(the_echo_marks_defaults_and_what_is_not_given)
{
    CLEANUP(free_memory) char *echo = echo_of("&run t_end = 2d-2 /" MATERIAL BODY, SCHEMA_MARKED);
    assert_contains(echo, "&run\n    title = '' ! default\n    t_end = 0.02\n    gravity = 0, -9.81 ! default\n"
                          "    ! residual = (not given)\n    pause = .false. ! default\n/\n");
    assert_contains(echo, "    ! clearance = (not given)\n");
    assert_contains(echo, "&solver\n    method = 'fehlberg45' ! default\n    rtol = 1e-06 ! default\n");
}

TEST(the_echo_reads_back_to_the_same_values)
{
    assert_echo_reads_back(RUN MATERIAL BODY);
    assert_echo_reads_back(
        "&run title = 'it''s \"q\" \xC3\xA9 / ! &x' t_end = 0.1 gravity = -0., 0.30000000000000004 /" MATERIAL
        "&body shape = 'file' file = 'a/b.h5' position = 4.9e-324, 1.7976931348623157e308 /"
        "&pores number = 2 radius = 1.1, 2.2 seed = 9007199254740992 /"
        "&obstacle points = 5*0., -0., 1, 2, 3e22, 123456789012345678, 2*.1 /");
}

TEST(reals_have_no_more_digits_than_they_need)
{
    static const struct {
        const char *given, *printed;
    } cases[] = {{"0.10000", "0.1"},
                 {"0.30000000000000004", "0.30000000000000004"},
                 {"0.3333333333333333", "0.3333333333333333"},
                 {"-1d22", "-1e+22"},
                 {"4.9406564584124654e-324", "4.94065645841247e-324"}, /* 15 digits at least are tried */
                 {"123456789.", "123456789"},
                 {"-0.", "-0.0"},
                 {"5.0e-7", "5e-07"}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        char text[256], line[64];
        (void)snprintf(text, sizeof text, "&run t_end = 1, gravity = 0, %s /\n" MATERIAL BODY, cases[k].given);
        (void)snprintf(line, sizeof line, "    gravity = 0, %s\n", cases[k].printed);
        CLEANUP(free_memory) char *echo = echo_of(text, SCHEMA_BARE);
        assert_contains(echo, line);
    }
}

TEST(quotes_in_strings_are_doubled)
{
    CLEANUP(free_memory)
    char *echo = echo_of("&run t_end = 1, title = \"it's 'so', \"\"you\"\" say\" /\n" MATERIAL BODY, SCHEMA_BARE);
    assert_contains(echo, "    title = 'it''s ''so'', \"you\" say'\n");
}

TEST(integers_are_printed_with_all_their_digits)
{
    CLEANUP(free_memory)
    char *echo =
        echo_of(RUN MATERIAL BODY "&pores number = 1000000, radius = 1, 1, seed = 9007199254740991 /", SCHEMA_BARE);
    assert_contains(echo, "    number = 1000000\n");
    assert_contains(echo, "    seed = 9007199254740991\n");
}

/* Every group of the deck is there, in the order of the table, closed by a line of its own. */
TEST(the_echo_has_every_group_of_the_deck)
{
    CLEANUP(free_memory)
    char *echo = echo_of("&body shape = 'disc', angle = 2 / &void centre = 1, 2 /" MATERIAL RUN BODY, SCHEMA_MARKED);
    static const char *const parts[] = {"&run\n",     "/\n&material\n", "/\n&body\n",   "    angle = 2\n", "/\n&body\n",
                                        "/\n&void\n", "/\n&contact\n",  "/\n&solver\n", "/\n&output\n"};
    const char *at = echo;
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; k++) {
        assert_contains(at, parts[k]);
        at = strstr(at, parts[k]) + 1;
    }
    assert_lacks(echo, "&pores");
    assert_string_equal(echo + strlen(echo) - 3, "\n/\n");
}

TEST(long_arrays_go_on_in_the_next_line)
{
    char text[8000] = RUN MATERIAL BODY "&obstacle points = ";
    for (int k = 0; k < 400; k++) (void)snprintf(text + strlen(text), 20, "%.6f ", sin(k));
    (void)snprintf(text + strlen(text), 10, "/");
    CLEANUP(free_memory) char *echo = echo_of(text, SCHEMA_MARKED);
    size_t longest = 0;
    for (const char *line = echo; *line != '\0'; line += strcspn(line, "\n") + 1)
        if (strcspn(line, "\n") > longest) longest = strcspn(line, "\n");
    assert_in_range(longest, 100, 130);
    assert_echo_reads_back(text);
}

TEST(equal_values_are_repeated_in_the_echo)
{
    CLEANUP(free_memory)
    char *echo = echo_of(RUN MATERIAL BODY "&obstacle points = 1000*0.5, 3*1, 4*0, 4*-0 /", SCHEMA_MARKED);
    assert_contains(echo, "points = 1000*0.5, 1, 1, 1, 4*0, 4*-0.0\n");
}

TEST(a_bare_echo_is_the_same_for_its_deck_and_its_echo)
{
    CLEANUP(free_memory)
    char *marked = echo_of(RUN MATERIAL BODY, SCHEMA_MARKED), *bare = echo_of(RUN MATERIAL BODY, SCHEMA_BARE);
    CLEANUP(free_memory) char *stated = echo_of("&run gravity = 0., -9.81, t_end = 1.0 /" MATERIAL BODY, SCHEMA_BARE);
    CLEANUP(free_memory)
    char *again = echo_of(marked, SCHEMA_BARE), *other = echo_of("&run t_end = 2 /" MATERIAL BODY, SCHEMA_BARE);
    assert_string_equal(again, bare);
    assert_string_equal(stated, bare);
    assert_string_not_equal(other, bare);
    assert_contains(bare, "    gravity = 0, -9.81\n");
    assert_lacks(bare, "!");
}

TEST(the_physics_is_the_same_however_it_is_written)
{
    CLEANUP(free_memory) char *a = echo_of(RUN MATERIAL BODY, SCHEMA_PHYSICS);
    CLEANUP(free_memory)
    char *b =
        echo_of(BODY "&solver rtol = 1d-6 / &output name = 'other' /\n&material density = 1.05e3, youngs_modulus = "
                     "10000000., thickness = 1. /\n&run t_end = 7, title = 'x', gravity = 0., -9.81 /",
                SCHEMA_PHYSICS);
    assert_string_equal(a, b);
    assert_lacks(a, "default");
    assert_lacks(a, "t_end");
    assert_lacks(a, "&output");
}

TEST(the_physics_depends_on_every_physical_key)
{
    static const char *const changes[] = {"&solver rtol = 1e-5 /", "&contact penetration_tolerance = 1e-9 /",
                                          "&void centre = 0, 0 /"};
    CLEANUP(free_memory) char *a = echo_of(RUN MATERIAL BODY, SCHEMA_PHYSICS);
    for (size_t k = 0; k < 3; k++) {
        char text[512];
        (void)snprintf(text, sizeof text, "%s%s", RUN MATERIAL BODY, changes[k]);
        CLEANUP(free_memory) char *b = echo_of(text, SCHEMA_PHYSICS);
        assert_string_not_equal(a, b);
    }
}

/* ---- template and reference ----------------------------------------------------------------------------------- */

TEST(the_template_is_a_deck_with_every_key)
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    CLEANUP(free_memory) char *text = printed(schema_template);
    CLEANUP(drop_resolved) resolved r = resolve_clean(text);
    for (int g = 0; g < n_groups; g++) {
        assert_int_equal(schema_count(&r.deck, groups[g].name), 1);
        const schema_instance *instance = schema_get(&r.deck, groups[g].name, 0);
        for (int k = 0; k < groups[g].n_keys; k++) {
            char comment[80];
            (void)snprintf(comment, sizeof comment, "    ! %s =\n", groups[g].keys[k].name);
            if (!instance->values[k].given) assert_contains(text, comment);
            assert_contains(text, groups[g].keys[k].sentence);
        }
    }
}

TEST(the_reference_has_a_row_for_every_key)
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    CLEANUP(free_memory) char *text = printed(schema_document);
    for (int g = 0; g < n_groups; g++) {
        for (int k = 0; k < groups[g].n_keys; k++) {
            char row[80];
            (void)snprintf(row, sizeof row, "\n| `%s` | ", groups[g].keys[k].name);
            assert_contains(text, row);
        }
    }
    assert_contains(text, "| `gravity` | 2 reals | m/s^2 | `0, -9.81` |  | Acceleration of free fall, x and y. |");
    assert_contains(
        text,
        "| `shape` | string | - | must be given | rectangle\\|disc\\|ring\\|polygon\\|mask\\|mesh\\|file | Shape");
    assert_contains(text, "| `points` | 4 or more reals | m | must be given |  | x and y");
}

static const char *initial_of(const schema_key *key)
{
    return key->initial != NULL ? key->initial : "";
}

/* The part of `text` between two lines, as a copy. */
static char *part_of(const char *text, const char *from, const char *to)
{
    assert_contains(text, from);
    const char *begin = strstr(text, from) + strlen(from), *end = strstr(begin, to);
    const size_t n = end != NULL ? (size_t)(end - begin) : strlen(begin);
    char *part = malloc(n + 1);
    assert_non_null(part);
    memcpy(part, begin, n);
    part[n] = '\0';
    return part;
}

TEST(the_template_has_an_example_or_the_default_of_every_key)
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    CLEANUP(free_memory) char *text = printed(schema_template);
    for (int g = 0; g < n_groups; g++) {
        char head[64], line[256];
        (void)snprintf(head, sizeof head, "\n&%s\n", groups[g].name);
        CLEANUP(free_memory) char *group = part_of(text, head, "\n/\n");
        assert_contains(group, groups[g].sentence);
        for (int k = 0; k < groups[g].n_keys; k++) {
            const schema_key *key = &groups[g].keys[k];
            const char *value = key->example != NULL ? key->example : initial_of(key);
            (void)snprintf(line, sizeof line, "\n    %s%s =%s%s", value[0] == '\0' ? "! " : "", key->name,
                           value[0] == '\0' ? "" : " ", value);
            assert_contains(group, line);
        }
    }
}

TEST(the_template_tells_type_unit_range_choices_and_default)
{
    CLEANUP(free_memory) char *text = printed(schema_template);
    assert_contains(text, "\n    ! [real, s, > 0; must be given]\n    t_end = ");
    assert_contains(text, "\n    ! [reals, 2 of them, m/s^2; default: 0, -9.81]\n    gravity = 0, -9.81\n");
    assert_contains(text, "\n    ! [reals, 2 to 4 of them, m]\n    place = ");
    assert_contains(text, "|damage|\n    !     strain|force; default: 'displacement', "); /* too long for one line */
    assert_contains(text, "\n    ! [reals, at least 4, m; must be given]\n    points = ");
    assert_contains(text, "\n    ! [string, single|double; default: 'single']\n    precision = 'single'\n");
    assert_contains(text, "\n    ! [integer, in [0, 9]; default: 1]\n    deflate = 1\n");
    assert_contains(text, "\n    ! [real, m, > 0]\n"); /* neither given nor a default */
}

TEST(lines_of_the_template_fit_the_screen)
{
    CLEANUP(free_memory) char *text = printed(schema_template);
    for (const char *line = text; *line != '\0'; line += strcspn(line, "\n") + 1)
        assert_in_range(strcspn(line, "\n"), 0, 120);
}

TEST(the_reference_tells_how_often_a_group_may_occur)
{
    static const struct {
        const char *head, *occurrence;
    } cases[] = {{"\n## &run\n\n", " Exactly once."},
                 {"\n## &body\n\n", " At least once."},
                 {"\n## &void\n\n", " Any number of times."},
                 {"\n## &solver\n\n", " At most once."}};
    CLEANUP(free_memory) char *text = printed(schema_document);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        CLEANUP(free_memory) char *sentence = part_of(text, cases[k].head, "\n\n| key | type | unit |");
        const size_t n = strlen(sentence), length = strlen(cases[k].occurrence);
        assert_true(n > length);
        assert_string_equal(sentence + n - length, cases[k].occurrence);
    }
}

/* In Markdown a row has as many cells as its head: bars within cells are escaped. */
TEST(rows_of_the_reference_have_six_cells)
{
    CLEANUP(free_memory) char *text = printed(schema_document);
    int n_rows = 0;
    for (const char *line = text; *line != '\0'; line += strcspn(line, "\n") + 1) {
        int n_bars = 0;
        if (*line != '|') continue;
        for (const char *c = line; *c != '\n'; c++) n_bars += *c == '|' && (c == line || c[-1] != '\\');
        assert_int_equal(n_bars, 7);
        n_rows++;
    }
    int n_groups, n_keys = 0;
    const schema_group *groups = schema_groups(&n_groups);
    for (int g = 0; g < n_groups; g++) n_keys += groups[g].n_keys;
    assert_int_equal(n_rows, n_keys + 2 * n_groups);
}

TEST(the_reference_tells_what_must_be_given_and_what_need_not)
{
    CLEANUP(free_memory) char *text = printed(schema_document);
    assert_contains(text, "| `t_end` | real | s | must be given | > 0 | ");
    assert_contains(text, "| `clearance` | real | m | not given | >= 0 | ");
    assert_contains(text, "| `deflate` | integer | - | `1` | [0, 9] | ");
}
