/* SPDX-License-Identifier: BSD-3-Clause */
/* Which anchors there are. Of the pairs of a node those count that push it, in their order, and that are with the
 * surface of the body on which the anchor is. After a step
 * - an anchor goes when nothing of that body pushes its node any more;
 * - a node without one gets one on the body whose edge pushes it most, with T_0 = 0;
 * - T_0 is the friction of the state, and g_0 and x_0 are those of the state.
 * None of this changes a force. The law of one anchor is in anchor.c. */
#include "surface_contact/anchor_set.h"

#include <math.h>
#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

static const double spring_share = 0.1; /* of the weight of a node over the thickness: stiffness of its spring */

static dem_status allocate(anchor_set *s, dem_index n)
{
    s->of = malloc((size_t)n * sizeof *s->of);
    s->x0 = calloc(2 * (size_t)n, sizeof *s->x0);
    CHECK(s->of && s->x0, DEM_ERROR_MEMORY, "out of memory for the friction of %lld nodes", (long long)n);
    for (dem_index i = 0; i < n; i++) s->of[i] = -1;
    return DEM_OK;
}

dem_status anchor_set_create(anchor_set *out, const anchor_surfaces *surfaces)
{
    *out = (anchor_set){.surfaces = *surfaces};
    return anchor_set_has_friction(out) ? allocate(out, surfaces->n_nodes) : DEM_OK;
}

static void free_list(anchor_list *l)
{
    free(l->at);
    free(l->patterns);
}

void anchor_set_destroy(anchor_set *s)
{
    free_list(&s->now);
    free_list(&s->before);
    free(s->of);
    free(s->x0);
    free(s->held);
    *s = (anchor_set){0};
}

/* ---- lists ---- */

static void clear_list(anchor_list *l)
{
    l->n = l->n_patterns = 0;
}

void anchor_set_clear(anchor_set *s)
{
    for (dem_index k = 0; k < s->now.n; k++) s->of[s->now.at[k].node] = -1;
    clear_list(&s->now);
}

static void set_aside(anchor_set *s)
{
    const anchor_list now = s->now;
    anchor_set_clear(s);
    s->now = s->before;
    s->before = now;
    clear_list(&s->now);
}

static dem_status append(anchor_set *s, const anchor *a)
{
    anchor_list *l = &s->now;
    CHECK(grow_array((void **)&l->at, &l->capacity, l->n + 1, sizeof *l->at), DEM_ERROR_MEMORY,
          "out of memory for %lld anchors", (long long)l->n + 1);
    s->of[a->node] = l->n;
    l->at[l->n++] = *a;
    return DEM_OK;
}

static dem_status append_pattern(anchor_list *l, const friction_pattern *pattern)
{
    CHECK(grow_array((void **)&l->patterns, &l->pattern_capacity, l->n_patterns + 1, sizeof *l->patterns),
          DEM_ERROR_MEMORY, "out of memory for the friction of %lld contact pairs", (long long)l->n_patterns + 1);
    l->patterns[l->n_patterns++] = *pattern;
    return DEM_OK;
}

static dem_index body_of(const anchor_set *s, dem_index node)
{
    return s->surfaces.body(s->surfaces.of, node);
}

/* The body of the edge of a pair. */
static dem_index body_of_edge(const anchor_set *s, const contact_pair *p)
{
    return body_of(s, p->nodes[CONTACT_PAIR_FIRST]);
}

static surface_law law_of_node(const anchor_set *s, dem_index node, dem_index body)
{
    return s->surfaces.law(s->surfaces.of, body_of(s, node), body);
}

/* ---- one anchor ---- */

const anchor *anchor_set_of_pair(const anchor_set *s, const contact_pair *p)
{
    const dem_index k = s->now.n > 0 ? s->of[p->nodes[CONTACT_PAIR_NODE]] : -1;
    return k >= 0 && !p->fills && body_of_edge(s, p) == s->now.at[k].body ? &s->now.at[k] : NULL;
}

/* g_0.(x - x_0), m, of an anchor of a list. */
static double way_before(const anchor_set *s, const anchor_list *l, const anchor *a, const double *x)
{
    double sum = 0.0;
    for (dem_index k = a->first; k < a->last; k++) sum += friction_pattern_way(&l->patterns[k], s->x0, x);
    return sum;
}

/* What is known of a load when all pushes are: these, and P.(x - x_0), J. */
typedef struct load_sums {
    node_push push;
    double work;
} load_sums;

static node_push push_on_node(const contact_push *push, const double *x)
{
    return (node_push){contact_push_on(push, CONTACT_PAIR_NODE), contact_push_size(push, x)};
}

static node_push add_pushes(node_push a, node_push b)
{
    return (node_push){vec2_add(a.force, b.force), a.size + b.size};
}

static void add_load(load_sums *sums, node_push push, double work)
{
    sums->push = add_pushes(sums->push, push);
    sums->work += work;
}

/* S */
static double press_of(node_push push)
{
    return fmax(vec2_norm(push.force), push.size);
}

/* With (g_0 + g).(x - x_0)/2, g = P/S. */
static anchor_load load_of(const load_sums *sums, double before)
{
    const double press = press_of(sums->push), now = press > 0.0 ? sums->work / press : 0.0;
    return (anchor_load){.press = press, .way = 0.5 * (before + now)};
}

/* ---- all of them ---- */

dem_status anchor_set_begin(anchor_set *s, dem_index n)
{
    s->n_held = 0;
    CHECK(s->now.n == 0 || grow_array((void **)&s->held, &s->held_capacity, n, sizeof *s->held), DEM_ERROR_MEMORY,
          "out of memory for the friction of %lld contact pairs", (long long)n);
    return DEM_OK;
}

void anchor_set_hold(anchor_set *s, const contact_push *push, const double *x)
{
    const anchor *a = anchor_set_of_pair(s, push->pair);
    if (a != NULL)
        s->held[s->n_held++] = (held_push){
            .anchor = a - s->now.at, .on_node = push_on_node(push, x), .friction = friction_pattern_make(push, x)};
}

/* The patterns of the pushes of one node become friction. */
static void turn(const anchor_set *s, held_push *held, dem_index n, const double *x)
{
    const anchor *a = &s->now.at[held->anchor];
    load_sums sums = {.work = 0.0};
    for (dem_index k = 0; k < n; k++)
        add_load(&sums, held[k].on_node, friction_pattern_way(&held[k].friction, s->x0, x));
    const anchor_load load = load_of(&sums, way_before(s, &s->now, a, x));
    const double ratio = anchor_ratio(a, &load);
    for (dem_index k = 0; k < n; k++) held[k].friction = friction_pattern_scale(-ratio, &held[k].friction);
}

void anchor_set_end(anchor_set *s, const double *x)
{
    for (dem_index first = 0, last = 0; first < s->n_held; first = last) {
        while (last < s->n_held && s->held[last].anchor == s->held[first].anchor) last++;
        turn(s, s->held + first, last - first, x);
    }
}

void anchor_set_add_held_power(const anchor_set *s, const double *v, exact_sum *power)
{
    for (dem_index k = 0; k < s->n_held; k++) exact_sum_add(power, -friction_pattern_dot(&s->held[k].friction, v));
}

static double size_of(const friction_pattern *p)
{
    double sum = 0.0;
    for (int which = 0; which < CONTACT_PAIR_NODES; which++) sum += vec2_norm(p->at[which]);
    return sum;
}

void anchor_set_add_stiffness(const anchor_set *s, void (*add)(void *to, dem_index node, double stiffness), void *to)
{
    for (dem_index j = 0; j < s->now.n; j++) {
        const anchor *a = &s->now.at[j];
        const friction_pattern *patterns = s->now.patterns;
        double size = 0.0;
        for (dem_index k = a->first; k < a->last; k++) size += size_of(&patterns[k]);
        for (dem_index k = a->first; k < a->last; k++)
            for (int which = 0; which < CONTACT_PAIR_NODES; which++)
                add(to, patterns[k].nodes[which], a->stiffness * size * vec2_norm(patterns[k].at[which]));
    }
}

/* ---- some of them ---- */

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

static anchor_load load_at(const anchor_set *s, const pair_rows *r, const anchor *a, const double *x)
{
    load_sums sums = {.work = 0.0};
    contact_push push;
    for (dem_index slot = r->first[a->node]; next_push(s, r, &slot, x, &push);) {
        const friction_pattern pattern = friction_pattern_make(&push, x);
        add_load(&sums, push_on_node(&push, x), friction_pattern_way(&pattern, s->x0, x));
    }
    return load_of(&sums, way_before(s, &s->now, a, x));
}

double anchor_set_ratio(const anchor_set *s, const pair_rows *r, const anchor *a, const double *x)
{
    const anchor_load load = load_at(s, r, a, x);
    return anchor_ratio(a, &load);
}

void anchor_set_add_force(const anchor_set *s, const pair_rows *r, dem_index i, const double *x, vec2 *force)
{
    contact_push push;
    for (dem_index slot = s->now.n > 0 ? r->first[i] : -1; slot >= 0; slot = r->next[slot]) {
        const contact_pair *p = pair_rows_pair(r, slot);
        const anchor *a = anchor_set_of_pair(s, p);
        if (a == NULL || !contact_pair_push(p, x, &push)) continue;
        const friction_pattern pattern = friction_pattern_make(&push, x);
        *force = vec2_add(*force, vec2_scale(-anchor_set_ratio(s, r, a, x), pattern.at[pair_rows_which(slot)]));
    }
}

void anchor_set_add_energy(const anchor_set *s, const pair_rows *r, const double *x, exact_sum *sum)
{
    for (dem_index k = 0; k < s->now.n; k++) {
        const anchor_load load = load_at(s, r, &s->now.at[k], x);
        exact_sum_add(sum, anchor_energy(&s->now.at[k], &load));
    }
}

/* ---- after a step ---- */

/* The pairs of one node. */
typedef struct node_pairs {
    const contact_pair *list;
    dem_index n;
} node_pairs;

/* Whether a body pushes the node of the pairs. */
static bool is_pushed_by(const anchor_set *s, const node_pairs *of, dem_index body, const double *x)
{
    node_push sum = {.size = 0.0};
    contact_push push;
    for (dem_index k = 0; k < of->n; k++)
        if (body_of_edge(s, &of->list[k]) == body && contact_pair_push(&of->list[k], x, &push))
            sum = add_pushes(sum, push_on_node(&push, x));
    return press_of(sum) > 0.0;
}

/* The body whose edge pushes the node most, of those with friction; -1: none. */
static dem_index find_body(const anchor_set *s, const node_pairs *of, const double *x)
{
    dem_index out = -1;
    double most = 0.0;
    contact_push push;
    for (dem_index k = 0; k < of->n; k++) {
        const contact_pair *p = &of->list[k];
        const dem_index body = body_of_edge(s, p);
        if (law_of_node(s, p->nodes[CONTACT_PAIR_NODE], body).friction <= 0.0) continue;
        const double size = contact_pair_push(p, x, &push) ? vec2_norm(contact_push_on(&push, CONTACT_PAIR_NODE)) : 0.0;
        if (size > most) {
            most = size;
            out = body;
        }
    }
    return out;
}

/* An anchor of a node on a body as it is before anything pulls. */
static anchor make_anchor(const anchor_set *s, dem_index node, dem_index body)
{
    const surface_law law = law_of_node(s, node, body);
    const double half_length = s->surfaces.half_length(s->surfaces.of, node);
    return (anchor){.node = node,
                    .body = body,
                    .stiffness = spring_share * half_length * law.modulus / law.thickness,
                    .friction = law.friction,
                    .first = s->now.n_patterns};
}

/* Takes down the patterns of the pairs by which the body of an anchor pushes its node.
 * \param[out] sums  of the load */
static dem_status take_patterns(anchor_set *s, anchor *a, const node_pairs *of, const double *x, load_sums *sums)
{
    contact_push push;
    for (dem_index k = 0; k < of->n; k++) {
        if (body_of_edge(s, &of->list[k]) != a->body || !contact_pair_push(&of->list[k], x, &push)) continue;
        const friction_pattern pattern = friction_pattern_make(&push, x);
        add_load(sums, push_on_node(&push, x), friction_pattern_way(&pattern, s->x0, x));
        TRY(append_pattern(&s->now, &pattern));
    }
    a->last = s->now.n_patterns;
    return DEM_OK;
}

/* Friction of an anchor after the step, N. `old` is what it was before. */
static double force_after(const anchor_set *s, const anchor *now, const anchor *old, const load_sums *sums,
                          const double *x)
{
    const anchor_load load = load_of(sums, way_before(s, &s->before, old, x));
    anchor a = *now;
    a.force = old->force;
    return anchor_force(&a, &load);
}

/* Appends the anchor of a node on a body that pushes it. `old` is the one that it had there; NULL: none. */
static dem_status renew(anchor_set *s, const anchor *old, dem_index body, const node_pairs *of, const double *x)
{
    anchor now = make_anchor(s, of->list->nodes[CONTACT_PAIR_NODE], body);
    load_sums sums = {.work = 0.0};
    TRY(take_patterns(s, &now, of, x, &sums));
    if (old != NULL) now.force = force_after(s, &now, old, &sums, x);
    const double press = press_of(sums.push);
    friction_pattern *patterns = s->now.patterns;
    for (dem_index k = now.first; k < now.last; k++) patterns[k] = friction_pattern_scale(1.0 / press, &patterns[k]);
    return append(s, &now);
}

/* The anchor that a node had, from `*k` on in that list, which is ascending by node as nodes come here; or NULL. */
static const anchor *old_of(const anchor_set *s, dem_index node, dem_index *k)
{
    const anchor_list *l = &s->before;
    while (*k < l->n && l->at[*k].node < node) ++*k;
    return *k < l->n && l->at[*k].node == node ? &l->at[*k] : NULL;
}

/* The pairs of the node of pair k of a list. What fills cracks has no friction; it is behind all others. */
static node_pairs pairs_from(const contact_pair *list, dem_index n, dem_index k)
{
    dem_index last = k;
    while (last < n && !list[last].fills && list[last].nodes[CONTACT_PAIR_NODE] == list[k].nodes[CONTACT_PAIR_NODE])
        last++;
    return (node_pairs){list + k, last - k};
}

dem_status anchor_set_settle(anchor_set *s, const contact_pair *list, dem_index n, const double *x)
{
    dem_index at_old = 0;
    set_aside(s);
    for (dem_index k = 0; k < n && !list[k].fills;) {
        const node_pairs of = pairs_from(list, n, k);
        const anchor *old = old_of(s, of.list->nodes[CONTACT_PAIR_NODE], &at_old);
        if (old != NULL && !is_pushed_by(s, &of, old->body, x)) old = NULL;
        const dem_index body = old != NULL ? old->body : find_body(s, &of, x);
        if (old != NULL || is_pushed_by(s, &of, body, x)) TRY(renew(s, old, body, &of, x));
        k += of.n;
    }
    if (s->now.n > 0) s->surfaces.copy(s->surfaces.of, x, s->x0);
    return DEM_OK;
}

/* ---- records ---- */

anchor_record anchor_set_record(const anchor_set *s, dem_index k)
{
    const anchor *a = &s->now.at[k];
    return (anchor_record){a->node, a->body, a->force};
}

static dem_status refuse(const anchor_record *record)
{
    return status_fail(DEM_ERROR_IO, "the checkpoint has an impossible friction: %g N at node %lld by body %lld",
                       record->force, (long long)record->node, (long long)record->body);
}

/* Whether anchors are those that have been found for the state. Nothing that comes from a file is trusted. */
static dem_status compare(const anchor_set *s, const anchor_record *records, dem_index n)
{
    CHECK(s->now.n == n, DEM_ERROR_IO, "the checkpoint has friction at %lld nodes, but %lld are pushed", (long long)n,
          (long long)s->now.n);
    for (dem_index k = 0; k < n; k++)
        if (records[k].node != s->now.at[k].node || records[k].body != s->now.at[k].body) return refuse(&records[k]);
    return DEM_OK;
}

static dem_status append_recorded(anchor_set *s, const anchor_record *records, dem_index k)
{
    const dem_index node = records[k].node, least = k > 0 ? records[k - 1].node + 1 : 0;
    const anchor a = {.node = node, .body = records[k].body, .force = records[k].force};
    if (node < least || node >= s->surfaces.n_nodes || !isfinite(a.force)) return refuse(&records[k]);
    return append(s, &a);
}

/* As those of a step in which nothing has moved, so that T_0 stays what it was. */
dem_status anchor_set_restore(anchor_set *s, const anchor_record *records, dem_index n, const contact_pair *list,
                              dem_index n_pairs, const double *x)
{
    anchor_set_clear(s);
    for (dem_index k = 0; k < n; k++) TRY(append_recorded(s, records, k));
    s->surfaces.copy(s->surfaces.of, x, s->x0);
    TRY(anchor_set_settle(s, list, n_pairs, x));
    return compare(s, records, n);
}
