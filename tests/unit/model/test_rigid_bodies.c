/* SPDX-License-Identifier: BSD-3-Clause */
/* rigid_bodies.c: means, moments and poses of a body, what is refused, and what a rigid body has no more of. */
#include "model/rigid_bodies.h"

#include <string.h>

#include "ask.h"
#include "harness/message.h"
#include "model/model.h"
#include "verification/support.h"

static const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.2, .density = 1050.0,
                                         .thickness = 1.0, .guard = 0.02);

/* An elastic block beside a rigid one of uneven masses. */
static dem_lattice make_pair(dem_guide guide)
{
    dem_lattice left = support_rectangle(0.03, 0.03, 5e-3, &rubber);
    CLEANUP(dem_lattice_free) dem_lattice right = support_rectangle(0.04, 0.02, 5e-3, &rubber);
    dem_lattice_move(&right, 0.3, (const double[2]){0.05, 0.01});
    for (dem_index i = 0; i < right.n_nodes; i++) right.mass[i] *= 1.0 + 0.1 * (double)(i % 7);
    assert_ok(dem_lattice_stiffen(&right, guide));
    assert_ok(dem_lattice_append(&left, &right));
    return left;
}

static const rigid_body *only_body(const dem_model *model)
{
    assert_int_equal(model->rigid.n, 1);
    return &model->rigid.list[0];
}

/* ---- sums ---- */

/* Sums are compared with those of a plain loop, which rounds more. */
TEST(a_rigid_body_has_the_mass_the_centre_and_the_inertia_of_its_nodes)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_pair(DEM_GUIDE_NONE);
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    const rigid_body *b = only_body(model);
    vec2 centre = {0.0, 0.0};
    double mass = 0.0, inertia = 0.0;
    dem_index n = 0;
    for (dem_index i = 0; i < l.n_nodes; i++) {
        assert_int_equal(rigid_bodies_at(&model->rigid, i) != NULL, l.body[i] == 1);
        if (l.body[i] != 1) continue;
        assert_int_equal(b->nodes[n++], i);
        mass += l.mass[i];
        centre = vec2_along(centre, l.mass[i], vec2_at(l.x, i));
    }
    centre = vec2_scale(1.0 / mass, centre);
    for (dem_index k = 0; k < n; k++) {
        const vec2 r = vec2_sub(vec2_at(l.x, b->nodes[k]), centre);
        inertia += b->masses[k] * vec2_dot(r, r);
        assert_close(b->shape[2 * k], r.x, 1e-16);
        assert_close(b->shape[2 * k + 1], r.y, 1e-16);
    }
    assert_int_equal(b->number, 1);
    assert_int_equal(b->n_nodes, n);
    assert_close(b->mass, mass, 1e-14 * mass);
    assert_close(b->inertia, inertia, 1e-13 * inertia);
    assert_close(rigid_body_mean(b, l.x).x, centre.x, 1e-15);
    const rigid_vectors places = {l.x, centre}, shifted = {l.x, {0.0, 0.0}};
    assert_close(rigid_body_dot(b, places, shifted), inertia, 1e-13 * inertia);
    assert_close(rigid_body_cross(b, places, shifted), 0.0, 1e-13 * inertia);
}

/* The body is turned and stretched alike in all directions about another place: the pose is that of the turn. */
TEST(the_pose_is_that_of_the_nearest_rigid_motion)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_pair(DEM_GUIDE_NONE);
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    const rigid_body *b = only_body(model);
    const double angles[4] = {0.0, 0.7, -2.0, 3.1};
    const vec2 centre = rigid_body_mean(b, l.x);
    for (int k = 0; k < 4; k++) {
        CLEANUP(free_memory) double *x = malloc(2 * (size_t)l.n_nodes * sizeof *x);
        const double c = cos(angles[k]), s = sin(angles[k]);
        for (dem_index i = 0; i < l.n_nodes; i++) {
            const vec2 r = vec2_sub(vec2_at(l.x, i), centre);
            vec2_put(x, i, (vec2){3.0 + 1.1 * (c * r.x - s * r.y), 4.0 + 1.1 * (s * r.x + c * r.y)});
        }
        const pose at = rigid_body_pose(b, x);
        assert_close(at.centre.x, 3.0, 1e-15);
        assert_close(at.centre.y, 4.0, 1e-15);
        assert_close(at.axis.x, c, 2e-14); /* places of 4 m have an error of 1e-14 of the body */
        assert_close(at.axis.y, s, 2e-14);
        assert_true(rigid_body_misplaced(b, x) >= b->nodes[0]);
    }
}

/* ---- what it has no more of ---- */

/* Springs, triangles and couplings of the rigid body carry nothing and bound no frequency, and its nodes take no part
 * in events; those of the other body are as they are without it. */
TEST(rigid_bodies_have_no_elements_and_no_surface_for_events)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_pair(DEM_GUIDE_NONE);
    CLEANUP(dem_lattice_free) dem_lattice left = support_rectangle(0.03, 0.03, 5e-3, &rubber);
    for (dem_index k = left.n_springs; k < l.n_springs; k++) l.stiffness[k] *= 1e6;
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    CLEANUP(free_model) dem_model *alone = support_model(&left, NULL, 0);
    dem_constants constants = {.struct_size = sizeof constants};
    double omega;
    for (dem_index i = left.n_nodes; i < l.n_nodes; i++) {
        assert_int_equal(model->springs.row[i], model->springs.row[i + 1]);
        assert_int_equal(model->triangles.row[i], model->triangles.row[i + 1]);
    }
    assert_int_equal(model->springs.row[l.n_nodes], 2 * left.n_springs);
    assert_int_equal(model->triangles.row[l.n_nodes], 3 * left.n_triangles);
    assert_int_equal(model->surface.n_nodes, alone->surface.n_nodes);
    assert_int_equal(model->surface.n_edges, alone->surface.n_edges);
    assert_close(dem_model_omega_max(model), dem_model_omega_max(alone), 0.0);
    assert_ok(dem_model_omega(model, &omega));
    assert_true(omega <= dem_model_omega_max(alone));
    assert_ok(dem_model_constants(model, 0, &constants));
    assert_int_equal(dem_model_constants(model, 1, &constants), DEM_ERROR_MODEL);
    assert_message_parts("body 1 is rigid");
}

/* Bodies of triangles of any shape have couplings, which must not enter the bound of frequencies either. */
TEST(couplings_of_rigid_bodies_are_left_out)
{
    dem_material coupled = rubber;
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    coupled.springs = DEM_SPRINGS_COUPLED;
    assert_ok(dem_lattice_rectangle(&l, 0.03, 0.03, 5e-3));
    assert_ok(dem_lattice_jitter(&l, 1e-3, 1));
    assert_ok(dem_lattice_assemble(&l, &coupled));
    CLEANUP(free_model) dem_model *elastic = support_model(&l, NULL, 0);
    assert_ok(dem_lattice_stiffen(&l, DEM_GUIDE_NONE));
    CLEANUP(free_model) dem_model *rigid = support_model(&l, NULL, 0);
    assert_true(elastic->couplings.n > 0);
    assert_int_equal(rigid->couplings.n, 0);
    assert_close(dem_model_omega_max(rigid), 0.0, 0.0);
}

/* ---- what is refused ---- */

static void refuse(const dem_lattice *l, const char *message)
{
    dem_model *model = NULL;
    assert_int_equal(dem_model_create(&model, l, NULL, 0), DEM_ERROR_MODEL);
    assert_null(model);
    assert_message_parts(message);
}

TEST(a_body_is_rigid_as_a_whole_or_not_at_all)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_pair(DEM_GUIDE_X);
    const dem_index first = 52, third = 54;
    assert_true(l.body[first - 1] == 0 && l.body[first] == 1);
    l.flags[3] |= DEM_NODE_RIGID;
    refuse(&l, "node 3 * node 0 * body 0 is rigid as a whole");
    l.flags[3] &= (unsigned char)~DEM_NODE_RIGID;
    l.flags[third] |= DEM_NODE_FIXED;
    refuse(&l, "node 54 is fixed * body 1 is rigid");
    l.flags[third] &= (unsigned char)~DEM_NODE_FIXED;
    l.flags[third] ^= DEM_NODE_GUIDE_X | DEM_NODE_GUIDE_Y;
    refuse(&l, "node 54 * node 52 * body 1 is rigid as a whole");
    for (dem_index i = first; i < l.n_nodes; i++) l.flags[i] |= DEM_NODE_GUIDE_X | DEM_NODE_GUIDE_Y;
    refuse(&l, "node 52 * body 1 has a guide along x and one along y");
    for (dem_index i = first; i < l.n_nodes; i++) l.flags[i] = DEM_NODE_GUIDE_X;
    refuse(&l, "node 52 has a guide * body 1 is not rigid");
}

TEST(the_initial_motion_of_a_rigid_body_is_rigid)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_pair(DEM_GUIDE_NONE);
    l.position = malloc(2 * (size_t)l.n_nodes * sizeof *l.position);
    assert_non_null(l.position);
    memcpy(l.position, l.x, 2 * (size_t)l.n_nodes * sizeof *l.position);
    l.position[120] += 1e-9;
    refuse(&l, "initial position * m of node 60 deforms its body 1, which is rigid");
    l.position[120] -= 1e-9;
    assert_ok(dem_lattice_spin(&l, 20.0));
    CLEANUP(free_model) dem_model *spinning = support_model(&l, NULL, 0);
    assert_int_equal(spinning->rigid.n, 1);
    l.velocity[121] += 1e-6;
    refuse(&l, "initial velocity * m/s of node 60 is not that of a rigid motion of its body 1");
}

TEST(a_guided_body_starts_along_its_guide)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_pair(DEM_GUIDE_Y);
    assert_ok(dem_lattice_launch(&l, (const double[2]){0.0, 3.0}));
    CLEANUP(free_model) dem_model *along = support_model(&l, NULL, 0);
    assert_int_equal(only_body(along)->guide, DEM_GUIDE_Y);
    assert_ok(dem_lattice_launch(&l, (const double[2]){1e-3, 0.0}));
    refuse(&l, "body 1 along its guide");
    assert_ok(dem_lattice_launch(&l, (const double[2]){-1e-3, 0.0}));
    assert_ok(dem_lattice_spin(&l, 1.0));
    refuse(&l, "body 1 along its guide");
}

TEST(a_point_has_no_inertia)
{
    const double x[2] = {0.0, 0.0}, mass = 1.0;
    CLEANUP(dem_lattice_free) dem_lattice l = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    assert_ok(dem_lattice_stiffen(&l, DEM_GUIDE_NONE));
    refuse(&l, "rigid body 0 has all its mass in one place");
}
