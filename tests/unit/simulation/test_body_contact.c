/* SPDX-License-Identifier: BSD-3-Clause */
/* body_contact.c: what is refused at the start and by set_motion, and the ledger of a motion that was set. How bodies
 * move in contact is in verification/test_bodies.c. */
#include "simulation/body_contact.h"

#include "ask.h"
#include "harness/message.h"
#include "verification/support.h"

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);

/* Two squares of 30 mm side by side with a gap between their corners. */
static dem_lattice make_squares(double gap)
{
    dem_lattice left = support_rectangle(0.03, 0.03, 5e-3, &rubber),
                right = support_rectangle(0.03, 0.03, 5e-3, &rubber);
    dem_lattice_move(&right, 0.0, (const double[2]){0.03 + gap, 0.0});
    assert_ok(dem_lattice_append(&left, &right));
    dem_lattice_free(&right);
    return left;
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

/* The second body is moved into the shell of the first: the energy of contact is work from outside, so that the ledger
 * stays, to the rounding of energies of some J. Into the first body itself it is refused, and all is as it was. Mean
 * velocities keep the rounding of forces of springs, summed over a thousand steps. */
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
    for (dem_index i = n / 2; i < n; i++) x[2 * i] += 1.5e-3;
    assert_ok(dem_simulation_set_motion(simulation, x, NULL));
    const dem_energy pressed = ask_energy(simulation);
    assert_true(pressed.contact > 1e-3);
    const dem_surfaces near = ask_surfaces(simulation);
    assert_close(near.gap_min, 5e-4, 1e-12); /* of the corners; 2 mm at first */
    assert_close(near.gap_share, 0.5, 1e-9);
    assert_true(near.pushing >= 2);
    assert_close(pressed.ledger, 0.0, 1e-12);
    assert_ok(dem_simulation_advance(simulation, 2e-3));
    const dem_energy apart_again = ask_energy(simulation);
    assert_close(apart_again.contact, 0.0, 0.0);
    assert_close(apart_again.motion, pressed.contact, 1e-4 * pressed.contact);
    assert_true(ask_body(simulation, 1).velocity[0] > 0.0);
    assert_close(ask_body(simulation, 0).velocity[0] + ask_body(simulation, 1).velocity[0], 0.0, 1e-12);
}
