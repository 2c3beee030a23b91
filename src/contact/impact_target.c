/* SPDX-License-Identifier: BSD-3-Clause */
/* What a candidate hits: of the segments that a node touches the one or two whose surfaces act, or the edge at a node
 * that comes down flat on a vertex (docs/method.md, Corners; A node at a convex vertex). At a vertex of a polyline two
 * segments are touched at once, yet only in a corner do both act. What the impact does is in impact_node.c and
 * impact_group.c. */
#include "contact/impact_target.h"

/* m. The way in an instant is allowed beyond twice the penetration tolerance, and the furthest that a projection after
 * a step has moved a node. */
double impact_target_depth(const contact_set *c, dem_index k, const contact_instant *now)
{
    const contact_candidate *candidate = &c->list[k];
    const double speed = vec2_norm(vec2_at(now->v, candidate->node));
    const double other = candidate_is_edge(candidate) ? vec2_norm(vec2_at(now->v, candidate->other)) : 0.0;
    return 2.0 * c->scene.rule.penetration_tolerance + c->projected +
           scene_instant(&c->scene, now->t) * (fmax(speed, other) + surface_speed(&c->scene));
}

/* A node that may hit several segments. */
typedef struct approaching {
    surface_query at;
    vec2 v;
} approaching;

/* Its velocity away from the line of a segment, m/s. */
static double receding(const contact_set *c, dem_index s, const approaching *node)
{
    const obstacle_motion wall = surface_motion(&c->scene, s, node->at);
    return vec2_dot(obstacle_motion_relative(&wall, node->v), surface_line_at(&c->scene, s, node->at.t).normal);
}

/* Whether segment s leaves the impact to another one. A node at a vertex meets one segment only, unless the vertex is a
 * corner: of two in line or with a convex bend the one approached faster, on a tie the one that ends there. */
static bool yields(const contact_set *c, dem_index s, dem_index to, const approaching *node)
{
    dem_index after, before;
    const obstacle_bend ahead = surface_bend(&c->scene, s, false, &after);
    const obstacle_bend behind = surface_bend(&c->scene, s, true, &before);
    const bool follows = before == to && behind != OBSTACLE_CONCAVE, leads = after == to && ahead != OBSTACLE_CONCAVE;
    if (!follows && !leads) return false;
    const double mine = receding(c, s, node), other = receding(c, to, node);
    return mine > other || (mine == other && follows);
}

/* Neighbours are a corner near the vertex that they share; segments of different obstacles if they are not nearly
 * parallel. */
bool impact_target_is_corner(const contact_set *c, dem_index s, dem_index other, surface_query at, double tolerance)
{
    vec2 vertex;
    if (surface_share(&c->scene, s, other, at.t, &vertex)) return vec2_norm(vec2_sub(at.x, vertex)) <= 4.0 * tolerance;
    return fabs(vec2_cross(surface_line_at(&c->scene, s, at.t).tangent,
                           surface_line_at(&c->scene, other, at.t).tangent)) > 0.01;
}

/* The speed of the node towards the line of a segment, m/s. */
static double approach(const contact_set *c, dem_index s, const approaching *node)
{
    return -receding(c, s, node);
}

/* Of the segments touched, those that yield to none are ranked by the speed of approach; the two fastest are kept, on a
 * tie the one found first, and the second only if both form a corner. */
impact_target impact_target_of_node(const contact_set *c, dem_index k, const contact_instant *now)
{
    enum { capacity = 8 };
    dem_index hits[capacity];
    impact_target out = {0};
    const contact_candidate *candidate = &c->list[k];
    const approaching node = {{now->t, vec2_at(now->x, candidate->node)}, vec2_at(now->v, candidate->node)};
    const obstacle_touch point = {impact_target_depth(c, k, now), scene_margin(&c->scene), candidate->behind[0]};
    const int n = surface_touching(&c->scene, node.at, &point, hits, capacity);
    for (int h = 0; h < n; h++) {
        bool meets = true;
        for (int q = 0; q < n && meets; q++) meets = !yields(c, hits[h], hits[q], &node);
        if (!meets) continue;
        const int place = out.n > 0 && approach(c, hits[h], &node) <= approach(c, out.feature[0], &node) ? 1 : 0;
        if (place == 1 && out.n == 2 && approach(c, hits[h], &node) <= approach(c, out.feature[1], &node)) continue;
        if (place == 0) out.feature[1] = out.feature[0];
        out.feature[place] = hits[h];
        out.n = out.n < 2 ? out.n + 1 : 2;
    }
    if (out.n == 2 && !impact_target_is_corner(c, out.feature[0], out.feature[1], node.at, point.tolerance)) out.n = 1;
    return out;
}

/* Of the edges at the node, the one that approaches a vertex fastest. Only those count for which the node is on the
 * vertex and whose normal lies between those of the vertex's segments. If there is none, the normal of a segment is the
 * right one, and the node hits that. */
dem_index impact_target_edge(const contact_set *c, dem_index k, const contact_instant *now, dem_index *vertex)
{
    const dem_index node = c->list[k].node;
    const double tolerance = impact_target_depth(c, k, now);
    double fastest = 0.0;
    dem_index best = -1;
    for (contact_edges e = contact_set_edges_at(c, node); contact_edges_next(&e);) {
        const contact_candidate *edge = &c->list[e.k];
        const candidate_positions spot = candidate_place(edge, now->t, now->x);
        const contact_gap gap = candidate_gap(&c->scene, edge, &spot);
        if (gap.feature < 0 || fabs(gap.distance) > tolerance) continue;
        const vec2 at = surface_vertex_at(&c->scene, gap.feature, now->t), v = vec2_at(now->v, node);
        if (vec2_norm(vec2_sub(at, vec2_at(now->x, node))) > 2.0 * tolerance ||
            !surface_in_cone(&c->scene, gap.feature, now->t, gap.normal))
            continue;
        const double speed = -vec2_dot(contact_gap_velocity(&c->scene, edge, &gap, &spot, v), gap.normal);
        if (speed <= fastest) continue;
        fastest = speed;
        best = e.k;
        *vertex = gap.feature;
    }
    return best;
}
