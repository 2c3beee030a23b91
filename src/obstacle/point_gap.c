/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distance of a point to polylines, and the segments that it touches (docs/method.md, Gaps). In front of a
 * segment, to its left, the distance is positive. Nearest to a vertex, it has the sign of the side of the vertex's mean
 * normal. Queries take from a tree of boxes what may matter and judge it as a loop over all segments would: ties go to
 * the lowest index whatever the order of visits, so the tree changes no bit. Edges against vertices are in
 * vertex_gap.c. */
#include "obstacle/point_gap.h"

/* Mean normal, not of unit length, of the vertex that s shares with a neighbour; {0, 0} at a free end, which is in
 * front of its obstacle from all sides. */
static vec2 vertex_normal(const obstacle_set *o, const segment *s, dem_index neighbour)
{
    return neighbour < 0 ? (vec2){0.0, 0.0} : vec2_add(s->normal, o->segments[neighbour].normal);
}

/* Whether a place along the segment, m from its start, is on it. Free ends count as longer by `margin`, or by what of
 * them is buried. */
static bool on_segment(const segment *s, double place, double tolerance, double margin)
{
    const double before = s->before < 0 ? fmax(margin, s->buried[0]) : 0.0;
    const double after = s->after < 0 ? fmax(margin, s->buried[1]) : 0.0;
    return place >= -(tolerance + before) && place <= s->length + tolerance + after;
}

/* Whether a distance is smaller than the smallest so far; of equal distances the lower index wins. */
static bool nearer(double distance, dem_index k, const obstacle_gap *nearest)
{
    const double so_far = fabs(nearest->distance);
    return distance < so_far || (distance == so_far && k < nearest->segment);
}

/* Where the foot is on the segment, the distance is the height over it. Otherwise the nearest point is an end, with the
 * distance r = |x - end|, the sign of r.(mean normal), and the gradient r/distance as the normal. */
static void take_nearer(const obstacle_set *o, dem_index k, vec2 x, double margin, obstacle_gap *nearest)
{
    const segment *s = &o->segments[k];
    const double place = segment_place(s, x), height = segment_height(s, x);
    if (on_segment(s, place, 0.0, margin)) {
        if (nearer(fabs(height), k, nearest)) *nearest = (obstacle_gap){height, k, s->normal};
        return;
    }
    const vec2 from = vec2_sub(x, place < 0.0 ? s->start : s->end);
    const double distance = vec2_norm(from);
    if (!nearer(distance, k, nearest)) return;
    const vec2 mean = vertex_normal(o, s, place < 0.0 ? s->before : s->after);
    const double signed_distance = vec2_dot(mean, from) >= 0.0 ? distance : -distance;
    *nearest = (obstacle_gap){signed_distance, k, s->normal};
    if (distance > 0.0) nearest->normal = vec2_scale(1.0 / signed_distance, from);
}

/* Twice how far x is outside of an interval, 0 in it: m + |m| for m the larger of the two excesses. It has no branch,
 * since the processor could not predict which case comes next. */
static inline double outside_twice(double low, double high, double x)
{
    const double below = low - x, above = x - high, most = below > above ? below : above;
    return most + fabs(most);
}

/* Square of a distance below which nothing in the box is, even if it is longer by the margin. It is lowered by a bound
 * of the rounding errors. */
static inline double clearance(const box *b, vec2 x, double margin)
{
    const double dx = outside_twice(b->low.x - margin, b->high.x + margin, x.x),
                 dy = outside_twice(b->low.y - margin, b->high.y + margin, x.y);
    return 0.25 * (1.0 - BOX_TREE_ROUNDING) * (dx * dx + dy * dy);
}

/* Gap in the obstacle's own frame to all its segments but one (-1: none is left out): visits the nearer box first, and
 * passes over boxes that are further than the nearest segment found so far. */
static obstacle_gap gap_inside(const obstacle_set *o, vec2 x, double margin, dem_index obstacle, dem_index without)
{
    const box_tree *tree = &o->trees[obstacle];
    const double longer = (1.0 + BOX_TREE_ROUNDING) * margin;
    const dem_index first = o->first[obstacle];
    obstacle_gap nearest = {INFINITY, -1, {0.0, 0.0}};
    box_tree_walk walk;
    for (dem_index node = box_tree_start(&walk, INFINITY); node > 0;) {
        if (!box_tree_is_leaf(tree, node)) {
            const box *children = &tree->boxes[2 * node];
            node = box_tree_down(&walk, node, clearance(&children[0], x, longer), clearance(&children[1], x, longer));
            continue;
        }
        for (dem_index k = box_tree_first(tree, node); k < box_tree_first(tree, node + 1); k++)
            if (first + k != without) take_nearer(o, first + k, x, margin, &nearest);
        walk.limit = nearest.distance * nearest.distance;
        node = box_tree_back(&walk);
    }
    return nearest;
}

/* The point is taken to the obstacle's frame, and the normal is turned back. */
obstacle_gap obstacles_gap_of(const obstacle_set *o, double t, vec2 x, double margin, dem_index obstacle)
{
    if (!o->laws[obstacle].moves) return gap_inside(o, x, margin, obstacle, -1);
    const pose at = motion_law_pose(&o->laws[obstacle], t);
    obstacle_gap gap = gap_inside(o, pose_inside(&at, x), margin, obstacle, -1);
    gap.normal = pose_turn(&at, gap.normal);
    return gap;
}

/* The smallest signed distance: an obstacle that the point is inside of counts before one that is near. */
obstacle_gap obstacles_gap(const obstacle_set *o, double t, vec2 x, double margin, dem_index without,
                           dem_index without_too)
{
    obstacle_gap smallest = {INFINITY, -1, {0.0, 0.0}};
    for (dem_index k = 0; k < o->n; k++) {
        if (k == without || k == without_too) continue;
        const obstacle_gap gap = obstacles_gap_of(o, t, x, margin, k);
        if (gap.distance < smallest.distance) smallest = gap;
    }
    return smallest;
}

/* By how much the radius of a lone segment is smaller than what is computed for it, against rounding. */
static const double spare = 1e-3;

/* Within a radius r a height changes by r at most, as does the distance to another segment, but for the margin by
 * which a free end counts as longer. */
obstacle_lone_segment obstacles_lone_segment(const obstacle_set *o, vec2 x, double margin)
{
    if (o->n != 1 || o->laws[0].moves) return (obstacle_lone_segment){.radius = 0.0};
    const obstacle_gap gap = gap_inside(o, x, margin, 0, -1);
    if (gap.segment < 0) return (obstacle_lone_segment){.radius = 0.0};
    const segment *s = &o->segments[gap.segment];
    const double place = segment_place(s, x), room = fmin(place, s->length - place);
    const double other = fabs(gap_inside(o, x, margin, 0, gap.segment).distance);
    const double apart = 0.5 * (other - fabs(gap.distance)) - margin;
    return (obstacle_lone_segment){x, (1.0 - spare) * fmax(0.0, fmin(room, apart)), gap.segment};
}

/* Within the tolerance of the segment's line, and of the segment along it. */
static bool touches(const segment *s, vec2 x, const obstacle_touch *point)
{
    return fabs(segment_height(s, x)) <= point->tolerance &&
           on_segment(s, segment_place(s, x), point->tolerance, point->margin);
}

/* Candidates come in the order of segments; at most `capacity` of them are kept. */
int obstacles_touching(const obstacle_set *o, double t, vec2 x, const obstacle_touch *point, dem_index *hits,
                       int capacity)
{
    int n = 0;
    for (dem_index q = 0; q < o->n; q++) {
        const box_tree *tree = &o->trees[q];
        if (q == point->without) continue;
        const vec2 inside = obstacles_inside(o, q, t, x);
        const box around = box_around(inside, inside, 2.0 * point->tolerance + point->margin); /* along and across */
        for (dem_index k = -1; n < capacity && (k = box_tree_seek(tree, k + 1, &around)) < tree->n;)
            if (touches(&o->segments[o->first[q] + k], inside, point)) hits[n++] = o->first[q] + k;
    }
    return n;
}
