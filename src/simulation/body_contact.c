/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact of bodies with each other in the time loop. A step is only taken if no node has crossed an edge in it: the
 * potential has no bound, so that a crossing is always a step that was too long. The force itself is part of the
 * right-hand side (forces/forces.h); the pairs and their potential are in src/surface_contact. */
#include "simulation/body_contact.h"

#include "base/reduce.h"
#include "base/status.h"
#include "surface_contact/surface_start.h"

dem_status body_contact_create(dem_simulation *s)
{
    const dem_options *o = &s->options;
    const surface_contact_rule rule = {.within_bodies = o->bodies == DEM_BODIES_ALL,
                                       .thickness = o->contact_thickness,
                                       .stiffness = o->contact_stiffness};
    if (o->bodies == DEM_BODIES_NONE) return DEM_OK;
    TRY(surface_contact_create(&s->surfaces, &s->model->lattice, &rule));
    return body_contact_check_start(s, s->model->lattice.position);
}

dem_status body_contact_check_start(dem_simulation *s, const double *x)
{
    if (s->surfaces == NULL) return DEM_OK;
    TRY(surface_contact_follow(s->surfaces, x));
    return surface_start_check(s->surfaces, x);
}

dem_status body_contact_follow(dem_simulation *s, const double *y)
{
    return s->surfaces != NULL ? surface_contact_follow(s->surfaces, y) : DEM_OK;
}

dem_status body_contact_begin_step(dem_simulation *s)
{
    return s->surfaces != NULL ? surface_contact_begin_step(s->surfaces, s->path.y0, s->path.y1) : DEM_OK;
}

/* Steps of a fixed length cannot be shortened by the loop. */
static dem_status refuse_crossing(const dem_simulation *s, const surface_crossing *crossing)
{
    const dem_index *nodes = crossing->pair.nodes, node = nodes[CONTACT_PAIR_NODE];
    const int32_t *body = s->model->lattice.body;
    const double *x = state_x(&s->layout, s->path.y0, node);
    return status_fail(DEM_ERROR_CONTACT,
                       "node %lld of body %d crosses the edge between nodes %lld and %lld of body %d near (%g, %g) m, "
                       "t = %.9g s%s",
                       (long long)node, body[node], (long long)nodes[CONTACT_PAIR_FIRST],
                       (long long)nodes[CONTACT_PAIR_SECOND], body[nodes[CONTACT_PAIR_FIRST]], x[0], x[1],
                       s->t + crossing->part * (s->path.end - s->t),
                       s->options.fixed_step > 0.0 ? ": shorten fixed_step" : "");
}

/* Events may bring nodes into contact that were not near in the step: an adaptive step is then taken again, shorter; a
 * fixed one goes on, and the derivative at its end is evaluated anew. */
dem_status body_contact_check_step(dem_simulation *s)
{
    surface_crossing crossing;
    s->outgrown = false;
    if (s->surfaces == NULL) return DEM_OK;
    const double *end = s->path.y1;
    if (s->path.end < s->path.t1) {
        dense_output_state(&s->path, s->path.end, s->frame);
        end = s->frame;
    }
    const surface_contact_fault fault = surface_contact_check_step(s->surfaces, s->path.y0, end, &crossing);
    if (fault == SURFACE_CONTACT_CROSSED) return refuse_crossing(s, &crossing);
    s->outgrown = fault == SURFACE_CONTACT_OUTGROWN;
    CHECK(!s->outgrown || s->options.fixed_step > 0.0, DEM_ERROR_CONTACT,
          "events in the step from t = %.9g s move surfaces of bodies too far", s->t);
    return DEM_OK;
}

dem_surfaces body_contact_surfaces(const dem_simulation *s, const double *x)
{
    if (s->surfaces == NULL) return (dem_surfaces){.gap_min = INFINITY, .gap_share = INFINITY};
    const contact_surface *of = &s->surfaces->surface;
    const surface_gaps gaps = surface_contact_gaps(s->surfaces, x);
    return (dem_surfaces){.gap_min = reduce_min(gaps.least),
                          .gap_share = reduce_min(gaps.least_share),
                          .thickness_min = of->least_thickness,
                          .thickness_max = of->most_thickness,
                          .pushing = reduce_count(gaps.pushing),
                          .n_edges = reduce_count(of->surface.n_edges)};
}

/* Halving a step that is stable would spoil the energy that fixed steps keep: with the default of 1/4 of the stability
 * bound contact needs no shorter steps until h omega is 1. */
double body_contact_stiffening(dem_simulation *s, double guard, const double *y)
{
    if (s->surfaces == NULL || !(s->options.fixed_step > 0.0)) return guard;
    const double omega = s->model->omega_max * guard;
    const double added = surface_contact_stiffening(s->surfaces, s->model->inverse_mass, y);
    const double product = s->options.fixed_step * sqrt(omega * omega + added);
    return product > 1.0 ? fmax(guard, product) : guard;
}
