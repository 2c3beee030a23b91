/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces, energy and stiffness of all contact pairs, and what a step has to fulfil. Each pair is evaluated by itself
 * (contact_pair.c), and each node sums its pairs in the order of (node, edge), beginning with 0, and then its anchors:
 * so neither threads nor lists have a part in the bits. */
#include "surface_contact/surface_contact.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/exact_sum.h"
#include "base/sorted.h"
#include "base/status.h"

/* Over the mean edge: of the list of candidates, of close pairs, and of the pairs that are near in a step. */
static const double usual_margin = 0.5, usual_close_margin = 0.15, near_margin = 0.05;

/* ---- what anchors ask of the surface ---- */

static dem_index body_of(const void *of, dem_index node)
{
    return contact_surface_body(of, node);
}

static surface_law law_between(const void *of, dem_index body, dem_index other)
{
    return contact_surface_law(of, body, other);
}

static double half_length_of(const void *of, dem_index node)
{
    const contact_surface *s = of;
    return s->half_length[sorted_find(s->nodes, s->n_nodes, node)];
}

static void copy_places(const void *of, const double *x, double *to)
{
    const contact_surface *s = of;
    for (dem_index k = 0; k < s->n_nodes; k++) vec2_put(to, s->nodes[k], vec2_at(x, s->nodes[k]));
}

static anchor_surfaces surfaces_of(const contact_surface *s)
{
    return (anchor_surfaces){.of = contact_surface_has_friction(s) ? s : NULL,
                             .n_nodes = s->lattice->n_nodes,
                             .body = body_of,
                             .law = law_between,
                             .half_length = half_length_of,
                             .copy = copy_places};
}

/* ---- creation ---- */

static dem_status compile_surface(contact_surface *out, const dem_lattice *lattice, const surface_contact_rule *rule)
{
    if (rule->part == NULL) return contact_surface_compile(out, lattice, rule->thickness, rule->stiffness);
    return contact_surface_compile_part(out, lattice, rule->part, rule->thickness, rule->stiffness);
}

static dem_status set_up(surface_contact *c, const dem_lattice *lattice, const surface_contact_rule *rule)
{
    const double margin = rule->margin > 0.0 ? rule->margin : usual_margin;
    TRY(compile_surface(&c->surface, lattice, rule));
    TRY(compact_pairs_create(&c->compact, lattice->n_nodes));
    TRY(pair_rows_create(&c->near, lattice->n_nodes));
    c->near_margin = near_margin * c->surface.mean_length;
    TRY(pair_list_create(&c->candidates, &c->surface, rule->within_bodies, margin * c->surface.mean_length));
    c->rows = &c->candidates.pairs;
    close_pairs_create(&c->close, &c->surface, &c->candidates.pairs);
    contact_surface_set_friction(&c->surface, rule->friction, rule->body_friction);
    const anchor_surfaces surfaces = surfaces_of(&c->surface);
    TRY(anchor_set_create(&c->anchors, &surfaces));
    return pair_list_count_left_out(&c->candidates, &c->n_left_out);
}

dem_status surface_contact_create(surface_contact **out, const dem_lattice *lattice, const surface_contact_rule *rule)
{
    surface_contact *c = calloc(1, sizeof *c);
    CHECK_MEMORY(c);
    const dem_status status = set_up(c, lattice, rule);
    if (status == DEM_OK)
        *out = c;
    else
        surface_contact_destroy(c);
    return status;
}

void surface_contact_destroy(surface_contact *c)
{
    if (c == NULL) return;
    pair_list_destroy(&c->candidates);
    anchor_set_destroy(&c->anchors);
    close_pairs_destroy(&c->close);
    pair_rows_destroy(&c->near);
    contact_surface_free_outline(&c->before);
    contact_surface_free(&c->surface);
    compact_pairs_destroy(&c->compact);
    surface_stages_destroy(&c->stages);
    free(c->is_near);
    free(c);
}

/* ---- lists ---- */

void surface_contact_forget(surface_contact *c)
{
    c->close.chosen = c->is_evaluated = false;
    c->candidates.made = false;
}

/* Another surface has other pairs. */
static void take_surface(surface_contact *c, const contact_surface *next)
{
    c->surface = *next;
    pair_list_clear(&c->candidates);
    close_pairs_clear(&c->close);
    compact_pairs_clear(&c->compact);
    pair_rows_clear(&c->near);
    c->rows = &c->candidates.pairs;
    c->is_evaluated = false;
}

dem_status surface_contact_break(surface_contact *c, const mesh_boundary *boundary, const unsigned char *broken,
                                 const double *x)
{
    contact_surface next;
    TRY(contact_surface_break(&next, &c->surface, boundary, broken, x));
    c->before = c->surface;
    c->left_out_before = c->n_left_out;
    take_surface(c, &next);
    return pair_list_count_left_out(&c->candidates, &c->n_left_out);
}

void surface_contact_keep(surface_contact *c)
{
    contact_surface_free_outline(&c->before);
    c->before = (contact_surface){0};
}

void surface_contact_mend(surface_contact *c)
{
    if (c->before.lattice == NULL) return;
    const contact_surface before = c->before;
    contact_surface_free_outline(&c->surface);
    c->before = (contact_surface){0};
    c->n_left_out = c->left_out_before;
    take_surface(c, &before);
}

/* As long as the close pairs hold, the candidates hold for what is near in a step, too: they are made anew while they
 * still have the margins of both to spare. */
static dem_status renew_lists(surface_contact *c, const double *x)
{
    approach_bound_lose(&c->bound);
    const double margin = c->candidates.margin, most = fmax(0.5 * (margin - c->near_margin), 0.0);
    const double close = fmin(usual_close_margin * c->surface.mean_length, most);
    c->close.chosen = false;
    TRY(pair_list_follow(&c->candidates, x, fmin((close + c->near_margin) / margin, 1.0)));
    TRY(close_pairs_choose(&c->close, close, x));
    const dem_status status = compact_pairs_take(&c->compact, c->close.list, c->close.n);
    c->close.chosen = status == DEM_OK;
    return status;
}

/* One list that has found no memory must not be forgotten when the next one finds some. */
static dem_status note_status(surface_contact *c, dem_status status)
{
    if (c->status != DEM_ERROR_MEMORY) c->status = status;
    return status;
}

/* With these single nodes are evaluated, of a state that is not evaluated yet. */
static void use_candidates(surface_contact *c)
{
    c->rows = &c->candidates.pairs;
    c->is_evaluated = false;
}

dem_status surface_contact_follow(surface_contact *c, const double *x)
{
    use_candidates(c);
    return note_status(c, close_pairs_hold(&c->close, x) ? DEM_OK : renew_lists(c, x));
}

/* ---- looks that are not needed ---- */

/* How far nodes may move relative to each other from positions x on, m. The lists are chosen anew where half of their
 * margin is gone, so that the bound holds for some steps.  \return false if a pair is close, or there is no memory */
static bool find_way_left(surface_contact *c, const double *x, double *left)
{
    if (!c->close.chosen || c->close.n > 0) return false;
    *left = c->close.margin - surface_ways_longest(&c->close.ways, x);
    if (*left >= 0.5 * c->close.margin) return true;
    use_candidates(c);
    if (note_status(c, renew_lists(c, x)) != DEM_OK || c->close.n > 0) return false;
    *left = c->close.margin;
    return true;
}

void surface_contact_bound_step(surface_contact *c, const double *x, const double *v)
{
    double left;
    if (approach_bound_begin_step(&c->bound) && find_way_left(c, x, &left))
        approach_bound_note(&c->bound, left, surface_ways_spread(&c->close.ways, v));
}

/* Whether there are no close pairs, and none since they were chosen. */
static bool is_apart(surface_contact *c)
{
    return c->close.chosen && c->close.n == 0 && approach_bound_holds(&c->bound);
}

static dem_status follow_if_near(surface_contact *c, const double *x)
{
    use_candidates(c);
    return is_apart(c) ? DEM_OK : surface_contact_follow(c, x);
}

/* ---- forces ---- */

static inline void add_at(double *at, vec2 force)
{
    vec2_put(at, 0, vec2_add(vec2_at(at, 0), force));
}

static void add_force(surface_contact *c, dem_index node, vec2 force)
{
    add_at(c->compact.force + compact_pairs_row(&c->compact, node), force);
}

static void add_push(surface_contact *c, const contact_push *push, const double *x)
{
    for (int which = 0; which < CONTACT_PAIR_PUSHED; which++)
        add_force(c, push->pair->nodes[which], contact_push_on(push, which));
    if (c->anchors.now.n > 0) anchor_set_hold(&c->anchors, push, x);
}

/* As add_push() of contact_batch_edge_push(). */
static inline void add_edge_push(double *restrict force, const contact_batch *restrict b, int k)
{
    const compact_pair *p = contact_batch_compact(b, k);
    const double size = p->weight * b->pressure[k], share = b->share[k];
    const vec2 on_node = vec2_scale(size, (vec2){b->n_x[k], b->n_y[k]});
    add_at(force + p->rows[CONTACT_PAIR_NODE], on_node);
    add_at(force + p->rows[CONTACT_PAIR_FIRST], vec2_scale(share - 1.0, on_node));
    add_at(force + p->rows[CONTACT_PAIR_SECOND], vec2_scale(-share, on_node));
}

/* \return how near the pair is, over the thickness */
static double add_push_near_end(surface_contact *c, const contact_batch *b, int k, const double *x)
{
    contact_push push;
    if (contact_batch_push(b, k, x, &push)) add_push(c, &push, x);
    return contact_batch_nearness(b, k, x);
}

static void hold_edge_push(surface_contact *c, const contact_batch *b, int k, const double *x)
{
    const contact_push push = contact_batch_edge_push(b, k);
    anchor_set_hold(&c->anchors, &push, x);
}

/* The pairs of a batch, most of which are far from the ends of their edge. */
static void add_pushes(surface_contact *c, const contact_batch *b, const double *x)
{
    const bool has_anchors = c->anchors.now.n > 0;
    double *force = c->compact.force, nearest = c->nearest;
    for (int k = 0; k < b->n; k++) {
        const bool is_alone = contact_batch_is_edge_alone(b, k);
        if (is_alone) add_edge_push(force, b, k);
        if (is_alone && has_anchors) hold_edge_push(c, b, k, x);
        const double u = is_alone ? b->u[k] : add_push_near_end(c, b, k, x);
        if (u < nearest) nearest = u;
    }
    c->nearest = nearest;
}

/* Friction comes behind the pairs. */
static void add_friction(surface_contact *c, const double *x)
{
    const anchor_set *anchors = &c->anchors;
    anchor_set_end(&c->anchors, x);
    for (dem_index k = 0; k < anchors->n_held; k++) {
        const friction_pattern *friction = &anchors->held[k].friction;
        for (int which = 0; which < CONTACT_PAIR_NODES; which++)
            add_force(c, friction->nodes[which], friction->at[which]);
    }
}

bool surface_contact_evaluate(surface_contact *c, const double *x)
{
    if (follow_if_near(c, x) != DEM_OK) return false;
    compact_pairs_clear_forces(&c->compact);
    if (note_status(c, anchor_set_begin(&c->anchors, c->close.n)) != DEM_OK) return false;
    contact_batch batch;
    c->nearest = 1.0;
    compact_pairs_read(&c->compact, x);
    contact_batch_begin(&batch, &c->compact, 1.0);
    while (contact_batch_next(&batch)) {
        contact_batch_evaluate(&batch);
        add_pushes(c, &batch, x);
    }
    add_friction(c, x);
    c->is_evaluated = true;
    return true;
}

/* Without close pairs nothing pushes for as long as they hold. If half of their margin is gone they are chosen anew, as
 * a step by bands is in vain when they do not last. */
bool surface_contact_begin_stages(surface_contact *c, const double *x, int n_stages)
{
    if (!c->close.chosen || !surface_ways_within(&c->close.ways, 0.5 * c->close.margin, x)) {
        use_candidates(c);
        if (note_status(c, renew_lists(c, x)) != DEM_OK) return false;
    }
    approach_bound_forget(&c->bound);
    return c->close.n == 0 && surface_stages_begin(&c->stages, &c->close.ways, n_stages);
}

void surface_contact_take_stage(surface_contact *c, int stage, const dem_index range[2], const double *x)
{
    surface_stages_take(&c->stages, &c->close.ways, stage, range, x);
}

bool surface_contact_stayed_apart(const surface_contact *c, int n_stages)
{
    bool apart = true;
    for (int k = 0; k < n_stages && apart; k++)
        apart = surface_stages_within(&c->stages, &c->close.ways, k, c->close.margin);
    return apart;
}

bool surface_contact_force(const surface_contact *c, dem_index i, const double *x, vec2 *force)
{
    const pair_rows *r = c->rows;
    contact_push push;
    *force = (vec2){0.0, 0.0};
    for (dem_index slot = r->first[i]; slot >= 0; slot = r->next[slot]) {
        const int which = pair_rows_which(slot);
        if (which >= CONTACT_PAIR_PUSHED || !contact_pair_push(pair_rows_pair(r, slot), x, &push)) continue;
        *force = vec2_add(*force, contact_push_on(&push, which));
    }
    anchor_set_add_force(&c->anchors, r, i, x, force);
    return surface_contact_acts(*force);
}

/* ---- friction ---- */

vec2 surface_contact_friction(const surface_contact *c, dem_index i, const double *x)
{
    vec2 force = {0.0, 0.0};
    anchor_set_add_force(&c->anchors, c->rows, i, x, &force);
    return force;
}

double surface_contact_stored(const surface_contact *c, const double *x)
{
    exact_sum sum = {0};
    anchor_set_add_energy(&c->anchors, c->rows, x, &sum);
    return exact_sum_value(&sum);
}

double surface_contact_friction_power(const surface_contact *c, const double *x, const double *v)
{
    const contact_surface *s = &c->surface;
    exact_sum power = {0};
    exact_terms terms;
    exact_terms_begin(&terms, &power);
    for (dem_index k = 0; k < s->n_nodes; k++)
        exact_terms_add(&terms, -vec2_dot(surface_contact_friction(c, s->nodes[k], x), vec2_at(v, s->nodes[k])));
    exact_terms_end(&terms);
    return exact_sum_value(&power);
}

double surface_contact_evaluated_power(const surface_contact *c, const double *v)
{
    exact_sum power = {0};
    anchor_set_add_held_power(&c->anchors, v, &power);
    return exact_sum_value(&power);
}

dem_status surface_contact_settle(surface_contact *c, const double *x)
{
    TRY(surface_contact_follow(c, x));
    return anchor_set_settle(&c->anchors, c->close.list, c->close.n, x);
}

dem_status surface_contact_restore(surface_contact *c, const anchor_record *records, dem_index n, const double *x)
{
    TRY(surface_contact_follow(c, x));
    return anchor_set_restore(&c->anchors, records, n, c->close.list, c->close.n, x);
}

/* ---- energy and stiffness ---- */

double surface_contact_energy(const surface_contact *c, const double *x)
{
    exact_sum sum = {0};
    for (dem_index k = 0; k < c->rows->n; k++) exact_sum_add(&sum, contact_pair_energy(&c->rows->list[k], x));
    return exact_sum_value(&sum);
}

double surface_contact_node_energy(const surface_contact *c, dem_index i, const double *x)
{
    const pair_rows *r = c->rows;
    double sum = 0.0;
    for (dem_index slot = r->first[i]; slot >= 0; slot = r->next[slot])
        sum += contact_pair_energy(pair_rows_pair(r, slot), x);
    return sum;
}

/* A vertex that is taken off pushes nothing away, but comes with an edge that does. */
surface_gaps surface_contact_gaps(const surface_contact *c, const double *x)
{
    surface_gaps out = {.least = INFINITY, .least_share = INFINITY};
    contact_push push;
    for (dem_index k = 0; k < c->rows->n; k++) {
        const contact_pair *p = &c->rows->list[k];
        if (p->fills || !contact_pair_push(p, x, &push)) continue;
        const double gap = contact_pair_gap(p, x);
        out.pushing++;
        out.least = fmin(out.least, gap);
        out.least_share = fmin(out.least_share, gap / p->thickness);
    }
    return out;
}

/* Sums over the pairs of each node, N/m, are kept where forces are, as their first components.
 * \return the largest of them over the mass, rad^2/s^2 */
static double largest_over_mass(surface_contact *c, const double *inverse_mass)
{
    const compact_pairs *all = &c->compact;
    double largest = 0.0;
    for (dem_index j = 0; j < all->n_nodes; j++)
        largest = fmax(largest, vec2_at(all->force, j).x * inverse_mass[all->nodes[j]]);
    return largest;
}

/* What all close pairs would add with contact_potential_stiffness() = 1, by their edges and their vertices. */
static double unit_stiffening(surface_contact *c, const double *inverse_mass)
{
    static const double terms[CONTACT_PAIR_PUSHED] = {2.0, 2.0, 1.0};
    compact_pairs_clear_forces(&c->compact);
    for (dem_index k = 0; k < c->close.n; k++) {
        const contact_pair *p = &c->close.list[k];
        for (int which = 0; which < CONTACT_PAIR_PUSHED && !p->fills; which++)
            add_force(c, p->nodes[which], (vec2){terms[which] * 2.0 * p->weight / p->thickness, 0.0});
    }
    return largest_over_mass(c, inverse_mass);
}

static void add_stiffness(surface_contact *c, const contact_pair *p, const double *x)
{
    double added[CONTACT_PAIR_PUSHED];
    if (!contact_pair_stiffness(p, x, added)) return;
    for (int which = 0; which < CONTACT_PAIR_PUSHED; which++) add_force(c, p->nodes[which], (vec2){added[which], 0.0});
}

/* What anchors add at a node. */
static void add_anchor(void *to, dem_index node, double stiffness)
{
    add_force(to, node, (vec2){stiffness, 0.0});
}

/* What adds as much however near it is: what fills cracks, and the anchors. */
static double steady_stiffening(surface_contact *c, const double *inverse_mass, const double *x)
{
    const compact_pairs *all = &c->compact;
    if (all->n_fillings == 0 && c->anchors.now.n == 0) return 0.0;
    compact_pairs_clear_forces(&c->compact);
    for (dem_index k = 0; k < all->n && all->n_fillings > 0; k++)
        if (all->list[k].fills) add_stiffness(c, &all->list[k], x);
    anchor_set_add_stiffness(&c->anchors, add_anchor, c);
    return largest_over_mass(c, inverse_mass);
}

/* What the pairs in reach add, and the anchors. */
static double stiffening_within_reach(surface_contact *c, const double *inverse_mass, const double *x)
{
    contact_batch batch;
    compact_pairs_clear_forces(&c->compact);
    contact_batch_begin(&batch, &c->compact, 1.0);
    while (contact_batch_next(&batch))
        for (int k = 0; k < batch.n; k++) add_stiffness(c, contact_batch_pair(&batch, k), x);
    anchor_set_add_stiffness(&c->anchors, add_anchor, c);
    return largest_over_mass(c, inverse_mass);
}

/* Whether the node of any pair is within a part of the contact thickness. */
static bool any_within(const surface_contact *c, double part)
{
    contact_batch batch;
    contact_batch_begin(&batch, &c->compact, part);
    return contact_batch_next(&batch);
}

/* If no pair is nearer than u, all of them add no more than 1/u^2 - 1 times their unit.
 * \return whether they add no more than `most`, rad^2/s^2, to the square of the frequency */
static bool adds_no_more(const surface_contact *c, double most, bool is_evaluated)
{
    const double part = sqrt(c->unit / (c->unit + fmax(most, 0.0)));
    if (c->close.n == 0) return true;
    if (is_evaluated && c->nearest > part) return part < 1.0;
    return part < 1.0 && !any_within(c, part);
}

double surface_contact_stiffening(surface_contact *c, const double *inverse_mass, double harmless, const double *x,
                                  bool is_known)
{
    const bool is_evaluated = is_known && c->is_evaluated;
    if (!is_evaluated && surface_contact_follow(c, x) != DEM_OK) return INFINITY;
    if (!is_evaluated) compact_pairs_read(&c->compact, x);
    c->rows = &c->candidates.pairs;
    if (c->n_chosen != c->close.n_chosen) c->unit = unit_stiffening(c, inverse_mass);
    c->n_chosen = c->close.n_chosen;
    const double steady = steady_stiffening(c, inverse_mass, x);
    return adds_no_more(c, harmless - steady, is_evaluated) ? 0.0 : stiffening_within_reach(c, inverse_mass, x);
}

/* ---- steps ---- */

/* The longest way of a node of the surface from x0 to x1, m. */
static double longest_way(const contact_surface *s, const double *x0, const double *x1)
{
    double square = 0.0;
    for (dem_index k = 0; k < s->n_nodes; k++) {
        const vec2 way = vec2_sub(vec2_at(x1, s->nodes[k]), vec2_at(x0, s->nodes[k]));
        square = fmax(square, vec2_dot(way, way));
    }
    return sqrt(square);
}

/* A pair is near if it is within thickness and margin at an end of the step, or so fast that it might cross. */
static dem_status find_near(surface_contact *c, const double *x0, const double *x1)
{
    const pair_rows *r = &c->candidates.pairs;
    const double fast = r->n > 0 ? 2.0 * longest_way(&c->surface, x0, x1) : 0.0;
    CHECK(grow_array((void **)&c->is_near, &c->near_capacity, r->n, 1), DEM_ERROR_MEMORY,
          "out of memory for %lld contact pairs", (long long)r->n);
    for (dem_index k = 0; k < r->n; k++) {
        const contact_pair *p = &r->list[k];
        const double reach = fmax(p->thickness + c->near_margin, fast);
        c->is_near[k] = contact_pair_gap(p, x0) < reach || contact_pair_gap(p, x1) < reach;
        if (c->is_near[k]) TRY(pair_rows_add(&c->near, p));
    }
    return pair_rows_link(&c->near);
}

dem_status surface_contact_begin_step(surface_contact *c, const double *x0, const double *x1)
{
    TRY(surface_contact_follow(c, x1));
    pair_rows_clear(&c->near);
    TRY(find_near(c, x0, x1));
    c->rows = &c->near;
    return DEM_OK;
}

/* The first crossing of the step counts, and of equal ones that of the first pair. */
static bool find_crossing(const pair_rows *r, const double *x0, const double *x1, surface_crossing *first)
{
    double part;
    first->part = INFINITY;
    for (dem_index k = 0; k < r->n; k++)
        if (contact_pair_crosses(&r->list[k], x0, x1, &part) && part < first->part)
            *first = (surface_crossing){r->list[k], part};
    return first->part <= 1.0;
}

surface_contact_fault surface_contact_check_step(const surface_contact *c, const double *x0, const double *x1,
                                                 surface_crossing *crossing)
{
    const pair_rows *all = &c->candidates.pairs;
    contact_push push;
    if (all->n > 0 && !close_pairs_stay_apart(&c->close, x0, x1) && find_crossing(all, x0, x1, crossing))
        return SURFACE_CONTACT_CROSSED;
    for (dem_index k = 0; k < all->n && c->rows == &c->near; k++)
        if (!c->is_near[k] && contact_pair_push(&all->list[k], x1, &push)) return SURFACE_CONTACT_OUTGROWN;
    return SURFACE_CONTACT_SOUND;
}
