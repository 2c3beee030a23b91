/* SPDX-License-Identifier: BSD-3-Clause */
/* Guards of one contact site as functions of the state, and their first zero in a step. */
#include "site.h"

#include <float.h>

vec2 site_force(const contact_scene *scene, const contact_site *site, const double *x)
{
    const double m = scene->model->lattice.mass[site->node];
    return vec2_scale(m, model_acceleration(scene->model, scene->rule.gravity, site->node, x));
}

obstacle_gap site_free_gap(const contact_scene *scene, const contact_site *site, vec2 x)
{
    return obstacles_gap(&scene->model->obstacles, x, site->behind, -1);
}

obstacle_gap site_other_gap(const contact_scene *scene, const contact_site *site, vec2 x)
{
    return obstacles_gap(&scene->model->obstacles, x, site->behind, scene_segment(scene, site->segments[0])->obstacle);
}

void site_reactions(const contact_scene *scene, const contact_site *site, const double *x, double reaction[2])
{
    const vec2 f = site_force(scene, site, x), n0 = scene_segment(scene, site->segments[0])->normal;
    reaction[0] = -vec2_dot(f, n0);
    reaction[1] = 0.0;
    if (site->n_closed < 2) return;
    vec2_parts(vec2_scale(-1.0, f), n0, scene_segment(scene, site->segments[1])->normal, reaction);
}

int site_end_passed(const contact_scene *scene, const contact_site *site, const double *x, const double *v)
{
    const segment *s = scene_segment(scene, site->segments[0]);
    const double place = segment_place(s, vec2_at(x, site->node)), speed = vec2_dot(vec2_at(v, site->node), s->tangent);
    if (place > 0.0 && place < s->length) return 0;
    const double heading = speed != 0.0 ? speed : vec2_dot(site_force(scene, site, x), s->tangent);
    if (place <= 0.0 && heading < 0.0) return -1;
    return place >= s->length && heading > 0.0 ? 1 : 0;
}

/* The gap as a guard: finite where there is no obstacle. */
static double gap_guard(const contact_scene *scene, obstacle_gap gap)
{
    return fmin(gap.distance, 1.0) + scene->rule.skin;
}

void site_guards(const contact_scene *scene, const contact_site *site, const double *x, double *g)
{
    const vec2 at = vec2_at(x, site->node);
    g[0] = g[1] = g[2] = 1.0;
    if (site->n_closed == 0) {
        g[0] = gap_guard(scene, site_free_gap(scene, site, at));
        return;
    }
    double reaction[2];
    site_reactions(scene, site, x, reaction);
    g[0] = reaction[0];
    if (site->n_closed == 2) {
        g[1] = reaction[1];
        return;
    }
    const segment *s = scene_segment(scene, site->segments[0]);
    const double place = segment_place(s, at);
    g[1] = fmin(place, s->length - place);
    g[2] = gap_guard(scene, site_other_gap(scene, site, at));
}

bool site_due(const contact_scene *scene, const contact_site *site, const double *y)
{
    double g[SITE_GUARDS];
    site_guards(scene, site, y, g);
    if (g[0] <= 0.0) return true;
    if (site->n_closed == 2) return g[1] <= 0.0;
    return g[2] <= 0.0 || site_end_passed(scene, site, y, y + 2 * scene->model->lattice.n_nodes) != 0;
}

static double free_guard(const contact_scene *scene, const contact_site *site, const path *p, double t)
{
    return gap_guard(scene, site_free_gap(scene, site, path_position(p, t, site->node)));
}

/* Width to which a time in the step is located: what ARKODE's root finder uses. */
static double time_resolution(const path *p, double t)
{
    return 100.0 * DBL_EPSILON * (fabs(t) + p->end - p->t0);
}

double site_first_crossing(const contact_scene *scene, const contact_site *site, const path *p, bool rooted)
{
    enum { samples = 8 };
    const double h = p->end - p->t0, last = free_guard(scene, site, p, p->end);
    const double speed =
        fmax(vec2_norm(path_velocity(p, p->t0, site->node)), vec2_norm(path_velocity(p, p->end, site->node)));
    if (last > 0.0 && fmin(last, free_guard(scene, site, p, p->t0)) > 2.0 * h * speed)
        return INFINITY; /* out of reach */
    double clear = p->t0, deep = INFINITY;
    for (int k = 1; k <= samples - rooted && isinf(deep); k++) {
        const double t = k == samples ? p->end : p->t0 + h * k / samples;
        if (free_guard(scene, site, p, t) <= 0.0)
            deep = t;
        else
            clear = t;
    }
    while (!isinf(deep) && deep - clear > time_resolution(p, deep)) {
        const double middle = 0.5 * (clear + deep);
        if (free_guard(scene, site, p, middle) <= 0.0)
            deep = middle;
        else
            clear = middle;
    }
    return deep;
}

double site_first_due(const contact_scene *scene, const contact_site *site, const path *p, double *state)
{
    double before = p->t0, after = p->end;
    while (after - before > time_resolution(p, after)) {
        const double middle = 0.5 * (before + after);
        path_state(p, middle, state);
        if (site_due(scene, site, state))
            after = middle;
        else
            before = middle;
    }
    return after;
}
