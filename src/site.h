/* SPDX-License-Identifier: BSD-3-Clause */
/* One contact site: the gaps it has and the reactions it feels, the guards that tell when its contacts change, and
 * the search for such a change within a step. Nothing here changes a state. */
#ifndef DEM_SITE_H
#define DEM_SITE_H

#include "model.h"
#include "path.h"

/** Guard functions per site; each is > 0 while nothing happens and falls through 0 when something does. */
#define SITE_GUARDS 3

/** One node that may touch. Free: n_closed = 0; sliding on a segment: 1; held in a corner: 2. */
typedef struct contact_site {
    dem_index node;
    dem_index behind; /* obstacle whose free end the node has passed round, or -1 */
    int n_closed;
    dem_index segments[2];
    dem_contact closed[2];
    double storm_start; /* s */
    dem_index storm;    /* changes of this site since then */
} contact_site;

typedef struct contact_rule {
    double skin;           /* m, depth at which an impact is taken */
    double position_error; /* m, tolerance of positions: hops below it are rest */
    double rest_speed;     /* m/s, 0: by the rule */
    double max_step;       /* s, longest step: with t it sets how exactly an event is located */
    double storm_time;     /* s */
    dem_index max_impacts; /* within storm_time at one node */
    model_load load;
} contact_rule;

/** What does not change during a run. */
typedef struct contact_scene {
    const dem_model *model;
    contact_rule rule;
} contact_scene;

static inline const segment *scene_segment(const contact_scene *scene, dem_index s)
{
    return &scene->model->obstacles.segments[s];
}

/** By how much free ends of obstacles count as longer, m: beyond it an impact is not due to the end any more. */
static inline double scene_margin(const contact_scene *scene)
{
    return 10.0 * scene->rule.skin;
}

/** Force on a site's node free of contact, elastic and weight, N. */
vec2 site_force(const contact_scene *scene, const contact_site *site, const double *x);

/** Gap of a free node to what it can hit. */
obstacle_gap site_free_gap(const contact_scene *scene, const contact_site *site, vec2 x);

/** Gap of a sliding node to the other obstacles: on its own one only the ends of its segment can stop it. */
obstacle_gap site_other_gap(const contact_scene *scene, const contact_site *site, vec2 x);

/** Reaction of each closed contact, N: what balances the force along its normal; < 0 pulls. */
void site_reactions(const contact_scene *scene, const contact_site *site, const double *x, double reaction[2]);

/** -1 or 1 if a sliding node is beyond the start or the end of its segment by the skin and heads out, else 0. */
int site_end_passed(const contact_scene *scene, const contact_site *site, const double *x, const double *v);

/** Values of the guards at positions x, [SITE_GUARDS]:
 *  free: gap + skin; sliding: reaction, distance to the segment's nearer end + skin, gap to the other obstacles + skin;
 *  held: both reactions. What is left over is 1. */
void site_guards(const contact_scene *scene, const contact_site *site, const double *x, double *g);

/** Whether a closed site's contacts have to change in the state y = (x, v). */
bool site_due(const contact_scene *scene, const contact_site *site, const double *y);

/** First time in the step at which a free site is as deep as the skin; infinity if never, or if only at the end of a
 *  step that ends at a root (`rooted`). The step is sampled eight times, and every dip between samples followed to
 *  its bottom. */
double site_first_crossing(const contact_scene *scene, const contact_site *site, const path *p, bool rooted);

/** First time in the step at which a closed site, due at its end, is due.  \param[out] state  [4 n] scratch */
double site_first_due(const contact_scene *scene, const contact_site *site, const path *p, double *state);

#endif
