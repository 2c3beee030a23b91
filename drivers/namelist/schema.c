/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks a parsed deck against the table and fills in defaults. */
#include "schema.h"

#include <assert.h>
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_NAMES = 32, /* groups, keys of a group, choices of a key */
    MAX_NAME = 63,  /* characters of a word that may be a misspelt name */
    MAX_CHOICES = 255
};

static const int64_t max_integer = INT64_C(1) << 53; /* beyond, a double skips integers */

typedef struct resolver {
    schema_deck *deck;
    const namelist *list;
    namelist defaults; /* the table's, a group for each of its groups */
    namelist_errors *errors;
    const schema_group *groups; /* [n_groups] */
    int n_groups;
    uint32_t meant_groups; /* bit for each group that an unknown one was likely meant to be: not missed a second time */
} resolver;

/* All assignments to one key of a group, brought together. */
typedef struct assembly {
    const schema_group *group;
    const schema_key *key;
    const namelist_key *initial; /* its default, NULL: none */
    bool given, fault;
    bool meant;                      /* by a misspelt name */
    bool counts;                     /* the number of elements is right */
    namelist_place place;            /* of the first assignment, else of the group */
    size_t n;                        /* elements */
    const namelist_value **elements; /* [n], NULL or of kind NULL: nothing assigned */
} assembly;

/* ---- names --------------------------------------------------------------------------------------------------- */

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Levenshtein distance in any case; `b` has at most MAX_NAME characters. */
static size_t distance(const char *a, const char *b)
{
    size_t row[MAX_NAME + 1];
    const size_t n = strlen(b);
    for (size_t j = 0; j <= n; j++) row[j] = j;
    for (size_t i = 0; a[i] != '\0'; i++) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < n; j++) {
            const bool differ = tolower((unsigned char)a[i]) != tolower((unsigned char)b[j]);
            const size_t replaced = diagonal + differ;
            diagonal = row[j + 1];
            row[j + 1] = smaller(replaced, 1 + smaller(row[j], row[j + 1]));
        }
    }
    return row[n];
}

static bool begins(const char *word, const char *name)
{
    return strlen(word) >= 3 && strncmp(word, name, strlen(word)) == 0;
}

/* Writes "" or " (did you mean 'x'?)" for the nearest name, and which it is. */
static bool suggest(char out[MAX_NAME + 32], const char *word, const char *const *names, size_t n, bool group,
                    size_t *nearest)
{
    const bool found = schema_nearest(word, names, n, nearest);
    const char *quote = group ? "" : "'";
    out[0] = '\0';
    if (found)
        (void)snprintf(out, MAX_NAME + 32, " (did you mean %s%s%s?)", group ? "&" : quote, names[*nearest], quote);
    return found;
}

static int find_group(const resolver *r, const char *name)
{
    for (int g = 0; g < r->n_groups; g++)
        if (strcmp(r->groups[g].name, name) == 0) return g;
    return -1;
}

static int find_key(const schema_group *group, const char *name)
{
    for (int k = 0; k < group->n_keys; k++)
        if (strcmp(group->keys[k].name, name) == 0) return k;
    return -1;
}

static void check_group_names(resolver *r)
{
    const char *names[MAX_NAMES];
    char hint[MAX_NAME + 32];
    size_t nearest;
    for (int g = 0; g < r->n_groups; g++) names[g] = r->groups[g].name;
    for (size_t k = 0; k < r->list->n_groups; k++) {
        const namelist_group *group = &r->list->groups[k];
        if (find_group(r, group->name) >= 0) continue;
        if (suggest(hint, group->name, names, (size_t)r->n_groups, true, &nearest)) r->meant_groups |= 1u << nearest;
        namelist_errors_add(r->errors, group->place, "unknown group &%.40s%s", group->name, hint);
    }
}

/* Names that keys had in earlier releases: a deck of that time is refused, and the error gives the new name. */
static const struct renamed_key {
    const char *group, *before, *now;
} renamed_keys[] = {{"contact", "skin", "penetration_tolerance"}, {"solver", "record_steps", "checkpoint_steps"}};

/* As suggest(), but first for the new name of a renamed key. */
static bool suggest_key(char out[MAX_NAME + 32], const schema_group *group, const char *name, size_t *nearest)
{
    const char *names[MAX_NAMES];
    for (size_t k = 0; k < sizeof renamed_keys / sizeof *renamed_keys; k++) {
        const struct renamed_key *key = &renamed_keys[k];
        if (strcmp(key->group, group->name) != 0 || strcmp(key->before, name) != 0) continue;
        (void)snprintf(out, MAX_NAME + 32, ": it is called '%s' now", key->now);
        *nearest = (size_t)find_key(group, key->now);
        return true;
    }
    for (int k = 0; k < group->n_keys; k++) names[k] = group->keys[k].name;
    return suggest(out, name, names, (size_t)group->n_keys, false, nearest);
}

/* Returns a bit for each key that an unknown one was likely meant to be. */
static uint32_t check_key_names(resolver *r, const schema_group *group, const namelist_group *given)
{
    char hint[MAX_NAME + 32];
    size_t nearest;
    uint32_t meant = 0;
    for (size_t k = 0; k < given->n_keys; k++) {
        const namelist_key *key = &given->keys[k];
        if (find_key(group, key->name) >= 0) continue;
        if (suggest_key(hint, group, key->name, &nearest)) meant |= 1u << nearest;
        namelist_errors_add(r->errors, key->place, "unknown key '%.40s' in &%s%s", key->name, group->name, hint);
    }
    return meant;
}

/* ---- one value ----------------------------------------------------------------------------------------------- */

static bool type_fits(schema_type type, namelist_kind kind)
{
    switch (type) {
    case SCHEMA_REAL:
        return kind == NAMELIST_REAL || kind == NAMELIST_INTEGER;
    case SCHEMA_INTEGER:
        return kind == NAMELIST_INTEGER;
    case SCHEMA_LOGICAL:
        return kind == NAMELIST_LOGICAL;
    case SCHEMA_STRING:
    case SCHEMA_CHOICE:
        break;
    }
    return kind == NAMELIST_STRING;
}

static bool in_range(const char *range, double x)
{
    if (range[0] == '[' || range[0] == '(') {
        char *end;
        const double low = strtod(range + 1, &end), high = strtod(end + 1, NULL);
        return range[0] == '[' ? x >= low && x <= high : x > low && x < high;
    }
    if (range[0] != '>') return true;
    const bool equal = range[1] == '=';
    const double low = strtod(range + (equal ? 2 : 1), NULL);
    return equal ? x >= low : x > low;
}

static size_t split_choices(const char *choices, char copy[MAX_CHOICES + 1], const char *names[MAX_NAMES])
{
    size_t n = 0;
    char *rest;
    (void)snprintf(copy, MAX_CHOICES + 1, "%s", choices);
    for (char *name = strtok_r(copy, "|", &rest); name != NULL; name = strtok_r(NULL, "|", &rest)) names[n++] = name;
    return n;
}

static bool is_choice(resolver *r, const assembly *a, const namelist_value *value)
{
    char copy[MAX_CHOICES + 1], list[2 * MAX_CHOICES] = "", hint[MAX_NAME + 32];
    const char *names[MAX_NAMES];
    const size_t n = split_choices(a->key->choices, copy, names);
    size_t length = 0, nearest;
    for (size_t k = 0; k < n; k++) {
        if (strcmp(value->text, names[k]) == 0) return true;
        const char *joint = k == 0 ? "" : k + 1 < n ? ", " : " or ";
        length += (size_t)snprintf(list + length, sizeof list - length, "%s'%s'", joint, names[k]);
    }
    (void)suggest(hint, value->text, names, n, false, &nearest);
    namelist_errors_add(r->errors, value->place, "'%s' in &%s must be %s, got '%.40s'%s", a->key->name, a->group->name,
                        list, value->text, hint);
    return false;
}

static void report_type(resolver *r, const assembly *a, const namelist_value *value)
{
    static const char *const expected[] = {"a real", "an integer", "a logical", "a string in quotes",
                                           "a string in quotes"};
    const bool string = a->key->type == SCHEMA_STRING || a->key->type == SCHEMA_CHOICE;
    const char *quote = string ? "" : "'";
    namelist_errors_add(r->errors, value->place, "'%s' in &%s expects %s, got %s%.40s%s", a->key->name, a->group->name,
                        expected[a->key->type], quote, value->text, quote);
}

static bool check_value(resolver *r, const assembly *a, const namelist_value *value)
{
    const schema_key *key = a->key;
    const bool integer = key->type == SCHEMA_INTEGER;
    if (!type_fits(key->type, value->kind)) {
        report_type(r, a, value);
    } else if (!a->counts) {
        return true; /* the number of values is reported, and they may be none that were meant */
    } else if (key->type == SCHEMA_CHOICE) {
        return is_choice(r, a, value);
    } else if ((integer || key->type == SCHEMA_REAL) && !in_range(key->range, value->real)) {
        namelist_errors_add(r->errors, value->place, "'%s' in &%s must be %s%s, got %.40s", key->name, a->group->name,
                            key->range[0] == '>' ? "" : "in ", key->range, value->text);
    } else if (integer && value->integer > max_integer) {
        namelist_errors_add(r->errors, value->place, "'%s' in &%s must be at most 2^53, got %.40s", key->name,
                            a->group->name, value->text);
    } else {
        return true;
    }
    return false;
}

/* ---- all values of a key ------------------------------------------------------------------------------------- */

static size_t element_of(const namelist_key *key, size_t k)
{
    return (size_t)key->first + k * (size_t)key->stride;
}

/* Number of elements that an assignment reaches; null values count only where they stand for a default. */
static void measure(assembly *a, const namelist_key *key)
{
    const size_t n_initial = a->initial == NULL ? 0 : a->initial->n_values;
    if (key->n_values == 0) a->fault = true;
    if (key->subscript && n_initial > a->n) a->n = n_initial;
    for (size_t k = 0; k < key->n_values; k++) {
        const bool null = key->values[k].kind == NAMELIST_NULL;
        const size_t element = element_of(key, k);
        if (key->values[k].kind == NAMELIST_FAULT) a->fault = true;
        if (!null) a->given = true;
        if (element > a->n && (!null || element <= n_initial)) a->n = element;
    }
}

static void measure_all(resolver *r, assembly *a, const namelist_group *given)
{
    const namelist_key *first = NULL;
    for (size_t k = 0; k < given->n_keys; k++) {
        const namelist_key *key = &given->keys[k];
        if (strcmp(key->name, a->key->name) != 0) continue;
        measure(a, key);
        if (first != NULL && !(first->subscript && key->subscript)) {
            namelist_errors_add(r->errors, key->place, "key '%s' is given twice in &%s, first in line %d", key->name,
                                a->group->name, first->place.line);
            a->fault = true;
        }
        if (first == NULL) first = key;
    }
    if (first != NULL) a->place = first->place;
}

static void place_values(resolver *r, assembly *a, const namelist_key *key)
{
    for (size_t k = 0; k < key->n_values; k++) {
        const namelist_value *value = &key->values[k];
        const size_t element = element_of(key, k);
        if (value->kind == NAMELIST_NULL) continue;
        if (a->elements[element - 1] != NULL && !a->fault) {
            namelist_errors_add(r->errors, key->place, "'%s(%zu)' is given twice in &%s, first in line %d", key->name,
                                element, a->group->name, a->elements[element - 1]->place.line);
            a->fault = true;
        }
        a->elements[element - 1] = value;
    }
}

static void check_values(resolver *r, assembly *a)
{
    const namelist_value *faulty = NULL;
    for (size_t k = 0; k < a->n; k++) {
        const namelist_value *value = a->elements[k];
        if (value == NULL || value->kind == NAMELIST_FAULT) continue;
        if (faulty != NULL && faulty->text == value->text) continue; /* one of r*c */
        if (check_value(r, a, value)) continue;
        faulty = value;
        a->fault = true;
    }
}

static bool has_count(const assembly *a)
{
    const size_t least = (size_t)a->key->min_count, most = (size_t)a->key->max_count;
    return a->n >= least && (most == 0 || a->n <= most);
}

/* Whether one of the commas looks like that of a decimal fraction: 0,03. */
static bool has_decimal_comma(const assembly *a)
{
    for (size_t k = 0; a->key->type == SCHEMA_REAL && k + 1 < a->n; k++) {
        const namelist_value *whole = a->elements[k], *part = a->elements[k + 1];
        if (whole == NULL || part == NULL || whole->kind != NAMELIST_INTEGER || whole->text == part->text) continue;
        if (isdigit((unsigned char)part->text[0]) && part->place.line == whole->place.line &&
            part->place.column == whole->place.column + (int)strlen(whole->text) + 1)
            return true;
    }
    return false;
}

static void check_count(resolver *r, assembly *a)
{
    const size_t least = (size_t)a->key->min_count, most = (size_t)a->key->max_count;
    const bool comma = most != 0 && a->n > least && has_decimal_comma(a);
    char range[32] = "";
    if (a->counts) return;
    if (most > least) (void)snprintf(range, sizeof range, " to %zu", most);
    namelist_errors_add(r->errors, a->place, "'%s' in &%s expects %s%zu%s value%s, got %zu%s", a->key->name,
                        a->group->name, most == 0 ? "at least " : "", least, range, least == 1 && most == 1 ? "" : "s",
                        a->n, comma ? "; a decimal point is written '.', not ','" : "");
    a->fault = true;
}

static void fill_holes(resolver *r, assembly *a)
{
    for (size_t k = 0; k < a->n && !a->fault; k++) {
        if (a->elements[k] != NULL) continue;
        if (a->initial != NULL && k < a->initial->n_values) {
            a->elements[k] = &a->initial->values[k];
        } else {
            namelist_errors_add(r->errors, a->place, "'%s(%zu)' in &%s is not given", a->key->name, k + 1,
                                a->group->name);
            a->fault = true;
        }
    }
}

/* Leaves the values that stand, those of the deck or the default's, in a->elements. */
static bool assemble(resolver *r, assembly *a, const namelist_group *given)
{
    if (given != NULL) measure_all(r, a, given);
    const size_t n_initial = a->initial == NULL ? 0 : a->initial->n_values;
    a->elements = calloc(1 + (a->n > n_initial ? a->n : n_initial), sizeof *a->elements);
    if (a->elements == NULL) return false;
    if (a->given) {
        for (size_t k = 0; k < given->n_keys; k++)
            if (strcmp(given->keys[k].name, a->key->name) == 0) place_values(r, a, &given->keys[k]);
        a->counts = has_count(a);
        check_values(r, a);
        if (!a->fault) check_count(r, a);
        fill_holes(r, a);
    }
    if (a->given && !a->fault) return true;
    a->n = n_initial;
    for (size_t k = 0; k < n_initial; k++) a->elements[k] = &a->initial->values[k];
    return true;
}

static bool store(schema_value *value, const assembly *a)
{
    const bool text = a->key->type == SCHEMA_STRING || a->key->type == SCHEMA_CHOICE;
    value->given = a->given;
    value->faulty = a->fault || a->meant;
    value->place = a->place;
    if (a->n == 0) return true;
    value->reals = text ? NULL : calloc(a->n, sizeof *value->reals);
    value->texts = text ? calloc(a->n, sizeof *value->texts) : NULL;
    if (value->reals == NULL && value->texts == NULL) return false;
    value->count = (int)a->n;
    for (size_t k = 0; k < a->n; k++) {
        const namelist_value *from = a->elements[k];
        if (!text)
            value->reals[k] = a->key->type == SCHEMA_LOGICAL ? from->logical : from->real;
        else if ((value->texts[k] = strdup(from->text)) == NULL)
            return false;
    }
    return true;
}

/* ---- groups -------------------------------------------------------------------------------------------------- */

static const namelist_key *default_of(const resolver *r, int g, const char *name)
{
    const namelist_group *group = &r->defaults.groups[g];
    for (size_t k = 0; k < group->n_keys; k++)
        if (strcmp(group->keys[k].name, name) == 0) return &group->keys[k];
    return NULL;
}

/* Appends an instance; `given` is NULL for one of defaults. */
static bool resolve_group(resolver *r, int g, const namelist_group *given)
{
    const schema_group *group = &r->groups[g];
    const uint32_t meant = given == NULL ? 0 : check_key_names(r, group, given);
    schema_instance *instance = &r->deck->instances[r->deck->n_instances];
    instance->group = group;
    instance->place = given == NULL ? (namelist_place){1, 1} : given->place;
    instance->values = calloc((size_t)group->n_keys, sizeof *instance->values);
    if (instance->values == NULL) return false;
    r->deck->n_instances++;
    bool good = true;
    for (int k = 0; k < group->n_keys && good; k++) {
        const schema_key *key = &group->keys[k];
        assembly a = {.group = group,
                      .key = key,
                      .initial = default_of(r, g, key->name),
                      .meant = (meant >> k & 1u) != 0,
                      .place = instance->place};
        good = assemble(r, &a, given) && store(&instance->values[k], &a);
        free(a.elements);
        if (key->initial == NULL && given != NULL && !a.given && !a.fault && !a.meant)
            namelist_errors_add(r->errors, instance->place, "'%s' in &%s must be given", key->name, group->name);
    }
    return good;
}

static bool resolve_groups(resolver *r, int g)
{
    const schema_group *group = &r->groups[g];
    const namelist_group *first = NULL;
    for (size_t k = 0; k < r->list->n_groups; k++) {
        const namelist_group *given = &r->list->groups[k];
        if (strcmp(given->name, group->name) != 0) continue;
        if (first != NULL && !group->repeated)
            namelist_errors_add(r->errors, given->place, "&%s is given twice, first in line %d", group->name,
                                first->place.line);
        else if (!resolve_group(r, g, given))
            return false;
        if (first == NULL) first = given;
    }
    if (first != NULL) return true;
    if (group->required && (r->meant_groups >> g & 1u) == 0)
        namelist_errors_add(r->errors, (namelist_place){1, 1}, "&%s must be given", group->name);
    return group->repeated || resolve_group(r, g, NULL);
}

/* Parses the defaults of the table like a deck. */
static bool parse_defaults(resolver *r)
{
    char *text = NULL;
    size_t size = 0;
    namelist_errors errors = {0};
    FILE *file = open_memstream(&text, &size);
    if (file == NULL) return false;
    for (int g = 0; g < r->n_groups; g++) {
        (void)fprintf(file, "&%s\n", r->groups[g].name);
        for (int k = 0; k < r->groups[g].n_keys; k++) {
            const schema_key *key = &r->groups[g].keys[k];
            if (key->initial != NULL && key->initial[0] != '\0')
                (void)fprintf(file, "%s = %s\n", key->name, key->initial);
        }
        (void)fprintf(file, "/\n");
    }
    const bool good = fclose(file) == 0 && text != NULL && namelist_parse(&r->defaults, text, size, &errors);
    assert(!good || errors.n == 0);
    namelist_errors_free(&errors);
    free(text);
    return good;
}

/* ---- public -------------------------------------------------------------------------------------------------- */

bool schema_resolve(schema_deck *out, const namelist *list, namelist_errors *errors)
{
    resolver r = {.deck = out, .list = list, .errors = errors};
    *out = (schema_deck){0};
    r.groups = schema_groups(&r.n_groups);
    out->instances = calloc(list->n_groups + (size_t)r.n_groups, sizeof *out->instances);
    bool good = out->instances != NULL && parse_defaults(&r);
    if (good) check_group_names(&r);
    out->misspelt = r.meant_groups != 0;
    for (int g = 0; g < r.n_groups && good; g++) good = resolve_groups(&r, g);
    namelist_free(&r.defaults);
    if (!good) schema_free(out);
    return good;
}

static void empty(schema_value *value)
{
    for (int j = 0; value->texts != NULL && j < value->count; j++) free(value->texts[j]);
    free(value->texts);
    free(value->reals);
    value->texts = NULL;
    value->reals = NULL;
    value->count = 0;
}

void schema_free(schema_deck *deck)
{
    for (size_t k = 0; k < deck->n_instances; k++) {
        schema_instance *instance = &deck->instances[k];
        for (int i = 0; i < instance->group->n_keys; i++) empty(&instance->values[i]);
        free(instance->values);
    }
    free(deck->instances);
    *deck = (schema_deck){0};
}

size_t schema_count(const schema_deck *deck, const char *group)
{
    size_t n = 0;
    for (size_t k = 0; k < deck->n_instances; k++) n += strcmp(deck->instances[k].group->name, group) == 0;
    return n;
}

const schema_instance *schema_get(const schema_deck *deck, const char *group, size_t k)
{
    for (size_t i = 0; i < deck->n_instances; i++)
        if (strcmp(deck->instances[i].group->name, group) == 0 && k-- == 0) return &deck->instances[i];
    return NULL;
}

void schema_drop(schema_instance *instance, const char *key)
{
    schema_value *value = &instance->values[find_key(instance->group, key)];
    empty(value);
    value->given = false;
}

bool schema_set_text(schema_instance *instance, const char *key, const char *text)
{
    schema_value *value = &instance->values[find_key(instance->group, key)];
    char *copy = strdup(text);
    assert(value->texts != NULL);
    if (copy == NULL) return false;
    free(value->texts[0]);
    value->texts[0] = copy;
    return true;
}

const schema_value *schema_value_of(const schema_instance *instance, const char *key)
{
    const int k = find_key(instance->group, key);
    assert(k >= 0);
    return &instance->values[k];
}

double schema_real(const schema_instance *instance, const char *key)
{
    const schema_value *value = schema_value_of(instance, key);
    return value->count > 0 ? value->reals[0] : 0;
}

const char *schema_text(const schema_instance *instance, const char *key)
{
    const schema_value *value = schema_value_of(instance, key);
    return value->count > 0 ? value->texts[0] : "";
}

const double *schema_reals(const schema_instance *instance, const char *key)
{
    return schema_value_of(instance, key)->reals;
}

bool schema_is(const schema_instance *instance, const char *key, const char *text)
{
    return strcmp(schema_text(instance, key), text) == 0;
}

bool schema_given(const schema_instance *instance, const char *key)
{
    return schema_value_of(instance, key)->given;
}

namelist_place schema_place(const schema_instance *instance, const char *key)
{
    return schema_value_of(instance, key)->place;
}

bool schema_nearest(const char *word, const char *const *names, size_t n_names, size_t *nearest)
{
    const size_t length = strlen(word);
    size_t best = 2 + length / 3;
    if (length > MAX_NAME) return false;
    for (size_t k = 0; k < n_names; k++) {
        if (strlen(names[k]) > MAX_NAME) continue;
        const size_t d = begins(word, names[k]) ? 1 : distance(word, names[k]);
        if (d >= best) continue;
        best = d;
        *nearest = k;
    }
    return best < 2 + length / 3;
}
