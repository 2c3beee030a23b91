/* SPDX-License-Identifier: BSD-3-Clause */
/* Which nodes are common is said in model/domain_model.c. */
#include "model/whole_lattice.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "domain/common_nodes.h"
#include "lattice/lattice.h"
#include "model/breakable_nodes.h"
#include "model/joined_nodes.h"
#include "model/mesh_boundary.h"

whole_parts whole_parts_of(const dem_model *m)
{
    const dem_lattice *l = &m->lattice;
    return (whole_parts){.lattice = l,
                         .rigid = &m->rigid,
                         .n = {l->n_nodes, l->n_springs, l->n_triangles},
                         .has_obstacles = m->obstacles.n > 0,
                         .is_slack = whole_lattice_is_slack(l)};
}

bool whole_lattice_is_slack(const dem_lattice *lattice)
{
    return lattice->area_stiffness == NULL && lattice->coupling == NULL;
}

int whole_lattice_rings(const dem_lattice *lattice)
{
    return lattice->viscosity != NULL ? 7 : 4;
}

/* \param is_near  NULL: all that may touch obstacles are */
static void mark_near(const whole_parts *whole, const unsigned char *is_near, unsigned char *is_common)
{
    const dem_lattice *l = whole->lattice;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const bool may_touch = whole->has_obstacles && l->flags[i] & DEM_NODE_CONTACT;
        if (l->flags[i] & DEM_NODE_RIGID || (may_touch && (is_near == NULL || is_near[i]))) is_common[i] = 1;
    }
}

static bool has_events(const whole_parts *whole)
{
    return whole->has_obstacles || breakable_lattice(whole->lattice);
}

/* Without obstacles, and what may break, there are no events, and so no rings. What is not near has none either.
 * \param touching   whether surfaces may touch each other
 * \param is_common  where nodes that may feel a break are marked, and others 0 */
static dem_status find_common(const whole_parts *whole, bool touching, const unsigned char *is_near,
                              unsigned char *is_common)
{
    const dem_lattice *l = whole->lattice;
    mark_near(whole, is_near, is_common);
    if (touching && is_near == NULL) TRY(mesh_boundary_mark_nodes(l, is_common, 1));
    if (has_events(whole)) common_nodes_add_rings(l, whole_lattice_rings(l), is_common);
    if (is_near == NULL) return DEM_OK;
    mark_near(whole, NULL, is_common);
    return touching ? mesh_boundary_mark_nodes(l, is_common, 1) : DEM_OK;
}

/* Where springs are damped accelerations follow from velocities of neighbours, so that a step would need twice as many
 * rings. Where something may break it does so on other ranks, too. */
static bool may_have_rings(const dem_lattice *l)
{
    return l->viscosity == NULL && !breakable_lattice(l);
}

static ring_room room_of(const whole_parts *of, ring_use use)
{
    return of->is_slack ? use.slack : use.stiff;
}

/* As many as there is a use for. */
static int rings_for(const whole_parts *of, int n_ranks, const domain_model_shares *s, ring_use use)
{
    if (s->n_rings > 0) return s->n_rings;
    return of->n[LATTICE_NODES] >= room_of(of, use).least_nodes * n_ranks && may_have_rings(of->lattice) ? use.most : 1;
}

static domain_shares shares_of(const whole_lattice *w, int n_ranks, const domain_model_shares *s, ring_use use)
{
    domain_shares shares = {.n_ranks = n_ranks,
                            .owner = s->owner,
                            .is_common = w->is_common,
                            .counting = w->of.counting,
                            .n_rings = rings_for(&w->of, n_ranks, s, use),
                            .most_ghosts = INT64_MAX};
    if (s->n_rings > 0) return shares;
    shares.least_rings = use.least;
    shares.most_ghosts = w->of.n[LATTICE_NODES] / room_of(&w->of, use).part;
    return shares;
}

enum { MOST_USES = 2 };

/* Where no use is known there are rings for steps of Verlet's method, so few that they are no burden to Fehlberg's
 * pair; else those that it has a use for.  \return how many uses there are, of which the first that fits counts */
static int list_uses(const domain_model_shares *s, ring_use uses[MOST_USES])
{
    enum { PAIR_RINGS = 3, LEAST_STEPS = 4, MOST_STEPS = 8 };
    uses[0] = s->use.most > 0 ? s->use : ring_use_of_steps(LEAST_STEPS, MOST_STEPS);
    if (s->use.most > 0) return 1;
    uses[0].slack = uses[0].stiff;
    uses[1] = ring_use_of_stages(PAIR_RINGS);
    return MOST_USES;
}

static dem_status find_lists(whole_lattice *w, int n_ranks, const domain_model_shares *s)
{
    ring_use uses[MOST_USES];
    const int n = list_uses(s, uses);
    for (int k = 0; k < n && w->lists.rings.n_rings <= 1; k++) {
        domain_lists_free(&w->lists);
        w->shares = shares_of(w, n_ranks, s, uses[k]);
        TRY(domain_lists_create(&w->lists, w->of.lattice, &w->shares));
    }
    return DEM_OK;
}

int whole_lattice_most_rings(const whole_parts *of, int n_ranks, const domain_model_shares *shares)
{
    ring_use uses[MOST_USES];
    const int n = list_uses(shares, uses);
    int most = 1;
    for (int k = 0; k < n; k++) {
        const int rings = rings_for(of, n_ranks, shares, uses[k]);
        most = rings > most ? rings : most;
    }
    return most;
}

static dem_status list_elements(whole_lattice *w)
{
    const dem_lattice *l = w->of.lattice;
    TRY(node_rows_create(&w->springs, l->ends, 2, l->n_springs, l->n_nodes));
    return node_rows_create(&w->triangles, l->triangles, 3, l->n_triangles, l->n_nodes);
}

static dem_status find_breakable(whole_lattice *w)
{
    const dem_lattice *l = w->of.lattice;
    if (!breakable_lattice(l)) return DEM_OK;
    breakable_nodes_mark(l, w->is_common);
    w->joined = lattice_zeros(l->n_nodes, sizeof *w->joined);
    CHECK_MEMORY(w->joined);
    joined_nodes_find(l, w->is_common, w->joined);
    return DEM_OK;
}

/* Of a part with the rings, as the nodes that they are about are known. */
static dem_status look_for_common(whole_lattice *w, const domain_model_shares *shares)
{
    const dem_lattice *l = w->of.lattice;
    w->is_common = lattice_zeros(l->n_nodes, sizeof *w->is_common);
    CHECK_MEMORY(w->is_common);
    TRY(find_breakable(w));
    if (w->of.is_common == NULL) return find_common(&w->of, shares->touching, shares->is_near, w->is_common);
    memcpy(w->is_common, w->of.is_common, (size_t)l->n_nodes);
    if (has_events(&w->of)) common_nodes_add_rings(l, whole_lattice_rings(l), w->is_common);
    return DEM_OK;
}

dem_status whole_lattice_open(whole_lattice *out, const whole_parts *of, int n_ranks, const domain_model_shares *shares)
{
    *out = (whole_lattice){.of = *of};
    TRY(look_for_common(out, shares));
    TRY(find_lists(out, n_ranks, shares));
    return list_elements(out);
}

void whole_lattice_close(whole_lattice *w)
{
    domain_lists_free(&w->lists);
    node_rows_free(&w->springs);
    node_rows_free(&w->triangles);
    free(w->is_common);
    free(w->joined);
}
