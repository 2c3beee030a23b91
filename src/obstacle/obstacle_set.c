/* SPDX-License-Identifier: BSD-3-Clause */
/* Compiles the obstacles of a model: copies of the points, segments and their trees (polyline.c), convex vertices and
 * their trees, and how far free ends go on behind other obstacles (docs/method.md, Start, free ends, errors). All of it
 * is in the frame of each obstacle, which is its place at t = 0. Afterwards the set does not change; queries are in
 * obstacle.c, point_gap.c and vertex_gap.c. */
#include "obstacle/obstacle_set.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "obstacle/obstacle_input.h"
#include "obstacle/point_gap.h"
#include "obstacle/polyline.h"

/* The caller's points may go away after the call. */
static dem_status copy_points(dem_obstacle *copy, const dem_obstacle *obstacle)
{
    const size_t size = 2 * (size_t)obstacle->n_points * sizeof(double);
    double *points = malloc(size);
    CHECK_MEMORY(points);
    memcpy(points, obstacle->points, size);
    *copy = *obstacle;
    copy->points = points;
    return DEM_OK;
}

/* The tree over the segments of obstacle o; buried ends are added later by bury_ends(). */
static dem_status plant_tree(obstacle_set *set, dem_index o)
{
    const dem_index n = set->list[o].n_points - 1;
    TRY(box_tree_create(&set->trees[o], n));
    for (dem_index k = 0; k < n; k++) {
        const box around = segment_cover(&set->segments[set->first[o] + k]);
        box_tree_cover(&set->trees[o], k, &around);
    }
    return DEM_OK;
}

/* Whether two obstacles are different ones that never move against each other. */
static bool go_together(const obstacle_set *o, dem_index a, dem_index b)
{
    return a != b && motion_law_is_same(&o->laws[a], &o->laws[b]);
}

/* Smallest gap of a point of an obstacle, in its frame, to the obstacles on which it may stand. */
static double distance_to_others(const obstacle_set *o, vec2 point, dem_index obstacle)
{
    double smallest = INFINITY;
    const vec2 x = obstacles_outside(o, obstacle, 0.0, point);
    for (dem_index k = 0; k < o->n; k++)
        if (go_together(o, k, obstacle)) smallest = fmin(smallest, obstacles_gap_of(o, 0.0, x, 0.0, k).distance);
    return smallest;
}

/* If the end meets the free end of another obstacle's segment and its continuation would be behind that segment, the
 * two form a corner: the length of that segment, else 0. `out` is the direction in which the end would go on. */
static double behind_free_end(const obstacle_set *o, const segment *s, vec2 end, vec2 out)
{
    double length = 0.0;
    for (dem_index k = 0; k < o->n_segments; k++) {
        const segment *b = &o->segments[k];
        if (!go_together(o, b->obstacle, s->obstacle) || vec2_dot(out, b->normal) >= 0.0) continue;
        const double start = b->before < 0 ? vec2_norm(vec2_sub(b->start, end)) : INFINITY;
        const double stop = b->after < 0 ? vec2_norm(vec2_sub(b->end, end)) : INFINITY;
        if (fmin(start, stop) <= 1e-6 * s->length) length = fmax(length, b->length);
    }
    return length;
}

/* A wall that stands on another obstacle, or meets its free end in a corner, goes on behind it, so that nothing slips
 * through the joint. How far, m: its own length, or the largest of its halves, quarters, ... that ends inside the other
 * obstacle; 0 if the end touches nothing. */
static double buried_length(const obstacle_set *o, const segment *s, vec2 end, vec2 out)
{
    const double touching = 1e-6 * s->length;
    if (distance_to_others(o, end, s->obstacle) > touching) return 0.0;
    for (double length = s->length; length > touching; length *= 0.5)
        if (distance_to_others(o, vec2_along(end, length, out), s->obstacle) < 0.0) return length;
    return fmin(s->length, behind_free_end(o, s, end, out));
}

/* For all free ends, once the segments of all obstacles are known. */
static void bury_ends(obstacle_set *o)
{
    for (dem_index k = 0; k < o->n_segments && o->n > 1; k++) {
        const segment *s = &o->segments[k];
        const double before = s->before < 0 ? buried_length(o, s, s->start, vec2_scale(-1.0, s->tangent)) : 0.0;
        const double after = s->after < 0 ? buried_length(o, s, s->end, s->tangent) : 0.0;
        o->segments[k].buried[0] = before;
        o->segments[k].buried[1] = after;
        const box around = segment_cover(s);
        box_tree_cover(&o->trees[s->obstacle], s->index, &around);
    }
}

/* Convex vertices, in the order of the segments that end there; there are at most as many as segments. */
static dem_status find_vertices(obstacle_set *o)
{
    o->vertices = malloc(((size_t)o->n_segments + 1) * sizeof *o->vertices);
    CHECK_MEMORY(o->vertices);
    for (dem_index k = 0; k < o->n_segments; k++) {
        dem_index after;
        if (obstacles_bend(o, k, false, &after) == OBSTACLE_CONVEX)
            o->vertices[o->n_vertices++] = (obstacle_vertex){o->segments[k].end, k, after};
    }
    return DEM_OK;
}

/* One tree for the vertices of all obstacles at rest, which a query goes through at once, and one for each obstacle
 * that moves, whose frame the query has to be taken to. The common tree numbers all vertices; those of moving obstacles
 * are in none of its boxes. */
static dem_status plant_vertices(obstacle_set *o)
{
    TRY(box_tree_create(&o->vertex_tree, o->n_vertices));
    dem_index k = 0;
    for (dem_index q = 0; q < o->n; q++) {
        const dem_index first = k;
        while (k < o->n_vertices && o->segments[o->vertices[k].before].obstacle == q) k++;
        o->first_vertex[q] = first;
        o->first_vertex[q + 1] = k;
        if (o->laws[q].moves) TRY(box_tree_create(&o->vertex_trees[q], k - first));
        for (dem_index v = first; v < k; v++) {
            const box around = box_around(o->vertices[v].at, o->vertices[v].at, 0.0);
            if (o->laws[q].moves)
                box_tree_cover(&o->vertex_trees[q], v - first, &around);
            else
                box_tree_cover(&o->vertex_tree, v, &around);
        }
    }
    return DEM_OK;
}

/* One more of each, so that nothing is allocated without bytes. */
static dem_status reserve(obstacle_set *o, dem_index n)
{
    o->list = calloc((size_t)n + 1, sizeof *o->list);
    o->segments = malloc(((size_t)o->n_segments + 1) * sizeof *o->segments);
    o->first = calloc((size_t)n + 1, sizeof *o->first);
    o->trees = calloc((size_t)n + 1, sizeof *o->trees);
    o->laws = calloc((size_t)n + 1, sizeof *o->laws);
    o->first_vertex = calloc((size_t)n + 1, sizeof *o->first_vertex);
    o->vertex_trees = calloc((size_t)n + 1, sizeof *o->vertex_trees);
    CHECK(o->list && o->segments && o->first && o->trees && o->laws && o->first_vertex && o->vertex_trees,
          DEM_ERROR_MEMORY, "out of memory for obstacles");
    return DEM_OK;
}

/* The obstacle counts from here on, so that obstacles_free() frees what it has if something fails. */
static dem_status append(obstacle_set *set, const dem_obstacle *obstacle)
{
    const dem_index o = set->n;
    TRY(copy_points(&set->list[o], obstacle));
    set->laws[o] = motion_law_of(&set->list[o]);
    set->bounds = motion_bounds_of_both(set->bounds, motion_law_bounds(&set->laws[o]));
    set->n++;
    set->is_asked = set->is_asked || obstacle->motion != NULL;
    TRY(motion_law_ask_start(&set->laws[o], o));
    polyline_compile(set, o);
    return plant_tree(set, o);
}

/* All but what obstacles are to each other. */
static dem_status compile_all(obstacle_set *o, const dem_obstacle *list, dem_index n)
{
    for (dem_index k = 0; k < n; k++) {
        TRY(polyline_check(&list[k], k));
        o->n_segments += list[k].n_points - 1;
    }
    TRY(reserve(o, n));
    for (dem_index k = 0; k < n; k++) TRY(append(o, &list[k]));
    return DEM_OK;
}

/* Each obstacle by itself first, then vertices and their trees, then what free ends do behind other obstacles: that
 * needs the gaps to all of them. */
dem_status obstacles_compile(obstacle_set *out, const dem_obstacle *list, dem_index n)
{
    obstacle_set o = {0};
    dem_status status = compile_all(&o, list, n);
    for (dem_index k = 0; k < n && status == DEM_OK; k++) status = polyline_check_crossings(&o, k);
    if (status == DEM_OK) status = find_vertices(&o);
    if (status == DEM_OK) status = plant_vertices(&o);
    if (status == DEM_OK) bury_ends(&o);
    if (status == DEM_OK)
        *out = o;
    else
        obstacles_free(&o);
    return status;
}

static dem_status find_crossing(const dem_obstacle *obstacle, dem_index segments[2])
{
    obstacle_set o = {0};
    dem_status status = compile_all(&o, obstacle, 1);
    if (status == DEM_OK) status = polyline_check_crossings(&o, 0);
    if (status == DEM_ERROR_MODEL && o.n == 1) (void)polyline_find_crossing(segments, &o, 0);
    obstacles_free(&o);
    return status;
}

/* Compiles one obstacle by itself and names the pair of segments that meet, for programs that mark them. */
dem_status dem_obstacle_check(const dem_obstacle *obstacle, dem_index segments[2])
{
    CHECK(obstacle != NULL && segments != NULL, DEM_ERROR_ARGUMENT, "dem_obstacle_check: %s is NULL",
          obstacle ? "segments" : "obstacle");
    dem_obstacle own;
    TRY(obstacle_input_read(&own, obstacle));
    segments[0] = segments[1] = -1;
    return find_crossing(&own, segments);
}

/* The points are const for users of the set, and belong to it. */
void obstacles_free(obstacle_set *o)
{
    for (dem_index k = 0; k < o->n; k++) {
        free((void *)(uintptr_t)o->list[k].points);
        box_tree_free(&o->trees[k]);
        box_tree_free(&o->vertex_trees[k]);
    }
    free(o->list);
    free(o->segments);
    free(o->first);
    free(o->trees);
    free(o->vertices);
    free(o->laws);
    free(o->first_vertex);
    free(o->vertex_trees);
    box_tree_free(&o->vertex_tree);
    *o = (obstacle_set){0};
}
