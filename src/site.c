/* SPDX-License-Identifier: BSD-3-Clause */
/* Guards of one contact site as functions of the state, and their first zero in a step. */
#include "site.h"

#include <float.h>

vec2 site_force(const contact_scene *scene, const contact_site *site, const double *x)
{
    const double m = scene->model->lattice.mass[site->node];
    const double *v = x + 2 * scene->model->lattice.n_nodes;
    return vec2_scale(m, model_acceleration(scene->model, &scene->rule.load, site->node, x, v));
}

obstacle_gap site_free_gap(const contact_scene *scene, const contact_site *site, vec2 x)
{
    return obstacles_gap(&scene->model->obstacles, x, scene_margin(scene), site->behind, -1);
}

obstacle_gap site_other_gap(const contact_scene *scene, const contact_site *site, vec2 x)
{
    return obstacles_gap(&scene->model->obstacles, x, scene_margin(scene), site->behind,
                         scene_segment(scene, site->segments[0])->obstacle);
}

void site_reactions(const contact_scene *scene, const contact_site *site, const double *x, double reaction[2])
{
    const vec2 f = site_force(scene, site, x), n0 = scene_segment(scene, site->segments[0])->normal;
    reaction[0] = -vec2_dot(f, n0);
    reaction[1] = 0.0;
    if (site->n_closed < 2) return;
    vec2_parts(vec2_scale(-1.0, f), n0, scene_segment(scene, site->segments[1])->normal, reaction);
}

/* Distance to the nearer end of the segment, and the skin: an end is passed when a node is beyond it by that. */
static double end_guard(const contact_scene *scene, const segment *s, vec2 x)
{
    const double place = segment_place(s, x);
    return fmin(place, s->length - place) + scene->rule.skin;
}

int site_end_passed(const contact_scene *scene, const contact_site *site, const double *x, const double *v)
{
    const segment *s = scene_segment(scene, site->segments[0]);
    const vec2 at = vec2_at(x, site->node);
    if (end_guard(scene, s, at) > 0.0) return 0;
    const int end = segment_place(s, at) > 0.0 ? 1 : -1;
    const double speed = vec2_dot(vec2_at(v, site->node), s->tangent);
    const double heading = speed != 0.0 ? speed : vec2_dot(site_force(scene, site, x), s->tangent);
    return end * heading > 0.0 ? end : 0;
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
    g[1] = end_guard(scene, scene_segment(scene, site->segments[0]), at);
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

/* A time between lo and hi at which the guard is as low as it gets, by golden section; the first found at or below 0
 * will do. */
static double lowest(const contact_scene *scene, const contact_site *site, const path *p, double lo, double hi)
{
    const double ratio = 0.6180339887498949;
    double a = hi - ratio * (hi - lo), b = lo + ratio * (hi - lo);
    double ga = free_guard(scene, site, p, a), gb = free_guard(scene, site, p, b);
    for (int k = 0; k < 40 && ga > 0.0 && gb > 0.0; k++) {
        if (ga < gb) {
            hi = b;
            b = a;
            gb = ga;
            a = hi - ratio * (hi - lo);
            ga = free_guard(scene, site, p, a);
        } else {
            lo = a;
            a = b;
            ga = gb;
            b = lo + ratio * (hi - lo);
            gb = free_guard(scene, site, p, b);
        }
    }
    return ga < gb ? a : b;
}

/* The zero of the guard between a time when it is above and one when it is not. */
static double crossing(const contact_scene *scene, const contact_site *site, const path *p, double clear, double deep)
{
    while (deep - clear > time_resolution(p, deep)) {
        const double middle = 0.5 * (clear + deep);
        if (free_guard(scene, site, p, middle) <= 0.0)
            deep = middle;
        else
            clear = middle;
    }
    return deep;
}

/* The guard of a free site at one time, and how fast it grows. */
typedef struct sample {
    double t, guard, slope;
} sample;

static sample sample_at(const contact_scene *scene, const contact_site *site, const path *p, double t)
{
    const obstacle_gap gap = site_free_gap(scene, site, path_position(p, t, site->node));
    return (sample){t, gap_guard(scene, gap), vec2_dot(gap.normal, path_velocity(p, t, site->node))};
}

double site_first_crossing(const contact_scene *scene, const contact_site *site, const path *p, bool rooted)
{
    enum { n = 8 };
    const double h = p->end - p->t0;
    const double v0 = vec2_norm(path_velocity(p, p->t0, site->node)),
                 v1 = vec2_norm(path_velocity(p, p->end, site->node));
    const double reach = 2.0 * h * fmax(v0, v1); /* no site goes further in this step */
    const sample last = sample_at(scene, site, p, p->end);
    sample s = sample_at(scene, site, p, p->t0);
    if (last.guard > reach && s.guard > reach) return INFINITY;
    for (int k = 1; k <= n; k++) {
        const sample next = k == n ? last : sample_at(scene, site, p, p->t0 + h * k / n);
        if (next.guard <= 0.0) return k == n && rooted ? INFINITY : crossing(scene, site, p, s.t, next.t);
        if (s.slope < 0.0 && next.slope > 0.0 && fmin(s.guard, next.guard) < reach / n) { /* a dip in between */
            const double low = lowest(scene, site, p, s.t, next.t);
            if (free_guard(scene, site, p, low) <= 0.0) return crossing(scene, site, p, s.t, low);
        }
        s = next;
    }
    return INFINITY;
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
