/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact of rigid bodies with obstacles: a force that depends on positions and time, by the contact potential of
 * bodies, with the friction of bodies. An impact on a rigid body would move all of it at once, and with it all that it
 * touches: such bodies have no events, and neither restitution nor rest. */
#ifndef DEM_SURFACE_CONTACT_RIGID_CONTACT_H
#define DEM_SURFACE_CONTACT_RIGID_CONTACT_H

#include "base/rate_sums.h"
#include "surface_contact/rigid_pairs.h"

typedef struct rigid_contact {
    const dem_model *model;
    obstacle_surface obstacles;
    dem_index n;       /* rigid bodies of the model */
    rigid_pairs *list; /* [n] in the same order */
    rate_sums rates;   /* scratch of rigid_contact_add_rates() */
    dem_status status; /* of the last evaluation; DEM_ERROR_MEMORY stays until it is set back */
} rigid_contact;

/** *out is NULL if the model has no rigid bodies, or no obstacles. Borrows the model. Free with
 *  rigid_contact_destroy().
 *  \param of  the surface of all bodies, of which what is needed is copied
 *  \return DEM_ERROR_MEMORY */
dem_status rigid_contact_create(rigid_contact **out, const dem_model *model, const contact_surface *of);
void rigid_contact_destroy(rigid_contact *c);

/** Whether forces depend on time: an obstacle moves. NULL: there are none. */
static inline bool rigid_contact_is_driven(const rigid_contact *c)
{
    return c != NULL && c->model->obstacles.bounds.speed > 0.0;
}

/** Evaluates the forces on all rigid bodies at positions x [n][2] and t, into list[k].force.
 *  \return false if that fails: `status` says why */
bool rigid_contact_evaluate(rigid_contact *c, double t, const double *x);

/** Evaluates those on body k alone.  \return as rigid_contact_evaluate() */
bool rigid_contact_evaluate_body(rigid_contact *c, dem_index k, double t, const double *x);

/** Adds the accelerations by the forces on body k, as they were evaluated last, to a [n][2].
 *  \return the sum of what is there then: whether all is finite */
double rigid_contact_accelerate(const rigid_contact *c, dem_index k, double *a);

/** What a vertex of an obstacle, the q-th near a body, does to that in the state evaluated last: force, N. */
static inline vec2 rigid_contact_force(const rigid_pairs *p, dem_index q)
{
    const vec2 on_vertex = vec2_at(p->force, rigid_pairs_place(p, p->near[q]));
    return (vec2){0.0 - on_vertex.x, 0.0 - on_vertex.y};
}

/** Power that an obstacle puts into them there, W. */
double rigid_contact_power(const rigid_contact *c, dem_index obstacle);

/** Adds the rates of impulses and work of all obstacles, and of what friction takes, to a derivative, in the state
 *  evaluated last, with the velocities v. */
void rigid_contact_add_rates(const rigid_contact *c, const state_layout *l, const double *v, double *a);

/** Whether any rigid body has friction with an obstacle. NULL: there are none. */
static inline bool rigid_contact_has_friction(const rigid_contact *c)
{
    return c != NULL && rigid_pairs_have_friction(&c->list[0]);
}

/** Renews the anchors of friction for positions x [n][2] that a step has reached at t.  \return DEM_ERROR_MEMORY */
dem_status rigid_contact_settle(rigid_contact *c, double t, const double *x);

/** Puts n anchors of body k as they were remembered in the place of all, for positions x and the time t in which they
 *  were.  \return what anchor_set_restore() returns */
dem_status rigid_contact_restore(rigid_contact *c, dem_index k, const anchor_record *records, dem_index n, double t,
                                 const double *x);

/** What friction has stored in springs, J. */
double rigid_contact_stored(rigid_contact *c, double t, const double *x);

/** Energy without what friction has stored, J. */
double rigid_contact_energy(rigid_contact *c, double t, const double *x);

/** What contact adds at most to the square of the highest frequency, rad^2/s^2. */
double rigid_contact_stiffening(rigid_contact *c, double t, const double *x);

/** A crossing of a rigid body and an obstacle. */
typedef struct rigid_crossing {
    dem_index body, obstacle;
    vec2 place;  /* m, at the end of the step */
    double part; /* of the step */
} rigid_crossing;

/** Checks a step from x0 at t0 to x1 at t1.
 *  \return DEM_ERROR_CONTACT, without a message, if a body has crossed an obstacle; DEM_ERROR_MEMORY */
dem_status rigid_contact_check_step(rigid_contact *c, const double *x0, double t0, const double *x1, double t1,
                                    rigid_crossing *crossing);

/** Refuses positions in which a body crosses or nearly touches an obstacle.  \return DEM_ERROR_MODEL */
dem_status rigid_contact_check_start(rigid_contact *c, double t, const double *x);

#endif
