/* SPDX-License-Identifier: BSD-3-Clause */
/* A domain's model is compiled from the lattice of its nodes, as any other is, but for what depends on more than the
 * neighbours of its own nodes: that is taken from the model of the whole. These are its scales; the boundary, as a side
 * whose other triangle belongs to another rank only is none; and the shares of springs in stresses, as a side opposite
 * to an own node may have its other triangle elsewhere. Orders of nodes, springs and triangles are those of the whole,
 * so that sums over a row have the same bits. A ghost of the last ring has the inverse mass 0, as its row is not
 * complete. What ghosts do comes from their owners, but several rings of them can be integrated here through a step.
 * All that is taken from the whole, with the lattice, is the cut of a domain, which may be made on rank 0 and sent
 * (model/domain_message.h); the rest is compiled from it alone.
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
#include <string.h>

#include "base/reduce.h"
#include "base/sorted.h"
#include "base/status.h"
#include "domain/common_nodes.h"
#include "lattice/lattice.h"
#include "lattice/lattice_cut.h"
#include "lattice/node_rows.h"
#include "model/breakable_nodes.h"
#include "model/domain_message.h"
#include "obstacle/obstacle_set.h"

/* ---- what is found of the whole once ---- */

typedef struct whole_lattice {
    const dem_model *model;
    touching_bodies bodies;
    unsigned char *is_common; /* [n_nodes] */
    domain_shares shares;
    domain_lists lists;           /* of the nodes of all ranks */
    node_rows springs, triangles; /* at each node */
    int32_t *place;               /* [n_nodes] of each node in the layout; NULL: its number */
} whole_lattice;

static void close_whole(whole_lattice *w)
{
    touching_bodies_free(&w->bodies);
    domain_lists_free(&w->lists);
    node_rows_free(&w->springs);
    node_rows_free(&w->triangles);
    free(w->place);
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
    shares.n_rings = n >= use.least_nodes * r->size && may_have_rings(&whole->lattice) ? use.most : 1;
    shares.least_rings = use.least;
    shares.most_ghosts = n / use.part;
    return shares;
}

/* Where no use is known there are rings for steps of Verlet's method, so few that they are no burden to Fehlberg's
 * pair; else those that it has a use for. */
static dem_status find_lists(whole_lattice *w, const ranks *r, const domain_model_shares *s)
{
    enum { PAIR_RINGS = 3, LEAST_STEPS = 4, MOST_STEPS = 8 };
    const ring_use both[] = {ring_use_of_steps(LEAST_STEPS, MOST_STEPS), ring_use_of_stages(PAIR_RINGS)};
    const ring_use *uses = s->use.most > 0 ? &s->use : both;
    const int n = s->use.most > 0 ? 1 : 2;
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

static dem_status find_order(whole_lattice *w)
{
    const layout *l = &w->model->layout;
    if (l->order == NULL) return DEM_OK;
    w->place = malloc((size_t)l->n_nodes * sizeof *w->place);
    CHECK_MEMORY(w->place);
    for (dem_index q = 0; q < l->n_nodes; q++) w->place[l->order[q]] = (int32_t)q;
    return DEM_OK;
}

static dem_status open_whole(whole_lattice *w, const ranks *r, const dem_model *model,
                             const domain_model_shares *shares)
{
    *w = (whole_lattice){.model = model};
    TRY(touching_bodies_create(&w->bodies, &model->lattice));
    w->is_common = lattice_zeros(model->lattice.n_nodes, sizeof *w->is_common);
    CHECK_MEMORY(w->is_common);
    TRY(find_common(model, shares->touching ? &w->bodies.boundary : NULL, shares->is_near, w->is_common));
    TRY(find_lists(w, r, shares));
    TRY(list_elements(w));
    return find_order(w);
}

/* ---- what is cut ---- */

/* Which of the whole lattice is in the domain, whose lists of springs and triangles these are. */
typedef struct places {
    const dem_index *node; /* [nodes of the whole] their numbers in the domain; -1: not there */
    dem_index n_springs, n_triangles;
    dem_index *spring, *triangle; /* [n] that are there, by their numbers in the whole, ascending */
} places;

/* Springs or triangles of the whole lattice. */
typedef struct tuples {
    const node_rows *rows; /* at each node */
    int arity;
    const dem_index *node; /* [n][arity] */
} tuples;

/* Lists those of which the domain has all nodes, each at the first of them, or without a list only counts them. */
static dem_index list_tuples(const tuples *t, const domain *d, const dem_index *local, dem_index *list)
{
    dem_index n = 0;
    for (dem_index i = 0; i < d->n_nodes; i++)
        for (dem_index p = t->rows->row[d->number[i]]; p < t->rows->row[d->number[i] + 1]; p++) {
            const dem_index *node = t->node + t->arity * t->rows->list[p];
            bool is_there = true;
            for (int c = 0; c < t->arity; c++) is_there = is_there && local[node[c]] >= i;
            if (is_there && list != NULL) list[n] = t->rows->list[p];
            n += is_there;
        }
    return n;
}

static dem_status find_tuples(dem_index **list, dem_index *n, const tuples *t, const domain *d, const dem_index *local)
{
    *n = list_tuples(t, d, local, NULL);
    *list = malloc(((size_t)*n + 1) * sizeof **list);
    CHECK(*list, DEM_ERROR_MEMORY, "out of memory for a domain of %lld nodes", (long long)d->n_nodes);
    (void)list_tuples(t, d, local, *list);
    (void)sorted_make(*list, *n);
    return DEM_OK;
}

static dem_status find_places(places *p, domain *d, const whole_lattice *w)
{
    const dem_lattice *l = &w->model->lattice;
    p->node = w->lists.local;
    TRY(find_tuples(&d->spring, &p->n_springs, &(tuples){&w->springs, 2, l->ends}, d, p->node));
    p->spring = d->spring;
    TRY(find_tuples(&d->triangle, &p->n_triangles, &(tuples){&w->triangles, 3, l->triangles}, d, p->node));
    p->triangle = d->triangle;
    return DEM_OK;
}

static dem_index spring_of(const places *p, dem_index number)
{
    return sorted_find(p->spring, p->n_springs, number);
}

static dem_index triangle_of(const places *p, dem_index number)
{
    return sorted_find(p->triangle, p->n_triangles, number);
}

static dem_status cut_lattice(dem_model *m, const dem_lattice *whole, const places *p)
{
    const lattice_cut list = {.n = {m->domain->n_nodes, p->n_springs, p->n_triangles},
                              .numbers = {m->domain->number, p->spring, p->triangle},
                              .node = p->node};
    return lattice_cut_create(&m->lattice, whole, &list);
}

/* The sides of the whole's boundary whose triangles are in the domain.  \return how many there are */
static dem_index cut_boundary(const mesh_boundary *whole, const places *p, mesh_boundary_edge *list)
{
    dem_index n = 0;
    for (dem_index k = 0; k < whole->n; k++) {
        const mesh_boundary_edge *e = &whole->list[k];
        const dem_index triangle = triangle_of(p, e->triangle);
        if (triangle < 0) continue;
        if (list != NULL) list[n] = (mesh_boundary_edge){p->node[e->lower], p->node[e->upper], triangle};
        n++;
    }
    return n;
}

/* The model has them from the start, so that they end with it. Where bodies touch each other the boundary has all sides
 * of the whole. */
static dem_status cut_touching(dem_model *m, const touching_bodies *whole, const places *p)
{
    touching_bodies *o = m->touching = calloc(1, sizeof *o);
    CHECK_MEMORY(o);
    o->domain = m->domain;
    o->n_bodies = whole->n_bodies;
    o->boundary.lattice = &m->lattice;
    o->boundary.n = cut_boundary(&whole->boundary, p, NULL);
    o->boundary.list = malloc(((size_t)o->boundary.n + 1) * sizeof *o->boundary.list);
    o->boundary.outer = malloc((size_t)m->domain->n_nodes);
    o->bodies = malloc(((size_t)o->n_bodies + 1) * sizeof *o->bodies);
    CHECK(o->boundary.list && o->boundary.outer && o->bodies, DEM_ERROR_MEMORY, "out of memory for %lld boundary edges",
          (long long)o->boundary.n);
    (void)cut_boundary(&whole->boundary, p, o->boundary.list);
    for (dem_index i = 0; i < m->domain->n_nodes; i++)
        o->boundary.outer[i] = whole->boundary.outer[m->domain->number[i]];
    memcpy(o->bodies, whole->bodies, (size_t)o->n_bodies * sizeof *o->bodies);
    return DEM_OK;
}

/* The rows of nodes that are integrated, of which common ones may decide what breaks; those of ghosts are empty. */
static dem_status cut_stress(dem_model *m, const stress_map *whole, const places *p)
{
    const domain *d = m->domain;
    const stress_rows *from = whole->rows;
    dem_index n = 0;
    TRY(stress_prepare(whole));
    for (dem_index i = 0; i < d->n_nodes; i++)
        if (!d->is_ghost[i]) n += from->row[d->number[i] + 1] - from->row[d->number[i]];
    TRY(stress_create(&m->stress, d->n_nodes, n, &m->couplings));
    stress_rows *to = m->stress.rows;
    n = 0;
    for (dem_index i = 0; i < d->n_nodes; i++) {
        const dem_index of = d->number[i];
        m->stress.volume[i] = whole->volume[of];
        for (dem_index q = from->row[of]; !d->is_ghost[i] && q < from->row[of + 1]; q++) {
            to->spring[n] = (int32_t)spring_of(p, from->spring[q]);
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
        m->inverse_mass[i] = d->is_outer[i] ? 0.0 : whole->inverse_mass[d->number[i]];
    return DEM_OK;
}

/* A node of the domain, and where the whole's layout has it. */
typedef struct placed {
    int32_t place, node;
} placed;

static int by_place(const void *a, const void *b)
{
    const placed *p = a, *q = b;
    return (p->place > q->place) - (p->place < q->place);
}

/* Nodes stand in the order of the whole's layout, so that all ranks and a process alone see an element from the same of
 * its nodes, the lowest in this order: areas have other bits from another corner. */
static dem_status cut_order(domain_cut *c, const whole_lattice *w)
{
    const domain *d = c->model->domain;
    const size_t n = (size_t)d->n_nodes;
    if (w->place == NULL) return DEM_OK;
    placed *list = malloc(n * sizeof *list);
    c->order = malloc(n * sizeof *c->order);
    if (list != NULL && c->order != NULL) {
        for (dem_index i = 0; i < d->n_nodes; i++) list[i] = (placed){w->place[d->number[i]], (int32_t)i};
        qsort(list, n, sizeof *list, by_place);
        for (size_t q = 0; q < n; q++) c->order[q] = list[q].node;
    }
    free(list);
    CHECK_MEMORY(list != NULL ? c->order : NULL);
    return DEM_OK;
}

static void take_scales(dem_model *m, const dem_model *whole)
{
    m->domain->n_springs = whole->lattice.n_springs;
    m->domain->n_triangles = whole->lattice.n_triangles;
    m->domain->n_surface_nodes = whole->surface.n_nodes;
    m->edges_are_springs = whole->edges_are_springs;
    m->n_bodies = whole->n_bodies;
    m->spacing = whole->spacing;
    m->omega_max = whole->omega_max;
    m->mass = whole->mass;
}

static dem_status cut_parts(domain_cut *c, const whole_lattice *w, const places *p)
{
    dem_model *m = c->model;
    const dem_model *whole = w->model;
    TRY(cut_lattice(m, &whole->lattice, p));
    TRY(cut_order(c, w));
    TRY(cut_touching(m, &w->bodies, p));
    TRY(rigid_bodies_cut(&m->rigid, &whole->rigid, p->node, m->lattice.n_nodes));
    TRY(cut_stress(m, &whole->stress, p));
    TRY(cut_nodes(m, whole));
    take_scales(m, whole);
    return DEM_OK;
}

static dem_status cut_placed(domain_cut *c, const whole_lattice *w)
{
    places p = {0};
    TRY(find_places(&p, c->model->domain, w));
    return cut_parts(c, w, &p);
}

/* For a rank, which need not be this one. */
static dem_status cut(domain_cut *c, whole_lattice *w, int rank)
{
    dem_model *m = c->model;
    m->domain = calloc(1, sizeof *m->domain);
    CHECK_MEMORY(m->domain);
    TRY(domain_create_within(m->domain, &w->lists, rank));
    domain_lists_number(&w->lists, m->domain->number, m->domain->n_nodes);
    const dem_status status = cut_placed(c, w);
    domain_lists_forget(&w->lists, m->domain->number, m->domain->n_nodes);
    return status;
}

static dem_status open_cut(domain_cut *c)
{
    c->order = NULL;
    c->model = calloc(1, sizeof *c->model);
    CHECK_MEMORY(c->model);
    return DEM_OK;
}

/* Ends what has been cut, but for the model, where that is wanted. */
static void close_cut(domain_cut *c, bool keeps_model)
{
    free(c->order);
    if (!keeps_model) dem_model_destroy(c->model);
}

/* ---- what is compiled of it ---- */

/* The boundary is kept where bodies touch each other, and where something may break. */
static dem_status compile_surface(dem_model *m, bool touching)
{
    m->touching->has_all = touching;
    TRY(surface_compile_boundary(&m->surface, &m->lattice, &m->touching->boundary, SURFACE_TOUCHING));
    if (touching || breakable_lattice(&m->lattice)) return DEM_OK;
    touching_bodies_free(m->touching);
    free(m->touching);
    m->touching = NULL;
    return DEM_OK;
}

static dem_status compile(const domain_cut *c, const dem_obstacle *obstacles, dem_index n_obstacles, bool touching)
{
    dem_model *m = c->model;
    TRY(springs_compile(&m->springs, &m->lattice));
    TRY(csr_view_create(&m->csr, &m->springs));
    TRY(triangles_compile(&m->triangles, &m->lattice));
    TRY(couplings_compile(&m->couplings, &m->lattice, &m->springs));
    TRY(layout_compile_part(&m->layout, &m->springs, &m->triangles, &m->couplings, c->order));
    TRY(compile_surface(m, touching));
    return obstacles_compile(&m->obstacles, obstacles, n_obstacles);
}

/* Hands the model over if all ranks have theirs. */
static dem_status finish(dem_model **out, const ranks *r, domain_cut *c, dem_status own)
{
    const dem_status status = reduce_status(r, own, 0.0);
    if (status == DEM_OK) {
        c->model->ranks = r;
        *out = c->model;
    }
    close_cut(c, status == DEM_OK);
    return status;
}

/* Each rank cuts its own. */
static dem_status create(domain_cut *c, const ranks *r, const dem_model *model, const domain_model_shares *shares)
{
    whole_lattice w;
    dem_status status = open_whole(&w, r, model, shares);
    if (status == DEM_OK) status = open_cut(c);
    if (status == DEM_OK) status = cut(c, &w, r->rank);
    close_whole(&w);
    TRY(status);
    return compile(c, model->obstacles.list, model->obstacles.n, shares->touching);
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
    dem_status status = takes_part ? open_cut(c) : DEM_OK;
    if (status == DEM_OK && r->rank == 0) status = cut(c, w, to);
    status = reduce_status(r, status, 0.0);
    if (status == DEM_OK) status = domain_message_send(r, to, takes_part ? c : NULL);
    close_cut(&other, false);
    return status;
}

/* One after the other, so that rank 0 has one domain at a time, and its own last. */
static dem_status send_all(domain_cut *own, const ranks *r, whole_lattice *w)
{
    for (int to = 1; to < r->size; to++) TRY(send_one(own, r, w, to));
    if (r->rank > 0) return DEM_OK;
    TRY(open_cut(own));
    return cut(own, w, 0);
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
    if (status == DEM_OK) status = compile(&c, obstacles, n_obstacles, shares->touching);
    return finish(out, r, &c, status);
}
