/* SPDX-License-Identifier: BSD-3-Clause */
/* Copies of a body: how many of them a &body group asks for, and where each of them is. The first one is the body as it
 * would be without the keys; body.c builds it and puts the others beside it. */
#ifndef DEM_COPIES_H
#define DEM_COPIES_H

#include "schema.h"

enum { COPIES_MAX = 10000 }; /* of one group */

/* Keys that do not go together; groups that need one body and have a body with copies. */
void copies_check(const schema_deck *groups, namelist_errors *errors);

/* Number of copies, the first one included. */
size_t copies_count(const schema_instance *body);

/* Of all bodies of the deck. */
size_t copies_total(const schema_deck *groups);

/* A body, when copies are counted as bodies, too. */
typedef struct copies_origin {
    size_t group, copy; /* from 0: its &body, and which of its copies it is */
} copies_origin;

/* Of the body with this number, from 0, which must be less than copies_total(). */
copies_origin copies_find(const schema_deck *groups, size_t number);

/* How far copy k, from 0, is moved from the place of the body without copies, m. False when memory runs out. */
bool copies_shift(double shift[2], const schema_instance *body, size_t k);

#endif
