/* SPDX-License-Identifier: BSD-3-Clause */
/* The one table of groups and keys of a deck. It parses, checks, documents, prints the template and writes the resolved
 * echo. What the keys mean is deck.c's business. */
#ifndef DEM_SCHEMA_H
#define DEM_SCHEMA_H

#include <stdio.h>

#include "namelist.h"

typedef enum schema_type { SCHEMA_REAL, SCHEMA_INTEGER, SCHEMA_LOGICAL, SCHEMA_STRING, SCHEMA_CHOICE } schema_type;

typedef struct schema_key {
    const char *name;
    schema_type type;
    int min_count, max_count; /* of values; max_count 0: any number */
    const char *unit;         /* "m", "Pa", "-" */
    const char *initial;      /* default as a deck would spell it; NULL: must be given; "": none, stays not given */
    const char *range;        /* "> 0", ">= 1", "[0, 1]", "(0, 1)", "" any; applies to each value */
    const char *choices;      /* CHOICE: "a|b|c"; else NULL */
    bool physics;             /* part of what makes two decks the same problem */
    const char *sentence;     /* documentation */
    const char *example; /* in the template, as a deck would spell it; NULL: the default; "" or none: a comment line */
} schema_key;

typedef struct schema_group {
    const char *name;
    bool required; /* at least one */
    bool repeated; /* may occur several times */
    const char *sentence;
    int n_keys;
    const schema_key *keys;
} schema_group;

/* The table, [*n_groups]. */
const schema_group *schema_groups(int *n_groups);

/* ---- a deck resolved against the table ---- */

typedef struct schema_value {
    bool given;  /* stated in the deck (a null value is not) */
    bool faulty; /* what the deck has for it, or for a misspelt name of it, is at fault, and has been reported */
    namelist_place place; /* of the key, or of the group if not given */
    int count;            /* number of values; 0 where nothing is given and there is no default */
    double *reals;        /* REAL, INTEGER (exact up to 2^53), LOGICAL as 0/1: [count] */
    char **texts;         /* STRING, CHOICE: [count] */
} schema_value;

typedef struct schema_instance {
    const schema_group *group;
    namelist_place place;
    schema_value *values; /* [group->n_keys] */
} schema_instance;

typedef struct schema_deck {
    size_t n_instances;
    schema_instance *instances; /* in the order of the table, then of the file */
    bool misspelt;              /* an unknown group was likely meant to be one of the table */
} schema_deck;

/* Checks a parsed namelist against the table and fills in defaults. Faults are appended to `errors`: unknown group or
 * key with the nearest name, repeated key, wrong type, wrong count, out of range, missing key or group. Where a value
 * is at fault the default stands in, so that later checks go on. Groups without occurrence that are not repeated get
 * one instance of defaults. Returns false only when memory runs out. Free with schema_free in any case. */
bool schema_resolve(schema_deck *out, const namelist *list, namelist_errors *errors);
void schema_free(schema_deck *deck);

/* Number of instances of a group, and the k-th of them, from 0; NULL if there is none. */
size_t schema_count(const schema_deck *deck, const char *group);
const schema_instance *schema_get(const schema_deck *deck, const char *group, size_t k);

/* Takes a value away, as if nothing had been stated and there were no default. */
void schema_drop(schema_instance *instance, const char *key);
/* Puts `text` in the place of a text; false when memory runs out. */
bool schema_set_text(schema_instance *instance, const char *key, const char *text);

/* A value by key name; the key must be in the table. */
const schema_value *schema_value_of(const schema_instance *instance, const char *key);
double schema_real(const schema_instance *instance, const char *key);         /* first real; 0 if not given */
const char *schema_text(const schema_instance *instance, const char *key);    /* first text; "" if not given */
const double *schema_reals(const schema_instance *instance, const char *key); /* NULL if not given */
bool schema_is(const schema_instance *instance, const char *key, const char *text);
bool schema_given(const schema_instance *instance, const char *key);
namelist_place schema_place(const schema_instance *instance, const char *key);

typedef enum schema_form {
    SCHEMA_MARKED,  /* every key, "! default" behind what was not given */
    SCHEMA_PHYSICS, /* the keys that make the problem */
    SCHEMA_COURSE,  /* those that a run must have in common with one that goes on from it */
    SCHEMA_BARE     /* every key, however it came to its value: the same for a deck and for its echo */
} schema_form;

/* Writes the deck resolved. Reals are printed so that they read back to the same bits; with every key, the result is
 * itself a valid deck that resolves to the same values. *out is malloc'ed; false when memory runs out. */
bool schema_echo(const schema_deck *deck, schema_form form, char **out);

/* A deck with every key at its default (or an example value where there is none) and its sentence as comment. */
void schema_template(FILE *file);

/* docs/deck.md, generated: one table per group. */
void schema_document(FILE *file);

/* Finds the name nearest to `word`: Levenshtein distance at most 1 + length/3, in any case; a name that `word` begins,
 * from three letters on, is at distance 1. Words and names of more than 63 characters are near to none. Returns false
 * if none is near. */
bool schema_nearest(const char *word, const char *const *names, size_t n_names, size_t *nearest);

#endif
