/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinds.h"

#include <math.h>
#include <stdlib.h>

/* What is nearer to the first of a kind than this times its size is of that kind. */
static const double rounding = 1e-12;

typedef struct thing {
    kinds_pair pair;
    dem_index number;
} thing;

static int compare(double a, double b)
{
    return (a > b) - (a < b);
}

static int compare_things(const void *one, const void *other)
{
    const thing *a = one, *b = other;
    const int first = compare(a->pair.a, b->pair.a), second = compare(a->pair.b, b->pair.b);
    return first != 0 ? first : second != 0 ? second : (a->number > b->number) - (a->number < b->number);
}

static bool alike(double a, double b)
{
    return fabs(a - b) <= rounding * fabs(a);
}

/* First numbers that are alike become equal, so that second ones are in order among them. */
static void level(thing *things, dem_index n)
{
    for (dem_index k = 1; k < n; k++)
        if (alike(things[k - 1].pair.a, things[k].pair.a)) things[k].pair.a = things[k - 1].pair.a;
}

static void number(kinds *out, const thing *things, dem_index n)
{
    for (dem_index k = 0; k < n; k++) {
        const kinds_pair p = things[k].pair;
        const kinds_pair *last = out->n > 0 ? &out->values[out->n - 1] : NULL;
        if (last == NULL || last->a != p.a || !alike(last->b, p.b)) out->values[out->n++] = p;
        out->of[things[k].number] = out->n - 1;
    }
}

bool kinds_find(kinds *out, const task *t, dem_index n, const kinds_pair *pairs)
{
    thing *things = task_allocate(t, n, sizeof *things);
    *out = (kinds){0, task_allocate(t, n, sizeof *out->of), task_allocate(t, n, sizeof *out->values)};
    const bool room = things != NULL && out->of != NULL && out->values != NULL;
    for (dem_index k = 0; room && k < n; k++) things[k] = (thing){pairs[k], k};
    if (room) {
        qsort(things, (size_t)n, sizeof *things, compare_things);
        level(things, n);
        qsort(things, (size_t)n, sizeof *things, compare_things);
        number(out, things, n);
    }
    free(things);
    return room;
}

void kinds_free(kinds *k)
{
    free(k->of);
    free(k->values);
    *k = (kinds){0};
}
