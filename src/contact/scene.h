/* SPDX-License-Identifier: BSD-3-Clause */
/* What contacts are computed from: the model, what acts on its nodes, the rules of a run, and a state at a time. */
#ifndef DEM_CONTACT_SCENE_H
#define DEM_CONTACT_SCENE_H

#include <float.h>
#include <math.h>

#include "base/state.h"
#include "base/team.h"
#include "forces/forces.h"

typedef struct contact_rule {
    double penetration_tolerance; /* m, depth at which an impact is taken */
    double position_error;        /* m, tolerance of positions: hops below it are rest */
    double rest_speed;            /* m/s, rebounds up to this are rest whatever else the rule says */
    double window;                /* s, impacts nearer than this are taken together */
    double max_step;              /* s, longest step: with t it sets how exactly an event is located */
    double storm_time;            /* s */
    dem_index max_impacts;        /* within storm_time at one candidate */
    dem_index most_in_step;       /* at one candidate in a step that can be taken again, shorter; else 0 */
    dem_index turns_in_step;      /* changes of one candidate after which it does not turn back again in a step; or 0 */
    bool vertices;                /* whether edges touch vertices */
    state_layout layout;          /* of the states */
    team *team;                   /* whose threads look at free candidates; NULL: the caller */
} contact_rule;

/** What does not change during a run. */
typedef struct contact_scene {
    const dem_model *model;
    const forces *forces; /* on the nodes of the model, without those of contacts */
    contact_rule rule;
} contact_scene;

/** The number of node i in the whole lattice, for messages. */
static inline long long scene_node(const contact_scene *scene, dem_index i)
{
    return (long long)model_node(scene->model, i);
}

/** By how much free ends of obstacles count as longer, m: a candidate further out than this cannot hit the end. */
static inline double scene_margin(const contact_scene *scene)
{
    return 10.0 * scene->rule.penetration_tolerance;
}

/** Time within which events count as one in time, s: ten times the 100 eps (t + h) to which one is located. */
static inline double scene_instant(const contact_scene *scene, double t)
{
    return 1000.0 * DBL_EPSILON * (fabs(t) + scene->rule.max_step);
}

/** A state for which contacts are computed: the nodes' positions and velocities [n][2] at a time. */
typedef struct scene_state {
    double t; /* s */
    const double *x, *v;
} scene_state;

/** The layout of the states. */
static inline const state_layout *scene_layout(const contact_scene *scene)
{
    return &scene->rule.layout;
}

/** The state y = (x, v) at t. */
static inline scene_state scene_state_at(const contact_scene *scene, double t, const double *y)
{
    return (scene_state){t, y, y + state_velocities(scene_layout(scene))};
}

#endif
