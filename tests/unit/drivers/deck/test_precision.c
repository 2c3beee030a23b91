/* SPDX-License-Identifier: BSD-3-Clause */
/* precision.c: tolerances beside the rounding of coordinates and speeds, of a spring from 7 to 8 m that moves at 8 m/s:
 * a rounding of 8 is 1.8e-15. */
#include "unit/reading.h"

#include "precision.h"

static void expect(const char *groups, const char *faults)
{
    double x[4] = {7.0, 0.0, 8.0, 0.0}, mass[2] = {1.0, 1.0}, velocity[4] = {0.0, -8.0}, rest = 1.0, stiffness = 1.0;
    dem_index ends[2] = {0, 1};
    dem_lattice lattice = dem_lattice_empty();
    CLEANUP(drop_resolved) resolved r = resolve(groups);
    lattice = dem_lattice_empty();
    lattice.n_nodes = 2, lattice.x = x, lattice.mass = mass, lattice.velocity = velocity;
    lattice.n_springs = 1, lattice.ends = ends, lattice.rest_length = &rest, lattice.stiffness = &stiffness;
    namelist_errors_free(&r.errors);
    r.errors = (namelist_errors){0};
    precision_check(&r.deck, &lattice, &r.errors);
    char found[1024];
    list_faults(&r.errors, found, sizeof found);
    assert_string_equal(found, faults);
}

TEST(tolerances_beyond_rounding_are_taken)
{
    expect("", "");
    expect("&contact penetration_tolerance = 1.8e-13 /\n&solver rtol = 1e-13, spacing = 0.1, v_scale = 0.1 /\n", "");
}

TEST(a_penetration_tolerance_that_rounding_hides_is_refused)
{
    expect("&contact penetration_tolerance = 1.7e-13 /\n",
           "1:10 'penetration_tolerance' in &contact must be >= 1.8e-13 m, or rounding of coordinates of up to 8 m "
           "hides it, got "
           "1.7e-13 m");
}

TEST(an_error_that_rounding_hides_is_refused)
{
    expect("&solver rtol = 1e-6, spacing = 1.7e-9 /\n",
           "1:22 'rtol' in &solver, 1e-06 of a spacing of 1.7e-09 m, asks for less than rounding makes of coordinates "
           "of up to 8 m");
    expect("&solver spacing = 1.8e-9 /\n", "");
    expect("&solver v_scale = 1.7e-9 /\n",
           "1:9 'rtol' in &solver, 1e-06 of 'v_scale', 1.7e-09 m/s, asks for less than rounding makes of velocities "
           "of up to 8 m/s");
    expect("&solver v_scale = 1.8e-9 /\n", "");
}
