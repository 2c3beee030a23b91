/* SPDX-License-Identifier: BSD-3-Clause */
/* All contact candidates of a model with the forces in their contacts and the ledger. The set closes and opens
 * contacts, and keeps groups, forces and sums in step with that; candidate_resolve.c and the impact_*.c files decide
 * when. */
#ifndef DEM_CONTACT_CONTACT_SET_H
#define DEM_CONTACT_CONTACT_SET_H

#include "contact/candidate.h"
#include "contact/ledger.h"

/** What the impact under way has done to one contact so far, and what will become of the contact. */
typedef struct contact_impact {
    bool fresh;      /* the contact was not closed before */
    bool opens;      /* it will not be closed after */
    bool approached; /* its point moved towards the surface */
    bool rests;      /* its rebound is no more than a hop that counts as rest */
    bool plastic;    /* it does not rebound, for it will last */
    vec2 before;     /* m/s, of the point of the body */
    vec2 impulse;    /* N s, given to the body */
    vec2 unstopped;  /* m/s, velocity of its point relative to the obstacle before contact_set_stop() */
    vec2 stop;       /* N s, what that gave it last */
    double energy;   /* J, taken by it */
} contact_impact;

/** The same for all contacts of a candidate: zero when no impact is under way, but for what contact_set_stop() left. */
typedef struct candidate_impact {
    int n; /* contacts that take part: the closed ones, then those that have opened */
    contact_impact of[2];
} candidate_impact;

/** Nodes that were inside an obstacle when they came to the surface, so far: without gaps, as checkpoints have it. */
typedef struct contact_burials {
    dem_index n;
    dem_index node;           /* of the first */
    double t;                 /* s, likewise */
    double x[STATE_DIM_MOST]; /* m, likewise */
} contact_burials;

typedef struct contact_set {
    contact_scene scene;
    const surface *surface; /* of the bodies */
    dem_index n;
    contact_candidate *list; /* [n] its nodes, then its edges: no place depends on what has happened before */
    contact_forces forces;
    contact_ledger ledger;
    int32_t *of_node; /* [n_nodes] candidate of a node, or -1 */
    dem_index n_involved;
    dem_index *involved;       /* [n_involved] candidates that take part in the impact under way; room for all */
    candidate_impact *impacts; /* [n] scratch of the impact under way */
    dem_contact *described;    /* [2 n] closed contacts as they were last reported */
    double step;               /* s, start of the step whose events are resolved one after the other */
    double projected;          /* m, the furthest that nodes were moved after a step to put closed contacts back */
    bool has_new;              /* some nodes may have come with the last surface */
    contact_burials burials;
    dem_index n_orphans;
    contact_candidate *orphans; /* [n_orphans] that have gone with their surface while they had closed contacts */
} contact_set;

/** `c` must stay where it is. */
dem_status contact_set_create(contact_set *c, const forces *acting, const contact_rule *rule);
void contact_set_destroy(contact_set *c);

/** Makes the candidates those of another surface of the same nodes, which is borrowed; the one before has to last till
 *  then. Candidates of both keep their contacts and what is known of them under new numbers; new ones are free. Those
 *  that go with closed contacts are orphans until they are released. Not during an impact.
 *  \return DEM_ERROR_MEMORY, with the set as it was */
dem_status contact_set_follow_surface(contact_set *c, const surface *to);

/** Reports and counts the release of the orphans' contacts in the state after the surface has changed. */
void contact_set_release_orphans(contact_set *c, contact_instant *now);

/** A candidate becomes what the same one was at another time, perhaps on another surface. */
void contact_set_become(contact_set *c, dem_index k, const contact_candidate *was);

/** A candidate without contacts and clearance; only the obstacles that it is behind are kept, and that it is new. */
static inline contact_candidate candidate_reset(const contact_candidate *candidate)
{
    return (contact_candidate){.node = candidate->node,
                               .other = candidate->other,
                               .previous = candidate->previous,
                               .next = candidate->next,
                               .behind = {candidate->behind[0], candidate->behind[1]},
                               .is_new = candidate->is_new};
}

/** Marks a candidate's clearance as unknown. */
static inline void candidate_forget_clearance(contact_candidate *candidate)
{
    candidate->clearance.inactive = false;
    candidate->clearance.distance = 0.0;
}

/** Whether edges are candidates: only where obstacles have vertices. */
static inline bool contact_set_has_edges(const contact_set *c)
{
    return c->n > c->surface->n_nodes;
}

/** The candidate of the k-th edge of the surface. */
static inline dem_index contact_set_of_edge(const contact_set *c, dem_index edge)
{
    return c->surface->n_nodes + edge;
}

/** The edges at a node that are candidates, ascending; contact_edges_next() leads to each of them. */
typedef struct contact_edges {
    const dem_index *at, *end; /* edges of the surface */
    dem_index n_nodes;
    dem_index k; /* the candidate */
} contact_edges;

static inline contact_edges contact_set_edges_at(const contact_set *c, dem_index node)
{
    const surface *s = c->surface;
    if (!contact_set_has_edges(c)) return (contact_edges){0};
    return (contact_edges){s->at + s->row[node], s->at + s->row[node + 1], s->n_nodes, -1};
}

static inline bool contact_edges_next(contact_edges *e)
{
    if (e->at == e->end) return false;
    e->k = e->n_nodes + *e->at++;
    return true;
}

/** The candidate with a key, or -1. */
dem_index contact_set_find(const contact_set *c, contact_key key);

/** The nodes that an event of a candidate may change at once: its own, and where obstacles have vertices those of the
 *  edges at them; some come more than once.  \return how many there are, of which up to `capacity` are in `nodes` */
dem_index contact_set_seeds(const contact_set *c, dem_index k, dem_index *nodes, dem_index capacity);

/** Whether other closed contacts share a node with the candidate. */
bool contact_set_coupled(const contact_set *c, dem_index k);

/** Notes that a node has passed round the free end of an obstacle, or come back (-1), in the node and in its edges. */
void contact_set_pass_behind(contact_set *c, dem_index k, dem_index obstacle);

/** Counts for the ledger the nodes that are behind obstacles. */
void contact_set_count_behind(contact_set *c);

/** Looks where nodes are that have come with the last surface: one that is inside an obstacle has not come through its
 *  front, and is behind it. */
void contact_set_look_at_new(contact_set *c, scene_state state);

/** Finds the groups of all contacts, and which of them are corners. */
dem_status contact_set_regroup(contact_set *c);

/** The same when these candidates have opened or closed contacts, and no others. */
dem_status contact_set_regroup_some(contact_set *c, const dem_index *changed, dem_index n);

/** Adds or takes away a closed contact. */
dem_status contact_set_close(contact_set *c, dem_index k, contact_point point);
dem_status contact_set_open(contact_set *c, dem_index k, int q);

/** Moves node i by `shift` and enters the energy that this puts in. */
void contact_set_move(contact_set *c, dem_index i, vec2 shift, double *x);

/** Stores the forces of a candidate's contacts as last solved for. */
void contact_set_store_forces(contact_set *c, dem_index k);

/** Solves for the forces of the candidate's group and stores them in the candidate's contacts. */
void contact_set_solve_forces(contact_set *c, dem_index k, scene_state state);

/** Solves for the forces of all groups; stores those of all closed contacts. */
void contact_set_solve_all(contact_set *c, scene_state state);
void contact_set_store_all(contact_set *c);

/** Takes from the velocities of a group what its closed contacts do not allow. Leaves in `stop` of each the impulse
 *  that this takes.
 *  \return the energy that it takes, J */
double contact_set_stop(contact_set *c, dem_index group, const contact_instant *now);

/** What a closed contact adds to the rates of its obstacle, with the forces last solved for. */
typedef struct contact_contribution {
    dem_index obstacle;
    vec2 force, friction; /* N, on the body: all of it, and the part along the surface */
    double power;         /* W, that friction takes */
    double work;          /* W, that the obstacle does as it moves */
} contact_contribution;

contact_contribution contact_set_contribution(const contact_set *c, dem_index k, int q, scene_state state);

/** The group that has closed contacts at a node, or -1. */
static inline dem_index contact_set_group_at(const contact_set *c, dem_index node)
{
    return c->forces.at_node[node];
}

/** An event of a candidate at a feature, with all that is known before an impact is resolved. */
dem_event contact_set_event(const contact_set *c, dem_index k, dem_index feature, dem_event_kind kind,
                            const contact_instant *now);

/** Gives the nodes that carry a contact an impulse (N s) at it. */
void contact_set_push(const contact_set *c, const contact_frame *f, vec2 impulse, double *v);

/** Adds an impulse (N s) to those that an obstacle gave: what is not along the normal is friction's, if it has any.
 *  \param carried  m/s, velocity of the obstacle there, with which it does work */
void contact_set_add_impulse(contact_set *c, dem_index obstacle, vec2 impulse, vec2 normal, vec2 carried);

/** Reports an impact and enters its energy, J, and the impulse (N s) that the features gave together. */
void contact_set_enter_impact(contact_set *c, dem_event *event, double energy, vec2 impulse, contact_instant *now);

#endif
