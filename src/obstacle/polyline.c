/* SPDX-License-Identifier: BSD-3-Clause */
/* A single obstacle: which polylines are valid, and its segments. A polyline that meets itself is refused, since it
 * would not be known what is inside. Bodies are on the left of each segment, where its normal points. Several
 * obstacles, and what they are to each other, are in obstacle_set.c. */
#include "obstacle/polyline.h"

#include "base/status.h"

/* The squared length of a segment must be a normal number: lengths are divided by, and a subnormal one has lost
 * digits. */
dem_status polyline_check(const dem_obstacle *obstacle, dem_index o)
{
    CHECK(obstacle->n_points >= 2 && obstacle->points != NULL, DEM_ERROR_MODEL,
          "obstacle %lld has %lld points, at least 2 are needed", (long long)o, (long long)obstacle->n_points);
    CHECK(obstacle->restitution >= 0.0 && obstacle->restitution <= 1.0, DEM_ERROR_MODEL,
          "obstacle %lld: restitution must be in [0, 1], got %g", (long long)o, obstacle->restitution);
    CHECK(isfinite(obstacle->friction) && obstacle->friction >= 0.0, DEM_ERROR_MODEL,
          "obstacle %lld: friction must be >= 0, got %g", (long long)o, obstacle->friction);
    CHECK(obstacle->friction_law != DEM_FRICTION_PAPER || obstacle->friction <= 1.0, DEM_ERROR_MODEL,
          "obstacle %lld: friction of the paper's law must be in [0, 1], got %g", (long long)o, obstacle->friction);
    TRY(motion_law_check(obstacle, o));
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

/* A ring has its first point again as the last one; three points of a ring would go forth and back. */
static bool closed(const dem_obstacle *obstacle)
{
    const vec2 first = vec2_at(obstacle->points, 0), last = vec2_at(obstacle->points, obstacle->n_points - 1);
    return obstacle->n_points > 3 && first.x == last.x && first.y == last.y;
}

/* The normal is the tangent turned counter-clockwise by 90 degrees. */
void polyline_compile(obstacle_set *set, dem_index o)
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
                                 .obstacle = o,
                                 .index = k,
                                 .before = k > 0 ? first + k - 1 : (ring ? first + n - 1 : -1),
                                 .after = k + 1 < n ? first + k + 1 : (ring ? first : -1)};
    }
}

/* Whether two intervals, each given by its ends in any order, have no point in common. */
static bool apart(double a, double b, double c, double d)
{
    return fmax(a, b) < fmin(c, d) || fmax(c, d) < fmin(a, b);
}

/* Whether segments ab and cd have a point in common. With p = a + u ab = c + v cd the parameters are
 *     u = (ac x cd)/(ab x cd),   v = (ac x ab)/(ab x cd).
 * Bounding intervals are compared first: for distant collinear segments the cross products round to a false hit.
 * Segments in one line meet if their intervals along it do. */
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

/* Whether the next segment goes back over this one: parallel and opposite. */
static bool goes_back(const segment *s, const segment *next)
{
    const vec2 here = vec2_sub(s->end, s->start), there = vec2_sub(next->end, next->start);
    return vec2_cross(here, there) == 0.0 && vec2_dot(here, there) < 0.0;
}

/* Neighbours are compared by goes_back() only, since they share a vertex: pairs begin at i + 2, and in a ring the first
 * and the last segment are neighbours as well. */
bool polyline_find_crossing(dem_index pair[2], const obstacle_set *set, dem_index o)
{
    const segment *s = &set->segments[set->first[o]];
    const box_tree *tree = &set->trees[o];
    for (dem_index i = 0; i < tree->n; i++) {
        const box around = segment_cover(&s[i]);
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

/* Names the two segments, the later one first if it goes back over the other. */
dem_status polyline_check_crossings(const obstacle_set *set, dem_index o)
{
    dem_index pair[2];
    if (!polyline_find_crossing(pair, set, o)) return DEM_OK;
    const bool follows = set->segments[set->first[o] + pair[0]].after == set->first[o] + pair[1];
    return status_fail(DEM_ERROR_MODEL,
                       follows ? "obstacle %lld: segment %lld goes back over segment %lld"
                               : "obstacle %lld: segments %lld and %lld meet",
                       (long long)o, (long long)pair[follows], (long long)pair[!follows]);
}
