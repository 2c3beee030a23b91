/* SPDX-License-Identifier: BSD-3-Clause */
/* A point mass dropped on a floor (row e): impact times, the end of bouncing, rest. Exact values are closed forms.
 * With a skin of 1e-13 m an impact is late by skin/|v_n| < 1e-11 s for the eight impacts compared; 1e-9 s is the
 * table's tolerance. */
#include "support.h"

static const double g = 9.81, height = 1.0;
static const double floor_points[4] = {-1.0, 0.0, 1.0, 0.0};

static void drop(support_run *run, double restitution)
{
    const double x[2] = {0.0, height}, v[2] = {0.0, 0.0};
    support_point(run, 2.0, x, v, floor_points, 2, restitution);
}

static void check_bounces(double eta, const double *times, int n, double t_star)
{
    support_run run;
    drop(&run, eta);
    dem_state state = support_at(&run, t_star + 1e-3); /* hops below the position tolerance are cut off: 1e-6 s early */
    for (int k = 0; k < n; k++) {
        assert_close(run.impacts[k].t, times[k], 1e-9);
        assert_close(run.impacts[k].after[1], eta * sqrt(2.0 * g * height) * pow(eta, k), 1e-9);
        assert_int_equal(run.impacts[k].state, DEM_CONTACT_FREE);
    }
    const dem_event last = run.impacts[run.n_impacts - 1];
    assert_int_not_equal(last.state, DEM_CONTACT_FREE);
    assert_close(last.t, t_star, 1e-5); /* what is left of the series after the last hop taken */
    const dem_index n_impacts = run.n_impacts;
    for (double t = t_star + 0.1; t < 10.0; t += 0.7) {
        state = support_at(&run, t);
        assert_close(state.x[1], 0.0, 1e-12);
        assert_close(state.v[1], 0.0, 0.0);
        assert_int_equal(state.n_contacts, 1);
        assert_close(state.contacts[0].force, 2.0 * g, 1e-12);
    }
    assert_int_equal(run.n_impacts, n_impacts);
    support_close(&run);
}

static void a_ball_of_restitution_one_half_follows_the_geometric_series_and_rests(void **unused)
{
    static const double times[8] = {0.4515236409857309, 0.9030472819714618, 1.1288091024643272, 1.24169001271076,
                                    1.2981304678339762, 1.3263506953955846, 1.3404608091763885, 1.3475158660667905};
    (void)unused;
    check_bounces(0.5, times, 8, 1.3545709229571927);
}

static void a_ball_of_restitution_three_tenths_follows_the_geometric_series_and_rests(void **unused)
{
    static const double times[8] = {0.4515236409857309, 0.7224378255771695, 0.8037120809546011, 0.8280943575678305,
                                    0.8354090405517993, 0.83760344544699,   0.8382617669155471, 0.8384592633561143};
    (void)unused;
    check_bounces(0.3, times, 8, 0.8385439046877861);
}

static void an_elastic_ball_returns_to_its_height_for_ever(void **unused)
{
    const double t0 = sqrt(2.0 * height / g);
    support_run run;
    (void)unused;
    drop(&run, 1.0);
    for (int k = 1; k <= 20; k++) {
        const dem_state state = support_at(&run, 2.0 * k * t0);
        assert_int_equal(run.n_impacts, k);
        assert_close(run.impacts[k - 1].t, (2.0 * k - 1.0) * t0, 1e-9);
        assert_close(state.x[1], height, 1e-9);
        assert_close(state.v[1], 0.0, 1e-8);
    }
    support_close(&run);
}

static void a_plastic_ball_stays_where_it_falls(void **unused)
{
    const double t0 = sqrt(2.0 * height / g);
    support_run run;
    (void)unused;
    drop(&run, 0.0);
    dem_state state = support_at(&run, 0.5 * t0);
    assert_close(state.x[1], height - 0.125 * g * t0 * t0, 1e-12);
    state = support_at(&run, 5.0);
    assert_int_equal(run.n_impacts, 1);
    assert_close(run.impacts[0].t, t0, 1e-9);
    assert_close(run.impacts[0].impulse[1], 2.0 * sqrt(2.0 * g * height), 1e-9);
    assert_close(state.x[1], 0.0, 0.0);
    assert_close(state.energy.impact, 2.0 * g * height, 1e-9); /* m g H, m = 2 kg */
    const dem_obstacle_load load = dem_simulation_obstacle(run.simulation, 0);
    assert_close(load.impulse[1], 2.0 * g * 5.0,
                 0.011 * 2.0 * g); /* weight times time, up to the step in hand at t_end */
    support_close(&run);
}

static void a_ball_starting_at_rest_on_the_floor_stays_there(void **unused)
{
    const double x[2] = {0.0, 0.0}, v[2] = {0.5, 0.0};
    support_run run;
    (void)unused;
    support_point(&run, 1.0, x, v, floor_points, 2, 0.5);
    const dem_state state = support_at(&run, 1.0);
    assert_close(state.x[0], 0.5, 1e-12);
    assert_close(state.x[1], 0.0, 0.0);
    assert_int_equal(run.n_impacts, 0);
    assert_int_equal(state.n_contacts, 1);
    support_close(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_of_restitution_one_half_follows_the_geometric_series_and_rests),
        cmocka_unit_test(a_ball_of_restitution_three_tenths_follows_the_geometric_series_and_rests),
        cmocka_unit_test(an_elastic_ball_returns_to_its_height_for_ever),
        cmocka_unit_test(a_plastic_ball_stays_where_it_falls),
        cmocka_unit_test(a_ball_starting_at_rest_on_the_floor_stays_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
