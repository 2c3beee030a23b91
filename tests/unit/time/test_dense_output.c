/* SPDX-License-Identifier: BSD-3-Clause */
/* dense_output.c: the quintic through both ends of a step, and its derivative. */
#include "verification/support.h"

#include <string.h>

#include "time/dense_output.h"

enum { n_nodes = 2, n_state = 4 * n_nodes };

/* A motion of two nodes: value and derivatives of coordinate k. */
typedef struct ode_problem {
    double (*x)(int k, double t), (*v)(int k, double t), (*a)(int k, double t);
} ode_problem;

static const state_layout layout = {.dim = 2, .n_nodes = n_nodes, .n_rows = n_nodes};

typedef struct step {
    double y0[n_state], f0[n_state], y1[n_state], f1[n_state];
    dense_output path;
} step;

static void sample(const ode_problem *m, double t, double *y, double *f)
{
    for (int k = 0; k < 2 * n_nodes; k++) {
        y[k] = m->x(k, t);
        y[2 * n_nodes + k] = f[k] = m->v(k, t);
        f[2 * n_nodes + k] = m->a(k, t);
    }
}

static void make_step(step *s, const ode_problem *m, double t0, double t1)
{
    sample(m, t0, s->y0, s->f0);
    sample(m, t1, s->y1, s->f1);
    s->path = (dense_output){layout, t0, t1, t1, s->y0, s->f0, s->y1, s->f1, false, NULL};
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

static const ode_problem quintic = {quintic_x, quintic_v, quintic_a};

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

static const ode_problem swing = {swing_x, swing_v, swing_a};

/* ---- tests ---- */

/* Ends that no interpolation would reproduce: positions and velocities have nothing to do with each other. */
static void the_ends_are_the_states_to_the_bit(void **state)
{
    (void)state;
    for (int q = 1; q <= 10; q++) {
        step s;
        double y[n_state];
        make_step(&s, &swing, 0.1 * q, 0.1 * q + 1.0 / (2.0 + q));
        for (int k = 0; k < n_state; k++) s.y1[k] += 1.0 / (3.0 + k);
        dense_output_state(&s.path, s.path.t0, y);
        assert_memory_equal(y, s.y0, sizeof y);
        dense_output_state(&s.path, s.path.t1, y);
        assert_memory_equal(y, s.y1, sizeof y);
        for (dem_index i = 0; i < n_nodes; i++) {
            const vec2 x0 = dense_output_position(&s.path, s.path.t0, i),
                       x1 = dense_output_position(&s.path, s.path.t1, i);
            const vec2 v0 = dense_output_velocity(&s.path, s.path.t0, i),
                       v1 = dense_output_velocity(&s.path, s.path.t1, i);
            assert_memory_equal(&x0, &s.y0[2 * i], sizeof x0);
            assert_memory_equal(&x1, &s.y1[2 * i], sizeof x1);
            assert_memory_equal(&v0, &s.y0[2 * (n_nodes + i)], sizeof v0);
            assert_memory_equal(&v1, &s.y1[2 * (n_nodes + i)], sizeof v1);
        }
    }
}

/* Rounding of a dozen terms of order 10. */
static void motions_of_degree_5_are_exact_with_their_velocities(void **state)
{
    const double starts[3] = {0.0, -0.7, 0.9}, lengths[3] = {1.0, 1.3, 0.25};
    (void)state;
    for (int q = 0; q < 3; q++) {
        step s;
        make_step(&s, &quintic, starts[q], starts[q] + lengths[q]);
        for (double share = 0.05; share < 1.0; share += 0.1) {
            const double t = starts[q] + share * lengths[q];
            for (int i = 0; i < n_nodes; i++) {
                const vec2 x = dense_output_position(&s.path, t, i), v = dense_output_velocity(&s.path, t, i);
                assert_close(x.x, quintic_x(2 * i, t), 1e-14);
                assert_close(x.y, quintic_x(2 * i + 1, t), 1e-14);
                assert_close(v.x, quintic_v(2 * i, t), 1e-13);
                assert_close(v.y, quintic_v(2 * i + 1, t), 1e-13);
            }
        }
    }
}

/* Largest errors over a step of length h from t = 0.4. */
static void errors_of_swing(double h, double *position, double *velocity)
{
    step s;
    make_step(&s, &swing, 0.4, 0.4 + h);
    *position = *velocity = 0.0;
    for (double share = 0.01; share < 1.0; share += 0.01) {
        const double t = 0.4 + share * h;
        *position = fmax(*position, fabs(dense_output_position(&s.path, t, 1).y - swing_x(3, t)));
        *velocity = fmax(*velocity, fabs(dense_output_velocity(&s.path, t, 1).y - swing_v(3, t)));
    }
}

/* Hermite's remainder: x'''''' s^3 (1 - s)^3 h^6/720, at most 4/46080 h^6; its order is 6, of the velocities 5. */
static void other_motions_are_interpolated_to_sixth_order(void **state)
{
    double x[2], v[2];
    (void)state;
    errors_of_swing(0.4, &x[0], &v[0]);
    errors_of_swing(0.2, &x[1], &v[1]);
    assert_true(x[0] <= 4.0 / 46080.0 * pow(0.4, 6.0));
    assert_close(log2(x[0] / x[1]), 6.0, 0.2);
    assert_close(log2(v[0] / v[1]), 5.0, 0.2);
}

static void the_whole_state_is_made_of_the_same_numbers_to_the_bit(void **state)
{
    step s;
    double y[n_state];
    (void)state;
    make_step(&s, &swing, 1.0, 1.37);
    for (double t = 1.01; t < 1.37; t += 0.1) {
        dense_output_state(&s.path, t, y);
        for (dem_index i = 0; i < n_nodes; i++) {
            const vec2 x = dense_output_position(&s.path, t, i), v = dense_output_velocity(&s.path, t, i);
            assert_memory_equal(&x, &y[2 * i], sizeof x);
            assert_memory_equal(&v, &y[2 * (n_nodes + i)], sizeof v);
        }
    }
}

/* One unit of rounding of t inside either end: the state differs by that time's motion and by rounding. */
static void it_is_continuous_at_its_ends(void **state)
{
    step s;
    (void)state;
    make_step(&s, &swing, 1.0, 1.5);
    const double first = nextafter(1.0, 2.0), last = nextafter(1.5, 1.0);
    for (int i = 0; i < n_nodes; i++) {
        const vec2 x0 = dense_output_position(&s.path, first, i), x1 = dense_output_position(&s.path, last, i);
        const vec2 v0 = dense_output_velocity(&s.path, first, i), v1 = dense_output_velocity(&s.path, last, i);
        assert_close(x0.x, s.y0[2 * i], 2e-15);
        assert_close(x1.x, s.y1[2 * i], 2e-15);
        assert_close(v0.y, s.y0[2 * (n_nodes + i) + 1], 2e-15);
        assert_close(v1.y, s.y1[2 * (n_nodes + i) + 1], 2e-15);
    }
}

/* The positions' rounding of 1e-16 m over a step of 1e-15 to 1e-9 s would be a velocity of 0.1 m/s down to 1e-7 m/s.
 * What is left is the change of the velocity over the step, 4 m/s^2 times h, and its rounding. */
static void rounding_of_the_positions_does_not_show_in_the_velocity_of_a_tiny_step(void **state)
{
    (void)state;
    for (double h = 1e-15; h < 1e-8; h *= 10.0) {
        step s;
        make_step(&s, &swing, 0.7, 0.7 + h);
        for (double share = 0.1; share < 1.0; share += 0.2)
            for (int i = 0; i < n_nodes; i++) {
                const double t = 0.7 + share * h;
                assert_close(dense_output_velocity(&s.path, t, i).x, swing_v(2 * i, 0.7), 4.0 * h + 1e-15);
                assert_close(dense_output_position(&s.path, t, i).x, swing_x(2 * i, 0.7), 4.0 * h + 1e-15);
            }
    }
}

/* A displacement that the velocities do not explain is followed: at rest at both ends, 0.1 m apart. */
static void a_displacement_beyond_rounding_is_followed(void **state)
{
    double y0[4] = {1.0, 2.0, 0.0, 0.0}, y1[4] = {1.1, 2.0, 0.0, 0.0}, f[4] = {0.0, 0.0, 0.0, 0.0};
    const dense_output p = {{2, 1, 0, 0, 1}, 0.0, 2.0, 2.0, y0, f, y1, f, false, NULL};
    (void)state;
    assert_close(dense_output_position(&p, 1.0, 0).x, 1.05, 1e-15);
    assert_close(dense_output_velocity(&p, 1.0, 0).x, 0.1 * 30.0 / 16.0 / 2.0, 1e-15); /* B'(1/2) = 30/16 over h */
    assert_close(dense_output_position(&p, 1.0, 0).y, 2.0, 0.0);
    assert_close(dense_output_velocity(&p, 1.0, 0).y, 0.0, 0.0);
}

/* From 1 with velocity 3 to 2, and from 3 m/s with 4 m/s^2 to 5 m/s, in 2 s: accelerations at the end do not count. */
static void a_parabolic_path_matches_what_a_method_of_order_2_knows(void **state)
{
    double y0[4] = {1.0, 0.0, 3.0, 0.0}, y1[4] = {2.0, 0.0, 5.0, 0.0}, f0[4] = {3.0, 0.0, 4.0, 0.0};
    double f1[4] = {5.0, 0.0, 99.0, 0.0}, y[4];
    const dense_output p = {{2, 1, 0, 0, 1}, 0.0, 2.0, 2.0, y0, f0, y1, f1, true, NULL};
    (void)state;
    assert_close(dense_output_position(&p, 1.0, 0).x, 1.0 + 3.0 - 1.25, 1e-15);
    assert_close(dense_output_velocity(&p, 1.0, 0).x, 3.0 + 4.0 - 1.5, 1e-15);
    assert_close((dense_output_position(&p, 1e-6, 0).x - 1.0) / 1e-6, 3.0, 1e-5);
    assert_close((dense_output_velocity(&p, 1e-6, 0).x - 3.0) / 1e-6, 4.0, 1e-5);
    for (int end = 0; end < 2; end++) {
        dense_output_state(&p, 2.0 * end, y);
        assert_memory_equal(y, end ? y1 : y0, sizeof y);
    }
    dense_output_state(&p, 0.5, y);
    assert_close(y[0], dense_output_position(&p, 0.5, 0).x, 0.0);
    assert_close(y[2], dense_output_velocity(&p, 0.5, 0).x, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_ends_are_the_states_to_the_bit),
        cmocka_unit_test(motions_of_degree_5_are_exact_with_their_velocities),
        cmocka_unit_test(other_motions_are_interpolated_to_sixth_order),
        cmocka_unit_test(the_whole_state_is_made_of_the_same_numbers_to_the_bit),
        cmocka_unit_test(it_is_continuous_at_its_ends),
        cmocka_unit_test(rounding_of_the_positions_does_not_show_in_the_velocity_of_a_tiny_step),
        cmocka_unit_test(a_displacement_beyond_rounding_is_followed),
        cmocka_unit_test(a_parabolic_path_matches_what_a_method_of_order_2_knows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
