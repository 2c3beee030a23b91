/* SPDX-License-Identifier: BSD-3-Clause */
/* Early reflection (docs/method.md, The window). At an impact, free candidates that would touch within the window tau
 * are reflected at once, where they are, by the law of their own impact. With `exact` every impact stops the step of
 * all bodies; a pressed surface that arrives node by node would stop it once for each. The energy is that of the impact
 * a moment later: the velocities are the same but for the acceleration over tau. Candidates that share nodes with
 * closed contacts are left to their groups (impact_group.c). No candidate is moved, and none is closed. */
#include "contact/early_reflection.h"

#include "contact/impact_rest.h"

/* Reflects a candidate as if it had a contact at its gap. The normal is the gap's: near a vertex it is not that of the
 * segment. */
void early_reflection_of(contact_set *c, dem_index k, const contact_gap *gap, contact_instant *now)
{
    vec2 kick;
    contact_frame f = contact_frame_on(&c->scene, &c->list[k], gap->feature, instant_state(now));
    f.normal = gap->normal;
    const impact_surface wall = impact_rest_surface(c, k, gap->feature, f.normal);
    const vec2 after = impact_law_rebound(&wall, 1, f.velocity, &kick), impulse = vec2_scale(1.0 / f.mobility, kick);
    dem_event event = contact_set_event(c, k, gap->feature, DEM_EVENT_IMPACT, now);
    contact_set_push(c, &f, impulse, now->v);
    event.normal[0] = f.normal.x;
    event.normal[1] = f.normal.y;
    vec2_put(event.after, 0, obstacle_motion_carry(f.wall, after));
    c->ledger.counts.early++;
    contact_set_add_impulse(c, event.obstacle, impulse, f.normal, f.wall);
    contact_set_enter_impact(c, &event, -0.5 * vec2_dot(impulse, vec2_add(f.velocity, after)), impulse, now);
}

/* Whether a candidate may touch within the window, judged by its clearance alone, which saves computing most gaps. */
static bool may_arrive(const contact_set *c, const contact_candidate *candidate, const candidate_positions *x,
                       const candidate_positions *v)
{
    const double way = c->scene.rule.window * (fmax(vec2_norm(v->a), vec2_norm(v->b)) + surface_speed(&c->scene));
    return candidate->clearance.distance - candidate_moved(&c->scene, candidate, x) < way;
}

/* Whether a candidate touches within the window if it goes on straight: near a vertex it may pass by. */
static bool arrives(const contact_set *c, const contact_candidate *candidate, const candidate_positions *x,
                    const candidate_positions *v)
{
    const double window = c->scene.rule.window;
    const candidate_positions ahead = {x->t + window, vec2_along(x->a, window, v->a), vec2_along(x->b, window, v->b),
                                       vec2_along(x->previous, window, v->previous),
                                       vec2_along(x->next, window, v->next)};
    return candidate_gap(&c->scene, candidate, &ahead).distance < -c->scene.rule.penetration_tolerance;
}

/* Two conditions must hold: the gap closes within tau at the present speed, and the candidate, taken straight on for
 * tau, is inside. Near a vertex a small gap may close without a touch. */
void early_reflection(contact_set *c, contact_instant *now)
{
    for (dem_index k = 0; k < c->n; k++) {
        contact_candidate candidate = c->list[k];
        const candidate_positions spot = candidate_place(&candidate, now->t, now->x),
                                  v = candidate_place(&candidate, now->t, now->v);
        if (candidate.n_closed > 0 || contact_set_coupled(c, k) || !may_arrive(c, &candidate, &spot, &v)) continue;
        candidate_forget_clearance(&candidate); /* so that the gap is exact */
        const contact_gap gap = candidate_gap(&c->scene, &candidate, &spot);
        if (gap.feature < 0) continue;
        const vec2 at = vec2_add(vec2_scale(1.0 - gap.place, v.a), vec2_scale(gap.place, v.b));
        const double speed = -vec2_dot(contact_gap_velocity(&c->scene, &candidate, &gap, &spot, at), gap.normal);
        if (speed > 0.0 && gap.distance + c->scene.rule.penetration_tolerance < speed * c->scene.rule.window &&
            arrives(c, &candidate, &spot, &v))
            early_reflection_of(c, k, &gap, now);
    }
}
