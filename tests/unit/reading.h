/* SPDX-License-Identifier: BSD-3-Clause */
/* A namelist read by a test, as it stands or resolved against the table, and its faults as text. */
#ifndef DEM_TEST_READING_H
#define DEM_TEST_READING_H

#include "unit/close.h"

#include <stdio.h>
#include <string.h>

#include "harness/message.h"
#include "schema.h"

/* What is read from a text. Tests free it with drop(). */
typedef struct reading {
    namelist list;
    namelist_errors errors;
} reading;

static inline reading read_bytes(const char *text, size_t size)
{
    reading out = {0};
    assert_true(namelist_parse(&out.list, text, size, &out.errors));
    namelist_errors_sort(&out.errors);
    return out;
}

static inline reading read_text(const char *text)
{
    return read_bytes(text, strlen(text));
}

static inline void drop(reading *r)
{
    namelist_free(&r->list);
    namelist_errors_free(&r->errors);
}

/* What is resolved from a text. Tests free it with drop_resolved(). */
typedef struct resolved {
    namelist list;
    namelist_errors errors;
    schema_deck deck;
} resolved;

static inline resolved resolve(const char *text)
{
    resolved r = {0};
    assert_true(namelist_parse(&r.list, text, strlen(text), &r.errors));
    assert_true(schema_resolve(&r.deck, &r.list, &r.errors));
    namelist_errors_sort(&r.errors);
    return r;
}

static inline void drop_resolved(resolved *r)
{
    schema_free(&r->deck);
    namelist_free(&r->list);
    namelist_errors_free(&r->errors);
}

static inline resolved resolve_clean(const char *text)
{
    resolved r = resolve(text);
    if (r.errors.n > 0) fail_msg("'%s' gives '%s'", text, r.errors.list[0].text);
    return r;
}

/* All faults as "line:column text", a line for each. */
static inline void list_faults(const namelist_errors *errors, char *out, size_t size)
{
    size_t length = 0;
    out[0] = '\0';
    for (size_t k = 0; k < errors->n && length < size; k++) {
        const namelist_error *e = &errors->list[k];
        length += (size_t)snprintf(out + length, size - length, "%s%d:%d %s", k == 0 ? "" : "\n", e->place.line,
                                   e->place.column, e->text);
    }
}

/* A text has one fault, in this line and with this word; or none, where the word is NULL. */
static inline void assert_one_fault(const namelist_errors *errors, const char *text, int line, const char *word)
{
    if (word == NULL) {
        if (errors->n > 0) fail_msg("'%s' gives '%s'", text, errors->list[0].text);
        return;
    }
    if (errors->n != 1) fail_msg("'%s' gives %zu faults", text, errors->n);
    assert_int_equal(errors->list[0].place.line, line);
    if (strstr(errors->list[0].text, word) == NULL) fail_msg("no '%s' in '%s'", word, errors->list[0].text);
}

static inline void assert_faults_of(const char *text, size_t size, const char *expected)
{
    char got[4096];
    reading r = read_bytes(text, size);
    list_faults(&r.errors, got, sizeof got);
    drop(&r);
    assert_line_parts(got, expected);
}

static inline void assert_faults(const char *text, const char *expected)
{
    assert_faults_of(text, strlen(text), expected);
}

static inline const namelist_key *key_at(const reading *r, size_t group, size_t key)
{
    assert_true(group < r->list.n_groups);
    assert_true(key < r->list.groups[group].n_keys);
    return &r->list.groups[group].keys[key];
}

#endif
