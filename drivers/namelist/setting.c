/* SPDX-License-Identifier: BSD-3-Clause */
/* A setting is read as a deck of one group with one key, which then joins the groups of the deck. */
#include "setting.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scan.h"

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
    const size_t size = strlen(s->text) + 16;
    namelist own = {0};
    namelist_errors found = {0};
    char *text = malloc(size);
    if (text == NULL) return false;
    (void)snprintf(text, size, "&%.*s\n%s\n/\n", s->name_length, s->text, s->assignment);
    bool good = namelist_parse(&own, text, strlen(text), &found);
    if (good && is_good(&own, &found, place, errors)) good = join(s, place, list, &own.groups[0], errors);
    errors->out_of_memory = errors->out_of_memory || found.out_of_memory;
    namelist_errors_free(&found);
    namelist_free(&own);
    free(text);
    return good;
}
