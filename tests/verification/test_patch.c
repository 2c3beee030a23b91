/* SPDX-License-Identifier: BSD-3-Clause */
/* The patch test: in a block of a regular lattice under any uniform strain every node, those of the boundary and the
 * corners too, has the one stress that the lattice's law gives, to rounding.
 *
 * With F the deformation and e_b the directions of the springs, lambda_b = |F e_b| is the stretch of all springs
 * along e_b. The sum of r x f over a cell is S = sum over b of c_b (lambda_b - 1)/lambda_b (F e_b)(F e_b)^T. For
 * equilateral triangles c_b = 8/3 G in the three directions; for squares whose diagonals are r times as stiff as their
 * sides, E h/(1 + nu), it is E/(1 + nu) along the sides, 2 r times that along the diagonals. The area term adds
 * kappa/h J (J - 1), J = det F, to xx and yy. To first order both are E and nu; at r = 1/2 squares are isotropic. */
#include "support.h"

#include <stdbool.h>
#include <stdlib.h>

static const double modulus = 2.5e7, thickness = 0.3, spacing = 5e-3;

typedef struct law {
    int n;                               /* directions */
    double stiffness[4], at[4][2], area; /* c_b; kappa/h */
} law;

static const double diagonal = 0.70710678118654752440, half_sqrt3 = 0.86602540378443864676;

/* Plane stress: G = E/(2 (1 + nu)), kappa/h = lambda - G, lambda = E nu/(1 - nu^2). */
static law triangular(double nu)
{
    const double G = modulus / (2.0 * (1.0 + nu)), lambda = modulus * nu / (1.0 - nu * nu), c = 8.0 / 3.0 * G;
    return (law){3, {c, c, c}, {{1.0, 0.0}, {0.5, half_sqrt3}, {-0.5, half_sqrt3}}, lambda - G};
}

static law square(double nu, double r)
{
    const double k = modulus / (1.0 + nu), c = 2.0 * r * k;
    return (law){4,
                 {k, k, c, c},
                 {{1.0, 0.0}, {0.0, 1.0}, {diagonal, diagonal}, {-diagonal, diagonal}},
                 modulus * ((1.0 + r) * nu - r) / (1.0 - nu * nu)};
}

static void exact_stress(const law *d, const double F[4], double stress[3])
{
    const double J = F[0] * F[3] - F[1] * F[2];
    stress[0] = stress[1] = d->area * J * (J - 1.0);
    stress[2] = 0.0;
    for (int b = 0; b < d->n; b++) {
        const double x = F[0] * d->at[b][0] + F[1] * d->at[b][1], y = F[2] * d->at[b][0] + F[3] * d->at[b][1];
        const double stretch = hypot(x, y), tension = d->stiffness[b] * (stretch - 1.0) / stretch;
        stress[0] += tension * x * x;
        stress[1] += tension * y * y;
        stress[2] += tension * x * y;
    }
}

/* ---- blocks ---- */

static dem_lattice make_triangular(double nu, dem_plane plane)
{
    const dem_material material = SIZED(dem_material, .youngs_modulus = modulus, .poissons_ratio = nu, .plane = plane,
                                        .density = 1000.0, .thickness = thickness, .guard = 0.02);
    dem_lattice lattice = support_rectangle(8 * spacing, 6 * spacing, spacing, &material);
    return lattice;
}

static dem_lattice make_square(double nu, double r)
{
    const dem_material material = SIZED(dem_material, .youngs_modulus = modulus, .poissons_ratio = nu,
                                        .density = 1000.0, .thickness = thickness, .guard = 0.02);
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_squares(&lattice, 6 * spacing, 5 * spacing, spacing));
    assert_ok(dem_lattice_assemble_squares(&lattice, &material, r));
    return lattice;
}

/* ---- the law ---- */

/* The stresses of the lattice under x -> F x; to be freed. */
static double *stresses(dem_lattice *lattice, const double F[4])
{
    const dem_index n = lattice->n_nodes;
    CLEANUP(support_close) support_run run;
    dem_options options = support_options();
    double *stress = malloc(3 * (size_t)n * sizeof *stress);
    free(lattice->position);
    lattice->position = malloc(2 * (size_t)n * sizeof *lattice->position);
    assert_true(stress != NULL && lattice->position != NULL);
    for (dem_index i = 0; i < n; i++)
        for (int c = 0; c < 2; c++)
            lattice->position[2 * i + c] = F[2 * c] * lattice->x[2 * i] + F[2 * c + 1] * lattice->x[2 * i + 1];
    support_open(&run, lattice, NULL, 0, &options);
    dem_simulation_stress(run.simulation, stress);
    return stress;
}

static const double cases[][4] = {
    {1.0 + 1e-3, 0.0, 0.0, 1.0}, /* uniaxial strain */
    {1.0, 0.0, 0.0, 1.0 - 2e-2}, /* the other axis */
    {1.0, 0.05, 0.0, 1.0},       /* simple shear */
    {1.3, 0.0, 0.0, 0.85},       /* large stretch and compression */
    {0.6, -0.8, 0.8, 0.6},       /* a turn: no stress */
    {0.72, -0.76, 0.91, 0.44},   /* a turn and a stretch */
};
enum { n_cases = sizeof cases / sizeof *cases };

static const double ratios[] = {0.0, 0.1, 1.0 / 3.0, 0.45};
enum { n_ratios = sizeof ratios / sizeof *ratios };

/* Rounding: strains are differences of coordinates of some 10 spacings over one. */
static void check_block(dem_lattice *lattice, const law *d)
{
    for (int k = 0; k < n_cases; k++) {
        double expected[3], *stress = stresses(lattice, cases[k]);
        exact_stress(d, cases[k], expected);
        for (dem_index i = 0; i < 3 * lattice->n_nodes; i++) assert_close(stress[i], expected[i % 3], 1e-12 * modulus);
        free(stress);
    }
    dem_lattice_free(lattice);
}

TEST(every_node_of_a_triangular_block_has_the_exact_stress)
{
    for (int k = 0; k < n_ratios; k++) {
        const law d = triangular(ratios[k]);
        dem_lattice lattice = make_triangular(ratios[k], DEM_PLANE_STRESS);
        check_block(&lattice, &d);
    }
}

static bool is_warping(double nu, double r)
{
    return 2.0 * r * (1.0 - nu) >= 1.0 + nu;
}

TEST(every_node_of_a_square_block_has_the_exact_stress)
{
    static const double diagonals[] = {0.5, 0.3, 0.8};
    for (int k = 0; k < 3 * n_ratios; k++) {
        if (is_warping(ratios[k % n_ratios], diagonals[k / n_ratios])) continue;
        const law d = square(ratios[k % n_ratios], diagonals[k / n_ratios]);
        dem_lattice lattice = make_square(ratios[k % n_ratios], diagonals[k / n_ratios]);
        check_block(&lattice, &d);
    }
}

/* Stresses of a plate of E and nu, to what is quadratic in a strain of 1e-7. */
static void check_hooke(dem_lattice *lattice, double E, double nu)
{
    const double xx = 1e-7, yy = -4e-8, xy = 3e-8, F[4] = {1.0 + xx, 2.0 * xy, 0.0, 1.0 + yy};
    const double plate = E / (1.0 - nu * nu);
    CLEANUP(free_memory) double *stress = stresses(lattice, F);
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        assert_close(stress[3 * i], plate * (xx + nu * yy), 2e-13 * modulus);
        assert_close(stress[3 * i + 1], plate * (yy + nu * xx), 2e-13 * modulus);
        assert_close(stress[3 * i + 2], plate * (1.0 - nu) * xy, 2e-13 * modulus);
    }
    dem_lattice_free(lattice);
}

/* In plane strain with E/(1 - nu^2) and nu/(1 - nu) in place of E and nu. */
TEST(small_strains_follow_hookes_law)
{
    for (int k = 0; k < n_ratios; k++) {
        const double nu = ratios[k];
        if (!is_warping(nu, 0.5)) {
            dem_lattice squares = make_square(nu, 0.5);
            check_hooke(&squares, modulus, nu);
        }
        dem_lattice thin = make_triangular(nu, DEM_PLANE_STRESS), thick = make_triangular(nu, DEM_PLANE_STRAIN);
        check_hooke(&thin, modulus, nu);
        check_hooke(&thick, modulus / (1.0 - nu * nu), nu / (1.0 - nu));
    }
}

/* Turning a strained body turns its stress: S(Q F) = Q S(F) Q^T; Q by an angle of 3-4-5. */
TEST(stress_turns_with_the_body)
{
    const double c = 0.8, s = 0.6, F[4] = {1.1, 0.2, -0.1, 0.9};
    const double turned[4] = {c * F[0] - s * F[2], c * F[1] - s * F[3], s * F[0] + c * F[2], s * F[1] + c * F[3]};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_triangular(0.45, DEM_PLANE_STRESS);
    CLEANUP(free_memory) double *before = stresses(&lattice, F), *after = stresses(&lattice, turned);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        const double xx = before[3 * i], yy = before[3 * i + 1], xy = before[3 * i + 2];
        assert_close(after[3 * i], c * c * xx + s * s * yy - 2.0 * s * c * xy, 1e-12 * modulus);
        assert_close(after[3 * i + 1], s * s * xx + c * c * yy + 2.0 * s * c * xy, 1e-12 * modulus);
        assert_close(after[3 * i + 2], s * c * (xx - yy) + (c * c - s * s) * xy, 1e-12 * modulus);
    }
}
