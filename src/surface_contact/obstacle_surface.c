/* SPDX-License-Identifier: BSD-3-Clause */
/* Compiles polylines to edges. Bodies live on the left of a segment, and an edge pushes to its right, as those of
 * bodies do: a segment from a to b becomes the edge from b to a, and of an open polyline also the edge from a to b. At
 * the free ends of that the edge before an edge is its own other side. */
#include "surface_contact/obstacle_surface.h"

#include <stdlib.h>

#include "base/status.h"

/* The polyline of one obstacle. */
typedef struct polyline_part {
    dem_index n_segments, n_vertices;
    bool closed;
} polyline_part;

static polyline_part part_of(const obstacle_set *of, dem_index k)
{
    const dem_index n = of->first[k + 1] - of->first[k];
    const bool closed = of->segments[of->first[k]].before >= 0;
    return (polyline_part){n, closed ? n : n + 1, closed};
}

static dem_status allocate(obstacle_surface *s)
{
    const size_t n = 2 * ((size_t)s->of->n_segments + (size_t)s->of->n);
    s->first_vertex = calloc((size_t)s->of->n + 1, sizeof *s->first_vertex);
    s->obstacle = malloc((n + 1) * sizeof *s->obstacle);
    s->half_length = calloc(n + 1, sizeof *s->half_length);
    s->edges = malloc((n + 1) * sizeof *s->edges);
    s->frames = calloc((size_t)s->of->n + 1, sizeof *s->frames);
    s->poses = calloc((size_t)s->of->n + 1, sizeof *s->poses);
    s->is_marked = calloc(n + 1, 1);
    CHECK(s->first_vertex && s->obstacle && s->half_length && s->edges && s->frames && s->poses && s->is_marked,
          DEM_ERROR_MEMORY, "out of memory for %lld segments of obstacles", (long long)s->of->n_segments);
    return DEM_OK;
}

static void add_vertices(obstacle_surface *s, dem_index k, const polyline_part *part)
{
    const segment *segments = &s->of->segments[s->of->first[k]];
    for (dem_index i = 0; i < part->n_segments; i++) {
        s->half_length[s->n_vertices + i] += 0.25 * segments[i].length;
        s->half_length[s->n_vertices + (i + 1) % part->n_vertices] += 0.25 * segments[i].length;
    }
    for (dem_index i = 0; i < part->n_vertices; i++) s->obstacle[s->n_vertices + i] = k;
}

static void add_frame(obstacle_surface *s, dem_index k)
{
    const dem_obstacle *o = &s->of->list[k];
    s->frames[k] = box_empty();
    for (dem_index i = 0; i < o->n_points; i++) s->frames[k] = box_with(s->frames[k], vec2_at(o->points, i));
}

/* The edge from one vertex of an obstacle to the next (step = 1) or to the one before (step = -1); its vertices are
 * numbered from `at` on. At a free end the edge beyond is its own other side. */
static void add_edge(obstacle_surface *s, dem_index at, const polyline_part *part, dem_index first, dem_index step)
{
    const dem_index n = part->n_vertices, second = (first + step + n) % n;
    const dem_index before = first - step, after = second + step;
    const bool starts = !part->closed && (before < 0 || before >= n), ends = !part->closed && (after < 0 || after >= n);
    s->edges[s->n_edges++] = (surface_edge){.first = at + first,
                                            .second = at + second,
                                            .before = at + (starts ? second : (before + n) % n),
                                            .after = at + (ends ? first : (after + n) % n)};
}

static void add_edges(obstacle_surface *s, dem_index at, const polyline_part *part)
{
    const dem_index n = part->n_vertices;
    for (dem_index i = 0; i < part->n_segments; i++) add_edge(s, at, part, (i + 1) % n, -1);
    for (dem_index i = 0; i < part->n_segments && !part->closed; i++) add_edge(s, at, part, i, 1);
}

dem_status obstacle_surface_compile(obstacle_surface *out, const obstacle_set *of)
{
    obstacle_surface s = {.of = of};
    const dem_status status = allocate(&s);
    for (dem_index k = 0; k < of->n && status == DEM_OK; k++) {
        const polyline_part part = part_of(of, k);
        s.first_vertex[k] = s.n_vertices;
        add_frame(&s, k);
        add_vertices(&s, k, &part);
        add_edges(&s, s.n_vertices, &part);
        s.n_vertices += part.n_vertices;
        s.first_vertex[k + 1] = s.n_vertices;
    }
    if (status == DEM_OK) {
        obstacle_surface_follow(&s, 0.0);
        *out = s;
    } else {
        obstacle_surface_free(&s);
    }
    return status;
}

void obstacle_surface_free(obstacle_surface *s)
{
    free(s->first_vertex);
    free(s->obstacle);
    free(s->half_length);
    free(s->edges);
    free(s->frames);
    free(s->poses);
    free(s->is_marked);
    *s = (obstacle_surface){0};
}

void obstacle_surface_follow(obstacle_surface *s, double t)
{
    for (dem_index k = 0; k < s->of->n; k++)
        if (s->of->laws[k].moves) s->poses[k] = motion_law_pose(&s->of->laws[k], t);
}

static vec2 outside(const obstacle_surface *s, dem_index k, vec2 x)
{
    return s->of->laws[k].moves ? pose_outside(&s->poses[k], x) : x;
}

vec2 obstacle_surface_place(const obstacle_surface *s, dem_index vertex)
{
    const dem_index k = s->obstacle[vertex];
    return outside(s, k, vec2_at(s->of->list[k].points, vertex - s->first_vertex[k]));
}

vec2 obstacle_surface_corner(const obstacle_surface *s, dem_index obstacle, int corner)
{
    const box *b = &s->frames[obstacle];
    return outside(s, obstacle, (vec2){corner & 1 ? b->high.x : b->low.x, corner & 2 ? b->high.y : b->low.y});
}

vec2 obstacle_surface_velocity(const obstacle_surface *s, dem_index vertex)
{
    const dem_index k = s->obstacle[vertex];
    return s->of->laws[k].moves ? pose_velocity(&s->poses[k], obstacle_surface_place(s, vertex)) : (vec2){0.0, 0.0};
}

bool obstacle_surface_has_friction(const obstacle_surface *s)
{
    for (dem_index k = 0; k < s->of->n; k++)
        if (obstacle_surface_friction(s, k) > 0.0) return true;
    return false;
}
