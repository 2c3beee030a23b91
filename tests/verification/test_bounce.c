/* SPDX-License-Identifier: BSD-3-Clause */
/* A point mass dropped on a floor (row e): impact times, the end of bouncing, rest. Exact values are closed forms.
 * With a penetration tolerance d of 1e-13 m an impact is late by d/|v_n| < 1e-11 s for the eight
 * impacts compared; 1e-9 s is the table's tolerance. */
#include <stdbool.h>

#include "harness/motion.h"
#include "support.h"

static const double g = 9.81, height = 1.0;
static const double floor_points[4] = {-1.0, 0.0, 1.0, 0.0};

static void drop(support_run *run, double restitution)
{
    const double x[2] = {0.0, height}, v[2] = {0.0, 0.0};
    support_point(run, 2.0, x, v, floor_points, 2, restitution);
}

/* Rest: hops below the position tolerance rtol spacing = 1e-12 m, that is rebounds below 4.4e-6 m/s, are cut off. */
static void check_rest(support_run *run, double eta, double t_star)
{
    const double rest_speed = sqrt(2.0 * g * 1e-12), cut_off = 2.0 * rest_speed / (g * (1.0 - eta));
    motion state = support_at(run, t_star + 1e-3);
    const dem_event last = run->impacts[run->n_impacts - 1];
    const dem_index n_impacts = run->n_impacts, n_events = ask_counts(run->simulation).events;
    assert_int_not_equal(last.state, DEM_CONTACT_FREE);
    assert_close(last.t, t_star, cut_off + 1e-7); /* d/|v_n| of all impacts: 1e-13/4e-6/(1 - eta) */
    for (double t = t_star + 0.1; t < t_star + 9.0; t += 0.7) {
        state = support_at(run, t);
        assert_close(state.x[1], 0.0, 1e-12);
        assert_close(state.v[1], 0.0, 0.0);
        assert_int_equal(state.n_contacts, 1);
        assert_close(state.contacts[0].force, 2.0 * g, 1e-12);
    }
    assert_int_equal(run->n_impacts, n_impacts);
    assert_int_equal(ask_counts(run->simulation).events, n_events);
    assert_int_equal(ask_counts(run->simulation).closings, 1);
    assert_int_equal(ask_counts(run->simulation).releases, 0);
}

static void check_bounces(double eta, const double times[8], double t_star)
{
    CLEANUP(support_close) support_run run;
    drop(&run, eta);
    for (int k = 0; k < 8; k++) {
        const double rebound = eta * sqrt(2.0 * g * height) * pow(eta, k);
        const motion state = support_at(&run, times[k] + rebound / g);
        assert_int_equal(run.n_impacts, k + 1);
        assert_close(run.impacts[k].t, times[k], 1e-9);
        assert_close(run.impacts[k].after[1], rebound, 1e-9);
        assert_int_equal(run.impacts[k].state, DEM_CONTACT_FREE);
        assert_close(state.x[1], height * pow(eta, 2 * (k + 1)), 1e-9); /* the apex */
        assert_close(state.v[1], 0.0, 1e-8);                            /* g times the tolerance of the time */
    }
    check_rest(&run, eta, t_star);
}

TEST(a_ball_of_restitution_one_half_follows_the_geometric_series_and_rests)
{
    static const double times[8] = {0.4515236409857309, 0.9030472819714618, 1.1288091024643272, 1.24169001271076,
                                    1.2981304678339762, 1.3263506953955846, 1.3404608091763885, 1.3475158660667905};
    check_bounces(0.5, times, 1.3545709229571927);
}

TEST(a_ball_of_restitution_three_tenths_follows_the_geometric_series_and_rests)
{
    static const double times[8] = {0.4515236409857309, 0.7224378255771695, 0.8037120809546011, 0.8280943575678305,
                                    0.8354090405517993, 0.83760344544699,   0.8382617669155471, 0.8384592633561143};
    check_bounces(0.3, times, 0.8385439046877861);
}

TEST(a_ball_of_restitution_four_fifths_follows_the_geometric_series_and_rests)
{
    static const double times[8] = {0.4515236409857309, 1.1739614665629003, 1.7519117270246358, 2.214271935394024,
                                    2.5841601020895353, 2.880070635445944,  3.116799062131071,  3.3061818034791726};
    check_bounces(0.8, times, 4.063712768871579);
}

TEST(a_ball_of_restitution_nine_tenths_follows_the_geometric_series_and_rests)
{
    static const double times[8] = {0.4515236409857309, 1.2642661947600464, 1.9957344931569305, 2.6540559617141257,
                                    3.2465452834156032, 3.779785672946931,  4.259702023525127,  4.691626739045502};
    check_bounces(0.9, times, 8.578949178728887);
}

/* Hundreds of bounces are left in the last 1e-3 of the time, which is one step: it is taken in parts of 50. */
TEST(a_ball_that_bounces_hundreds_of_times_in_a_step_comes_to_rest)
{
    const double eta = 0.98, fall = sqrt(2.0 * height / g), t_star = fall * (1.0 + 2.0 * eta / (1.0 - eta));
    CLEANUP(support_close) support_run run;
    drop(&run, eta);
    (void)support_at(&run, t_star + 1e-3);
    assert_true(run.n_impacts > 500);
    check_rest(&run, eta, t_star);
}

TEST(an_elastic_ball_returns_to_its_height_for_ever)
{
    const double t0 = sqrt(2.0 * height / g);
    CLEANUP(support_close) support_run run;
    drop(&run, 1.0);
    for (int k = 1; k <= 20; k++) {
        const motion state = support_at(&run, 2.0 * k * t0);
        assert_int_equal(run.n_impacts, k);
        assert_close(run.impacts[k - 1].t, (2.0 * k - 1.0) * t0, 1e-9);
        assert_close(state.x[1], height, 1e-9);
        assert_close(state.v[1], 0.0, 1e-8);
    }
}

TEST(a_plastic_ball_stays_where_it_falls)
{
    const double t0 = sqrt(2.0 * height / g);
    CLEANUP(support_close) support_run run;
    drop(&run, 0.0);
    motion state = support_at(&run, 0.5 * t0);
    assert_close(state.x[1], height - 0.125 * g * t0 * t0, 1e-12);
    state = support_at(&run, 5.0);
    assert_int_equal(run.n_impacts, 1);
    assert_close(run.impacts[0].t, t0, 1e-9);
    assert_close(run.impacts[0].impulse[1], 2.0 * sqrt(2.0 * g * height), 1e-9);
    assert_close(state.x[1], 0.0, 0.0);
    assert_close(state.energy.impact, 2.0 * g * height, 1e-9); /* m g H, m = 2 kg */
    const dem_obstacle_load load = ask_obstacle(run.simulation, 0);
    assert_close(load.impulse[1], 2.0 * g * 5.0, 1e-9); /* weight times time, from rest to rest */
}

/* Two masses joined by a spring of length 1, which start 1.5 apart, the lower one at `height` over the floor: it is at
 * height - g t^2/2 + (1 - cos(omega t))/4, omega^2 = 2 k/m. */
static const double pair_omega = 20.0;

static double pair_height(double t)
{
    return height - 0.5 * g * t * t + 0.25 * (1.0 - cos(pair_omega * t));
}

static double pair_speed(double t)
{
    return -g * t + 0.25 * pair_omega * sin(pair_omega * t);
}

static double pair_acceleration(double t)
{
    return -g + 0.25 * pair_omega * pair_omega * cos(pair_omega * t);
}

static double pair_root(void)
{
    double low = 0.3, high = 0.6;
    for (double t = 0.0; t < 0.6 && low == 0.3; t += 1e-3) /* the first one */
        if (pair_height(t) < 0.0) {
            low = t - 1e-3;
            high = t;
        }
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (low + high);
        *(pair_height(middle) > 0.0 ? &low : &high) = middle;
    }
    return high;
}

/* A ball or the pair, with or without the floor; step 0: as the tolerance of 1e-12 asks for. */
static void open_fall(support_run *run, bool pair, bool floored, double step)
{
    const double x[4] = {0.0, height, 0.0, height + 1.0}, start[4] = {0.0, height, 0.0, height + 1.5};
    const double mass[2] = {1.0, 1.0};
    const dem_index ends[2] = {0, 1};
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor_points};
    dem_options options = support_options();
    options.spacing = options.v_scale = 1.0;
    options.max_step = 0.01;
    options.fixed_step = step;
    options.rtol = 1e-12;
    options.penetration_tolerance = 1e-13;
    CLEANUP(dem_lattice_free)
    dem_lattice lattice =
        support_lattice(pair ? 2 : 1, x, mass, pair ? 1 : 0, ends, 1.0, 0.5 * pair_omega * pair_omega, NULL);
    support_start(&lattice, start, NULL);
    support_open(run, &lattice, &ground, floored ? 1 : 0, &options);
}

/* The time that (7) gives, t = d1/(d1 - d2) of the step in which the ball falls through the floor, from runs of fixed
 * steps without one: `steps` of them and a half lead to the root. */
static double linear_estimate(bool pair, double root, int steps)
{
    const double step = root / (steps + 0.5);
    CLEANUP(support_close) support_run run;
    open_fall(&run, pair, false, step);
    const double d1 = support_at(&run, steps * step).x[1], d2 = support_at(&run, (steps + 1) * step).x[1];
    assert_true(d1 > 0.0 && d2 < 0.0);
    return steps * step + step * d1 / (d1 - d2);
}

/* Its error is -a_n dt^2/(8 v_n) with the root in the middle of the step; the next terms are dt^2 smaller. */
static void check_estimates(bool pair, double root, double acceleration, double v)
{
    double error[4];
    for (int k = 0; k < 4; k++) {
        const int steps = 100 << k;
        const double step = root / (steps + 0.5);
        error[k] = linear_estimate(pair, root, steps) - root;
        assert_close(error[k] / (-0.125 * acceleration * step * step / v), 1.0, 2e-4 / (1 << 2 * k));
        if (k > 0) assert_close(log2(error[k - 1] / error[k]) / log2((steps + 0.5) / (steps / 2 + 0.5)), 2.0, 1e-3);
    }
}

TEST(the_linear_estimate_of_a_contact_is_of_second_order_and_the_root_is_exact)
{
    const double fall = sqrt(2.0 * height / g), root = pair_root();
    CLEANUP(support_close) support_run run;
    open_fall(&run, false, true, 0.0);
    (void)support_at(&run, fall + 0.001);
    assert_close(run.impacts[0].t, fall, 1e-12);
    check_estimates(false, run.impacts[0].t, -g, -g * fall);
    support_close(&run);
    open_fall(&run, true, true, 0.0);
    (void)support_at(&run, root + 0.001);
    assert_close(run.impacts[0].t, root, 1e-12);
    check_estimates(true, run.impacts[0].t, pair_acceleration(root), pair_speed(root));
}

TEST(a_ball_starting_at_rest_on_the_floor_stays_there)
{
    const double x[2] = {0.0, 0.0}, v[2] = {0.5, 0.0};
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, floor_points, 2, 0.5);
    const motion state = support_at(&run, 1.0);
    assert_close(state.x[0], 0.5, 1e-12);
    assert_close(state.x[1], 0.0, 0.0);
    assert_int_equal(run.n_impacts, 0);
    assert_int_equal(state.n_contacts, 1);
}
