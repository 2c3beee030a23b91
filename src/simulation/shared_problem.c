/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays that are not there have no entry. All ranks are the same program on machines of one kind, so that structs are
 * sent as they are; what points anywhere is put in place again. */
#include "simulation/shared_problem.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/checkpoint_entries.h"
#include "base/status.h"

enum { NAME_LENGTH = 32 };

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

dem_status shared_problem_put(dem_checkpoint *into, const dem_obstacle *obstacles, dem_index n_obstacles,
                              const dem_options *options)
{
    TRY(dem_checkpoint_put(into, "obstacles", &n_obstacles, sizeof n_obstacles));
    TRY(dem_checkpoint_put(into, "options", options, sizeof *options));
    if (options->body_friction != NULL)
        TRY(dem_checkpoint_put(into, "body friction", options->body_friction,
                               (size_t)options->n_body_frictions * sizeof *options->body_friction));
    for (dem_index k = 0; k < n_obstacles; k++) TRY(put_obstacle(into, &obstacles[k], k));
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

dem_status shared_problem_get(shared_problem *out, const dem_checkpoint *from)
{
    size_t size;
    *out = (shared_problem){0};
    TRY(dem_checkpoint_get(from, "obstacles", &out->n_obstacles, sizeof out->n_obstacles));
    TRY(dem_checkpoint_get(from, "options", &out->options, sizeof out->options));
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
