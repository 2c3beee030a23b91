/* SPDX-License-Identifier: BSD-3-Clause */
/* Projects the accelerations of the nodes of a rigid body on rigid motions. With r_i the places from the centre of
 * mass, M the mass and I the sum of m r.r, both of the state as it is, forces m_i a_i become
 *   a_c = (sum of m_i a_i)/M,   alpha = (sum of m_i r_i x a_i)/I,   omega = (sum of m_i r_i x v_i)/I,
 *   a_i = a_c + alpha z x r_i - omega^2 r_i.
 * In free rotation every node solves the same linear equations from another start. A Runge-Kutta step therefore turns
 * and enlarges the places about the centre, and the velocities likewise, all by the same: its error of size is that of
 * the method. The shape is put back at the end of every step. As this takes an error of the step away and no energy of
 * the motion, the ledger has no entry for it. What is measured of a body is in model/rigid_bodies.c, how rigid bodies
 * touch others in src/surface_contact. */
#include "forces/rigid_motion.h"

/* The part of a vector along the guide; all of it without one. */
static vec2 guided(const rigid_body *b, vec2 a)
{
    if (b->guide == DEM_GUIDE_X) return (vec2){a.x, 0.0};
    return b->guide == DEM_GUIDE_Y ? (vec2){0.0, a.y} : a;
}

/* Velocities enter relative to the middle node: the sum of m r is 0, but for rounding. */
void rigid_motion_accelerate_body(const rigid_body *b, const double *x, const double *v, double *a)
{
    const vec2 mean = rigid_body_mean(b, a);
    pose at = {.acceleration = guided(b, mean)};
    if (b->guide == DEM_GUIDE_NONE) {
        at.centre = rigid_body_mean(b, x);
        const rigid_vectors places = {x, at.centre};
        const double inertia = rigid_body_dot(b, places, places);
        at.spin = rigid_body_cross(b, places, (rigid_vectors){v, vec2_at(v, b->middle)}) / inertia;
        at.spin_rate = rigid_body_cross(b, places, (rigid_vectors){a, mean}) / inertia;
    }
    for (dem_index k = 0; k < b->n_nodes; k++)
        vec2_put(a, b->nodes[k], pose_acceleration(&at, vec2_at(x, b->nodes[k])));
}

void rigid_motion_accelerate(const rigid_bodies *r, const double *x, const double *v, double *a)
{
    for (dem_index k = 0; k < r->n; k++) rigid_motion_accelerate_body(&r->list[k], x, v, a);
}

/* A state y = (x, v) of all nodes, and its derivative f = (u, a), if there is one. */
typedef struct rigid_end {
    double *x, *v;
    double *u, *a; /* NULL: not known */
} rigid_end;

/* The motion of a body in a state. Moments are those of the shape as it is, over the inertia that the body will have:
 * what the forces of this state will do to its angular momentum does not change. */
static pose motion_of(const rigid_body *b, rigid_invariant kept, const rigid_end *y)
{
    pose at = rigid_body_pose(b, y->x);
    const vec2 velocity = rigid_body_mean(b, y->v);
    const vec2 acceleration = y->a != NULL ? rigid_body_mean(b, y->a) : (vec2){0.0, 0.0};
    at.velocity = guided(b, velocity);
    at.acceleration = guided(b, acceleration);
    if (b->guide != DEM_GUIDE_NONE) return at;
    const rigid_vectors places = {y->x, at.centre};
    const double inertia = kept == RIGID_MOTION_SPIN ? rigid_body_dot(b, places, places) : b->inertia;
    at.spin = rigid_body_cross(b, places, (rigid_vectors){y->v, velocity}) / inertia;
    if (y->a != NULL) at.spin_rate = rigid_body_cross(b, places, (rigid_vectors){y->a, acceleration}) / b->inertia;
    return at;
}

static void put_back(const rigid_body *b, rigid_invariant kept, const rigid_end *y)
{
    const pose at = motion_of(b, kept, y);
    pose about = at; /* the same seen from the centre, where places have less rounding */
    about.centre = (vec2){0.0, 0.0};
    for (dem_index k = 0; k < b->n_nodes; k++) {
        const dem_index i = b->nodes[k];
        const vec2 arm = pose_turn(&at, vec2_at(b->shape, k)), velocity = pose_velocity(&about, arm);
        vec2_put(y->x, i, vec2_add(at.centre, arm));
        vec2_put(y->v, i, velocity);
        if (y->a == NULL) continue;
        vec2_put(y->u, i, velocity);
        vec2_put(y->a, i, pose_acceleration(&about, arm));
    }
}

void rigid_motion_put_back(const rigid_bodies *r, rigid_invariant kept, double *x, double *v)
{
    const rigid_end y = {.x = x, .v = v};
    for (dem_index k = 0; k < r->n; k++) put_back(&r->list[k], kept, &y);
}

void rigid_motion_put_back_end(const rigid_bodies *r, rigid_invariant kept, double *const y[2], double *const f[2])
{
    const rigid_end end = {y[0], y[1], f[0], f[1]};
    for (dem_index k = 0; k < r->n; k++) put_back(&r->list[k], kept, &end);
}
