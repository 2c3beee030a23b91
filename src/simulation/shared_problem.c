/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays that are not there have no entry. All ranks are the same program on machines of one kind, so that structs are
 * sent as they are; what points anywhere is put in place again. */
#include "simulation/shared_problem.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/checkpoint_entries.h"
#include "base/status.h"
#include "lattice/lattice_arrays.h"

enum { N_NUMBERS = 4, NAME_LENGTH = 32 };

static const char *name_list(char name[NAME_LENGTH], const char *what, dem_index boundary)
{
    (void)snprintf(name, NAME_LENGTH, "%s %lld", what, (long long)boundary);
    return name;
}

static dem_status put_boundary(dem_checkpoint *into, const dem_boundary *b, dem_index number)
{
    char name[NAME_LENGTH];
    const size_t n = (size_t)b->n_nodes;
    TRY(dem_checkpoint_put(into, name_list(name, "boundary", number), b, sizeof *b));
    TRY(dem_checkpoint_put(into, name_list(name, "nodes", number), b->nodes, n * sizeof *b->nodes));
    if (b->share == NULL) return DEM_OK;
    return dem_checkpoint_put(into, name_list(name, "share", number), b->share, n * sizeof *b->share);
}

static dem_status put_obstacle(dem_checkpoint *into, const dem_obstacle *o, dem_index number)
{
    char name[NAME_LENGTH];
    TRY(dem_checkpoint_put(into, name_list(name, "obstacle", number), o, sizeof *o));
    return dem_checkpoint_put(into, name_list(name, "points", number), o->points,
                              2 * (size_t)o->n_points * sizeof *o->points);
}

dem_status shared_problem_put(dem_checkpoint *into, const dem_model *model, const dem_options *options)
{
    const dem_lattice *l = &model->lattice;
    const obstacle_set *obstacles = &model->obstacles;
    const dem_index numbers[N_NUMBERS] = {l->n_nodes, l->n_springs, l->n_triangles, obstacles->n};
    TRY(dem_checkpoint_put(into, "numbers", numbers, sizeof numbers));
    TRY(dem_checkpoint_put(into, "options", options, sizeof *options));
    if (options->body_friction != NULL)
        TRY(dem_checkpoint_put(into, "body friction", options->body_friction,
                               (size_t)options->n_body_frictions * sizeof *options->body_friction));
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        const void *items = lattice_array_of(l, a);
        if (items != NULL) TRY(dem_checkpoint_put(into, a->name, items, (size_t)lattice_count(l, a->of) * a->size));
    }
    for (dem_index k = 0; k < obstacles->n; k++) TRY(put_obstacle(into, &obstacles->list[k], k));
    for (dem_index k = 0; k < options->n_boundaries; k++) TRY(put_boundary(into, &options->boundaries[k], k));
    return DEM_OK;
}

static dem_status get_boundary(dem_boundary *out, const dem_checkpoint *from, dem_index number)
{
    char name[NAME_LENGTH];
    size_t size;
    TRY(dem_checkpoint_get(from, name_list(name, "boundary", number), out, sizeof *out));
    out->nodes = dem_checkpoint_find(from, name_list(name, "nodes", number), &size);
    out->share = dem_checkpoint_find(from, name_list(name, "share", number), &size);
    return DEM_OK;
}

static dem_status get_obstacle(dem_obstacle *out, const dem_checkpoint *from, dem_index number)
{
    char name[NAME_LENGTH];
    size_t size;
    TRY(dem_checkpoint_get(from, name_list(name, "obstacle", number), out, sizeof *out));
    out->points = dem_checkpoint_find(from, name_list(name, "points", number), &size);
    return DEM_OK;
}

static void view_lattice(dem_lattice *l, const dem_checkpoint *from)
{
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        size_t size;
        const void *items = dem_checkpoint_find(from, lattice_arrays[k].name, &size);
        lattice_array_put(l, &lattice_arrays[k], (void *)(uintptr_t)items); /* which nobody changes */
    }
}

dem_status shared_problem_get(shared_problem *out, const dem_checkpoint *from)
{
    dem_index numbers[N_NUMBERS];
    size_t size;
    *out = (shared_problem){.lattice = dem_lattice_empty()};
    TRY(dem_checkpoint_get(from, "numbers", numbers, sizeof numbers));
    TRY(dem_checkpoint_get(from, "options", &out->options, sizeof out->options));
    out->lattice.n_nodes = numbers[0];
    out->lattice.n_springs = numbers[1];
    out->lattice.n_triangles = numbers[2];
    out->n_obstacles = numbers[3];
    view_lattice(&out->lattice, from);
    out->obstacles = calloc((size_t)out->n_obstacles + 1, sizeof *out->obstacles);
    out->boundaries = calloc((size_t)out->options.n_boundaries + 1, sizeof *out->boundaries);
    CHECK(out->obstacles != NULL && out->boundaries != NULL, DEM_ERROR_MEMORY, "out of memory for what ranks share");
    out->options.boundaries = out->boundaries;
    out->options.body_friction = dem_checkpoint_find(from, "body friction", &size);
    for (dem_index k = 0; k < out->n_obstacles; k++) TRY(get_obstacle(&out->obstacles[k], from, k));
    for (dem_index k = 0; k < out->options.n_boundaries; k++) TRY(get_boundary(&out->boundaries[k], from, k));
    return DEM_OK;
}

void shared_problem_free(shared_problem *p)
{
    free(p->obstacles);
    free(p->boundaries);
    *p = (shared_problem){0};
}
