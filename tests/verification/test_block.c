/* SPDX-License-Identifier: BSD-3-Clause */
/* Free blocks of triangles and of squares under uniform tension, transverse tension and shear, by the tractions on
 * their edges: every spring then has the strain of Hooke's law, for any Poisson's ratio, in plane stress and plane
 * strain; and so measured, too. Squares whose diagonals are not half as stiff as their sides differ in shear alone.
 * The equilibrium is a linear solve with the tangent about the rest shape. */
#include <stdbool.h>
#include <stdlib.h>

#include "support.h"

#include "model/tangent_stiffness.h"

static const double spacing = 5e-3, modulus = 1e7, thickness = 0.5;
static const double ratios[] = {0.0, 0.1, 0.2, 1.0 / 3.0, 0.45};
static const double diagonals[] = {0.0, 0.5, 0.3, 0.8};
enum { n_ratios = sizeof ratios / sizeof ratios[0], n_diagonals = sizeof diagonals / sizeof diagonals[0] };

typedef struct block {
    double diagonal; /* of squares: stiffness over that of a side; 0: triangles */
    double nu;
    dem_plane plane;
} block;

/* Every ratio in plane stress, then in plane strain, for triangles and squares of each kind. */
static block block_of(int k)
{
    return (block){.diagonal = diagonals[k / (2 * n_ratios)],
                   .nu = ratios[k % n_ratios],
                   .plane = k / n_ratios % 2 == 0 ? DEM_PLANE_STRESS : DEM_PLANE_STRAIN};
}

/* Otherwise cells would warp. */
static bool is_stable(const block *b)
{
    const double nu = b->plane == DEM_PLANE_STRESS ? b->nu : b->nu / (1.0 - b->nu);
    return 2.0 * b->diagonal * (1.0 - nu) < 1.0 + nu;
}

/* G of shear along the axes over that of the isotropic solid. */
static double shear_factor(const block *b)
{
    return b->diagonal > 0.0 ? 2.0 * b->diagonal : 1.0;
}

static dem_model *make_block(const block *b)
{
    const dem_material solid = SIZED(dem_material, .youngs_modulus = modulus, .poissons_ratio = b->nu,
                                     .plane = b->plane, .density = 1050.0, .thickness = thickness, .guard = 0.02);
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    if (b->diagonal > 0.0) {
        assert_ok(dem_lattice_squares(&lattice, 0.045, 0.05, spacing));
        assert_ok(dem_lattice_assemble_squares(&lattice, &solid, b->diagonal));
    } else {
        assert_ok(dem_lattice_rectangle(&lattice, 0.045, 0.05, spacing));
        assert_ok(dem_lattice_assemble(&lattice, &solid));
    }
    dem_model *model = support_model(&lattice, NULL, 0);
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
static void hooke(const block *b, const double stress[3], double strain[3])
{
    const double nu = b->nu, across = b->plane == DEM_PLANE_STRAIN ? nu * (stress[0] + stress[1]) : 0.0;
    strain[0] = (stress[0] - nu * (stress[1] + across)) / modulus;
    strain[1] = (stress[1] - nu * (stress[0] + across)) / modulus;
    strain[2] = stress[2] * (1.0 + nu) / modulus / shear_factor(b);
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
static void check_loaded(const dem_model *model, const block *b)
{
    static const double stresses[3][3] = {{1e3, 0.0, 0.0}, {0.0, 1e3, 0.0}, {0.0, 0.0, 1e3}};
    unsigned char *held = calloc((size_t)model->lattice.n_nodes, 1);
    assert_non_null(held);
    for (int k = 0; k < 3; k++) {
        double strain[3], *u = tractions(model, stresses[k]);
        hooke(b, stresses[k], strain);
        assert_ok(tangent_solve(model, model->lattice.x, held, 1e-13 * 1e3 * thickness * spacing, u));
        assert_close(worst_strain(model, u, strain), 0.0, 1e-9);
        free(u);
    }
    free(held);
}

TEST(springs_have_the_strain_of_hookes_law)
{
    for (int k = 0; k < n_diagonals * 2 * n_ratios; k++) {
        const block b = block_of(k);
        if (!is_stable(&b)) continue;
        CLEANUP(free_model) dem_model *model = make_block(&b);
        check_loaded(model, &b);
    }
}

/* C of the plate that moves alike: in plane strain it has E/(1 - nu^2) and nu/(1 - nu). */
static void check_constants(const dem_constants *c, const block *b)
{
    const bool stress = b->plane == DEM_PLANE_STRESS;
    const double nu = stress ? b->nu : b->nu / (1.0 - b->nu), G = 0.5 * modulus / (1.0 + b->nu);
    const double C11 = 2.0 * G / (1.0 - nu);
    const double C[3][3] = {{C11, nu * C11, 0.0}, {nu * C11, C11, 0.0}, {0.0, 0.0, shear_factor(b) * G}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) assert_close(c->stiffness[i][j] / modulus, C[i][j] / modulus, 1e-9);
    if (shear_factor(b) != 1.0) return;
    assert_close(c->youngs_modulus / (2.0 * G * (1.0 + nu)), 1.0, 1e-9);
    assert_close(c->poissons_ratio, nu, 1e-9);
    assert_close(c->anisotropy, 1.0, 1e-9);
}

TEST(constants_measured_are_those_stated)
{
    for (int k = 0; k < n_diagonals * 2 * n_ratios; k++) {
        const block b = block_of(k);
        if (!is_stable(&b)) continue;
        CLEANUP(free_model) dem_model *model = make_block(&b);
        dem_constants c = {.struct_size = sizeof c};
        assert_ok(dem_model_constants(model, 0, &c));
        check_constants(&c, &b);
    }
}
