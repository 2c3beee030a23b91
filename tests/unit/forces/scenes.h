/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies of all kinds in states without an order, for what is measured of all nodes. */
#ifndef DEM_TEST_FORCES_SCENES_H
#define DEM_TEST_FORCES_SCENES_H

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

#include "harness/cleanup_gsl.h"
#include "model/element_state.h"
#include "verification/support.h"

typedef struct scene {
    dem_model *model;
    double *x, *v;
} scene;

static inline void free_scene(scene *s)
{
    dem_model_destroy(s->model);
    free(s->x);
    free(s->v);
}

/* Positions at rest, moved at random by up to `share` of the spacing, and random velocities. */
static inline scene make_scene(const dem_lattice *lattice, double share)
{
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    scene s = {0};
    const dem_index n = 2 * lattice->n_nodes;
    assert_ok(dem_model_create(&s.model, lattice, NULL, 0));
    s.x = malloc((size_t)n * sizeof *s.x);
    s.v = malloc((size_t)n * sizeof *s.v);
    assert_true(s.x != NULL && s.v != NULL);
    for (dem_index k = 0; k < n; k++) {
        s.x[k] = lattice->x[k] + share * dem_model_spacing(s.model) * (2.0 * gsl_rng_uniform(r) - 1.0);
        s.v[k] = 20.0 * gsl_rng_uniform(r) - 10.0;
    }
    return s;
}

static inline dem_material law_of(int laws)
{
    dem_material material = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0,
                                  .thickness = 1.0, .guard = 0.02);
    if (laws & 1) material.poissons_ratio = 0.45;
    if (laws & 2) material.guard = 0.0;
    if (laws & 4) material.springs = DEM_SPRINGS_COUPLED;
    return material;
}

static inline dem_lattice make_solid(double width, double height, const dem_material *material)
{
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&lattice, width, height, 1e-2));
    assert_ok(dem_lattice_assemble(&lattice, material));
    return lattice;
}

static inline bool outside_hole(void *context, const double *x)
{
    (void)context;
    return hypot(x[0] - 0.08, x[1] - 0.1) > 0.043;
}

static inline dem_lattice make_holed(const dem_material *material)
{
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&lattice, 0.15, 1e-2));
    dem_lattice_move(&lattice, 0.1, (const double[2]){0.15, 0.15});
    assert_ok(dem_lattice_cut(&lattice, outside_hole, NULL));
    if (material->springs == DEM_SPRINGS_COUPLED) assert_ok(dem_lattice_jitter(&lattice, 2e-3, 1));
    assert_ok(dem_lattice_assemble(&lattice, material));
    return lattice;
}

static inline void swap_nodes(dem_lattice *l, const dem_index *number)
{
    const size_t size = 2 * (size_t)l->n_nodes * sizeof *l->x;
    double *old = malloc(size);
    assert_non_null(old);
    memcpy(old, l->x, size);
    for (dem_index i = 0; i < l->n_nodes; i++) memcpy(l->x + 2 * number[i], old + 2 * i, 2 * sizeof *old);
    free(old);
    for (dem_index k = 0; k < 2 * l->n_springs; k++) l->ends[k] = number[l->ends[k]];
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) l->triangles[k] = number[l->triangles[k]];
}

static inline dem_lattice make_shuffled(const dem_material *material)
{
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&lattice, 0.5, 0.4, 1e-2));
    CLEANUP(free_memory) dem_index *number = malloc((size_t)lattice.n_nodes * sizeof *number);
    assert_non_null(number);
    for (dem_index k = 0; k < lattice.n_nodes; k++) number[k] = k;
    for (dem_index k = lattice.n_nodes - 1; k > 0; k--) {
        const dem_index j = (dem_index)gsl_rng_uniform_int(r, (unsigned long)k + 1), kept = number[k];
        number[k] = number[j];
        number[j] = kept;
    }
    swap_nodes(&lattice, number);
    assert_ok(dem_lattice_assemble(&lattice, material));
    return lattice;
}

/* Three bodies beside each other. */
static inline dem_lattice make_bodies(void)
{
    const dem_material material = law_of(1), other = law_of(0);
    dem_lattice lattice = make_solid(0.11, 0.07, &material);
    CLEANUP(dem_lattice_free) dem_lattice second = make_solid(0.13, 0.05, &other);
    CLEANUP(dem_lattice_free) dem_lattice third = make_solid(0.04, 0.05, &other);
    dem_lattice_move(&second, 0.0, (const double[2]){0.2, 0.0});
    dem_lattice_move(&third, 0.0, (const double[2]){0.5, 0.0});
    assert_ok(dem_lattice_append(&lattice, &second));
    assert_ok(dem_lattice_append(&lattice, &third));
    return lattice;
}

/* Every 29th spring and every 31st triangle. */
static inline element_state break_some(const dem_lattice *lattice)
{
    CLEANUP(springs_free) springs all;
    element_state broken;
    assert_ok(springs_compile(&all, lattice));
    assert_ok(element_state_create(&broken, lattice, &all));
    for (dem_index k = 0; k < lattice->n_springs; k += 29) element_state_break_spring(&broken, k);
    for (dem_index k = 0; k < lattice->n_triangles; k += 31) element_state_break_triangle(&broken, k);
    return broken;
}

#endif
