/* SPDX-License-Identifier: BSD-3-Clause */
/* Free blocks of two layers of different materials, of triangles and of squares, by the tractions on their edges. Three
 * loads leave each layer a uniform strain, and a spring between them has the strain that both share: tension along the
 * layers where both have the same nu, tension across them where both have the same nu/E, shear. Linear solve with the
 * tangent about the rest shape. */
#include <stdbool.h>
#include <stdlib.h>

#include "support.h"

#include "model/tangent_stiffness.h"

static const double spacing = 5e-3, thickness = 0.5;
enum { columns = 9, rows = 10, n_below = 4 };

typedef struct layers {
    bool squares;
    double E[2], nu[2];  /* of the lower, of the upper one */
    double stress[2][3]; /* xx, yy, xy, N/m^2 */
    double strain_scale; /* the largest strain */
    double interface;    /* m, height */
} layers;

static int layer_at(const layers *l, double y)
{
    return y > l->interface;
}

static dem_model *make_block(layers *l)
{
    dem_material solids[2];
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    const double row = (l->squares ? 1.0 : 0.5 * sqrt(3.0)) * spacing;
    for (int k = 0; k < 2; k++)
        solids[k] = (dem_material)SIZED(dem_material, .youngs_modulus = l->E[k], .poissons_ratio = l->nu[k],
                                        .density = 1050.0 * (k + 1), .thickness = thickness);
    assert_ok(l->squares ? dem_lattice_squares(&lattice, columns * spacing, rows * row, spacing)
                         : dem_lattice_rectangle(&lattice, columns * spacing, rows * row, spacing));
    l->interface = n_below * row;
    CLEANUP(free_memory) dem_index *of = calloc((size_t)lattice.n_triangles, sizeof *of);
    assert_non_null(of);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        const dem_index *c = lattice.triangles + 3 * t;
        of[t] = layer_at(l, (lattice.x[2 * c[0] + 1] + lattice.x[2 * c[1] + 1] + lattice.x[2 * c[2] + 1]) / 3.0);
    }
    assert_ok(dem_lattice_assemble_mixed(&lattice, solids, 2, of, l->squares ? 0.5 : 0.0));
    dem_model *model = support_model(&lattice, NULL, 0);
    return model;
}

/* Half of every boundary edge's force to either of its nodes, by the stress of its layer. */
static double *tractions(const dem_model *model, const layers *l)
{
    double *force = calloc(2 * (size_t)model->lattice.n_nodes, sizeof *force);
    assert_non_null(force);
    for (dem_index e = 0; e < model->surface.n_edges; e++) { /* the body is on the left */
        const dem_index ends[2] = {model->surface.ends[2 * e], model->surface.ends[2 * e + 1]};
        const vec2 a = vec2_at(model->lattice.x, ends[0]), b = vec2_at(model->lattice.x, ends[1]);
        const double *stress = l->stress[layer_at(l, 0.5 * (a.y + b.y))];
        const vec2 outward = {0.5 * thickness * (b.y - a.y), -0.5 * thickness * (b.x - a.x)};
        const vec2 pull = {stress[0] * outward.x + stress[2] * outward.y,
                           stress[2] * outward.x + stress[1] * outward.y};
        for (int k = 0; k < 2; k++) vec2_put(force, ends[k], vec2_add(vec2_at(force, ends[k]), pull));
    }
    return force;
}

/* The largest difference of a spring's strain from Hooke's law of its layer, over the largest strain. On the interface
 * both layers have the same strain along it. */
static double worst_strain(const dem_model *model, const layers *l, const double *u)
{
    const dem_lattice *lattice = &model->lattice;
    double worst = 0.0;
    for (dem_index s = 0; s < lattice->n_springs; s++) {
        const vec2 a = vec2_at(lattice->x, lattice->ends[2 * s]), b = vec2_at(lattice->x, lattice->ends[2 * s + 1]);
        const vec2 ua = vec2_at(u, lattice->ends[2 * s]), ub = vec2_at(u, lattice->ends[2 * s + 1]);
        const vec2 d = vec2_sub(b, a), w = vec2_sub(ub, ua);
        const int k = layer_at(l, 0.5 * (a.y + b.y));
        const double *p = l->stress[k], E = l->E[k], nu = l->nu[k];
        const double xx = (p[0] - nu * p[1]) / E, yy = (p[1] - nu * p[0]) / E, xy = p[2] * (1.0 + nu) / E;
        const double expected = (xx * d.x * d.x + yy * d.y * d.y + 2.0 * xy * d.x * d.y) / vec2_dot(d, d);
        worst = fmax(worst, fabs(vec2_dot(d, w) / vec2_dot(d, d) - expected));
    }
    return worst / l->strain_scale;
}

/* 1e-9 as for one material; the residual of the solve is 1e-13 of the tractions. */
static void check(layers l)
{
    for (int k = 0; k < 2; k++) {
        l.squares = k == 1;
        CLEANUP(free_model) dem_model *model = make_block(&l);
        unsigned char *held = calloc((size_t)model->lattice.n_nodes, 1);
        assert_non_null(held);
        CLEANUP(free_memory) double *u = tractions(model, &l);
        assert_ok(tangent_solve(model, model->lattice.x, held, 1e-13 * 1e3 * thickness * spacing, u));
        assert_close(worst_strain(model, &l, u), 0.0, 1e-9);
        free(held);
    }
}

TEST(layers_side_by_side_share_their_strain)
{
    check((layers){
        .E = {1e7, 4e7}, .nu = {0.2, 0.2}, .stress = {{1e3, 0.0, 0.0}, {4e3, 0.0, 0.0}}, .strain_scale = 1e-4});
}

TEST(layers_one_behind_the_other_share_their_stress)
{
    check((layers){
        .E = {1e7, 4e7}, .nu = {0.1, 0.4}, .stress = {{0.0, 1e3, 0.0}, {0.0, 1e3, 0.0}}, .strain_scale = 1e-4});
}

TEST(sheared_layers_share_their_stress)
{
    check((layers){
        .E = {1e7, 4e7}, .nu = {0.1, 0.45}, .stress = {{0.0, 0.0, 1e3}, {0.0, 0.0, 1e3}}, .strain_scale = 1e-4});
}
