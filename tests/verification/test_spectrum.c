/* SPDX-License-Identifier: BSD-3-Clause */
/* Frequencies of free solids about their rest shape, by GSL from their own forces: none below zero but the three rigid
 * motions', none above dem_model_omega_max(), for any Poisson's ratio. */
#include "dense.h"
#include "harness/cleanup_gsl.h"

static const double spacing = 5e-3;

static dem_model *make_model(dem_lattice *lattice, double nu, dem_plane plane)
{
    const dem_material solid = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = nu, .plane = plane,
                                     .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    assert_ok(dem_lattice_assemble(lattice, &solid));
    dem_model *model = support_model(lattice, NULL, 0);
    dem_lattice_free(lattice);
    return model;
}

/* omega^2, ascending. K is taken over 1e-4 spacings: relative errors of 1e-8 by the third order of the forces. */
static gsl_vector *frequencies_of(const dem_model *model)
{
    const dem_lattice *lattice = dem_model_lattice(model);
    return dense_frequencies(model, dense_stiffness(model, lattice->x, 1e-4 * spacing));
}

/* Three rigid motions, and no other without force: the smallest of the others is of the order (c/L)^2, that is a
 * (spacing/L)^2 = 1e-3 of the largest. The bound is asked to be above, to the 1e-8 of K, and not to be of no use. */
static void check_frequencies(const dem_model *model, double nu)
{
    CLEANUP(free_vector) gsl_vector *squared = frequencies_of(model);
    const double largest = gsl_vector_get(squared, squared->size - 1), bound = dem_model_omega_max(model);
    for (size_t k = 0; k < 3; k++) assert_close(gsl_vector_get(squared, k), 0.0, 1e-6 * largest);
    assert_true(gsl_vector_get(squared, 3) > 1e-4 * largest);
    assert_true(bound >= sqrt(largest) * (1.0 - 1e-7));
    assert_true(bound <= (nu < 0.3 ? 1.7 : 1.25) * sqrt(largest)); /* it leaves a negative area term out */
    print_message("# nu %.3f: omega_max a/c = %.3f, bound %.3f times that, third free one %.4f of it\n", nu,
                  sqrt(largest) * spacing / sqrt(1e7 / 1050.0), bound / sqrt(largest),
                  sqrt(gsl_vector_get(squared, 3) / largest));
}

static const double ratios[] = {-0.5, 0.0, 0.1, 0.2, 1.0 / 3.0, 0.45};
enum { n_ratios = sizeof ratios / sizeof ratios[0] };

TEST(blocks_are_stable_and_the_bound_is_above_their_frequencies)
{
    for (int k = 0; k < n_ratios; k++) {
        dem_lattice lattice = dem_lattice_empty();
        assert_ok(dem_lattice_rectangle(&lattice, 0.04, 0.04, spacing));
        CLEANUP(free_model) dem_model *model = make_model(&lattice, ratios[k], DEM_PLANE_STRESS);
        check_frequencies(model, ratios[k]);
    }
}

TEST(discs_are_stable_and_the_bound_is_above_their_frequencies)
{
    for (int k = 0; k < n_ratios; k++) {
        dem_lattice lattice = dem_lattice_empty();
        assert_ok(dem_lattice_disc(&lattice, 0.02, spacing));
        CLEANUP(free_model) dem_model *model = make_model(&lattice, ratios[k], DEM_PLANE_STRAIN);
        check_frequencies(model, ratios[k]);
    }
}

/* (omega_max a/c)^2 of blocks, by an independent program, to its digits. The highest mode sits in a corner, so that the
 * size of the block does not matter; but at nu = 0 it spreads, and the last digit depends on the size. */
TEST(the_highest_frequency_of_a_block_is_that_of_an_independent_program)
{
    static const double table[][2] = {{0.0, 5.47},  {0.1, 5.56}, {0.2, 5.85}, {1.0 / 3.0, 6.55},
                                      {0.45, 7.58}, {0.5, 8.19}, {0.7, 12.86}};
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
        dem_lattice lattice = dem_lattice_empty();
        assert_ok(dem_lattice_rectangle(&lattice, 0.04, 0.04, spacing));
        CLEANUP(free_model) dem_model *model = make_model(&lattice, table[k][0], DEM_PLANE_STRESS);
        CLEANUP(free_vector) gsl_vector *squared = frequencies_of(model);
        const double highest = gsl_vector_get(squared, squared->size - 1) * spacing * spacing / (1e7 / 1050.0);
        assert_close(highest, table[k][1], k == 0 ? 2e-2 : 1e-2);
    }
}

/* Corners that move by turns along one diagonal, h each: the sides have the energy 2 k h^2, k = E h/(1 + nu), the
 * area term 4 kappa h^2, the motion 1/2 m h'^2. So omega^2 = 4 (k + 2 kappa)/m; along the other diagonal, which the
 * triangles share, no area changes. Below r = (1 + nu)/(2 (1 - nu)) it is > 0. */
TEST(a_square_cell_warps_with_the_frequency_of_its_sides_and_areas)
{
    static const double table[][2] = {{0.0, 0.49}, {0.2, 0.7}, {1.0 / 3.0, 0.5}, {0.45, 1.3}, {-0.5, 0.16}};
    for (size_t j = 0; j < sizeof table / sizeof table[0]; j++) {
        const double nu = table[j][0], r = table[j][1], k = 1e7 / (1.0 + nu);
        const double kappa = 1e7 * ((1.0 + r) * nu - r) / (1.0 - nu * nu), m = 1050.0 * spacing * spacing;
        const dem_material solid =
            SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = nu, .density = 1050.0, .thickness = 1.0);
        CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
        assert_ok(dem_lattice_squares(&lattice, spacing, spacing, spacing));
        assert_ok(dem_lattice_assemble_squares(&lattice, &solid, r));
        CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
        CLEANUP(free_vector) gsl_vector *squared = frequencies_of(model);
        const double largest = gsl_vector_get(squared, 7), warps[2] = {4.0 * k / m, 4.0 * (k + 2.0 * kappa) / m};
        for (int w = 0; w < 2; w++) {
            double nearest = INFINITY;
            for (size_t q = 3; q < 8; q++) nearest = fmin(nearest, fabs(gsl_vector_get(squared, q) - warps[w]));
            assert_close(nearest / largest, 0.0, 1e-7);
        }
    }
}
