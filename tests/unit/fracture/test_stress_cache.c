/* SPDX-License-Identifier: BSD-3-Clause */
/* stress_cache.c: whatever is asked for in whatever order, stresses are those of the state, to the bit. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "fracture/stress_cache.h"

static void move(const dem_lattice *l, double factor, double *x)
{
    for (dem_index i = 0; i < l->n_nodes; i++)
        for (int d = 0; d < 2; d++) x[2 * i + d] = l->x[2 * i + d] * (1.0 + factor * (double)((i * 7 + d) % 5));
}

static void check(stress_cache *c, dem_index i, const double *x)
{
    double found[3], expected[3];
    stress_cache_find(c, i, found);
    node_stress(c->model, NULL, NODE_STRESS_EFFECTIVE, i, x, expected);
    assert_memory_equal(found, expected, sizeof found);
}

/* More nodes than there is room for, so that they take places from each other. */
TEST(it_finds_the_stress_of_the_state)
{
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    const dem_material solid = {.struct_size = sizeof(dem_material),
                                .youngs_modulus = 1e7,
                                .poissons_ratio = 0.3,
                                .density = 1e3,
                                .thickness = 1.0};
    stress_cache c;
    assert_ok(dem_lattice_rectangle(&block, 0.5, 0.5, 0.01));
    assert_ok(dem_lattice_assemble(&block, &solid));
    dem_model *model = support_model(&block, NULL, 0);
    double *x = malloc(2 * (size_t)block.n_nodes * sizeof *x);
    assert_non_null(x);
    assert_ok(stress_cache_create(&c, model, NULL, 100));
    assert_true(c.n < block.n_nodes);
    for (int state = 0; state < 3; state++) {
        move(&block, 1e-3 * state, x);
        stress_cache_begin(&c, x);
        for (dem_index k = 0; k < 3 * block.n_nodes; k++) check(&c, k * 17 % block.n_nodes, x);
    }
    stress_cache_destroy(&c);
    dem_model_destroy(model);
    free(x);
}

/* A state may change, and numbers begin anew after 2^32 of them: the number 0 of what has never been found is not one
 * of them. */
TEST(what_it_forgets_is_found_anew)
{
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    stress_cache c;
    support_block(&block);
    dem_model *model = support_model(&block, NULL, 0);
    double *x = malloc(2 * (size_t)block.n_nodes * sizeof *x);
    assert_non_null(x);
    assert_ok(stress_cache_create(&c, model, NULL, 100));
    for (int k = 0; k < 2; k++) {
        move(&block, 1e-3 * k, x);
        stress_cache_begin(&c, x);
        assert_int_equal(c.number, 1);
        for (dem_index i = 0; i < block.n_nodes; i++) check(&c, i, x);
        move(&block, 4e-3, x);
        for (dem_index i = 0; i < block.n_nodes; i++) stress_cache_forget(&c, i);
        for (dem_index i = 0; i < block.n_nodes; i++) check(&c, i, x);
        c.number = UINT32_MAX;
    }
    stress_cache_destroy(&c);
    dem_model_destroy(model);
    free(x);
}
