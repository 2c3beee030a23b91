/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles with a constant velocity: closed forms of a node that is hit, carried along a belt or shut in between two
 * walls, and bodies against the same run seen by an observer who moves. Tolerances of 1e-12 to 1e-10 are the
 * integrator's at rtol 1e-12. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "harness/motion.h"
#include "support.h"
#include "harness/message.h"
#include "view.h"

static const double g = 9.81, mass = 2.0;

/* ---- a node ---- */

static dem_options node_options(double gravity)
{
    dem_options options = support_options();
    options.gravity[1] = -gravity;
    options.spacing = options.v_scale = 1.0;
    options.max_step = 0.01;
    options.rtol = 1e-12;
    options.penetration_tolerance = 1e-13;
    return options;
}

static void open_node(support_run *run, const double x[2], const dem_obstacle *obstacles, dem_index n, double gravity)
{
    const dem_options options = node_options(gravity);
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_open(run, &lattice, obstacles, n, &options);
}

TEST(a_wall_at_speed_throws_a_node_at_rest_by_one_plus_eta)
{
    static const double upright[4] = {-1.0, 9.0, -1.0, -9.0}, x[2] = {0.0, 0.0}, eta[3] = {0.0, 0.5, 1.0};
    const double speed = 3.0;
    for (int k = 0; k < 3; k++) {
        CLEANUP(support_close) support_run run;
        const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = upright, .restitution = eta[k],
                                            .friction = 0.5, .velocity = {speed, 0.7});
        open_node(&run, x, &obstacle, 1, 0.0);
        const double start = ask_energy(run.simulation).ledger;
        const motion s = support_at(&run, 1.0);
        assert_int_equal(run.n_impacts, 1);
        assert_close(run.impacts[0].t, 1.0 / speed, 1e-12);
        assert_close(run.impacts[0].before[0], 0.0, 1e-14);
        assert_close(run.impacts[0].after[0], (1.0 + eta[k]) * speed, 1e-12);
        assert_close(s.v[0], (1.0 + eta[k]) * speed, 1e-12);
        assert_close(s.v[1], 0.7, 1e-12); /* friction has taken it along: 0.7 < 0.5 (1 + eta) 3 */
        assert_close(s.x[0], (1.0 + eta[k]) * speed * (1.0 - 1.0 / speed), 1e-11);
        const double normal = 0.5 * mass * (1.0 - eta[k] * eta[k]) * speed * speed, along = 0.5 * mass * 0.49;
        assert_close(s.energy.impact, normal + along, 1e-11);
        assert_close(s.energy.obstacle, mass * ((1.0 + eta[k]) * speed * speed + 0.49), 1e-11);
        assert_close(s.energy.ledger, start, 1e-11);
        const dem_obstacle_load load = ask_obstacle(run.simulation, 0);
        assert_close(load.impulse[0], mass * (1.0 + eta[k]) * speed, 1e-11);
        assert_close(load.friction_impulse[1], mass * 0.7, 1e-11);
    }
}

/* It slides under mu m g till it is as fast as the belt, then sticks: half of the belt's work m U^2 goes to
 * friction. */
TEST(a_node_on_a_belt_reaches_its_speed_and_half_of_the_work_is_lost)
{
    static const double belt[4] = {-9.0, 0.0, 9.0, 0.0}, x[2] = {0.0, 0.0};
    const double mu = 0.4, speed = 1.5, t = speed / (mu * g);
    for (int side = -1; side <= 1; side += 2) {
        CLEANUP(support_close) support_run run;
        const dem_obstacle obstacle =
            SIZED(dem_obstacle, .n_points = 2, .points = belt, .friction = mu, .velocity = {side * speed, 0.0});
        open_node(&run, x, &obstacle, 1, g);
        motion s = support_at(&run, 0.5 * t);
        assert_int_equal(s.n_contacts, 1);
        assert_int_equal(s.contacts[0].state, DEM_CONTACT_SLIP);
        assert_close(s.v[0], side * 0.5 * speed, 1e-11);
        assert_close(s.x[0], side * 0.125 * mu * g * t * t, 1e-11);
        assert_close(s.energy.obstacle, 0.5 * mass * speed * speed, 1e-10);
        s = support_at(&run, t + 1.0);
        assert_int_equal(s.contacts[0].state, DEM_CONTACT_STICK);
        assert_close(s.v[0], side * speed, 0.0); /* what sticks has the velocity of the belt */
        assert_close(s.x[0], side * speed * (0.5 * t + 1.0), 1e-10);
        assert_close(s.energy.obstacle, mass * speed * speed, 1e-10);
        assert_close(s.energy.friction, 0.5 * mass * speed * speed, 1e-10);
        assert_close(s.energy.ledger, 0.0, 1e-10);
    }
}

/* A lift carries what rests on it, with the weight as force and m g U as power. */
TEST(a_floor_that_rises_carries_a_node_and_does_the_work_of_its_weight)
{
    static const double level[4] = {-9.0, 0.0, 9.0, 0.0}, x[2] = {0.0, 0.0};
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = level, .velocity = {0.0, 2.0});
    CLEANUP(support_close) support_run run;
    open_node(&run, x, &obstacle, 1, g);
    const motion s = support_at(&run, 3.0);
    assert_int_equal(s.n_contacts, 1);
    assert_close(s.x[1], 6.0, 1e-12);
    assert_close(s.v[1], 2.0, 1e-13);
    assert_close(s.contacts[0].force, mass * g, 1e-12);
    assert_close(s.energy.obstacle, mass * (2.0 * 2.0 + 3.0 * 2.0 * g), 1e-9); /* an impact at first */
    assert_close(s.energy.impact, 0.5 * mass * 4.0, 1e-12);
    assert_close(s.energy.ledger, 0.0, 1e-9);
}

/* Between two walls, one at rest and one that comes: each elastic impact on it adds 2 U to the speed, so that the gap
 * times the speed relative to it halfway stays. */
TEST(a_node_between_a_wall_and_one_that_comes_gains_twice_its_speed_each_time)
{
    static const double right[4] = {1.0, -9.0, 1.0, 9.0}, left[4] = {0.0, 9.0, 0.0, -9.0}, x[2] = {0.5, 0.0};
    const dem_obstacle list[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = left, .restitution = 1.0},
        SIZED(dem_obstacle, .n_points = 2, .points = right, .restitution = 1.0, .velocity = {-0.1, 0.0})};
    CLEANUP(support_close) support_run run;
    double at = 0.5, t = 0.0, v = 0.0;
    open_node(&run, x, list, 2, 0.0);
    const motion s = support_at(&run, 9.7);
    assert_true(run.n_impacts >= 6);
    for (dem_index k = 0; k < run.n_impacts; k++) {
        const dem_event *e = &run.impacts[k];
        const bool comes = k % 2 == 0;
        const double wait = comes ? (1.0 - 0.1 * t - at) / (v + 0.1) : at / -v;
        t += wait;
        at = comes ? 1.0 - 0.1 * t : 0.0;
        v = comes ? -0.2 - v : -v;
        assert_close(e->t, t, 1e-10);
        assert_int_equal(e->obstacle, comes ? 1 : 0);
        assert_close(e->after[0], v, 1e-10);
    }
    assert_close(s.energy.obstacle, 0.5 * mass * v * v, 1e-10);
    assert_close(s.energy.impact, 0.0, 1e-11);
}

/* In the corner of a floor at rest and a wall that comes, plastic: the corner takes the node along, and the wall does
 * m U^2 at once and nothing after. With Coulomb friction on the floor the contact is one of a corner: held without. */
TEST(the_corner_of_a_floor_and_a_wall_that_comes_takes_a_node_along)
{
    static const double level[4] = {-9.0, 0.0, 9.0, 0.0}, wall[4] = {-1.0, 9.0, -1.0, -0.5}, x[2] = {0.0, 0.0};
    const dem_obstacle list[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = level},
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = wall, .velocity = {2.0, 0.0}}};
    CLEANUP(support_close) support_run run;
    open_node(&run, x, list, 2, g);
    const motion s = support_at(&run, 2.0);
    assert_close(s.x[0], 3.0, 1e-11);
    assert_close(s.v[0], 2.0, 1e-12);
    assert_close(s.x[1], 0.0, 1e-12);
    assert_close(s.energy.obstacle, mass * 4.0, 1e-11);
    assert_close(s.energy.impact, 0.5 * mass * 4.0, 1e-11);
    assert_close(s.energy.ledger, 0.0, 1e-11);
}

/* ---- bodies, seen by one who moves ---- */

/* As one sees it in whose frame all goes by with this velocity. */
static void open_view(support_run *run, const view *v, const double frame[2], dem_method method)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    dem_obstacle ground[2];
    dem_options options = support_options();
    memcpy(ground, v->ground, sizeof ground);
    for (dem_index k = 0; k < v->n; k++)
        for (int d = 0; d < 2; d++) ground[k].velocity[d] += frame[d];
    options.method = method;
    options.gravity[1] = -v->gravity;
    options.rtol = 1e-9;
    options.v_scale = 1.0;
    view_make_body(&lattice, v);
    for (dem_index k = 0; k < 2 * lattice.n_nodes; k++) lattice.velocity[k] += frame[k % 2];
    support_open(run, &lattice, ground, v->n, &options);
}

/* Positions within 1e-9 of the spacing and energies within 1e-9 of the kinetic one, at rtol 1e-9; with fixed steps,
 * whose own error in the ledger is 1e-3 J, rounding that decides by which side of a step an event is seen costs
 * more. */
static void compare_views(const view *v, const double frame[2], dem_method method)
{
    const bool adaptive = method == DEM_METHOD_FEHLBERG45;
    const double tolerance = adaptive ? 1e-9 : 1e-8, share = adaptive ? 1e-9 : 1e-5;
    CLEANUP(support_close) support_run rest, passing;
    open_view(&rest, v, (const double[2]){0.0, 0.0}, method);
    open_view(&passing, v, frame, method);
    const double spacing = 5e-3, start = ask_energy(passing.simulation).ledger;
    const dem_index n = ask_sizes(rest.model).n_nodes;
    double worst = 0.0;
    for (int k = 1; k <= 8; k++) {
        const double t = v->t_end * k / 8.0;
        const motion a = support_at(&rest, t), b = support_at(&passing, t);
        for (dem_index i = 0; i < 2 * n; i++) {
            worst = fmax(worst, fabs(b.x[i] - a.x[i] - frame[i % 2] * t));
            worst = fmax(worst, 1e-3 * fabs(b.v[i] - a.v[i] - frame[i % 2])); /* m/s in a ms */
        }
        assert_int_equal(a.n_contacts, b.n_contacts);
        for (dem_index c = 0; c < a.n_contacts; c++) assert_int_equal(a.contacts[c].state, b.contacts[c].state);
        assert_close(b.energy.impact, a.energy.impact, share * (1.0 + a.energy.kinetic));
        assert_close(b.energy.friction, a.energy.friction, share * (1.0 + a.energy.kinetic));
    }
    const dem_counts a = ask_counts(rest.simulation), b = ask_counts(passing.simulation);
    assert_true(a.impacts > 0 && a.impacts == b.impacts && a.closings == b.closings);
    assert_true(worst <= tolerance * spacing);
    if (adaptive) assert_close(ask_energy(passing.simulation).ledger, start, 1e-6);
}

static const double frames[2][2] = {{-1.0, 3.0}, {4.7, -0.6}};

TEST(what_happens_does_not_depend_on_who_looks)
{
    for (int k = 0; k < VIEWS; k++)
        for (int f = 0; f < 2; f++) compare_views(&views[k], frames[f], DEM_METHOD_FEHLBERG45);
}

TEST(nor_with_fixed_steps)
{
    for (int k = 0; k < VIEWS; k++)
        compare_views(&views[k], frames[0], k % 2 == 0 ? DEM_METHOD_VERLET : DEM_METHOD_RK4);
}

/* ---- checkpoints ---- */

TEST(a_run_goes_on_from_its_checkpoint_to_the_same_bits)
{
    for (int k = 0; k < VIEWS; k++) {
        const view *v = &views[k];
        CLEANUP(support_close) support_run run;
        CLEANUP(free_simulation) dem_simulation *resumed;
        open_view(&run, v, frames[0], DEM_METHOD_FEHLBERG45);
        (void)support_at(&run, 0.6 * v->t_end);
        const dem_options options = ask_options(run.simulation);
        const dem_checkpoint *checkpoint = dem_simulation_checkpoint(run.simulation);
        assert_non_null(checkpoint);
        assert_ok(dem_simulation_resume(&resumed, run.model, &options, checkpoint));
        const motion a = support_at(&run, v->t_end);
        motion b;
        assert_ok(dem_simulation_advance(resumed, v->t_end));
        motion_see(resumed, &b);
        const size_t size = 2 * (size_t)ask_sizes(run.model).n_nodes * sizeof *a.x;
        assert_memory_equal(a.x, b.x, size);
        assert_memory_equal(a.v, b.v, size);
        assert_memory_equal(&a.energy, &b.energy, sizeof a.energy);
    }
}

TEST(a_checkpoint_of_another_velocity_is_refused)
{
    CLEANUP(support_close) support_run run, other;
    dem_simulation *resumed = NULL;
    open_view(&run, &views[1], frames[0], DEM_METHOD_FEHLBERG45);
    open_view(&other, &views[1], frames[1], DEM_METHOD_FEHLBERG45);
    (void)support_at(&run, 0.001);
    const dem_options options = ask_options(run.simulation);
    assert_int_equal(dem_simulation_resume(&resumed, other.model, &options, dem_simulation_checkpoint(run.simulation)),
                     DEM_ERROR_IO);
    assert_message_parts("obstacle 0 * velocity * -1 m/s * 4.7 m/s");
    assert_null(resumed);
}

TEST(a_velocity_that_is_not_finite_is_refused)
{
    const double line[4] = {-0.3, 0.0, 0.3, 0.0};
    const dem_obstacle nan = SIZED(dem_obstacle, .n_points = 2, .points = line, .velocity = {0.0, NAN});
    dem_index segments[2];
    assert_int_equal(dem_obstacle_check(&nan, segments), DEM_ERROR_MODEL);
    assert_message_parts("obstacle 0: velocity * nan m/s * not finite");
}
