/* SPDX-License-Identifier: BSD-3-Clause */
/* Polylines compiled to segments with normals and neighbours. Queries take from a tree of boxes what may matter and
 * judge it as a loop over all would: ties go to the lowest index whatever the order of visits. */
#include "obstacle/obstacle.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"

static const double straight_below = 1e-9; /* sine of the bend */

static dem_status check_obstacle(const dem_obstacle *obstacle, dem_index o)
{
    CHECK(obstacle->n_points >= 2 && obstacle->points != NULL, DEM_ERROR_MODEL,
          "obstacle %lld has %lld points, at least 2 are needed", (long long)o, (long long)obstacle->n_points);
    CHECK(obstacle->restitution >= 0.0 && obstacle->restitution <= 1.0, DEM_ERROR_MODEL,
          "obstacle %lld: restitution must be in [0, 1], got %g", (long long)o, obstacle->restitution);
    CHECK(isfinite(obstacle->friction) && obstacle->friction >= 0.0, DEM_ERROR_MODEL,
          "obstacle %lld: friction must be >= 0, got %g", (long long)o, obstacle->friction);
    CHECK(obstacle->friction_law != DEM_FRICTION_PAPER || obstacle->friction <= 1.0, DEM_ERROR_MODEL,
          "obstacle %lld: friction of the paper's law must be in [0, 1], got %g", (long long)o, obstacle->friction);
    for (dem_index k = 0; k < 2 * obstacle->n_points; k++)
        CHECK(isfinite(obstacle->points[k]), DEM_ERROR_MODEL, "obstacle %lld: point %lld is not finite", (long long)o,
              (long long)(k / 2));
    for (dem_index k = 0; k + 1 < obstacle->n_points; k++) {
        const vec2 way = vec2_sub(vec2_at(obstacle->points, k + 1), vec2_at(obstacle->points, k));
        CHECK(isnormal(vec2_dot(way, way)), DEM_ERROR_MODEL, "obstacle %lld: segment %lld has length %g m",
              (long long)o, (long long)k, hypot(way.x, way.y));
    }
    return DEM_OK;
}

static bool closed(const dem_obstacle *obstacle)
{
    const vec2 first = vec2_at(obstacle->points, 0), last = vec2_at(obstacle->points, obstacle->n_points - 1);
    return obstacle->n_points > 3 && first.x == last.x && first.y == last.y;
}

static bool apart(double a, double b, double c, double d)
{
    return fmax(a, b) < fmin(c, d) || fmax(c, d) < fmin(a, b);
}

/* Whether segments ab and cd have a point in common. Of two far apart in one line rounding would say so. */
static bool meet(vec2 a, vec2 b, vec2 c, vec2 d)
{
    if (apart(a.x, b.x, c.x, d.x) || apart(a.y, b.y, c.y, d.y)) return false;
    const vec2 ab = vec2_sub(b, a), cd = vec2_sub(d, c), ac = vec2_sub(c, a);
    const double turn = vec2_cross(ab, cd), along = vec2_cross(ac, cd), across = vec2_cross(ac, ab);
    if (turn != 0.0) return along / turn >= 0.0 && along / turn <= 1.0 && across / turn >= 0.0 && across / turn <= 1.0;
    if (across != 0.0) return false; /* parallel lines */
    const double length = vec2_dot(ab, ab), u = vec2_dot(ac, ab), v = u + vec2_dot(cd, ab);
    return fmax(u, v) >= 0.0 && fmin(u, v) <= length;
}

static void compile_segments(obstacle_set *set, dem_index o)
{
    const dem_obstacle *obstacle = &set->list[o];
    const dem_index n = obstacle->n_points - 1, first = set->first[o];
    const bool ring = closed(obstacle);
    segment *s = set->segments;
    set->first[o + 1] = first + n;
    for (dem_index k = 0; k < n; k++) {
        const vec2 a = vec2_at(obstacle->points, k), b = vec2_at(obstacle->points, k + 1), d = vec2_sub(b, a);
        const double length = vec2_norm(d);
        const vec2 t = vec2_scale(1.0 / length, d);
        s[first + k] = (segment){.start = a,
                                 .end = b,
                                 .tangent = t,
                                 .normal = {-t.y, t.x},
                                 .length = length,
                                 .restitution = obstacle->restitution,
                                 .obstacle = o,
                                 .index = k,
                                 .before = k > 0 ? first + k - 1 : (ring ? first + n - 1 : -1),
                                 .after = k + 1 < n ? first + k + 1 : (ring ? first : -1)};
    }
}

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

/* All that counts as the segment, but for a margin. */
static box cover(const segment *s)
{
    return box_around(vec2_along(s->start, -s->buried[0], s->tangent), vec2_along(s->end, s->buried[1], s->tangent),
                      0.0);
}

static dem_status plant_tree(obstacle_set *set, dem_index o)
{
    const dem_index n = set->list[o].n_points - 1;
    TRY(box_tree_create(&set->trees[o], n));
    for (dem_index k = 0; k < n; k++) {
        const box around = cover(&set->segments[set->first[o] + k]);
        box_tree_cover(&set->trees[o], k, &around);
    }
    return DEM_OK;
}

static bool goes_back(const segment *s, const segment *next)
{
    const vec2 here = vec2_sub(s->end, s->start), there = vec2_sub(next->end, next->start);
    return vec2_cross(here, there) == 0.0 && vec2_dot(here, there) < 0.0;
}

/* Segments of one polyline have at most the vertex of neighbours in common: else what is inside is not told.
 * \param[out] pair  two that have more; the second follows the first if it goes back over it */
static bool find_crossing(dem_index pair[2], const obstacle_set *set, dem_index o)
{
    const segment *s = &set->segments[set->first[o]];
    const box_tree *tree = &set->trees[o];
    for (dem_index i = 0; i < tree->n; i++) {
        const box around = cover(&s[i]);
        const dem_index end = i == 0 && s[0].before >= 0 ? tree->n - 1 : tree->n;
        pair[0] = i;
        pair[1] = s[i].after - set->first[o];
        if (s[i].after >= 0 && goes_back(&s[i], &s[pair[1]])) return true;
        for (dem_index k = box_tree_seek(tree, i + 2, &around); k < end; k = box_tree_seek(tree, k + 1, &around)) {
            pair[1] = k;
            if (meet(s[i].start, s[i].end, s[k].start, s[k].end)) return true;
        }
    }
    return false;
}

static dem_status check_crossings(const obstacle_set *set, dem_index o)
{
    dem_index pair[2];
    if (!find_crossing(pair, set, o)) return DEM_OK;
    const bool follows = set->segments[set->first[o] + pair[0]].after == set->first[o] + pair[1];
    return status_fail(DEM_ERROR_MODEL,
                       follows ? "obstacle %lld: segment %lld goes back over segment %lld"
                               : "obstacle %lld: segments %lld and %lld meet",
                       (long long)o, (long long)pair[follows], (long long)pair[!follows]);
}

/* Mean normal of the vertex where the segment ends or starts, not of unit length; {0, 0} at a free end. */
static vec2 vertex_normal(const obstacle_set *o, const segment *s, dem_index neighbour)
{
    return neighbour < 0 ? (vec2){0.0, 0.0} : vec2_add(s->normal, o->segments[neighbour].normal);
}

/* Whether a place along the segment is on it, free ends being longer by `margin`, or by what of it is buried. */
static bool on_segment(const segment *s, double place, double tolerance, double margin)
{
    const double before = s->before < 0 ? fmax(margin, s->buried[0]) : 0.0;
    const double after = s->after < 0 ? fmax(margin, s->buried[1]) : 0.0;
    return place >= -(tolerance + before) && place <= s->length + tolerance + after;
}

/* Whether what is at this distance is nearer than what was nearest so far. */
static bool nearer(double distance, dem_index k, const obstacle_gap *nearest)
{
    const double so_far = fabs(nearest->distance);
    return distance < so_far || (distance == so_far && k < nearest->segment);
}

/* Takes segment k for the nearest if it is. */
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

/* Twice how far x is outside an interval, 0 in it: without a branch, which would be a coin's throw. */
static inline double outside_twice(double low, double high, double x)
{
    const double below = low - x, above = x - high, most = below > above ? below : above;
    return most + fabs(most);
}

/* Square of a distance below which nothing in the box is, even if it is longer by the margin. */
static inline double clearance(const box *b, vec2 x, double margin)
{
    const double dx = outside_twice(b->low.x - margin, b->high.x + margin, x.x),
                 dy = outside_twice(b->low.y - margin, b->high.y + margin, x.y);
    return 0.25 * (1.0 - BOX_TREE_ROUNDING) * (dx * dx + dy * dy);
}

obstacle_gap obstacles_gap_of(const obstacle_set *o, vec2 x, double margin, dem_index obstacle)
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
            take_nearer(o, first + k, x, margin, &nearest);
        walk.limit = nearest.distance * nearest.distance;
        node = box_tree_back(&walk);
    }
    return nearest;
}

obstacle_gap obstacles_gap(const obstacle_set *o, vec2 x, double margin, dem_index without, dem_index without_too)
{
    obstacle_gap smallest = {INFINITY, -1, {0.0, 0.0}};
    for (dem_index k = 0; k < o->n; k++) {
        if (k == without || k == without_too) continue;
        const obstacle_gap gap = obstacles_gap_of(o, x, margin, k);
        if (gap.distance < smallest.distance) smallest = gap;
    }
    return smallest;
}

/* Whether the end meets the free end of another obstacle's segment, behind which it would go on: the length of that. */
static double behind_free_end(const obstacle_set *o, const segment *s, vec2 end, vec2 out)
{
    double length = 0.0;
    for (dem_index k = 0; k < o->n_segments; k++) {
        const segment *b = &o->segments[k];
        if (b->obstacle == s->obstacle || vec2_dot(out, b->normal) >= 0.0) continue;
        const double start = b->before < 0 ? vec2_norm(vec2_sub(b->start, end)) : INFINITY;
        const double stop = b->after < 0 ? vec2_norm(vec2_sub(b->end, end)) : INFINITY;
        if (fmin(start, stop) <= 1e-6 * s->length) length = fmax(length, b->length);
    }
    return length;
}

/* A wall that stands on another obstacle, or meets its free end in a corner, goes on behind it, so that nothing slips
 * through the joint: how far, m, up to its own length. */
static double buried_length(const obstacle_set *o, const segment *s, vec2 end, vec2 out)
{
    const double touching = 1e-6 * s->length;
    if (obstacles_gap(o, end, 0.0, s->obstacle, -1).distance > touching) return 0.0;
    for (double length = s->length; length > touching; length *= 0.5)
        if (obstacles_gap(o, vec2_along(end, length, out), 0.0, s->obstacle, -1).distance < 0.0) return length;
    return fmin(s->length, behind_free_end(o, s, end, out));
}

static void bury_ends(obstacle_set *o)
{
    for (dem_index k = 0; k < o->n_segments && o->n > 1; k++) {
        const segment *s = &o->segments[k];
        const double before = s->before < 0 ? buried_length(o, s, s->start, vec2_scale(-1.0, s->tangent)) : 0.0;
        const double after = s->after < 0 ? buried_length(o, s, s->end, s->tangent) : 0.0;
        o->segments[k].buried[0] = before;
        o->segments[k].buried[1] = after;
        const box around = cover(s);
        box_tree_cover(&o->trees[s->obstacle], s->index, &around);
    }
}

static bool touches(const segment *s, vec2 x, const obstacle_touch *point)
{
    return fabs(segment_height(s, x)) <= point->tolerance &&
           on_segment(s, segment_place(s, x), point->tolerance, point->margin);
}

int obstacles_touching(const obstacle_set *o, vec2 x, const obstacle_touch *point, dem_index *hits, int capacity)
{
    const box around = box_around(x, x, 2.0 * point->tolerance + point->margin); /* tolerance along and across */
    int n = 0;
    for (dem_index q = 0; q < o->n; q++) {
        const box_tree *tree = &o->trees[q];
        if (q == point->without) continue;
        for (dem_index k = -1; n < capacity && (k = box_tree_seek(tree, k + 1, &around)) < tree->n;)
            if (touches(&o->segments[o->first[q] + k], x, point)) hits[n++] = o->first[q] + k;
    }
    return n;
}

bool obstacles_share(const obstacle_set *o, dem_index s, dem_index other, vec2 *vertex)
{
    const bool ends = o->segments[s].after == other, starts = o->segments[s].before == other;
    *vertex = ends ? o->segments[s].end : o->segments[s].start;
    return ends || starts;
}

obstacle_bend obstacles_bend(const obstacle_set *o, dem_index s, bool backwards, dem_index *beyond)
{
    const segment *here = &o->segments[s];
    *beyond = backwards ? here->before : here->after;
    if (*beyond < 0) return OBSTACLE_FREE_END;
    const segment *there = &o->segments[*beyond];
    const double turn =
        backwards ? vec2_cross(there->tangent, here->tangent) : vec2_cross(here->tangent, there->tangent);
    const double along = vec2_dot(here->tangent, there->tangent);
    if (fabs(turn) < straight_below && along > 0.0) return OBSTACLE_STRAIGHT;
    return turn < 0.0 ? OBSTACLE_CONVEX : OBSTACLE_CONCAVE;
}

/* ---- vertices ---- */

/* At most as many as segments. */
static dem_status find_vertices(obstacle_set *o)
{
    o->vertices = malloc(((size_t)o->n_segments + 1) * sizeof *o->vertices);
    CHECK_MEMORY(o->vertices);
    for (dem_index k = 0; k < o->n_segments; k++) {
        dem_index after;
        if (obstacles_bend(o, k, false, &after) == OBSTACLE_CONVEX)
            o->vertices[o->n_vertices++] = (obstacle_vertex){o->segments[k].end, k, after};
    }
    TRY(box_tree_create(&o->vertex_tree, o->n_vertices));
    for (dem_index k = 0; k < o->n_vertices; k++) {
        const box around = box_around(o->vertices[k].at, o->vertices[k].at, 0.0);
        box_tree_cover(&o->vertex_tree, k, &around);
    }
    return DEM_OK;
}

/* An edge with its directions: what is asked of every box and vertex. */
typedef struct line {
    const obstacle_edge *edge;
    vec2 tangent, normal;
    double length; /* m */
} line;

static bool out_of_question(const obstacle_set *o, const obstacle_edge *edge, dem_index k)
{
    const dem_index obstacle = o->segments[o->vertices[k].before].obstacle;
    return k == edge->except[0] || k == edge->except[1] || obstacle == edge->without[0] || obstacle == edge->without[1];
}

/* Signed distance of x in front of the edge from p to q, if its foot is on it; else -infinity. */
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

static bool round_corner(const obstacle_edge *edge, vec2 x, vec2 mean, double distance)
{
    const vec2 way = vec2_sub(edge->b, edge->a);
    const bool before = vec2_cross(vec2_sub(edge->a, edge->previous), way) > 0.0;
    const bool after = vec2_cross(way, vec2_sub(edge->next, edge->b)) > 0.0;
    return (before && belongs(edge->previous, edge->a, x, mean, distance)) ||
           (after && belongs(edge->b, edge->next, x, mean, distance));
}

/* Whether x, behind the edge with its foot beyond an end of it, is in a notch of the body there: where the boundary
 * turns in, and its foot is beyond that end of the neighbour, too. */
static bool in_notch(const obstacle_edge *edge, vec2 x, double beyond)
{
    const vec2 way = vec2_sub(edge->b, edge->a), next = vec2_sub(edge->next, edge->b),
               previous = vec2_sub(edge->a, edge->previous);
    if (fabs(beyond) > edge->depth) return false;
    if (beyond > 0.0) return vec2_cross(way, next) < 0.0 && vec2_dot(next, vec2_sub(x, edge->b)) < 0.0;
    return vec2_cross(previous, way) < 0.0 && vec2_dot(previous, vec2_sub(x, edge->a)) > 0.0;
}

/* Takes vertex k if it is deeper than the deepest so far. */
static void take_deeper(const obstacle_set *o, dem_index k, const line *l, obstacle_poke *deepest)
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
    if (!(vec2_dot(l->normal, mean) > 0.0) || out_of_question(o, edge, k)) return;
    if (distance < 0.0 && round_corner(edge, v->at, mean, distance)) return;
    *deepest = (obstacle_poke){distance, k, fmin(fmax(place / l->length, 0.0), 1.0), l->normal};
}

/* A distance below which no vertex in the box is that could be taken; infinity if none could. */
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

static line line_along(const obstacle_edge *edge)
{
    const vec2 way = vec2_sub(edge->b, edge->a);
    const double length = vec2_norm(way);
    const vec2 tangent = vec2_scale(1.0 / length, way);
    return (line){edge, tangent, {-tangent.y, tangent.x}, length};
}

obstacle_poke obstacles_poke(const obstacle_set *o, const obstacle_edge *edge)
{
    const box_tree *tree = &o->vertex_tree;
    const line l = line_along(edge);
    obstacle_poke deepest = {INFINITY, -1, 0.0, l.normal};
    box_tree_walk walk;
    for (dem_index node = box_tree_start(&walk, fmin(edge->reach, DBL_MAX)); node > 0;) {
        if (!box_tree_is_leaf(tree, node)) {
            const box *children = &tree->boxes[2 * node];
            node = box_tree_down(&walk, node, shallowest(&children[0], &l), shallowest(&children[1], &l));
            continue;
        }
        for (dem_index k = box_tree_first(tree, node); k < box_tree_first(tree, node + 1); k++)
            take_deeper(o, k, &l, &deepest);
        if (deepest.vertex >= 0) walk.limit = deepest.distance;
        node = box_tree_back(&walk);
    }
    return deepest;
}

/* A distance from the edge below which nothing in the box is. */
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

static double distance_of(const obstacle_set *o, dem_index k, const line *l)
{
    const vec2 from = vec2_sub(o->vertices[k].at, l->edge->a);
    const double place = vec2_dot(from, l->tangent), beyond = place - fmin(fmax(place, 0.0), l->length);
    return out_of_question(o, l->edge, k) ? INFINITY : hypot(beyond, vec2_dot(from, l->normal));
}

double obstacles_clearance(const obstacle_set *o, const obstacle_edge *edge)
{
    const box_tree *tree = &o->vertex_tree;
    const line l = line_along(edge);
    box_tree_walk walk;
    double nearest = edge->reach;
    for (dem_index node = box_tree_start(&walk, nearest); node > 0;) {
        if (!box_tree_is_leaf(tree, node)) {
            const box *children = &tree->boxes[2 * node];
            node = box_tree_down(&walk, node, apart_by(&children[0], &l), apart_by(&children[1], &l));
            continue;
        }
        for (dem_index k = box_tree_first(tree, node); k < box_tree_first(tree, node + 1); k++)
            nearest = fmin(nearest, distance_of(o, k, &l));
        walk.limit = nearest;
        node = box_tree_back(&walk);
    }
    return nearest;
}

/* ---- compiling ---- */

static dem_status reserve(obstacle_set *o, dem_index n)
{
    o->list = calloc((size_t)n + 1, sizeof *o->list);
    o->segments = malloc(((size_t)o->n_segments + 1) * sizeof *o->segments);
    o->first = calloc((size_t)n + 1, sizeof *o->first);
    o->trees = calloc((size_t)n + 1, sizeof *o->trees);
    CHECK(o->list && o->segments && o->first && o->trees, DEM_ERROR_MEMORY, "out of memory for obstacles");
    return DEM_OK;
}

static dem_status append(obstacle_set *set, const dem_obstacle *obstacle)
{
    const dem_index o = set->n;
    TRY(copy_points(&set->list[o], obstacle));
    set->n++;
    compile_segments(set, o);
    return plant_tree(set, o);
}

/* All but what obstacles are to each other. */
static dem_status compile_all(obstacle_set *o, const dem_obstacle *list, dem_index n)
{
    for (dem_index k = 0; k < n; k++) {
        TRY(check_obstacle(&list[k], k));
        o->n_segments += list[k].n_points - 1;
    }
    TRY(reserve(o, n));
    for (dem_index k = 0; k < n; k++) TRY(append(o, &list[k]));
    return DEM_OK;
}

dem_status obstacles_compile(obstacle_set *out, const dem_obstacle *list, dem_index n)
{
    obstacle_set o = {0};
    dem_status status = compile_all(&o, list, n);
    for (dem_index k = 0; k < n && status == DEM_OK; k++) status = check_crossings(&o, k);
    if (status == DEM_OK) status = find_vertices(&o);
    if (status == DEM_OK) bury_ends(&o);
    if (status == DEM_OK)
        *out = o;
    else
        obstacles_free(&o);
    return status;
}

dem_status dem_obstacle_check(const dem_obstacle *obstacle, dem_index segments[2])
{
    obstacle_set o = {0};
    CHECK(obstacle != NULL && segments != NULL, DEM_ERROR_ARGUMENT, "dem_obstacle_check: %s is NULL",
          obstacle ? "segments" : "obstacle");
    segments[0] = segments[1] = -1;
    dem_status status = compile_all(&o, obstacle, 1);
    if (status == DEM_OK) status = check_crossings(&o, 0);
    if (status == DEM_ERROR_MODEL && o.n == 1) (void)find_crossing(segments, &o, 0);
    obstacles_free(&o);
    return status;
}

void obstacles_free(obstacle_set *o)
{
    for (dem_index k = 0; k < o->n; k++) {
        free((void *)(uintptr_t)o->list[k].points);
        box_tree_free(&o->trees[k]);
    }
    free(o->list);
    free(o->segments);
    free(o->first);
    free(o->trees);
    free(o->vertices);
    box_tree_free(&o->vertex_tree);
    *o = (obstacle_set){0};
}
