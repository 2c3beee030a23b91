/* SPDX-License-Identifier: BSD-3-Clause */
/* contact_pair.c: forces against differences of the energy in every region of an edge and its vertex, momenta,
 * invariance, outlines as a whole, and crossings. */
#include "surface_contact/contact_pair.h"

#include <string.h>

#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>

#include "../close.h"
#include "harness/cleanup_gsl.h"
#include "surface_contact/contact_potential.h"

/* The node, A, B, Z and the node after B: numbered as in a pair. The thickness is 1 m and the weight 1 N. */
static const contact_pair pair = {.nodes = {0, 1, 2, 3, 4}, .thickness = 1.0, .weight = 1.0};

enum { N = 2 * CONTACT_PAIR_NODES };

static double draw(gsl_rng *rng, double from, double to)
{
    return from + (to - from) * gsl_rng_uniform(rng);
}

static vec2 unit_at(double angle)
{
    return (vec2){cos(angle), sin(angle)};
}

/* Edges 2 to 4 m long that meet at any angle but a fold, and a node within 1.3 m of their vertex. */
static void draw_nodes(gsl_rng *rng, double *x)
{
    const double way = draw(rng, -M_PI, M_PI), turn = draw(rng, -2.6, 2.6);
    const vec2 a = {draw(rng, -1.0, 1.0), draw(rng, -1.0, 1.0)};
    vec2_put(x, CONTACT_PAIR_FIRST, a);
    vec2_put(x, CONTACT_PAIR_SECOND, vec2_along(a, draw(rng, 2.0, 4.0), unit_at(way + turn)));
    vec2_put(x, CONTACT_PAIR_AFTER, vec2_along(vec2_at(x, CONTACT_PAIR_SECOND), 2.0, unit_at(way)));
    vec2_put(x, CONTACT_PAIR_BEFORE, vec2_along(a, -draw(rng, 2.0, 4.0), unit_at(way)));
    vec2_put(x, CONTACT_PAIR_NODE, vec2_along(a, 1.3 * sqrt(gsl_rng_uniform(rng)), unit_at(draw(rng, -M_PI, M_PI))));
}

/* Which terms push. A concave vertex is taken off only where its edge pushes. */
enum { NOTHING, BEHIND, EDGE, CONVEX, CONCAVE, SECOND, REGIONS };

static int region_of(const contact_pair *p, const double *x)
{
    contact_push push;
    const vec2 a = vec2_at(x, p->nodes[CONTACT_PAIR_FIRST]), b = vec2_at(x, p->nodes[CONTACT_PAIR_SECOND]);
    const vec2 r = vec2_sub(vec2_at(x, p->nodes[CONTACT_PAIR_NODE]), a), t = vec2_sub(b, a);
    if (!contact_pair_push(p, x, &push)) return vec2_norm(r) < 1.0 && vec2_cross(r, t) < 0.0 ? BEHIND : NOTHING;
    const double outward = vec2_dot(push.by_vertex, r);
    if (vec2_norm(push.by_second) > 0.0) return SECOND;
    return outward > 0.0 ? CONVEX : (outward < 0.0 ? CONCAVE : EDGE);
}

static double component(const contact_push *push, int c)
{
    const vec2 force = contact_push_on(push, c / 2);
    return c % 2 == 0 ? force.x : force.y;
}

/* Minus the slope of the energy by component c, by differences of fourth order; NAN where another region begins within
 * them. */
static double difference(const contact_pair *p, const double *x, int c)
{
    const double h = 1e-4, steps[4] = {h, -h, 2.0 * h, -2.0 * h};
    double moved[N], energy[4];
    memcpy(moved, x, sizeof moved);
    for (int k = 0; k < 4; k++) {
        moved[c] = x[c] + steps[k];
        energy[k] = contact_pair_energy(p, moved);
        if (region_of(p, moved) != region_of(p, x)) return (double)NAN;
    }
    return -(8.0 * (energy[0] - energy[1]) - (energy[2] - energy[3])) / (12.0 * h);
}

/* Draws until the node is no nearer than 0.1 m to the edge: below, differences lose their digits. */
static void draw_apart(gsl_rng *rng, double *x)
{
    do draw_nodes(rng, x);
    while (contact_pair_distance(vec2_at(x, 0), vec2_at(x, 1), vec2_at(x, 2)) < 0.1);
}

/* Turns the edge round, so that the node, which is near the first end, is near the second one. */
static void end_at_second(contact_pair *p, double *x)
{
    const vec2 first = vec2_at(x, CONTACT_PAIR_FIRST);
    vec2_put(x, CONTACT_PAIR_FIRST, vec2_at(x, CONTACT_PAIR_SECOND));
    vec2_put(x, CONTACT_PAIR_SECOND, first);
    p->ends_at_second = true;
}

/* Of every two pairs the surface ends at the second end of one: that is where the node is then. */
TEST(forces_are_minus_the_gradient_of_the_energy_in_every_region)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_of[REGIONS] = {0};
    for (int k = 0; k < 24000; k++) {
        double x[N];
        contact_pair p = pair;
        contact_push push;
        draw_apart(rng, x);
        if (k % 2 == 1) end_at_second(&p, x);
        (void)contact_pair_push(&p, x, &push);
        for (int c = 0; c < N; c++) {
            const double expected = difference(&p, x, c), actual = component(&push, c);
            if (!isnan(expected)) assert_close(actual, expected, 1e-8 * (1.0 + fabs(actual)));
        }
        n_of[region_of(&p, x)]++;
    }
    for (int region = 0; region < REGIONS; region++) assert_true(n_of[region] > 300);
}

/* Every force acts along the line from the foot to the node. What is left is the rounding of sums of terms as large as
 * the force times the distance from the origin, at most 6 m. */
TEST(a_pair_keeps_momentum_and_angular_momentum)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < 10000; k++) {
        double x[N], moment = 0.0;
        contact_push push;
        vec2 sum = {0.0, 0.0};
        contact_pair p = pair;
        draw_nodes(rng, x);
        if (k % 2 == 1) end_at_second(&p, x);
        (void)contact_pair_push(&p, x, &push);
        const double size = 3.0 * (vec2_norm(push.by_edge) + vec2_norm(push.by_vertex) + vec2_norm(push.by_second));
        for (int which = 0; which < CONTACT_PAIR_NODES; which++) {
            const vec2 force = contact_push_on(&push, which);
            sum = vec2_add(sum, force);
            moment += vec2_cross(vec2_at(x, which), force);
        }
        assert_close(vec2_norm(sum), 0.0, 1e-15 * size);
        assert_close(moment, 0.0, 6e-15 * size);
    }
}

/* ---- what fills a crack ---- */

/* A node in front of an edge, behind it and beyond its ends. */
static void draw_filling(gsl_rng *rng, double *x)
{
    const vec2 a = {draw(rng, -1.0, 1.0), draw(rng, -1.0, 1.0)};
    const vec2 t = vec2_scale(draw(rng, 0.8, 2.0), unit_at(draw(rng, -M_PI, M_PI)));
    const vec2 normal = vec2_scale(1.0 / vec2_norm(t), (vec2){t.y, -t.x});
    draw_nodes(rng, x);
    vec2_put(x, CONTACT_PAIR_FIRST, a);
    vec2_put(x, CONTACT_PAIR_SECOND, vec2_add(a, t));
    vec2_put(x, CONTACT_PAIR_NODE, vec2_along(vec2_along(a, draw(rng, -0.1, 1.1), t), draw(rng, -0.2, 1.2), normal));
}

/* Its slope jumps nowhere: differences of fourth order are exact to 24 h/L at the ends, T'' times their step, and to h
 * at the height where it begins to push. */
TEST(what_fills_a_crack_pushes_by_the_gradient_of_its_energy)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    contact_pair filling = pair;
    int n_pushing = 0;
    filling.fills = true;
    for (int k = 0; k < 10000; k++) {
        double x[N], moment = 0.0;
        contact_push push;
        vec2 sum = {0.0, 0.0};
        draw_filling(rng, x);
        n_pushing += contact_pair_push(&filling, x, &push);
        for (int c = 0; c < N; c++) {
            const double h = 1e-6;
            double moved[N], energy[2];
            memcpy(moved, x, sizeof moved);
            for (int side = 0; side < 2; side++) {
                moved[c] = x[c] + (side ? -h : h);
                energy[side] = contact_pair_energy(&filling, moved);
            }
            assert_close(component(&push, c), (energy[1] - energy[0]) / (2.0 * h), 40.0 * h);
        }
        for (int which = 0; which < CONTACT_PAIR_NODES; which++) {
            sum = vec2_add(sum, contact_push_on(&push, which));
            moment += vec2_cross(vec2_at(x, which), contact_push_on(&push, which));
        }
        assert_close(vec2_norm(sum), 0.0, 1e-14);
        assert_close(moment, 0.0, 1e-13);
    }
    assert_true(n_pushing > 5000);
}

/* Above the middle of its edge it is a triangle of the height 1 m under pressure. Its stiffness of 1 N/m is within the
 * bounds of it, and so are those beside the middle, by differences of the force. */
TEST(what_fills_a_crack_is_as_stiff_as_it_was)
{
    contact_pair filling = pair;
    contact_push push;
    double added[CONTACT_PAIR_PUSHED];
    filling.fills = true;
    for (double gap = -0.25; gap < 1.5; gap += 0.25) {
        const double x[N] = {0.5, -gap, 0.0, 0.0, 1.0, 0.0}, left = gap > 0.0 && gap < 1.0 ? 1.0 - gap : 0.0;
        assert_true(contact_pair_push(&filling, x, &push) == (left > 0.0));
        assert_close(contact_push_on(&push, CONTACT_PAIR_NODE).y, -left, 1e-15);
        assert_close(contact_push_on(&push, CONTACT_PAIR_FIRST).y, 0.5 * left, 1e-15);
        assert_close(contact_push_on(&push, CONTACT_PAIR_SECOND).x, 0.0, 1e-15);
        assert_close(contact_pair_energy(&filling, x), 0.5 * left * left, 1e-15);
        assert_true(contact_pair_stiffness(&filling, x, added) == (left > 0.0));
    }
    for (double s = 0.05; s < 1.0; s += 0.1)
        for (double gap = 0.1; gap < 1.0; gap += 0.1)
            for (int c = 0; c < 2; c++) {
                const double x[N] = {s, -gap, 0.0, 0.0, 1.0, 0.0}, h = 1e-5;
                contact_push after;
                double moved[N];
                memcpy(moved, x, sizeof moved);
                moved[c] += h;
                assert_true(contact_pair_push(&filling, x, &push) && contact_pair_stiffness(&filling, x, added));
                (void)contact_pair_push(&filling, moved, &after);
                assert_true(fabs(component(&after, c) - component(&push, c)) / h < added[CONTACT_PAIR_NODE]);
            }
}

static vec2 turned_by(vec2 turn, vec2 a)
{
    return (vec2){turn.x * a.x - turn.y * a.y, turn.y * a.x + turn.x * a.y};
}

/* A rounding of a place, 4e-16 m, changes a force at u = 0.1 by the stiffness of 100 N/m at most. */
TEST(forces_turn_with_the_nodes_and_do_not_depend_on_the_place)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < 10000; k++) {
        double x[N], moved[N];
        contact_push push, after;
        draw_apart(rng, x);
        const vec2 turn = unit_at(draw(rng, -M_PI, M_PI)), shift = {draw(rng, -1.0, 1.0), draw(rng, -1.0, 1.0)};
        for (int which = 0; which < CONTACT_PAIR_NODES; which++)
            vec2_put(moved, which, vec2_add(shift, turned_by(turn, vec2_at(x, which))));
        (void)contact_pair_push(&pair, x, &push);
        (void)contact_pair_push(&pair, moved, &after);
        for (int which = 0; which < CONTACT_PAIR_NODES; which++) {
            const vec2 expected = turned_by(turn, contact_push_on(&push, which)),
                       actual = contact_push_on(&after, which);
            assert_close(vec2_norm(vec2_sub(actual, expected)), 0.0, 1e-13);
        }
    }
}

/* The edge before the vertex never touches its own ends: at the same place another node is pushed. */
TEST(a_vertex_does_not_push_the_node_before_it)
{
    const double x[N] = {-0.3, -0.4, 0.0, 0.0, 3.0, 0.0, -0.3, -0.4};
    const contact_pair neighbour = {.nodes = {3, 1, 2, 3}, .thickness = 1.0, .weight = 1.0, .ends_at_first = true};
    const double other[N] = {-0.3, 0.1, 0.0, 0.0, 0.0, 3.0, -3.0, 0.0};
    contact_push push;
    assert_false(contact_pair_push(&neighbour, x, &push));
    assert_close(contact_pair_energy(&neighbour, x), 0.0, 0.0);
    assert_false(contact_pair_push(&pair, other, &push)); /* behind the edge */
}

/* ---- outlines ---- */

enum { CORNERS = 7 };

/* A star with a node between corners that go in and out, counter-clockwise; edges are longer than the thickness. */
typedef struct outline {
    double x[2 * (CORNERS + 1)]; /* the last one is the node */
    bool is_open;                /* whether the first edge never touches the node */
} outline;

static void draw_outline(gsl_rng *rng, outline *out)
{
    for (int k = 0; k < CORNERS; k++)
        vec2_put(out->x, k,
                 vec2_scale(draw(rng, 3.0, 6.0), unit_at(2.0 * M_PI * (k + draw(rng, -0.2, 0.2)) / CORNERS)));
}

static contact_pair pair_with(const outline *o, int edge)
{
    return (contact_pair){.nodes = {CORNERS, edge, (edge + 1) % CORNERS, (edge + CORNERS - 1) % CORNERS},
                          .thickness = 1.0,
                          .weight = 1.0,
                          .ends_at_first = o->is_open && edge == 1,
                          .ends_at_second = o->is_open && edge == CORNERS - 1};
}

static double energy_of(const outline *o)
{
    double sum = 0.0;
    for (int edge = o->is_open; edge < CORNERS; edge++) {
        const contact_pair of_edge = pair_with(o, edge);
        sum += contact_pair_energy(&of_edge, o->x);
    }
    return sum;
}

static vec2 force_of(const outline *o)
{
    vec2 sum = {0.0, 0.0};
    contact_push push;
    for (int edge = o->is_open; edge < CORNERS; edge++) {
        const contact_pair of_edge = pair_with(o, edge);
        if (contact_pair_push(&of_edge, o->x, &push)) sum = vec2_add(sum, contact_push_on(&push, CONTACT_PAIR_NODE));
    }
    return sum;
}

/* Distance of the node from the outline. */
static double gap_of(const outline *o)
{
    double gap = INFINITY;
    for (int k = 0; k < CORNERS; k++)
        gap = fmin(gap,
                   contact_pair_distance(vec2_at(o->x, CORNERS), vec2_at(o->x, k), vec2_at(o->x, (k + 1) % CORNERS)));
    return gap;
}

static void count_regions(const outline *o, int n_of[REGIONS])
{
    for (int edge = o->is_open; edge < CORNERS; edge++) {
        const contact_pair of_edge = pair_with(o, edge);
        n_of[region_of(&of_edge, o->x)]++;
    }
}

static vec2 innermost_corner(const outline *o)
{
    vec2 found = vec2_at(o->x, 0);
    for (int k = 1; k < CORNERS; k++)
        if (vec2_norm(vec2_at(o->x, k)) < vec2_norm(found)) found = vec2_at(o->x, k);
    return found;
}

/* On a way past the outline, no nearer than 0.2 m, the work of the force is the difference of energies, over all
 * borders between edges and vertices: a jump of the force or of the energy would show. The trapezoidal rule with
 * steps h is off by h^2/12 times the change of the slope of the force along the way. With h = 2 mm and slopes up to
 * 1/u^2 - 1 = 24 N/m this is 8e-6 J; found is as much. Every other way leads into the notch at the innermost corner.
 * Every third outline has an edge that never touches the node; the way leads to one of its ends. */
TEST(the_energy_is_the_work_on_any_way_along_an_outline)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_of[REGIONS] = {0};
    for (int k = 0; k < 200; k++) {
        outline o = {.is_open = k % 3 == 2};
        draw_outline(rng, &o);
        const vec2 past = vec2_scale(8.0, unit_at(draw(rng, -M_PI, M_PI)));
        const vec2 in = o.is_open ? vec2_at(o.x, k % 2) : innermost_corner(&o);
        const bool goes_in = o.is_open || k % 2 == 1;
        const double angle = !goes_in ? draw(rng, -M_PI, M_PI) : atan2(in.y, in.x) + draw(rng, -0.2, 0.2);
        const vec2 beside = vec2_along(in, draw(rng, 0.0, 1.0), unit_at(draw(rng, -M_PI, M_PI)));
        const vec2 start = vec2_scale(8.0, unit_at(angle)), end = goes_in ? beside : past;
        const double length = vec2_norm(vec2_sub(end, start));
        const int n = 1 + (int)(length / 2e-3);
        double before = 0.0, work = 0.0;
        vec2 force = {0.0, 0.0};
        for (int step = 0; step <= n; step++) {
            vec2_put(o.x, CORNERS, vec2_along(start, (double)step / n, vec2_sub(end, start)));
            if (gap_of(&o) < 0.2) break; /* the way goes into the body */
            const vec2 now = force_of(&o);
            work += 0.5 * vec2_dot(vec2_add(force, now), vec2_scale(step > 0 ? 1.0 / n : 0.0, vec2_sub(end, start)));
            force = now;
            assert_close(before - energy_of(&o), work, 1e-5);
            count_regions(&o, n_of);
        }
    }
    assert_true(n_of[EDGE] > 10000 && n_of[CONVEX] > 3000 && n_of[CONCAVE] > 300);
}

/* A notch of 40 degrees at the origin: Z, A, B, the node Y before Z, and the node. Where a node goes past the vertex in
 * the body, the line across an edge there, the edge begins to push with nothing. */
TEST(behind_an_edge_of_a_notch_the_other_one_does_not_push_at_once)
{
    const vec2 z = unit_at(0.0), t = unit_at(-140.0 * M_PI / 180.0);
    const contact_pair pairs[2] = {{.nodes = {4, 0, 1, 3}, .thickness = 1.0, .weight = 1.0},
                                   {.nodes = {4, 1, 2, 0}, .thickness = 1.0, .weight = 1.0}};
    const vec2 along[2] = {z, t}, front[2] = {{z.y, -z.x}, {t.y, -t.x}};
    for (int edge = 0; edge < 2; edge++) {
        double x[10] = {-3.0, 0.0, 0.0, 0.0, 3.0 * t.x, 3.0 * t.y, -3.0, 3.0}, last = 0.0, largest = 0.0;
        for (int k = -500; k <= 500; k++) {
            const double way = (edge == 0 ? -2e-4 : 2e-4) * k;
            vec2_put(x, 4, vec2_along(vec2_scale(0.5, front[edge]), way, along[edge]));
            const double energy = contact_pair_energy(&pairs[0], x) + contact_pair_energy(&pairs[1], x);
            assert_close(energy, last, 1e-4);
            last = energy;
            largest = fmax(largest, energy);
        }
        assert_true(largest > 1e-3);
    }
}

/* Beside a straight surface of two edges the potential is that of the distance, wherever the node is: also exactly in
 * front of the vertex, where two mirrored bodies have it. */
TEST(beside_a_straight_surface_the_force_is_that_of_the_distance)
{
    for (double along = -1.5; along <= 1.5; along += 0.0625) {
        const double x[8] = {along, -0.3, 0.0, 0.0, 3.0, 0.0, -3.0, 0.0};
        const contact_pair second = pair, first = {.nodes = {0, 3, 1, 3}, .thickness = 1.0, .weight = 1.0};
        contact_push a, b;
        (void)contact_pair_push(&first, x, &a);
        (void)contact_pair_push(&second, x, &b);
        const vec2 sum = vec2_add(contact_push_on(&a, 0), contact_push_on(&b, 0));
        assert_close(sum.x, 0.0, 0.0);
        assert_close(sum.y, -contact_potential_pressure(0.3), 1e-15);
    }
}

/* The same in other directions, where the vertex is straight but for rounding: the node is in front of it but for
 * rounding, and neither edge nor vertex may lose it, or have it twice. */
TEST(no_node_falls_between_two_edges_by_rounding)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < 20000; k++) {
        const vec2 along = unit_at(draw(rng, -M_PI, M_PI)), out = {along.y, -along.x};
        const vec2 at = {draw(rng, -1.0, 1.0), draw(rng, -1.0, 1.0)};
        double x[8];
        vec2_put(x, 0, vec2_along(vec2_along(at, 0.3, out), draw(rng, -2e-16, 2e-16), along));
        vec2_put(x, 1, at);
        vec2_put(x, 2, vec2_along(at, draw(rng, 2.0, 3.0), along));
        vec2_put(x, 3, vec2_along(at, -draw(rng, 2.0, 3.0), along));
        const contact_pair last = {.nodes = {0, 3, 1, 3}, .thickness = 1.0, .weight = 1.0};
        contact_push a, b;
        (void)contact_pair_push(&last, x, &a);
        (void)contact_pair_push(&pair, x, &b);
        const vec2 sum = vec2_add(contact_push_on(&a, 0), contact_push_on(&b, 0));
        assert_close(vec2_dot(sum, out), contact_potential_pressure(0.3), 1e-14); /* a rounding of places */
    }
}

/* ---- crossing ---- */

TEST(a_node_crosses_an_edge_where_the_straight_ways_meet)
{
    /* The edge from (0, 0) to (2, 0) rises by 1 m, the node falls by 3 m from 1 m above it: at a quarter of the way. */
    const double x0[N] = {0.5, 1.0, 0.0, 0.0, 2.0, 0.0, -2.0, 0.0}, x1[N] = {0.5, -2.0, 0.0, 1.0, 2.0, 1.0, -2.0, 1.0};
    const double beside[N] = {2.5, -2.0, 0.0, 1.0, 2.0, 1.0, -2.0, 1.0};
    double when;
    assert_true(contact_pair_crosses(&pair, x0, x1, &when));
    assert_close(when, 0.25, 1e-15);
    assert_false(contact_pair_crosses(&pair, x0, x0, &when));
    assert_false(contact_pair_crosses(&pair, x1, x1, &when));
    assert_true(contact_pair_crosses(&pair, x0, beside, &when)); /* before it has left it sideways */
    assert_true(contact_pair_crosses(&pair, x1, x0, &when));
}

/* Both ways that an edge may turn while a node goes by are seen; an independent search in steps of 1/4000 finds the
 * same, but for crossings near the ends of the edge or of the way. */
TEST(crossings_are_those_that_small_steps_find)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_crossings = 0;
    for (int k = 0; k < 2000; k++) {
        double x0[N], x1[N], when, found = -1.0, last = 0.0;
        draw_nodes(rng, x0);
        for (int c = 0; c < N; c++) x1[c] = x0[c] + draw(rng, -2.0, 2.0);
        bool is_near_an_end = false;
        for (int step = 0; step <= 4000 && found < 0.0; step++) {
            double x[N];
            for (int c = 0; c < N; c++) x[c] = x0[c] + step / 4000.0 * (x1[c] - x0[c]);
            const vec2 r = vec2_sub(vec2_at(x, 0), vec2_at(x, 1)), t = vec2_sub(vec2_at(x, 2), vec2_at(x, 1));
            const double side = vec2_cross(r, t), s = vec2_dot(r, t) / vec2_dot(t, t);
            if (step > 0 && side * last <= 0.0 && s > 0.0 && s < 1.0) found = step / 4000.0;
            if (fabs(side) < 0.02 && (fmin(fabs(s), fabs(s - 1.0)) < 0.01 || step > 3980)) is_near_an_end = true;
            last = side;
        }
        const bool crosses = contact_pair_crosses(&pair, x0, x1, &when);
        if (is_near_an_end) continue;
        assert_int_equal(crosses, found >= 0.0);
        if (crosses) assert_close(when, found, 1.1 / 4000.0);
        n_crossings += crosses;
    }
    assert_true(n_crossings > 300);
}
