/* SPDX-License-Identifier: BSD-3-Clause */
/* Where anchors are. Of the pairs of a node those count that push it, in their order; the force N that limits friction
 * is the sum over the pairs with the surface of the body on which the anchor is. After a step an anchor
 * - goes when nothing of that body pushes its node any more;
 * - comes to the edge that pushes most when the node's foot has left its edge;
 * - has its shift shortened to k tau = mu N where k tau is more;
 * - takes down where its node is. None of this changes a force.
 * A node without an anchor gets one on the edge that pushes most. The law of one anchor is in anchor.c. */
#include "surface_contact/anchor_set.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

static const double spring_share = 0.1; /* of the weight of a node over the thickness: stiffness of its spring */
static const double end_margin = 0.02;  /* of an edge, by which the foot may be beyond its ends */

static dem_status allocate(anchor_set *s, dem_index n)
{
    s->of = malloc((size_t)n * sizeof *s->of);
    CHECK(s->of != NULL, DEM_ERROR_MEMORY, "out of memory for the friction of %lld nodes", (long long)n);
    for (dem_index i = 0; i < n; i++) s->of[i] = -1;
    return DEM_OK;
}

dem_status anchor_set_create(anchor_set *out, const anchor_surfaces *surfaces)
{
    *out = (anchor_set){.surfaces = *surfaces};
    return anchor_set_has_friction(out) ? allocate(out, surfaces->n_nodes) : DEM_OK;
}

void anchor_set_destroy(anchor_set *s)
{
    free(s->list);
    free(s->old);
    free(s->of);
    *s = (anchor_set){0};
}

/* ---- the list ---- */

void anchor_set_clear(anchor_set *s)
{
    for (dem_index k = 0; k < s->n; k++) s->of[s->list[k].nodes[CONTACT_PAIR_NODE]] = -1;
    s->n = 0;
}

static dem_status append(anchor_set *s, const anchor *a)
{
    CHECK(grow_array((void **)&s->list, &s->capacity, s->n + 1, sizeof *s->list), DEM_ERROR_MEMORY,
          "out of memory for %lld anchors", (long long)s->n + 1);
    s->of[a->nodes[CONTACT_PAIR_NODE]] = s->n;
    s->list[s->n++] = *a;
    return DEM_OK;
}

static dem_index body_of(const anchor_set *s, dem_index node)
{
    return s->surfaces.body(s->surfaces.of, node);
}

static surface_law law_between(const anchor_set *s, dem_index body, dem_index other)
{
    return s->surfaces.law(s->surfaces.of, body, other);
}

/* An anchor of a node on an edge that may push it, at no place as yet. */
static anchor make_anchor(const anchor_set *s, dem_index node, dem_index edge)
{
    dem_index ends[2];
    (void)s->surfaces.ends(s->surfaces.of, node, edge, ends);
    const surface_law law = law_between(s, body_of(s, node), body_of(s, ends[0]));
    const double half_length = s->surfaces.half_length(s->surfaces.of, node);
    return (anchor){.nodes = {node, ends[0], ends[1]},
                    .edge = edge,
                    .stiffness = spring_share * half_length * law.modulus / law.thickness,
                    .friction = law.friction};
}

static anchor_record record_of(const anchor *a)
{
    return (anchor_record){a->nodes[CONTACT_PAIR_NODE],      a->edge, a->weight, {a->place.x, a->place.y},
                           {a->direction.x, a->direction.y}, a->shift};
}

/* Its stiffness comes from the surfaces. */
static dem_status append_recorded(anchor_set *s, const anchor_record *record)
{
    anchor a = make_anchor(s, record->node, record->edge);
    a.weight = record->weight;
    a.place = (vec2){record->place[0], record->place[1]};
    a.direction = (vec2){record->direction[0], record->direction[1]};
    a.shift = record->shift;
    return append(s, &a);
}

/* ---- forces ---- */

const anchor *anchor_set_of_pair(const anchor_set *s, const contact_pair *p)
{
    const dem_index k = s->n > 0 ? s->of[p->nodes[CONTACT_PAIR_NODE]] : -1;
    if (k < 0) return NULL;
    const anchor *a = &s->list[k];
    return body_of(s, p->nodes[CONTACT_PAIR_FIRST]) == body_of(s, a->nodes[CONTACT_PAIR_FIRST]) ? a : NULL;
}

/* The next push of an anchor's node by its body, from `*slot` on.  \return whether there is one */
static bool next_push(const anchor_set *s, const pair_rows *r, dem_index *slot, const double *x, contact_push *out)
{
    bool found = false;
    for (; *slot >= 0 && !found; *slot = r->next[*slot]) {
        const contact_pair *p = pair_rows_pair(r, *slot);
        found = pair_rows_which(*slot) == CONTACT_PAIR_NODE && anchor_set_of_pair(s, p) != NULL &&
                contact_pair_push(p, x, out);
    }
    return found;
}

/* The force with which the anchor's body pushes its node, N. */
static vec2 normal_of(const anchor_set *s, const pair_rows *r, const anchor *a, const double *x)
{
    vec2 sum = {0.0, 0.0};
    contact_push push;
    for (dem_index slot = r->first[a->nodes[CONTACT_PAIR_NODE]]; next_push(s, r, &slot, x, &push);)
        sum = vec2_add(sum, contact_push_on(&push, CONTACT_PAIR_NODE));
    return sum;
}

static bool is_force(vec2 a)
{
    return vec2_norm(a) > 0.0;
}

double anchor_set_ratio(const anchor_set *s, const pair_rows *r, const anchor *a, const double *x)
{
    const vec2 normal = normal_of(s, r, a, x);
    return is_force(normal) ? anchor_ratio(a, normal, x) : 0.0;
}

bool anchor_set_add_force(const anchor_set *s, const pair_rows *r, dem_index i, const double *x, vec2 *force)
{
    bool pulls = false;
    contact_push push;
    vec2 friction[ANCHOR_NODES];
    for (dem_index slot = s->n > 0 ? r->first[i] : -1; slot >= 0; slot = r->next[slot]) {
        const int which = pair_rows_which(slot);
        const contact_pair *p = pair_rows_pair(r, slot);
        const anchor *a = which < ANCHOR_NODES ? anchor_set_of_pair(s, p) : NULL;
        if (a == NULL || !contact_pair_push(p, x, &push)) continue;
        anchor_turn_push(&push, anchor_set_ratio(s, r, a, x), x, friction);
        *force = vec2_add(*force, friction[which]);
        pulls = true;
    }
    return pulls;
}

/* Adds the friction of one anchor. */
static void add_friction(const anchor_set *s, const pair_rows *r, const anchor *a, const double *x, double *forces)
{
    const double ratio = anchor_set_ratio(s, r, a, x);
    contact_push push;
    vec2 friction[ANCHOR_NODES];
    for (dem_index slot = r->first[a->nodes[CONTACT_PAIR_NODE]]; next_push(s, r, &slot, x, &push);) {
        anchor_turn_push(&push, ratio, x, friction);
        for (int which = 0; which < ANCHOR_NODES; which++) {
            const dem_index node = push.pair->nodes[which];
            vec2_put(forces, node, vec2_add(vec2_at(forces, node), friction[which]));
        }
    }
}

void anchor_set_add_forces(const anchor_set *s, const pair_rows *r, const double *x, double *forces)
{
    for (dem_index k = 0; k < s->n; k++) add_friction(s, r, &s->list[k], x, forces);
}

void anchor_set_add_energy(const anchor_set *s, const pair_rows *r, const double *x, exact_sum *sum)
{
    for (dem_index k = 0; k < s->n; k++) {
        const vec2 normal = normal_of(s, r, &s->list[k], x);
        if (is_force(normal)) exact_sum_add(sum, anchor_energy(&s->list[k], normal, x));
    }
}

/* Friction is proportional to T/N, which is known when all pushes are. */
static double power_of(const anchor_set *s, const pair_rows *r, const anchor *a, const double *x, const double *v)
{
    vec2 normal = {0.0, 0.0}, friction[ANCHOR_NODES];
    double sum = 0.0;
    contact_push push;
    for (dem_index slot = r->first[a->nodes[CONTACT_PAIR_NODE]]; next_push(s, r, &slot, x, &push);) {
        normal = vec2_add(normal, contact_push_on(&push, CONTACT_PAIR_NODE));
        anchor_turn_push(&push, 1.0, x, friction);
        for (int which = 0; which < ANCHOR_NODES; which++)
            sum -= vec2_dot(friction[which], vec2_at(v, push.pair->nodes[which]));
    }
    return is_force(normal) ? anchor_ratio(a, normal, x) * sum : 0.0;
}

double anchor_set_power(const anchor_set *s, const pair_rows *r, const double *x, const double *v)
{
    double sum = 0.0;
    for (dem_index k = 0; k < s->n; k++) sum += power_of(s, r, &s->list[k], x, v);
    return sum;
}

/* ---- moving ---- */

/* What pushes a node: by all edges, and by those of the body on which its anchor is. */
typedef struct node_pushes {
    const contact_pair *most, *most_there; /* the pair that pushes most, of those with friction; NULL: none */
    double size, size_there;               /* N, by it */
    vec2 there;                            /* N, the sum */
} node_pushes;

static void note_push(const anchor_set *s, const contact_pair *p, dem_index body, vec2 force, node_pushes *out)
{
    const dem_index theirs = body_of(s, p->nodes[CONTACT_PAIR_FIRST]);
    const double size = vec2_norm(force);
    if (law_between(s, body_of(s, p->nodes[CONTACT_PAIR_NODE]), theirs).friction <= 0.0) return;
    if (size > out->size) {
        out->size = size;
        out->most = p;
    }
    if (theirs != body) return;
    out->there = vec2_add(out->there, force);
    if (size > out->size_there) {
        out->size_there = size;
        out->most_there = p;
    }
}

/* Of the pairs `first` to `last` - 1, which are those of one node, whose anchor is on the body. */
static node_pushes pushes_of(const anchor_set *s, const contact_pair *list, const dem_index range[2], dem_index body,
                             const double *x)
{
    node_pushes out = {.most = NULL};
    contact_push push;
    for (dem_index k = range[0]; k < range[1]; k++)
        if (contact_pair_push(&list[k], x, &push))
            note_push(s, &list[k], body, contact_push_on(&push, CONTACT_PAIR_NODE), &out);
    return out;
}

static bool has_left(const anchor *a, const double *x)
{
    const double foot = anchor_foot(a, x);
    return foot < -end_margin || foot > 1.0 + end_margin;
}

/* The anchor of a node from its old one, or NULL, and what pushes the node. */
static anchor renew(const anchor_set *s, const anchor *old, const node_pushes *pushes, const double *x)
{
    const contact_pair *most = pushes->most_there;
    const vec2 normal = pushes->there;
    const bool leaves = old != NULL && has_left(old, x) && most->edge != old->edge;
    const double ratio = old != NULL ? anchor_ratio(old, normal, x) : 0.0;
    anchor now = old == NULL || leaves ? make_anchor(s, most->nodes[CONTACT_PAIR_NODE], most->edge) : *old;
    anchor_put(&now, normal, ratio * vec2_norm(normal) / now.stiffness, x);
    return now;
}

/* The old anchor of a node, from `*k` on in the old list, which is ascending by node as nodes come here. */
static const anchor *old_of(const anchor_set *s, dem_index node, dem_index *k)
{
    while (*k < s->n_old && s->old[*k].nodes[CONTACT_PAIR_NODE] < node) ++*k;
    return *k < s->n_old && s->old[*k].nodes[CONTACT_PAIR_NODE] == node ? &s->old[*k] : NULL;
}

static void set_old_aside(anchor_set *s)
{
    anchor *const list = s->list;
    const dem_index n = s->n, capacity = s->capacity;
    anchor_set_clear(s);
    s->list = s->old;
    s->capacity = s->old_capacity;
    s->old = list;
    s->n_old = n;
    s->old_capacity = capacity;
}

/* What pushes the node of the pairs of a range, on the body of its anchor, or where that pushes no more, on the one
 * that pushes most: then *old becomes NULL. */
static node_pushes find_pushes(const anchor_set *s, const contact_pair *list, const dem_index range[2],
                               const anchor **old, const double *x)
{
    const dem_index body = *old != NULL ? body_of(s, (*old)->nodes[CONTACT_PAIR_FIRST]) : -1;
    const node_pushes pushes = pushes_of(s, list, range, body, x);
    if (is_force(pushes.there) || pushes.most == NULL) return pushes;
    *old = NULL;
    return pushes_of(s, list, range, body_of(s, pushes.most->nodes[CONTACT_PAIR_FIRST]), x);
}

dem_status anchor_set_settle(anchor_set *s, const contact_pair *list, dem_index n, const double *x)
{
    dem_index range[2] = {0, 0}, k = 0;
    set_old_aside(s);
    for (; range[0] < n; range[0] = range[1]) {
        const dem_index node = list[range[0]].nodes[CONTACT_PAIR_NODE];
        while (range[1] < n && list[range[1]].nodes[CONTACT_PAIR_NODE] == node) range[1]++;
        const anchor *old = old_of(s, node, &k);
        const node_pushes pushes = find_pushes(s, list, range, &old, x);
        if (!is_force(pushes.there)) continue;
        const anchor now = renew(s, old, &pushes, x);
        TRY(append(s, &now));
    }
    return DEM_OK;
}

/* ---- other edges ---- */

static bool is_on_surfaces(const anchor_set *s, const anchor_record *record)
{
    dem_index ends[2];
    return s->surfaces.ends(s->surfaces.of, record->node, record->edge, ends);
}

dem_status anchor_set_follow_edges(anchor_set *s, dem_index (*edge)(const void *of, dem_index first, dem_index second))
{
    set_old_aside(s);
    for (dem_index k = 0; k < s->n_old; k++) {
        const dem_index *nodes = s->old[k].nodes;
        anchor_record record = record_of(&s->old[k]);
        record.edge = edge(s->surfaces.of, nodes[CONTACT_PAIR_FIRST], nodes[CONTACT_PAIR_SECOND]);
        if (is_on_surfaces(s, &record)) TRY(append_recorded(s, &record));
    }
    return DEM_OK;
}

/* ---- records ---- */

anchor_record anchor_set_record(const anchor_set *s, dem_index k)
{
    return record_of(&s->list[k]);
}

static bool is_possible(const anchor_set *s, const anchor_record *a)
{
    const double size = hypot(a->direction[0], a->direction[1]);
    const bool in_place = a->weight >= 0.0 && a->weight <= 1.0 && fabs(size - 1.0) < 1e-9;
    const bool is_finite = isfinite(a->place[0]) && isfinite(a->place[1]) && isfinite(a->shift);
    return in_place && is_finite && is_on_surfaces(s, a);
}

/* Nothing that comes from a file is trusted. */
dem_status anchor_set_restore(anchor_set *s, const anchor_record *list, dem_index n)
{
    for (dem_index k = 0; k < n; k++)
        CHECK(is_possible(s, &list[k]) && (k == 0 || list[k - 1].node < list[k].node), DEM_ERROR_IO,
              "anchor %lld of the checkpoint is impossible: node %lld on edge %lld", (long long)k,
              (long long)list[k].node, (long long)list[k].edge);
    anchor_set_clear(s);
    for (dem_index k = 0; k < n; k++) TRY(append_recorded(s, &list[k]));
    return DEM_OK;
}
