/* SPDX-License-Identifier: BSD-3-Clause */
/* The list of sites, and the bookkeeping of contacts that open and close. */
#include "contact/contact_set.h"

#include <stdlib.h>

#include "base/status.h"

static void list_edges(contact_sites *c)
{
    const surface *s = &c->scene.model->surface;
    for (dem_index e = 0; e < c->n - c->scene.model->n_sites; e++) {
        contact_site site = {.node = s->ends[2 * e], .other = s->ends[2 * e + 1], .behind = {-1, -1}};
        site.previous = s->previous[e] >= 0 ? s->ends[2 * s->previous[e]] : -1;
        site.next = s->next[e] >= 0 ? s->ends[2 * s->next[e] + 1] : -1;
        c->list[sites_of_edge(c, e)] = site;
    }
}

dem_status sites_create(contact_sites *c, const dem_model *model, const contact_rule *rule)
{
    const bool vertices = rule->vertices && model->obstacles.n_vertices > 0;
    *c = (contact_sites){.scene = {model, *rule}};
    c->n = model->n_sites + (vertices ? model->surface.n_edges : 0);
    c->list = calloc((size_t)c->n + 1, sizeof *c->list);
    c->of_node = malloc((size_t)model->lattice.n_nodes * sizeof *c->of_node);
    if (c->list == NULL || c->of_node == NULL) {
        sites_destroy(c);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld contact sites", (long long)c->n);
    }
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) c->of_node[i] = -1;
    for (dem_index k = 0; k < model->n_sites; k++) {
        c->list[k] =
            (contact_site){.node = model->sites[k], .other = -1, .previous = -1, .next = -1, .behind = {-1, -1}};
        c->of_node[model->sites[k]] = k;
    }
    list_edges(c);
    dem_status status = books_create(&c->books, model->obstacles.n);
    if (status == DEM_OK) status = reactions_create(&c->reactions, &c->scene, c->list, c->n);
    if (status != DEM_OK) sites_destroy(c);
    return status;
}

void sites_destroy(contact_sites *c)
{
    free(c->list);
    free(c->of_node);
    books_destroy(&c->books);
    reactions_destroy(&c->reactions);
    *c = (contact_sites){0};
}

/* Whether an edge at the node, other than site k, has closed contacts. */
static bool edge_closed(const contact_sites *c, dem_index node, dem_index k)
{
    const surface *s = &c->scene.model->surface;
    if (c->n == c->scene.model->n_sites) return false;
    for (dem_index p = s->row[node]; p < s->row[node + 1]; p++)
        if (sites_of_edge(c, s->at[p]) != k && c->list[sites_of_edge(c, s->at[p])].n_closed > 0) return true;
    return false;
}

static bool node_closed(const contact_sites *c, dem_index node)
{
    return c->of_node[node] >= 0 && c->list[c->of_node[node]].n_closed > 0;
}

bool sites_coupled(const contact_sites *c, dem_index k)
{
    const contact_site *s = &c->list[k];
    if (!site_is_edge(s)) return edge_closed(c, s->node, k);
    return edge_closed(c, s->node, k) || edge_closed(c, s->other, k) || node_closed(c, s->node) ||
           node_closed(c, s->other);
}

void sites_go_behind(contact_sites *c, dem_index k, dem_index obstacle)
{
    const surface *s = &c->scene.model->surface;
    const dem_index node = c->list[k].node;
    c->books.counts.behind += obstacle >= 0 ? 1 : -1;
    c->list[k].behind[0] = obstacle;
    sites_disturb(&c->list[k]);
    for (dem_index p = s->row[node]; p < s->row[node + 1] && c->n > c->scene.model->n_sites; p++) {
        contact_site *edge = &c->list[sites_of_edge(c, s->at[p])];
        edge->behind[edge->node == node ? 0 : 1] = obstacle;
        sites_disturb(edge);
    }
}

/* Whether an edge at the node, other than site k, has closed a contact with the vertex. */
static bool shared(const contact_sites *c, dem_index node, dem_index k, dem_index feature)
{
    const surface *s = &c->scene.model->surface;
    for (dem_index p = s->row[node]; p < s->row[node + 1]; p++) {
        const dem_index e = sites_of_edge(c, s->at[p]);
        for (int q = 0; e != k && q < c->list[e].n_closed; q++)
            if (c->list[e].closed[q].feature == feature) return true;
    }
    return false;
}

/* Which contacts are of a corner: both of a node on two segments, and a vertex on two edges that meet in it. One that
 * is not any more is at rest. */
static void mark_corners(contact_sites *c)
{
    for (dem_index k = 0; k < c->n; k++) {
        contact_site *site = &c->list[k];
        for (int q = 0; q < site->n_closed; q++) {
            contact_touch *touch = &site->closed[q];
            const bool held = site_is_edge(site) ? shared(c, site->node, k, touch->feature) ||
                                                       shared(c, site->other, k, touch->feature)
                                                 : site->n_closed == 2;
            if (touch->held && !held) touch->sign = touch_friction(&c->scene, site, touch->feature) > 0.0 ? 0 : 1;
            if (held) touch->sign = 1;
            touch->held = held;
        }
    }
}

dem_status sites_regroup(contact_sites *c)
{
    mark_corners(c);
    return reactions_regroup(&c->reactions);
}

dem_status sites_close(contact_sites *c, dem_index k, contact_touch touch)
{
    contact_site *site = &c->list[k];
    site->closed[site->n_closed++] = touch;
    sites_disturb(site);
    return sites_regroup(c);
}

dem_status sites_open(contact_sites *c, dem_index k, int q)
{
    contact_site *site = &c->list[k];
    if (q == 0) site->closed[0] = site->closed[1];
    site->n_closed--;
    sites_disturb(site);
    return sites_regroup(c);
}

void sites_move(contact_sites *c, dem_index i, vec2 shift, double *x)
{
    const double *gravity = c->scene.rule.load.gravity;
    const double before = forces_node_energy(c->scene.model, gravity, i, x);
    vec2_put(x, i, vec2_add(vec2_at(x, i), shift));
    c->books.projection += forces_node_energy(c->scene.model, gravity, i, x) - before;
}

void sites_store(contact_sites *c, dem_index k)
{
    for (int q = 0; q < c->list[k].n_closed; q++) {
        c->list[k].closed[q].force = c->reactions.force[k][q].normal;
        c->list[k].closed[q].friction = c->reactions.force[k][q].tangent;
    }
}

void sites_weigh(contact_sites *c, dem_index k, const double *x, const double *v)
{
    reactions_solve(&c->reactions, c->reactions.group[k], x, v);
    sites_store(c, k);
}

double sites_stop(contact_sites *c, dem_index group, const double *x, double *v)
{
    reactions *r = &c->reactions;
    double energy = 0.0;
    for (int after = 0; after < 2; after++) { /* impulses at points take -J.(v + v')/2 */
        for (dem_index p = r->row[group]; p < r->row[group + 1]; p++) {
            contact_site *site = &c->list[r->members[p]];
            for (int q = 0; q < site->n_closed; q++) {
                const touch_frame f = touch_frame_at(&c->scene, site, q, x, v);
                const reaction got = r->force[r->members[p]][q];
                const vec2 impulse = vec2_along(vec2_scale(got.normal, f.normal), got.tangent, f.tangent);
                if (after) energy -= 0.5 * vec2_dot(impulse, vec2_add(site->closed[q].stop, f.velocity));
                site->closed[q].stop = after ? impulse : f.velocity;
            }
        }
        if (!after) reactions_stop(r, group, x, v);
    }
    return energy;
}

sites_share sites_share_of(const contact_sites *c, dem_index k, int q, const double *x, const double *v)
{
    const contact_site *site = &c->list[k];
    const reaction *force = &c->reactions.force[k][q];
    const touch_frame f = touch_frame_at(&c->scene, site, q, x, v);
    const vec2 along = vec2_scale(force->tangent, f.tangent);
    const bool slides = site->closed[q].sign != 0;
    return (sites_share){.obstacle =
                             touch_obstacle(&c->scene, site, site->closed[q].feature) - c->scene.model->obstacles.list,
                         .force = vec2_along(along, force->normal, f.normal),
                         .friction = along,
                         .power = slides ? -force->tangent * vec2_dot(f.velocity, f.tangent) : 0.0};
}

dem_index sites_group_at(const contact_sites *c, dem_index node)
{
    const surface *s = &c->scene.model->surface;
    if (node_closed(c, node)) return c->reactions.group[c->of_node[node]];
    if (c->n == c->scene.model->n_sites) return -1;
    for (dem_index p = s->row[node]; p < s->row[node + 1]; p++)
        if (c->list[sites_of_edge(c, s->at[p])].n_closed > 0) return c->reactions.group[sites_of_edge(c, s->at[p])];
    return -1;
}

dem_event sites_event(const contact_sites *c, dem_index k, dem_index feature, dem_event_kind kind,
                      const contact_moment *now)
{
    const contact_site *site = &c->list[k];
    contact_site alone = *site;
    alone.closed[0] = (contact_touch){.feature = feature, .sign = 1};
    const touch_frame f = touch_frame_at(&c->scene, &alone, 0, now->x, now->v);
    const segment *s = scene_segment(&c->scene, touch_segment(&c->scene, site, feature));
    const vec2 at = site_is_edge(site) ? c->scene.model->obstacles.vertices[feature].at : vec2_at(now->x, site->node);
    dem_event event = {.t = now->t,
                       .kind = kind,
                       .node = site->node,
                       .other = site->other,
                       .weight = site_is_edge(site) ? f.place : 0.0,
                       .obstacle = s->obstacle,
                       .segment = s->index,
                       .x = {at.x, at.y},
                       .normal = {f.normal.x, f.normal.y},
                       .before = {f.velocity.x, f.velocity.y},
                       .after = {f.velocity.x, f.velocity.y}};
    for (int q = 0; q < site->n_closed; q++)
        if (site->closed[q].feature == feature)
            event.state = site->closed[q].sign == 0 || site->closed[q].held ? DEM_CONTACT_STICK : DEM_CONTACT_SLIP;
    return event;
}
