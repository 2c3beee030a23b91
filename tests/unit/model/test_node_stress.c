/* SPDX-License-Identifier: BSD-3-Clause */
/* node_stress.c: beside what is broken the stress is that of the solid without it. */
#include "verification/support.h"

#include <string.h>

#include "model/node_stress.h"
#include "model/spring_share.h"
#include "unit/model/cut_solids.h"
#include "unit/model/triangle_stress.h"

static const double strain_size = 0.02;

/* Moves every node by a smooth deformation of its place, the same in both solids. */
static void deform(const dem_lattice *l, double *x)
{
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double px = l->x[2 * i], py = l->x[2 * i + 1];
        x[2 * i] = px + strain_size * (px + 0.3 * py) + strain_size * 0.01 * sin(90.0 * px - 40.0 * py);
        x[2 * i + 1] = py - strain_size * (0.2 * px + py) + strain_size * 0.01 * cos(70.0 * py + 30.0 * px);
    }
}

/* The cut solid is assembled anew, so that its shares are computed from other sums: 1e-15 of stresses up to E times
 * 0.02. */
TEST(it_is_the_stress_of_the_solid_without_the_broken_triangles)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(dem_lattice_free) dem_lattice whole = solid_of(kind), cut = cut_solid(kind);
        CLEANUP(free_model) dem_model *model = NULL;
        CLEANUP(free_model) dem_model *cut_model = NULL;
        CLEANUP(element_state_destroy) element_state state;
        dem_index n_without = 0;
        assert_ok(dem_model_create(&model, &whole, NULL, 0));
        assert_ok(stress_prepare(&model->stress));
        assert_ok(dem_model_create(&cut_model, &cut, NULL, 0));
        assert_ok(stress_prepare(&cut_model->stress));
        assert_ok(element_state_create(&state, &model->lattice, &model->springs));
        CLEANUP(free_memory) double *x = calloc(2 * (size_t)whole.n_nodes, sizeof *x);
        CLEANUP(free_memory) double *cut_x = calloc(2 * (size_t)cut.n_nodes, sizeof *cut_x);
        assert_true(x && cut_x);
        deform(&whole, x);
        deform(&cut, cut_x);
        for (dem_index t = 0; t < whole.n_triangles; t++)
            if (breaks(kind, t)) element_state_break_triangle(&state, t);
        for (dem_index i = 0; i < whole.n_nodes; i++) {
            const dem_index same = same_node(&cut, &whole.x[2 * i]);
            double stress[3], expected[3] = {0.0};
            node_stress(model, &state, NODE_STRESS_CARRIED, i, x, stress);
            if (same >= 0) node_stress(cut_model, NULL, NODE_STRESS_CARRIED, same, cut_x, expected);
            for (int k = 0; k < 3; k++) assert_close(stress[k], expected[k], 1e-8);
            assert_int_equal(same >= 0, stress[0] != 0.0);
            n_without += same < 0;
        }
        assert_true(n_without > 0);
    }
}

/* The stress of a node is the mean of those of its whole triangles by volume: 1e-15 of stresses up to E times 0.02. */
TEST(it_is_the_mean_of_its_triangles)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(dem_lattice_free) dem_lattice whole = solid_of(kind);
        CLEANUP(free_model) dem_model *model = NULL;
        CLEANUP(element_state_destroy) element_state state;
        assert_ok(dem_model_create(&model, &whole, NULL, 0));
        assert_ok(stress_prepare(&model->stress));
        assert_ok(element_state_create(&state, &model->lattice, &model->springs));
        CLEANUP(free_memory) double *x = calloc(2 * (size_t)whole.n_nodes, sizeof *x);
        CLEANUP(free_memory) double *sum = calloc(4 * (size_t)whole.n_nodes, sizeof *sum);
        assert_true(x && sum);
        deform(&whole, x);
        for (dem_index t = 0; t < whole.n_triangles; t++)
            if (breaks(kind, t)) element_state_break_triangle(&state, t);
        for (dem_index t = 0; t < whole.n_triangles; t++) {
            double own[3];
            if (state.triangle[t]) continue;
            triangle_stress(model, &state, t, x, own);
            for (int c = 0; c < 3; c++) {
                double *at = &sum[4 * whole.triangles[3 * t + c]];
                for (int k = 0; k < 3; k++) at[k] += spring_share_volume(&whole, t) * own[k];
                at[3] += spring_share_volume(&whole, t);
            }
        }
        for (dem_index i = 0; i < whole.n_nodes; i++) {
            double stress[3];
            node_stress(model, &state, NODE_STRESS_CARRIED, i, x, stress);
            for (int k = 0; k < 3; k++)
                assert_close(stress[k], sum[4 * i + 3] > 0.0 ? sum[4 * i + k] / sum[4 * i + 3] : 0.0, 1e-8);
        }
    }
}

/* Stretched in all directions, every part of a triangle is in tension: a node carries the mean of its triangles'
 * effective stresses times what is left of them. Squeezed, it carries all. */
TEST(softened_triangles_carry_what_is_left_in_tension)
{
    for (int kind = 0; kind < N_KINDS; kind++) {
        CLEANUP(dem_lattice_free) dem_lattice soft = solid_of(kind);
        CLEANUP(free_model) dem_model *model = NULL;
        CLEANUP(element_state_destroy) element_state state;
        soft.softening = malloc((size_t)soft.n_triangles * sizeof *soft.softening);
        CLEANUP(free_memory) double *x = calloc(2 * (size_t)soft.n_nodes, sizeof *x);
        CLEANUP(free_memory) double *sum = calloc(4 * (size_t)soft.n_nodes, sizeof *sum);
        assert_true(soft.softening && x && sum);
        for (dem_index t = 0; t < soft.n_triangles; t++) soft.softening[t] = 3.0;
        assert_ok(dem_model_create(&model, &soft, NULL, 0));
        assert_ok(stress_prepare(&model->stress));
        assert_ok(element_state_create(&state, &model->lattice, &model->springs));
        for (dem_index t = 0; t < soft.n_triangles; t++)
            for (int k = 0; k < 1 + (int)(t % 32); k++) element_state_soften(&state, t);
        for (int sign = -1; sign <= 1; sign += 2) {
            memset(sum, 0, 4 * (size_t)soft.n_nodes * sizeof *sum);
            for (dem_index c = 0; c < 2 * soft.n_nodes; c++) x[c] = soft.x[c] * (1.0 + sign * strain_size);
            for (dem_index t = 0; t < soft.n_triangles; t++) {
                const double left = sign > 0 ? softening_left(3.0, 1 + (int)(t % 32)) : 1.0;
                double own[3];
                triangle_stress(model, &state, t, x, own);
                for (int c = 0; c < 3; c++) {
                    double *at = &sum[4 * soft.triangles[3 * t + c]];
                    for (int k = 0; k < 3; k++) at[k] += left * spring_share_volume(&soft, t) * own[k];
                    at[3] += spring_share_volume(&soft, t);
                }
            }
            for (dem_index i = 0; i < soft.n_nodes; i++) {
                double stress[3], effective[3], whole[3];
                node_stress(model, &state, NODE_STRESS_CARRIED, i, x, stress);
                node_stress(model, &state, NODE_STRESS_EFFECTIVE, i, x, effective);
                node_stress(model, NULL, NODE_STRESS_CARRIED, i, x, whole);
                for (int k = 0; k < 3; k++) {
                    if (kind != COUPLED || sign > 0) assert_close(stress[k], sum[4 * i + k] / sum[4 * i + 3], 1e-8);
                    assert_close(effective[k], whole[k], 1e-8);
                }
            }
        }
    }
}

/* A node at which nothing is broken has the bits of a body in which nothing is. */
TEST(elsewhere_nothing_changes)
{
    CLEANUP(dem_lattice_free) dem_lattice whole = solid_of(COUPLED);
    CLEANUP(free_model) dem_model *model = NULL;
    CLEANUP(element_state_destroy) element_state state;
    dem_index n_changed = 0;
    assert_ok(dem_model_create(&model, &whole, NULL, 0));
    assert_ok(stress_prepare(&model->stress));
    assert_ok(element_state_create(&state, &model->lattice, &model->springs));
    CLEANUP(free_memory) double *x = calloc(2 * (size_t)whole.n_nodes, sizeof *x);
    assert_non_null(x);
    deform(&whole, x);
    element_state_break_triangle(&state, whole.n_triangles / 2);
    for (dem_index i = 0; i < whole.n_nodes; i++) {
        double stress[3], before[3];
        node_stress(model, &state, NODE_STRESS_CARRIED, i, x, stress);
        node_stress(model, NULL, NODE_STRESS_CARRIED, i, x, before);
        n_changed += memcmp(stress, before, sizeof stress) != 0;
    }
    assert_int_equal(n_changed, 3); /* its corners; its other nodes keep the stresses of their own triangles */
}

/* Volume of the triangles at a node that are whole, m^3, of which a third is the node's. */
static double volume_at(const dem_lattice *l, const element_state *state, dem_index i)
{
    double volume = 0.0;
    for (dem_index k = 0; k < 3 * l->n_triangles; k++)
        if (l->triangles[k] == i && !state->triangle[k / 3]) volume += rubber.thickness * area_of(l, k / 3) / 3.0;
    return volume;
}

/* Three cells in a row, with a bar along x from the second node below to the last one, stretched to twice its length:
 * its tension is 1e6 N, its r x f 2e6 J. */
static dem_lattice barred(dem_index *node)
{
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_squares(&l, 3.0, 1.0, 1.0));
    assert_ok(dem_lattice_assemble(&l, &rubber));
    const size_t n = (size_t)l.n_springs++;
    l.ends = realloc(l.ends, 2 * (n + 1) * sizeof *l.ends);
    l.rest_length = realloc(l.rest_length, (n + 1) * sizeof *l.rest_length);
    l.stiffness = realloc(l.stiffness, (n + 1) * sizeof *l.stiffness);
    assert_true(l.ends && l.rest_length && l.stiffness);
    *node = l.ends[2 * n] = same_node(&l, (const double[]){-0.5, 0.0});
    l.ends[2 * n + 1] = same_node(&l, (const double[]){1.5, 0.0});
    assert_true(l.ends[2 * n] >= 0 && l.ends[2 * n + 1] >= 0);
    l.rest_length[n] = 1.0;
    l.stiffness[n] = 1e6;
    return l;
}

/* Half of its r x f goes to each end, whatever breaks beside it, as long as a triangle is left there. */
TEST(a_bar_that_no_triangle_holds_counts_as_before)
{
    dem_index node, triangle = -1;
    double stress[3];
    CLEANUP(dem_lattice_free) dem_lattice lattice = barred(&node);
    CLEANUP(free_model) dem_model *model = NULL;
    CLEANUP(element_state_destroy) element_state state;
    assert_ok(dem_model_create(&model, &lattice, NULL, 0));
    assert_ok(stress_prepare(&model->stress));
    assert_ok(element_state_create(&state, &model->lattice, &model->springs));
    node_stress(model, &state, NODE_STRESS_CARRIED, node, lattice.x, stress);
    assert_close(stress[0] * volume_at(&lattice, &state, node), 1e6, 1e-3);
    for (dem_index k = 0; k < 3 * lattice.n_triangles; k++)
        if (lattice.triangles[k] == node) triangle = k / 3;
    element_state_break_triangle(&state, triangle);
    node_stress(model, &state, NODE_STRESS_CARRIED, node, lattice.x, stress);
    assert_close(stress[0] * volume_at(&lattice, &state, node), 1e6, 1e-3);
    assert_close(stress[1], 0.0, 1e-3);
    element_state_break_spring(&state, lattice.n_springs - 1);
    node_stress(model, &state, NODE_STRESS_CARRIED, node, lattice.x, stress);
    assert_close(stress[0], 0.0, 1e-3);
}
