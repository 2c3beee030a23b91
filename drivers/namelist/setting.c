/* SPDX-License-Identifier: BSD-3-Clause */
/* A setting is read as a deck of one group with one key, which then joins the groups of the deck. A shell takes quotes
 * away, so that the value of a string key may come without them; it gets them before it is read. */
#include "setting.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "scan.h"
#include "schema.h"

enum { MOST_DIGITS = 6, NAME = 64 };

bool setting_parse(setting *out, const char *text)
{
    const size_t name = scan_name_length(text);
    const char *rest = text + name;
    *out = (setting){.text = text, .name_length = (int)name};
    if (*rest == '(') {
        const size_t n = strspn(rest + 1, "0123456789");
        if (n == 0 || n > MOST_DIGITS || rest[n + 1] != ')') return false;
        out->number = strtol(rest + 1, NULL, 10);
        if (out->number < 1) return false;
        rest += n + 2;
    }
    if (name == 0 || name >= NAME || *rest != '.') return false;
    out->assignment = rest + 1;
    const size_t key = scan_name_length(out->assignment);
    return key > 0 && out->assignment[key] == '=';
}

static bool is_name(const char *name, const char *text, size_t n)
{
    return strlen(name) == n && strncasecmp(name, text, n) == 0;
}

/* The key as the table has it; NULL: it is none of the table. */
static const schema_key *find_key(const setting *s)
{
    int n_groups;
    const schema_group *groups = schema_groups(&n_groups);
    const size_t length = scan_name_length(s->assignment);
    for (int g = 0; g < n_groups; g++)
        for (int k = 0; k < groups[g].n_keys && is_name(groups[g].name, s->text, (size_t)s->name_length); k++)
            if (is_name(groups[g].keys[k].name, s->assignment, length)) return &groups[g].keys[k];
    return NULL;
}

/* Puts a text in quotes; where it is several values, each between two commas. */
static void quote(char *out, const char *text, bool several)
{
    const char *joint = "', '";
    *out++ = '\'';
    for (; *text != '\0'; text++) {
        if (several && *text == ',') {
            for (const char *c = joint; *c != '\0'; c++) *out++ = *c;
            text += strspn(text + 1, " ");
            continue;
        }
        if (*text == '\'') *out++ = '\'';
        *out++ = *text;
    }
    *out++ = '\'';
    *out = '\0';
}

/* The assignment as a deck has it, malloc'ed; NULL when memory runs out. */
static char *spell_assignment(const setting *s)
{
    const schema_key *key = find_key(s);
    const char *value = strchr(s->assignment, '=') + 1;
    const char *first = value + strspn(value, " ");
    const size_t head = (size_t)(value - s->assignment);
    const bool string = key != NULL && (key->type == SCHEMA_STRING || key->type == SCHEMA_CHOICE);
    char *text = malloc(head + 4 * strlen(value) + 3); /* a comma becomes four characters */
    if (text == NULL) return NULL;
    memcpy(text, s->assignment, head);
    if (string && *first != '\0' && *first != '\'' && *first != '"')
        quote(text + head, first, key->max_count != 1);
    else
        strcpy(text + head, value);
    return text;
}

static void move_to_line(namelist_group *group, int line)
{
    group->place.line = line;
    for (size_t k = 0; k < group->n_keys; k++) {
        namelist_key *key = &group->keys[k];
        key->place.line = line;
        for (size_t v = 0; v < key->n_values; v++) key->values[v].place.line = line;
    }
}

/* Whether the text was one assignment and no more; reports the first fault of syntax. */
static bool is_good(const namelist *own, const namelist_errors *found, namelist_place place, namelist_errors *errors)
{
    if (found->n > 0) namelist_errors_add(errors, place, "%s", found->list[0].text);
    if (found->n > 0) return false;
    if (own->n_groups == 1 && own->groups[0].n_keys == 1) return true;
    namelist_errors_add(errors, place, "one key and its value are expected");
    return false;
}

/* Of the group that is meant; list->n_groups: a new one. False if there is none. */
static bool find_group(const setting *s, const namelist *list, const char *name, namelist_place place,
                       namelist_errors *errors, size_t *found)
{
    long n = 0;
    *found = list->n_groups;
    for (size_t k = 0; k < list->n_groups; k++) {
        if (strcmp(list->groups[k].name, name) != 0) continue;
        if (++n == s->number || s->number == 0) *found = k;
    }
    if (s->number == 0 && n > 1)
        namelist_errors_add(errors, place, "there are %ld groups &%s; write %s(1) to %s(%ld)", n, name, name, name, n);
    else if (s->number > n && n > 0)
        namelist_errors_add(errors, place, "there %s only %ld &%s", n == 1 ? "is" : "are", n, name);
    else if (s->number > 1 && n == 0)
        namelist_errors_add(errors, place, "there is no &%s", name);
    else
        return true;
    return false;
}

static bool join(const setting *s, namelist_place place, namelist *list, namelist_group *group, namelist_errors *errors)
{
    size_t at;
    if (!find_group(s, list, group->name, place, errors, &at)) return true;
    move_to_line(group, place.line);
    return namelist_merge(list, at, group);
}

bool setting_apply(const setting *s, int line, namelist *list, namelist_errors *errors)
{
    const namelist_place place = {line, 1};
    namelist own = {0};
    namelist_errors found = {0};
    char *assignment = spell_assignment(s);
    const size_t size = assignment == NULL ? 0 : (size_t)s->name_length + strlen(assignment) + 16;
    char *text = assignment == NULL ? NULL : malloc(size);
    if (text != NULL) (void)snprintf(text, size, "&%.*s\n%s\n/\n", s->name_length, s->text, assignment);
    free(assignment);
    if (text == NULL) return false;
    bool good = namelist_parse(&own, text, strlen(text), &found);
    if (good && is_good(&own, &found, place, errors)) good = join(s, place, list, &own.groups[0], errors);
    errors->out_of_memory = errors->out_of_memory || found.out_of_memory;
    namelist_errors_free(&found);
    namelist_free(&own);
    free(text);
    return good;
}
