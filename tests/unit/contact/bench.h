/* SPDX-License-Identifier: BSD-3-Clause */
/* A scene put together by hand, contacts anywhere: nodes 0 .. n-1, candidates 0 .. n-1 of them, then candidates of
 * edges. Contact q of candidate k is on feature 2 k + q: a segment of its own for a node, a vertex of its own for an
 * edge. */
#ifndef DEM_TEST_BENCH_H
#define DEM_TEST_BENCH_H

#include "verification/support.h"

#include "contact/contact_point.h"

enum { BENCH_NODES = 12, BENCH_CANDIDATES = 24, BENCH_FEATURES = 2 * BENCH_CANDIDATES, BENCH_OBSTACLES = 3 };

typedef struct bench {
    dem_model model;
    forces acting;
    contact_scene scene;
    double mass[BENCH_NODES], inverse_mass[BENCH_NODES], x[2 * BENCH_NODES], v[2 * BENCH_NODES];
    int32_t body[BENCH_NODES];
    int32_t none[BENCH_NODES + 1]; /* rows of no springs and no triangles */
    dem_obstacle list[BENCH_OBSTACLES];
    motion_law laws[BENCH_OBSTACLES]; /* at rest */
    segment segments[BENCH_FEATURES];
    obstacle_vertex vertices[BENCH_FEATURES];
    dem_index n_candidates;
    contact_candidate candidates[BENCH_CANDIDATES];
} bench;

/** n free nodes of mass 1 at rest in the origin, their candidates, and no edges. Stays where it is: it points to
 *  itself. Steps so long that nothing draws a contact back. Obstacle 0 is smooth, 1 has Coulomb's friction, 2 the law
 *  (10). */
static inline void bench_open(bench *b, dem_index n)
{
    assert_true(n <= BENCH_NODES);
    *b = (bench){0};
    b->list[1].friction = 0.3;
    b->list[2] =
        (dem_obstacle){.struct_size = sizeof(dem_obstacle), .friction = 0.9, .friction_law = DEM_FRICTION_PAPER};
    for (dem_index i = 0; i < n; i++) {
        b->mass[i] = b->inverse_mass[i] = 1.0;
        b->candidates[i] = (contact_candidate){.node = i, .other = -1, .previous = -1, .next = -1, .behind = {-1, -1}};
    }
    b->n_candidates = n;
    b->model.lattice = (dem_lattice){.dim = 2, .n_nodes = n, .mass = b->mass, .body = b->body};
    b->model.surface.n_nodes = n;
    b->model.inverse_mass = b->inverse_mass;
    b->model.springs.row = b->none;
    b->model.triangles.row = b->none;
    b->model.obstacles = (obstacle_set){.n = BENCH_OBSTACLES, .list = b->list, .segments = b->segments};
    b->model.obstacles.vertices = b->vertices;
    b->model.obstacles.laws = b->laws;
    b->acting = (forces){.model = &b->model};
    b->scene = (contact_scene){
        .model = &b->model, .forces = &b->acting, .rule = {.penetration_tolerance = 1e-6, .max_step = 1e100}};
    b->scene.rule.layout = (state_layout){.dim = 2, .n_nodes = n, .n_rows = n};
}

static inline void bench_mass(bench *b, dem_index node, double mass)
{
    b->mass[node] = mass;
    b->inverse_mass[node] = 1.0 / mass;
}

/** An edge from node a to b, after the one that ends at a and before the one that starts at b; returns its candidate.
 *  */
static inline dem_index bench_edge(bench *b, dem_index from, dem_index to)
{
    contact_candidate edge = {.node = from, .other = to, .previous = -1, .next = -1, .behind = {-1, -1}};
    assert_true(b->n_candidates < BENCH_CANDIDATES);
    for (dem_index k = 0; k < b->n_candidates; k++) {
        contact_candidate *beside = &b->candidates[k];
        if (!candidate_is_edge(beside)) continue;
        if (beside->other == from) edge.previous = beside->node, beside->next = to;
        if (beside->node == to) edge.next = beside->other, beside->previous = from;
    }
    b->candidates[b->n_candidates] = edge;
    return b->n_candidates++;
}

/** Closes another contact of candidate k on an obstacle. A node lies on a segment whose normal has the angle `at`; an
 *  edge has a vertex at the fraction `at` of it, where it sticks if sign is 0. Positions must have been set. */
static inline contact_point *bench_touch(bench *b, dem_index k, dem_index obstacle, double at, int sign)
{
    contact_candidate *candidate = &b->candidates[k];
    const dem_index feature = 2 * k + candidate->n_closed;
    contact_point *point = &candidate->closed[candidate->n_closed++];
    segment *s = &b->segments[feature];
    assert_true(candidate->n_closed <= 2);
    *point = (contact_point){.feature = feature, .slide = sign};
    s->obstacle = obstacle;
    s->index = feature;
    if (candidate_is_edge(candidate)) {
        const vec2 a = vec2_at(b->x, candidate->node), ab = vec2_sub(vec2_at(b->x, candidate->other), a);
        b->vertices[feature] = (obstacle_vertex){.at = vec2_along(a, at, ab), .before = feature, .after = -1};
        point->place = sign == 0 ? at : 77.0;
        return point;
    }
    s->normal = (vec2){cos(at), sin(at)};
    s->tangent = (vec2){s->normal.y, -s->normal.x};
    s->start = vec2_along(vec2_at(b->x, candidate->node), -0.5, s->tangent);
    s->end = vec2_along(s->start, 1.0, s->tangent);
    s->length = 1.0;
    return point;
}

/** Two segments with normals of these angles hold node k, whatever their signs say. */
static inline void bench_corner(bench *b, dem_index k, double first, double second)
{
    bench_touch(b, k, 1, first, 0)->held = true;
    bench_touch(b, k, 1, second, 1)->held = true;
}

#endif
