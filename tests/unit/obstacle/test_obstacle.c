/* SPDX-License-Identifier: BSD-3-Clause */
/* obstacle.c: compiling polylines, signed gap and its normal, what a point touches, bends. Tolerances of 1e-15 to
 * 1e-13 are the rounding of coordinates of order 1 m. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>

#include "obstacle/obstacle.h"

/* A polyline with a free end at (-2, 0), a convex vertex at (0, 0), a concave one at (1, -1) and a free end at (3,
 * -1). */
static const double valley[8] = {-2.0, 0.0, 0.0, 0.0, 1.0, -1.0, 3.0, -1.0};

/* A block standing on y = 0, clockwise: its inside is on the right. */
static const double block[10] = {5.0, 0.0, 5.0, 1.0, 6.0, 1.0, 6.0, 0.0, 5.0, 0.0};

static obstacle_set compile(const double *points, dem_index n_points, double restitution)
{
    const dem_obstacle obstacle = {.n_points = n_points, .points = points, .restitution = restitution};
    obstacle_set o;
    assert_ok(obstacles_compile(&o, &obstacle, 1));
    return o;
}

static obstacle_set compile_both(void)
{
    const dem_obstacle list[2] = {{.n_points = 4, .points = valley, .restitution = 0.25},
                                  {.n_points = 5, .points = block, .restitution = 0.5}};
    obstacle_set o;
    assert_ok(obstacles_compile(&o, list, 2));
    return o;
}

static obstacle_gap gap_at(const obstacle_set *o, double x, double y)
{
    return obstacles_gap(o, (vec2){x, y}, 0.0, -1, -1);
}

/* ---- compiling ---- */

static void refuse(const dem_obstacle *list, dem_index n, const char *message)
{
    obstacle_set o = {.n = 77};
    assert_int_equal(obstacles_compile(&o, list, n), DEM_ERROR_MODEL);
    assert_string_equal(dem_status_message(), message);
    assert_int_equal(o.n, 77);
}

static void an_obstacle_of_one_point_or_none_is_refused(void **state)
{
    const dem_obstacle list[2] = {{.n_points = 4, .points = valley, .restitution = 0.0},
                                  {.n_points = 1, .points = valley, .restitution = 0.0}},
                       none = {.n_points = 2, .points = NULL, .restitution = 0.0};
    (void)state;
    refuse(list, 2, "obstacle 1 has 1 points, at least 2 are needed");
    refuse(&none, 1, "obstacle 0 has 2 points, at least 2 are needed");
}

static void restitution_must_lie_between_0_and_1(void **state)
{
    const dem_obstacle above = {.n_points = 4, .points = valley, .restitution = 1.5},
                       below = {.n_points = 4, .points = valley, .restitution = -0.25},
                       nan = {.n_points = 4, .points = valley, .restitution = fabs((double)NAN)};
    (void)state;
    refuse(&above, 1, "obstacle 0: restitution must be in [0, 1], got 1.5");
    refuse(&below, 1, "obstacle 0: restitution must be in [0, 1], got -0.25");
    refuse(&nan, 1, "obstacle 0: restitution must be in [0, 1], got nan");
}

static void a_point_that_is_not_finite_is_named(void **state)
{
    const double infinite[6] = {0.0, 0.0, 1.0, 0.0, 2.0, (double)INFINITY}, nan[4] = {0.0, 0.0, (double)NAN, 0.0};
    const dem_obstacle first = {.n_points = 3, .points = infinite, .restitution = 0.0},
                       second = {.n_points = 2, .points = nan, .restitution = 0.0};
    (void)state;
    refuse(&first, 1, "obstacle 0: point 2 is not finite");
    refuse(&second, 1, "obstacle 0: point 1 is not finite");
}

static void a_segment_without_length_is_named(void **state)
{
    const double twice[6] = {0.0, 0.0, 1.0, 0.0, 1.0, 0.0}, far[4] = {-1e308, 0.0, 1e308, 0.0},
                 near[4] = {0.0, 0.0, 0.0, 1e-160}; /* its square has lost its digits */
    const dem_obstacle list[2] = {{.n_points = 4, .points = valley, .restitution = 0.0},
                                  {.n_points = 3, .points = twice, .restitution = 0.0}},
                       wide = {.n_points = 2, .points = far, .restitution = 0.0},
                       narrow = {.n_points = 2, .points = near, .restitution = 0.0};
    (void)state;
    refuse(list, 2, "obstacle 1: segment 1 has length 0 m");
    refuse(&wide, 1, "obstacle 0: segment 0 has length inf m");
    refuse(&narrow, 1, "obstacle 0: segment 0 has length 1e-160 m");
}

static void segments_are_numbered_obstacle_by_obstacle(void **state)
{
    static const dem_index obstacle[7] = {0, 0, 0, 1, 1, 1, 1}, index[7] = {0, 1, 2, 0, 1, 2, 3};
    static const dem_index before[7] = {-1, 0, 1, 6, 3, 4, 5}, after[7] = {1, 2, -1, 4, 5, 6, 3};
    (void)state;
    obstacle_set o = compile_both();
    assert_int_equal(o.n, 2);
    assert_int_equal(o.n_segments, 7);
    for (int k = 0; k < 7; k++) {
        const segment *s = &o.segments[k];
        assert_int_equal(s->obstacle, obstacle[k]);
        assert_int_equal(s->index, index[k]);
        assert_int_equal(s->before, before[k]);
        assert_int_equal(s->after, after[k]);
        assert_close(s->restitution, obstacle[k] == 0 ? 0.25 : 0.5, 0.0);
        assert_close(vec2_norm(vec2_sub(s->end, s->start)), s->length, 1e-15);
        assert_close(vec2_dot(vec2_sub(s->end, s->start), s->tangent), s->length, 1e-15);
        assert_close(vec2_cross(s->tangent, s->normal), 1.0, 1e-15); /* out of the solid is to the left */
        assert_close(vec2_dot(s->tangent, s->normal), 0.0, 0.0);
    }
    assert_close(o.segments[1].normal.x, sqrt(0.5), 1e-15);
    assert_close(o.segments[1].normal.y, sqrt(0.5), 1e-15);
    obstacles_free(&o);
    assert_null(o.segments);
}

static void the_set_keeps_copies_of_the_points(void **state)
{
    double points[4] = {0.0, 0.0, 1.0, 0.0};
    (void)state;
    obstacle_set o = compile(points, 2, 0.0);
    points[1] = points[3] = 100.0;
    assert_close(o.list[0].points[1], 0.0, 0.0);
    assert_close(gap_at(&o, 0.5, 1.0).distance, 1.0, 0.0);
    obstacles_free(&o);
}

/* ---- gap ---- */

static void check_gap(const obstacle_set *o, double x, double y, double distance, dem_index nearest, double nx,
                      double ny)
{
    const obstacle_gap gap = gap_at(o, x, y);
    assert_close(gap.distance, distance, 1e-15);
    assert_int_equal(gap.segment, nearest);
    assert_close(gap.normal.x, nx, 1e-14);
    assert_close(gap.normal.y, ny, 1e-14);
}

static void the_gap_counts_from_the_nearest_segment_and_is_negative_behind_it(void **state)
{
    const double r = sqrt(0.5);
    (void)state;
    obstacle_set o = compile(valley, 4, 0.0);
    check_gap(&o, -1.0, 0.3, 0.3, 0, 0.0, 1.0);
    check_gap(&o, -1.0, -0.3, -0.3, 0, 0.0, 1.0);
    check_gap(&o, -1.0, 0.0, 0.0, 0, 0.0, 1.0);
    check_gap(&o, 0.5 + 0.2, -0.5 + 0.2, 0.2 / r, 1, r, r);
    check_gap(&o, 0.5 - 0.2, -0.5 - 0.2, -0.2 / r, 1, r, r);
    check_gap(&o, 2.0, -1.5, -0.5, 2, 0.0, 1.0);
    obstacles_free(&o);
}

/* Off the convex vertex (0, 0) the nearest point is the vertex, in front; behind the concave one (1, -1) likewise,
 * inside. */
static void at_a_vertex_the_distance_is_to_the_vertex(void **state)
{
    (void)state;
    obstacle_set o = compile(valley, 4, 0.0);
    obstacle_gap gap = gap_at(&o, 0.3, 0.4);
    assert_close(gap.distance, 0.5, 1e-15);
    assert_close(gap.normal.x, 0.6, 1e-15);
    assert_close(gap.normal.y, 0.8, 1e-15);
    gap = gap_at(&o, 1.0 - 0.3, -1.0 - 0.4);
    assert_close(gap.distance, -0.5, 1e-15);
    assert_close(gap.normal.x, 0.6, 1e-14);
    assert_close(gap.normal.y, 0.8, 1e-14);
    obstacles_free(&o);
}

static void round_a_free_end_every_point_is_in_front(void **state)
{
    (void)state;
    obstacle_set o = compile(valley, 4, 0.0);
    check_gap(&o, -2.3, 0.4, 0.5, 0, -0.6, 0.8);
    check_gap(&o, -2.3, -0.4, 0.5, 0, -0.6, -0.8);
    check_gap(&o, 3.4, -1.3, 0.5, 2, 0.8, -0.6);
    check_gap(&o, 3.0 - 1e-9, -1.3, -0.3, 2, 0.0, 1.0);
    obstacles_free(&o);
}

static void on_the_vertex_itself_the_gap_is_zero_and_the_normal_that_of_a_segment(void **state)
{
    (void)state;
    obstacle_set o = compile(valley, 4, 0.0);
    check_gap(&o, 0.0, 0.0, 0.0, 0, 0.0, 1.0);
    obstacles_free(&o);
}

static void a_ring_is_solid_inside_when_it_runs_clockwise_and_a_vessel_otherwise(void **state)
{
    double vessel[10];
    (void)state;
    obstacle_set o = compile(block, 5, 0.0);
    check_gap(&o, 5.5, 0.9, -0.1, 1, 0.0, 1.0);
    check_gap(&o, 5.1, 0.5, -0.1, 0, -1.0, 0.0);
    check_gap(&o, 5.5, -0.5, 0.5, 3, 0.0, -1.0);
    assert_close(gap_at(&o, 4.7, -0.4).distance, 0.5, 1e-15); /* the corner where the ring closes */
    obstacles_free(&o);
    for (int k = 0; k < 5; k++) {
        vessel[2 * k] = block[2 * (4 - k)];
        vessel[2 * k + 1] = block[2 * (4 - k) + 1];
    }
    o = compile(vessel, 5, 0.0);
    check_gap(&o, 5.5, 0.9, 0.1, 2, 0.0, -1.0);
    assert_close(gap_at(&o, 4.7, -0.4).distance, -0.5, 1e-15);
    obstacles_free(&o);
}

static void without_obstacles_the_gap_is_infinite(void **state)
{
    obstacle_set o;
    (void)state;
    assert_ok(obstacles_compile(&o, NULL, 0));
    const obstacle_gap gap = gap_at(&o, 1.0, 2.0);
    assert_true(gap.distance == (double)INFINITY);
    assert_int_equal(gap.segment, -1);
    obstacles_free(&o);
}

static void obstacles_can_be_left_out_or_asked_alone(void **state)
{
    const vec2 x = {4.5, -0.25}; /* 0.56 m from the block's corner, 1.68 m from the valley's end */
    (void)state;
    obstacle_set o = compile_both();
    assert_int_equal(obstacles_gap(&o, x, 0.0, -1, -1).segment, 3);
    assert_int_equal(obstacles_gap(&o, x, 0.0, 1, -1).segment, 2);
    assert_int_equal(obstacles_gap(&o, x, 0.0, -1, 1).segment, 2);
    assert_int_equal(obstacles_gap(&o, x, 0.0, 1, 0).segment, -1);
    assert_close(obstacles_gap(&o, x, 0.0, 1, -1).distance, hypot(1.5, 0.75), 1e-15);
    assert_close(obstacles_gap_of(&o, x, 0.0, 0).distance, hypot(1.5, 0.75), 1e-15);
    assert_close(obstacles_gap_of(&o, x, 0.0, 1).distance, hypot(0.5, 0.25), 1e-15);
    obstacles_free(&o);
}

/* 0.1 m in front of the floor, 0.3 m inside the wall: the smaller signed distance, not the nearer surface. */
static void inside_one_of_several_obstacles_is_inside(void **state)
{
    const double ground[4] = {-4.0, 0.0, 4.0, 0.0}, wall[4] = {2.0, -1.0, 2.0, 3.0};
    const dem_obstacle list[2] = {{.n_points = 2, .points = ground, .restitution = 0.0},
                                  {.n_points = 2, .points = wall, .restitution = 0.0}};
    obstacle_set o;
    (void)state;
    assert_ok(obstacles_compile(&o, list, 2));
    check_gap(&o, 2.3, 0.1, -0.3, 1, -1.0, 0.0);
    check_gap(&o, 2.1, -0.3, -0.3, 0, 0.0, 1.0);
    obstacles_free(&o);
}

/* ---- properties over the plane ---- */

/* A ring with spikes and bays, clockwise. */
static const double star[26] = {0.0,  3.0,  0.3,  0.4,  2.0,  1.5,  1.0, 0.0,  2.5, -2.0, 0.2, -1.0, 0.0,
                                -3.0, -0.5, -0.5, -2.5, -1.0, -1.0, 0.2, -3.0, 2.0, -0.6, 0.9, 0.0,  3.0};

/* Distance to the points of all segments, each written as start + clamp(t) d. */
static double distance_to_star(vec2 x)
{
    double nearest = (double)INFINITY;
    for (int k = 0; k < 12; k++) {
        const vec2 a = vec2_at(star, k), d = vec2_sub(vec2_at(star, k + 1), a);
        const double t = fmin(1.0, fmax(0.0, vec2_dot(vec2_sub(x, a), d) / vec2_dot(d, d)));
        nearest = fmin(nearest, vec2_norm(vec2_sub(x, vec2_along(a, t, d))));
    }
    return nearest;
}

/* Crossings of the ray to the right. */
static int inside_star(vec2 x)
{
    int crossings = 0;
    for (int k = 0; k < 12; k++) {
        const vec2 a = vec2_at(star, k), b = vec2_at(star, k + 1);
        if ((a.y > x.y) == (b.y > x.y)) continue;
        crossings += a.x + (x.y - a.y) / (b.y - a.y) * (b.x - a.x) > x.x;
    }
    return crossings % 2;
}

static vec2 random_point(gsl_rng *rng)
{
    const double x = 8.0 * gsl_rng_uniform(rng) - 4.0;
    return (vec2){x, 8.0 * gsl_rng_uniform(rng) - 4.0};
}

static void the_gap_is_the_distance_with_the_sign_of_the_side(void **state)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_inside = 0;
    (void)state;
    obstacle_set o = compile(star, 13, 0.0);
    for (int k = 0; k < 20000; k++) {
        const vec2 x = random_point(rng);
        const int inside = inside_star(x);
        n_inside += inside;
        assert_close(gap_at(&o, x.x, x.y).distance, (inside ? -1.0 : 1.0) * distance_to_star(x), 1e-14);
    }
    assert_true(n_inside > 1000 && n_inside < 19000);
    obstacles_free(&o);
    gsl_rng_free(rng);
}

/* Central differences over 1e-6 m: curvature 1/distance < 1e3 away from vertices gives 1e-9, rounding 1e-15/1e-6.
 * Where two features are equally near there is no gradient: such points are told by one-sided differences that
 * disagree, and are few. */
static void the_normal_is_the_gradient_of_the_gap(void **state)
{
    const double h = 1e-6;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_kinks = 0;
    (void)state;
    obstacle_set o = compile(star, 13, 0.0);
    for (int k = 0; k < 5000; k++) {
        const vec2 x = random_point(rng);
        const obstacle_gap here = gap_at(&o, x.x, x.y);
        const double right = gap_at(&o, x.x + h, x.y).distance, left = gap_at(&o, x.x - h, x.y).distance;
        const double up = gap_at(&o, x.x, x.y + h).distance, down = gap_at(&o, x.x, x.y - h).distance;
        const double bend = fabs(right + left - 2.0 * here.distance) + fabs(up + down - 2.0 * here.distance);
        assert_close(vec2_norm(here.normal), 1.0, 1e-12);
        n_kinks += bend > 1e-3 * h;
        if (fabs(here.distance) < 1e-3 || bend > 1e-3 * h) continue;
        assert_close((right - left) / (2.0 * h), here.normal.x, 1e-8);
        assert_close((up - down) / (2.0 * h), here.normal.y, 1e-8);
    }
    assert_true(n_kinks < 50);
    obstacles_free(&o);
    gsl_rng_free(rng);
}

/* ---- the tree against loops over all segments ---- */

/* Does the segment count as going on to this place along it? */
static int reaches(const segment *s, double place, double tolerance, double margin)
{
    const double before = s->before < 0 ? fmax(margin, s->buried[0]) : 0.0;
    const double after = s->after < 0 ? fmax(margin, s->buried[1]) : 0.0;
    return place >= -(tolerance + before) && place <= s->length + tolerance + after;
}

/* The first of the nearest segments of an obstacle, one after the other. */
static obstacle_gap gap_by_loop(const obstacle_set *o, vec2 x, double margin, dem_index obstacle)
{
    obstacle_gap nearest = {(double)INFINITY, -1, {0.0, 0.0}};
    for (dem_index k = o->first[obstacle]; k < o->first[obstacle + 1]; k++) {
        const segment *s = &o->segments[k];
        const double place = segment_place(s, x), height = segment_height(s, x);
        const dem_index beyond = place < 0.0 ? s->before : s->after;
        const vec2 from = vec2_sub(x, place < 0.0 ? s->start : s->end);
        const double distance = reaches(s, place, 0.0, margin) ? fabs(height) : vec2_norm(from);
        if (distance >= fabs(nearest.distance)) continue;
        nearest = (obstacle_gap){height, k, s->normal};
        if (reaches(s, place, 0.0, margin)) continue;
        const int behind = beyond >= 0 && vec2_dot(vec2_add(s->normal, o->segments[beyond].normal), from) < 0.0;
        nearest.distance = behind ? -distance : distance;
        if (distance > 0.0) nearest.normal = vec2_scale(1.0 / nearest.distance, from);
    }
    return nearest;
}

static void assert_same_gap(obstacle_gap actual, obstacle_gap expected)
{
    assert_true(actual.distance == expected.distance);
    assert_int_equal(actual.segment, expected.segment);
    assert_true(actual.normal.x == expected.normal.x && actual.normal.y == expected.normal.y);
}

static void compare_gaps(const obstacle_set *o, vec2 x, double margin)
{
    obstacle_gap smallest = {(double)INFINITY, -1, {0.0, 0.0}}, but_first = smallest;
    for (dem_index k = 0; k < o->n; k++) {
        const obstacle_gap gap = gap_by_loop(o, x, margin, k);
        assert_same_gap(obstacles_gap_of(o, x, margin, k), gap);
        if (gap.distance < smallest.distance) smallest = gap;
        if (k > 0 && gap.distance < but_first.distance) but_first = gap;
    }
    assert_same_gap(obstacles_gap(o, x, margin, -1, -1), smallest);
    assert_same_gap(obstacles_gap(o, x, margin, -1, 0), but_first);
}

/* Returns how many are touched. */
static int compare_touching(const obstacle_set *o, vec2 x, const obstacle_touch *point)
{
    enum { capacity = 4 };
    dem_index expected[capacity], hits[capacity];
    int n = 0;
    for (dem_index k = 0; k < o->n_segments && n < capacity; k++) {
        const segment *s = &o->segments[k];
        if (s->obstacle == point->without || fabs(segment_height(s, x)) > point->tolerance) continue;
        if (reaches(s, segment_place(s, x), point->tolerance, point->margin)) expected[n++] = k;
    }
    assert_int_equal(obstacles_touching(o, x, point, hits, capacity), n);
    for (int k = 0; k < n; k++) assert_int_equal(hits[k], expected[k]);
    return n;
}

static double uniform(gsl_rng *rng, double a, double b)
{
    return a + (b - a) * gsl_rng_uniform(rng);
}

/* Three polylines: rough ground from the left to the right, a ring above it, and a wall that stands on the ground;
 * scaled, turned and put somewhere. */
typedef struct landscape {
    obstacle_set set;
    vec2 origin, axis;
} landscape;

static vec2 placed(const landscape *l, double x, double y)
{
    return (vec2){l->origin.x + l->axis.x * x - l->axis.y * y, l->origin.y + l->axis.y * x + l->axis.x * y};
}

enum { ground_points = 41, ring_points = 14, wall_points = 4 };

static landscape random_landscape(gsl_rng *rng)
{
    double ground[2 * ground_points], ring[2 * ring_points], wall[2 * wall_points];
    const dem_obstacle list[3] = {{.n_points = ground_points, .points = ground, .restitution = 0.0},
                                  {.n_points = ring_points, .points = ring, .restitution = 0.0},
                                  {.n_points = wall_points, .points = wall, .restitution = 0.0}};
    const double size = pow(10.0, uniform(rng, -3.0, 1.0)), turn = uniform(rng, 0.0, 6.28);
    landscape l = {.axis = {size * cos(turn), size * sin(turn)}};
    l.origin = gsl_rng_uniform(rng) < 0.5 ? (vec2){0.0, 0.0} : (vec2){uniform(rng, -9.0, 9.0), uniform(rng, -9.0, 9.0)};
    double foot = 0.0;
    for (int k = 0; k < ground_points; k++) {
        const double y = k % 3 == 0 ? 0.0 : uniform(rng, -0.1, 0.1);
        if (k == 30) foot = y;
        vec2_put(ground, k, placed(&l, k / 10.0 - 2.0, y));
    }
    for (int k = 0; k < ring_points - 1; k++) {
        const double r = uniform(rng, 0.3, 0.9), angle = -2.0 * M_PI * k / (ring_points - 1);
        vec2_put(ring, k, placed(&l, r * cos(angle), 1.2 + r * sin(angle)));
    }
    vec2_put(ring, ring_points - 1, vec2_at(ring, 0));
    for (int k = 0; k < wall_points; k++) vec2_put(wall, k, placed(&l, 1.0, foot + 0.4 * (wall_points - 1 - k)));
    assert_ok(obstacles_compile(&l.set, list, 3));
    return l;
}

/* Points in the plane, and near or on what may tie: vertices, middles and prolongations of segments. */
static vec2 telling_point(gsl_rng *rng, const landscape *l)
{
    const segment *s = &l->set.segments[gsl_rng_uniform_int(rng, (unsigned long)l->set.n_segments)];
    switch (gsl_rng_uniform_int(rng, 5)) {
    case 0:
        return s->end;
    case 1:
        return vec2_along(vec2_along(s->end, uniform(rng, -0.3, 0.3) * s->length, s->normal), 0.0, s->tangent);
    case 2:
        return vec2_along(vec2_along(s->start, uniform(rng, -0.5, 1.5) * s->length, s->tangent),
                          pow(10.0, uniform(rng, -16.0, 0.0)) * s->length, s->normal);
    case 3:
        return vec2_along(s->start, uniform(rng, -2.0, 2.0) * s->length, s->tangent);
    default:
        return placed(l, uniform(rng, -3.0, 3.0), uniform(rng, -1.0, 3.0));
    }
}

static void the_tree_finds_what_a_loop_finds_to_the_bit(void **state)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_buried = 0, n_touched = 0;
    (void)state;
    for (int c = 0; c < 200; c++) {
        landscape l = random_landscape(rng);
        n_buried += l.set.segments[l.set.n_segments - 1].buried[1] > 0.0;
        for (int k = 0; k < 200; k++) {
            const vec2 x = telling_point(rng, &l);
            const double step = 0.1 * vec2_norm(l.axis), margin = k % 2 == 0 ? 0.0 : uniform(rng, 0.0, 3.0) * step;
            const obstacle_touch point = {uniform(rng, 0.0, k % 3 == 0 ? 1.0 : 1e-6) * step, margin, k % 5 - 1};
            compare_gaps(&l.set, x, margin);
            n_touched += compare_touching(&l.set, x, &point);
        }
        obstacles_free(&l.set);
    }
    assert_true(n_buried == 200 && n_touched > 10000);
    gsl_rng_free(rng);
}

/* From the middle of a square or a square standing on its tip, of 40 segments, features are as far away as rounding
 * lets them be. */
static void rounding_does_not_hide_a_segment(void **state)
{
    static const double corner[2][2] = {{1.0, 1.0}, {1.0, 0.0}};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    (void)state;
    for (int c = 0; c < 2000; c++) {
        double points[2 * 41];
        const double size = pow(10.0, uniform(rng, -4.0, 1.0));
        const vec2 middle = {uniform(rng, -1.0, 1.0), uniform(rng, -1.0, 1.0)};
        vec2 out = {size * corner[c % 2][0], size * corner[c % 2][1]};
        for (int k = 0; k < 40; k++) {
            const vec2 next = {out.y, -out.x}, way = vec2_sub(next, out);
            vec2_put(points, k, vec2_add(middle, vec2_along(out, (k % 10) / 10.0, way)));
            if (k % 10 == 9) out = next;
        }
        vec2_put(points, 40, vec2_at(points, 0));
        obstacle_set o = compile(points, 41, 0.0);
        compare_gaps(&o, middle, 0.0);
        obstacles_free(&o);
    }
    gsl_rng_free(rng);
}

/* A hook whose start points along its shank, and a point off the start's prolongation, 1.5 m from the start and 0.8 m
 * from the shank; turned to all four sides. */
static void a_free_end_is_longer_by_the_margin_where_another_part_is_nearer(void **state)
{
    static const double hook[2 * 8] = {0.0, 0.0, -1.0, 0.0, -1.0, 1.0, 0.0, 1.0,
                                       1.0, 1.0, 2.0,  1.0, 3.0,  1.0, 4.0, 1.0};
    vec2 axis = {1.0, 0.0};
    (void)state;
    for (int side = 0; side < 4; side++, axis = (vec2){-axis.y, axis.x}) {
        double points[2 * 8];
        for (int k = 0; k < 8; k++)
            vec2_put(points, k, vec2_along(vec2_scale(hook[2 * k], axis), hook[2 * k + 1], (vec2){-axis.y, axis.x}));
        const vec2 x = vec2_along(vec2_scale(1.5, axis), 0.2, (vec2){-axis.y, axis.x});
        obstacle_set o = compile(points, 8, 0.0);
        assert_int_equal(obstacles_gap(&o, x, 2.0, -1, -1).segment, 0);
        assert_close(obstacles_gap(&o, x, 2.0, -1, -1).distance, -0.2, 1e-15);
        assert_int_equal(obstacles_gap(&o, x, 1.4, -1, -1).segment, 4);
        obstacles_free(&o);
    }
}

/* The end of one segment and the start of the next are the same point; where a ring closes the first comes first. */
static void of_equally_near_segments_the_first_counts(void **state)
{
    double comb[2 * 40];
    (void)state;
    obstacle_set o = compile(block, 5, 0.0);
    assert_int_equal(gap_at(&o, 5.5, 0.5).segment, 0); /* the middle of a square */
    assert_int_equal(gap_at(&o, 4.7, -0.4).segment, 0);
    assert_int_equal(gap_at(&o, 6.3, 1.4).segment, 1);
    obstacles_free(&o);
    for (int k = 0; k < 40; k++) vec2_put(comb, k, (vec2){k, k % 2});
    o = compile(comb, 40, 0.0);
    for (int k = 1; k < 19; k++) {
        assert_int_equal(gap_at(&o, 2.0 * k, 0.75).segment, 2 * k - 1);
        assert_int_equal(gap_at(&o, 2.0 * k + 1.0, 1.5).segment, 2 * k);
        assert_int_equal(gap_at(&o, 2.0 * k, -0.5).segment, 2 * k - 1);
    }
    obstacles_free(&o);
}

/* ---- touching ---- */

static void a_point_touches_the_segments_within_the_tolerance_of_their_line_and_ends(void **state)
{
    const vec2 past = {3.0005, -1.0}, vertex = {0.0, 0.0}, on_one = {-1.0, 0.0005}, above = {-1.0, 0.002},
               beyond = {-2.0005, 0.0}, further = {-2.002, 0.0};
    const obstacle_touch all = {1e-3, 0.0, -1}, other = {1e-3, 0.0, 0}, longer = {1e-3, 2e-3, -1};
    dem_index hits[4] = {-1, -1, -1, -1};
    (void)state;
    obstacle_set o = compile_both();
    assert_int_equal(obstacles_touching(&o, vertex, &all, hits, 4), 2);
    assert_int_equal(hits[0], 0);
    assert_int_equal(hits[1], 1);
    assert_int_equal(obstacles_touching(&o, vertex, &all, hits, 1), 1);
    assert_int_equal(obstacles_touching(&o, vertex, &other, hits, 4), 0);
    assert_int_equal(obstacles_touching(&o, on_one, &all, hits, 4), 1);
    assert_int_equal(obstacles_touching(&o, above, &all, hits, 4), 0);
    assert_int_equal(obstacles_touching(&o, beyond, &all, hits, 4), 1);
    assert_int_equal(obstacles_touching(&o, further, &all, hits, 4), 0);
    assert_int_equal(obstacles_touching(&o, further, &longer, hits, 4), 1); /* past a free end */
    assert_int_equal(obstacles_touching(&o, past, &all, hits, 4), 1);
    assert_int_equal(hits[0], 2);
    obstacles_free(&o);
}

/* ---- bends ---- */

static void check_bend(const obstacle_set *o, dem_index s, bool backwards, obstacle_bend bend, dem_index expected)
{
    dem_index beyond = 77;
    assert_int_equal(obstacles_bend(o, s, backwards, &beyond), bend);
    assert_int_equal(beyond, expected);
}

static void bends_are_told_from_both_sides_alike(void **state)
{
    (void)state;
    obstacle_set o = compile_both();
    check_bend(&o, 0, true, OBSTACLE_FREE_END, -1);
    check_bend(&o, 0, false, OBSTACLE_CONVEX, 1);
    check_bend(&o, 1, true, OBSTACLE_CONVEX, 0);
    check_bend(&o, 1, false, OBSTACLE_CONCAVE, 2);
    check_bend(&o, 2, true, OBSTACLE_CONCAVE, 1);
    check_bend(&o, 2, false, OBSTACLE_FREE_END, -1);
    check_bend(&o, 6, false, OBSTACLE_CONVEX, 3); /* where the ring closes */
    check_bend(&o, 3, true, OBSTACLE_CONVEX, 6);
    obstacles_free(&o);
}

/* Straight is a sine of the bend below 1e-9; a line that turns back is none, though its sine is 0. */
static void a_bend_below_1e_9_is_straight(void **state)
{
    const double points[10] = {0.0, 0.0, 1.0, 0.0, 2.0, 0.5e-9, 3.0, 3.0e-9, 4.0, 3.0e-9};
    (void)state;
    obstacle_set o = compile(points, 5, 0.0);
    check_bend(&o, 0, false, OBSTACLE_STRAIGHT, 1);
    check_bend(&o, 1, true, OBSTACLE_STRAIGHT, 0);
    check_bend(&o, 1, false, OBSTACLE_CONCAVE, 2);
    check_bend(&o, 2, false, OBSTACLE_CONVEX, 3);
    obstacles_free(&o);
}

/* ---- vertices ---- */

static void check_vertex(const obstacle_set *o, dem_index k, dem_index before, dem_index after, double x, double y)
{
    assert_int_equal(o->vertices[k].before, before);
    assert_int_equal(o->vertices[k].after, after);
    assert_true(o->vertices[k].at.x == x && o->vertices[k].at.y == y);
}

static void vertices_are_where_the_solid_sticks_out(void **state)
{
    const double points[14] = {0.0, 0.0, 1.0, 0.0, 2.0, 0.5e-9, 3.0, 3.0e-9, 4.0, 3.0e-9, 4.0, -1.0, 5.0, -1.0};
    (void)state;
    obstacle_set o = compile_both();
    assert_int_equal(o.n_vertices, 5);
    check_vertex(&o, 0, 0, 1, 0.0, 0.0); /* of the valley; (1, -1) is a bay, the ends are free */
    check_vertex(&o, 1, 3, 4, 5.0, 1.0);
    check_vertex(&o, 2, 4, 5, 6.0, 1.0);
    check_vertex(&o, 3, 5, 6, 6.0, 0.0);
    check_vertex(&o, 4, 6, 3, 5.0, 0.0); /* where the ring closes */
    obstacles_free(&o);
    assert_null(o.vertices);
    assert_int_equal(o.n_vertices, 0);
    o = compile(points, 7, 0.0); /* straight, a bay, two corners, a bay */
    assert_int_equal(o.n_vertices, 2);
    check_vertex(&o, 0, 2, 3, 3.0, 3.0e-9);
    check_vertex(&o, 1, 3, 4, 4.0, 3.0e-9);
    obstacles_free(&o);
}

/* An edge of a body above: from the left to the right, its body on the left. */
static obstacle_edge edge_between(double ax, double ay, double bx, double by)
{
    return (obstacle_edge){.previous = {ax, ay},
                           .next = {bx, by},
                           .a = {ax, ay},
                           .b = {bx, by},
                           .tolerance = 1e-9,
                           .depth = 0.5,
                           .reach = 0.5,
                           .without = {-1, -1},
                           .except = {-1, -1}};
}

static void assert_no_poke(const obstacle_set *o, const obstacle_edge *edge)
{
    const obstacle_poke poke = obstacles_poke(o, edge);
    assert_int_equal(poke.vertex, -1);
    assert_true(poke.distance == (double)INFINITY);
}

static void a_vertex_pokes_an_edge_from_the_front_or_from_behind(void **state)
{
    (void)state;
    obstacle_set o = compile(valley, 4, 0.0);
    obstacle_edge edge = edge_between(-1.0, 0.25, 3.0, 0.25);
    obstacle_poke poke = obstacles_poke(&o, &edge);
    assert_int_equal(poke.vertex, 0);
    assert_close(poke.distance, 0.25, 1e-15);
    assert_close(poke.place, 0.25, 1e-15);
    assert_close(poke.normal.x, 0.0, 0.0);
    assert_close(poke.normal.y, 1.0, 0.0);
    edge = edge_between(-0.3, 0.2, 0.3, -0.6); /* falls 4 on 3: its normal is (0.8, 0.6) */
    poke = obstacles_poke(&o, &edge);
    assert_close(poke.distance, -0.12, 1e-15);
    assert_close(poke.place, 0.34, 1e-15);
    assert_close(poke.normal.x, 0.8, 1e-15);
    assert_close(poke.normal.y, 0.6, 1e-15);
    obstacles_free(&o);
}

static void a_vertex_beside_an_edge_or_out_of_its_range_or_on_its_back_does_not_poke(void **state)
{
    (void)state;
    obstacle_set o = compile(valley, 4, 0.0);
    obstacle_edge edge = edge_between(0.125, 0.25, 1.0, 0.25);
    assert_no_poke(&o, &edge);
    edge.tolerance = 0.125;
    assert_close(obstacles_poke(&o, &edge).place, 0.0, 0.0);
    edge = edge_between(-1.0, 0.25, -0.125, 0.25);
    assert_no_poke(&o, &edge);
    edge.tolerance = 0.125;
    assert_close(obstacles_poke(&o, &edge).place, 1.0, 0.0);
    edge = edge_between(-1.0, 0.5, 1.0, 0.5);
    assert_no_poke(&o, &edge); /* as far as the reach */
    edge = edge_between(-1.0, -0.5, 1.0, -0.5);
    assert_no_poke(&o, &edge); /* as far as the depth */
    edge = edge_between(1.0, 0.25, -1.0, 0.25);
    assert_no_poke(&o, &edge); /* the corner points out of this body */
    edge = edge_between(-1.0, 0.25, -1.0, 0.25);
    assert_no_poke(&o, &edge); /* no length */
    obstacles_free(&o);
    o = compile(block, 5, 0.0);
    edge = edge_between(4.75, 1.25, 5.25, 0.75);
    assert_no_poke(&o, &edge); /* the corner points along the edge */
    obstacles_free(&o);
}

/* Teeth whose tips are at y = 0, but the fifth which is 0.125 m lower and the ninth 0.125 m higher. */
static void of_several_vertices_the_deepest_pokes_and_of_equals_the_first(void **state)
{
    enum { n = 25 };
    double points[2 * n];
    (void)state;
    for (int k = 0; k < n; k++)
        vec2_put(points, k, (vec2){k, k % 2 == 0 ? -1.0 : (k == 9 ? -0.125 : (k == 17 ? 0.125 : 0.0))});
    obstacle_set o = compile(points, n, 0.0);
    obstacle_edge edge = edge_between(0.0, 0.25, 24.0, 0.25);
    assert_int_equal(o.n_vertices, 12);
    assert_int_equal(obstacles_poke(&o, &edge).vertex, 8);
    edge.except[1] = 8;
    assert_int_equal(obstacles_poke(&o, &edge).vertex, 0);
    edge.except[0] = 0;
    assert_int_equal(obstacles_poke(&o, &edge).vertex, 1);
    edge = edge_between(6.5, 0.25, 15.5, 0.25);
    assert_int_equal(obstacles_poke(&o, &edge).vertex, 3);
    edge = edge_between(6.5, -0.25, 15.5, -0.25);
    assert_close(obstacles_poke(&o, &edge).distance, -0.25, 1e-15);
    edge.without[1] = 0;
    assert_no_poke(&o, &edge);
    edge.without[0] = 0;
    edge.without[1] = -1;
    assert_no_poke(&o, &edge);
    obstacles_free(&o);
}

/* Whether x, `distance` in front of an edge, is further in front of its neighbour pq, on which its foot is, where the
 * boundary turns left from one to the other, and outside the body there or pointing into it. */
static bool beside_neighbour(vec2 p, vec2 q, vec2 x, vec2 mean, double distance)
{
    const vec2 way = vec2_sub(q, p);
    const double along = vec2_dot(vec2_sub(x, p), way), height = -vec2_cross(way, vec2_sub(x, p));
    if (along < 0.0 || along > vec2_dot(way, way) || height / vec2_norm(way) <= distance) return false;
    return height >= 0.0 || vec2_cross(way, mean) > 0.0;
}

static obstacle_poke poke_by_loop(const obstacle_set *o, const obstacle_edge *edge)
{
    const vec2 way = vec2_sub(edge->b, edge->a);
    const double length = vec2_norm(way);
    const vec2 tangent = vec2_scale(1.0 / length, way), normal = {-tangent.y, tangent.x};
    obstacle_poke first = {(double)INFINITY, -1, 0.0, normal};
    for (dem_index k = 0; k < o->n_vertices && length > 0.0; k++) {
        const segment *before = &o->segments[o->vertices[k].before], *after = &o->segments[o->vertices[k].after];
        const double distance = vec2_dot(vec2_sub(edge->a, o->vertices[k].at), normal);
        const double place = vec2_dot(vec2_sub(o->vertices[k].at, edge->a), tangent);
        if (k == edge->except[0] || k == edge->except[1]) continue;
        if (before->obstacle == edge->without[0] || before->obstacle == edge->without[1]) continue;
        if (distance <= -edge->depth || distance >= edge->reach || distance >= first.distance) continue;
        const vec2 next = vec2_sub(edge->next, edge->b), previous = vec2_sub(edge->a, edge->previous);
        const bool notch_b = vec2_cross(way, next) < 0.0 && place > length && place - length <= edge->depth &&
                             distance < 0.0 && vec2_dot(next, vec2_sub(o->vertices[k].at, edge->b)) < 0.0;
        const bool notch_a = vec2_cross(previous, way) < 0.0 && place < 0.0 && -place <= edge->depth &&
                             distance < 0.0 && vec2_dot(previous, vec2_sub(o->vertices[k].at, edge->a)) > 0.0;
        if ((place < -edge->tolerance && !notch_a) || (place > length + edge->tolerance && !notch_b)) continue;
        if (vec2_dot(normal, vec2_add(before->normal, after->normal)) <= 0.0) continue;
        const vec2 mean = vec2_add(before->normal, after->normal);
        if (distance < 0.0 && vec2_cross(previous, way) > 0.0 &&
            beside_neighbour(edge->previous, edge->a, o->vertices[k].at, mean, distance))
            continue;
        if (distance < 0.0 && vec2_cross(way, next) > 0.0 &&
            beside_neighbour(edge->b, edge->next, o->vertices[k].at, mean, distance))
            continue;
        first = (obstacle_poke){distance, k, fmin(fmax(place / length, 0.0), 1.0), normal};
    }
    return first;
}

/* Edges between telling points: many pass exactly through vertices, end on their foot, or lie along segments. */
static void the_tree_finds_the_vertex_that_a_loop_finds_to_the_bit(void **state)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_pokes = 0;
    (void)state;
    for (int c = 0; c < 200; c++) {
        landscape l = random_landscape(rng);
        const double size = vec2_norm(l.axis);
        for (int k = 0; k < 200; k++) {
            const dem_index some = (dem_index)gsl_rng_uniform_int(rng, (unsigned long)l.set.n_vertices);
            obstacle_edge edge = {.a = telling_point(rng, &l),
                                  .b = telling_point(rng, &l),
                                  .tolerance = k % 2 == 0 ? 0.0 : uniform(rng, 0.0, 0.2) * size,
                                  .depth = k % 3 == 0 ? (double)INFINITY : uniform(rng, 0.0, 1.0) * size,
                                  .reach = k % 5 == 0 ? (double)INFINITY : uniform(rng, 0.0, 1.0) * size,
                                  .without = {k % 7 - 1, k % 11 - 1},
                                  .except = {k % 4 == 0 ? some : -1, k % 4 == 1 ? some : -1}};
            edge.previous = k % 2 == 0 ? edge.a : telling_point(rng, &l);
            edge.next = k % 3 == 0 ? edge.b : telling_point(rng, &l);
            const obstacle_poke poke = obstacles_poke(&l.set, &edge), expected = poke_by_loop(&l.set, &edge);
            assert_int_equal(poke.vertex, expected.vertex);
            assert_true(poke.distance == expected.distance && poke.place == expected.place);
            n_pokes += poke.vertex >= 0;
        }
        obstacles_free(&l.set);
    }
    assert_true(n_pokes > 5000 && n_pokes < 35000);
    gsl_rng_free(rng);
}

static void height_and_place_are_measured_from_the_start(void **state)
{
    const vec2 x = {0.5 + 0.1, -0.5 + 0.1};
    (void)state;
    obstacle_set o = compile(valley, 4, 0.0);
    assert_close(segment_place(&o.segments[1], x), sqrt(0.5), 1e-15);
    assert_close(segment_height(&o.segments[1], x), 0.1 * sqrt(2.0), 1e-15);
    obstacles_free(&o);
}

static void a_polyline_that_meets_itself_is_refused(void **state)
{
    static const double crossing[8] = {0.0, 0.0, 2.0, 0.0, 2.0, 1.0, 1.0, -1.0},
                        back[6] = {0.0, 0.0, 2.0, 0.0, 1.0, 0.0};
    static const double six[10] = {-1.0, 0.0, 3.0, 0.0, 3.0, 2.0, 1.0, 2.0, 1.0, 0.0};
    const dem_obstacle list[3] = {{.n_points = 4, .points = crossing, .restitution = 0.0},
                                  {.n_points = 3, .points = back, .restitution = 0.0},
                                  {.n_points = 5, .points = six, .restitution = 0.0}};
    static const char *const messages[3] = {"obstacle 0: segments 0 and 2 meet",
                                            "obstacle 0: segment 1 goes back over segment 0",
                                            "obstacle 0: segments 0 and 3 meet"};
    (void)state;
    for (int k = 0; k < 3; k++) {
        obstacle_set o;
        assert_int_equal(obstacles_compile(&o, &list[k], 1), DEM_ERROR_MODEL);
        assert_string_equal(dem_status_message(), messages[k]);
    }
}

/* Equal steps in one direction that is none of the axes': segments far apart on a line do not meet, although rounding
 * makes the lines cross. */
static void segments_in_line_do_not_meet(void **state)
{
    enum { n = 201 };
    double points[2 * n];
    (void)state;
    for (int slope = 1; slope < 100; slope++) {
        for (int k = 0; k < n; k++) vec2_put(points, k, (vec2){0.001 * k, 0.001 * k * slope / 100.0});
        obstacle_set o = compile(points, n, 0.0);
        obstacles_free(&o);
    }
}

/* The refused pair is the first one with the smallest first segment. */
static void of_10000_segments_the_pair_that_meets_is_named(void **state)
{
    enum { n = 10001 };
    static double points[2 * n];
    const dem_obstacle obstacle = {.n_points = n, .points = points, .restitution = 0.0};
    (void)state;
    for (int k = 0; k < n; k++) vec2_put(points, k, (vec2){1e-4 * k, k % 2 == 0 ? 0.0 : 1e-3});
    obstacle_set o = compile(points, n, 0.0);
    assert_int_equal(obstacles_gap(&o, (vec2){0.77770001, 2e-3}, 0.0, -1, -1).segment, 7776);
    obstacles_free(&o);
    vec2_put(points, n - 1, (vec2){0.5, 0.9e-3});
    refuse(&obstacle, 1, "obstacle 0: segments 5000 and 9999 meet");
}

static void an_obstacle_is_checked_by_itself(void **state)
{
    (void)state;
    static const double crossing[] = {0, 0, 2, 0, 2, -1, 1, 1}, back[] = {0, 0, 2, 0, 1, 0}, point[] = {1, 1, 1, 1};
    static const struct {
        dem_obstacle obstacle;
        dem_status status;
        dem_index pair[2];
    } cases[] = {{{.n_points = 4, .points = valley}, DEM_OK, {-1, -1}},
                 {{.n_points = 5, .points = block}, DEM_OK, {-1, -1}},
                 {{.n_points = 4, .points = crossing}, DEM_ERROR_MODEL, {0, 2}},
                 {{.n_points = 3, .points = back}, DEM_ERROR_MODEL, {0, 1}},
                 {{.n_points = 2, .points = point}, DEM_ERROR_MODEL, {-1, -1}},
                 {{.n_points = 4, .points = valley, .restitution = 2.0}, DEM_ERROR_MODEL, {-1, -1}}};
    dem_index pair[2];
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_int_equal(dem_obstacle_check(&cases[k].obstacle, pair), cases[k].status);
        assert_int_equal(pair[0], cases[k].pair[0]);
        assert_int_equal(pair[1], cases[k].pair[1]);
    }
    assert_int_equal(dem_obstacle_check(NULL, pair), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_obstacle_check(&cases[0].obstacle, NULL), DEM_ERROR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_obstacle_of_one_point_or_none_is_refused),
        cmocka_unit_test(restitution_must_lie_between_0_and_1),
        cmocka_unit_test(a_point_that_is_not_finite_is_named),
        cmocka_unit_test(a_segment_without_length_is_named),
        cmocka_unit_test(segments_are_numbered_obstacle_by_obstacle),
        cmocka_unit_test(the_set_keeps_copies_of_the_points),
        cmocka_unit_test(the_gap_counts_from_the_nearest_segment_and_is_negative_behind_it),
        cmocka_unit_test(at_a_vertex_the_distance_is_to_the_vertex),
        cmocka_unit_test(round_a_free_end_every_point_is_in_front),
        cmocka_unit_test(on_the_vertex_itself_the_gap_is_zero_and_the_normal_that_of_a_segment),
        cmocka_unit_test(a_ring_is_solid_inside_when_it_runs_clockwise_and_a_vessel_otherwise),
        cmocka_unit_test(without_obstacles_the_gap_is_infinite),
        cmocka_unit_test(obstacles_can_be_left_out_or_asked_alone),
        cmocka_unit_test(inside_one_of_several_obstacles_is_inside),
        cmocka_unit_test(the_gap_is_the_distance_with_the_sign_of_the_side),
        cmocka_unit_test(the_normal_is_the_gradient_of_the_gap),
        cmocka_unit_test(the_tree_finds_what_a_loop_finds_to_the_bit),
        cmocka_unit_test(rounding_does_not_hide_a_segment),
        cmocka_unit_test(a_free_end_is_longer_by_the_margin_where_another_part_is_nearer),
        cmocka_unit_test(of_equally_near_segments_the_first_counts),
        cmocka_unit_test(a_point_touches_the_segments_within_the_tolerance_of_their_line_and_ends),
        cmocka_unit_test(bends_are_told_from_both_sides_alike),
        cmocka_unit_test(a_bend_below_1e_9_is_straight),
        cmocka_unit_test(vertices_are_where_the_solid_sticks_out),
        cmocka_unit_test(a_vertex_pokes_an_edge_from_the_front_or_from_behind),
        cmocka_unit_test(a_vertex_beside_an_edge_or_out_of_its_range_or_on_its_back_does_not_poke),
        cmocka_unit_test(of_several_vertices_the_deepest_pokes_and_of_equals_the_first),
        cmocka_unit_test(the_tree_finds_the_vertex_that_a_loop_finds_to_the_bit),
        cmocka_unit_test(height_and_place_are_measured_from_the_start),
        cmocka_unit_test(a_polyline_that_meets_itself_is_refused),
        cmocka_unit_test(segments_in_line_do_not_meet),
        cmocka_unit_test(an_obstacle_is_checked_by_itself),
        cmocka_unit_test(of_10000_segments_the_pair_that_meets_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
