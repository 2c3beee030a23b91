/* SPDX-License-Identifier: BSD-3-Clause */
/* dense_output.c: the quintic through both ends of a step, and its derivative, in two and in three dimensions. */
#include "verification/support.h"

#include <string.h>

#include "time/dense_output.h"

enum { n_nodes = 2, n_state = 2 * STATE_DIM_MOST * n_nodes };

/* A motion of two nodes: position, velocity and acceleration of coordinate k. */
typedef struct known_motion {
    double (*x)(int k, double t), (*v)(int k, double t), (*a)(int k, double t);
} known_motion;

typedef struct step {
    double y0[n_state], f0[n_state], y1[n_state], f1[n_state];
    dense_output dense;
} step;

static void sample(const known_motion *m, int n, double t, double *y, double *f)
{
    for (int k = 0; k < n; k++) {
        y[k] = m->x(k, t);
        y[n + k] = f[k] = m->v(k, t);
        f[n + k] = m->a(k, t);
    }
}

static void make_step(step *s, int dim, const known_motion *m, double t0, double t1)
{
    sample(m, dim * n_nodes, t0, s->y0, s->f0);
    sample(m, dim * n_nodes, t1, s->y1, s->f1);
    s->dense = (dense_output){
        {.dim = dim, .n_nodes = n_nodes, .n_rows = n_nodes}, t0, t1, t1, s->y0, s->f0, s->y1, s->f1, false, NULL};
}

/* Polynomials of degree 5 in t, other ones for each coordinate. */
static double quintic_x(int k, double t)
{
    const double c = 1.0 + k;
    return c - 2.0 * t + t * t * (3.0 - c * t + t * t * (0.5 * c - 1.5 * t));
}

static double quintic_v(int k, double t)
{
    const double c = 1.0 + k;
    return -2.0 + t * (6.0 - 3.0 * c * t + t * t * (2.0 * c - 7.5 * t));
}

static double quintic_a(int k, double t)
{
    const double c = 1.0 + k;
    return 6.0 - 6.0 * c * t + t * t * (6.0 * c - 30.0 * t);
}

static const known_motion quintic = {quintic_x, quintic_v, quintic_a};

static double swing_x(int k, double t)
{
    return (1.0 + k) * sin(t + 0.3 * k);
}

static double swing_v(int k, double t)
{
    return (1.0 + k) * cos(t + 0.3 * k);
}

static double swing_a(int k, double t)
{
    return -swing_x(k, t);
}

static const known_motion swing = {swing_x, swing_v, swing_a};

/* ---- tests ---- */

/* Position and velocity of a node. */
typedef struct node_motion {
    double x[STATE_DIM_MOST], v[STATE_DIM_MOST];
} node_motion;

static node_motion motion_at(const dense_output *p, double t, dem_index i)
{
    node_motion m;
    dense_output_position(p, t, i, m.x);
    dense_output_velocity(p, t, i, m.v);
    return m;
}

/* That a node's motion is that in a state to the bit. */
static void same_motion(const node_motion *m, const dense_output *p, const double *y, dem_index i)
{
    const size_t size = (size_t)p->layout.dim * sizeof *y;
    assert_memory_equal(m->x, state_x(&p->layout, y, i), size);
    assert_memory_equal(m->v, state_v(&p->layout, y, i), size);
}

/* Ends that no interpolation would reproduce: positions and velocities have nothing to do with each other. */
TEST(the_ends_are_the_states_to_the_bit)
{
    for (int q = 1; q <= 20; q++) {
        step s;
        double y[n_state];
        const int dim = 2 + q % 2;
        const size_t size = 2 * (size_t)(dim * n_nodes) * sizeof *y;
        make_step(&s, dim, &swing, 0.1 * q, 0.1 * q + 1.0 / (2.0 + q));
        for (int k = 0; k < 2 * dim * n_nodes; k++) s.y1[k] += 1.0 / (3.0 + k);
        dense_output_state(&s.dense, s.dense.t0, y);
        assert_memory_equal(y, s.y0, size);
        dense_output_state(&s.dense, s.dense.t1, y);
        assert_memory_equal(y, s.y1, size);
        for (dem_index i = 0; i < n_nodes; i++) {
            const node_motion first = motion_at(&s.dense, s.dense.t0, i), last = motion_at(&s.dense, s.dense.t1, i);
            same_motion(&first, &s.dense, s.y0, i);
            same_motion(&last, &s.dense, s.y1, i);
        }
    }
}

/* With quintics and with parabolas, in two and in three dimensions, at the ends and between them. */
TEST(positions_of_a_list_are_those_of_its_nodes_to_the_bit)
{
    const int32_t list[n_nodes] = {1, 0};
    for (int q = 0; q < 4; q++) {
        step s;
        const int dim = 2 + q % 2;
        make_step(&s, dim, &swing, 0.4, 0.9);
        s.dense.parabolic = q >= 2;
        for (int k = 0; k <= 10; k++) {
            const double t = k == 10 ? s.dense.t1 : s.dense.t0 + 0.05 * k;
            double x[STATE_DIM_MOST * n_nodes], one[STATE_DIM_MOST];
            dense_output_put_positions(&s.dense, t, list, n_nodes, x);
            for (dem_index i = 0; i < n_nodes; i++) {
                dense_output_position(&s.dense, t, i, one);
                assert_memory_equal(x + dim * i, one, (size_t)dim * sizeof *one);
            }
        }
    }
}

/* Rounding of a dozen terms of order 10. */
/* At both ends, inside, and where an event has changed the motion of a node. */
TEST(nodes_of_a_list_have_their_positions_and_velocities_to_the_bit)
{
    const dem_index list[n_nodes] = {1, 0};
    for (int turn = 0; turn < 8; turn++) {
        step s;
        CLEANUP(changed_motion_destroy) changed_motion changed;
        motion_polynomial *way;
        double x[STATE_DIM_MOST * n_nodes], v[STATE_DIM_MOST * n_nodes];
        const int dim = 2 + turn / 4;
        make_step(&s, dim, &swing, 1.0, 1.5);
        s.dense.parabolic = turn % 2 == 1;
        assert_ok(changed_motion_create(&changed, &s.dense.layout));
        changed_motion_start(&changed, 1.5, s.y1, s.f1);
        s.dense.changed = &changed;
        if (turn % 4 >= 2) {
            assert_ok(changed_motion_take(&changed, 1, &way));
            *way = (motion_polynomial){.from = 1.0, .dim = dim, .x = {{0.5, 0.25, 2.0}, {1.0, -1.0, 3.0}}};
        }
        for (double t = 1.0; t <= 1.5; t += 0.125) {
            dense_output_put_nodes(&s.dense, t, n_nodes, list, x, v);
            for (int j = 0; j < n_nodes; j++) {
                const node_motion m = motion_at(&s.dense, t, list[j]);
                assert_memory_equal(x + dim * j, m.x, (size_t)dim * sizeof *x);
                assert_memory_equal(v + dim * j, m.v, (size_t)dim * sizeof *v);
            }
        }
    }
}

TEST(motions_of_degree_5_are_exact_with_their_velocities)
{
    const double starts[3] = {0.0, -0.7, 0.9}, lengths[3] = {1.0, 1.3, 0.25};
    for (int q = 0; q < 6; q++) {
        step s;
        const int dim = 2 + q / 3;
        make_step(&s, dim, &quintic, starts[q % 3], starts[q % 3] + lengths[q % 3]);
        for (double share = 0.05; share < 1.0; share += 0.1) {
            const double t = starts[q % 3] + share * lengths[q % 3];
            for (int k = 0; k < dim * n_nodes; k++) {
                const node_motion m = motion_at(&s.dense, t, k / dim);
                assert_close(m.x[k % dim], quintic_x(k, t), 2e-14);
                assert_close(m.v[k % dim], quintic_v(k, t), 2e-13);
            }
        }
    }
}

/* In powers of s, from the start on: rounding of six terms of order 10. */
TEST(the_motion_of_a_node_is_the_same_as_a_polynomial)
{
    for (int q = 0; q < 4; q++) {
        step s;
        motion_polynomial m;
        const int dim = 2 + q / 2;
        make_step(&s, dim, &swing, 0.5, 1.75);
        s.dense.parabolic = q % 2 == 1;
        dense_output_motions(&s.dense, 1, &(dem_index){1}, &m);
        assert_int_equal(m.dim, dim);
        assert_close(m.from, 0.5, 0.0);
        for (double share = 0.05; share < 1.0; share += 0.1) {
            const node_motion expected = motion_at(&s.dense, 0.5 + 1.25 * share, 1);
            node_motion found;
            motion_polynomial_position(&m, share, found.x);
            motion_polynomial_velocity(&m, share, found.v);
            for (int d = 0; d < dim; d++) {
                assert_close(found.x[d], expected.x[d], 2e-14);
                assert_close(found.v[d], expected.v[d], 1e-13);
            }
        }
    }
}

/* The Bezier curve of control points [n][dim], summed up by Bernstein's polynomials, which are not negative and have
 * the sum 1: it is in the hull of the points. */
static double bezier(const double *control, int n, int dim, int d, double s)
{
    double sum = 0.0, binomial = 1.0;
    for (int k = 0; k < n; k++) {
        sum += binomial * pow(s, k) * pow(1.0 - s, n - 1 - k) * control[dim * k + d];
        binomial *= (double)(n - 1 - k) / (k + 1);
    }
    return sum;
}

/* Of steps, and of motions that an event has changed: terms of order 10. */
TEST(a_node_stays_in_its_hull_whose_points_make_its_motion)
{
    for (int q = 0; q < 8; q++) {
        step s;
        CLEANUP(changed_motion_destroy) changed_motion changed;
        motion_polynomial *way;
        double hull[DENSE_OUTPUT_HULL * STATE_DIM_MOST];
        const int dim = 2 + q / 4;
        make_step(&s, dim, &swing, 0.5, 1.75);
        s.dense.parabolic = q % 2 == 1;
        assert_ok(changed_motion_create(&changed, &s.dense.layout));
        changed_motion_start(&changed, 1.75, s.y1, s.f1);
        const double from = q % 4 < 2 ? 0.5 : 1.0;
        if (q % 4 >= 2) {
            motion_polynomial m;
            dense_output_motions(&s.dense, 1, &(dem_index){1}, &m);
            motion_polynomial_restart(&m, from, 1.75);
            assert_ok(changed_motion_take(&changed, 1, &way));
            motion_polynomial_copy(way, &m);
        }
        s.dense.changed = &changed;
        const int n = dense_output_hull(&s.dense, 1, hull);
        assert_int_equal(n, s.dense.parabolic ? 3 : 6);
        for (double share = 0.0; share <= 1.0; share += 0.125) {
            const node_motion expected = motion_at(&s.dense, from + (1.75 - from) * share, 1);
            for (int d = 0; d < dim; d++) assert_close(bezier(hull, n, dim, d, share), expected.x[d], 2e-14);
        }
    }
}

/* Largest errors over a step of length h from t = 0.4. */
static void errors_of_swing(double h, double *position, double *velocity)
{
    step s;
    make_step(&s, 3, &swing, 0.4, 0.4 + h);
    *position = *velocity = 0.0;
    for (double share = 0.01; share < 1.0; share += 0.01) {
        const double t = 0.4 + share * h;
        const node_motion m = motion_at(&s.dense, t, 0);
        for (int d = 0; d < 3; d++) {
            *position = fmax(*position, fabs(m.x[d] - swing_x(d, t)));
            *velocity = fmax(*velocity, fabs(m.v[d] - swing_v(d, t)));
        }
    }
}

/* Hermite's remainder: x'''''' s^3 (1 - s)^3 h^6/720, at most 4/46080 h^6; its order is 6, of the velocities 5. */
TEST(other_motions_are_interpolated_to_sixth_order)
{
    double x[2], v[2];
    errors_of_swing(0.4, &x[0], &v[0]);
    errors_of_swing(0.2, &x[1], &v[1]);
    assert_true(x[0] <= 4.0 / 46080.0 * pow(0.4, 6.0));
    assert_close(log2(x[0] / x[1]), 6.0, 0.2);
    assert_close(log2(v[0] / v[1]), 5.0, 0.2);
}

TEST(the_whole_state_is_made_of_the_same_numbers_to_the_bit)
{
    step s;
    double y[n_state];
    for (int q = 0; q < 4; q++) {
        make_step(&s, 2 + q / 2, &swing, 1.0, 1.37);
        s.dense.parabolic = q % 2 == 1;
        for (double t = 1.01; t < 1.37; t += 0.1) {
            dense_output_state(&s.dense, t, y);
            for (dem_index i = 0; i < n_nodes; i++) {
                const node_motion m = motion_at(&s.dense, t, i);
                same_motion(&m, &s.dense, y, i);
            }
        }
    }
}

/* One unit of rounding of t inside either end: the state differs by that time's motion and by rounding. */
TEST(it_is_continuous_at_its_ends)
{
    step s;
    make_step(&s, 3, &swing, 1.0, 1.5);
    const double first = nextafter(1.0, 2.0), last = nextafter(1.5, 1.0);
    for (dem_index i = 0; i < n_nodes; i++) {
        const node_motion m0 = motion_at(&s.dense, first, i), m1 = motion_at(&s.dense, last, i);
        for (int d = 0; d < 3; d++) {
            assert_close(m0.x[d], state_x(&s.dense.layout, s.y0, i)[d], 3e-15);
            assert_close(m1.x[d], state_x(&s.dense.layout, s.y1, i)[d], 3e-15);
            assert_close(m0.v[d], state_v(&s.dense.layout, s.y0, i)[d], 3e-15);
            assert_close(m1.v[d], state_v(&s.dense.layout, s.y1, i)[d], 3e-15);
        }
    }
}

/* The positions' rounding of 1e-16 m over a step of 1e-15 to 1e-9 s would be a velocity of 0.1 m/s down to 1e-7 m/s.
 * What is left is the change of the velocity over the step, 4 m/s^2 times h, and its rounding. */
TEST(rounding_of_the_positions_does_not_show_in_the_velocity_of_a_tiny_step)
{
    for (double h = 1e-15; h < 1e-8; h *= 10.0) {
        step s;
        make_step(&s, 2, &swing, 0.7, 0.7 + h);
        for (double share = 0.1; share < 1.0; share += 0.2)
            for (int i = 0; i < n_nodes; i++) {
                const double t = 0.7 + share * h;
                assert_close(motion_at(&s.dense, t, i).v[0], swing_v(2 * i, 0.7), 4.0 * h + 1e-15);
                assert_close(motion_at(&s.dense, t, i).x[0], swing_x(2 * i, 0.7), 4.0 * h + 1e-15);
            }
    }
}

/* A displacement that the velocities do not explain is followed: at rest at both ends, 0.1 m apart. */
TEST(a_displacement_beyond_rounding_is_followed)
{
    double y0[4] = {1.0, 2.0, 0.0, 0.0}, y1[4] = {1.1, 2.0, 0.0, 0.0}, f[4] = {0.0, 0.0, 0.0, 0.0};
    const dense_output p = {{.dim = 2, .n_nodes = 1, .n_rows = 1}, 0.0, 2.0, 2.0, y0, f, y1, f, false, NULL};
    assert_close(motion_at(&p, 1.0, 0).x[0], 1.05, 1e-15);
    assert_close(motion_at(&p, 1.0, 0).v[0], 0.1 * 30.0 / 16.0 / 2.0, 1e-15); /* B'(1/2) = 30/16 over h */
    assert_close(motion_at(&p, 1.0, 0).x[1], 2.0, 0.0);
    assert_close(motion_at(&p, 1.0, 0).v[1], 0.0, 0.0);
}

/* From 1 with velocity 3 to 2, and from 3 m/s with 4 m/s^2 to 5 m/s, in 2 s: accelerations at the end do not count. */
TEST(a_parabolic_output_matches_what_a_method_of_order_2_knows)
{
    double y0[4] = {1.0, 0.0, 3.0, 0.0}, y1[4] = {2.0, 0.0, 5.0, 0.0}, f0[4] = {3.0, 0.0, 4.0, 0.0};
    double f1[4] = {5.0, 0.0, 99.0, 0.0}, y[4];
    const dense_output p = {{.dim = 2, .n_nodes = 1, .n_rows = 1}, 0.0, 2.0, 2.0, y0, f0, y1, f1, true, NULL};
    assert_close(motion_at(&p, 1.0, 0).x[0], 1.0 + 3.0 - 1.25, 1e-15);
    assert_close(motion_at(&p, 1.0, 0).v[0], 3.0 + 4.0 - 1.5, 1e-15);
    assert_close((motion_at(&p, 1e-6, 0).x[0] - 1.0) / 1e-6, 3.0, 1e-5);
    assert_close((motion_at(&p, 1e-6, 0).v[0] - 3.0) / 1e-6, 4.0, 1e-5);
    for (int end = 0; end < 2; end++) {
        dense_output_state(&p, 2.0 * end, y);
        assert_memory_equal(y, end ? y1 : y0, sizeof y);
    }
    dense_output_state(&p, 0.5, y);
    assert_close(y[0], motion_at(&p, 0.5, 0).x[0], 0.0);
    assert_close(y[2], motion_at(&p, 0.5, 0).v[0], 0.0);
}
