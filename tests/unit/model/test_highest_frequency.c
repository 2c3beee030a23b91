/* SPDX-License-Identifier: BSD-3-Clause */
/* highest_frequency.c: the highest frequency, against closed forms and GSL. */
#include "harness/cleanup_gsl.h"
#include "unit/domain/shared_lattice.h"
#include "verification/dense.h"

#include <string.h>

#include "harness/rank_threads.h"
#include "model/shared_model.h"

/* sqrt(E/d0 (1/m1 + 1/m2)); one fixed: sqrt(E/d0/m2). */
TEST(a_pair_has_the_frequency_of_its_reduced_mass)
{
    const double x[4] = {0.0, 0.0, 1.2, 1.6}, mass[2] = {1.0, 3.0};
    const dem_index ends[2] = {0, 1};
    const unsigned char fixed[2] = {1, 0};
    for (int k = 0; k < 2; k++) {
        double omega;
        CLEANUP(dem_lattice_free)
        dem_lattice lattice = support_lattice(2, x, mass, 1, ends, 2.0, 100.0, k == 0 ? NULL : fixed);
        CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
        assert_ok(dem_model_omega(model, &omega));
        assert_close(omega, sqrt(50.0 * (k == 0 ? 1.0 + 1.0 / 3.0 : 1.0 / 3.0)), 1e-12);
    }
}

enum { n_chain = 400 };

/* 2 sqrt(k/m) sin(pi j/(2 (N + 1))) of a chain between fixed ends: the highest of 400 are 1e-5 apart, which is what the
 * residual allows; the error is of second order in it where it can tell them apart. */
TEST(a_chain_has_the_frequency_of_its_highest_mode)
{
    static double x[2 * (n_chain + 2)], mass[n_chain + 2];
    static dem_index ends[2 * (n_chain + 1)];
    static unsigned char fixed[n_chain + 2];
    double omega, again;
    for (int i = 0; i < n_chain + 2; i++) {
        x[2 * i] = i;
        mass[i] = 2.0;
        fixed[i] = i == 0 || i == n_chain + 1;
        if (i <= n_chain) ends[2 * i] = i, ends[2 * i + 1] = i + 1;
    }
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = support_lattice(n_chain + 2, x, mass, n_chain + 1, ends, 1.0, 8.0, fixed);
    CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
    assert_ok(dem_model_omega(model, &omega));
    assert_ok(dem_model_omega(model, &again));
    assert_close(omega / (2.0 * 2.0 * sin(0.5 * M_PI * n_chain / (n_chain + 1.0))), 1.0, 1e-6);
    assert_memory_equal(&omega, &again, sizeof omega);
}

/* From below, to the 1e-6 of the residual; K by differences is good to 1e-8. */
TEST(solids_have_the_highest_frequency_that_gsl_finds)
{
    static const double ratios[3] = {0.0, 1.0 / 3.0, 0.45};
    for (int k = 0; k < 6; k++) {
        const dem_material solid = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = ratios[k / 2],
                                         .density = 1050.0, .thickness = 1.0);
        CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
        double omega;
        assert_ok(k % 2 == 0 ? dem_lattice_rectangle(&lattice, 0.05, 0.04, 5e-3)
                             : dem_lattice_disc(&lattice, 0.02, 5e-3));
        assert_ok(dem_lattice_assemble(&lattice, &solid));
        CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
        assert_ok(dem_model_omega(model, &omega));
        CLEANUP(free_vector) gsl_vector *squared = dense_frequencies(model, dense_stiffness(model, lattice.x, 5e-7));
        assert_close(omega / sqrt(gsl_vector_get(squared, squared->size - 1)), 1.0, 1e-6);
        assert_true(omega < dem_model_omega_max(model));
    }
}

/* Takes every third triangle or so away, but the last ones of a node. */
static void break_some(dem_lattice *l, uint64_t seed)
{
    dem_index *left = calloc((size_t)l->n_nodes, sizeof *left), n = 0;
    assert_non_null(left);
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) left[l->triangles[k]]++;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        const dem_index *c = &l->triangles[3 * t];
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        if ((seed >> 33) % 3 == 0 && left[c[0]] > 1 && left[c[1]] > 1 && left[c[2]] > 1) {
            for (int q = 0; q < 3; q++) left[c[q]]--;
            continue;
        }
        for (int q = 0; q < 3; q++) l->triangles[3 * n + q] = c[q];
        n++;
    }
    assert_true(n < l->n_triangles * 4 / 5);
    l->n_triangles = n;
    free(left);
}

/* Masses stay where triangles break, and what is left is stiff as if it had been cut before. */
TEST(what_is_broken_leaves_the_bound_of_the_whole)
{
    static const double ratios[4] = {-0.3, 0.0, 1.0 / 3.0, 0.45};
    for (int k = 0; k < 16; k++) {
        const dem_material solid = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = ratios[k / 4],
                                         .density = 1050.0, .thickness = 1.0, .springs = DEM_SPRINGS_COUPLED);
        CLEANUP(dem_lattice_free) dem_lattice whole = dem_lattice_empty(), broken = dem_lattice_empty();
        double omega;
        for (int which = 0; which < 2; which++) {
            dem_lattice *l = which == 0 ? &whole : &broken;
            assert_ok(dem_lattice_rectangle(l, 0.05, 0.04, 5e-3));
            if (k % 4 > 0) assert_ok(dem_lattice_jitter(l, 1.25e-3, (uint64_t)k));
            if (which == 1) break_some(l, (uint64_t)k + 1);
            assert_ok(dem_lattice_assemble(l, &solid));
        }
        assert_int_equal(broken.n_nodes, whole.n_nodes);
        for (dem_index i = 0; i < whole.n_nodes; i++) broken.mass[i] = whole.mass[i];
        CLEANUP(free_model) dem_model *first = support_model(&whole, NULL, 0);
        CLEANUP(free_model) dem_model *second = support_model(&broken, NULL, 0);
        assert_ok(dem_model_omega(second, &omega));
        assert_true(omega < dem_model_omega_max(first));
    }
}

/* ---- ranks ---- */

enum { N_RANKS = 3 };

typedef struct shared {
    const dem_private_whole *whole;
    double omega[N_RANKS];
    dem_status status[N_RANKS];
} shared;

static void find_shared(const ranks *r, void *context)
{
    shared *s = context;
    CLEANUP(free_model) dem_model *model = NULL;
    dem_status *status = &s->status[r->rank];
    *status = dem_private_share_model(&model, s->whole, r);
    if (*status == DEM_OK) *status = dem_model_omega(model, &s->omega[r->rank]);
}

/* Above a floor, so that ranks have nodes in common, too. */
TEST(ranks_find_the_bits_of_one_process)
{
    const double points[4] = {-1.0, -0.05, 1.0, -0.05};
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = points);
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_model) dem_model *alone = support_model(&l, &floor, 1);
    for (int n = 0; n < 2; n++) {
        const dem_private_whole whole = {.lattice = &l, .obstacles = &floor, .n_obstacles = n};
        shared s = {.whole = &whole};
        double omega;
        assert_ok(dem_model_omega(alone, &omega));
        rank_threads_run(N_RANKS, find_shared, &s);
        for (int k = 0; k < N_RANKS; k++) {
            assert_ok(s.status[k]);
            assert_memory_equal(&s.omega[k], &omega, sizeof omega);
        }
    }
}

TEST(without_springs_or_with_all_nodes_fixed_it_is_zero)
{
    const double x[4] = {0.0, 0.0, 1.0, 0.0}, mass[2] = {1.0, 1.0};
    const dem_index ends[2] = {0, 1};
    const unsigned char fixed[2] = {1, 1};
    for (int k = 0; k < 2; k++) {
        double omega = 1.0;
        CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1 + k, x, mass, k, ends, 1.0, 100.0, fixed);
        CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
        assert_ok(dem_model_omega(model, &omega));
        assert_close(omega, 0.0, 0.0);
        assert_int_equal(dem_model_omega(model, NULL), DEM_ERROR_ARGUMENT);
        assert_int_equal(dem_model_omega(NULL, &omega), DEM_ERROR_ARGUMENT);
    }
}
