/* SPDX-License-Identifier: BSD-3-Clause */
/* elastic_constants.c: which body is measured, what holds it, what follows from the stiffness, and what is refused. */
#include "verification/dense.h"

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>

#include "harness/cleanup_gsl.h"
#include "harness/message.h"
#include "unit/solids.h"

static const double spacing = 0.01;

static dem_lattice make_body(double nu, double modulus)
{
    dem_material solid = rubber;
    solid.poissons_ratio = nu, solid.youngs_modulus = modulus;
    dem_lattice lattice = make_rectangle(0.08, 0.07, spacing);
    assert_ok(dem_lattice_assemble(&lattice, &solid));
    return lattice;
}

static dem_model *make_model(dem_lattice *lattice)
{
    dem_model *model = support_model(lattice, NULL, 0);
    dem_lattice_free(lattice);
    return model;
}

/* C of plane stress; waves sqrt(C11/rho) and sqrt(G/rho); rounding only. */
TEST(a_regular_block_is_measured_exactly)
{
    const double nu = 0.1, E = 1e7, G = 0.5 * E / (1.0 + nu), C11 = E / (1.0 - nu * nu);
    dem_constants c = {.struct_size = sizeof c};
    dem_lattice lattice = make_body(nu, 1e7);
    const double volume = 0.5 * (double)lattice.n_triangles * sqrt(3.0) / 4.0 * spacing * spacing;
    CLEANUP(free_model) dem_model *model = make_model(&lattice);
    assert_ok(dem_model_constants(model, 0, &c));
    const double expected[3][3] = {{C11, nu * C11, 0.0}, {nu * C11, C11, 0.0}, {0.0, 0.0, G}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) assert_close(c.stiffness[i][j], expected[i][j], 1e-12 * E);
    assert_close(c.youngs_modulus, E, 1e-12 * E);
    assert_close(c.poissons_ratio, nu, 1e-12);
    assert_close(c.anisotropy, 1.0, 1e-12);
    assert_close(c.volume, volume, 1e-12 * volume);
    assert_close(c.longitudinal_speed, sqrt(C11 / 1050.0), 1e-10);
    assert_close(c.transverse_speed, sqrt(G / 1050.0), 1e-10);
}

TEST(bodies_are_measured_apart_fixed_nodes_or_not)
{
    const double away[2] = {0.2, 0.1};
    dem_constants soft = {.struct_size = sizeof soft}, stiff = {.struct_size = sizeof stiff};
    dem_lattice lattice = make_body(1.0 / 3.0, 1e7), other = make_body(0.2, 3e7);
    dem_lattice_move(&other, 0.4, away);
    other.flags = calloc((size_t)other.n_nodes, 1);
    assert_non_null(other.flags);
    for (dem_index i = 0; i < other.n_nodes; i++) other.flags[i] = i < 30 ? DEM_NODE_FIXED : 0;
    assert_ok(dem_lattice_append(&lattice, &other));
    dem_lattice_free(&other);
    CLEANUP(free_model) dem_model *model = make_model(&lattice);
    assert_ok(dem_model_constants(model, 0, &soft));
    assert_ok(dem_model_constants(model, 1, &stiff));
    assert_close(soft.youngs_modulus, 1e7, 1e-11 * 1e7);
    assert_close(soft.poissons_ratio, 1.0 / 3.0, 1e-11);
    assert_close(stiff.youngs_modulus, 3e7, 1e-11 * 3e7);
    assert_close(stiff.poissons_ratio, 0.2, 1e-11);
}

static bool is_outside(void *context, const double *x)
{
    (void)context;
    return hypot(x[0], x[1] - 0.035) > 0.012;
}

/* Pores do not count, since their rims are held: the material's constants. */
TEST(a_hole_does_not_change_the_material)
{
    dem_constants c = {.struct_size = sizeof c};
    dem_lattice lattice = make_rectangle(0.08, 0.07, spacing);
    const dem_index n = lattice.n_nodes;
    assert_ok(dem_lattice_cut(&lattice, is_outside, NULL));
    assert_true(lattice.n_nodes < n);
    assert_ok(dem_lattice_assemble(&lattice, &rubber));
    CLEANUP(free_model) dem_model *model = make_model(&lattice);
    assert_ok(dem_model_constants(model, 0, &c));
    assert_close(c.youngs_modulus, 1e7, 1e-11 * 1e7);
    assert_close(c.poissons_ratio, 1.0 / 3.0, 1e-11);
}

/* Energy per volume of a strain with the boundary held, the inside in equilibrium by GSL's Cholesky factors. */
static double dense_energy(const dem_model *model, const unsigned char *inside, const double strain[3])
{
    const dem_lattice *l = dem_model_lattice(model);
    const size_t n = 2 * (size_t)l->n_nodes;
    CLEANUP(free_matrix)
    gsl_matrix *k = dense_stiffness(model, l->x, 1e-5 * spacing), *reduced = gsl_matrix_alloc(n, n);
    CLEANUP(free_vector) gsl_vector *u = gsl_vector_alloc(n), *f = gsl_vector_alloc(n);
    double volume = 0.0, energy;
    for (size_t i = 0; i < n / 2; i++) {
        const double x = l->x[2 * i], y = l->x[2 * i + 1];
        gsl_vector_set(u, 2 * i, strain[0] * x + 0.5 * strain[2] * y);
        gsl_vector_set(u, 2 * i + 1, strain[1] * y + 0.5 * strain[2] * x);
    }
    gsl_blas_dgemv(CblasNoTrans, -1.0, k, u, 0.0, f);
    gsl_matrix_memcpy(reduced, k);
    for (size_t i = 0; i < n; i++) {
        if (!inside[i / 2]) gsl_vector_set(f, i, 0.0);
        for (size_t j = 0; j < n; j++)
            if (!inside[i / 2] || !inside[j / 2]) gsl_matrix_set(reduced, i, j, i == j ? 1e7 : 0.0);
    }
    assert_int_equal(gsl_linalg_cholesky_decomp1(reduced), 0);
    assert_int_equal(gsl_linalg_cholesky_svx(reduced, f), 0);
    gsl_vector_add(u, f);
    gsl_blas_dgemv(CblasNoTrans, 1.0, k, u, 0.0, f);
    gsl_blas_ddot(u, f, &energy);
    for (dem_index t = 0; t < l->n_triangles; t++) volume += l->thickness[t] * area_of(l, t);
    return energy / volume;
}

/* Springs of one stiffness all over: the boundary is too stiff, and the inside of random stiffness moves. e.C e is
 * compared with the dense solution to what the residual of 1e-4 leaves, its square times a few. */
TEST(an_irregular_body_has_the_energy_of_a_dense_factorization)
{
    static const double strains[4][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {0.5, -0.3, 0.8}};
    uint32_t random = 1;
    dem_constants c = {.struct_size = sizeof c};
    dem_lattice lattice = make_body(0.45, 1e7);
    unsigned char inside[200];
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        random = random * 1664525u + 1013904223u;
        lattice.stiffness[k] *= 0.5 + (double)random / 4294967296.0;
    }
    CLEANUP(free_model) dem_model *model = make_model(&lattice);
    const dem_lattice *l = dem_model_lattice(model);
    assert_true(l->n_nodes <= 200);
    for (dem_index i = 0; i < l->n_nodes; i++) inside[i] = (l->flags[i] & DEM_NODE_CONTACT) == 0;
    assert_ok(dem_model_constants(model, 0, &c));
    for (int k = 0; k < 4; k++) {
        const double *e = strains[k];
        double energy = 0.0;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) energy += e[i] * c.stiffness[i][j] * e[j];
        assert_close(energy / dense_energy(model, inside, e), 1.0, 1e-7);
    }
    assert_true(c.anisotropy > 1.001);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++) assert_close(c.stiffness[i][j], c.stiffness[j][i], 1e-7 * c.stiffness[0][0]);
}

TEST(what_cannot_be_measured_is_refused)
{
    const double x[4] = {0.0, 0.0, 1.0, 0.0}, mass[2] = {1.0, 1.0};
    const dem_index ends[2] = {0, 1};
    dem_constants c = {.youngs_modulus = 7.0};
    dem_lattice lattice = support_lattice(2, x, mass, 1, ends, 1.0, 1.0, NULL);
    dem_model *model = support_model(&lattice, NULL, 0);
    dem_lattice_free(&lattice);
    assert_int_equal(dem_model_constants(model, 0, &c), DEM_ERROR_MODEL);
    assert_message_parts("the body has no triangles, whose volume its constants refer to");
    assert_int_equal(dem_model_constants(model, 1, &c), DEM_ERROR_ARGUMENT);
    assert_message_parts("body 1 * 1");
    assert_int_equal(dem_model_constants(model, -1, &c), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_model_constants(model, 0, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_model_constants(NULL, 0, &c), DEM_ERROR_ARGUMENT);
    assert_close(c.youngs_modulus, 7.0, 0.0);
    dem_model_destroy(model);
    for (dem_index every = 1; every < 8; every += 6) { /* the whole; an inside that would fold */
        lattice = make_body(0.1, 1e7);
        for (dem_index t = 0; t < lattice.n_triangles; t++) lattice.area_stiffness[t] = t % every == 0 ? -1e8 : 0.0;
        model = make_model(&lattice);
        assert_int_equal(dem_model_constants(model, 0, &c), DEM_ERROR_MODEL);
        assert_non_null(strstr(dem_status_message(), "not stable"));
        assert_close(c.youngs_modulus, 7.0, 0.0);
        dem_model_destroy(model);
    }
}
