/* SPDX-License-Identifier: BSD-3-Clause */
/* The force on a node comes from all pairs in which it is. Half of the pressure on a surface reaches a node as that of
 * its own pairs, and the other half as an end of edges, so that both together are divided by all of its length. */
#include "surface_contact/surface_load.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

void surface_load_free(surface_load *l)
{
    free(l->pairs);
    *l = (surface_load){0};
}

void surface_load_forces(const surface_contact *c, const double *x, double *force)
{
    for (dem_index i = 0; i < c->surface.lattice->n_nodes; i++) {
        vec2 on_node;
        (void)surface_contact_force(c, i, x, &on_node);
        vec2_put(force, i, on_node);
    }
}

/* ---- pressures ---- */

/* The area of surface at a node, m^2: half of each of its edges, times the thickness of the plate. */
static double area_of(const contact_surface *c, dem_index node)
{
    const surface *s = &c->surface;
    double area = 0.0;
    for (dem_index p = s->row[node]; p < s->row[node + 1]; p++) area += 0.5 * c->length[s->at[p]] * c->plate[s->at[p]];
    return area;
}

/* Adds what all pairs push with, along their normals. */
static void add_pushes(const surface_contact *c, const double *x, double *force)
{
    contact_push push;
    for (dem_index k = 0; k < c->rows->n; k++) {
        const contact_pair *p = &c->rows->list[k];
        if (!contact_pair_push(p, x, &push)) continue;
        for (int which = 0; which < CONTACT_PAIR_PUSHED; which++) {
            const dem_index node = p->nodes[which];
            vec2_put(force, node, vec2_add(vec2_at(force, node), contact_push_on(&push, which)));
        }
    }
}

dem_status surface_load_pressures(const surface_contact *c, const double *x, double *pressure)
{
    const contact_surface *s = &c->surface;
    double *force = calloc(2 * (size_t)s->lattice->n_nodes, sizeof *force);
    CHECK_MEMORY(force);
    add_pushes(c, x, force);
    for (dem_index i = 0; i < s->lattice->n_nodes; i++) pressure[i] = 0.0;
    for (dem_index k = 0; k < s->n_nodes; k++) {
        const dem_index i = s->nodes[k];
        pressure[i] = vec2_norm(vec2_at(force, i)) / area_of(s, i);
    }
    free(force);
    return DEM_OK;
}

/* ---- pairs ---- */

dem_status surface_load_list(surface_load *l, const surface_contact *c, const double *x)
{
    contact_push push;
    l->n = 0;
    for (dem_index k = 0; k < c->rows->n; k++) {
        const contact_pair *p = &c->rows->list[k];
        if (p->fills || !contact_pair_push(p, x, &push)) continue;
        CHECK(grow_array((void **)&l->pairs, &l->capacity, l->n + 1, sizeof *l->pairs), DEM_ERROR_MEMORY,
              "out of memory for %lld contact pairs", (long long)l->n + 1);
        const anchor *a = anchor_set_of_pair(&c->anchors, p);
        const double ratio = a != NULL ? anchor_set_ratio(&c->anchors, c->rows, a, x) : 0.0;
        l->pairs[l->n++] = (surface_load_entry){*p, ratio, a != NULL && fabs(ratio) >= a->friction};
    }
    return DEM_OK;
}

/* The place of an edge that is nearest to the node. */
static vec2 foot_of(const contact_pair *p, const double *x)
{
    const vec2 a = vec2_at(x, p->nodes[CONTACT_PAIR_FIRST]);
    const vec2 t = vec2_sub(vec2_at(x, p->nodes[CONTACT_PAIR_SECOND]), a);
    const double s = vec2_dot(vec2_sub(vec2_at(x, p->nodes[CONTACT_PAIR_NODE]), a), t) / vec2_dot(t, t);
    return vec2_along(a, fmin(fmax(s, 0.0), 1.0), t);
}

dem_pair surface_load_pair(const surface_load *l, dem_index k, const contact_surface *of, const double *x)
{
    const surface_load_entry *entry = &l->pairs[k];
    const contact_pair *p = &entry->pair;
    const dem_index node = p->nodes[CONTACT_PAIR_NODE], first = p->nodes[CONTACT_PAIR_FIRST];
    const vec2 foot = foot_of(p, x), way = vec2_sub(vec2_at(x, node), foot);
    const double gap = vec2_norm(way);
    contact_push push;
    (void)contact_pair_push(p, x, &push);
    const friction_pattern pattern = friction_pattern_make(&push, x);
    const vec2 force = contact_push_on(&push, CONTACT_PAIR_NODE);
    const vec2 friction = vec2_scale(-entry->ratio, pattern.at[CONTACT_PAIR_NODE]);
    return (dem_pair){
        .node = contact_surface_number(of, node),
        .edge = {contact_surface_number(of, first), contact_surface_number(of, p->nodes[CONTACT_PAIR_SECOND])},
        .body = contact_surface_body(of, node),
        .other_body = contact_surface_body(of, first),
        .x = {foot.x, foot.y},
        .normal = {way.x / gap, way.y / gap},
        .gap = gap,
        .thickness = p->thickness,
        .force = {force.x, force.y},
        .friction = {friction.x, friction.y},
        .slides = entry->slides};
}
