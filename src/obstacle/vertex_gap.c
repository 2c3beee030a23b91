/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of bodies against convex vertices of obstacles: which vertex is nearest to entering the body through an edge,
 * and how far an edge is from all of them (docs/method.md, Gaps). Distances are positive in front of the edge, outside
 * the body. Queries take from the tree of vertices what may matter and judge it as a loop over all would: the smallest
 * distance, and of equal ones the lowest index, so the tree changes no bit. Points against segments are in
 * point_gap.c. */
#include "obstacle/vertex_gap.h"

#include <float.h>

/* An edge with its directions: what is asked of every box and vertex. */
typedef struct line {
    const obstacle_edge *edge;
    vec2 tangent, normal;
    double length; /* m */
    bool moves;    /* whether it is in the frame of a moving obstacle, of whose vertices it is asked */
} line;

/* Whether a vertex is left out: by the caller, by its obstacle, or because it is in the tree of vertices at rest and
 * belongs to an obstacle that moves. */
static bool out_of_question(const obstacle_set *o, const line *l, dem_index k)
{
    const obstacle_edge *edge = l->edge;
    const dem_index obstacle = o->segments[o->vertices[k].before].obstacle;
    return k == edge->except[0] || k == edge->except[1] || obstacle == edge->without[0] ||
           obstacle == edge->without[1] || o->laws[obstacle].moves != l->moves;
}

/* Signed distance of x in front of the edge from p to q (body on the left, so in front is the right), if its foot is on
 * the edge; else -inf. */
static double distance_beside(vec2 p, vec2 q, vec2 x)
{
    const vec2 way = vec2_sub(q, p), from = vec2_sub(x, p);
    const double square = vec2_dot(way, way), along = vec2_dot(from, way);
    return along >= 0.0 && along <= square && square > 0.0 ? -vec2_cross(way, from) / sqrt(square) : -INFINITY;
}

/* Whether x, behind the edge by -distance, belongs to the neighbour from p to q round a convex corner of the body: it
 * is nearer to that, and outside the body in front of it, or inside with the obstacle's corner pointing against it. */
static bool belongs(vec2 p, vec2 q, vec2 x, vec2 mean, double distance)
{
    const double beside = distance_beside(p, q, x);
    return beside > distance && (beside >= 0.0 || vec2_cross(vec2_sub(q, p), mean) > 0.0);
}

/* The same for both neighbouring edges, where the body's boundary turns left (a convex corner). */
static bool round_corner(const obstacle_edge *edge, vec2 x, vec2 mean, double distance)
{
    const vec2 way = vec2_sub(edge->b, edge->a);
    const bool before = vec2_cross(vec2_sub(edge->a, edge->previous), way) > 0.0;
    const bool after = vec2_cross(way, vec2_sub(edge->next, edge->b)) > 0.0;
    return (before && belongs(edge->previous, edge->a, x, mean, distance)) ||
           (after && belongs(edge->b, edge->next, x, mean, distance));
}

/* Whether x, behind the edge with its foot beyond an end of it by `beyond` (< 0: before the start), is in a notch of
 * the body there: where the boundary turns right, and the foot is beyond that end of the neighbouring edge, too. */
static bool in_notch(const obstacle_edge *edge, vec2 x, double beyond)
{
    const vec2 way = vec2_sub(edge->b, edge->a), next = vec2_sub(edge->next, edge->b),
               previous = vec2_sub(edge->a, edge->previous);
    if (fabs(beyond) > edge->depth) return false;
    if (beyond > 0.0) return vec2_cross(way, next) < 0.0 && vec2_dot(next, vec2_sub(x, edge->b)) < 0.0;
    return vec2_cross(previous, way) < 0.0 && vec2_dot(previous, vec2_sub(x, edge->a)) > 0.0;
}

/* Takes vertex k if its distance is the smallest so far and the vertex counts: within `reach` and `depth`, with its
 * foot on the edge, its mean normal pointing into the body, and not round a corner. */
static void take_deeper(const obstacle_set *o, dem_index k, const line *l, obstacle_vertex_gap *deepest)
{
    const obstacle_edge *edge = l->edge;
    const obstacle_vertex *v = &o->vertices[k];
    const double distance = vec2_dot(vec2_sub(edge->a, v->at), l->normal);
    const double place = vec2_dot(vec2_sub(v->at, edge->a), l->tangent);
    if (!(distance > -edge->depth && distance < edge->reach)) return;
    const double beyond = place - fmin(fmax(place, 0.0), l->length);
    if (fabs(beyond) > edge->tolerance && !(distance < 0.0 && in_notch(edge, v->at, beyond))) return;
    if (distance > deepest->distance || (distance == deepest->distance && k > deepest->vertex)) return;
    const vec2 mean = vec2_add(o->segments[v->before].normal, o->segments[v->after].normal);
    if (!(vec2_dot(l->normal, mean) > 0.0) || out_of_question(o, l, k)) return;
    if (distance < 0.0 && round_corner(edge, v->at, mean, distance)) return;
    *deepest = (obstacle_vertex_gap){distance, k, fmin(fmax(place / l->length, 0.0), 1.0), l->normal};
}

/* A lower bound of the distance of vertices in the box, or infinity if none of them could be taken: centre and half
 * sizes are projected on the edge's directions, which makes an interval along and across the edge. */
static double shallowest(const box *b, const line *l)
{
    const obstacle_edge *edge = l->edge;
    const vec2 half = {0.5 * (b->high.x - b->low.x), 0.5 * (b->high.y - b->low.y)};
    const vec2 centre = vec2_sub((vec2){0.5 * (b->low.x + b->high.x), 0.5 * (b->low.y + b->high.y)}, edge->a);
    const double rounding = BOX_TREE_ROUNDING * (fabs(centre.x) + fabs(centre.y) + half.x + half.y);
    const double tx = fabs(l->tangent.x), ty = fabs(l->tangent.y);
    const double place = vec2_dot(centre, l->tangent), along = tx * half.x + ty * half.y + rounding;
    const double distance = -vec2_dot(centre, l->normal), across = ty * half.x + tx * half.y + rounding;
    const double longer = fmax(edge->tolerance, edge->depth);
    const bool beside = place + along < -longer || place - along > l->length + longer;
    return beside || distance + across < -edge->depth ? INFINITY : distance - across;
}

/* Unit vectors along the edge and to its left, into the body. */
static line line_along(const obstacle_edge *edge, bool moves)
{
    const vec2 way = vec2_sub(edge->b, edge->a);
    const double length = vec2_norm(way);
    const vec2 tangent = vec2_scale(1.0 / length, way);
    return (line){edge, tangent, {-tangent.y, tangent.x}, length, moves};
}

/* The edge in the frame of an obstacle. */
static obstacle_edge edge_inside(const obstacle_edge *edge, const pose *at)
{
    obstacle_edge inside = *edge;
    inside.a = pose_inside(at, edge->a);
    inside.b = pose_inside(at, edge->b);
    inside.previous = pose_inside(at, edge->previous);
    inside.next = pose_inside(at, edge->next);
    return inside;
}

/* Searches a tree for a vertex that is deeper than the deepest so far; its vertices are those from `first` on. The box
 * with the smaller bound comes first. */
static void look_deeper(const obstacle_set *o, const box_tree *tree, dem_index first, const line *l,
                        obstacle_vertex_gap *deepest)
{
    box_tree_walk walk;
    const double limit = deepest->vertex >= 0 ? deepest->distance : fmin(l->edge->reach, DBL_MAX);
    for (dem_index node = box_tree_start(&walk, limit); node > 0;) {
        if (!box_tree_is_leaf(tree, node)) {
            const box *children = &tree->boxes[2 * node];
            node = box_tree_down(&walk, node, shallowest(&children[0], l), shallowest(&children[1], l));
            continue;
        }
        for (dem_index k = box_tree_first(tree, node); k < box_tree_first(tree, node + 1); k++)
            take_deeper(o, first + k, l, deepest);
        if (deepest->vertex >= 0) walk.limit = deepest->distance;
        node = box_tree_back(&walk);
    }
}

/* The same for an obstacle that moves: the edge is taken to the obstacle's frame, where the tree is. The normal found
 * there is turned back. */
static void look_deeper_moving(const obstacle_set *o, dem_index obstacle, double t, const obstacle_edge *edge,
                               obstacle_vertex_gap *deepest)
{
    const pose at = motion_law_pose(&o->laws[obstacle], t);
    const obstacle_edge inside = edge_inside(edge, &at);
    const line l = line_along(&inside, true);
    const dem_index before = deepest->vertex;
    look_deeper(o, &o->vertex_trees[obstacle], o->first_vertex[obstacle], &l, deepest);
    if (deepest->vertex != before) deepest->normal = pose_turn(&at, deepest->normal);
}

/* Obstacles at rest come first, all at once. */
obstacle_vertex_gap obstacles_vertex_gap(const obstacle_set *o, double t, const obstacle_edge *edge)
{
    const line l = line_along(edge, false);
    obstacle_vertex_gap deepest = {INFINITY, -1, 0.0, l.normal};
    look_deeper(o, &o->vertex_tree, 0, &l, &deepest);
    for (dem_index k = 0; k < o->n && o->bounds.speed > 0.0; k++)
        if (o->laws[k].moves) look_deeper_moving(o, k, t, edge, &deepest);
    return deepest;
}

/* A distance from the edge below which nothing in the box is: the larger of the distances along and across the edge,
 * less rounding. */
static double apart_by(const box *b, const line *l)
{
    const vec2 half = {0.5 * (b->high.x - b->low.x), 0.5 * (b->high.y - b->low.y)};
    const vec2 centre = vec2_sub((vec2){0.5 * (b->low.x + b->high.x), 0.5 * (b->low.y + b->high.y)}, l->edge->a);
    const double rounding = BOX_TREE_ROUNDING * (fabs(centre.x) + fabs(centre.y) + half.x + half.y);
    const double tx = fabs(l->tangent.x), ty = fabs(l->tangent.y), place = vec2_dot(centre, l->tangent);
    const double beyond = fabs(place - 0.5 * l->length) - 0.5 * l->length - tx * half.x - ty * half.y;
    const double across = fabs(vec2_dot(centre, l->normal)) - ty * half.x - tx * half.y;
    return fmax(0.0, fmax(beyond, across) - rounding);
}

/* Distance of a vertex to the edge as a segment, m. */
static double distance_of(const obstacle_set *o, dem_index k, const line *l)
{
    const vec2 from = vec2_sub(o->vertices[k].at, l->edge->a);
    const double place = vec2_dot(from, l->tangent), beyond = place - fmin(fmax(place, 0.0), l->length);
    return out_of_question(o, l, k) ? INFINITY : hypot(beyond, vec2_dot(from, l->normal));
}

/* The distance of the nearest vertex of a tree, from `first` on, if it is below `nearest`; else `nearest`. */
static double look_nearer(const obstacle_set *o, const box_tree *tree, dem_index first, const line *l, double nearest)
{
    box_tree_walk walk;
    for (dem_index node = box_tree_start(&walk, nearest); node > 0;) {
        if (!box_tree_is_leaf(tree, node)) {
            const box *children = &tree->boxes[2 * node];
            node = box_tree_down(&walk, node, apart_by(&children[0], l), apart_by(&children[1], l));
            continue;
        }
        for (dem_index k = box_tree_first(tree, node); k < box_tree_first(tree, node + 1); k++)
            nearest = fmin(nearest, distance_of(o, first + k, l));
        walk.limit = nearest;
        node = box_tree_back(&walk);
    }
    return nearest;
}

/* `nearest` goes from tree to tree as the limit of the search, so that later trees are left early. */
double obstacles_clearance(const obstacle_set *o, double t, const obstacle_edge *edge)
{
    const line here = line_along(edge, false);
    double nearest = look_nearer(o, &o->vertex_tree, 0, &here, edge->reach);
    for (dem_index k = 0; k < o->n && o->bounds.speed > 0.0; k++) {
        if (!o->laws[k].moves) continue;
        const pose at = motion_law_pose(&o->laws[k], t);
        const obstacle_edge inside = edge_inside(edge, &at);
        const line l = line_along(&inside, true);
        nearest = look_nearer(o, &o->vertex_trees[k], o->first_vertex[k], &l, nearest);
    }
    return nearest;
}
