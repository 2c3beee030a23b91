/* SPDX-License-Identifier: BSD-3-Clause */
/* vertex_gap.c: which vertex enters through an edge. Tolerances of 1e-15 are the rounding of coordinates of order
 * 1 m. */
#include "obstacle/vertex_gap.h"

#include "harness/cleanup_gsl.h"
#include "unit/obstacle/landscape.h"

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

static void assert_no_gap(const obstacle_set *o, const obstacle_edge *edge)
{
    const obstacle_vertex_gap gap = obstacles_vertex_gap(o, 0.0, edge);
    assert_int_equal(gap.vertex, -1);
    assert_true(gap.distance == (double)INFINITY);
}

TEST(a_vertex_pokes_an_edge_from_the_front_or_from_behind)
{
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0);
    obstacle_edge edge = edge_between(-1.0, 0.25, 3.0, 0.25);
    obstacle_vertex_gap gap = obstacles_vertex_gap(&o, 0.0, &edge);
    assert_int_equal(gap.vertex, 0);
    assert_close(gap.distance, 0.25, 1e-15);
    assert_close(gap.place, 0.25, 1e-15);
    assert_close(gap.normal.x, 0.0, 0.0);
    assert_close(gap.normal.y, 1.0, 0.0);
    edge = edge_between(-0.3, 0.2, 0.3, -0.6); /* falls 4 on 3: its normal is (0.8, 0.6) */
    gap = obstacles_vertex_gap(&o, 0.0, &edge);
    assert_close(gap.distance, -0.12, 1e-15);
    assert_close(gap.place, 0.34, 1e-15);
    assert_close(gap.normal.x, 0.8, 1e-15);
    assert_close(gap.normal.y, 0.6, 1e-15);
}

TEST(a_vertex_beside_an_edge_or_out_of_its_range_or_on_its_back_has_no_gap)
{
    CLEANUP(obstacles_free) obstacle_set o = compile(valley, 4, 0.0);
    obstacle_edge edge = edge_between(0.125, 0.25, 1.0, 0.25);
    assert_no_gap(&o, &edge);
    edge.tolerance = 0.125;
    assert_close(obstacles_vertex_gap(&o, 0.0, &edge).place, 0.0, 0.0);
    edge = edge_between(-1.0, 0.25, -0.125, 0.25);
    assert_no_gap(&o, &edge);
    edge.tolerance = 0.125;
    assert_close(obstacles_vertex_gap(&o, 0.0, &edge).place, 1.0, 0.0);
    edge = edge_between(-1.0, 0.5, 1.0, 0.5);
    assert_no_gap(&o, &edge); /* as far as the reach */
    edge = edge_between(-1.0, -0.5, 1.0, -0.5);
    assert_no_gap(&o, &edge); /* as far as the depth */
    edge = edge_between(1.0, 0.25, -1.0, 0.25);
    assert_no_gap(&o, &edge); /* the corner points out of this body */
    edge = edge_between(-1.0, 0.25, -1.0, 0.25);
    assert_no_gap(&o, &edge); /* no length */
    obstacles_free(&o);
    o = compile(block, 5, 0.0);
    edge = edge_between(4.75, 1.25, 5.25, 0.75);
    assert_no_gap(&o, &edge); /* the corner points along the edge */
}

/* Teeth whose tips are at y = 0, but the fifth which is 0.125 m lower and the ninth 0.125 m higher. */
TEST(of_several_vertices_the_deepest_pokes_and_of_equals_the_first)
{
    enum { n = 25 };
    double points[2 * n];
    for (int k = 0; k < n; k++)
        vec2_put(points, k, (vec2){k, k % 2 == 0 ? -1.0 : (k == 9 ? -0.125 : (k == 17 ? 0.125 : 0.0))});
    CLEANUP(obstacles_free) obstacle_set o = compile(points, n, 0.0);
    obstacle_edge edge = edge_between(0.0, 0.25, 24.0, 0.25);
    assert_int_equal(o.n_vertices, 12);
    assert_int_equal(obstacles_vertex_gap(&o, 0.0, &edge).vertex, 8);
    edge.except[1] = 8;
    assert_int_equal(obstacles_vertex_gap(&o, 0.0, &edge).vertex, 0);
    edge.except[0] = 0;
    assert_int_equal(obstacles_vertex_gap(&o, 0.0, &edge).vertex, 1);
    edge = edge_between(6.5, 0.25, 15.5, 0.25);
    assert_int_equal(obstacles_vertex_gap(&o, 0.0, &edge).vertex, 3);
    edge = edge_between(6.5, -0.25, 15.5, -0.25);
    assert_close(obstacles_vertex_gap(&o, 0.0, &edge).distance, -0.25, 1e-15);
    edge.without[1] = 0;
    assert_no_gap(&o, &edge);
    edge.without[0] = 0;
    edge.without[1] = -1;
    assert_no_gap(&o, &edge);
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

static obstacle_vertex_gap gap_by_loop(const obstacle_set *o, const obstacle_edge *edge)
{
    const vec2 way = vec2_sub(edge->b, edge->a);
    const double length = vec2_norm(way);
    const vec2 tangent = vec2_scale(1.0 / length, way), normal = {-tangent.y, tangent.x};
    obstacle_vertex_gap first = {(double)INFINITY, -1, 0.0, normal};
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
        first = (obstacle_vertex_gap){distance, k, fmin(fmax(place / length, 0.0), 1.0), normal};
    }
    return first;
}

/* Edges between telling points: many pass exactly through vertices, end on their foot, or lie along segments. */
TEST(the_tree_finds_the_vertex_that_a_loop_finds_to_the_bit)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_gaps = 0;
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
            const obstacle_vertex_gap gap = obstacles_vertex_gap(&l.set, 0.0, &edge),
                                      expected = gap_by_loop(&l.set, &edge);
            assert_int_equal(gap.vertex, expected.vertex);
            assert_true(gap.distance == expected.distance && gap.place == expected.place);
            n_gaps += gap.vertex >= 0;
        }
        obstacles_free(&l.set);
    }
    assert_true(n_gaps > 5000 && n_gaps < 35000);
}

/* 1e-14: rounding of coordinates of order 10 m. */
TEST(what_moves_is_met_where_it_is)
{
    const vec2 velocity = {-3.0, -0.5};
    const double t = 1.25;
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_of_valley = 0, n_of_block = 0;
    CLEANUP(obstacles_free) obstacle_set moving = compile_moving(velocity, (vec2){0.0, 0.0});
    CLEANUP(obstacles_free) obstacle_set there = compile_moving((vec2){0.0, 0.0}, vec2_scale(t, velocity));
    for (int k = 0; k < 4000; k++) {
        const double x = uniform(rng, -3.0, 4.0), y = uniform(rng, -1.5, 1.5);
        obstacle_edge edge = edge_between(x, y, x + uniform(rng, -1.0, 1.0), y + uniform(rng, -1.0, 1.0));
        edge.previous = (vec2){x, y + 1.0};
        edge.next = vec2_add(edge.b, (vec2){0.3, 1.0});
        const obstacle_vertex_gap a = obstacles_vertex_gap(&moving, t, &edge),
                                  b = obstacles_vertex_gap(&there, 0.0, &edge);
        assert_int_equal(a.vertex, b.vertex);
        if (a.vertex >= 0) assert_close(a.distance, b.distance, 1e-14);
        assert_close(a.place, b.place, 1e-12);
        assert_close(vec2_norm(vec2_sub(a.normal, b.normal)), 0.0, 1e-14);
        assert_close(obstacles_clearance(&moving, t, &edge), obstacles_clearance(&there, 0.0, &edge), 1e-14);
        n_of_valley += a.vertex == 0;
        n_of_block += a.vertex > 0;
    }
    assert_true(n_of_valley > 50 && n_of_block > 50);
}
