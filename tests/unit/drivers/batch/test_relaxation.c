/* SPDX-License-Identifier: BSD-3-Clause */
/* relaxation.c: a weight on a spring comes to rest where it hangs, and not before its ramps are over. */
#include "verification/support.h"

#include "relaxation.h"

/* A mass of 2 kg under a fixed one, on a spring of 0.5 m and E = 100 N, which hangs 0.5 m 20 N/100 N lower. */
static const double hanging[] = {0.0, 0.0, 0.0, -0.5}, masses[] = {1.0, 2.0};
static const dem_index ends[] = {0, 1};
static const unsigned char fixed[] = {1, 0};
static const double g = 10.0, sag = 0.1;

/* Of the lattice of a run. */
static double damping_of(const support_run *run)
{
    CLEANUP(lattice_facts_free) lattice_facts facts;
    assert_true(lattice_facts_find(&facts, dem_model_lattice(run->model)));
    return relaxation_damping(run->model, &facts);
}

static double expected_of(const support_run *run, const dem_options *options, double residual)
{
    CLEANUP(lattice_facts_free) lattice_facts facts;
    assert_true(lattice_facts_find(&facts, dem_model_lattice(run->model)));
    return relaxation_expected(run->simulation, &facts, options, residual);
}

static void open_weight(support_run *run, dem_options *options)
{
    options->gravity[1] = -g;
    options->mass_damping = 20.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(2, hanging, masses, 1, ends, 0.5, 100.0, fixed);
    support_open(run, &lattice, NULL, 0, options);
}

/* The residual r is of the spring's force of 20 N, so that the weight is r 20 N/(200 N/m) off at most, and as slow. */
TEST(a_weight_comes_to_rest_where_it_hangs)
{
    const double residual = 1e-8;
    dem_options options = dem_options_default();
    CLEANUP(support_close) support_run run;
    dem_state state = {.struct_size = sizeof state};
    open_weight(&run, &options);
    relaxation r = relaxation_start(residual, &options);
    const dem_observer observer = relaxation_observer(&r);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    assert_int_equal(dem_simulation_advance(run.simulation, 100.0), DEM_STOPPED);
    dem_simulation_state(run.simulation, &state);
    assert_true(r.done);
    assert_true(r.reached <= residual);
    assert_close(r.t, state.t, 0.0);
    assert_close(state.x[3], -0.5 - sag, 2.0 * residual * sag);
}

/* Critical damping of the slowest motion takes log(1/residual) over half of itself; twice as much slows it down to the
 * smaller root of s^2 - alpha s + critical^2/4, half as much to half its rate. */
TEST(the_time_to_rest_is_that_of_the_slowest_motion)
{
    static const double share[] = {1.0, 2.0, 0.5};
    for (int k = 0; k < 3; k++) {
        dem_options options = dem_options_default();
        CLEANUP(support_close) support_run probe;
        CLEANUP(support_close) support_run run;
        open_weight(&probe, &options);
        const double critical = damping_of(&probe), alpha = share[k] * critical;
        const double rate = k == 1 ? (1.0 - sqrt(0.75)) * critical : 0.5 * alpha;
        options.mass_damping = alpha;
        CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(2, hanging, masses, 1, ends, 0.5, 100.0, fixed);
        support_open(&run, &lattice, NULL, 0, &options);
        assert_close(expected_of(&run, &options, 1e-3), log(1e3) / rate, 1e-9 / rate);
    }
}

TEST(what_is_not_at_rest_goes_on)
{
    dem_options options = dem_options_default();
    CLEANUP(support_close) support_run run;
    open_weight(&run, &options);
    relaxation r = relaxation_start(1e-8, &options);
    const dem_observer observer = relaxation_observer(&r);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    assert_ok(dem_simulation_advance(run.simulation, 0.5));
    assert_false(r.done);
    assert_true(r.reached > 1e-8);
}

/* A force that ends its ramp at 10 s: the weight follows it so slowly that it is nearly at rest all the time. */
TEST(ramps_are_waited_for)
{
    static const dem_index node[] = {1};
    const dem_boundary pull = SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 1, .nodes = node,
                                    .value = {0.0, -20.0}, .ramp = 10.0);
    dem_options options = dem_options_default();
    CLEANUP(support_close) support_run run;
    dem_state state = {.struct_size = sizeof state};
    options.n_boundaries = 1;
    options.boundaries = &pull;
    open_weight(&run, &options);
    relaxation r = relaxation_start(1e-2, &options);
    const dem_observer observer = relaxation_observer(&r);
    assert_close(r.settled, 10.0, 0.0);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    assert_int_equal(dem_simulation_advance(run.simulation, 100.0), DEM_STOPPED);
    dem_simulation_state(run.simulation, &state);
    assert_true(state.t >= 10.0 && state.t < 11.0);
    assert_close(state.x[3], -0.5 - 2.0 * sag, 2.0 * 1e-2 * 2.0 * sag);
}

/* omega_max is a bound of the pair's sqrt(E/d0 (1/m1 + 1/m2)) or above; the rest is pi c/L, c = omega_max d0/2. */
TEST(damping_is_critical_for_the_slowest_stretch)
{
    dem_options options = dem_options_default();
    CLEANUP(support_close) support_run run;
    open_weight(&run, &options);
    assert_close(damping_of(&run), M_PI * 0.5 * dem_model_omega_max(run.model), 1e-12);
}

/* Of two springs, one of four times the other's slowness, waves run in the mean at 2/(1 + 4) of the faster one's. */
TEST(soft_parts_make_the_slowest_stretch_slower)
{
    const double x[] = {0.0, 0.0, 1.0, 0.0, 2.0, 0.0}, equal[] = {1.0, 1.0, 1.0};
    const dem_index both[] = {0, 1, 1, 2};
    dem_options options = dem_options_default();
    CLEANUP(support_close) support_run run;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(3, x, equal, 2, both, 1.0, 100.0, NULL);
    lattice.stiffness[1] /= 16.0;
    options.v_scale = 1.0;
    support_open(&run, &lattice, NULL, 0, &options);
    assert_close(damping_of(&run), 0.4 * M_PI / 2.0 * 0.5 * dem_model_omega_max(run.model), 1e-12);
}
