/* SPDX-License-Identifier: BSD-3-Clause */
/* A domain's model is compiled from the lattice of its nodes, as any other is, but for what depends on more than the
 * neighbours of its own nodes. The boundary, as a side whose other triangle belongs to another rank only is none, and
 * the shares of springs in stresses, as a side opposite to an own node may have its other triangle elsewhere, follow
 * from a lattice with the triangles beside the domain; scales are those of the whole. Orders of nodes, springs and
 * triangles are those of the whole, so that sums over a row have the same bits. A ghost of the last ring has the
 * inverse mass 0, as its row is not complete. What ghosts do comes from their owners, but several rings of them can be
 * integrated here through a step. All that is taken from the whole is the cut of a domain (model/domain_cut.h), which
 * may be made on rank 0 and sent; the rest is compiled from it alone.
 *
 * All ranks have in common
 * - where there are obstacles what may touch them;
 * - where bodies touch each other, or themselves, all nodes of their surfaces, with the boundary of the whole and the
 *   sums over its bodies by which the laws of surfaces are chosen;
 * - rigid bodies, whose motion follows from sums over them;
 * - what has elements that may break, with all that is joined to these: which break, in which order, and what comes of
 *   it, surfaces and fragments too, each rank finds by itself;
 * - where there are obstacles, or surfaces beside what may break, what the correction of a step for an event changes or
 *   reads, too (events/local_correction.c): its rings about the nodes that the event moves, which are among those that
 *   may touch or break, and the accelerations of the last of these rings. From one surface to another that it touches a
 *   ring goes to nodes that are on surfaces, and begins anew there. Who can do without some events has rings only where
 *   others may happen soon. */
#include "model/domain_model.h"

#include <stdlib.h>

#include "base/reduce.h"
#include "base/status.h"
#include "domain/common_nodes.h"
#include "lattice/lattice.h"
#include "model/breakable_nodes.h"
#include "model/domain_compile.h"
#include "model/domain_message.h"

/* ---- what is found of the whole once ---- */

static void close_whole(whole_lattice *w)
{
    touching_bodies_free(&w->bodies);
    domain_lists_free(&w->lists);
    node_rows_free(&w->springs);
    node_rows_free(&w->triangles);
    free(w->is_common);
}

int domain_model_rings(const dem_lattice *lattice)
{
    return lattice->viscosity != NULL ? 7 : 4;
}

/* \param is_near  NULL: all that may touch obstacles are */
static void mark_near(const dem_model *whole, const unsigned char *is_near, unsigned char *is_common)
{
    const dem_lattice *l = &whole->lattice;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const bool may_touch = whole->obstacles.n > 0 && l->flags[i] & DEM_NODE_CONTACT;
        if (l->flags[i] & DEM_NODE_RIGID || (may_touch && (is_near == NULL || is_near[i]))) is_common[i] = 1;
    }
}

/* \param boundary  of surfaces that may touch each other; NULL: none do. Without obstacles, and what may break, there
 *  are no events, and so no rings. What is not near has none either */
static dem_status find_common(const dem_model *whole, const mesh_boundary *boundary, const unsigned char *is_near,
                              unsigned char *is_common)
{
    const dem_lattice *l = &whole->lattice;
    TRY(breakable_nodes_mark(l, is_common));
    mark_near(whole, is_near, is_common);
    if (boundary != NULL && is_near == NULL) mesh_boundary_mark(boundary, is_common, 1);
    if (whole->obstacles.n > 0 || breakable_lattice(l)) common_nodes_add_rings(l, domain_model_rings(l), is_common);
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

static domain_shares shares_of(const ranks *r, const dem_model *whole, const domain_model_shares *s, ring_use use,
                               const unsigned char *is_common)
{
    const dem_index n = whole->lattice.n_nodes;
    domain_shares shares = {
        .n_ranks = r->size, .owner = s->owner, .is_common = is_common, .n_rings = s->n_rings, .most_ghosts = INT64_MAX};
    if (s->n_rings > 0) return shares;
    const bool is_slack = !whole->layout.stiff && !whole->layout.coupled;
    const ring_room room = is_slack ? use.slack : use.stiff;
    shares.n_rings = n >= room.least_nodes * r->size && may_have_rings(&whole->lattice) ? use.most : 1;
    shares.least_rings = use.least;
    shares.most_ghosts = n / room.part;
    return shares;
}

/* Where no use is known there are rings for steps of Verlet's method, so few that they are no burden to Fehlberg's
 * pair; else those that it has a use for. */
static dem_status find_lists(whole_lattice *w, const ranks *r, const domain_model_shares *s)
{
    enum { PAIR_RINGS = 3, LEAST_STEPS = 4, MOST_STEPS = 8 };
    ring_use both[] = {ring_use_of_steps(LEAST_STEPS, MOST_STEPS), ring_use_of_stages(PAIR_RINGS)};
    const ring_use *uses = s->use.most > 0 ? &s->use : both;
    const int n = s->use.most > 0 ? 1 : 2;
    both[0].slack = both[0].stiff;
    for (int k = 0; k < n && w->lists.rings.n_rings <= 1; k++) {
        domain_lists_free(&w->lists);
        w->shares = shares_of(r, w->model, s, uses[k], w->is_common);
        TRY(domain_lists_create(&w->lists, &w->model->lattice, &w->shares));
    }
    return DEM_OK;
}

static dem_status list_elements(whole_lattice *w)
{
    const dem_lattice *l = &w->model->lattice;
    TRY(node_rows_create(&w->springs, l->ends, 2, l->n_springs, l->n_nodes));
    return node_rows_create(&w->triangles, l->triangles, 3, l->n_triangles, l->n_nodes);
}

static dem_status open_whole(whole_lattice *w, const ranks *r, const dem_model *model,
                             const domain_model_shares *shares)
{
    mesh_boundary boundary = {0};
    *w = (whole_lattice){.model = model};
    TRY(touching_bodies_sum_up(&w->bodies, &model->lattice));
    w->is_common = lattice_zeros(model->lattice.n_nodes, sizeof *w->is_common);
    CHECK_MEMORY(w->is_common);
    if (shares->touching) TRY(mesh_boundary_create(&boundary, &model->lattice, NULL));
    const dem_status status = find_common(model, shares->touching ? &boundary : NULL, shares->is_near, w->is_common);
    mesh_boundary_free(&boundary);
    TRY(status);
    TRY(find_lists(w, r, shares));
    return list_elements(w);
}

/* ---- from the whole that each rank has ---- */

/* Hands the model over if all ranks have theirs. */
static dem_status finish(dem_model **out, const ranks *r, domain_cut *c, dem_status own)
{
    const dem_status status = reduce_status(r, own, 0.0);
    if (status == DEM_OK) {
        c->model->ranks = r;
        *out = c->model;
    }
    domain_cut_close(c, status == DEM_OK);
    return status;
}

/* Each rank cuts its own. */
static dem_status create(domain_cut *c, const ranks *r, const dem_model *model, const domain_model_shares *shares)
{
    whole_lattice w;
    dem_status status = open_whole(&w, r, model, shares);
    if (status == DEM_OK) status = domain_cut_open(c);
    if (status == DEM_OK) status = domain_cut_fill(c, &w, r->rank);
    close_whole(&w);
    TRY(status);
    return domain_compile(c, model->obstacles.list, model->obstacles.n, shares->touching);
}

dem_status domain_model_create(dem_model **out, const ranks *r, const dem_model *whole,
                               const domain_model_shares *shares)
{
    domain_cut c = {0};
    return finish(out, r, &c, create(&c, r, whole, shares));
}

/* ---- from the whole that rank 0 has ---- */

/* What rank 0 has cut for another one ends as soon as it is sent. */
static dem_status send_one(domain_cut *own, const ranks *r, whole_lattice *w, int to)
{
    domain_cut other = {0}, *const c = r->rank == 0 ? &other : own;
    const bool takes_part = r->rank == 0 || r->rank == to;
    dem_status status = takes_part ? domain_cut_open(c) : DEM_OK;
    if (status == DEM_OK && r->rank == 0) status = domain_cut_fill(c, w, to);
    status = reduce_status(r, status, 0.0);
    if (status == DEM_OK) status = domain_message_send(r, to, takes_part ? c : NULL);
    domain_cut_close(&other, false);
    return status;
}

/* One after the other, so that rank 0 has one domain at a time, and its own last. */
static dem_status send_all(domain_cut *own, const ranks *r, whole_lattice *w)
{
    for (int to = 1; to < r->size; to++) TRY(send_one(own, r, w, to));
    if (r->rank > 0) return DEM_OK;
    TRY(domain_cut_open(own));
    return domain_cut_fill(own, w, 0);
}

static dem_status distribute(domain_cut *own, const ranks *r, const dem_model *model, const domain_model_shares *shares)
{
    whole_lattice w = {0};
    dem_status status = r->rank == 0 ? open_whole(&w, r, model, shares) : DEM_OK;
    status = reduce_status(r, status, 0.0);
    if (status == DEM_OK) status = send_all(own, r, &w);
    close_whole(&w);
    return status;
}

dem_status domain_model_distribute(dem_model **out, const ranks *r, const dem_model *whole,
                                   const domain_model_shares *shares, const dem_obstacle *obstacles,
                                   dem_index n_obstacles)
{
    domain_cut c = {0};
    dem_status status = distribute(&c, r, whole, shares);
    if (status == DEM_OK) status = domain_compile(&c, obstacles, n_obstacles, shares->touching);
    return finish(out, r, &c, status);
}
