/* SPDX-License-Identifier: BSD-3-Clause */
/* crack_energy.c: a row that is broken across a block takes the fracture energy that the material was given, or that
 * its strength means, times its area, in plane stress and strain, brittle and softening, of triangles and squares. */
#include "verification/support.h"

#include <stdlib.h>

#include "ask.h"

static const double spacing = 0.005, thickness = 0.3, modulus = 5e10;

static dem_material stone(dem_plane plane, double nu, double strength, double fracture_energy)
{
    return (dem_material){.struct_size = sizeof(dem_material),
                          .youngs_modulus = modulus,
                          .poissons_ratio = nu,
                          .plane = plane,
                          .density = 2600.0,
                          .thickness = thickness,
                          .strength = strength,
                          .fracture_energy = fracture_energy};
}

static dem_lattice block_of(const dem_material *m, bool squares)
{
    dem_lattice l = dem_lattice_empty();
    if (squares) {
        assert_ok(dem_lattice_squares(&l, 0.03, 0.05, spacing));
        assert_ok(dem_lattice_assemble_squares(&l, m, 0.5));
    } else {
        assert_ok(dem_lattice_rectangle(&l, 0.03, 0.052, spacing));
        assert_ok(dem_lattice_assemble(&l, m));
    }
    return l;
}

/* Energy over length of what is broken between two heights, J/m. */
static double break_row(const dem_lattice *l)
{
    const dem_options options = dem_options_default();
    CLEANUP(support_close) support_run run;
    dem_index row[64], n = 0;
    double energy = -1.0;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        int above = 0;
        for (int c = 0; c < 3; c++) above += l->x[2 * l->triangles[3 * t + c] + 1] > 0.026;
        if (above == 1 || above == 2) row[n++] = t;
        assert_true(n < 64);
    }
    support_open(&run, l, NULL, 0, &options);
    assert_ok(dem_simulation_crack_energy(run.simulation, &energy));
    assert_close(energy, 0.0, 0.0);
    assert_ok(dem_simulation_break(run.simulation, row, n, NULL, 0));
    assert_ok(dem_simulation_crack_energy(run.simulation, &energy));
    return energy / ask_fracture(run.simulation).crack_length;
}

/* Of a material with a fracture energy it is that to rounding, whatever else it is. */
TEST(a_crack_takes_the_fracture_energy_that_was_given)
{
    const double energy = 90.0;
    for (int squares = 0; squares < 2; squares++)
        for (int strain = 0; strain < 2; strain++)
            for (int softens = 0; softens < 2; softens++)
                for (int k = 0; k < 3; k++) {
                    const double nu[] = {0.1, 1.0 / 3.0, 0.4}, strength = softens ? 6e6 : 0.0;
                    dem_material m = stone(strain ? DEM_PLANE_STRAIN : DEM_PLANE_STRESS, nu[k], strength, energy);
                    m.springs = squares ? DEM_SPRINGS_INDEPENDENT : DEM_SPRINGS_COUPLED;
                    CLEANUP(dem_lattice_free) dem_lattice l = block_of(&m, squares);
                    assert_close(break_row(&l), energy * thickness, 1e-12 * energy * thickness);
                }
}

TEST(so_it_does_by_the_stress_of_elements)
{
    dem_material m = stone(DEM_PLANE_STRESS, 0.2, 6e6, 90.0);
    m.stress_average = DEM_STRESS_AVERAGE_ELEMENT;
    CLEANUP(dem_lattice_free) dem_lattice l = block_of(&m, false);
    assert_close(break_row(&l), 90.0 * thickness, 1e-12 * 90.0);
}

/* 3.4 strength^2 a/E, a the spacing. */
TEST(a_strength_alone_means_a_fracture_energy)
{
    const dem_material m = stone(DEM_PLANE_STRESS, 0.2, 1e7, 0.0);
    CLEANUP(dem_lattice_free) dem_lattice l = block_of(&m, false);
    assert_close(break_row(&l), 3.4 * 1e14 * spacing / modulus * thickness, 1e-11);
}

TEST(without_strengths_or_moduli_none_is_known)
{
    const dem_material m = stone(DEM_PLANE_STRESS, 0.2, 1e7, 0.0), whole = stone(DEM_PLANE_STRESS, 0.2, 0.0, 0.0);
    CLEANUP(dem_lattice_free) dem_lattice l = block_of(&m, false);
    CLEANUP(dem_lattice_free) dem_lattice other = block_of(&whole, false);
    free(l.modulus);
    l.modulus = NULL;
    assert_close(break_row(&l), 0.0, 0.0);
    assert_close(break_row(&other), 0.0, 0.0);
}
