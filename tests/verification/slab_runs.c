/* SPDX-License-Identifier: BSD-3-Clause */
#include "slab_runs.h"

#include <stdlib.h>
#include <string.h>

#include "harness/rank_threads.h"
#include "model/shared_model.h"
#include "support.h"

slab_runs slab_runs_make(const slab_runs_scene *scene, int n)
{
    slab_runs runs = {.scene = scene};
    for (int part = 0; part < n; part++) {
        dem_slab *s = &runs.slabs[part];
        *s = scene->make(scene->of, part, n);
        runs.first[part] = s->first_node;
        runs.first[part + 1] = s->first_node + s->n_own;
    }
    return runs;
}

/* ---- the same model ---- */

static bool same(const void *a, const void *b, dem_index n, size_t size)
{
    return memcmp(a, b, (size_t)n * size) == 0;
}

static bool same_nodes(const domain *d, const domain *e)
{
    const dem_index n = d->n_nodes;
    return n == e->n_nodes && d->n_whole == e->n_whole && d->n_springs == e->n_springs &&
           d->n_triangles == e->n_triangles && d->n_surface_nodes == e->n_surface_nodes && d->n_rings == e->n_rings &&
           same(d->number, e->number, n, sizeof *d->number) && same(d->is_own, e->is_own, n, 1) &&
           same(d->is_ghost, e->is_ghost, n, 1) && same(d->is_common, e->is_common, n, 1) &&
           same(d->is_outer, e->is_outer, n, 1);
}

static bool same_neighbours(const domain *d, const domain *e)
{
    bool is_same = d->n_neighbours == e->n_neighbours;
    for (int k = 0; is_same && k < d->n_neighbours; k++) {
        const domain_neighbour *p = &d->neighbours[k], *q = &e->neighbours[k];
        is_same = p->rank == q->rank && p->n_sent == q->n_sent && p->n_received == q->n_received &&
                  same(p->sent, q->sent, p->n_sent, sizeof *p->sent) &&
                  same(p->received, q->received, p->n_received, sizeof *p->received);
    }
    return is_same;
}

static bool same_elements(const dem_model *a, const dem_model *b)
{
    const dem_lattice *l = &a->lattice, *m = &b->lattice;
    return l->n_springs == m->n_springs && l->n_triangles == m->n_triangles &&
           same(a->domain->spring, b->domain->spring, l->n_springs, sizeof *a->domain->spring) &&
           same(a->domain->triangle, b->domain->triangle, l->n_triangles, sizeof *a->domain->triangle) &&
           same(l->body, m->body, l->n_nodes, sizeof *l->body);
}

/* Of bodies that touch, with the boundary of the whole. */
static bool same_bodies(const dem_model *a, const dem_model *b, const dem_model *whole)
{
    const touching_bodies *p = a->touching, *q = b->touching;
    if (p == NULL || q == NULL) return p == q;
    const mesh_boundary *r = &p->boundary, *s = &q->boundary;
    bool is_same = p->has_all && q->has_all && p->n_bodies == q->n_bodies && r->n == s->n &&
                   same(p->bodies, q->bodies, p->n_bodies, sizeof *p->bodies) &&
                   same(r->outer, s->outer, a->lattice.n_nodes, 1);
    CLEANUP(mesh_boundary_free) mesh_boundary all = {0};
    assert_ok(mesh_boundary_create(&all, &whole->lattice, NULL));
    is_same = is_same && r->n == all.n;
    for (dem_index k = 0; is_same && k < r->n; k++) {
        const mesh_boundary_edge *e = &r->list[k], *f = &s->list[k], *of = &all.list[k];
        is_same = e->lower == f->lower && e->upper == f->upper && e->triangle == f->triangle &&
                  a->domain->number[e->lower] == of->lower && a->domain->number[e->upper] == of->upper &&
                  a->domain->triangle[e->triangle] == of->triangle;
    }
    return is_same;
}

static bool same_model(const dem_model *a, const dem_model *b, const dem_model *whole)
{
    return same_nodes(a->domain, b->domain) && same_neighbours(a->domain, b->domain) && same_elements(a, b) &&
           a->spacing == b->spacing && a->omega_max == b->omega_max && a->mass == b->mass &&
           a->n_bodies == b->n_bodies && same_bodies(a, b, whole);
}

static bool touches(const slab_runs *runs)
{
    return runs->scene->run.options.bodies != DEM_BODIES_NONE && !runs->has_no_options;
}

/* The model is cut from the whole by the same owners. */
static bool is_as_cut(const ranks *r, const slab_runs *runs, const dem_model *model)
{
    const slab_runs_scene *s = runs->scene;
    const dem_model *whole = s->run.model;
    CLEANUP(free_memory) int32_t *owner = malloc((size_t)whole->lattice.n_nodes * sizeof *owner);
    dem_model *cut = NULL;
    for (int k = 0; k < r->size; k++)
        for (dem_index i = runs->first[k]; i < runs->first[k + 1]; i++) owner[i] = (int32_t)k;
    const domain_model_shares shares = {.owner = owner, .touching = touches(runs), .use = s->use};
    const bool is_same = domain_model_create(&cut, r, whole, &shares) == DEM_OK && same_model(model, cut, whole);
    dem_model_destroy(cut);
    return is_same;
}

/* ---- runs ---- */

static void run_rank(const ranks *r, void *context)
{
    slab_runs *runs = context;
    const slab_runs_scene *s = runs->scene;
    rank_runs_outcome *o = &runs->outcomes[r->rank];
    const dem_private_whole of = {.slab = &runs->slabs[r->rank],
                                  .obstacles = s->obstacles,
                                  .n_obstacles = s->n_obstacles,
                                  .touching = touches(runs) ? DEM_PRIVATE_TOUCHING_SOME : DEM_PRIVATE_TOUCHING_UNKNOWN,
                                  .use = s->use};
    dem_model *model = NULL;
    o->status = dem_private_share_model(&model, &of, r);
    (void)strncpy(o->message, o->status != DEM_OK ? dem_status_message() : "", sizeof o->message - 1);
    if (o->status == DEM_OK) runs->is_cut[r->rank] = is_as_cut(r, runs, model);
    if (o->status == DEM_OK) rank_runs_go(model, NULL, NULL, o);
    dem_model_destroy(model);
}

void slab_runs_go(slab_runs *runs, int n)
{
    rank_threads_run(n, run_rank, runs);
}

void slab_runs_assert_same(const slab_runs_scene *scene, int n, const rank_runs_outcome *whole)
{
    slab_runs runs = slab_runs_make(scene, n);
    rank_runs_make_outcomes(&scene->run, n, runs.outcomes);
    slab_runs_go(&runs, n);
    for (int rank = 0; rank < n; rank++) {
        const char *what = rank_runs_difference(&runs.outcomes[rank], whole, NULL);
        if (what != NULL) fail_msg("rank %d of %d has another %s: '%s'", rank, n, what, runs.outcomes[rank].message);
        if (!runs.is_cut[rank]) fail_msg("rank %d of %d has another model", rank, n);
        assert_true(runs.slabs[rank].n_own == 0 && runs.slabs[rank].lattice.x == NULL);
    }
    rank_runs_free_outcomes(runs.outcomes, n);
}
