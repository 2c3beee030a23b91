/* SPDX-License-Identifier: BSD-3-Clause */
/* All contact sites of a model with the forces in their contacts and the books: how contacts begin and end. */
#ifndef DEM_CONTACT_CONTACT_SET_H
#define DEM_CONTACT_CONTACT_SET_H

#include "contact/candidate.h"
#include "contact/ledger.h"

typedef struct contact_sites {
    contact_scene scene;
    dem_index n;
    contact_site *list; /* [n] the model's nodes that may touch, then its edges */
    reactions reactions;
    contact_books books;
    dem_index *of_node;  /* [n_nodes] site of a node, or -1 */
    double straightened; /* m, the furthest that nodes were moved after a step to put closed contacts back */
} contact_sites;

/** `c` must stay where it is. */
dem_status sites_create(contact_sites *c, const dem_model *model, const contact_rule *rule);
void sites_destroy(contact_sites *c);

/** A site of the same nodes without contacts, of which nothing is known but behind what it is. */
static inline contact_site sites_anew(const contact_site *site)
{
    return (contact_site){.node = site->node,
                          .other = site->other,
                          .previous = site->previous,
                          .next = site->next,
                          .behind = {site->behind[0], site->behind[1]}};
}

/** What was known of a site's distance to other things holds no more. */
static inline void sites_disturb(contact_site *site)
{
    site->asleep = false;
    site->clear = 0.0;
}

/** The site of the k-th edge of the surface. */
static inline dem_index sites_of_edge(const contact_sites *c, dem_index edge)
{
    return c->scene.model->n_sites + edge;
}

/** Whether other closed contacts share a node with the site. */
bool sites_coupled(const contact_sites *c, dem_index k);

/** A node has passed round the free end of an obstacle, or come back (-1); its edges know as well. */
void sites_go_behind(contact_sites *c, dem_index k, dem_index obstacle);

/** Finds the groups of contacts and which of them are corners, when closed contacts have changed. */
dem_status sites_regroup(contact_sites *c);

/** Adds or takes away a closed contact. */
dem_status sites_close(contact_sites *c, dem_index k, contact_touch touch);
dem_status sites_open(contact_sites *c, dem_index k, int q);

/** Moves node i by `shift` and books the energy that this puts in. */
void sites_move(contact_sites *c, dem_index i, vec2 shift, double *x);

/** Stores the forces of a site's contacts as last solved for. */
void sites_store(contact_sites *c, dem_index k);

/** Solves for the forces of the site's group and stores them in the site's contacts. */
void sites_weigh(contact_sites *c, dem_index k, const double *x, const double *v);

/** Stops a group: closed contacts neither open nor slide where they stick. Leaves in `stop` of each the impulse that
 *  this takes.  \return the energy that it takes, J */
double sites_stop(contact_sites *c, dem_index group, const double *x, double *v);

/** What a closed contact does to its obstacle's account, with the forces last solved for. */
typedef struct sites_share {
    dem_index obstacle;
    vec2 force, friction; /* N, on the body: all of it, and the part along the surface */
    double power;         /* W, that friction takes */
} sites_share;

sites_share sites_share_of(const contact_sites *c, dem_index k, int q, const double *x, const double *v);

/** The group that has closed contacts at a node, or -1. */
dem_index sites_group_at(const contact_sites *c, dem_index node);

/** An event of a site at a feature: what is known without the impact. */
dem_event sites_event(const contact_sites *c, dem_index k, dem_index feature, dem_event_kind kind,
                      const contact_moment *now);

#endif
