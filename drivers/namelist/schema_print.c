/* SPDX-License-Identifier: BSD-3-Clause */
/* What is printed from the table: the resolved echo, the template and the reference of all keys. */
#include "schema.h"

#include "decimal.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LINE = 100,      /* column from which on the values of a key go on in the next line */
    LEAST_REPEAT = 4 /* equal values written as r*c */
};

static const char *const type_names[] = {"real", "integer", "logical", "string", "string"};

/* ---- echo ---------------------------------------------------------------------------------------------------- */

static int print_string(FILE *file, const char *text)
{
    int n = 2;
    (void)fputc('\'', file);
    for (const char *c = text; *c != '\0'; c++, n++) {
        if (*c == '\'') n += fprintf(file, "'");
        (void)fputc(*c, file);
    }
    (void)fputc('\'', file);
    return n;
}

/* Returns the number of characters written. */
static int print_value(FILE *file, const schema_key *key, const schema_value *value, int k)
{
    char number[DECIMAL_SIZE];
    switch (key->type) {
    case SCHEMA_STRING:
    case SCHEMA_CHOICE:
        return print_string(file, value->texts[k]);
    case SCHEMA_LOGICAL:
        return fprintf(file, "%s", value->reals[k] != 0 ? ".true." : ".false.");
    case SCHEMA_INTEGER:
        return fprintf(file, "%" PRId64, (int64_t)value->reals[k]);
    case SCHEMA_REAL:
        break;
    }
    decimal_print(number, value->reals[k]);
    return fprintf(file, "%s", number);
}

static int count_equal(const schema_value *value, int k)
{
    int n = 1;
    while (value->reals != NULL && k + n < value->count &&
           memcmp(&value->reals[k], &value->reals[k + n], sizeof value->reals[k]) == 0)
        n++;
    return n >= LEAST_REPEAT ? n : 1;
}

static void print_values(FILE *file, const schema_key *key, const schema_value *value)
{
    int column = fprintf(file, "    %s = ", key->name);
    const int indent = column;
    for (int k = 0; k < value->count;) {
        const int repeat = count_equal(value, k);
        if (k > 0 && column < LINE)
            column += fprintf(file, ", ");
        else if (k > 0)
            column = fprintf(file, ",\n%*s", indent, "") - 2;
        if (repeat > 1) column += fprintf(file, "%d*", repeat);
        column += print_value(file, key, value, k);
        k += repeat;
    }
}

static void echo_key(FILE *file, const schema_key *key, const schema_value *value, bool marks)
{
    if (value->count > 0) {
        print_values(file, key, value);
        (void)fprintf(file, "%s\n", marks && !value->given ? " ! default" : "");
    } else if (marks) {
        (void)fprintf(file, "    ! %s = (not given)\n", key->name);
    }
}

/* Keys on which neither a number that is computed nor a row that is written depends. */
static bool is_aside(const char *group, const char *key)
{
    static const char *const all[][2] = {{"run", "title"},      {"run", "t_end"},      {"contact", "max_impacts"},
                                         {"solver", "kernel"},  {"solver", "threads"}, {"output", "name"},
                                         {"output", "deflate"}, {"output", "closure"}, {"output", "most_stressed"},
                                         {"output", "measure"}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        if (strcmp(group, all[k][0]) == 0 && strcmp(key, all[k][1]) == 0) return true;
    return false;
}

static bool has_key(schema_form form, const schema_group *group, int k)
{
    if (form == SCHEMA_PHYSICS) return group->keys[k].physics;
    return form != SCHEMA_COURSE || !is_aside(group->name, group->keys[k].name);
}

static bool has_keys(schema_form form, const schema_group *group)
{
    for (int k = 0; k < group->n_keys; k++)
        if (has_key(form, group, k)) return true;
    return false;
}

static void echo_instance(FILE *file, const schema_instance *instance, schema_form form)
{
    const schema_group *group = instance->group;
    if (!has_keys(form, group)) return;
    (void)fprintf(file, "&%s\n", group->name);
    for (int k = 0; k < group->n_keys; k++)
        if (has_key(form, group, k)) echo_key(file, &group->keys[k], &instance->values[k], form == SCHEMA_MARKED);
    (void)fprintf(file, "/\n");
}

/* ---- template ------------------------------------------------------------------------------------------------ */

static bool is_required(const schema_key *key)
{
    return key->initial == NULL;
}

static bool stays_not_given(const schema_key *key)
{
    return key->initial != NULL && key->initial[0] == '\0';
}

/* Many choices take several lines.  \return the width of the last */
static size_t print_choices(FILE *file, const char *choices)
{
    size_t width = 0;
    for (const char *c = choices; *c != '\0'; c++) {
        (void)fputc(*c, file);
        if (++width < 72 || *c != '|') continue;
        (void)fprintf(file, "\n    !     ");
        width = 0;
    }
    return width;
}

static void print_facts(FILE *file, const schema_key *key)
{
    size_t width = 0;
    (void)fprintf(file, "    ! [%s", type_names[key->type]);
    if (key->max_count == 0) (void)fprintf(file, "s, at least %d", key->min_count);
    if (key->max_count > key->min_count)
        (void)fprintf(file, "s, %d to %d of them", key->min_count, key->max_count);
    else if (key->max_count > 1)
        (void)fprintf(file, "s, %d of them", key->max_count);
    if (strcmp(key->unit, "-") != 0) (void)fprintf(file, ", %s", key->unit);
    if (key->range[0] != '\0') (void)fprintf(file, ", %s%s", key->range[0] == '[' ? "in " : "", key->range);
    if (key->choices != NULL) {
        (void)fprintf(file, ", ");
        width = print_choices(file, key->choices);
    }
    if (is_required(key))
        (void)fprintf(file, "; must be given");
    else if (!stays_not_given(key))
        (void)fprintf(file, ";%sdefault: %s", width + strlen(key->initial) > LINE ? "\n    !  " : " ", key->initial);
    (void)fprintf(file, "]\n");
}

static void print_template_key(FILE *file, const schema_key *key)
{
    (void)fprintf(file, "    ! %s\n", key->sentence);
    print_facts(file, key);
    const char *value = key->example != NULL ? key->example : key->initial;
    if (value[0] == '\0')
        (void)fprintf(file, "    ! %s =\n", key->name);
    else
        (void)fprintf(file, "    %s = %s\n", key->name, value);
}

/* ---- reference ----------------------------------------------------------------------------------------------- */

/* A table's cell must not hold a bare '|'. */
static void print_cell(FILE *file, const char *text)
{
    for (; *text != '\0'; text++) {
        if (*text == '|') (void)fputc('\\', file);
        (void)fputc(*text, file);
    }
}

static void print_type(FILE *file, const schema_key *key)
{
    if (key->max_count == 0)
        (void)fprintf(file, "%d or more ", key->min_count);
    else if (key->max_count > key->min_count)
        (void)fprintf(file, "%d to %d ", key->min_count, key->max_count);
    else if (key->max_count > 1)
        (void)fprintf(file, "%d ", key->max_count);
    (void)fprintf(file, "%s%s", type_names[key->type], key->max_count == 1 ? "" : "s");
}

static void print_row(FILE *file, const schema_key *key)
{
    (void)fprintf(file, "| `%s` | ", key->name);
    print_type(file, key);
    (void)fprintf(file, " | %s | ", key->unit);
    if (is_required(key))
        (void)fprintf(file, "must be given");
    else if (stays_not_given(key))
        (void)fprintf(file, "not given");
    else
        (void)fprintf(file, "`%s`", key->initial);
    (void)fprintf(file, " | ");
    print_cell(file, key->choices != NULL ? key->choices : key->range);
    (void)fprintf(file, " | %s |\n", key->sentence);
}

static const char *occurrence(const schema_group *group)
{
    if (group->repeated) return group->required ? "At least once." : "Any number of times.";
    return group->required ? "Exactly once." : "At most once.";
}

static void print_table(FILE *file, const schema_group *group)
{
    (void)fprintf(file, "\n## &%s\n\n%s %s\n\n", group->name, group->sentence, occurrence(group));
    (void)fprintf(file, "| key | type | unit | default | values | meaning |\n|---|---|---|---|---|---|\n");
    for (int k = 0; k < group->n_keys; k++) print_row(file, &group->keys[k]);
}

/* ---- public -------------------------------------------------------------------------------------------------- */

bool schema_echo(const schema_deck *deck, schema_form form, char **out)
{
    size_t size = 0;
    *out = NULL;
    FILE *file = open_memstream(out, &size);
    if (file == NULL) return false;
    for (size_t k = 0; k < deck->n_instances; k++) echo_instance(file, &deck->instances[k], form);
    const bool good = ferror(file) == 0;
    if (fclose(file) == 0 && good && *out != NULL) return true; /* glibc closes without memory, and says nothing */
    free(*out);
    *out = NULL;
    return false;
}

void schema_template(FILE *file)
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    (void)fprintf(file, "! Every key of a deck, with its default or an example; written by dem_batch --template.\n"
                        "! Units are SI. Lengths and places are in the plane of the motion, y points up.\n");
    for (int g = 0; g < n_groups; g++) {
        (void)fprintf(file, "\n&%s\n    ! %s %s\n", groups[g].name, groups[g].sentence, occurrence(&groups[g]));
        for (int k = 0; k < groups[g].n_keys; k++) print_template_key(file, &groups[g].keys[k]);
        (void)fprintf(file, "/\n");
    }
}

void schema_document(FILE *file)
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    (void)fprintf(file,
                  "# The deck\n\n"
                  "<!-- Generated by `dem_batch --keys` from drivers/namelist/schema_table.c; do not edit. -->\n\n"
                  "A deck is a text file of Fortran namelist groups, `&name key = value, ... /`. Names may be in\n"
                  "any case, `!` begins a comment, strings stand in quotes, and text between groups is ignored.\n"
                  "An unknown group or key, a wrong type and a value out of range are errors. Units are SI.\n");
    for (int g = 0; g < n_groups; g++) print_table(file, &groups[g]);
}
