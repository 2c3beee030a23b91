/* SPDX-License-Identifier: BSD-3-Clause */
/* Two segments ab and pq cross if a and b lie on different sides of the line pq, and p and q of ab. All vectors from a
 * point of one to a point of the other fill a parallelogram around 0, and its sides are the places where an end of one
 * segment is on the other: the way to come apart is the least distance of an end to the other segment. */
#include "obstacle/edge_crossing.h"

static double distance_to(vec2 x, vec2 a, vec2 b)
{
    const vec2 way = vec2_sub(b, a), from = vec2_sub(x, a);
    const double place = fmin(fmax(vec2_dot(from, way) / vec2_dot(way, way), 0.0), 1.0);
    return vec2_norm(vec2_along(from, -place, way));
}

static bool parts(vec2 a, vec2 b, vec2 p, vec2 q)
{
    const vec2 way = vec2_sub(b, a);
    const double left = vec2_cross(way, vec2_sub(p, a)), right = vec2_cross(way, vec2_sub(q, a));
    return (left > 0.0 && right < 0.0) || (left < 0.0 && right > 0.0);
}

static double depth_of(vec2 a, vec2 b, const segment *s)
{
    if (!parts(a, b, s->start, s->end) || !parts(s->start, s->end, a, b)) return 0.0;
    return fmin(fmin(distance_to(a, s->start, s->end), distance_to(b, s->start, s->end)),
                fmin(distance_to(s->start, a, b), distance_to(s->end, a, b)));
}

/* In the frame of the obstacle, where its tree is. */
static void look_deeper(const obstacle_set *o, dem_index obstacle, const vec2 edge[2], obstacle_crossing *deepest)
{
    const box_tree *tree = &o->trees[obstacle];
    const box around = box_around(edge[0], edge[1], 0.0);
    for (dem_index k = box_tree_seek(tree, 0, &around); k < tree->n; k = box_tree_seek(tree, k + 1, &around)) {
        const dem_index id = o->first[obstacle] + k;
        const double depth = depth_of(edge[0], edge[1], &o->segments[id]);
        if (depth > deepest->depth) *deepest = (obstacle_crossing){id, depth};
    }
}

obstacle_crossing obstacles_crossing(const obstacle_set *o, double t, const vec2 edge[2], const dem_index without[2])
{
    obstacle_crossing deepest = {-1, 0.0};
    for (dem_index k = 0; k < o->n; k++) {
        if (k == without[0] || k == without[1]) continue;
        const vec2 inside[2] = {obstacles_inside(o, k, t, edge[0]), obstacles_inside(o, k, t, edge[1])};
        look_deeper(o, k, inside, &deepest);
    }
    return deepest;
}
