/* SPDX-License-Identifier: BSD-3-Clause */
/* body_contact.c: what is refused at the start and by set_motion, and the ledger of a motion that was set; friction in
 * both, and in checkpoints. How bodies move in contact is in verification/test_bodies.c. */
#include "simulation/body_contact.h"

#include "ask.h"
#include "harness/message.h"
#include "verification/last_record.h"
#include "verification/support.h"

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);

/* Two squares of 30 mm side by side with a gap between their corners. */
static dem_lattice make_squares(double gap)
{
    return support_squares(0.03, 5e-3, &rubber, (const double[2]){0.03 + gap, 0.0});
}

static dem_options touching(void)
{
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.bodies = DEM_BODIES_OTHERS;
    return options;
}

static void refuse(const dem_lattice *lattice, const dem_options *options, const char *message)
{
    CLEANUP(free_model) dem_model *model = support_model(lattice, NULL, 0);
    dem_simulation *simulation = NULL;
    assert_int_equal(dem_simulation_create(&simulation, model, options), DEM_ERROR_MODEL);
    assert_null(simulation);
    assert_message_parts(message);
}

TEST(what_cannot_be_in_contact_is_refused)
{
    CLEANUP(dem_lattice_free) dem_lattice apart = make_squares(1e-3), crossing = make_squares(-1e-3);
    const double x[4] = {0.0, 0.0, 1.0, 0.0}, mass[2] = {1.0, 1.0};
    const dem_index ends[2] = {0, 1};
    CLEANUP(dem_lattice_free) dem_lattice spring = support_lattice(2, x, mass, 1, ends, 1.0, 1.0, NULL);
    dem_options o = touching();
    refuse(&crossing, &o, "node * of body * m inside body * surfaces must not cross at the start");
    refuse(&spring, &o, "body 0 has no triangles");
    o.contact_thickness = 2.6e-3;
    refuse(&apart, &o, "thickness of 0.0026 m * half of the shortest boundary edge of body 0, 0.005 m");
}

TEST(without_contact_of_bodies_nothing_is_looked_at)
{
    CLEANUP(dem_lattice_free) dem_lattice crossing = make_squares(-1e-3);
    CLEANUP(free_model) dem_model *model = support_model(&crossing, NULL, 0);
    dem_options o = touching();
    o.bodies = DEM_BODIES_NONE;
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    assert_null(simulation->surfaces);
    assert_close(ask_energy(simulation).contact, 0.0, 0.0);
}

/* The second body is moved to within the thickness of the first: the energy of contact is work from outside, so that
 * the ledger stays, to the rounding of 14 J. Into the first body itself it is refused, and all is as it was. Until then
 * nothing has moved, so that places are known to 1e-17 m. The energy comes back to the error of the integrator at rtol
 * 1e-6, found 6e-6 of it; mean velocities of 1.6 m/s keep the rounding of forces over a thousand steps, found 1e-13. */
TEST(a_motion_that_is_set_counts_the_energy_of_contact)
{
    CLEANUP(dem_lattice_free) dem_lattice apart = make_squares(2e-3);
    CLEANUP(free_model) dem_model *model = support_model(&apart, NULL, 0);
    const dem_options o = touching();
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    const dem_index n = apart.n_nodes;
    CLEANUP(free_memory) double *x = malloc(2 * (size_t)n * sizeof *x);
    assert_ok(dem_simulation_advance(simulation, 1e-5));
    memcpy(x, ask_state(simulation).x, 2 * (size_t)n * sizeof *x);
    for (dem_index i = n / 2; i < n; i++) x[2 * i] -= 3e-3;
    assert_int_equal(dem_simulation_set_motion(simulation, x, NULL), DEM_ERROR_MODEL);
    assert_close(ask_energy(simulation).contact, 0.0, 0.0);
    assert_int_equal(ask_surfaces(simulation).pushing, 0);
    assert_true(isinf(ask_surfaces(simulation).gap_min));
    assert_close(ask_surfaces(simulation).pressure_share, 0.0, 0.0);
    for (dem_index i = n / 2; i < n; i++) x[2 * i] += 1.5e-3;
    assert_ok(dem_simulation_set_motion(simulation, x, NULL));
    const dem_energy pressed = ask_energy(simulation);
    assert_true(pressed.contact > 1e-3);
    const dem_surfaces near = ask_surfaces(simulation);
    assert_close(near.gap_min, 5e-4, 1e-15); /* of the corners; 2 mm at first */
    assert_close(near.gap_share, 0.5, 1e-12);
    assert_close(near.pressure_share, 0.5, 1e-11); /* (1 - u)^2/u */
    assert_true(near.pushing >= 2);
    assert_close(pressed.ledger, 0.0, 1e-12);
    assert_ok(dem_simulation_advance(simulation, 2e-3));
    const dem_energy apart_again = ask_energy(simulation);
    assert_close(apart_again.contact, 0.0, 0.0);
    assert_close(apart_again.motion, pressed.contact, 2e-5 * pressed.contact);
    assert_true(ask_body(simulation, 1).velocity[0] > 0.0);
    assert_close(ask_body(simulation, 0).velocity[0] + ask_body(simulation, 1).velocity[0], 0.0, 1e-12);
}

/* A fixed step of 2/omega_max is within the bound of rk4, 2.8/omega_max. */
TEST(a_long_fixed_step_is_kept_where_nothing_touches)
{
    CLEANUP(dem_lattice_free) dem_lattice apart = make_squares(2e-3);
    CLEANUP(free_model) dem_model *model = support_model(&apart, NULL, 0);
    dem_options o = touching();
    o.method = DEM_METHOD_RK4;
    o.fixed_step = 2.0 / dem_model_omega_max(model);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    assert_ok(dem_simulation_advance(simulation, 9.5 * o.fixed_step));
    assert_int_equal(ask_counts(simulation).steps, 10);
}

/* Two squares run into each other with a step that is far too long, and an error test that lets everything pass: steps
 * in which they would cross are taken again, and counted. A run that goes on from a checkpoint counts on. */
TEST(steps_in_which_surfaces_cross_are_counted)
{
    CLEANUP(dem_lattice_free) dem_lattice squares = make_squares(2e-3);
    const dem_index n = squares.n_nodes;
    CLEANUP(free_memory) double *v = calloc(2 * (size_t)n, sizeof *v);
    for (dem_index i = 0; i < n; i++) v[2 * i] = i < n / 2 ? 20.0 : -20.0;
    support_start(&squares, NULL, v);
    CLEANUP(free_model) dem_model *model = support_model(&squares, NULL, 0);
    dem_options o = touching();
    o.rtol = 0.1;
    o.max_step = 1e-4;
    o.checkpoint_steps = 4;
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    assert_int_equal(ask_counts(simulation).crossings, 0);
    assert_ok(dem_simulation_advance(simulation, 3e-4));
    const dem_counts first = ask_counts(simulation);
    assert_true(first.crossings > 0 && first.crossings <= first.rejected);
    CLEANUP(free_simulation) dem_simulation *resumed = NULL;
    assert_ok(dem_simulation_resume(&resumed, model, &o, dem_simulation_checkpoint(simulation)));
    assert_ok(dem_simulation_advance(resumed, 3e-4));
    assert_int_equal(ask_counts(resumed).crossings, first.crossings);
}

/* ---- what is shown ---- */

/* Two squares that push each other from the start, seen after a moment; the sum of the forces on a body is its mass
 * times its acceleration, by differences over 20 ns: the tips are pushed apart in 1 us. */
TEST(forces_of_contact_move_the_bodies)
{
    CLEANUP(dem_lattice_free) dem_lattice apart = make_squares(3e-4);
    CLEANUP(free_model) dem_model *model = support_model(&apart, NULL, 0);
    dem_options o = touching();
    o.rtol = 1e-10;
    o.max_step = 1e-7; /* what is seen within a step is interpolated */
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    CLEANUP(free_memory) double *force = malloc(2 * (size_t)apart.n_nodes * sizeof *force);
    double speed[2], sum[2] = {0.0, 0.0};
    assert_ok(dem_simulation_advance(simulation, 1e-5));
    speed[0] = ask_body(simulation, 1).velocity[0];
    assert_ok(dem_simulation_advance(simulation, 1.001e-5));
    assert_ok(dem_simulation_contact_forces(simulation, force));
    assert_ok(dem_simulation_advance(simulation, 1.002e-5));
    speed[1] = ask_body(simulation, 1).velocity[0];
    for (dem_index i = 0; i < apart.n_nodes; i++) sum[2 * i >= apart.n_nodes] += force[2 * i];
    assert_true(sum[1] > 1.0);
    assert_close(sum[0], -sum[1], 1e-11 * sum[1]);
    assert_close(sum[1], ask_body(simulation, 1).mass * (speed[1] - speed[0]) / 2e-8, 1e-4 * sum[1]);
}

/* The pairs that are counted, one by one: the smallest gap is that of one of them, and the forces of all pairs between
 * the bodies are what these feel. Without contact there are none, and all forces are 0. */
TEST(pairs_are_shown_one_by_one)
{
    CLEANUP(dem_lattice_free) dem_lattice apart = make_squares(3e-4);
    CLEANUP(free_model) dem_model *model = support_model(&apart, NULL, 0);
    dem_options o = touching();
    dem_pair p = {.struct_size = sizeof p};
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    CLEANUP(free_memory) double *force = malloc(3 * (size_t)apart.n_nodes * sizeof *force);
    double *pressure = force + 2 * apart.n_nodes, felt = 0.0, of_pairs = 0.0, least = INFINITY;
    assert_ok(dem_simulation_advance(simulation, 1e-5));
    const dem_surfaces seen = ask_surfaces(simulation);
    assert_true(seen.pushing > 0);
    assert_int_equal(seen.left_out, 0);
    for (dem_index k = 0; k < seen.pushing; k++) {
        assert_ok(dem_simulation_pair(simulation, k, &p));
        least = fmin(least, p.gap);
        of_pairs += p.body == 1 ? p.force[0] : -p.force[0];
    }
    assert_close(least, seen.gap_min, 1e-15); /* rounding of places */
    assert_int_equal(dem_simulation_pair(simulation, seen.pushing, &p), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_pair(simulation, -1, &p), DEM_ERROR_ARGUMENT);
    assert_ok(dem_simulation_contact_forces(simulation, force));
    for (dem_index i = apart.n_nodes / 2; i < apart.n_nodes; i++) felt += force[2 * i];
    assert_close(of_pairs, felt, 1e-12 * felt);
    o.bodies = DEM_BODIES_NONE;
    CLEANUP(free_simulation) dem_simulation *without = support_simulation(model, &o);
    assert_int_equal(dem_simulation_pair(without, 0, &p), DEM_ERROR_ARGUMENT);
    assert_ok(dem_simulation_contact_forces(without, force));
    assert_ok(dem_simulation_contact_pressures(without, pressure));
    for (dem_index i = 0; i < 3 * apart.n_nodes; i++) assert_close(force[i], 0.0, 0.0);
}

/* A block at rest on a fixed one, flat on flat: pressure times area of its nodes is its weight, and so is the sum of
 * the forces on it. With mass damping, of some 4/5 of the critical one of 5e3 1/s, e^-50 of the motion is left. */
TEST(pressure_times_area_carries_a_block_at_rest)
{
    dem_material thin = rubber;
    thin.thickness = 0.02;
    CLEANUP(dem_lattice_free) dem_lattice blocks = support_rectangle(0.03, 0.026, 5e-3, &thin);
    CLEANUP(dem_lattice_free) dem_lattice upper = support_rectangle(0.03, 0.026, 5e-3, &thin);
    const dem_index half = upper.n_nodes, n = 2 * half;
    double sum = 0.0, lift = 0.0;
    dem_lattice_move(&upper, 0.0, (const double[2]){0.37 * 5e-3, support_top(&blocks) + 0.995e-3});
    assert_ok(dem_lattice_append(&blocks, &upper));
    if (blocks.flags == NULL) blocks.flags = calloc((size_t)n, sizeof *blocks.flags);
    for (dem_index i = 0; i < half; i++) blocks.flags[i] |= DEM_NODE_FIXED;
    CLEANUP(free_model) dem_model *model = support_model(&blocks, NULL, 0);
    dem_options o = touching();
    o.gravity[1] = -9.81;
    o.mass_damping = 4e3;
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    CLEANUP(free_memory) dem_index *nodes = malloc((size_t)n * sizeof *nodes);
    CLEANUP(free_memory) double *values = malloc(4 * (size_t)n * sizeof *values);
    double *force = values, *pressure = values + 2 * n, *area = values + 3 * n;
    for (dem_index i = 0; i < n; i++) nodes[i] = i;
    assert_ok(dem_lattice_edge_shares(&blocks, nodes, n, NULL, area));
    assert_ok(dem_simulation_advance(simulation, 0.03));
    assert_ok(dem_simulation_contact_forces(simulation, force));
    assert_ok(dem_simulation_contact_pressures(simulation, pressure));
    for (dem_index i = half; i < n; i++) {
        sum += pressure[i] * area[i];
        lift += force[2 * i + 1];
    }
    const double weight = 9.81 * ask_body(simulation, 1).mass;
    assert_close(lift, weight, 1e-6 * weight);
    assert_close(sum, weight, 1e-6 * weight);
}

/* ---- friction ---- */

/* Squares that press each other; the second one begins to slide along the first one. */
static dem_simulation *slide(const dem_model *model, const dem_options *options)
{
    dem_simulation *simulation = support_simulation(model, options);
    const dem_lattice *l = &simulation->model->lattice;
    CLEANUP(free_memory) double *v = calloc(2 * (size_t)l->n_nodes, sizeof *v);
    for (dem_index i = 0; i < l->n_nodes; i++) v[2 * i + 1] = l->body[i] == 1 ? 1.0 : 0.0;
    assert_ok(dem_simulation_set_motion(simulation, NULL, v));
    assert_ok(dem_simulation_advance(simulation, 1e-5));
    assert_true(surface_contact_stored(simulation->surfaces, ask_state(simulation).x) > 0.0);
    return simulation;
}

static dem_options rubbing(void)
{
    dem_options options = touching();
    options.contact_friction = 0.5;
    options.checkpoint_steps = 1;
    return options;
}

/* It is no part of the change: the ledger stays, to the rounding of energies of some J. */
TEST(a_motion_that_is_set_loses_what_friction_has_stored)
{
    CLEANUP(dem_lattice_free) dem_lattice apart = make_squares(5e-4);
    CLEANUP(free_model) dem_model *model = support_model(&apart, NULL, 0);
    const dem_options o = rubbing();
    CLEANUP(free_simulation) dem_simulation *simulation = slide(model, &o);
    const dem_energy before = ask_energy(simulation);
    const double stored = surface_contact_stored(simulation->surfaces, ask_state(simulation).x);
    const size_t size = 2 * (size_t)apart.n_nodes * sizeof(double);
    CLEANUP(free_memory) double *v = malloc(size);
    memcpy(v, ask_state(simulation).v, size);
    assert_ok(dem_simulation_set_motion(simulation, NULL, v));
    const dem_energy after = ask_energy(simulation);
    assert_close(after.contact, before.contact - stored, 1e-14);
    assert_close(after.friction, before.friction + stored, 1e-14);
    assert_close(after.boundary, before.boundary, 1e-14);
    assert_close(after.ledger, before.ledger, 1e-13);
}

TEST(friction_of_a_damaged_checkpoint_is_refused)
{
    CLEANUP(dem_lattice_free) dem_lattice apart = make_squares(5e-4);
    CLEANUP(free_model) dem_model *model = support_model(&apart, NULL, 0);
    const dem_options o = rubbing();
    CLEANUP(free_simulation) dem_simulation *simulation = slide(model, &o);
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = last_record(simulation);
    dem_simulation *resumed = NULL;
    assert_ok(dem_checkpoint_put(checkpoint, "friction", "12345678", 8));
    assert_int_equal(dem_simulation_resume(&resumed, model, &o, checkpoint), DEM_ERROR_IO);
    assert_message_parts("the checkpoint has 8 bytes of friction, which has 24 bytes for each node");
    assert_null(resumed);
}

TEST(friction_is_given_to_all_bodies_or_none)
{
    CLEANUP(dem_lattice_free) dem_lattice apart = make_squares(1e-3);
    CLEANUP(free_model) dem_model *model = support_model(&apart, NULL, 0);
    const double frictions[3] = {0.1, 0.2, 0.3};
    dem_options o = touching();
    dem_simulation *simulation = NULL;
    o.n_body_frictions = 3;
    o.body_friction = frictions;
    assert_int_equal(dem_simulation_create(&simulation, model, &o), DEM_ERROR_ARGUMENT);
    assert_message_parts("body_friction is of 3 bodies, but there are 2");
    o.n_body_frictions = 2;
    assert_ok(dem_simulation_create(&simulation, model, &o));
    assert_close(contact_surface_law(&simulation->surfaces->surface, 0, 1).friction, 0.1, 0.0);
    assert_close(contact_surface_law(&simulation->surfaces->surface, 1, 1).friction, 0.2, 0.0);
    dem_simulation_destroy(simulation);
}
