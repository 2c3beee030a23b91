/* SPDX-License-Identifier: BSD-3-Clause */
/* Reader of Fortran namelists: one pass over a cleaned copy of the text, one token ahead. What a key or a value means,
 * and whether it is of the right type, is not known here. */
#include "namelist.h"
#include "scan.h"
#include "utf8.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_LINE = 1 << 16,  /* characters */
    MAX_GROUPS = 2000,   /* bounds the resolved echo, which must be readable in its turn */
    MAX_VALUES = 100000, /* in the file; also the largest repeat count and subscript */
    MAX_STRING = 4096,   /* bytes */
    MAX_NUMBER = 200     /* characters */
};

static const char digits[] = "0123456789";

typedef struct reader {
    scanner scan;
    namelist *list;
    namelist_errors *errors;
    const char *key; /* whose values are read */
    size_t n_values; /* in all groups so far */
    bool failed;     /* memory ran out */
} reader;

/* Room for one more in a list of n whose capacity is the next power of two; NULL when memory runs out. */
static void *grown(void *list, size_t n, size_t item_size)
{
    if ((n & (n - 1)) != 0) return list;
    return realloc(list, (n == 0 ? 1 : 2 * n) * item_size);
}

static void fail(reader *r)
{
    r->failed = true;
    r->scan.at = r->scan.size;
}

static const char *here(const reader *r)
{
    return scan_here(&r->scan);
}

static namelist_place place_here(const reader *r)
{
    return (namelist_place){r->scan.line, r->scan.column};
}

/* ---- cleaning ------------------------------------------------------------------------------------------------ */

/* Replaces what is not text by blanks, and reports it once. Returns false if it stands in several lines: then it is not
 * by oversight, and the rest is better not looked at. */
static bool clean(char *text, size_t size, namelist_errors *errors)
{
    namelist_place place = {1, 1}, first = place;
    unsigned char byte = 0; /* the first that is not text */
    size_t n_lines = 0;     /* that have such */
    bool good = true;       /* this line, so far */
    for (size_t k = 0; k < size;) {
        const size_t n = utf8_plain_length(text + k);
        const bool beyond = place.column > MAX_LINE && text[k] != '\n';
        if (good && n == 0 && n_lines++ == 0) {
            byte = (unsigned char)text[k];
            first = place;
        }
        if (good && n > 0 && beyond)
            namelist_errors_add(errors, place, "the line is longer than %d characters", MAX_LINE);
        good = good && n > 0 && !beyond;
        if (n == 0) text[k] = ' ';
        k += n > 0 ? n : 1;
        place.column++;
        if (text[k - 1] == '\n') {
            place = (namelist_place){place.line + 1, 1};
            good = true;
        }
    }
    if (n_lines == 1) namelist_errors_add(errors, first, "byte 0x%02X is not text; UTF-8 is expected", byte);
    if (n_lines > 1)
        namelist_errors_add(errors, first, "byte 0x%02X is not text; UTF-8 is expected (%zu such lines)", byte,
                            n_lines);
    return n_lines <= 1;
}

static bool is_utf16(const char *s, size_t size)
{
    return size >= 2 && (memcmp(s, "\xFF\xFE", 2) == 0 || memcmp(s, "\xFE\xFF", 2) == 0 || !s[0] != !s[1]);
}

static char *cleaned_copy(const char *text, size_t size, bool *is_text, namelist_errors *errors)
{
    const size_t mark = size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    char *copy = malloc(size - mark + 1);
    if (copy == NULL) return NULL;
    if (size > mark) memcpy(copy, text + mark, size - mark);
    copy[size - mark] = '\0';
    *is_text = clean(copy, size - mark, errors);
    return copy;
}

static char *copy_text(reader *r, const char *s, size_t n)
{
    char *text = malloc(n + 1);
    if (text == NULL) {
        fail(r);
        return NULL;
    }
    memcpy(text, s, n);
    text[n] = '\0';
    return text;
}

static char *copy_name(reader *r, const char *s, size_t n)
{
    char *name = copy_text(r, s, n);
    size_t length = 0;
    for (size_t k = 0; name != NULL && k < n; k++)
        if (!scan_is_blank(name[k])) name[length++] = (char)tolower((unsigned char)name[k]);
    if (name != NULL) name[length] = '\0';
    return name;
}

/* ---- values -------------------------------------------------------------------------------------------------- */

static void report_fault(reader *r, namelist_value *value, const char *what)
{
    namelist_errors_add(r->errors, value->place, "'%.40s': '%.40s' %s", r->key, value->text, what);
    value->kind = NAMELIST_FAULT;
}

/* INTEGER, REAL, FAULT for an exponent without its letter, or WORD. */
static namelist_kind number_kind(const char *s)
{
    s += *s == '+' || *s == '-';
    const size_t whole = strspn(s, digits);
    s += whole;
    const bool point = *s == '.';
    const size_t fraction = point ? strspn(s + 1, digits) : 0;
    s += (point ? 1 : 0) + fraction;
    if (whole + fraction == 0) return NAMELIST_WORD;
    if (*s == '\0') return point ? NAMELIST_REAL : NAMELIST_INTEGER;
    const bool letter = strchr("eEdD", *s) != NULL;
    s += letter;
    const bool sign = *s == '+' || *s == '-';
    s += sign;
    const size_t exponent = strspn(s, digits);
    if (exponent == 0 || s[exponent] != '\0' || !(letter || sign)) return NAMELIST_WORD;
    return letter ? NAMELIST_REAL : NAMELIST_FAULT;
}

static void read_number(reader *r, namelist_value *value)
{
    char number[MAX_NUMBER + 1];
    const size_t n = strlen(value->text);
    if (n > MAX_NUMBER) {
        report_fault(r, value, "has too many digits");
        return;
    }
    for (size_t k = 0; k <= n; k++) {
        const char c = value->text[k];
        number[k] = c == 'd' || c == 'D' ? 'e' : c;
    }
    value->real = strtod(number, NULL);
    errno = 0;
    if (value->kind == NAMELIST_INTEGER) value->integer = strtoll(number, NULL, 10);
    if (errno == ERANGE)
        report_fault(r, value, "is too large for an integer");
    else if (!isfinite(value->real))
        report_fault(r, value, "is too large for a real");
}

static void read_word(reader *r, namelist_value *value)
{
    const size_t n = scan_word_length(here(r));
    value->text = copy_text(r, here(r), n);
    if (value->text == NULL) return;
    scan_step_over(&r->scan, n);
    value->kind = number_kind(value->text);
    if (value->kind == NAMELIST_FAULT)
        report_fault(r, value, "has an exponent without its letter; write 1.5e+3 for 1.5+3");
    else if (value->kind != NAMELIST_WORD)
        read_number(r, value);
    else if (scan_is_logical(value->text, &value->logical))
        value->kind = NAMELIST_LOGICAL;
    else if (scan_is_infinite(value->text))
        report_fault(r, value, "is not a finite number");
}

/* Takes the quotes off, one of each doubled quote and the ends of lines. */
static void unquote(char *text, const char *s, size_t n)
{
    size_t length = 0;
    for (size_t k = 1; k + 1 < n; k++) {
        if (s[k] == s[0]) k++;
        if (s[k] != '\n' && s[k] != '\r') text[length++] = s[k];
    }
    text[length] = '\0';
}

static void read_string(reader *r, namelist_value *value)
{
    const char *s = here(r);
    const size_t n = scan_string_length(s);
    value->text = copy_text(r, s, n);
    if (value->text == NULL) return;
    if (n == 0) {
        namelist_errors_add(r->errors, value->place, "the string is not closed");
        scan_step(&r->scan);
        scan_skip_junk(&r->scan);
        return;
    }
    unquote(value->text, s, n);
    scan_step_over(&r->scan, n);
    if (strlen(value->text) > MAX_STRING)
        namelist_errors_add(r->errors, value->place, "the string is longer than %d bytes", MAX_STRING);
    else
        value->kind = NAMELIST_STRING;
}

static void read_unexpected(reader *r, namelist_value *value)
{
    const char *s = here(r);
    value->text = copy_text(r, s, 1);
    if (*s == '(')
        namelist_errors_add(r->errors, value->place, "a number is expected; complex ones are not understood");
    else if (*s == '#')
        namelist_errors_add(r->errors, value->place, "unexpected '#'; comments begin with '!'");
    else
        namelist_errors_add(r->errors, value->place, "unexpected '%c'", *s);
    const size_t pair = *s == '(' ? 1 + strspn(s + 1, "0123456789+-.eEdD, \t") : 0;
    if (*s == '#')
        scan_skip_line(&r->scan);
    else
        scan_step_over(&r->scan, s[pair] == ')' ? pair + 1 : 1);
}

/* The count of "r*", 1 without one; 0 after a fault. */
static size_t read_repeat(reader *r)
{
    const char *s = here(r);
    const size_t n = strspn(s, digits);
    if (n == 0 || s[n] != '*') return 1;
    const unsigned long repeat = n < 10 ? strtoul(s, NULL, 10) : MAX_VALUES + 1;
    const bool good = repeat >= 1 && repeat <= MAX_VALUES;
    if (!good)
        namelist_errors_add(r->errors, place_here(r), "repeat count '%.*s' is not in 1 to %d", (int)(n < 40 ? n : 40),
                            s, MAX_VALUES);
    scan_step_over(&r->scan, n + 1);
    return good ? repeat : 0;
}

/* Appends `value` `repeat` times; they share its text, which the key owns from now on. */
static bool append_repeated(namelist_key *key, const namelist_value *value, size_t repeat)
{
    for (size_t k = 0; k < repeat; k++) {
        namelist_value *values = grown(key->values, key->n_values, sizeof *values);
        if (values == NULL) return k > 0;
        key->values = values;
        values[key->n_values++] = *value;
    }
    return repeat > 0;
}

static void append_values(reader *r, namelist_key *key, const namelist_value *value, size_t repeat)
{
    const bool full = r->n_values > MAX_VALUES;
    r->n_values += full ? 0 : repeat;
    if (!full && r->n_values > MAX_VALUES)
        namelist_errors_add(r->errors, value->place, "there are more than %d values", MAX_VALUES);
    const size_t n = key->n_values, wanted = r->n_values > MAX_VALUES ? 0 : repeat;
    const bool owned = append_repeated(key, value, wanted);
    if (key->n_values < n + wanted) fail(r);
    if (!owned) free(value->text);
}

static void append_null(reader *r, namelist_key *key, namelist_place place, size_t repeat)
{
    const namelist_value null = {.kind = NAMELIST_NULL, .place = place, .text = copy_text(r, "", 0)};
    if (null.text != NULL) append_values(r, key, &null, repeat);
}

static void read_value(reader *r, namelist_key *key)
{
    namelist_value value = {.kind = NAMELIST_FAULT, .place = place_here(r)};
    const size_t start = r->scan.at;
    const size_t repeat = read_repeat(r);
    const char c = *here(r);
    if (r->scan.at > start && (scan_is_blank(c) || strchr(",;/!", c) != NULL)) {
        append_null(r, key, value.place, repeat);
        return;
    }
    if (c == '\'' || c == '"')
        read_string(r, &value);
    else if (strchr("(#=&$", c) != NULL)
        read_unexpected(r, &value);
    else
        read_word(r, &value);
    if (repeat == 0) value.kind = NAMELIST_FAULT;
    if (value.text != NULL) append_values(r, key, &value, repeat > 0 ? repeat : 1);
    if (value.kind != NAMELIST_FAULT && !scan_is_blank(*here(r)) && strchr(",;/!=&$", *here(r)) == NULL) {
        namelist_errors_add(r->errors, place_here(r), "a blank or a comma is missing here");
        scan_skip_junk(&r->scan);
    }
}

static void read_values(reader *r, namelist_key *key)
{
    bool null = true; /* the next comma has no value before it */
    for (scan_skip_blanks(&r->scan); !scan_at_stop(&r->scan); scan_skip_blanks(&r->scan)) {
        const char c = *here(r);
        if (c == ';')
            namelist_errors_add(r->errors, place_here(r), "values are separated by ',' or blanks, not by ';'");
        if (c == ',' || c == ';') {
            if (null) append_null(r, key, place_here(r), 1);
            null = true;
            scan_step(&r->scan);
        } else if (key->n_values > 0 && !null && scan_at_line_name(&r->scan)) {
            return; /* the next key, without its '=' */
        } else {
            read_value(r, key);
            null = false;
        }
    }
}

/* ---- keys ---------------------------------------------------------------------------------------------------- */

/* Reads the number at `s`, if there is one, and the blanks round it. */
static const char *read_bound(const char *s, int64_t *bound)
{
    s += strspn(s, " \t");
    char *end = (char *)s;
    if (*s != ':' && *s != ')') *bound = strtoll(s, &end, 10);
    return end + strspn(end, " \t");
}

/* Reads "(i)", "(i:j)", "(i:j:k)"; returns how many values there is room for, 0 after a fault. */
static int64_t read_subscript(reader *r, namelist_key *key, const char *s)
{
    int64_t last = MAX_VALUES;
    key->subscript = true;
    s = read_bound(s + 1, &key->first);
    if (*s == ':') s = read_bound(s + 1, &last);
    if (*s == ':') s = read_bound(s + 1, &key->stride);
    if (*s == ',')
        namelist_errors_add(r->errors, key->place, "'%.40s' has more than one subscript; only one is understood",
                            key->name);
    else if (*s != ')')
        namelist_errors_add(r->errors, key->place, "the subscript of '%.40s' must be (i), (i:j) or (i:j:k)", key->name);
    else if (key->first < 1 || last < key->first || last > MAX_VALUES || key->stride < 1 || key->stride > MAX_VALUES)
        namelist_errors_add(r->errors, key->place, "the subscript of '%.40s' must ascend, from 1 to %d at most",
                            key->name, MAX_VALUES);
    else
        return (last - key->first) / key->stride + 1;
    return 0;
}

static void drop_values(namelist_key *key)
{
    for (size_t k = 0; k < key->n_values; k++)
        if (k == 0 || key->values[k].text != key->values[k - 1].text) free(key->values[k].text);
    free(key->values);
    key->values = NULL;
    key->n_values = 0;
}

static void free_key(namelist_key *key)
{
    drop_values(key);
    free(key->name);
}

static void append_key(reader *r, namelist_group *group, namelist_key *key)
{
    namelist_key *keys = key->name == NULL ? NULL : grown(group->keys, group->n_keys, sizeof *keys);
    if (keys == NULL) {
        fail(r);
        free_key(key);
        return;
    }
    group->keys = keys;
    keys[group->n_keys++] = *key;
}

static void read_assignment(reader *r, namelist_group *group)
{
    const char *s = here(r);
    const size_t n = scan_designator_length(s);
    size_t base = n;
    if (s[n - 1] == ')')
        while (s[--base] != '(') continue;
    namelist_key key = {.place = place_here(r), .first = 1, .stride = 1, .name = copy_name(r, s, base)};
    if (key.name == NULL) return;
    const int64_t room = base < n ? read_subscript(r, &key, s + base) : MAX_VALUES;
    scan_step_over(&r->scan, n);
    while (*here(r) != '=' && *here(r) != '\0') scan_step(&r->scan);
    scan_step(&r->scan);
    const size_t faults = r->errors->n;
    r->key = key.name;
    read_values(r, &key);
    if (key.n_values == 0 && r->errors->n == faults) append_null(r, &key, key.place, 1); /* as f90nml writes None */
    if (room > 0 && key.n_values > (size_t)room)
        namelist_errors_add(r->errors, key.place, "the subscript of '%.40s' has room for %lld, got %zu values",
                            key.name, (long long)room, key.n_values);
    if (key.n_values > (size_t)room) drop_values(&key);
    append_key(r, group, &key);
}

/* What stands where a key should: kept as a key with a fault if it has a name. */
static void read_junk(reader *r, namelist_group *group)
{
    const char *s = here(r);
    const size_t name = scan_name_length(s), word = scan_word_length(s);
    const int shown = (int)(word == 0 ? 1 : word < 40 ? word : 40);
    if (*s == '#')
        namelist_errors_add(r->errors, place_here(r), "unexpected '#'; comments begin with '!'");
    else if (name > 0 && s[name] == '(')
        namelist_errors_add(r->errors, place_here(r), "the subscript in '%.*s' must be (i), (i:j) or (i:j:k)", shown,
                            s);
    else if (name > 0)
        namelist_errors_add(r->errors, place_here(r), "'=' is missing after '%.*s'", shown, s);
    else
        namelist_errors_add(r->errors, place_here(r), "a key is expected, got '%.*s'", shown, s);
    if (name > 0) {
        namelist_key key = {.place = place_here(r), .first = 1, .stride = 1, .name = copy_name(r, s, name)};
        append_key(r, group, &key);
    }
    if (*s == '#') scan_skip_line(&r->scan);
    scan_skip_junk(&r->scan);
}

/* ---- groups -------------------------------------------------------------------------------------------------- */

static void free_group(namelist_group *group)
{
    for (size_t k = 0; k < group->n_keys; k++) free_key(&group->keys[k]);
    free(group->keys);
    free(group->name);
}

static void append_group(reader *r, namelist_group *group)
{
    const size_t n = r->list->n_groups;
    namelist_group *groups = n == MAX_GROUPS ? NULL : grown(r->list->groups, n, sizeof *groups);
    if (groups == NULL) {
        if (n < MAX_GROUPS)
            fail(r);
        else
            namelist_errors_add(r->errors, group->place, "there are more than %d groups", MAX_GROUPS);
        free_group(group);
        return;
    }
    r->list->groups = groups;
    groups[r->list->n_groups++] = *group;
}

static bool read_end(reader *r, const namelist_group *group)
{
    const char *s = here(r);
    if (scan_at_end_word(&r->scan)) {
        scan_step_over(&r->scan, 4);
    } else if (*s == '/') {
        scan_step(&r->scan);
        if (!scan_is_blank(s[1]) && strchr("!&$", s[1]) == NULL)
            namelist_errors_add(r->errors, place_here(r),
                                "text right behind the '/' that ends &%.40s; does a path lack its quotes?",
                                group->name);
    } else if (scan_at_group(&r->scan)) {
        namelist_errors_add(r->errors, group->place, "&%.40s is not closed: '/' is missing before &%.*s in line %d",
                            group->name, (int)(scan_name_length(s + 1) < 40 ? scan_name_length(s + 1) : 40), s + 1,
                            r->scan.line);
    } else if (*s == '\0' && !r->failed) {
        namelist_errors_add(r->errors, group->place, "&%.40s is not closed: '/' is missing before the end of the file",
                            group->name);
    } else {
        return *s == '\0';
    }
    return true;
}

static void read_group(reader *r)
{
    namelist_group group = {.place = place_here(r)};
    const size_t n = scan_name_length(here(r) + 1);
    if (scan_at_end_word(&r->scan)) {
        namelist_errors_add(r->errors, place_here(r), "'%.4s' closes no group", here(r));
        scan_step_over(&r->scan, 4);
        return;
    }
    group.name = copy_name(r, here(r) + 1, n);
    if (group.name == NULL) return;
    scan_step_over(&r->scan, n + 1);
    for (scan_skip_blanks(&r->scan); !read_end(r, &group); scan_skip_blanks(&r->scan)) {
        if (scan_at_key(&r->scan))
            read_assignment(r, &group);
        else
            read_junk(r, &group);
    }
    append_group(r, &group);
}

/* Skips the text between groups. */
static bool find_group(reader *r)
{
    for (; *here(r) != '\0'; scan_step(&r->scan)) {
        if (*here(r) == '!') scan_skip_line(&r->scan);
        if (scan_at_group(&r->scan) && (r->scan.at == 0 || scan_is_blank(here(r)[-1]))) return true;
    }
    return false;
}

/* ---- public -------------------------------------------------------------------------------------------------- */

bool namelist_parse(namelist *out, const char *text, size_t size, namelist_errors *errors)
{
    *out = (namelist){0};
    const namelist_place start = {1, 1};
    out->unreadable = size > NAMELIST_MAX_FILE || is_utf16(text, size);
    if (size > NAMELIST_MAX_FILE)
        namelist_errors_add(errors, start, "the file is larger than %d bytes", NAMELIST_MAX_FILE);
    else if (out->unreadable)
        namelist_errors_add(errors, start, "the file is in UTF-16; UTF-8 is expected");
    if (out->unreadable) return true;
    bool is_text;
    char *copy = cleaned_copy(text, size, &is_text, errors);
    if (copy == NULL) return false;
    reader r = {.scan = {.text = copy, .size = strlen(copy), .line = 1, .column = 1}, .list = out, .errors = errors};
    out->unreadable = !is_text;
    while (is_text && (scan_at_group(&r.scan) || find_group(&r))) read_group(&r);
    free(copy);
    if (r.failed) namelist_free(out);
    return !r.failed;
}

static void drop_key(namelist_group *group, const char *name)
{
    size_t n = 0;
    for (size_t k = 0; k < group->n_keys; k++) {
        if (strcmp(group->keys[k].name, name) == 0)
            free_key(&group->keys[k]);
        else
            group->keys[n++] = group->keys[k];
    }
    group->n_keys = n;
}

bool namelist_merge(namelist *list, size_t at, namelist_group *from)
{
    if (at == list->n_groups) {
        namelist_group *groups = realloc(list->groups, (at + 1) * sizeof *groups);
        if (groups == NULL) return false;
        list->groups = groups;
        groups[list->n_groups++] = *from;
    } else {
        namelist_group *group = &list->groups[at];
        namelist_key *keys = realloc(group->keys, (group->n_keys + from->n_keys + 1) * sizeof *keys);
        if (keys == NULL) return false;
        group->keys = keys;
        for (size_t k = 0; k < from->n_keys; k++) drop_key(group, from->keys[k].name);
        for (size_t k = 0; k < from->n_keys; k++) keys[group->n_keys++] = from->keys[k];
        free(from->keys);
        free(from->name);
    }
    *from = (namelist_group){0};
    return true;
}

void namelist_free(namelist *list)
{
    for (size_t k = 0; k < list->n_groups; k++) free_group(&list->groups[k]);
    free(list->groups);
    *list = (namelist){0};
}
