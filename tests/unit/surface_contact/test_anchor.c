/* SPDX-License-Identifier: BSD-3-Clause */
/* anchor.c: the friction of one pair against differences of the spring's energy, both momenta, its limit, the order of
 * the way that it measures, what a step changes. */
#include "surface_contact/anchor.h"

#include <string.h>

#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>

#include "../close.h"
#include "harness/cleanup_gsl.h"

enum { N = 2 * CONTACT_PAIR_NODES };

/* The node, A, B, and the node before A. */
static const contact_pair pair = {.nodes = {0, 1, 2, 3}, .thickness = 1.0, .weight = 1.0};

static double draw(gsl_rng *rng, double from, double to)
{
    return from + (to - from) * gsl_rng_uniform(rng);
}

/* Edges at a convex vertex, and a node that one of them pushes or the vertex, with its anchor. */
static anchor draw_anchor(gsl_rng *rng, double *x, contact_push *push)
{
    do {
        for (int c = 0; c < N; c++) x[c] = draw(rng, -0.3, 0.3);
        x[2 * CONTACT_PAIR_SECOND] += 2.0;
        x[2 * CONTACT_PAIR_BEFORE] -= 2.0;
        x[2 * CONTACT_PAIR_BEFORE + 1] += 2.0;
        x[2 * CONTACT_PAIR_NODE] += draw(rng, -0.3, 1.5);
        x[2 * CONTACT_PAIR_NODE + 1] -= 0.6;
    } while (!contact_pair_push(&pair, x, push) || vec2_norm(contact_push_on(push, 0)) < 0.01);
    anchor a = {.nodes = {0, 1, 2}, .stiffness = draw(rng, 0.5, 2.0), .friction = 0.3};
    anchor_put(&a, contact_push_on(push, CONTACT_PAIR_NODE), draw(rng, -0.5, 0.5), x);
    return a;
}

static double energy_at(const anchor *a, const double *x)
{
    contact_push push;
    (void)contact_pair_push(&pair, x, &push);
    return anchor_energy(a, contact_push_on(&push, CONTACT_PAIR_NODE), x);
}

static void friction_at(const anchor *a, const double *x, vec2 out[ANCHOR_NODES])
{
    contact_push push;
    (void)contact_pair_push(&pair, x, &push);
    anchor_turn_push(&push, anchor_ratio(a, contact_push_on(&push, CONTACT_PAIR_NODE), x), x, out);
}

/* After the last step, and far from the limit. Differences of fourth order leave out h^4 times fifth derivatives. */
TEST(friction_that_holds_is_minus_the_gradient_of_its_energy)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int n_by_vertex = 0;
    for (int k = 0; k < 1000; k++) {
        double x[N];
        contact_push push;
        vec2 friction[ANCHOR_NODES];
        anchor a = draw_anchor(rng, x, &push);
        a.friction = 1e9;
        n_by_vertex += vec2_norm(push.by_vertex) > 0.0;
        friction_at(&a, x, friction);
        for (int c = 0; c < 2 * ANCHOR_NODES; c++) {
            const double h = 1e-4, here = x[c], steps[4] = {h, -h, 2.0 * h, -2.0 * h};
            double energy[4];
            for (int s = 0; s < 4; s++) {
                x[c] = here + steps[s];
                energy[s] = energy_at(&a, x);
            }
            x[c] = here;
            const double found = c % 2 == 0 ? friction[c / 2].x : friction[c / 2].y;
            assert_close(found, -(8.0 * (energy[0] - energy[1]) - (energy[2] - energy[3])) / (12.0 * h), 1e-7);
        }
    }
    assert_true(n_by_vertex > 100 && n_by_vertex < 900);
}

/* Both momenta, whether the spring holds or slides: to the rounding of forces and places of some units. */
TEST(forces_and_moments_sum_up_to_nothing)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < 1000; k++) {
        double x[N], moment = 0.0;
        contact_push push;
        vec2 sum = {0.0, 0.0}, friction[ANCHOR_NODES];
        const anchor a = draw_anchor(rng, x, &push);
        friction_at(&a, x, friction);
        for (int which = 0; which < ANCHOR_NODES; which++) {
            sum = vec2_add(sum, friction[which]);
            moment += vec2_cross(vec2_at(x, which), friction[which]);
        }
        const double size = 1.0 + vec2_norm(friction[CONTACT_PAIR_NODE]);
        assert_close(vec2_norm(sum), 0.0, 1e-15 * size);
        assert_close(moment, 0.0, 1e-14 * size);
    }
}

/* An edge of 2 m along x, with its front below, and a node there 0.3 m ahead of where it was. */
static const double level[N] = {1.3, -0.1, 0.0, 0.0, 2.0, 0.0}, before[N] = {1.0, -0.1, 0.0, 0.0, 2.0, 0.0};

static anchor at_rest(void)
{
    anchor a = {.nodes = {0, 1, 2}, .stiffness = 10.0, .friction = 0.5};
    anchor_put(&a, (vec2){0.0, -1.0}, 0.0, before);
    return a;
}

TEST(the_force_is_that_of_the_spring_up_to_friction)
{
    const anchor a = at_rest();
    const vec2 large = {0.0, -100.0}, small = {0.0, -2.0};
    assert_close(anchor_shift(&a, large, level), 0.3, 1e-15);
    assert_close(anchor_ratio(&a, large, level), 0.03, 1e-15);
    assert_close(anchor_energy(&a, large, level), 0.45, 1e-14);
    assert_close(anchor_ratio(&a, small, level), 0.5, 0.0);
    assert_close(anchor_energy(&a, small, level), 0.05, 1e-16);
    assert_close(anchor_shift(&a, (vec2){0.0, 1.0}, level), 0.0, 0.0); /* it pushes the other way */
}

TEST(what_a_step_has_reached_changes_no_force)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < 1000; k++) {
        double x[N];
        contact_push push;
        anchor a = draw_anchor(rng, x, &push);
        const double last = x[0];
        x[0] += 0.01;
        if (!contact_pair_push(&pair, x, &push)) continue;
        const vec2 normal = contact_push_on(&push, CONTACT_PAIR_NODE);
        const double ratio = anchor_ratio(&a, normal, x);
        anchor_put(&a, normal, anchor_shift(&a, normal, x), x);
        assert_close(anchor_ratio(&a, normal, x), ratio, 1e-14);
        x[0] = last;
    }
}

TEST(the_point_is_the_foot_as_far_as_the_edge_goes)
{
    const double slanted[N] = {3.0, 4.0, 0.0, 0.0, 2.0, 2.0}; /* an edge of 45 degrees, and a node beyond its end */
    anchor a = at_rest();
    assert_close(a.weight, 0.5, 1e-15);
    assert_close(a.direction.x, 1.0, 0.0);
    assert_close(a.place.x, 0.0, 1e-15);
    assert_close(a.place.y, -0.1, 1e-15);
    assert_close(anchor_foot(&a, level), 0.65, 1e-15);
    assert_close(anchor_foot(&a, slanted), 1.75, 1e-15);
    anchor_put(&a, (vec2){1.0, 0.0}, 0.25, slanted);
    assert_close(a.weight, 1.0, 0.0);
    assert_close(vec2_norm(a.place), sqrt(5.0), 1e-15);
    assert_close(a.direction.x, sqrt(0.5), 1e-15); /* up, seen from the edge */
    assert_close(a.direction.y, sqrt(0.5), 1e-15);
    assert_close(anchor_shift(&a, (vec2){1.0, 0.0}, slanted), 0.25, 0.0);
}

/* A node goes half a turn round the end of the edge in n steps while its distance grows from 1 m to 2 m; the edge
 * turns, too. The way across is the integral of the distance over the angle, 1.5 pi m: four times better with twice the
 * steps. */
TEST(the_way_round_a_vertex_is_of_second_order)
{
    double off[2];
    for (int k = 0; k < 2; k++) {
        const int n = 20 << k;
        double x[N], shift = 0.0;
        anchor a = {.nodes = {0, 1, 2}, .stiffness = 1.0, .friction = 1e9};
        for (int step = 0; step <= n; step++) {
            const double part = (double)step / n, frame = part * part, angle = frame + M_PI * part;
            const vec2 normal = {-sin(angle), cos(angle)};
            vec2_put(x, CONTACT_PAIR_FIRST, (vec2){0.0, 0.0});
            vec2_put(x, CONTACT_PAIR_SECOND, (vec2){-sin(frame), cos(frame)});
            vec2_put(x, CONTACT_PAIR_NODE, vec2_scale(-1.0 - part, normal));
            if (step > 0) shift = anchor_shift(&a, normal, x);
            anchor_put(&a, normal, shift, x);
        }
        off[k] = fabs(fabs(shift) - 1.5 * M_PI);
    }
    assert_true(off[0] < 0.02 && off[0] > 3.8 * off[1] && off[0] < 4.2 * off[1]);
}

/* The bound is of k (g.u)^2 for any motion u. With the foot on the edge it is 2 k, 2 k (1 - w) and 2 k w. */
TEST(the_stiffness_is_bounded)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < 1000; k++) {
        double x[N], added[ANCHOR_NODES], work = 0.0, bound = 0.0;
        contact_push push;
        vec2 friction[ANCHOR_NODES];
        anchor a = draw_anchor(rng, x, &push);
        a.friction = 1e9;
        a.shift = 1.0; /* friction is k times the gradient then */
        friction_at(&a, x, friction);
        anchor_stiffness(&a, x, added);
        for (int which = 0; which < ANCHOR_NODES; which++) {
            const vec2 u = {draw(rng, -1.0, 1.0), draw(rng, -1.0, 1.0)};
            work += vec2_dot(friction[which], u);
            bound += added[which] * vec2_dot(u, u);
        }
        assert_true(work * work / a.stiffness <= bound * (1.0 + 1e-12));
    }
}
