/* SPDX-License-Identifier: BSD-3-Clause */
/* A domain's model is compiled from the lattice of its nodes, as any other is, but for what depends on more than the
 * neighbours of its own nodes: that is taken from the model of the whole. These are its scales; the boundary, as a side
 * whose other triangle belongs to another rank only is none; and the shares of springs in stresses, as a side opposite
 * to an own node may have its other triangle elsewhere. Orders of nodes, springs and triangles are those of the whole,
 * so that sums over a row have the same bits. A ghost has the inverse mass 0: its row is not complete, and what it does
 * comes from its owner.
 *
 * All ranks have in common
 * - where there are obstacles what may touch them;
 * - where bodies touch each other, or themselves, all nodes of their surfaces, with the boundary of the whole and the
 *   sums over its bodies by which the laws of surfaces are chosen;
 * - rigid bodies, whose motion follows from sums over them;
 * - where there are obstacles what the correction of a step for an event there changes or reads, too
 *   (events/local_correction.c): its rings about the nodes that the event moves, which are among those that may touch,
 *   and the accelerations of the last of these rings. From one surface to another that it touches a ring goes to nodes
 *   that are on surfaces, and begins anew there. */
#include "model/domain_model.h"

#include <stdlib.h>

#include "base/reduce.h"
#include "base/status.h"
#include "domain/common_nodes.h"
#include "lattice/lattice.h"
#include "obstacle/obstacle_set.h"

/* The numbers in the domain of what the whole lattice has; -1: it is not there. */
typedef struct places {
    dem_index *node, *spring, *triangle;
} places;

static void free_places(places *p)
{
    free(p->node);
    free(p->spring);
    free(p->triangle);
}

/* Numbers the tuples of which the domain has all corners, as dem_lattice_select() keeps them. */
static void number_tuples(const dem_index *corner, int arity, dem_index n, const dem_index *node, dem_index *number)
{
    dem_index kept = 0;
    for (dem_index k = 0; k < n; k++) {
        bool is_there = true;
        for (int c = 0; c < arity; c++) is_there = is_there && node[corner[arity * k + c]] >= 0;
        number[k] = is_there ? kept++ : -1;
    }
}

static dem_status find_places(places *p, const domain *d, const dem_lattice *whole)
{
    p->node = lattice_zeros(whole->n_nodes, sizeof *p->node);
    p->spring = lattice_zeros(whole->n_springs, sizeof *p->spring);
    p->triangle = lattice_zeros(whole->n_triangles, sizeof *p->triangle);
    CHECK(p->node && p->spring && p->triangle, DEM_ERROR_MEMORY, "out of memory for a domain of %lld nodes",
          (long long)d->n_nodes);
    for (dem_index i = 0; i < whole->n_nodes; i++) p->node[i] = -1;
    for (dem_index i = 0; i < d->n_nodes; i++) p->node[d->number[i]] = i;
    number_tuples(whole->ends, 2, whole->n_springs, p->node, p->spring);
    number_tuples(whole->triangles, 3, whole->n_triangles, p->node, p->triangle);
    return DEM_OK;
}

static dem_status cut_lattice(dem_model *m, const dem_lattice *whole, const places *p)
{
    m->lattice = dem_lattice_empty();
    TRY(dem_lattice_append(&m->lattice, whole));
    bool *keep = lattice_zeros(whole->n_nodes, sizeof *keep);
    CHECK_MEMORY(keep);
    for (dem_index i = 0; i < whole->n_nodes; i++) keep[i] = p->node[i] >= 0;
    const dem_status status = dem_lattice_select(&m->lattice, keep);
    free(keep);
    return status;
}

/* Leaves of the whole's boundary the sides whose triangles are in the domain. */
static void cut_boundary(mesh_boundary *b, const dem_model *m, const places *p)
{
    dem_index kept = 0;
    for (dem_index k = 0; k < b->n; k++) {
        const mesh_boundary_edge *e = &b->list[k];
        if (p->triangle[e->triangle] < 0) continue;
        b->list[kept++] = (mesh_boundary_edge){p->node[e->lower], p->node[e->upper], p->triangle[e->triangle]};
    }
    b->n = kept;
    b->lattice = &m->lattice;
    free(b->outer); /* of nodes of the whole */
    b->outer = NULL;
}

/* Those of the whole so far. The model has them from the start, so that they end with it. */
static dem_status find_touching(dem_model *m, const dem_lattice *whole)
{
    m->touching = calloc(1, sizeof *m->touching);
    CHECK_MEMORY(m->touching);
    return touching_bodies_create(m->touching, whole);
}

/* Where bodies touch each other the boundary is kept, with their sums: it has all sides then. */
static dem_status cut_surface(dem_model *m, const places *p, bool touching)
{
    touching_bodies *bodies = m->touching;
    cut_boundary(&bodies->boundary, m, p);
    bodies->domain = m->domain;
    TRY(surface_compile_boundary(&m->surface, &m->lattice, &bodies->boundary, SURFACE_TOUCHING));
    if (touching) return DEM_OK;
    touching_bodies_free(bodies);
    free(bodies);
    m->touching = NULL;
    return DEM_OK;
}

/* The rows of own nodes; those of ghosts are empty. */
static dem_status cut_stress(dem_model *m, const stress_map *whole, const places *p)
{
    const domain *d = m->domain;
    const stress_rows *from = whole->rows;
    dem_index n = 0;
    TRY(stress_prepare(whole));
    for (dem_index i = 0; i < d->n_nodes; i++)
        if (d->is_own[i]) n += from->row[d->number[i] + 1] - from->row[d->number[i]];
    TRY(stress_create(&m->stress, d->n_nodes, n, &m->couplings));
    stress_rows *to = m->stress.rows;
    n = 0;
    for (dem_index i = 0; i < d->n_nodes; i++) {
        const dem_index of = d->number[i];
        m->stress.volume[i] = whole->volume[of];
        for (dem_index q = from->row[of]; d->is_own[i] && q < from->row[of + 1]; q++) {
            to->spring[n] = (int32_t)p->spring[from->spring[q]];
            to->share[n++] = from->share[q];
        }
        to->row[i + 1] = (int32_t)n;
    }
    return DEM_OK;
}

static dem_status cut_nodes(dem_model *m, const dem_model *whole)
{
    const domain *d = m->domain;
    m->inverse_mass = lattice_zeros(d->n_nodes, sizeof *m->inverse_mass);
    CHECK_MEMORY(m->inverse_mass);
    for (dem_index i = 0; i < d->n_nodes; i++)
        m->inverse_mass[i] = d->is_ghost[i] ? 0.0 : whole->inverse_mass[d->number[i]];
    return DEM_OK;
}

/* The numbers of springs in the whole lattice. */
static dem_status list_springs(dem_model *m, const dem_lattice *whole, const places *p)
{
    domain *d = m->domain;
    d->spring = malloc(((size_t)m->lattice.n_springs + 1) * sizeof *d->spring);
    CHECK_MEMORY(d->spring);
    for (dem_index k = 0; k < whole->n_springs; k++)
        if (p->spring[k] >= 0) d->spring[p->spring[k]] = k;
    return DEM_OK;
}

/* Nodes stand in the order of the whole's layout, so that all ranks and a process alone see an element from the same of
 * its nodes, the lowest in this order: areas have other bits from another corner. */
static dem_status cut_layout(dem_model *m, const layout *whole, const places *p)
{
    const domain *d = m->domain;
    int32_t *order = NULL;
    dem_index n = 0;
    if (whole->order != NULL) {
        order = malloc((size_t)d->n_nodes * sizeof *order);
        CHECK_MEMORY(order);
        for (dem_index q = 0; q < d->n_whole; q++)
            if (p->node[whole->order[q]] >= 0) order[n++] = (int32_t)p->node[whole->order[q]];
    }
    const dem_status status = layout_compile_part(&m->layout, &m->springs, &m->triangles, &m->couplings, order);
    free(order);
    return status;
}

static void take_scales(dem_model *m, const dem_model *whole)
{
    m->domain->n_springs = whole->lattice.n_springs;
    m->domain->n_triangles = whole->lattice.n_triangles;
    m->domain->n_surface_nodes = whole->surface.n_nodes;
    m->domain->n_surface_edges = whole->surface.n_edges;
    m->edges_are_springs = whole->edges_are_springs;
    m->n_bodies = whole->n_bodies;
    m->spacing = whole->spacing;
    m->omega_max = whole->omega_max;
    m->mass = whole->mass;
}

static dem_status cut(dem_model *m, const dem_model *whole, const places *p, bool touching)
{
    TRY(cut_lattice(m, &whole->lattice, p));
    TRY(springs_compile(&m->springs, &m->lattice));
    TRY(csr_view_create(&m->csr, &m->springs));
    TRY(triangles_compile(&m->triangles, &m->lattice));
    TRY(couplings_compile(&m->couplings, &m->lattice, &m->springs));
    TRY(list_springs(m, &whole->lattice, p));
    TRY(cut_layout(m, &whole->layout, p));
    TRY(cut_surface(m, p, touching));
    TRY(rigid_bodies_cut(&m->rigid, &whole->rigid, p->node, m->lattice.n_nodes));
    TRY(cut_stress(m, &whole->stress, p));
    TRY(cut_nodes(m, whole));
    TRY(obstacles_compile(&m->obstacles, whole->obstacles.list, whole->obstacles.n));
    take_scales(m, whole);
    return DEM_OK;
}

int domain_model_rings(const dem_lattice *lattice)
{
    return lattice->viscosity != NULL ? 7 : 4;
}

/* \param boundary  of surfaces that may touch each other; NULL: none do. Without obstacles there are no events, and so
 *  no rings */
static void find_common(const dem_model *whole, const mesh_boundary *boundary, unsigned char *is_common)
{
    const dem_lattice *l = &whole->lattice;
    const bool has_events = whole->obstacles.n > 0;
    for (dem_index i = 0; i < l->n_nodes; i++)
        is_common[i] = (has_events && l->flags[i] & DEM_NODE_CONTACT) || l->flags[i] & DEM_NODE_RIGID;
    if (boundary != NULL) mesh_boundary_mark(boundary, is_common, 1);
    if (has_events) common_nodes_add_rings(l, domain_model_rings(l), is_common);
}

static dem_status create_domain(dem_model *m, const dem_model *whole, const domain_model_shares *s)
{
    m->domain = calloc(1, sizeof *m->domain);
    CHECK_MEMORY(m->domain);
    unsigned char *is_common = lattice_zeros(whole->lattice.n_nodes, sizeof *is_common);
    CHECK_MEMORY(is_common);
    find_common(whole, s->touching ? &m->touching->boundary : NULL, is_common);
    const domain_shares shares = {m->ranks->size, s->owner, is_common};
    const dem_status status = domain_create(m->domain, &whole->lattice, &shares, m->ranks->rank);
    free(is_common);
    return status;
}

static dem_status create(dem_model *m, const dem_model *whole, const domain_model_shares *s)
{
    places p = {0};
    TRY(find_touching(m, &whole->lattice));
    TRY(create_domain(m, whole, s));
    dem_status status = find_places(&p, m->domain, &whole->lattice);
    if (status == DEM_OK) status = cut(m, whole, &p, s->touching);
    free_places(&p);
    return status;
}

/* What ranks cannot share yet. A motion that the program computes may differ from rank to rank. */
static dem_status check(const ranks *r, const dem_model *whole)
{
    const dem_lattice *l = &whole->lattice;
    CHECK(!whole->obstacles.is_asked, DEM_ERROR_MODEL,
          "%d ranks cannot share a model with obstacles whose motion a function computes yet", r->size);
    CHECK(l->strength == NULL && l->critical_stretch == NULL && l->compressive_strength == NULL, DEM_ERROR_MODEL,
          "%d ranks cannot share a model that may break yet", r->size);
    return DEM_OK;
}

dem_status domain_model_create(dem_model **out, const ranks *r, const dem_model *whole,
                               const domain_model_shares *shares)
{
    TRY(reduce_status(r, check(r, whole), 0.0));
    dem_model *m = calloc(1, sizeof *m);
    CHECK_MEMORY(m);
    m->ranks = r;
    const dem_status status = reduce_status(r, create(m, whole, shares), 0.0);
    if (status == DEM_OK)
        *out = m;
    else
        dem_model_destroy(m);
    return status;
}
