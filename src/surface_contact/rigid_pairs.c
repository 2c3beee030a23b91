/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds and evaluates the pairs of one rigid body with obstacles, by the law of contact_pair.c with the thickness and
 * modulus of the body. A node weighs as in contact with bodies. A vertex would have the length of its long segments: it
 * weighs as a node of the body does on average, or less if its segments are shorter. What is far from the body's box is
 * passed over; the rest is compared one by one. The list is only a filter, and changes no result. */
#include "surface_contact/rigid_pairs.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/sorted.h"
#include "base/status.h"

static const double usual_margin = 0.5;    /* over the mean edge */
static const double least_distance = 0.05; /* over the contact thickness, at the start */

/* ---- the body's surface ---- */

static dem_status allocate(rigid_pairs *p)
{
    const size_t n = (size_t)p->n_nodes, n_places = (size_t)p->n_places;
    p->nodes = malloc((n + 1) * sizeof *p->nodes);
    p->half_length = malloc((n + 1) * sizeof *p->half_length);
    p->edges = malloc(((size_t)p->n_edges + 1) * sizeof *p->edges);
    p->reference = calloc(2 * (size_t)p->n_tracked, sizeof *p->reference);
    p->places = calloc(2 * n_places, sizeof *p->places);
    p->before = calloc(2 * n_places, sizeof *p->before);
    p->force = calloc(2 * n_places, sizeof *p->force);
    CHECK(p->nodes && p->half_length && p->edges && p->reference && p->places && p->before && p->force,
          DEM_ERROR_MEMORY, "out of memory for the surface of rigid body %lld", (long long)p->body);
    return pair_rows_create(&p->pairs, p->n_places);
}

static void count(rigid_pairs *p, const contact_surface *of)
{
    for (dem_index k = 0; k < of->n_nodes; k++) p->n_nodes += contact_surface_body(of, of->nodes[k]) == p->body;
    for (dem_index e = 0; e < of->surface.n_edges; e++)
        p->n_edges += contact_surface_body(of, contact_surface_first(of, e)) == p->body;
    p->n_tracked = p->n_nodes + OBSTACLE_SURFACE_CORNERS * p->obstacles->of->n;
    p->n_places = p->n_tracked + p->obstacles->n_vertices;
}

static dem_index place_of_node(const rigid_pairs *p, dem_index node)
{
    return sorted_find(p->nodes, p->n_nodes, node);
}

static void list_surface(rigid_pairs *p, const contact_surface *of)
{
    dem_index n = 0;
    for (dem_index k = 0; k < of->n_nodes; k++) {
        if (contact_surface_body(of, of->nodes[k]) != p->body) continue;
        p->nodes[n] = of->nodes[k];
        p->half_length[n++] = of->half_length[k];
        p->mean += of->half_length[k] / (double)p->n_nodes;
    }
    n = 0;
    for (dem_index e = 0; e < of->surface.n_edges; e++) {
        const dem_index first = contact_surface_first(of, e);
        const dem_index before = of->surface.previous[e], after = of->surface.next[e];
        if (contact_surface_body(of, first) == p->body)
            p->edges[n++] = (surface_edge){.first = place_of_node(p, first),
                                           .second = place_of_node(p, contact_surface_second(of, e)),
                                           .before = place_of_node(p, contact_surface_first(of, before)),
                                           .after = place_of_node(p, contact_surface_second(of, after))};
    }
}

/* An edge by places. */
static surface_edge edge_at(const rigid_pairs *p, dem_index edge)
{
    if (edge < p->n_edges) return p->edges[edge];
    const surface_edge *of = &p->obstacles->edges[edge - p->n_edges];
    return (surface_edge){rigid_pairs_place(p, of->first), rigid_pairs_place(p, of->second),
                          rigid_pairs_place(p, of->before), rigid_pairs_place(p, of->after)};
}

/* Half of the length that a node, or a vertex, has of its surface, m. */
static double half_length_at(const rigid_pairs *p, dem_index place)
{
    return place < p->n_nodes ? p->half_length[place] : fmin(p->obstacles->half_length[place - p->n_tracked], p->mean);
}

/* ---- what anchors ask ---- */

/* The body is number 0, and obstacles follow. */
static dem_index number_of_body(const void *of, dem_index place)
{
    const rigid_pairs *p = of;
    return place < p->n_nodes ? 0 : 1 + p->obstacles->obstacle[place - p->n_tracked];
}

static surface_law law_between(const void *of, dem_index body, dem_index other)
{
    const rigid_pairs *p = of;
    const dem_index obstacle = (body > other ? body : other) - 1;
    return (surface_law){p->law.thickness, p->law.modulus, obstacle_surface_friction(p->obstacles, obstacle)};
}

static double half_length_of(const void *of, dem_index place)
{
    return half_length_at(of, place);
}

/* Nodes are where they are tracked, and vertices anywhere. */
static void copy_places(const void *of, const double *x, double *to)
{
    const rigid_pairs *p = of;
    memcpy(to, x, 2 * (size_t)p->n_tracked * sizeof *to);
    for (dem_index v = 0; v < p->obstacles->n_vertices; v++)
        vec2_put(to, rigid_pairs_place(p, v), obstacle_surface_place(p->obstacles, v));
}

static dem_status create_friction(rigid_pairs *p)
{
    const anchor_surfaces surfaces = {.of = p,
                                      .n_nodes = p->n_places,
                                      .body = number_of_body,
                                      .law = law_between,
                                      .half_length = half_length_of,
                                      .copy = copy_places};
    if (!obstacle_surface_has_friction(p->obstacles)) return DEM_OK;
    p->friction = calloc(2 * (size_t)p->n_places, sizeof *p->friction);
    CHECK(p->friction != NULL, DEM_ERROR_MEMORY, "out of memory for the friction of rigid body %lld",
          (long long)p->body);
    return anchor_set_create(&p->anchors, &surfaces);
}

dem_status rigid_pairs_create(rigid_pairs *out, const contact_surface *of, dem_index body,
                              const obstacle_surface *obstacles)
{
    *out = (rigid_pairs){.obstacles = obstacles, .part = of->part, .body = body, .law = of->laws[body]};
    out->margin = usual_margin * of->mean_length;
    count(out, of);
    TRY(allocate(out));
    list_surface(out, of);
    return create_friction(out);
}

void rigid_pairs_free(rigid_pairs *p)
{
    free(p->nodes);
    free(p->half_length);
    free(p->edges);
    free(p->places);
    free(p->before);
    free(p->reference);
    free(p->force);
    free(p->friction);
    free(p->near);
    free(p->facing);
    pair_rows_destroy(&p->pairs);
    anchor_set_destroy(&p->anchors);
    *p = (rigid_pairs){0};
}

/* ---- the list ---- */

static vec2 at(const rigid_pairs *p, dem_index place)
{
    return vec2_at(p->places, place);
}

static box box_of_body(const rigid_pairs *p, double margin)
{
    box around = box_empty();
    for (dem_index k = 0; k < p->n_nodes; k++) around = box_with(around, at(p, k));
    return box_around(around.low, around.high, margin);
}

/* Whether a segment may meet a box: whether their boxes do. */
static bool may_meet(vec2 a, vec2 b, const box *around)
{
    const box own = box_join((box){a, a}, (box){b, b});
    return box_meets(&own, around);
}

static bool is_near(const obstacle_surface *o, const surface_edge *edge, const box *around)
{
    return may_meet(obstacle_surface_place(o, edge->first), obstacle_surface_place(o, edge->second), around);
}

/* Lists the edges of obstacles that may meet the body's box, and marks their vertices and those next to them. */
static dem_status list_facing(rigid_pairs *p, const box *around)
{
    const obstacle_surface *o = p->obstacles;
    p->n_facing = 0;
    for (dem_index e = 0; e < o->n_edges; e++) {
        const surface_edge *edge = &o->edges[e];
        if (!is_near(o, edge, around)) continue;
        CHECK(grow_array((void **)&p->facing, &p->facing_capacity, p->n_facing + 1, sizeof *p->facing),
              DEM_ERROR_MEMORY, "out of memory for the contact of rigid body %lld", (long long)p->body);
        p->facing[p->n_facing++] = e;
        o->is_marked[edge->first] = o->is_marked[edge->second] = 1;
        o->is_marked[edge->before] = o->is_marked[edge->after] = 1;
    }
    return DEM_OK;
}

/* Lists the vertices that are marked, and takes their marks away. */
static dem_status list_near(rigid_pairs *p)
{
    const obstacle_surface *o = p->obstacles;
    p->n_near = 0;
    for (dem_index v = 0; v < o->n_vertices; v++) {
        if (!o->is_marked[v]) continue;
        o->is_marked[v] = 0;
        CHECK(grow_array((void **)&p->near, &p->near_capacity, p->n_near + 1, sizeof *p->near), DEM_ERROR_MEMORY,
              "out of memory for the contact of rigid body %lld", (long long)p->body);
        p->near[p->n_near++] = v;
    }
    return DEM_OK;
}

/* Puts the vertices near the body where they are. */
static void place_near(const rigid_pairs *p, double *places)
{
    for (dem_index q = 0; q < p->n_near; q++)
        vec2_put(places, rigid_pairs_place(p, p->near[q]), obstacle_surface_place(p->obstacles, p->near[q]));
}

/* Likewise what is tracked. */
static void place_tracked(const rigid_pairs *p, const double *x, double *places)
{
    dem_index n = p->n_nodes;
    for (dem_index k = 0; k < p->n_nodes; k++) vec2_put(places, k, vec2_at(x, p->nodes[k]));
    for (dem_index k = 0; k < p->obstacles->of->n; k++)
        for (int corner = 0; corner < OBSTACLE_SURFACE_CORNERS; corner++)
            vec2_put(places, n++, obstacle_surface_corner(p->obstacles, k, corner));
}

/* Adds the pair of a place and an edge if they are near. */
static dem_status consider(rigid_pairs *p, dem_index place, dem_index number)
{
    const double reach = p->law.thickness + p->margin;
    const surface_edge edge = edge_at(p, number);
    if (contact_pair_distance(at(p, place), at(p, edge.first), at(p, edge.second)) > reach) return DEM_OK;
    const contact_pair pair = {.nodes = {place, edge.first, edge.second, edge.before, edge.after},
                               .thickness = p->law.thickness,
                               .weight = half_length_at(p, place) * p->law.modulus};
    return pair_rows_add(&p->pairs, &pair);
}

static dem_status list_pairs(rigid_pairs *p, const box *around)
{
    pair_rows_clear(&p->pairs);
    for (dem_index k = 0; k < p->n_nodes; k++)
        for (dem_index q = 0; q < p->n_facing; q++) TRY(consider(p, k, p->n_edges + p->facing[q]));
    for (dem_index q = 0; q < p->n_near; q++) {
        const dem_index place = rigid_pairs_place(p, p->near[q]);
        const bool near = may_meet(at(p, place), at(p, place), around);
        for (dem_index e = 0; e < p->n_edges && near; e++) TRY(consider(p, place, e));
    }
    return pair_rows_link(&p->pairs);
}

static dem_status make_list(rigid_pairs *p)
{
    const box around = box_of_body(p, p->law.thickness + p->margin);
    const dem_status listed = list_facing(p, &around);
    TRY(status_first(listed, list_near(p)));
    place_near(p, p->places);
    return list_pairs(p, &around);
}

/* How far two places have moved relative to each other from where they were, at most, m. */
static double change(const rigid_pairs *p, const double *from)
{
    box ways = box_empty();
    for (dem_index k = 0; k < p->n_tracked; k++) ways = box_with(ways, vec2_sub(at(p, k), vec2_at(from, k)));
    return box_diagonal(ways);
}

/* Makes the list anew unless it holds. */
static dem_status renew_list(rigid_pairs *p)
{
    if (p->made && change(p, p->reference) <= p->margin) return DEM_OK;
    memcpy(p->reference, p->places, 2 * (size_t)p->n_tracked * sizeof *p->places);
    const dem_status status = make_list(p);
    p->made = status == DEM_OK;
    return status;
}

/* Places of what had friction after the last step are needed, even if it is not near any more. */
static void place_anchors(rigid_pairs *p)
{
    const anchor_list *l = &p->anchors.now;
    for (dem_index k = 0; k < l->n_patterns; k++)
        for (int which = 0; which < CONTACT_PAIR_NODES; which++) {
            const dem_index place = l->patterns[k].nodes[which];
            if (place >= p->n_tracked)
                vec2_put(p->places, place, obstacle_surface_place(p->obstacles, place - p->n_tracked));
        }
}

dem_status rigid_pairs_follow(rigid_pairs *p, const double *x)
{
    place_tracked(p, x, p->places);
    place_near(p, p->places);
    place_anchors(p);
    return renew_list(p);
}

/* ---- forces, energy, stiffness ---- */

static void add(double *to, dem_index place, vec2 force)
{
    vec2_put(to, place, vec2_add(vec2_at(to, place), force));
}

static void clear(const rigid_pairs *p, double *vectors)
{
    memset(vectors, 0, 2 * (size_t)p->n_nodes * sizeof *vectors);
    for (dem_index q = 0; q < p->n_near; q++) vec2_put(vectors, rigid_pairs_place(p, p->near[q]), (vec2){0.0, 0.0});
}

/* Friction comes behind the pairs. */
static void add_friction(rigid_pairs *p)
{
    const anchor_set *anchors = &p->anchors;
    clear(p, p->friction);
    anchor_set_end(&p->anchors, p->places);
    for (dem_index k = 0; k < anchors->n_held; k++) {
        const friction_pattern *friction = &anchors->held[k].friction;
        for (int which = 0; which < CONTACT_PAIR_NODES; which++) {
            add(p->friction, friction->nodes[which], friction->at[which]);
            add(p->force, friction->nodes[which], friction->at[which]);
        }
    }
}

dem_status rigid_pairs_push(rigid_pairs *p)
{
    contact_push push;
    clear(p, p->force);
    TRY(anchor_set_begin(&p->anchors, p->pairs.n));
    for (dem_index k = 0; k < p->pairs.n; k++) {
        if (!contact_pair_push(&p->pairs.list[k], p->places, &push)) continue;
        for (int which = 0; which < CONTACT_PAIR_PUSHED; which++)
            add(p->force, push.pair->nodes[which], contact_push_on(&push, which));
        anchor_set_hold(&p->anchors, &push, p->places);
    }
    if (rigid_pairs_have_friction(p)) add_friction(p);
    return DEM_OK;
}

void rigid_pairs_add_energy(const rigid_pairs *p, exact_sum *sum)
{
    for (dem_index k = 0; k < p->pairs.n; k++) exact_sum_add(sum, contact_pair_energy(&p->pairs.list[k], p->places));
}

/* What anchors add at the nodes of the body. */
static void add_anchor(void *to, dem_index place, double stiffness)
{
    rigid_pairs *p = to;
    if (place < p->n_nodes) add(p->force, place, (vec2){stiffness, 0.0});
}

/* Sums at the nodes, N/m, are kept where forces are, as their first components. */
double rigid_pairs_stiffening(rigid_pairs *p, const double *inverse_mass)
{
    double added[CONTACT_PAIR_PUSHED], largest = 0.0;
    clear(p, p->force);
    for (dem_index k = 0; k < p->pairs.n; k++) {
        const contact_pair *pair = &p->pairs.list[k];
        if (!contact_pair_stiffness(pair, p->places, added)) continue;
        for (int which = 0; which < CONTACT_PAIR_PUSHED; which++)
            add(p->force, pair->nodes[which], (vec2){added[which], 0.0});
    }
    anchor_set_add_stiffness(&p->anchors, add_anchor, p);
    for (dem_index k = 0; k < p->n_nodes; k++)
        largest = fmax(largest, vec2_at(p->force, k).x * inverse_mass[p->nodes[k]]);
    return largest;
}

/* ---- steps ---- */

void rigid_pairs_begin_step(rigid_pairs *p, const double *x)
{
    place_tracked(p, x, p->before);
}

/* What has crossed is no further apart than it has come in the step: from then on the list reaches as far. */
dem_status rigid_pairs_end_step(rigid_pairs *p, const double *x)
{
    TRY(rigid_pairs_follow(p, x));
    const double way = change(p, p->before);
    if (!(way > p->margin)) return DEM_OK;
    p->margin = way;
    p->made = false;
    return renew_list(p);
}

void rigid_pairs_look_back(rigid_pairs *p)
{
    place_near(p, p->before);
}

const contact_pair *rigid_pairs_crossing(const rigid_pairs *p, double *part)
{
    for (dem_index k = 0; k < p->pairs.n; k++)
        if (contact_pair_crosses(&p->pairs.list[k], p->before, p->places, part)) return &p->pairs.list[k];
    return NULL;
}

dem_index rigid_pairs_obstacle(const rigid_pairs *p, const contact_pair *pair)
{
    const dem_index node = pair->nodes[CONTACT_PAIR_NODE];
    const dem_index vertex = node < p->n_nodes ? pair->nodes[CONTACT_PAIR_FIRST] : node;
    return p->obstacles->obstacle[vertex - p->n_tracked];
}

dem_status rigid_pairs_settle(rigid_pairs *p, const double *x)
{
    TRY(rigid_pairs_follow(p, x));
    return anchor_set_settle(&p->anchors, p->pairs.list, p->pairs.n, p->places);
}

dem_status rigid_pairs_restore(rigid_pairs *p, const anchor_record *records, dem_index n, const double *x)
{
    TRY(rigid_pairs_follow(p, x));
    return anchor_set_restore(&p->anchors, records, n, p->pairs.list, p->pairs.n, p->places);
}

/* ---- the start ---- */

static dem_status check_edge(const rigid_pairs *p, const surface_edge *of_obstacle)
{
    const obstacle_surface *o = p->obstacles;
    const vec2 c = obstacle_surface_place(o, of_obstacle->first), d = obstacle_surface_place(o, of_obstacle->second);
    for (dem_index e = 0; e < p->n_edges; e++) {
        const surface_edge *edge = &p->edges[e];
        const vec2 a = at(p, edge->first);
        CHECK(!vec2_segments_cross(a, at(p, edge->second), c, d), DEM_ERROR_MODEL,
              "body %lld, which is rigid, crosses obstacle %lld at the start: by its edge between nodes %lld and %lld, "
              "at (%g, %g) m",
              (long long)p->body, (long long)o->obstacle[of_obstacle->first],
              (long long)touching_bodies_node(p->part, p->nodes[edge->first]),
              (long long)touching_bodies_node(p->part, p->nodes[edge->second]), a.x, a.y);
    }
    return DEM_OK;
}

dem_status rigid_pairs_check_start(const rigid_pairs *p)
{
    const obstacle_surface *o = p->obstacles;
    const box around = box_of_body(p, 0.0);
    for (dem_index e = 0; e < o->n_edges; e++)
        if (is_near(o, &o->edges[e], &around)) TRY(check_edge(p, &o->edges[e]));
    for (dem_index k = 0; k < p->pairs.n; k++) {
        const contact_pair *pair = &p->pairs.list[k];
        const double gap = contact_pair_gap(pair, p->places), least = least_distance * p->law.thickness;
        const vec2 place = at(p, pair->nodes[CONTACT_PAIR_NODE]);
        CHECK(gap >= least, DEM_ERROR_MODEL,
              "body %lld, which is rigid, is %g m from obstacle %lld at (%g, %g) m: they must be %g m apart at the "
              "start, a twentieth of the contact thickness",
              (long long)p->body, gap, (long long)rigid_pairs_obstacle(p, pair), place.x, place.y, least);
    }
    return DEM_OK;
}
