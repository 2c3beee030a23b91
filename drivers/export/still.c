/* SPDX-License-Identifier: BSD-3-Clause */
#include "still.h"

#include <stdlib.h>
#include <string.h>

static bool add(still *s, const dem_reader_array *what)
{
    const dem_index n = what->of_springs ? s->n_springs : s->n_nodes;
    still_array *a = &s->arrays[s->n_arrays];
    *a = (still_array){what, task_allocate(s->task, n * what->components, sizeof *a->values)};
    if (a->values != NULL) s->n_arrays++;
    return a->values != NULL;
}

static bool add_named(still *s, const still_choice *choice)
{
    for (dem_index k = 0; k < choice->n_names; k++) {
        const dem_reader_array *what = dem_reader_array_find(s->task->reader, choice->names[k]);
        if (what != NULL && what->of_springs == choice->of_springs && !add(s, what)) return false;
    }
    return true;
}

bool still_open(still *out, const task *t, const still_choice *choice)
{
    dem_index n = 0;
    const dem_lattice *l = dem_reader_lattice(t->reader);
    const dem_reader_array *all = dem_reader_arrays(t->reader, &n);
    *out = (still){.task = t, .n_nodes = l->n_nodes, .n_springs = l->n_springs};
    out->x = task_allocate(t, 2 * l->n_nodes, sizeof *out->x);
    out->arrays = task_allocate(t, choice->names != NULL ? choice->n_names : n, sizeof *out->arrays);
    if (out->x == NULL || out->arrays == NULL) return false;
    if (choice->names != NULL) return add_named(out, choice);
    for (dem_index k = 0; k < n; k++)
        if (all[k].of_springs == choice->of_springs && !add(out, &all[k])) return false;
    return true;
}

void still_free(still *s)
{
    for (dem_index k = 0; k < s->n_arrays; k++) free(s->arrays[k].values);
    free(s->arrays);
    free(s->x);
    *s = (still){0};
}

bool still_read(still *s, dem_index frame)
{
    const dem_reader *reader = s->task->reader;
    if (!task_holds(s->task, dem_reader_positions(reader, frame, s->x))) return false;
    for (dem_index k = 0; k < s->n_arrays; k++)
        if (!task_holds(s->task, dem_reader_read(reader, s->arrays[k].what, frame, s->arrays[k].values))) return false;
    return true;
}

const double *still_values(const still *s, const char *name)
{
    for (dem_index k = 0; k < s->n_arrays; k++)
        if (strcmp(s->arrays[k].what->name, name) == 0) return s->arrays[k].values;
    return NULL;
}
