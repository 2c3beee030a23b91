/* SPDX-License-Identifier: BSD-3-Clause */
/* local_springs.c, local_elements.c: the nodes round one and their accelerations are those of forces.h, on a block that
 * is deformed and moves. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "forces/local_springs.h"

enum { RINGS = 3 };

typedef struct rig {
    dem_model *model;
    forces acting;
    state_layout layout;
    local_springs springs;
    local_forces near;
    local_nodes nodes;
    double *y, *x, *v, *a; /* whole state; by local numbers */
} rig;

/* What a block is of, and by how much its nodes are moved: nu other than 1/3 brings the area term, jitter couplings. */
typedef struct kind {
    double poissons_ratio, guard, jitter, damping_time, noise; /* 1, 1, m, s, m */
    bool softens;
} kind;

static const kind plain = {.poissons_ratio = 1.0 / 3.0, .noise = 1e-4};
static const kind others[] = {{.poissons_ratio = 0.2, .noise = 1e-4},
                              {.poissons_ratio = 1.0 / 3.0, .guard = 0.02, .noise = 1e-4}, /* it is off */
                              {.poissons_ratio = 1.0 / 3.0, .guard = 0.02, .noise = 2e-3}, /* it pushes */
                              {.poissons_ratio = 0.2, .guard = 0.02, .jitter = 1e-3, .noise = 1e-3},
                              {.poissons_ratio = 1.0 / 3.0, .noise = 1e-4, .softens = true},
                              {.poissons_ratio = 0.2, .guard = 0.02, .jitter = 1e-3, .noise = 1e-4, .softens = true},
                              {.poissons_ratio = 0.2, .guard = 0.02, .damping_time = 1e-3, .noise = 1e-4}};
enum { N_OTHERS = sizeof others / sizeof *others };

static void shake(rig *r, double noise)
{
    const dem_lattice *l = &r->model->lattice;
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) {
        r->y[k] = l->position[k] + noise * sin(3.0 * (double)k);
        r->y[state_velocities(&r->layout) + k] = cos(5.0 * (double)k);
    }
}

static void open_rig(rig *r, kind of)
{
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = of.poissons_ratio, .density = 1050.0,
              .thickness = 1.0, .guard = of.guard, .damping_time = of.damping_time,
              .springs = of.jitter > 0.0 ? DEM_SPRINGS_COUPLED : DEM_SPRINGS_INDEPENDENT,
              .strength = of.softens ? 1e5 : 0.0, .fracture_energy = of.softens ? 60.0 : 0.0);
    *r = (rig){0};
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&block, 0.05, 0.05, 5e-3));
    if (of.jitter > 0.0) assert_ok(dem_lattice_jitter(&block, of.jitter, 1));
    assert_ok(dem_lattice_assemble(&block, &rubber));
    assert_ok(dem_model_create(&r->model, &block, NULL, 0));
    r->layout = state_layout_of(2, block.n_nodes, 0, false);
    r->acting = (forces){.model = r->model, .gravity = {0.0, -9.81}, .mass_damping = 3.0};
    const size_t size = (size_t)state_size(&r->layout);
    r->y = calloc(4 * size, sizeof *r->y);
    assert_non_null(r->y);
    r->x = r->y + size;
    r->v = r->x + size;
    r->a = r->v + size;
    shake(r, of.noise);
    local_springs_create(&r->springs, &r->acting, &r->layout);
    r->near = local_springs_forces(&r->springs);
    assert_ok(local_nodes_create(&r->nodes, block.n_nodes, RINGS));
}

static void close_rig(rig *r)
{
    local_nodes_destroy(&r->nodes);
    local_springs_destroy(&r->springs);
    dem_model_destroy(r->model);
    free(r->y);
}

/* Gathers the rings round some nodes. */
static void gather_round(rig *r, const dem_index *seeds, dem_index n)
{
    local_nodes_clear(&r->nodes);
    for (dem_index k = 0; k < n; k++) assert_ok(local_nodes_add(&r->nodes, seeds[k]));
    r->nodes.end[0] = r->nodes.n;
    for (int ring = 1; ring <= RINGS; ring++) {
        const dem_index first = local_nodes_begin(&r->nodes, ring - 1), last = r->nodes.end[ring - 1];
        assert_ok(r->near.add_neighbours(r->near.self, &r->nodes, first, last));
        r->nodes.end[ring] = r->nodes.n;
    }
    assert_ok(r->near.gather(r->near.self, &r->nodes));
    for (dem_index j = 0; j < r->nodes.n; j++) {
        state_copy_row(&r->layout, r->x + 2 * j, state_x(&r->layout, r->y, r->nodes.list[j]));
        state_copy_row(&r->layout, r->v + 2 * j, state_v(&r->layout, r->y, r->nodes.list[j]));
    }
}

static void gather(rig *r, dem_index node)
{
    gather_round(r, &node, 1);
}

/* One node alone has the bits. */
static void check_accelerations(rig *r, double tolerance)
{
    const local_state s = {0.0, r->x, r->v, r->y};
    gather(r, r->layout.n_nodes / 2);
    for (int ring = 0; ring < RINGS; ring++) {
        r->near.accelerate(r->near.self, &r->nodes, ring, &s, r->a);
        for (dem_index j = 0; j < r->nodes.end[ring]; j++) {
            const dem_index i = r->nodes.list[j];
            const vec2 a = forces_acceleration(&r->acting, i, r->y, r->y + state_velocities(&r->layout));
            double alone[2];
            r->near.accelerate_one(r->near.self, i, r->y, alone);
            assert_close(alone[0], a.x, 0.0);
            assert_close(alone[1], a.y, 0.0);
            assert_close(r->a[2 * j], a.x, tolerance);
            assert_close(r->a[2 * j + 1], a.y, tolerance);
        }
    }
}

/* The whole block, and with a state in which elements have broken by `harm`. */
static void check_kind(kind of, void (*harm)(element_state *), double tolerance)
{
    CLEANUP(close_rig) rig r;
    CLEANUP(element_state_destroy) element_state broken;
    open_rig(&r, of);
    check_accelerations(&r, tolerance);
    assert_int_equal(r.near.read_state(r.near.self), of.damping_time > 0.0);
    assert_ok(element_state_create(&broken, &r.model->lattice, &r.model->springs));
    harm(&broken);
    r.acting.elements = &broken;
    check_accelerations(&r, tolerance);
}

static void break_nothing(element_state *s)
{
    (void)s;
}

/* Half of the springs are broken, those with an odd number. */
static void break_springs(element_state *s)
{
    for (dem_index k = 1; k < s->lattice->n_springs; k += 2) element_state_break_spring(s, k);
}

/* Every third triangle is broken, so that some springs have half of their stiffness, and some none; of the others some
 * have softened. */
static void break_triangles(element_state *s)
{
    for (dem_index k = 0; k < s->lattice->n_triangles; k++)
        if (k % 3 == 0)
            element_state_break_triangle(s, k);
        else if (k % 4 == 0 && s->lattice->softening != NULL)
            element_state_soften(s, k);
}

/* Sums of forces of 1e3 N on 0.02 kg have another order: 1e-16 times some ten of them. */
TEST(plain_springs_accelerate_as_those_of_the_model)
{
    check_kind(plain, break_nothing, 1e-9);
    check_kind(plain, break_springs, 1e-9);
}

TEST(all_else_has_the_bits_of_the_model)
{
    for (int k = 0; k < N_OTHERS; k++) {
        check_kind(others[k], break_nothing, 0.0);
        check_kind(others[k], break_triangles, 0.0);
    }
}

/* ---- guards that come on ---- */

/* Moves the corners of a triangle by a distance in each coordinate, such that its area falls the fastest. */
static void squeeze(rig *r, const dem_index corner[3], double by)
{
    const vec2 at[3] = {vec2_at(r->y, corner[0]), vec2_at(r->y, corner[1]), vec2_at(r->y, corner[2])};
    for (int c = 0; c < 3; c++) {
        const vec2 across = vec2_sub(at[(c + 2) % 3], at[(c + 1) % 3]);
        r->y[2 * corner[c]] += copysign(by, across.y);
        r->y[2 * corner[c] + 1] -= copysign(by, across.x);
    }
    for (dem_index j = 0; j < r->nodes.n; j++)
        state_copy_row(&r->layout, r->x + 2 * j, state_x(&r->layout, r->y, r->nodes.list[j]));
}

static void check_last_ring(rig *r, double tolerance)
{
    const local_state s = {0.0, r->x, r->v, r->y};
    r->near.accelerate(r->near.self, &r->nodes, RINGS - 1, &s, r->a);
    for (dem_index j = 0; j < r->nodes.end[RINGS - 1]; j++) {
        const vec2 a = forces_acceleration(&r->acting, r->nodes.list[j], r->y, r->y + state_velocities(&r->layout));
        assert_close(r->a[2 * j], a.x, tolerance);
        assert_close(r->a[2 * j + 1], a.y, tolerance);
    }
}

/* How far nodes may go without a look at each triangle is known from where they were first: all corners of one go the
 * shortest way, in thousandths of the spacing, until its guard pushes. */
TEST(a_guard_pushes_from_its_onset_on)
{
    const double step = 5e-6;
    CLEANUP(close_rig) rig r;
    open_rig(&r, others[1]);
    gather(&r, r.layout.n_nodes / 2);
    const triangles *t = &r.model->triangles;
    const dem_index p = t->row[r.nodes.list[0]], corner[3] = {r.nodes.list[0], t->next[p], t->last[p]};
    double share = 1.0;
    while (share > 0.9 * TRIANGLES_GUARD_ONSET) {
        check_last_ring(&r, 0.0);
        squeeze(&r, corner, step);
        share = vec2_triangle_area(vec2_at(r.y, corner[0]), vec2_at(r.y, corner[1]), vec2_at(r.y, corner[2])) /
                triangles_rest_area(t, corner[0], p);
    }
    check_last_ring(&r, 0.0);
}

/* ---- nodes that have moved ---- */

/* After the first nodes have moved what the others do is as it was: a last time so far that guards push. */
TEST(where_some_nodes_have_moved_the_others_are_not_evaluated_again)
{
    for (int k = 0; k < N_OTHERS - 1; k++) {
        CLEANUP(close_rig) rig r;
        open_rig(&r, others[k]);
        gather(&r, r.layout.n_nodes / 2);
        const local_state s = {0.0, r.x, r.v, r.y};
        for (int ring = 0; ring < RINGS; ring++)
            for (dem_index n = 1; n <= r.nodes.end[RINGS - 1]; n += 3) {
                double expected[2 * 64];
                r.near.accelerate(r.near.self, &r.nodes, ring, &s, r.a);
                for (dem_index c = 0; c < 2 * n; c++) r.x[c] += (n < 16 ? 2e-5 : 3e-4) * sin((double)(7 * c + n));
                r.near.accelerate_moved(r.near.self, &r.nodes, n, ring, &s, r.a);
                const dem_index size = 2 * r.nodes.end[ring];
                assert_true(size <= 128);
                memcpy(expected, r.a, (size_t)size * sizeof *expected);
                r.near.accelerate(r.near.self, &r.nodes, ring, &s, r.a);
                assert_memory_equal(r.a, expected, (size_t)size * sizeof *expected);
            }
    }
}

/* ---- what breaks ---- */

/* Another triangle with both ends of the first edge of one. */
static dem_index find_other(const dem_lattice *l, dem_index triangle)
{
    const dem_index *of = &l->triangles[3 * triangle];
    dem_index other = 0;
    for (dem_index k = 0; k < l->n_triangles; k++) {
        int n = 0;
        for (int c = 0; c < 9; c++) n += l->triangles[3 * k + c / 3] == of[c % 3] && c % 3 < 2;
        if (n == 2 && k != triangle) other = k;
    }
    return other;
}

/* Two triangles in the middle fail, one after the other, and with the second the spring between them breaks. */
static void check_failing(kind of, void (*harm)(element_state *, dem_index), double tolerance)
{
    CLEANUP(close_rig) rig r;
    CLEANUP(element_state_destroy) element_state state;
    open_rig(&r, of);
    const dem_lattice *l = &r.model->lattice;
    const dem_index list[2] = {l->n_triangles / 2, find_other(l, l->n_triangles / 2)};
    dem_index seeds[6];
    for (int k = 0; k < 6; k++) seeds[k] = l->triangles[3 * list[k / 3] + k % 3];
    assert_ok(element_state_create(&state, l, &r.model->springs));
    r.acting.elements = &state;
    gather_round(&r, seeds, 6);
    assert_int_equal(r.nodes.end[0], 4);
    check_last_ring(&r, tolerance);
    for (int k = 0; k < 2; k++) {
        harm(&state, list[k]);
        assert_ok(r.near.renew(r.near.self, &r.nodes));
        check_last_ring(&r, tolerance);
    }
}

TEST(what_fails_between_the_first_nodes_is_listed_anew)
{
    check_failing(plain, element_state_break_triangle, 1e-9);
    for (int k = 0; k < N_OTHERS; k++) check_failing(others[k], element_state_break_triangle, 0.0);
    check_failing(others[4], element_state_soften, 0.0);
    check_failing(others[5], element_state_soften, 0.0);
}

/* ---- what is kept ---- */

/* The rings round a node as they were kept, and its accelerations to the bit. */
static void check_recalled(rig *r, dem_index node, bool expected)
{
    double fresh[2 * 64];
    const local_state s = {0.0, r->x, r->v, r->y};
    gather(r, node);
    const dem_index n = r->nodes.n, size = 2 * local_nodes_n_moving(&r->nodes);
    dem_index list[64], end[LOCAL_NODES_RINGS];
    assert_true(n <= 64);
    memcpy(list, r->nodes.list, (size_t)n * sizeof *list);
    memcpy(end, r->nodes.end, sizeof end);
    r->near.accelerate(r->near.self, &r->nodes, RINGS - 1, &s, r->a);
    memcpy(fresh, r->a, (size_t)size * sizeof *fresh);
    local_nodes_clear(&r->nodes);
    assert_int_equal(r->near.recall(r->near.self, node, &r->nodes), expected);
    assert_int_equal(r->nodes.n, expected ? n : 0);
    if (!expected) return;
    assert_memory_equal(r->nodes.list, list, (size_t)n * sizeof *list);
    assert_memory_equal(r->nodes.end, end, (RINGS + 1) * sizeof *end);
    for (dem_index j = 0; j < n; j++) assert_int_equal(r->nodes.number[list[j]], j);
    r->near.accelerate(r->near.self, &r->nodes, RINGS - 1, &s, r->a);
    assert_memory_equal(r->a, fresh, (size_t)size * sizeof *fresh);
}

static void keep(rig *r, dem_index node)
{
    gather(r, node);
    r->near.keep(r->near.self, node, &r->nodes);
}

/* Of two nodes, after the body has moved on; and no longer where an element near has broken or softened. */
TEST(what_was_listed_is_kept_until_something_near_fails)
{
    for (int k = -1; k < N_OTHERS; k++) {
        const kind of = k < 0 ? plain : others[k];
        CLEANUP(close_rig) rig r;
        CLEANUP(element_state_destroy) element_state state;
        open_rig(&r, of);
        const dem_index node[2] = {r.layout.n_nodes / 2, 0};
        const bool listed = of.damping_time == 0.0;
        for (int q = 0; q < 2; q++) keep(&r, node[q]);
        for (int q = 0; q < 2; q++) check_recalled(&r, node[q], listed);
        shake(&r, 0.5 * of.noise);
        for (int q = 0; q < 2; q++) check_recalled(&r, node[q], listed);
        check_recalled(&r, node[0] + 1, false);
        assert_ok(element_state_create(&state, &r.model->lattice, &r.model->springs));
        r.acting.elements = &state;
        check_recalled(&r, node[0], listed);
        const dem_index near = r.model->springs.spring[r.model->springs.row[node[0]]];
        element_state_break_spring(&state, near);
        check_recalled(&r, node[0], false);
        keep(&r, node[0]); /* in vain */
        check_recalled(&r, node[0], false);
        check_recalled(&r, node[1], listed);
    }
}

/* ---- what is given ---- */

TEST(given_forces_act_beside_those_of_elements)
{
    CLEANUP(close_rig) rig r;
    CLEANUP(boundary_conditions_free) boundary_conditions given;
    open_rig(&r, others[0]);
    const dem_index pushed[1] = {r.layout.n_nodes / 2};
    const dem_boundary list[1] = {
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 1, .nodes = pushed, .value = {40.0, -20.0})};
    assert_ok(boundary_conditions_compile(&given, list, 1, &r.model->lattice, NULL, 0));
    r.acting.boundaries = &given;
    check_accelerations(&r, 0.0);
}

/* ---- nodes ---- */

/* Every node has its number, in the nearest ring; those gathered before are forgotten. */
TEST(nodes_have_their_numbers_in_rings)
{
    CLEANUP(close_rig) rig r;
    open_rig(&r, plain);
    gather(&r, 0);
    gather(&r, r.layout.n_nodes / 2);
    dem_index n = 0;
    for (dem_index i = 0; i < r.layout.n_nodes; i++) n += r.nodes.number[i] >= 0;
    assert_int_equal(n, r.nodes.n);
    assert_int_equal(r.nodes.end[1], 7); /* of a triangular lattice */
    for (dem_index j = 0; j < r.nodes.n; j++) {
        assert_int_equal(r.nodes.number[r.nodes.list[j]], j);
        for (int ring = 0; ring <= RINGS; ring++)
            assert_int_equal(local_nodes_have(&r.nodes, r.nodes.list[j], ring), j < r.nodes.end[ring]);
    }
    assert_false(local_nodes_have(&r.nodes, 0, RINGS));
}

/* The damping of masses takes alpha m v^2 of each. */
TEST(power_is_summed_over_rings)
{
    double totals[STATE_TOTALS] = {0.0}, expected = 0.0;
    CLEANUP(close_rig) rig r;
    open_rig(&r, plain);
    gather(&r, r.layout.n_nodes / 2);
    assert_true(r.near.have_power);
    r.near.add_power(r.near.self, &r.nodes, 1, r.y, totals);
    for (dem_index j = 0; j < r.nodes.end[1]; j++) {
        const vec2 v = vec2_at(r.v, j);
        expected += 3.0 * r.model->lattice.mass[r.nodes.list[j]] * vec2_dot(v, v);
    }
    assert_close(totals[STATE_DAMPING], expected, 1e-14 * expected);
    assert_close(totals[STATE_WORK], 0.0, 0.0);
}
