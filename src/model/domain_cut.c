/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/domain_cut.h"

#include <stdlib.h>

#include "base/sorted.h"
#include "base/status.h"
#include "lattice/lattice_cut.h"

/* ---- springs and triangles ---- */

/* Springs or triangles of the whole lattice. */
typedef struct tuples {
    const node_rows *rows; /* at each node */
    int arity;
    const dem_index *node; /* [n][arity] */
    bool entire;           /* whether all of their nodes have to be in the domain, or any */
} tuples;

/* Lists those at the nodes of a domain, each at the first of them, or without a list only counts them. */
static dem_index list_tuples(const tuples *t, const domain *d, const dem_index *local, dem_index *list)
{
    dem_index n = 0;
    for (dem_index i = 0; i < d->n_nodes; i++)
        for (dem_index p = t->rows->row[d->number[i]]; p < t->rows->row[d->number[i] + 1]; p++) {
            const dem_index *node = t->node + t->arity * t->rows->list[p];
            bool is_first = true;
            for (int c = 0; c < t->arity; c++)
                is_first = is_first && (local[node[c]] >= i || (local[node[c]] < 0 && !t->entire));
            if (is_first && list != NULL) list[n] = t->rows->list[p];
            n += is_first;
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

/* ---- nodes ---- */

/* The lattice about a domain, by numbers of the whole. */
typedef struct draft {
    dem_index n[LATTICE_ITEMS];
    dem_index *node;     /* [n] ascending, as those of springs and triangles in the cut */
    dem_lattice *arrays; /* which become those of the cut; NULL: they are copied */
} draft;

/* The corners of triangles that are not in the domain, ascending: each is marked when it is met first. */
static dem_index list_corners(const domain_cut *c, const draft *s, const dem_lattice *whole, dem_index *local,
                              dem_index *list)
{
    dem_index n = 0;
    for (dem_index k = 0; k < 3 * s->n[LATTICE_TRIANGLES]; k++) {
        const dem_index node = whole->triangles[3 * c->triangle[k / 3] + k % 3];
        if (local[node] >= 0) continue;
        local[node] = 0;
        list[n++] = node;
    }
    return sorted_make(list, n);
}

/* In the domain and beside it. Afterwards `local` has their numbers. */
static dem_status find_nodes(draft *s, const domain_cut *c, whole_lattice *w)
{
    const domain *d = c->model->domain;
    const size_t most = 3 * (size_t)s->n[LATTICE_TRIANGLES] + 1;
    dem_index *beside = malloc(most * sizeof *beside), n_beside = 0;
    if (beside != NULL) n_beside = list_corners(c, s, w->of.lattice, w->lists.local, beside);
    s->node = malloc(((size_t)(d->n_nodes + n_beside) + 1) * sizeof *s->node);
    if (beside != NULL && s->node != NULL)
        s->n[LATTICE_NODES] = sorted_merge(s->node, d->number, d->n_nodes, beside, n_beside);
    free(beside);
    CHECK(s->n[LATTICE_NODES] > 0, DEM_ERROR_MEMORY, "out of memory for a domain of %lld nodes", (long long)d->n_nodes);
    domain_lists_number(&w->lists, s->node, s->n[LATTICE_NODES]);
    return DEM_OK;
}

/* Without positions that are those at rest. */
static dem_status copy_lattice(dem_lattice *out, const dem_lattice *whole, const lattice_cut *list)
{
    dem_lattice from = *whole;
    if (from.position == from.x) from.position = NULL;
    return lattice_cut_create(out, &from, list);
}

static dem_status cut_lattice(domain_cut *c, const draft *s, const whole_lattice *w)
{
    const domain *d = c->model->domain;
    const lattice_cut list = {.n = {s->n[LATTICE_NODES], s->n[LATTICE_SPRINGS], s->n[LATTICE_TRIANGLES]},
                              .numbers = {s->node, d->spring, c->triangle},
                              .node = w->lists.local};
    c->place = malloc((size_t)d->n_nodes * sizeof *c->place);
    CHECK_MEMORY(c->place);
    for (dem_index i = 0; i < d->n_nodes; i++) c->place[i] = w->lists.local[d->number[i]];
    if (s->arrays == NULL) return copy_lattice(&c->around, w->of.lattice, &list);
    lattice_cut_shrink(s->arrays, &list);
    c->around = *s->arrays;
    *s->arrays = dem_lattice_empty();
    return DEM_OK;
}

/* ---- public ---- */

dem_status domain_cut_open(domain_cut *out)
{
    *out = (domain_cut){.model = calloc(1, sizeof *out->model), .around = dem_lattice_empty()};
    CHECK_MEMORY(out->model);
    return DEM_OK;
}

void domain_cut_close(domain_cut *c, bool keeps_model)
{
    if (c->model == NULL) return;
    dem_lattice_free(&c->around);
    free(c->place);
    free(c->triangle);
    free(c->given);
    if (!keeps_model) dem_model_destroy(c->model);
    *c = (domain_cut){0};
}

static dem_status copy_joined(domain *d, const whole_lattice *w)
{
    if (w->joined == NULL) return DEM_OK;
    d->joined = malloc((size_t)d->n_nodes * sizeof *d->joined);
    CHECK_MEMORY(d->joined);
    for (dem_index i = 0; i < d->n_nodes; i++) d->joined[i] = w->joined[d->number[i]];
    return DEM_OK;
}

/* While `local` has the numbers of the domain. */
static dem_status find_elements(domain_cut *c, draft *s, const whole_lattice *w)
{
    const dem_lattice *l = w->of.lattice;
    domain *d = c->model->domain;
    const dem_index *local = w->lists.local;
    TRY(rigid_bodies_cut(&c->model->rigid, w->of.rigid, local, d->n_nodes));
    TRY(find_tuples(&d->spring, &s->n[LATTICE_SPRINGS], &(tuples){&w->springs, 2, l->ends, true}, d, local));
    return find_tuples(&c->triangle, &s->n[LATTICE_TRIANGLES], &(tuples){&w->triangles, 3, l->triangles, false}, d,
                       local);
}

static dem_status fill(domain_cut *c, draft *s, whole_lattice *w)
{
    TRY(find_elements(c, s, w));
    TRY(copy_joined(c->model->domain, w));
    TRY(find_nodes(s, c, w));
    return cut_lattice(c, s, w);
}

static void renumber(dem_index *list, dem_index n, const dem_index *number)
{
    for (dem_index k = 0; k < n && number != NULL; k++) list[k] = number[list[k]];
}

/* From the numbers of the lattice that the domain is cut from to those of the whole. */
static void number_by_whole(domain_cut *c, const whole_parts *of)
{
    domain *d = c->model->domain;
    d->n_whole = of->n[LATTICE_NODES];
    d->n_springs = of->n[LATTICE_SPRINGS];
    d->n_triangles = of->n[LATTICE_TRIANGLES];
    renumber(d->number, d->n_nodes, of->number[LATTICE_NODES]);
    renumber(d->spring, c->around.n_springs, of->number[LATTICE_SPRINGS]);
    renumber(c->triangle, c->around.n_triangles, of->number[LATTICE_TRIANGLES]);
}

dem_status domain_cut_take(domain_cut *out, whole_lattice *whole, int rank, dem_lattice *lattice)
{
    domain *d = out->model->domain = calloc(1, sizeof *d);
    touching_bodies *o = out->model->touching = calloc(1, sizeof *o);
    draft s = {.arrays = lattice};
    CHECK_MEMORY(d != NULL ? o : NULL);
    o->domain = d;
    TRY(domain_create_within(d, &whole->lists, rank));
    domain_lists_number(&whole->lists, d->number, d->n_nodes);
    const dem_status status = fill(out, &s, whole);
    domain_lists_forget(&whole->lists, d->number, d->n_nodes);
    domain_lists_forget(&whole->lists, s.node, s.n[LATTICE_NODES]);
    free(s.node);
    number_by_whole(out, &whole->of);
    return status;
}

dem_status domain_cut_fill(domain_cut *out, whole_lattice *whole, int rank)
{
    return domain_cut_take(out, whole, rank, NULL);
}
