/* SPDX-License-Identifier: BSD-3-Clause */
/* Free blocks under uniform tension, transverse tension and shear, by the tractions on their edges: every spring then
 * has the strain of Hooke's law, for any Poisson's ratio, in plane stress and plane strain; and so measured, too. The
 * equilibrium is a linear solve with the tangent about the rest shape. */
#include <stdlib.h>

#include "support.h"

#include "tangent.h"

static const double spacing = 5e-3, modulus = 1e7, thickness = 0.5;
static const double ratios[] = {0.0, 0.1, 0.2, 1.0 / 3.0, 0.45};
enum { n_ratios = sizeof ratios / sizeof ratios[0] };

static dem_model *make_block(double nu, dem_plane plane)
{
    const dem_material solid = {.youngs_modulus = modulus,
                                .poissons_ratio = nu,
                                .plane = plane,
                                .density = 1050.0,
                                .thickness = thickness,
                                .guard = 0.02};
    dem_lattice lattice;
    dem_model *model;
    assert_ok(dem_lattice_rectangle(&lattice, 0.045, 0.05, spacing));
    assert_ok(dem_lattice_assemble(&lattice, &solid));
    assert_ok(dem_model_create(&model, &lattice, NULL, 0));
    dem_lattice_free(&lattice);
    return model;
}

/* Forces on the nodes of a uniform stress (xx, yy, xy), N/m^2, half of every boundary edge's to either of its nodes. */
static double *tractions(const dem_model *model, const double stress[3])
{
    double *force = calloc(2 * (size_t)model->lattice.n_nodes, sizeof *force);
    assert_non_null(force);
    for (dem_index e = 0; e < model->surface.n_edges; e++) { /* the body is on the left */
        const dem_index a = model->surface.ends[2 * e], b = model->surface.ends[2 * e + 1];
        const vec2 along = vec2_sub(vec2_at(model->lattice.x, b), vec2_at(model->lattice.x, a));
        const vec2 outward = {0.5 * thickness * along.y, -0.5 * thickness * along.x};
        const vec2 pull = {stress[0] * outward.x + stress[2] * outward.y,
                           stress[2] * outward.x + stress[1] * outward.y};
        vec2_put(force, a, vec2_add(vec2_at(force, a), pull));
        vec2_put(force, b, vec2_add(vec2_at(force, b), pull));
    }
    return force;
}

/* Hooke's law in three dimensions: plane stress as it stands; in plane strain with the stress across, nu (xx + yy). */
static void hooke(double nu, dem_plane plane, const double stress[3], double strain[3])
{
    const double across = plane == DEM_PLANE_STRAIN ? nu * (stress[0] + stress[1]) : 0.0;
    strain[0] = (stress[0] - nu * (stress[1] + across)) / modulus;
    strain[1] = (stress[1] - nu * (stress[0] + across)) / modulus;
    strain[2] = stress[2] * (1.0 + nu) / modulus;
}

/* The largest difference of a spring's strain from that of the uniform strain e (xx, yy, xy), over the largest of e. */
static double worst_strain(const dem_model *model, const double *u, const double e[3])
{
    const dem_lattice *l = &model->lattice;
    double worst = 0.0, largest = fmax(fmax(fabs(e[0]), fabs(e[1])), fabs(e[2]));
    for (dem_index k = 0; k < l->n_springs; k++) {
        const dem_index i = l->ends[2 * k], j = l->ends[2 * k + 1];
        const vec2 d = vec2_sub(vec2_at(l->x, j), vec2_at(l->x, i)), w = vec2_sub(vec2_at(u, j), vec2_at(u, i));
        const double expected = (e[0] * d.x * d.x + e[1] * d.y * d.y + 2.0 * e[2] * d.x * d.y) / vec2_dot(d, d);
        worst = fmax(worst, fabs(vec2_dot(d, w) / vec2_dot(d, d) - expected));
    }
    return worst / largest;
}

/* 1e-9 is what is asked for; the residual of the solve is 1e-13 of the tractions. */
static void check_loaded(const dem_model *model, double nu, dem_plane plane)
{
    static const double stresses[3][3] = {{1e3, 0.0, 0.0}, {0.0, 1e3, 0.0}, {0.0, 0.0, 1e3}};
    unsigned char *held = calloc((size_t)model->lattice.n_nodes, 1);
    assert_non_null(held);
    for (int k = 0; k < 3; k++) {
        double strain[3], *u = tractions(model, stresses[k]);
        hooke(nu, plane, stresses[k], strain);
        assert_ok(tangent_solve(model, model->lattice.x, held, 1e-13 * 1e3 * thickness * spacing, u));
        assert_close(worst_strain(model, u, strain), 0.0, 1e-9);
        free(u);
    }
    free(held);
}

static void springs_have_the_strain_of_hookes_law(void **state)
{
    (void)state;
    for (int k = 0; k < 2 * n_ratios; k++) {
        const dem_plane plane = k < n_ratios ? DEM_PLANE_STRESS : DEM_PLANE_STRAIN;
        dem_model *model = make_block(ratios[k % n_ratios], plane);
        check_loaded(model, ratios[k % n_ratios], plane);
        dem_model_destroy(model);
    }
}

/* In plane strain those of the plate that moves alike, E/(1 - nu^2) and nu/(1 - nu). */
static void constants_measured_are_those_stated(void **state)
{
    (void)state;
    for (int k = 0; k < 2 * n_ratios; k++) {
        const bool stress = k < n_ratios;
        const double nu = ratios[k % n_ratios], E = modulus / (stress ? 1.0 : 1.0 - nu * nu);
        dem_model *model = make_block(nu, stress ? DEM_PLANE_STRESS : DEM_PLANE_STRAIN);
        dem_constants c;
        assert_ok(dem_model_constants(model, 0, &c));
        assert_close(c.youngs_modulus / E, 1.0, 1e-9);
        assert_close(c.poissons_ratio, stress ? nu : nu / (1.0 - nu), 1e-9);
        assert_close(c.anisotropy, 1.0, 1e-9);
        dem_model_destroy(model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(springs_have_the_strain_of_hookes_law),
        cmocka_unit_test(constants_measured_are_those_stated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
