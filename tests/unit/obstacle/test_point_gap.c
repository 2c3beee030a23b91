/* SPDX-License-Identifier: BSD-3-Clause */
/* point_gap.c: signed gap and its normal, what a point touches. Tolerances of 1e-15 to 1e-13 are the rounding of
 * coordinates of order 1 m. */
#include "harness/cleanup_gsl.h"
#include "unit/obstacle/landscape.h"

static void check_gap(const obstacle_set *o, double x, double y, double distance, dem_index nearest, double nx,
                      double ny)
{
    const obstacle_gap gap = gap_at(o, x, y);
    assert_close(gap.distance, distance, 1e-15);
    assert_int_equal(gap.segment, nearest);
    assert_close(gap.normal.x, nx, 1e-14);
    assert_close(gap.normal.y, ny, 1e-14);
}

TEST(the_gap_counts_from_the_nearest_segment_and_is_negative_behind_it)
{
    const double r = sqrt(0.5);
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0);
    check_gap(&o, -1.0, 0.3, 0.3, 0, 0.0, 1.0);
    check_gap(&o, -1.0, -0.3, -0.3, 0, 0.0, 1.0);
    check_gap(&o, -1.0, 0.0, 0.0, 0, 0.0, 1.0);
    check_gap(&o, 0.5 + 0.2, -0.5 + 0.2, 0.2 / r, 1, r, r);
    check_gap(&o, 0.5 - 0.2, -0.5 - 0.2, -0.2 / r, 1, r, r);
    check_gap(&o, 2.0, -1.5, -0.5, 2, 0.0, 1.0);
}

/* Off the convex vertex (0, 0) the nearest point is the vertex, in front; behind the concave one (1, -1) likewise,
 * inside. */
TEST(at_a_vertex_the_distance_is_to_the_vertex)
{
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0);
    obstacle_gap gap = gap_at(&o, 0.3, 0.4);
    assert_close(gap.distance, 0.5, 1e-15);
    assert_close(gap.normal.x, 0.6, 1e-15);
    assert_close(gap.normal.y, 0.8, 1e-15);
    gap = gap_at(&o, 1.0 - 0.3, -1.0 - 0.4);
    assert_close(gap.distance, -0.5, 1e-15);
    assert_close(gap.normal.x, 0.6, 1e-14);
    assert_close(gap.normal.y, 0.8, 1e-14);
}

TEST(round_a_free_end_every_point_is_in_front)
{
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0);
    check_gap(&o, -2.3, 0.4, 0.5, 0, -0.6, 0.8);
    check_gap(&o, -2.3, -0.4, 0.5, 0, -0.6, -0.8);
    check_gap(&o, 3.4, -1.3, 0.5, 2, 0.8, -0.6);
    check_gap(&o, 3.0 - 1e-9, -1.3, -0.3, 2, 0.0, 1.0);
}

TEST(on_the_vertex_itself_the_gap_is_zero_and_the_normal_that_of_a_segment)
{
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0);
    check_gap(&o, 0.0, 0.0, 0.0, 0, 0.0, 1.0);
}

TEST(a_ring_is_solid_inside_when_it_runs_clockwise_and_a_vessel_otherwise)
{
    double vessel[10];
    CLEANUP(obstacles_free) obstacle_set o = compile(block, 5, 0.0);
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
}

TEST(without_obstacles_the_gap_is_infinite)
{
    CLEANUP(obstacles_free) obstacle_set o;
    assert_ok(obstacles_compile(&o, NULL, 0));
    const obstacle_gap gap = gap_at(&o, 1.0, 2.0);
    assert_true(gap.distance == (double)INFINITY);
    assert_int_equal(gap.segment, -1);
}

TEST(obstacles_can_be_left_out_or_asked_alone)
{
    const vec2 x = {4.5, -0.25}; /* 0.56 m from the block's corner, 1.68 m from the valley's end */
    CLEANUP(obstacles_free) obstacle_set o = compile_both();
    assert_int_equal(obstacles_gap(&o, 0.0, x, 0.0, -1, -1).segment, 3);
    assert_int_equal(obstacles_gap(&o, 0.0, x, 0.0, 1, -1).segment, 2);
    assert_int_equal(obstacles_gap(&o, 0.0, x, 0.0, -1, 1).segment, 2);
    assert_int_equal(obstacles_gap(&o, 0.0, x, 0.0, 1, 0).segment, -1);
    assert_close(obstacles_gap(&o, 0.0, x, 0.0, 1, -1).distance, hypot(1.5, 0.75), 1e-15);
    assert_close(obstacles_gap_of(&o, 0.0, x, 0.0, 0).distance, hypot(1.5, 0.75), 1e-15);
    assert_close(obstacles_gap_of(&o, 0.0, x, 0.0, 1).distance, hypot(0.5, 0.25), 1e-15);
}

/* 0.1 m in front of the floor, 0.3 m inside the wall: the smaller signed distance, not the nearer surface. */
TEST(inside_one_of_several_obstacles_is_inside)
{
    const double ground[4] = {-4.0, 0.0, 4.0, 0.0}, wall[4] = {2.0, -1.0, 2.0, 3.0};
    const dem_obstacle list[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = ground, .restitution = 0.0},
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = wall, .restitution = 0.0}};
    CLEANUP(obstacles_free) obstacle_set o;
    assert_ok(obstacles_compile(&o, list, 2));
    check_gap(&o, 2.3, 0.1, -0.3, 1, -1.0, 0.0);
    check_gap(&o, 2.1, -0.3, -0.3, 0, 0.0, 1.0);
}

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

TEST(the_gap_is_the_distance_with_the_sign_of_the_side)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_inside = 0;
    CLEANUP(obstacles_free) obstacle_set o = compile(star, 13, 0.0);
    for (int k = 0; k < 20000; k++) {
        const vec2 x = random_point(rng);
        const int inside = inside_star(x);
        n_inside += inside;
        assert_close(gap_at(&o, x.x, x.y).distance, (inside ? -1.0 : 1.0) * distance_to_star(x), 1e-14);
    }
    assert_true(n_inside > 1000 && n_inside < 19000);
}

/* Central differences over 1e-6 m: curvature 1/distance < 1e3 away from vertices gives 1e-9, rounding 1e-15/1e-6.
 * Where two features are equally near there is no gradient: such points are recognised by one-sided differences that
 * disagree, and are few. */
TEST(the_normal_is_the_gradient_of_the_gap)
{
    const double h = 1e-6;
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_kinks = 0;
    CLEANUP(obstacles_free) obstacle_set o = compile(star, 13, 0.0);
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
}

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

/* As far as half the way to the next segment, whose nearest point is the vertex, is further than the first. */
TEST(a_segment_is_alone_up_to_where_another_might_be_nearer)
{
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0);
    const obstacle_lone_segment above = obstacles_lone_segment(&o, (vec2){-1.0, 0.3}, 0.0),
                                near = obstacles_lone_segment(&o, (vec2){2.5, -0.99}, 0.0);
    assert_int_equal(above.segment, 0);
    assert_close(above.radius, 0.999 * 0.5 * (sqrt(1.09) - 0.3), 1e-15);
    assert_int_equal(near.segment, 2);
    assert_close(near.radius, 0.999 * 0.5, 1e-15);
}

TEST(beside_a_segment_and_between_several_obstacles_none_is_alone)
{
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0), both = compile_both();
    const vec2 off_a_vertex = {0.3, 0.4}, beyond_an_end = {-2.3, 0.1}, above = {-1.0, 0.3};
    assert_true(obstacles_lone_segment(&o, above, 0.0).radius > 0.0);
    assert_close(obstacles_lone_segment(&o, off_a_vertex, 0.0).radius, 0.0, 0.0);
    assert_close(obstacles_lone_segment(&o, beyond_an_end, 0.0).radius, 0.0, 0.0);
    assert_close(obstacles_lone_segment(&both, above, 0.0).radius, 0.0, 0.0);
    assert_false(obstacle_lone_covers(&(obstacle_lone_segment){.radius = 0.0}, (vec2){0.0, 0.0}));
}

/* Points up to the radius; some of them nearer to a vertex than the centre is, or behind the line. */
TEST(where_a_segment_is_alone_the_gap_is_the_height_over_it_to_the_bit)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(obstacles_free) obstacle_set closed = compile(star, 13, 0.0), open = compile(valley, 4, 0.0);
    int n_alone = 0;
    for (int k = 0; k < 4000; k++) {
        const obstacle_set *o = k % 2 == 0 ? &closed : &open;
        const double margin = k % 4 < 2 ? 0.0 : 1e-3;
        const vec2 centre = random_point(rng);
        const obstacle_lone_segment lone = obstacles_lone_segment(o, centre, margin);
        n_alone += lone.radius > 0.0;
        for (int q = 0; q < 20 && lone.radius > 0.0; q++) {
            const double r = lone.radius * (q % 2 == 0 ? 0.9999 : gsl_rng_uniform(rng)), turn = 0.31 * q;
            const vec2 x = {centre.x + r * cos(turn), centre.y + r * sin(turn)};
            const obstacle_gap expected = obstacles_gap(o, 0.0, x, margin, -1, -1),
                               found = obstacle_lone_gap(o, &lone, x);
            assert_true(obstacle_lone_covers(&lone, x));
            assert_same_gap(found, expected);
        }
    }
    assert_true(n_alone > 1000);
}

static void compare_gaps(const obstacle_set *o, vec2 x, double margin)
{
    obstacle_gap smallest = {(double)INFINITY, -1, {0.0, 0.0}}, but_first = smallest;
    for (dem_index k = 0; k < o->n; k++) {
        const obstacle_gap gap = gap_by_loop(o, x, margin, k);
        assert_same_gap(obstacles_gap_of(o, 0.0, x, margin, k), gap);
        if (gap.distance < smallest.distance) smallest = gap;
        if (k > 0 && gap.distance < but_first.distance) but_first = gap;
    }
    assert_same_gap(obstacles_gap(o, 0.0, x, margin, -1, -1), smallest);
    assert_same_gap(obstacles_gap(o, 0.0, x, margin, -1, 0), but_first);
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
    assert_int_equal(obstacles_touching(o, 0.0, x, point, hits, capacity), n);
    for (int k = 0; k < n; k++) assert_int_equal(hits[k], expected[k]);
    return n;
}

TEST(the_tree_finds_what_a_loop_finds_to_the_bit)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_buried = 0, n_touched = 0;
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
}

/* From the middle of a square or a square standing on its tip, of 40 segments, features are as far away as rounding
 * lets them be. */
TEST(rounding_does_not_hide_a_segment)
{
    static const double corner[2][2] = {{1.0, 1.0}, {1.0, 0.0}};
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
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
        CLEANUP(obstacles_free) obstacle_set o = compile(points, 41, 0.0);
        compare_gaps(&o, middle, 0.0);
    }
}

/* A hook whose start points along its shank, and a point off the start's prolongation, 1.5 m from the start and 0.8 m
 * from the shank; turned to all four sides. */
TEST(a_free_end_is_longer_by_the_margin_where_another_part_is_nearer)
{
    static const double hook[2 * 8] = {0.0, 0.0, -1.0, 0.0, -1.0, 1.0, 0.0, 1.0,
                                       1.0, 1.0, 2.0,  1.0, 3.0,  1.0, 4.0, 1.0};
    vec2 axis = {1.0, 0.0};
    for (int side = 0; side < 4; side++, axis = (vec2){-axis.y, axis.x}) {
        double points[2 * 8];
        for (int k = 0; k < 8; k++)
            vec2_put(points, k, vec2_along(vec2_scale(hook[2 * k], axis), hook[2 * k + 1], (vec2){-axis.y, axis.x}));
        const vec2 x = vec2_along(vec2_scale(1.5, axis), 0.2, (vec2){-axis.y, axis.x});
        CLEANUP(obstacles_free) obstacle_set o = compile(points, 8, 0.0);
        assert_int_equal(obstacles_gap(&o, 0.0, x, 2.0, -1, -1).segment, 0);
        assert_close(obstacles_gap(&o, 0.0, x, 2.0, -1, -1).distance, -0.2, 1e-15);
        assert_int_equal(obstacles_gap(&o, 0.0, x, 1.4, -1, -1).segment, 4);
    }
}

/* The end of one segment and the start of the next are the same point; where a ring closes the first comes first. */
TEST(of_equally_near_segments_the_first_counts)
{
    double comb[2 * 40];
    CLEANUP(obstacles_free) obstacle_set o = compile(block, 5, 0.0);
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
}

TEST(a_point_touches_the_segments_within_the_tolerance_of_their_line_and_ends)
{
    const vec2 past = {3.0005, -1.0}, vertex = {0.0, 0.0}, on_one = {-1.0, 0.0005}, above = {-1.0, 0.002},
               beyond = {-2.0005, 0.0}, further = {-2.002, 0.0};
    const obstacle_touch all = {1e-3, 0.0, -1}, other = {1e-3, 0.0, 0}, longer = {1e-3, 2e-3, -1};
    dem_index hits[4] = {-1, -1, -1, -1};
    CLEANUP(obstacles_free) obstacle_set o = compile_both();
    assert_int_equal(obstacles_touching(&o, 0.0, vertex, &all, hits, 4), 2);
    assert_int_equal(hits[0], 0);
    assert_int_equal(hits[1], 1);
    assert_int_equal(obstacles_touching(&o, 0.0, vertex, &all, hits, 1), 1);
    assert_int_equal(obstacles_touching(&o, 0.0, vertex, &other, hits, 4), 0);
    assert_int_equal(obstacles_touching(&o, 0.0, on_one, &all, hits, 4), 1);
    assert_int_equal(obstacles_touching(&o, 0.0, above, &all, hits, 4), 0);
    assert_int_equal(obstacles_touching(&o, 0.0, beyond, &all, hits, 4), 1);
    assert_int_equal(obstacles_touching(&o, 0.0, further, &all, hits, 4), 0);
    assert_int_equal(obstacles_touching(&o, 0.0, further, &longer, hits, 4), 1); /* past a free end */
    assert_int_equal(obstacles_touching(&o, 0.0, past, &all, hits, 4), 1);
    assert_int_equal(hits[0], 2);
}

/* 1e-14: rounding of coordinates of order 10 m. */
TEST(what_moves_is_met_where_it_is)
{
    const vec2 velocity = {-3.0, -0.5};
    const double t = 1.25;
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_hits = 0;
    CLEANUP(obstacles_free) obstacle_set moving = compile_moving(velocity, (vec2){0.0, 0.0});
    CLEANUP(obstacles_free) obstacle_set there = compile_moving((vec2){0.0, 0.0}, vec2_scale(t, velocity));
    for (int k = 0; k < 2000; k++) {
        const vec2 x = {uniform(rng, -3.0, 7.0), uniform(rng, -2.0, 2.0)};
        const obstacle_gap a = obstacles_gap(&moving, t, x, 0.1, -1, -1),
                           b = obstacles_gap(&there, 0.0, x, 0.1, -1, -1);
        const obstacle_touch point = {0.2, 0.1, -1};
        dem_index hits[2][8];
        assert_close(a.distance, b.distance, 1e-14);
        assert_int_equal(a.segment, b.segment);
        assert_close(vec2_norm(vec2_sub(a.normal, b.normal)), 0.0, 1e-12);
        const int n = obstacles_touching(&moving, t, x, &point, hits[0], 8);
        assert_int_equal(n, obstacles_touching(&there, 7.0, x, &point, hits[1], 8));
        for (int h = 0; h < n; h++) assert_int_equal(hits[0][h], hits[1][h]);
        n_hits += n;
    }
    assert_true(n_hits > 50);
}
