/* SPDX-License-Identifier: BSD-3-Clause */
/* Boundary, stresses, and what triangles give to springs are found in the lattice about the domain, as a side of a
 * triangle of the domain may have its other triangle outside of it, and stresses when they are first asked for, unless
 * they decide what breaks; all else in the lattice of the domain, as any model is compiled. */
#include "model/domain_compile.h"

#include <stdlib.h>

#include "base/status.h"
#include "lattice/lattice.h"
#include "model/breakable_nodes.h"
#include "model/coupled_bound.h"
#include "model/domain_stress.h"
#include "model/joined_nodes.h"
#include "obstacle/obstacle_set.h"

/* The numbers that nodes and triangles about the domain have in it; -1: they are beside it. */
typedef struct numbers {
    dem_index *node, *triangle;
} numbers;

static void free_numbers(numbers *q)
{
    free(q->node);
    free(q->triangle);
}

static dem_status find_numbers(numbers *q, const domain_cut *c)
{
    const dem_lattice *l = &c->around;
    dem_index n = 0;
    q->node = lattice_zeros(l->n_nodes, sizeof *q->node);
    q->triangle = lattice_zeros(l->n_triangles, sizeof *q->triangle);
    CHECK(q->node && q->triangle, DEM_ERROR_MEMORY, "out of memory for a domain of %lld nodes", (long long)l->n_nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) q->node[i] = -1;
    for (dem_index i = 0; i < c->model->domain->n_nodes; i++) q->node[c->place[i]] = i;
    for (dem_index k = 0; k < l->n_triangles; k++) {
        const dem_index *corner = &l->triangles[3 * k];
        const bool is_there = q->node[corner[0]] >= 0 && q->node[corner[1]] >= 0 && q->node[corner[2]] >= 0;
        q->triangle[k] = is_there ? n++ : -1;
    }
    return DEM_OK;
}

/* The sides of a boundary whose triangles are in the domain.  \return how many there are */
static dem_index list_sides(const mesh_boundary *around, const numbers *q, mesh_boundary_edge *list)
{
    dem_index n = 0;
    for (dem_index k = 0; k < around->n; k++) {
        const mesh_boundary_edge *e = &around->list[k];
        if (q->triangle[e->triangle] < 0) continue;
        if (list != NULL)
            list[n] = (mesh_boundary_edge){q->node[e->lower], q->node[e->upper], q->triangle[e->triangle]};
        n++;
    }
    return n;
}

/* A side that the lattice about the domain has but once is on the boundary if one of its ends is in the domain, as all
 * triangles of that end are there. Where bodies touch each other the boundary has all sides of the whole. */
static dem_status cut_boundary(mesh_boundary *out, const mesh_boundary *around, const numbers *q, const domain_cut *c)
{
    const domain *d = c->model->domain;
    out->lattice = &c->model->lattice;
    out->n = list_sides(around, q, NULL);
    out->list = malloc(((size_t)out->n + 1) * sizeof *out->list);
    out->outer = calloc((size_t)d->n_nodes + 1, 1);
    CHECK(out->list && out->outer, DEM_ERROR_MEMORY, "out of memory for %lld boundary edges", (long long)out->n);
    (void)list_sides(around, q, out->list);
    for (dem_index k = 0; k < around->n; k++) {
        const dem_index i = q->node[around->list[k].lower], j = q->node[around->list[k].upper];
        if (i >= 0) out->outer[i] = 1;
        if (j >= 0) out->outer[j] = 1;
    }
    return DEM_OK;
}

/* Those of nodes that are integrated here. */
static dem_status list_boundary(domain *d, const mesh_boundary *cut)
{
    dem_index n = 0;
    for (dem_index i = 0; i < d->n_nodes; i++) n += cut->outer[i] && !d->is_ghost[i];
    d->boundary = malloc(((size_t)n + 1) * sizeof *d->boundary);
    CHECK(d->boundary != NULL, DEM_ERROR_MEMORY, "out of memory for %lld nodes of the boundary", (long long)n);
    for (dem_index i = 0; i < d->n_nodes; i++)
        if (cut->outer[i] && !d->is_ghost[i]) d->boundary[d->n_boundary++] = i;
    return DEM_OK;
}

static dem_status compile_boundary(const domain_cut *c, const numbers *q)
{
    mesh_boundary around, *const cut = &c->model->touching->boundary;
    TRY(mesh_boundary_create(&around, &c->around, NULL));
    const dem_status status = cut_boundary(cut, &around, q, c);
    mesh_boundary_free(&around);
    return status == DEM_OK ? list_boundary(c->model->domain, cut) : status;
}

/* What springs have of the triangles at them, of which one may be beside the domain. */
static dem_status compile_given(domain_cut *c)
{
    springs all = {0};
    if (c->around.coupling == NULL) return DEM_OK;
    TRY(springs_compile(&all, &c->around));
    const dem_status status = coupled_bound_given(&c->given, &c->around, &all);
    springs_free(&all);
    return status;
}

/* In the place of the lattice about the domain, which ends. */
static dem_status take_lattice(domain_cut *c, const numbers *q)
{
    dem_lattice *l = &c->around;
    const dem_index n_nodes = l->n_nodes, n_triangles = l->n_triangles;
    bool *keep = lattice_zeros(n_nodes, sizeof *keep);
    CHECK_MEMORY(keep);
    for (dem_index i = 0; i < n_nodes; i++) keep[i] = q->node[i] >= 0;
    const dem_status status = dem_lattice_select(l, keep);
    free(keep);
    TRY(status);
    for (dem_index k = 0; k < n_triangles; k++)
        if (q->triangle[k] >= 0) c->triangle[q->triangle[k]] = c->triangle[k];
    c->model->domain->triangle = c->triangle;
    c->model->lattice = *l;
    if (l->position == NULL) c->model->lattice.position = l->x; /* neither is changed */
    c->triangle = NULL;
    *l = dem_lattice_empty();
    return DEM_OK;
}

static dem_status compile_nodes(dem_model *m)
{
    const domain *d = m->domain;
    const dem_lattice *l = &m->lattice;
    m->inverse_mass = lattice_zeros(d->n_nodes, sizeof *m->inverse_mass);
    CHECK_MEMORY(m->inverse_mass);
    for (dem_index i = 0; i < d->n_nodes; i++)
        m->inverse_mass[i] = d->is_outer[i] || (l->flags[i] & DEM_NODE_FIXED) ? 0.0 : 1.0 / l->mass[i];
    return DEM_OK;
}

static dem_status compile_cut(domain_cut *c)
{
    numbers q = {0};
    dem_status status = find_numbers(&q, c);
    if (status == DEM_OK) status = compile_boundary(c, &q);
    if (status == DEM_OK) status = compile_given(c);
    if (status == DEM_OK) status = domain_stress_create(c, q.node, q.triangle);
    if (status == DEM_OK) status = take_lattice(c, &q);
    free_numbers(&q);
    return status == DEM_OK ? compile_nodes(c->model) : status;
}

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

dem_status domain_compile(domain_cut *c, const dem_obstacle *obstacles, dem_index n_obstacles, bool touching)
{
    dem_model *m = c->model;
    TRY(compile_cut(c));
    if (m->domain->joined != NULL) TRY(joined_nodes_place(m->domain));
    TRY(model_rows_compile(m));
    TRY(compile_surface(m, touching));
    TRY(obstacles_compile(&m->obstacles, obstacles, n_obstacles));
    return breakable_lattice(&m->lattice) ? stress_prepare(&m->stress) : DEM_OK;
}
