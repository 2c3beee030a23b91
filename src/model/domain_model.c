/* SPDX-License-Identifier: BSD-3-Clause */
/* A domain's model is compiled from the lattice of its nodes, as any other is, but for what depends on more than the
 * neighbours of its own nodes. The boundary, as a side whose other triangle belongs to another rank only is none, and
 * the shares of springs in stresses, as a side opposite to an own node may have its other triangle elsewhere, follow
 * from a lattice with the triangles beside the domain; scales are joined of what each rank finds of its own nodes
 * (model/model_scales.c). Orders of nodes, springs and triangles are those of the whole, so that sums over a row have
 * the same bits. A ghost of the last ring has the inverse mass 0, as its row is not complete. What ghosts do comes from
 * their owners, but several rings of them can be integrated here through a step. All that is taken from the whole is
 * the cut of a domain (model/domain_cut.h), which may be made on rank 0 and sent; the rest is compiled from it alone.
 *
 * All ranks have in common
 * - where there are obstacles what may touch them;
 * - where bodies touch each other, or themselves, all nodes of their surfaces, with the boundary of the whole and the
 *   sums over its bodies by which the laws of surfaces are chosen;
 * - rigid bodies, whose motion follows from sums over them;
 * - nodes of elements that may break, and what is next to these: which break, in which order, and what comes of it,
 *   surfaces too, each rank finds by itself, and fragments with what springs that cannot break join for good;
 * - where there are obstacles, or something may break, what the correction of a step for an event changes or
 *   reads, too (events/local_correction.c): its rings about the nodes that the event moves, which are among those that
 *   may touch or break, and the accelerations of the last of these rings. From one surface to another that it touches a
 *   ring goes to nodes that are on surfaces, and begins anew there. Who can do without some events has rings only where
 *   others may happen soon. */
#include "model/domain_model.h"

#include <stdlib.h>

#include "base/freed_memory.h"
#include "base/reduce.h"
#include "base/status.h"
#include "domain/region.h"
#include "model/domain_compile.h"
#include "model/domain_message.h"
#include "model/slab_lattice.h"

/* ---- from the whole that each rank has ---- */

static dem_index count_own_surface(const dem_model *m)
{
    dem_index n = 0;
    for (dem_index k = 0; k < m->surface.n_nodes; k++) n += domain_owns(m->domain, m->surface.nodes[k]);
    return n;
}

/* What is joined of the domains of all ranks. */
static dem_status join(dem_model *m, const ranks *r, const double *given)
{
    m->ranks = r;
    m->domain->n_surface_nodes = reduce_count(r, count_own_surface(m));
    TRY(model_find_scales(m, given));
    return m->touching != NULL ? touching_bodies_sum_up(m->touching, r, &m->lattice, m->n_bodies) : DEM_OK;
}

/* Hands the model over if all ranks have theirs. */
static dem_status finish(dem_model **out, const ranks *r, domain_cut *c, dem_status own)
{
    dem_status status = reduce_status(r, own, 0.0);
    if (status == DEM_OK) status = join(c->model, r, c->given);
    if (status == DEM_OK) *out = c->model;
    domain_cut_close(c, status == DEM_OK);
    return status;
}

/* Each rank cuts its own. */
static dem_status create(domain_cut *c, const ranks *r, const dem_model *model, const domain_model_shares *shares)
{
    const whole_parts of = whole_parts_of(model);
    whole_lattice w;
    dem_status status = whole_lattice_open(&w, &of, r->size, shares);
    if (status == DEM_OK) status = domain_cut_open(c);
    if (status == DEM_OK) status = domain_cut_fill(c, &w, r->rank);
    whole_lattice_close(&w);
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

static dem_status open_at_0(whole_lattice *w, const ranks *r, const dem_model *model, const domain_model_shares *shares)
{
    if (r->rank > 0) return DEM_OK;
    const whole_parts of = whole_parts_of(model);
    return whole_lattice_open(w, &of, r->size, shares);
}

static dem_status distribute(domain_cut *own, const ranks *r, const dem_model *model, const domain_model_shares *shares)
{
    whole_lattice w = {0};
    dem_status status = open_at_0(&w, r, model, shares);
    status = reduce_status(r, status, 0.0);
    if (status == DEM_OK) status = send_all(own, r, &w);
    whole_lattice_close(&w);
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

/* ---- from slabs of the whole, of which each rank has one ---- */

/* What there is of the whole for this rank. */
typedef struct surroundings {
    region region;
    int32_t *owner; /* [nodes of the region] */
} surroundings;

static dem_status list_owners(surroundings *g, const slab_rows *rows)
{
    const dem_index n = g->region.lattice.n_nodes;
    g->owner = malloc((size_t)n * sizeof *g->owner);
    CHECK_MEMORY(g->owner);
    for (dem_index i = 0; i < n; i++) g->owner[i] = (int32_t)slab_rows_owner(rows, g->region.number[LATTICE_NODES][i]);
    return DEM_OK;
}

static region_extent extent_of(const whole_parts *of, const ranks *r, const domain_model_shares *shares,
                               const unsigned char *is_common)
{
    return (region_extent){.is_common = is_common,
                           .common_rings = of->has_obstacles ? whole_lattice_rings(of->lattice) : 0,
                           .rings = whole_lattice_most_rings(of, r->size, shares) + 1};
}

/* Rows end, as nobody asks for any more of them. */
static dem_status gather(surroundings *g, slab_rows *rows, const whole_parts *of, const domain_model_shares *shares)
{
    unsigned char *marks;
    *g = (surroundings){.region.lattice = dem_lattice_empty()};
    dem_status status = slab_lattice_mark_common(&marks, of->lattice, of->has_obstacles, shares->touching);
    status = reduce_status(rows->ranks, status, 0.0);
    const region_extent extent = extent_of(of, rows->ranks, shares, marks);
    if (status == DEM_OK) status = region_create(&g->region, rows, &extent);
    if (status == DEM_OK) status = list_owners(g, rows);
    slab_rows_free(rows);
    free(marks);
    return status;
}

/* It is as a whole lattice for this rank; what is found there of other ranks' ghosts need not be all. */
static dem_status cut_region(domain_cut *c, const ranks *r, const whole_parts *of, const domain_model_shares *shares,
                             dem_lattice *lattice)
{
    whole_lattice w = {0};
    dem_status status = whole_lattice_open(&w, of, r->size, shares);
    if (status == DEM_OK) status = domain_cut_open(c);
    if (status == DEM_OK) status = domain_cut_take(c, &w, r->rank, lattice);
    whole_lattice_close(&w);
    return status;
}

static dem_status cut_slabs(domain_cut *c, slab_rows *rows, domain_model_shares shares, bool has_obstacles)
{
    const rigid_bodies none = {0};
    const ranks *r = rows->ranks;
    whole_parts of = {.lattice = rows->lattice,
                      .rigid = &none,
                      .n = {rows->n[LATTICE_NODES], rows->n[LATTICE_SPRINGS], rows->n[LATTICE_TRIANGLES]},
                      .has_obstacles = has_obstacles,
                      .is_slack = whole_lattice_is_slack(rows->lattice),
                      .counting = r};
    surroundings g;
    dem_status status = gather(&g, rows, &of, &shares);
    dem_lattice *l = &g.region.lattice;
    of.lattice = l;
    of.is_common = g.region.is_common;
    for (int k = 0; k < LATTICE_ITEMS; k++) of.number[k] = g.region.number[k];
    shares.owner = g.owner;
    if (status == DEM_OK) status = cut_region(c, r, &of, &shares, l);
    region_free(&g.region);
    free(g.owner);
    return status;
}

dem_status domain_model_gather(dem_model **out, slab_rows *rows, const domain_model_shares *shares,
                               const dem_obstacle *obstacles, dem_index n_obstacles)
{
    const ranks *r = rows->ranks;
    domain_cut c = {0};
    dem_status status = cut_slabs(&c, rows, *shares, n_obstacles > 0);
    freed_memory_return(c.around.n_nodes);
    if (status == DEM_OK) status = domain_compile(&c, obstacles, n_obstacles, shares->touching);
    return finish(out, r, &c, status);
}
