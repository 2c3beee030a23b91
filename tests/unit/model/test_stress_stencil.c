/* SPDX-License-Identifier: BSD-3-Clause */
/* stress_stencil.c: the stresses are those of node_stress(), to the bit. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "model/node_stress.h"
#include "model/stress_stencil.h"

/* Bars that are independent and have no area term: triangles have guards. */
static const dem_material plain = {.struct_size = sizeof(dem_material),
                                   .youngs_modulus = 1e7,
                                   .poissons_ratio = 1.0 / 3.0,
                                   .density = 1e3,
                                   .thickness = 0.1,
                                   .guard = 0.02};

/* Also with a bar that no triangle holds, between two corners. */
static dem_lattice make(bool with_cells)
{
    dem_lattice l = dem_lattice_empty();
    if (with_cells)
        assert_ok(dem_lattice_squares(&l, 0.08, 0.06, 0.01));
    else
        assert_ok(dem_lattice_rectangle(&l, 0.08, 0.06, 0.01));
    assert_ok(dem_lattice_assemble(&l, &plain));
    const size_t n = (size_t)l.n_springs++;
    l.ends = realloc(l.ends, 2 * (n + 1) * sizeof *l.ends);
    l.rest_length = realloc(l.rest_length, (n + 1) * sizeof *l.rest_length);
    l.stiffness = realloc(l.stiffness, (n + 1) * sizeof *l.stiffness);
    assert_true(l.ends && l.rest_length && l.stiffness);
    l.ends[2 * n] = 0;
    l.ends[2 * n + 1] = l.n_nodes / 2;
    l.rest_length[n] = 0.09;
    l.stiffness[n] = 1e5;
    return l;
}

static void prepare(dem_model **model, element_state *state, stress_stencil **p, const dem_lattice *l)
{
    assert_ok(dem_model_create(model, l, NULL, 0));
    assert_ok(stress_prepare(&(*model)->stress));
    assert_ok(element_state_create(state, &(*model)->lattice, &(*model)->springs));
    assert_ok(stress_stencil_create(p, *model, state));
}

/* A triangle at an end of it, where others are left. */
static dem_index at_the_bar(const dem_lattice *l)
{
    dem_index k = 0;
    while (l->triangles[k] != l->n_nodes / 2) k++;
    return k / 3;
}

/* Moves nodes by parts of 1e-3 of their places, each otherwise. */
static void move(const dem_lattice *l, int turn, double *x)
{
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) x[k] = l->x[k] * (1.0 + 1e-3 * (double)((k * 7 + turn) % 11));
}

static void check_corners(stress_stencil *p, dem_index triangle, const double *x)
{
    const dem_index *corner = &p->model->lattice.triangles[3 * triangle];
    assert_int_equal(stress_stencil_list(p, corner, 3), 3);
    for (int again = 0; again < 2; again++) assert_true(stress_stencil_find(p, x));
    for (int c = 0; c < 3; c++) {
        double expected[3];
        node_stress(p->model, p->elements, NODE_STRESS_EFFECTIVE, corner[c], x, expected);
        assert_memory_equal(p->node[c].stress, expected, sizeof expected);
    }
}

/* While everything is whole, and then with one triangle after the other broken, or the bar. */
TEST(they_have_the_bits_of_node_stress)
{
    for (int with_cells = 0; with_cells < 2; with_cells++) {
        CLEANUP(dem_lattice_free) dem_lattice l = make(with_cells);
        CLEANUP(free_model) dem_model *model = NULL;
        CLEANUP(element_state_destroy) element_state state;
        stress_stencil *p = NULL;
        prepare(&model, &state, &p, &l);
        CLEANUP(free_memory) double *x = calloc(2 * (size_t)l.n_nodes, sizeof *x);
        assert_non_null(x);
        for (int turn = 0; turn < 12; turn++) {
            move(&l, turn, x);
            for (dem_index t = 0; t < l.n_triangles; t++) check_corners(p, t, x);
            element_state_break_triangle(&state, turn == 0 ? at_the_bar(&l) : (17 * turn + 5) % l.n_triangles);
            if (turn == 9) element_state_break_spring(&state, l.n_springs - 1);
        }
        stress_stencil_destroy(p);
    }
}

/* A triangle that is squeezed to half of its area, and one that is not a number. */
TEST(where_a_guard_may_act_they_are_not_known)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make(false);
    CLEANUP(free_model) dem_model *model = NULL;
    CLEANUP(element_state_destroy) element_state state;
    stress_stencil *p = NULL;
    prepare(&model, &state, &p, &l);
    CLEANUP(free_memory) double *x = calloc(2 * (size_t)l.n_nodes, sizeof *x);
    assert_non_null(x);
    const dem_index *corner = &l.triangles[3 * (l.n_triangles / 2)];
    for (int worse = 0; worse < 2; worse++) {
        move(&l, 0, x);
        check_corners(p, l.n_triangles / 2, x);
        for (int d = 0; d < 2; d++) {
            const double end = x[2 * corner[1] + d];
            x[2 * corner[0] + d] = worse ? (double)NAN : 0.6 * end + 0.4 * x[2 * corner[0] + d];
        }
        assert_int_equal(stress_stencil_list(p, corner, 3), 3);
        assert_false(stress_stencil_find(p, x));
    }
    stress_stencil_destroy(p);
}

/* Of rays of springs only the ends have room; and areas that push, and coupled triangles, are not listed. */
TEST(what_has_no_room_is_not_listed)
{
    enum { RAYS = 100 };
    double x[2 * (RAYS + 1)] = {0.0}, masses[RAYS + 1];
    dem_index ends[2 * RAYS], nodes[5] = {1, 2, 0, 3, 4}, few[6] = {1, 2, 3, 4, 5, 6};
    for (int k = 0; k < RAYS; k++) {
        x[2 * k + 2] = cos(2.0 * acos(-1.0) * k / RAYS);
        x[2 * k + 3] = sin(2.0 * acos(-1.0) * k / RAYS);
        ends[2 * k] = 0;
        ends[2 * k + 1] = k + 1;
    }
    for (int k = 0; k <= RAYS; k++) masses[k] = 1.0;
    CLEANUP(dem_lattice_free)
    dem_lattice star = support_lattice(RAYS + 1, x, masses, RAYS, ends, 1.0, 1.0, NULL);
    CLEANUP(dem_lattice_free) dem_lattice soft = dem_lattice_empty();
    CLEANUP(free_model) dem_model *model = support_model(&star, NULL, 0);
    CLEANUP(free_model) dem_model *of_rubber = NULL;
    stress_stencil *p = NULL;
    assert_ok(stress_prepare(&model->stress));
    assert_ok(stress_stencil_create(&p, model, NULL));
    assert_int_equal(stress_stencil_list(p, nodes, 5), 2);
    assert_int_equal(stress_stencil_list(p, few, 6), STRESS_STENCIL_NODES);
    stress_stencil_destroy(p);
    assert_ok(dem_lattice_rectangle(&soft, 0.05, 0.05, 0.01));
    dem_material other = plain;
    other.poissons_ratio = 0.2;
    assert_ok(dem_lattice_assemble(&soft, &other));
    assert_ok(dem_model_create(&of_rubber, &soft, NULL, 0));
    assert_ok(stress_prepare(&of_rubber->stress));
    assert_true(of_rubber->triangles.area_stiffness_of != NULL || of_rubber->couplings.n > 0);
    assert_ok(stress_stencil_create(&p, of_rubber, NULL));
    assert_int_equal(stress_stencil_list(p, nodes, 3), 0);
    stress_stencil_destroy(p);
}
