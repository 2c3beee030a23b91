/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers come first, for the rank that waits to make what has the arrays; then the arrays, and last the lists of nodes
 * that are exchanged with each neighbour. All ranks are the same program on machines of one kind, so that structs are
 * sent as they are; what points anywhere is put in place again. */
#include "model/domain_message.h"

#include <stdlib.h>

#include "base/parcel.h"
#include "base/reduce.h"
#include "base/status.h"
#include "lattice/lattice_arrays.h"

/* The numbers of a cut. */
typedef struct head {
    domain domain;              /* without its arrays */
    dem_index n[LATTICE_ITEMS]; /* of the lattice about it */
    dem_index n_rigid, n_rigid_nodes;
} head;

static head head_of(const domain_cut *c)
{
    const dem_model *m = c->model;
    head h = {.domain = *m->domain,
              .n = {c->around.n_nodes, c->around.n_springs, c->around.n_triangles},
              .n_rigid = m->rigid.n,
              .n_rigid_nodes = m->rigid.n_nodes};
    h.domain.number = h.domain.spring = NULL;
    h.domain.is_own = h.domain.is_ghost = h.domain.is_common = h.domain.is_outer = NULL;
    h.domain.joined = NULL;
    h.domain.neighbours = NULL;
    return h;
}

static dem_status make_parts(dem_model *m, const head *h)
{
    m->domain = calloc(1, sizeof *m->domain);
    m->touching = calloc(1, sizeof *m->touching);
    CHECK(m->domain && m->touching, DEM_ERROR_MEMORY, "out of memory for a domain of %lld nodes",
          (long long)h->domain.n_nodes);
    return DEM_OK;
}

/* There are no neighbours before there is a list of them. */
static void take_head(domain_cut *c, const head *h)
{
    dem_model *m = c->model;
    *m->domain = h->domain;
    m->domain->n_neighbours = 0;
    c->around.n_nodes = h->n[LATTICE_NODES];
    c->around.n_springs = h->n[LATTICE_SPRINGS];
    c->around.n_triangles = h->n[LATTICE_TRIANGLES];
    m->touching->domain = m->domain;
    m->rigid.n = h->n_rigid;
    m->rigid.n_nodes = h->n_rigid_nodes;
}

static dem_status prepare(domain_cut *c, const head *h)
{
    TRY(make_parts(c->model, h));
    take_head(c, h);
    return DEM_OK;
}

static void list_lattice(parcel *p, dem_lattice *l)
{
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        parcel_add(p, (char *)l + a->offset, (size_t)lattice_count(l, a->of) * a->size);
    }
}

static void list_domain(parcel *p, domain *d, const head *h)
{
    const size_t n = (size_t)d->n_nodes;
    parcel_add(p, &d->number, n * sizeof *d->number);
    parcel_add(p, &d->spring, (size_t)h->n[LATTICE_SPRINGS] * sizeof *d->spring);
    parcel_add(p, &d->is_own, n);
    parcel_add(p, &d->is_ghost, n);
    parcel_add(p, &d->is_common, n);
    parcel_add(p, &d->is_outer, n);
    parcel_add(p, &d->joined, n * sizeof *d->joined);
    parcel_add(p, &d->neighbours, (size_t)h->domain.n_neighbours * sizeof *d->neighbours);
}

static void list_rigid(parcel *p, rigid_bodies *r, dem_index n_nodes)
{
    const size_t n = (size_t)r->n_nodes;
    parcel_add(p, &r->list, (size_t)r->n * sizeof *r->list);
    parcel_add(p, &r->of_node, (size_t)n_nodes * sizeof *r->of_node);
    parcel_add(p, &r->nodes, n * sizeof *r->nodes);
    parcel_add(p, &r->masses, n * sizeof *r->masses);
    parcel_add(p, &r->shapes, 2 * n * sizeof *r->shapes);
}

static void list_arrays(parcel *p, domain_cut *c, const head *h)
{
    dem_model *m = c->model;
    const size_t n = (size_t)h->domain.n_nodes;
    list_lattice(p, &c->around);
    list_domain(p, m->domain, h);
    list_rigid(p, &m->rigid, h->domain.n_nodes);
    parcel_add(p, &c->place, n * sizeof *c->place);
    parcel_add(p, &c->triangle, (size_t)h->n[LATTICE_TRIANGLES] * sizeof *c->triangle);
}

static void list_neighbours(parcel *p, domain *d)
{
    for (int k = 0; k < d->n_neighbours; k++) {
        domain_neighbour *one = &d->neighbours[k];
        parcel_add(p, &one->sent, (size_t)one->n_sent * sizeof *one->sent);
        parcel_add(p, &one->received, (size_t)one->n_received * sizeof *one->received);
    }
}

/* On the rank that waits: what points anywhere. */
static void link_parts(dem_model *m, const head *h)
{
    domain *d = m->domain;
    for (int k = 0; k < h->domain.n_neighbours; k++) d->neighbours[k].sent = d->neighbours[k].received = NULL;
    d->n_neighbours = h->domain.n_neighbours;
    rigid_bodies_link(&m->rigid);
}

static dem_status send_arrays(const ranks *r, int to, domain_cut *c, const head *h)
{
    parcel arrays = {0}, neighbours = {0};
    if (c != NULL) list_arrays(&arrays, c, h);
    TRY(parcel_send(r, to, &arrays));
    if (r->rank == to) link_parts(c->model, h);
    if (c != NULL) list_neighbours(&neighbours, c->model->domain);
    return parcel_send(r, to, &neighbours);
}

dem_status domain_message_send(const ranks *r, int to, domain_cut *c)
{
    head h = {0};
    if (r->rank == 0) h = head_of(c);
    parcel_pass(r, to, &h, sizeof h);
    TRY(reduce_status(r, r->rank == to ? prepare(c, &h) : DEM_OK, 0.0));
    return send_arrays(r, to, c, &h);
}
