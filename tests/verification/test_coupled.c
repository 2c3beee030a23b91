/* SPDX-License-Identifier: BSD-3-Clause */
/* Coupled springs against Hooke's law, for bodies of any triangles: nodes moved at random, right angles, squares cut in
 * two and moved, rings, and a Delaunay triangulation of random points. Each is a plate with exactly E and nu. */
#include "support.h"

#include <gsl/gsl_rng.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "elastic_bodies.h"
#include "harness/cleanup_gsl.h"
#include "model/tangent_stiffness.h"

static const double E = 1e7, thickness = 0.5;

static const double ratios[] = {0.0, 0.1, 0.2, 0.3, 1.0 / 3.0, 0.4, 0.45};
static const double strains[6][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -1, 0}, {1, 1, 0}, {0.3, -0.7, 0.5}};

static dem_material solid_of(double nu, dem_plane plane)
{
    return (dem_material)SIZED(dem_material, .youngs_modulus = E, .poissons_ratio = nu, .plane = plane,
                               .density = 1050.0, .thickness = thickness, .springs = DEM_SPRINGS_COUPLED);
}

/* ---- bodies ---- */

enum { JITTERED, RIGHT, CUT_SQUARES, RINGS, DELAUNAY, N_SHAPES };

static void make_shape(dem_lattice *l, int shape)
{
    *l = dem_lattice_empty();
    if (shape == JITTERED) assert_ok(dem_lattice_rectangle(l, 8.0, 7.0, 1.0));
    if (shape == RIGHT || shape == CUT_SQUARES) assert_ok(dem_lattice_squares(l, 8.0, 7.0, 1.0));
    if (shape == RINGS) elastic_bodies_rings(l, 5);
    if (shape == DELAUNAY) elastic_bodies_delaunay(l, 40, 150, 3);
    if (shape == JITTERED || shape == CUT_SQUARES) assert_ok(dem_lattice_jitter(l, 0.3, 5));
}

static dem_model *make_model(int shape, double nu, dem_plane plane)
{
    const dem_material solid = solid_of(nu, plane);
    CLEANUP(dem_lattice_free) dem_lattice lattice;
    make_shape(&lattice, shape);
    assert_ok(dem_lattice_assemble(&lattice, &solid));
    assert_non_null(lattice.coupling);
    dem_model *model = support_model(&lattice, NULL, 0);
    return model;
}

/* ---- uniform strains ---- */

/* Stress of Hooke's law, Pa: of plane stress, or of the plate that plane strain is like. */
static void stress_of(double nu, dem_plane plane, const double e[3], double stress[3])
{
    const double G = 0.5 * E / (1.0 + nu);
    const double lambda = plane == DEM_PLANE_STRAIN ? 2.0 * G * nu / (1.0 - 2.0 * nu) : E * nu / (1.0 - nu * nu);
    for (int c = 0; c < 3; c++) stress[c] = 2.0 * G * e[c] + (c < 2 ? lambda * (e[0] + e[1]) : 0.0);
}

/* Forces that a uniform stress asks for at the nodes: half of the traction on each boundary edge at each of its ends,
 * and none inside. Summed over the triangles, what their sides have inside the body cancels. */
static void add_tractions(const dem_lattice *l, const double stress[3], double *force)
{
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
        const dem_index i = l->triangles[k], j = l->triangles[k / 3 * 3 + (k + 1) % 3];
        const vec2 d = vec2_sub(vec2_at(l->x, j), vec2_at(l->x, i)), out = {d.y, -d.x};
        const vec2 half = vec2_scale(
            0.5 * thickness, (vec2){stress[0] * out.x + stress[2] * out.y, stress[2] * out.x + stress[1] * out.y});
        vec2_put(force, i, vec2_add(vec2_at(force, i), half));
        vec2_put(force, j, vec2_add(vec2_at(force, j), half));
    }
}

/* A uniform strain takes no force inside, and at the boundary just the tractions of its stress: a free block loaded by
 * them has exactly this strain. Its energy is that of Hooke's law. Rounding of some 20 terms at each node, of up to 30
 * times the largest force. */
static void check_strain(const dem_model *model, double nu, dem_plane plane, const double e[3])
{
    const dem_lattice *l = &model->lattice;
    CLEANUP(free_memory) double *u = calloc(6 * (size_t)l->n_nodes, sizeof *u);
    assert_non_null(u);
    double *force = u + 2 * l->n_nodes, *expected = force + 2 * l->n_nodes, stress[3], work = 0.0, volume = 0.0;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const vec2 x = vec2_at(l->x, i);
        vec2_put(u, i, (vec2){e[0] * x.x + e[2] * x.y, e[2] * x.x + e[1] * x.y});
        volume += dem_model_volumes(model)[i];
    }
    stress_of(nu, plane, e, stress);
    tangent_apply(model, l->x, u, force);
    add_tractions(l, stress, expected);
    for (dem_index c = 0; c < 2 * l->n_nodes; c++) {
        assert_close(force[c], expected[c], 1e-12 * E * thickness);
        work += u[c] * force[c];
    }
    assert_close(work / volume, stress[0] * e[0] + stress[1] * e[1] + 2.0 * stress[2] * e[2], 1e-12 * E);
}

TEST(any_triangles_take_a_uniform_strain_without_forces_inside)
{
    for (int shape = 0; shape < N_SHAPES; shape++)
        for (size_t n = 0; n < 2 * sizeof ratios / sizeof *ratios; n++) {
            const dem_plane plane = n % 2 == 0 ? DEM_PLANE_STRESS : DEM_PLANE_STRAIN;
            CLEANUP(free_model) dem_model *model = make_model(shape, ratios[n / 2], plane);
            for (int k = 0; k < 6; k++) check_strain(model, ratios[n / 2], plane, strains[k]);
        }
}

/* As the log has them; read in plane stress, which in plane strain are E/(1 - nu^2) and nu/(1 - nu). */
TEST(any_triangles_have_exactly_the_constants_asked_for)
{
    for (int shape = 0; shape < N_SHAPES; shape++)
        for (size_t n = 0; n < 2 * sizeof ratios / sizeof *ratios; n++) {
            const bool strain = n % 2 == 1;
            const double nu = ratios[n / 2], modulus = strain ? E / (1.0 - nu * nu) : E;
            CLEANUP(free_model) dem_model *model = make_model(shape, nu, strain ? DEM_PLANE_STRAIN : DEM_PLANE_STRESS);
            dem_constants c = {.struct_size = sizeof c};
            assert_ok(dem_model_constants(model, 0, &c));
            assert_close(c.youngs_modulus / modulus, 1.0, 1e-9);
            assert_close(c.poissons_ratio, strain ? nu / (1.0 - nu) : nu, 1e-9);
            assert_close(c.anisotropy, 1.0, 1e-9);
        }
}

/* ---- frequencies ---- */

/* The bound is above the highest frequency, which Lanczos' iteration finds to 1e-6, and not to be of no use: found 1.29
 * (rings) to 1.66 times it (Delaunay). */
TEST(the_bound_is_above_the_highest_frequency)
{
    for (int shape = 0; shape < N_SHAPES; shape++)
        for (size_t n = 0; n < sizeof ratios / sizeof *ratios; n++) {
            double omega;
            CLEANUP(free_model) dem_model *model = make_model(shape, ratios[n], DEM_PLANE_STRESS);
            assert_ok(dem_model_omega(model, &omega));
            print_message("# shape %d, nu %.3f: bound %.3f times omega\n", shape, ratios[n],
                          dem_model_omega_max(model) / omega);
            assert_true(dem_model_omega_max(model) >= omega * (1.0 - 1e-6));
            assert_true(dem_model_omega_max(model) <= 1.75 * omega);
        }
}

/* ---- motion ---- */

/* A free body, deformed by up to some percent and turning, keeps momentum, angular momentum and energy. Both momenta
 * are sums of forces that cancel in pairs: rounding of some 1e3 steps. The pair's error of the energy is below 1e-6 of
 * what is exchanged at rtol 1e-9. */
TEST(a_free_body_keeps_momenta_and_energy)
{
    for (int shape = 0; shape < N_SHAPES; shape++) {
        const dem_material solid = solid_of(0.2, DEM_PLANE_STRESS);
        dem_options options = support_options();
        dem_energy first = {.struct_size = sizeof first}, last = {.struct_size = sizeof last};
        dem_body_motion before = {.struct_size = sizeof before}, after = {.struct_size = sizeof after};
        CLEANUP(dem_lattice_free) dem_lattice lattice;
        make_shape(&lattice, shape);
        assert_ok(dem_lattice_assemble(&lattice, &solid));
        assert_ok(dem_lattice_launch(&lattice, (const double[2]){0.3, -0.2}));
        assert_ok(dem_lattice_spin(&lattice, 2.0));
        for (dem_index i = 0; i < lattice.n_nodes; i++)
            lattice.velocity[2 * i] += 2.0 * sin(lattice.x[2 * i]) * cos(lattice.x[2 * i + 1]);
        options.gravity[0] = options.gravity[1] = 0.0;
        options.rtol = 1e-9;
        CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
        CLEANUP(free_simulation) dem_simulation *run = support_simulation(model, &options);
        assert_ok(dem_simulation_energy(run, &first));
        assert_ok(dem_simulation_body(run, 0, &before));
        assert_ok(dem_simulation_advance(run, 0.2));
        assert_ok(dem_simulation_energy(run, &last));
        assert_ok(dem_simulation_body(run, 0, &after));
        assert_true(last.elastic > 0.01 * first.kinetic);
        assert_close(last.ledger / first.ledger, 1.0, 1e-6);
        for (int c = 0; c < 2; c++) assert_close(after.velocity[c], before.velocity[c], 1e-12);
        assert_close(after.angular_momentum[2] / before.angular_momentum[2], 1.0, 1e-11);
    }
}
