/* SPDX-License-Identifier: BSD-3-Clause */
/* stress_nodes.c: the nodes are those that the stress depends on; and neighbours where all edges have springs. */
#include "verification/support.h"

#include <stdlib.h>

#include "fracture/stress_nodes.h"
#include "model/node_stress.h"

static void collect(void *context, dem_index node)
{
    ((unsigned char *)context)[node] = 1;
}

static bool is_near(const dem_model *m, dem_index i, dem_index node)
{
    return i == node || springs_between(&m->springs, i, node) >= 0;
}

/* The stress at node i with another node moved by one part in 1e3 of a spacing. */
static bool depends_on(const dem_model *m, dem_index i, dem_index node, double *x)
{
    double before[3], after[3];
    const double was = x[2 * node];
    node_stress(m, NULL, NODE_STRESS_EFFECTIVE, i, x, before);
    x[2 * node] += 1e-5;
    node_stress(m, NULL, NODE_STRESS_EFFECTIVE, i, x, after);
    x[2 * node] = was;
    return before[0] != after[0] || before[1] != after[1] || before[2] != after[2];
}

TEST(they_are_what_the_stress_depends_on)
{
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    const dem_material solid = {.struct_size = sizeof(dem_material),
                                .youngs_modulus = 1e7,
                                .poissons_ratio = 0.2,
                                .density = 1e3,
                                .thickness = 1.0};
    element_state elements;
    assert_ok(dem_lattice_rectangle(&block, 0.12, 0.12, 0.01));
    assert_ok(dem_lattice_assemble(&block, &solid));
    dem_model *model = support_model(&block, NULL, 0);
    const dem_index n = block.n_nodes;
    double *x = malloc(2 * (size_t)n * sizeof *x);
    assert_non_null(x);
    for (dem_index k = 0; k < 2 * n; k++) x[k] = 1.001 * block.x[k];
    assert_ok(stress_prepare(&model->stress));
    assert_ok(element_state_begin(&elements, &model->lattice, &model->springs));
    for (dem_index i = 0; i < n; i++) {
        unsigned char *visited = calloc((size_t)n, 1);
        assert_non_null(visited);
        stress_nodes_visit(model, &elements, i, collect, visited);
        for (dem_index node = 0; node < n; node++) {
            if (depends_on(model, i, node, x)) assert_true(visited[node]);
            assert_int_equal(visited[node], is_near(model, i, node));
        }
        free(visited);
    }
    element_state_destroy(&elements);
    dem_model_destroy(model);
    free(x);
}

/* A star of springs without triangles. */
TEST(ends_of_springs_are_visited)
{
    enum { RAYS = 24 };
    double x[2 * (RAYS + 1)] = {0.0}, masses[RAYS + 1];
    dem_index ends[2 * RAYS];
    for (int k = 0; k < RAYS; k++) {
        x[2 * k + 2] = cos(2.0 * acos(-1.0) * k / RAYS);
        x[2 * k + 3] = sin(2.0 * acos(-1.0) * k / RAYS);
        ends[2 * k] = 0;
        ends[2 * k + 1] = k + 1;
    }
    for (int k = 0; k <= RAYS; k++) masses[k] = 1.0;
    CLEANUP(dem_lattice_free)
    dem_lattice star = support_lattice(RAYS + 1, x, masses, RAYS, ends, 1.0, 1.0, NULL);
    unsigned char visited[RAYS + 1] = {0};
    element_state elements;
    dem_model *model = support_model(&star, NULL, 0);
    assert_ok(stress_prepare(&model->stress));
    assert_ok(element_state_begin(&elements, &model->lattice, &model->springs));
    stress_nodes_visit(model, &elements, 1, collect, visited);
    for (int k = 0; k <= RAYS; k++) assert_int_equal(visited[k], k < 2);
    stress_nodes_visit(model, &elements, 0, collect, visited);
    for (int k = 0; k <= RAYS; k++) assert_int_equal(visited[k], 1);
    element_state_destroy(&elements);
    dem_model_destroy(model);
}
