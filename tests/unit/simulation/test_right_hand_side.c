/* SPDX-License-Identifier: BSD-3-Clause */
/* right_hand_side.c: derivatives, fused steps and root functions as the integrator calls them. */
#include "runs.h"

#include "harness/message.h"
#include "harness/motion.h"
#include "simulation/right_hand_side.h"

enum { MOST = 256 };

/* x' and v' in a state, each as long as half of it. */
typedef struct slopes {
    double u[MOST], a[MOST];
} slopes;

static int derive(dem_simulation *s, const double *y, slopes *out)
{
    const ode_problem problem = right_hand_side_problem(s);
    assert_true(state_velocities(&s->layout) <= MOST);
    return problem.derivative(s->t, y, out->u, out->a, problem.context);
}

/* A rectangle in the air, and its state, which may be changed. */
static dem_simulation *start_falling(dem_model **model, double y[2 * MOST])
{
    const dem_options options = dem_options_default();
    *model = make_falling(0.5);
    dem_simulation *s = simulate(*model, &options);
    assert_true(state_size(&s->layout) <= 2 * MOST);
    memcpy(y, s->y, (size_t)state_size(&s->layout) * sizeof *y);
    return s;
}

/* A stretched rectangle in the air: as it is far from the slope, every node has the acceleration that the forces on it
 * give. Sweeps have the bits of forces_acceleration(). */
TEST(free_nodes_have_the_acceleration_of_their_forces)
{
    double y[2 * MOST];
    slopes at;
    CLEANUP(free_model) dem_model *model;
    CLEANUP(free_simulation) dem_simulation *s = start_falling(&model, y);
    for (dem_index k = 0; k < 2 * s->layout.n_nodes; k++) y[k] *= 1.0 + 1e-3 * (double)(k % 7);
    const double *v = y + state_velocities(&s->layout);
    assert_int_equal(derive(s, y, &at), 0);
    for (dem_index i = 0; i < s->layout.n_nodes; i++) {
        const vec2 expected = forces_acceleration(&s->forces, i, y, v);
        assert_memory_equal(&at.a[2 * i], &expected, sizeof expected);
        assert_memory_equal(&at.u[2 * i], &v[2 * i], sizeof expected);
    }
}

/* m v' = -m g - c m v with m = 2 kg, c = 0.5 1/s, v = (3, 4) m/s: damping takes c m v^2 = 25 W. Time is integrated at
 * a rate of 1. */
TEST(quadratures_have_their_rates)
{
    const double v[2] = {3.0, 4.0};
    dem_options options = point_options();
    slopes at;
    options.mass_damping = 0.5;
    CLEANUP(free_model) dem_model *model = make_point(v, 0.5);
    CLEANUP(free_simulation) dem_simulation *s = simulate(model, &options);
    assert_int_equal(derive(s, s->y, &at), 0);
    assert_close(at.a[0], -1.5, 1e-15);
    assert_close(at.a[1], -9.81 - 2.0, 1e-15);
    assert_close(at.a[state_total_index(&s->layout, STATE_DAMPING)], 25.0, 1e-14);
    assert_close(at.a[state_total_index(&s->layout, STATE_FRICTION)], 0.0, 0.0);
    assert_close(at.a[state_total_index(&s->layout, STATE_WORK)], 0.0, 0.0);
    assert_close(at.a[state_total_index(&s->layout, STATE_TIME)], 1.0, 0.0);
}

/* At rest on the floor after a plastic impact: m g goes into the row of the obstacle's impulse. */
TEST(a_closed_contact_holds_its_node_and_gives_an_impulse)
{
    const dem_options options = point_options();
    slopes at;
    CLEANUP(free_model) dem_model *model = make_point(NULL, 0.0);
    CLEANUP(free_simulation) dem_simulation *s = simulate(model, &options);
    assert_ok(dem_simulation_advance(s, 2.0));
    assert_int_equal(derive(s, s->y, &at), 0);
    const double *impulse = at.a + state_row(&s->layout, state_impulse(&s->layout, 0));
    assert_close(at.a[1], 0.0, 0.0);
    assert_close(impulse[0], 0.0, 0.0);
    assert_close(impulse[1], 2.0 * 9.81, 1e-14);
}

TEST(the_node_is_named_whose_velocity_is_not_finite)
{
    double y[2 * MOST];
    slopes at;
    CLEANUP(free_model) dem_model *model;
    CLEANUP(free_simulation) dem_simulation *s = start_falling(&model, y);
    y[state_velocities(&s->layout) + 2 * 5] = (double)NAN;
    assert_int_equal(derive(s, y, &at), 1);
    assert_non_null(strstr(dem_status_message(), "force or velocity of node 5 is not finite at ("));
}

/* With 'exact' the integrator looks for a root of the lowest of all root functions in units of the start. The node,
 * 0.125 m above the floor, is fast enough to reach it in a step, and is tried a quarter of the penetration tolerance of
 * 1e-6 m deep. At the start its gap counts as 20 tolerances less, for it is known to be clear by that much at least.
 * With 'local' there is no root function. */
TEST(only_exact_contacts_have_a_root_function)
{
    const double down[2] = {0.0, -8.0};
    dem_options options = point_options();
    double y[2 * MOST], f[2 * MOST] = {0.0};
    CLEANUP(free_model) dem_model *model = make_point_at(0.125, down, 0.5);
    CLEANUP(free_simulation) dem_simulation *simulation = simulate(model, &options);
    assert_true(right_hand_side_problem(simulation).begin_roots == NULL);
    assert_true(right_hand_side_problem(simulation).root_function == NULL);
    dem_simulation_destroy(simulation);
    options.contact = DEM_CONTACT_EXACT;
    simulation = simulate(model, &options);
    assert_ok(dem_simulation_advance(simulation, 0.0)); /* finds the candidates that are near */
    const ode_problem problem = right_hand_side_problem(simulation);
    memcpy(y, simulation->y, (size_t)state_size(&simulation->layout) * sizeof *y);
    y[1] = -0.25e-6;
    const dense_output step = {simulation->layout, 0.0, 0.015, 0.015, simulation->y, f, y, f, false, NULL};
    problem.begin_roots(0.0, simulation->y, problem.context);
    assert_close(problem.root_function(&step, problem.context), 0.75e-6 / (0.125 - 19e-6), 1e-20); /* rounding */
}

static int fuse(dem_simulation *s)
{
    double y1[2 * MOST] = {0.0}, f0[2 * MOST] = {0.0}, f1[2 * MOST] = {0.0};
    const ode_problem problem = right_hand_side_problem(s);
    const ode_fused_step step = {.t1 = s->t + 1e-5, .h = 1e-5, .y0 = s->y, .f0 = f0, .y1 = y1, .f1 = f1};
    return problem.fused_step(&step, problem.context);
}

TEST(a_closed_contact_or_damping_allows_no_fused_step)
{
    dem_options options = point_options();
    CLEANUP(free_model) dem_model *model = make_point(NULL, 0.0);
    CLEANUP(free_simulation) dem_simulation *simulation = simulate(model, &options);
    assert_int_equal(fuse(simulation), 0);
    assert_ok(dem_simulation_advance(simulation, 2.0)); /* lies on the floor */
    assert_int_equal(fuse(simulation), -1);
    dem_simulation_destroy(simulation);
    options.mass_damping = 0.5;
    simulation = simulate(model, &options);
    assert_int_equal(fuse(simulation), -1);
}

/* A force of nothing on a node inside: steps of Verlet's method are taken part by part then, and not in one pass. */
TEST(steps_in_one_pass_are_those_in_parts)
{
    for (int elastic = 0; elastic < 2; elastic++) { /* without restitution contacts last, and end */
        CLEANUP(free_model) dem_model *model = make_falling(0.7 * elastic);
        snapshot run[2];
        dem_obstacle_load load[2];
        dem_index inside = 0;
        while (dem_model_lattice(model)->flags[inside] & DEM_NODE_CONTACT) inside++;
        const dem_boundary nothing = SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 1, .nodes = &inside);
        for (int in_parts = 0; in_parts < 2; in_parts++) {
            dem_options options = dem_options_default();
            options.method = DEM_METHOD_VERLET;
            options.boundaries = &nothing;
            options.n_boundaries = in_parts;
            CLEANUP(free_simulation) dem_simulation *simulation = simulate(model, &options);
            assert_ok(dem_simulation_advance(simulation, t_whole));
            run[in_parts] = snap(simulation);
            load[in_parts] = ask_obstacle(simulation, 0);
        }
        assert_true(run[0].counts.impacts > 3);
        if (!elastic) assert_true(run[0].counts.releases > 0);
        assert_same(&run[0], &run[1]);
        assert_memory_equal(&load[0], &load[1], sizeof load[0]);
    }
}

/* A rectangle with the guard in the air over the slope; its steps are taken by bands. */
static dem_model *make_large_falling(void)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.2, .density = 1050.0,
                                      .thickness = 1.0, .guard = 0.02);
    const dem_obstacle slope = SIZED(dem_obstacle, .n_points = 3, .points = slope_points, .restitution = 0.98);
    const double down[2] = {0.5, -4.0}, up[2] = {-0.3, 0.0763};
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&lattice, 0.16, 0.12, 1.5e-3));
    assert_ok(dem_lattice_assemble(&lattice, &rubber));
    dem_lattice_move(&lattice, 0.0, up);
    assert_ok(dem_lattice_launch(&lattice, down));
    dem_model *model = support_model(&lattice, &slope, 1);
    dem_lattice_free(&lattice);
    return model;
}

static bool has_bands(dem_simulation *s)
{
    const ode_problem problem = right_hand_side_problem(s);
    return problem.band_rows > 0 && problem.has_bands(5, s);
}

/* Two runs, of which one has a force of nothing on a node inside, as above: its stages are evaluated one by one.
 *  \return at how many of `rounds` times the other one had no bands */
static int race(const dem_model *model, dem_options options, double round, int rounds)
{
    dem_index inside = 0;
    int without = 0;
    while (dem_model_lattice(model)->flags[inside] & DEM_NODE_CONTACT) inside++;
    const dem_boundary nothing = SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 1, .nodes = &inside);
    CLEANUP(free_simulation) dem_simulation *by_bands = simulate(model, &options);
    options.boundaries = &nothing;
    options.n_boundaries = 1;
    CLEANUP(free_simulation) dem_simulation *by_stages = simulate(model, &options);
    assert_true(by_bands->layout.n_nodes > 8000 && !has_bands(by_stages));
    for (int k = 1; k <= rounds; k++) {
        assert_ok(dem_simulation_advance(by_bands, round * k));
        assert_ok(dem_simulation_advance(by_stages, round * k));
        const dem_counts a = ask_counts(by_bands), b = ask_counts(by_stages);
        without += !has_bands(by_bands);
        assert_memory_equal(&a, &b, sizeof a);
        assert_memory_equal(by_bands->y, by_stages->y, (size_t)state_size(&by_bands->layout) * sizeof(double));
    }
    return without;
}

/* Some contacts are closed on the way, so that steps by bands and by stages follow each other. */
TEST(steps_by_bands_are_those_by_stages)
{
    CLEANUP(free_model) dem_model *model = make_large_falling();
    for (int contact = DEM_CONTACT_LOCAL; contact <= DEM_CONTACT_EXACT; contact++) {
        dem_options options = dem_options_default();
        options.contact = (dem_contact_method)contact;
        const int without = race(model, options, 8e-5, 10);
        assert_true(without > 0 && without < 10);
    }
}

/* Two blocks in flight run into each other, with and without threads. */
TEST(bodies_that_come_near_each_other_have_no_bands_any_more)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
    const double right[2] = {8.0, 1.0}, left[2] = {-2.0, 1.0}, apart[2] = {0.125, 0.01};
    dem_lattice lattice = dem_lattice_empty(), other = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&lattice, 0.12, 0.12, 1.5e-3));
    assert_ok(dem_lattice_assemble(&lattice, &rubber));
    assert_ok(dem_lattice_append(&other, &lattice));
    dem_lattice_move(&other, 0.0, apart);
    assert_ok(dem_lattice_launch(&lattice, right));
    assert_ok(dem_lattice_launch(&other, left));
    assert_ok(dem_lattice_append(&lattice, &other));
    CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
    dem_lattice_free(&lattice);
    dem_lattice_free(&other);
    for (int threads = 1; threads <= 2; threads++) {
        dem_options options = dem_options_default();
        options.bodies = DEM_BODIES_ALL;
        options.threads = threads;
        const int without = race(model, options, 8e-5, 10);
        assert_true(without > 0 && without < 10);
    }
}

TEST(nodes_that_coincide_end_the_run_with_the_node_named)
{
    const double x[4] = {0.0, 0.0, 1.0, 0.0}, start[4] = {0.5, 0.25, 0.5, 0.25}, mass[2] = {1.0, 1.0};
    const dem_index ends[2] = {0, 1};
    const dem_options options = dem_options_default();
    motion now;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(2, x, mass, 1, ends, 1.0, 10.0, NULL);
    support_start(&lattice, start, NULL);
    CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
    CLEANUP(free_simulation) dem_simulation *simulation = simulate(model, &options);
    assert_int_equal(dem_simulation_advance(simulation, 1.0), DEM_ERROR_INTEGRATOR);
    assert_message_parts("force * velocity * node 0 * not finite * (0.5, 0.25) m, t = 0 s");
    motion_see(simulation, &now);
    assert_close(now.t, 0.0, 0.0);
    assert_close(now.x[0], 0.5, 0.0);
}
