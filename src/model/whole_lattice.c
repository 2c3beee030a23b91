/* SPDX-License-Identifier: BSD-3-Clause */
/* Which nodes are common is said in model/domain_model.c. */
#include "model/whole_lattice.h"

#include <stdlib.h>

#include "base/status.h"
#include "domain/common_nodes.h"
#include "lattice/lattice.h"
#include "model/breakable_nodes.h"

whole_parts whole_parts_of(const dem_model *m)
{
    const dem_lattice *l = &m->lattice;
    return (whole_parts){.lattice = l,
                         .rigid = &m->rigid,
                         .n = {l->n_nodes, l->n_springs, l->n_triangles},
                         .has_obstacles = m->obstacles.n > 0,
                         .is_slack = !m->layout.stiff && !m->layout.coupled};
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

/* \param boundary  of surfaces that may touch each other; NULL: none do. Without obstacles, and what may break, there
 *  are no events, and so no rings. What is not near has none either */
static dem_status find_common(const whole_parts *whole, const mesh_boundary *boundary, const unsigned char *is_near,
                              unsigned char *is_common)
{
    const dem_lattice *l = whole->lattice;
    TRY(breakable_nodes_mark(l, is_common));
    mark_near(whole, is_near, is_common);
    if (boundary != NULL && is_near == NULL) mesh_boundary_mark(boundary, is_common, 1);
    if (whole->has_obstacles || breakable_lattice(l)) common_nodes_add_rings(l, whole_lattice_rings(l), is_common);
    if (is_near == NULL) return DEM_OK;
    mark_near(whole, NULL, is_common);
    if (boundary != NULL) mesh_boundary_mark(boundary, is_common, 1);
    return DEM_OK;
}

/* Where springs are damped accelerations follow from velocities of neighbours, so that a step would need twice as many
 * rings. Where something may break it does so on other ranks, too. */
static bool may_have_rings(const dem_lattice *l)
{
    return l->viscosity == NULL && !breakable_lattice(l);
}

static domain_shares shares_of(const whole_lattice *w, int n_ranks, const domain_model_shares *s, ring_use use)
{
    domain_shares shares = {.n_ranks = n_ranks,
                            .owner = s->owner,
                            .is_common = w->of.is_common,
                            .counting = w->of.counting,
                            .n_rings = s->n_rings,
                            .most_ghosts = INT64_MAX};
    if (s->n_rings > 0) return shares;
    const dem_index n = w->of.n[LATTICE_NODES];
    const ring_room room = w->of.is_slack ? use.slack : use.stiff;
    shares.n_rings = n >= room.least_nodes * n_ranks && may_have_rings(w->of.lattice) ? use.most : 1;
    shares.least_rings = use.least;
    shares.most_ghosts = n / room.part;
    return shares;
}

/* Where no use is known there are rings for steps of Verlet's method, so few that they are no burden to Fehlberg's
 * pair; else those that it has a use for. */
static dem_status find_lists(whole_lattice *w, int n_ranks, const domain_model_shares *s)
{
    enum { PAIR_RINGS = 3, LEAST_STEPS = 4, MOST_STEPS = 8 };
    ring_use both[] = {ring_use_of_steps(LEAST_STEPS, MOST_STEPS), ring_use_of_stages(PAIR_RINGS)};
    const ring_use *uses = s->use.most > 0 ? &s->use : both;
    const int n = s->use.most > 0 ? 1 : 2;
    both[0].slack = both[0].stiff;
    for (int k = 0; k < n && w->lists.rings.n_rings <= 1; k++) {
        domain_lists_free(&w->lists);
        w->shares = shares_of(w, n_ranks, s, uses[k]);
        TRY(domain_lists_create(&w->lists, w->of.lattice, &w->shares));
    }
    return DEM_OK;
}

static dem_status list_elements(whole_lattice *w)
{
    const dem_lattice *l = w->of.lattice;
    TRY(node_rows_create(&w->springs, l->ends, 2, l->n_springs, l->n_nodes));
    return node_rows_create(&w->triangles, l->triangles, 3, l->n_triangles, l->n_nodes);
}

static dem_status look_for_common(whole_lattice *w, const domain_model_shares *shares)
{
    const dem_lattice *l = w->of.lattice;
    mesh_boundary boundary = {0};
    w->is_common = lattice_zeros(l->n_nodes, sizeof *w->is_common);
    CHECK_MEMORY(w->is_common);
    w->of.is_common = w->is_common;
    if (shares->touching) TRY(mesh_boundary_create(&boundary, l, NULL));
    const dem_status status = find_common(&w->of, shares->touching ? &boundary : NULL, shares->is_near, w->is_common);
    mesh_boundary_free(&boundary);
    return status;
}

dem_status whole_lattice_open(whole_lattice *out, const whole_parts *of, int n_ranks, const domain_model_shares *shares)
{
    *out = (whole_lattice){.of = *of};
    if (of->is_common == NULL) TRY(look_for_common(out, shares));
    TRY(find_lists(out, n_ranks, shares));
    return list_elements(out);
}

void whole_lattice_close(whole_lattice *w)
{
    domain_lists_free(&w->lists);
    node_rows_free(&w->springs);
    node_rows_free(&w->triangles);
    free(w->is_common);
}
