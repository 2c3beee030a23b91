/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays that are not there have no entry. All ranks are the same program on machines of one kind, so that structs are
 * sent as they are; what points anywhere is put in place again. */
#include "simulation/shared_problem.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/checkpoint_entries.h"
#include "base/status.h"

/* An array of a lattice: its entry, and where it is. What breaks is not among them, as ranks cannot share it. */
typedef struct array {
    const char *name;
    void *at; /* the pointer to it */
    size_t size;
} array;

enum { N_ARRAYS = 16, N_NUMBERS = 4, NAME_LENGTH = 32 };

static void list_arrays(dem_lattice *l, array list[N_ARRAYS])
{
    const size_t n = (size_t)l->n_nodes, s = (size_t)l->n_springs, t = (size_t)l->n_triangles, real = sizeof(double);
    const array all[N_ARRAYS] = {{"x", &l->x, 2 * n * real},
                                 {"mass", &l->mass, n * real},
                                 {"ends", &l->ends, 2 * s * sizeof *l->ends},
                                 {"rest_length", &l->rest_length, s * real},
                                 {"stiffness", &l->stiffness, s * real},
                                 {"triangles", &l->triangles, 3 * t * sizeof *l->triangles},
                                 {"viscosity", &l->viscosity, s * real},
                                 {"guard", &l->guard, t * real},
                                 {"area_stiffness", &l->area_stiffness, t * real},
                                 {"thickness", &l->thickness, t * real},
                                 {"modulus", &l->modulus, t * real},
                                 {"flags", &l->flags, n},
                                 {"body", &l->body, n * sizeof *l->body},
                                 {"position", &l->position, 2 * n * real},
                                 {"velocity", &l->velocity, 2 * n * real},
                                 {"coupling", &l->coupling, 3 * t * real}};
    for (int k = 0; k < N_ARRAYS; k++) list[k] = all[k];
}

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
    dem_lattice view = model->lattice;
    const obstacle_set *obstacles = &model->obstacles;
    array list[N_ARRAYS];
    const dem_index numbers[N_NUMBERS] = {view.n_nodes, view.n_springs, view.n_triangles, obstacles->n};
    list_arrays(&view, list);
    TRY(dem_checkpoint_put(into, "numbers", numbers, sizeof numbers));
    TRY(dem_checkpoint_put(into, "options", options, sizeof *options));
    for (int k = 0; k < N_ARRAYS; k++) {
        const void *data = *(void **)list[k].at;
        if (data != NULL) TRY(dem_checkpoint_put(into, list[k].name, data, list[k].size));
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
    array list[N_ARRAYS];
    list_arrays(l, list);
    for (int k = 0; k < N_ARRAYS; k++) {
        size_t size;
        const void *data = dem_checkpoint_find(from, list[k].name, &size);
        *(void **)list[k].at = (void *)(uintptr_t)data; /* which nobody changes */
    }
}

dem_status shared_problem_get(shared_problem *out, const dem_checkpoint *from)
{
    dem_index numbers[N_NUMBERS];
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
