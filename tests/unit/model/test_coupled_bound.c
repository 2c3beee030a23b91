/* SPDX-License-Identifier: BSD-3-Clause */
/* coupled_bound.c: its blocks against the tangent stiffness, for displacements at random. How near the bound comes to
 * the highest frequency is shown in tests/verification/test_coupled.c. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>

#include "harness/cleanup_gsl.h"
#include "model/coupled_bound.h"
#include "model/tangent_stiffness.h"
#include "unit/solids.h"

static const double spacing = 2.5e-3;

static dem_lattice make_jittered(double nu)
{
    dem_material material = rubber;
    material.poissons_ratio = nu;
    material.springs = DEM_SPRINGS_COUPLED;
    dem_lattice lattice = make_rectangle(0.02, 0.02, spacing);
    assert_ok(dem_lattice_jitter(&lattice, 0.3 * spacing, 1));
    assert_ok(dem_lattice_assemble(&lattice, &material));
    return lattice;
}

/* u.(2 S + 3 T + C) u of node i. */
static double bound_of(const dem_model *m, const sym2 *coupled, dem_index i, vec2 u)
{
    const sym2 S = springs_block(&m->springs, m->springs.stiffness_of, i, m->lattice.x);
    const sym2 T = triangles_block(&m->triangles, i, m->lattice.x), *C = &coupled[i];
    const double xx = 2.0 * S.xx + 3.0 * T.xx + C->xx, xy = 2.0 * S.xy + 3.0 * T.xy + C->xy;
    return xx * u.x * u.x + 2.0 * xy * u.x * u.y + (2.0 * S.yy + 3.0 * T.yy + C->yy) * u.y * u.y;
}

static void add_couplings(const dem_model *m, sym2 *block)
{
    double *given = NULL;
    assert_ok(coupled_bound_given(&given, &m->lattice, &m->springs));
    coupled_bound_add(&m->lattice, &m->couplings, given, block);
    free(given);
}

/* The largest u.K u over its bound: of one node moved alone, and of nodes moved along the forces of their last
 * displacements, which come near the highest mode. */
static double closest_to_bound(const dem_lattice *lattice)
{
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_model) dem_model *m = support_model(lattice, NULL, 0);
    const dem_index n = lattice->n_nodes;
    CLEANUP(free_memory) sym2 *coupled = calloc((size_t)n, sizeof *coupled);
    CLEANUP(free_memory) double *u = calloc(4 * (size_t)n, sizeof *u);
    assert_true(coupled != NULL && u != NULL);
    double *force = u + 2 * n, closest = 0.0;
    add_couplings(m, coupled);
    for (int trial = 0; trial < 400; trial++) {
        double work = 0.0, bound = 0.0, largest = 0.0;
        for (dem_index k = 0; k < 2 * n && trial % 40 == 0; k++) force[k] = 2.0 * gsl_rng_uniform(r) - 1.0;
        for (dem_index k = 0; k < 2 * n; k++) largest = fmax(largest, fabs(force[k]));
        for (dem_index k = 0; k < 2 * n; k++) u[k] = force[k] / largest;
        tangent_apply(m, m->lattice.x, u, force);
        for (dem_index i = 0; i < n; i++) {
            work += vec2_dot(vec2_at(u, i), vec2_at(force, i));
            bound += bound_of(m, coupled, i, vec2_at(u, i));
        }
        closest = fmax(closest, work / bound);
    }
    return closest;
}

TEST(the_blocks_bound_the_stiffness_for_every_poissons_ratio)
{
    static const double ratios[] = {-0.5, 0.0, 0.2, 1.0 / 3.0, 0.45};
    for (size_t k = 0; k < sizeof ratios / sizeof *ratios; k++) {
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_jittered(ratios[k]);
        const double closest = closest_to_bound(&lattice);
        assert_true(closest <= 1.0);
        assert_true(closest > 0.5);
    }
}

/* Couplings of any strength and sign, of which a triangle alone may be unstable, and no modulus. */
TEST(couplings_given_otherwise_are_bounded_too)
{
    for (int trial = 0; trial < 20; trial++) {
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_jittered(0.2);
        free(lattice.modulus);
        lattice.modulus = NULL;
        for (dem_index k = 0; k < 3 * lattice.n_triangles; k++)
            lattice.coupling[k] *= 10.0 * sin((double)(trial * 1000 + k));
        assert_true(closest_to_bound(&lattice) <= 1.0);
    }
}

/* At nu = 1/3 a triangle that is all but equilateral has nothing beside its springs: lambda is 2. */
TEST(nearly_equilateral_triangles_add_nothing)
{
    dem_material material = rubber;
    material.springs = DEM_SPRINGS_COUPLED;
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.02, 0.02, spacing);
    assert_ok(dem_lattice_jitter(&lattice, 1e-7 * spacing, 1));
    assert_ok(dem_lattice_assemble(&lattice, &material));
    assert_non_null(lattice.coupling);
    CLEANUP(free_model) dem_model *m = support_model(&lattice, NULL, 0);
    CLEANUP(free_memory) sym2 *coupled = calloc((size_t)lattice.n_nodes, sizeof *coupled);
    assert_non_null(coupled);
    add_couplings(m, coupled);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        const sym2 S = springs_block(&m->springs, m->springs.stiffness_of, i, lattice.x);
        /* 0.1 % from the 1024th root, 1e-6 from the jitter */
        assert_close(sym2_largest(coupled[i]) / sym2_largest(S), 0.0, 0.003);
    }
}
