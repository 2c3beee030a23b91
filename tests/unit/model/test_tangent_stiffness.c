/* SPDX-License-Identifier: BSD-3-Clause */
/* tangent_stiffness.c, tangent_stiffness.h: products with the stiffness about any state, and the equilibrium that they
 * lead to. */
#include "verification/dense.h"

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_rng.h>

#include "forces/forces.h"
#include "harness/cleanup_gsl.h"
#include "ask.h"
#include "harness/message.h"
#include "model/tangent_stiffness.h"

static const double spacing = 0.01;

static dem_model *make_block(double nu)
{
    const dem_material solid = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = nu, .density = 1050.0,
                                     .thickness = 1.0, .guard = 0.02);
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(0.04, 0.05, spacing, &solid);
    dem_model *model = support_model(&lattice, NULL, 0);
    return model;
}

static double *zeros(const dem_model *model)
{
    double *array = calloc(2 * (size_t)model->lattice.n_nodes, sizeof *array);
    assert_non_null(array);
    return array;
}

static double *random_field(const dem_model *model, unsigned long seed, double size)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double *field = zeros(model);
    assert_non_null(rng);
    gsl_rng_set(rng, seed);
    for (dem_index k = 0; k < 2 * model->lattice.n_nodes; k++) field[k] = size * (2.0 * gsl_rng_uniform(rng) - 1.0);
    return field;
}

/* Squeezed to 0.3 of its height, sheared and stirred by a tenth of the spacing: some triangles are guarded. */
static double *squeezed(const dem_model *model, unsigned long seed)
{
    double *x = random_field(model, seed, 0.1 * spacing);
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) {
        x[2 * i] += 1.1 * model->lattice.x[2 * i] + 0.2 * model->lattice.x[2 * i + 1];
        x[2 * i + 1] += 0.3 * model->lattice.x[2 * i + 1];
    }
    return x;
}

/* Central differences of forces_of_elements() over 1e-7 spacings along a motion: rounding 1e-16 * 1e5 N/1e-7 against
 * forces of 1e7 N/m times unit displacements, truncation smaller. */
TEST(it_is_the_derivative_of_the_forces_about_any_state)
{
    for (unsigned long trial = 1; trial <= 10; trial++) {
        CLEANUP(free_model) dem_model *model = make_block(trial % 2 == 0 ? 0.1 : 0.45);
        const dem_index n = model->lattice.n_nodes;
        const double step = 1e-7 * spacing;
        const forces acting = {.model = model};
        double *x = squeezed(model, trial), *u = random_field(model, 100 + trial, 1.0), *out = zeros(model);
        double *above = zeros(model), *below = zeros(model), *still = zeros(model);
        for (dem_index k = 0; k < 2 * n; k++) {
            above[k] = x[k] + step * u[k];
            below[k] = x[k] - step * u[k];
        }
        assert_true(ask_sizes(model).n_triangles > 0);
        tangent_apply(model, x, u, out);
        for (dem_index i = 0; i < n; i++) {
            const vec2 change =
                vec2_sub(forces_of_elements(&acting, i, below, still), forces_of_elements(&acting, i, above, still));
            assert_close(out[2 * i], change.x / (2.0 * step), 1e-6 * 1e7);
            assert_close(out[2 * i + 1], change.y / (2.0 * step), 1e-6 * 1e7);
        }
        free(x), free(u), free(out), free(above), free(below), free(still);
    }
}

static double product(const dem_model *model, const double *a, const double *b)
{
    double sum = 0.0;
    for (dem_index k = 0; k < 2 * model->lattice.n_nodes; k++) sum += a[k] * b[k];
    return sum;
}

TEST(it_is_symmetric)
{
    CLEANUP(free_model) dem_model *model = make_block(0.45);
    double *x = squeezed(model, 7), *u = random_field(model, 8, 1.0), *v = random_field(model, 9, 1.0);
    double *ku = zeros(model), *kv = zeros(model);
    tangent_apply(model, x, u, ku);
    tangent_apply(model, x, v, kv);
    const double scale = sqrt(product(model, ku, ku) * product(model, v, v));
    assert_close(product(model, ku, v), product(model, kv, u), 1e-13 * scale);
    free(x), free(u), free(v), free(ku), free(kv);
}

/* Shifted, or turned about the origin, a lattice at rest feels nothing: rounding of k u, 1e7 N/m times 0.1 m. */
TEST(rigid_motions_take_no_force_at_rest)
{
    CLEANUP(free_model) dem_model *model = make_block(0.1);
    double *u = zeros(model), *out = zeros(model);
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) {
        u[2 * i] = 0.3 - model->lattice.x[2 * i + 1];
        u[2 * i + 1] = -0.2 + model->lattice.x[2 * i];
    }
    tangent_apply(model, model->lattice.x, u, out);
    for (dem_index k = 0; k < 2 * model->lattice.n_nodes; k++) assert_close(out[k], 0.0, 1e-14 * 1e7);
    free(u), free(out);
}

/* ---- equilibrium ---- */

/* Nodes of the lower face are held. */
static unsigned char *hold_below(const dem_model *model)
{
    unsigned char *held = calloc((size_t)model->lattice.n_nodes, 1);
    assert_non_null(held);
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) held[i] = model->lattice.x[2 * i + 1] < 0.5 * spacing;
    return held;
}

/* GSL's Cholesky factors of the dense matrix, with ones on the diagonal where a node is held. */
static gsl_vector *dense_solution(const dem_model *model, const unsigned char *held, const double *f)
{
    const size_t n = 2 * (size_t)model->lattice.n_nodes;
    CLEANUP(free_matrix) gsl_matrix *k = dense_stiffness(model, model->lattice.x, 1e-5 * spacing);
    gsl_vector *u = gsl_vector_alloc(n);
    for (size_t i = 0; i < n; i++) {
        gsl_vector_set(u, i, held[i / 2] ? 0.0 : f[i]);
        for (size_t j = 0; j < n; j++)
            if (held[i / 2] || held[j / 2]) gsl_matrix_set(k, i, j, i == j ? 1e7 : 0.0);
    }
    assert_int_equal(gsl_linalg_cholesky_decomp1(k), 0);
    assert_int_equal(gsl_linalg_cholesky_svx(k, u), 0);
    return u;
}

/* The dense matrix is of central differences: 1e-10 by their truncation, 1e-11 by rounding, of displacements of 1e-7
 * m, times the condition of 1e3. */
TEST(equilibrium_is_that_of_a_dense_factorization)
{
    CLEANUP(free_model) dem_model *model = make_block(0.1);
    unsigned char *held = hold_below(model);
    double *f = random_field(model, 3, 1.0), *u = zeros(model), *image = zeros(model), residual = 0.0;
    CLEANUP(free_vector) gsl_vector *expected = dense_solution(model, held, f);
    memcpy(u, f, 2 * (size_t)model->lattice.n_nodes * sizeof *u);
    assert_ok(tangent_solve(model, model->lattice.x, held, 1e-12, u));
    tangent_apply(model, model->lattice.x, u, image);
    for (dem_index k = 0; k < 2 * model->lattice.n_nodes; k++) {
        assert_close(u[k], gsl_vector_get(expected, (size_t)k), 1e-6 * 1e-7);
        if (held[k / 2]) assert_close(u[k], 0.0, 0.0);
        if (!held[k / 2]) residual += (f[k] - image[k]) * (f[k] - image[k]);
    }
    assert_close(sqrt(residual), 0.0, 1e-11); /* the residual is followed, not computed anew */
    free(held), free(f), free(u), free(image);
}

TEST(nothing_is_done_where_forces_are_below_the_residual)
{
    CLEANUP(free_model) dem_model *model = make_block(0.1);
    unsigned char *held = hold_below(model);
    double *u = zeros(model);
    u[2 * model->lattice.n_nodes - 1] = 0.5;
    assert_ok(tangent_solve(model, model->lattice.x, held, 0.5, u));
    for (dem_index k = 0; k < 2 * model->lattice.n_nodes; k++) assert_close(u[k], 0.0, 0.0);
    free(held), free(u);
}

/* Springs under pressure push a bowed chain further out. */
TEST(an_unstable_state_is_refused)
{
    const double x[6] = {0.0, 0.0, 0.5, 0.0, 1.0, 0.0}, mass[3] = {1.0, 1.0, 1.0};
    const dem_index ends[4] = {0, 1, 1, 2};
    const unsigned char held[3] = {1, 0, 1};
    double u[6] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(3, x, mass, 2, ends, 1.0, 100.0, NULL);
    CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
    assert_int_equal(tangent_solve(model, x, held, 1e-9, u), DEM_ERROR_MODEL);
    assert_message_parts("stable * displacement * 1");
}
