/* SPDX-License-Identifier: BSD-3-Clause */
/* rigid_motion.c: projection of accelerations, and shapes that are put back. How rigid bodies move is in
 * verification/test_rigid.c. */
#include "forces/rigid_motion.h"

#include <string.h>

#include "base/random.h"
#include "model/model.h"
#include "verification/support.h"

enum { MOST = 2 * 64 };

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);

/* A rigid block, and a state of its nodes that moves as one rigid body; 3 rad/s, centre at (0.1, 0.2) m. */
typedef struct block {
    dem_model *model;
    const rigid_body *body;
    double x[MOST], v[MOST], a[MOST];
} block;

static const double spin = 3.0;

static void block_set_up(block *k, dem_guide guide)
{
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(0.04, 0.02, 5e-3, &rubber);
    for (dem_index i = 0; i < l.n_nodes; i++) l.mass[i] *= 1.0 + 0.1 * (double)(i % 7);
    assert_ok(dem_lattice_stiffen(&l, guide));
    assert_true(2 * l.n_nodes <= MOST);
    k->model = support_model(&l, NULL, 0);
    k->body = &k->model->rigid.list[0];
    const pose at = {.centre = {0.1, 0.2}, .velocity = {0.5, -2.0}, .axis = {0.8, 0.6}, .spin = spin};
    for (dem_index i = 0; i < l.n_nodes; i++) {
        vec2_put(k->x, i, pose_outside(&at, vec2_at(k->body->shape, i)));
        vec2_put(k->v, i, pose_velocity(&at, vec2_at(k->x, i)));
    }
    uint64_t random = 7;
    for (dem_index c = 0; c < 2 * l.n_nodes; c++) k->a[c] = 500.0 * random_next(&random);
}

static void block_tear_down(block *k)
{
    dem_model_destroy(k->model);
}

static rigid_vectors arms(const block *k)
{
    return (rigid_vectors){k->x, rigid_body_mean(k->body, k->x)};
}

/* ---- accelerations ---- */

/* Accelerations are those of a body on which the same forces act, by the formulas of rigid motion. */
TEST(forces_and_moments_on_a_rigid_body_stay_the_same)
{
    CLEANUP(block_tear_down) block k;
    block_set_up(&k, DEM_GUIDE_NONE);
    const vec2 mean = rigid_body_mean(k.body, k.a);
    const double moment = rigid_body_cross(k.body, arms(&k), (rigid_vectors){k.a, {0.0, 0.0}});
    const double rate = moment / rigid_body_dot(k.body, arms(&k), arms(&k));
    rigid_motion_accelerate(&k.model->rigid, k.x, k.v, k.a);
    assert_close(rigid_body_mean(k.body, k.a).x, mean.x, 1e-12);
    assert_close(rigid_body_mean(k.body, k.a).y, mean.y, 1e-12);
    assert_close(rigid_body_cross(k.body, arms(&k), (rigid_vectors){k.a, {0.0, 0.0}}), moment, 1e-12 * fabs(moment));
    for (dem_index i = 0; i < k.body->n_nodes; i++) {
        const vec2 r = vec2_sub(vec2_at(k.x, i), arms(&k).less);
        assert_close(k.a[2 * i], mean.x - rate * r.y - spin * spin * r.x, 1e-11);
        assert_close(k.a[2 * i + 1], mean.y + rate * r.x - spin * spin * r.y, 1e-11);
    }
}

TEST(a_guide_leaves_the_acceleration_along_it)
{
    for (int g = 0; g < 2; g++) {
        CLEANUP(block_tear_down) block k;
        block_set_up(&k, g == 0 ? DEM_GUIDE_X : DEM_GUIDE_Y);
        const vec2 mean = rigid_body_mean(k.body, k.a);
        rigid_motion_accelerate(&k.model->rigid, k.x, k.v, k.a);
        for (dem_index i = 0; i < k.body->n_nodes; i++) {
            assert_close(k.a[2 * i + g], g == 0 ? mean.x : mean.y, 0.0);
            assert_close(k.a[2 * i + 1 - g], 0.0, 0.0);
        }
    }
}

/* ---- shapes ---- */

/* Places and velocities about the centre are made larger by a factor, as a Runge-Kutta step does. */
static void enlarge(block *k, double factor)
{
    const vec2 centre = rigid_body_mean(k->body, k->x), velocity = rigid_body_mean(k->body, k->v);
    for (dem_index i = 0; i < k->body->n_nodes; i++) {
        vec2_put(k->x, i, vec2_along(centre, factor, vec2_sub(vec2_at(k->x, i), centre)));
        vec2_put(k->v, i, vec2_along(velocity, factor, vec2_sub(vec2_at(k->v, i), velocity)));
    }
}

TEST(an_enlarged_body_gets_its_shape_back_and_keeps_its_spin)
{
    CLEANUP(block_tear_down) block k, expected;
    block_set_up(&k, DEM_GUIDE_NONE);
    block_set_up(&expected, DEM_GUIDE_NONE);
    enlarge(&k, 1.01);
    rigid_motion_put_back(&k.model->rigid, RIGID_MOTION_SPIN, k.x, k.v);
    for (dem_index c = 0; c < 2 * k.body->n_nodes; c++) {
        assert_close(k.x[c], expected.x[c], 1e-16);
        assert_close(k.v[c], expected.v[c], 1e-15);
    }
}

TEST(an_enlarged_body_may_keep_its_angular_momentum_instead)
{
    CLEANUP(block_tear_down) block k;
    block_set_up(&k, DEM_GUIDE_NONE);
    enlarge(&k, 1.01);
    const double moment = rigid_body_cross(k.body, arms(&k), (rigid_vectors){k.v, rigid_body_mean(k.body, k.v)});
    rigid_motion_put_back(&k.model->rigid, RIGID_MOTION_MOMENTUM, k.x, k.v);
    const double kept = rigid_body_cross(k.body, arms(&k), (rigid_vectors){k.v, rigid_body_mean(k.body, k.v)});
    assert_close(kept, moment, 1e-15 * moment);
    assert_close(kept / k.body->inertia, spin * 1.01 * 1.01, 1e-14);
    assert_int_equal(rigid_body_misplaced(k.body, k.x), -1);
    assert_int_equal(rigid_body_deviating(k.body, k.x, k.v), -1);
}

/* What the forces at the end of a step do to the momenta stays: the next half of Verlet's kick is like the last. */
TEST(the_derivative_keeps_force_and_moment_when_the_shape_is_put_back)
{
    CLEANUP(block_tear_down) block k;
    block_set_up(&k, DEM_GUIDE_NONE);
    enlarge(&k, 1.01);
    rigid_motion_accelerate(&k.model->rigid, k.x, k.v, k.a);
    const vec2 mean = rigid_body_mean(k.body, k.a);
    const double moment = rigid_body_cross(k.body, arms(&k), (rigid_vectors){k.a, mean});
    double u[MOST] = {0.0};
    rigid_motion_put_back_end(&k.model->rigid, RIGID_MOTION_SPIN, (double *[]){k.x, k.v}, (double *[]){u, k.a});
    assert_memory_equal(u, k.v, 2 * (size_t)k.body->n_nodes * sizeof *u);
    assert_close(rigid_body_mean(k.body, k.a).x, mean.x, 1e-12);
    assert_close(rigid_body_cross(k.body, arms(&k), (rigid_vectors){k.a, mean}), moment, 1e-13 * fabs(moment));
    double again[MOST];
    memcpy(again, k.a, sizeof again);
    rigid_motion_accelerate(&k.model->rigid, k.x, k.v, again);
    for (dem_index c = 0; c < 2 * k.body->n_nodes; c++) assert_close(again[c], k.a[c], 1e-10);
}

TEST(a_guided_body_that_is_put_back_moves_along_its_guide_alone)
{
    CLEANUP(block_tear_down) block k;
    block_set_up(&k, DEM_GUIDE_X);
    rigid_motion_put_back(&k.model->rigid, RIGID_MOTION_SPIN, k.x, k.v);
    for (dem_index i = 0; i < k.body->n_nodes; i++) {
        assert_close(k.v[2 * i], 0.5, 1e-15);
        assert_close(k.v[2 * i + 1], 0.0, 0.0);
    }
    assert_int_equal(rigid_body_misplaced(k.body, k.x), -1);
}
