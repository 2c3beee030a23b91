/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces, energy and stiffness of all contact pairs, and what a step has to fulfil. Each pair is evaluated by itself
 * (contact_pair.c), and each node sums its pairs in the order of (node, edge), beginning with 0: so neither threads nor
 * lists have a part in the bits. A node on which no pair acts is left alone. */
#include "surface_contact/surface_contact.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/reduce.h"
#include "base/status.h"

/* Over the mean edge: of the list of candidates, and of the pairs that are near in a step. */
static const double usual_margin = 0.25, near_margin = 0.05;

static dem_status allocate(surface_contact *c, dem_index n)
{
    c->pushed = malloc((size_t)n * sizeof *c->pushed);
    c->force = calloc(2 * (size_t)n, sizeof *c->force);
    c->is_pushed = calloc((size_t)n, 1);
    CHECK(c->pushed && c->force && c->is_pushed, DEM_ERROR_MEMORY, "out of memory for the contact of %lld nodes",
          (long long)n);
    return pair_rows_create(&c->near, n);
}

static dem_status set_up(surface_contact *c, const dem_lattice *lattice, const surface_contact_rule *rule)
{
    const double margin = rule->margin > 0.0 ? rule->margin : usual_margin;
    TRY(contact_surface_compile(&c->surface, lattice, rule->thickness, rule->stiffness));
    TRY(allocate(c, lattice->n_nodes));
    c->near_margin = near_margin * c->surface.mean_length;
    TRY(pair_list_create(&c->candidates, &c->surface, rule->within_bodies, margin * c->surface.mean_length));
    c->rows = &c->candidates.pairs;
    return DEM_OK;
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
    pair_rows_destroy(&c->near);
    contact_surface_free(&c->surface);
    free(c->is_near);
    free(c->pushed);
    free(c->force);
    free(c->is_pushed);
    free(c);
}

/* ---- forces ---- */

dem_status surface_contact_follow(surface_contact *c, const double *x)
{
    c->rows = &c->candidates.pairs;
    return c->status = pair_list_follow(&c->candidates, x, 0.0);
}

static void forget_forces(surface_contact *c)
{
    for (dem_index k = 0; k < c->n_pushed; k++) {
        vec2_put(c->force, c->pushed[k], (vec2){0.0, 0.0});
        c->is_pushed[c->pushed[k]] = 0;
    }
    c->n_pushed = 0;
}

static void add_force(surface_contact *c, dem_index node, vec2 force)
{
    if (!c->is_pushed[node]) c->pushed[c->n_pushed++] = node;
    c->is_pushed[node] = 1;
    vec2_put(c->force, node, vec2_add(vec2_at(c->force, node), force));
}

bool surface_contact_evaluate(surface_contact *c, const double *x)
{
    const pair_rows *r = &c->candidates.pairs;
    contact_push push;
    forget_forces(c);
    if (surface_contact_follow(c, x) != DEM_OK) return false;
    for (dem_index k = 0; k < r->n; k++)
        if (contact_pair_push(&r->list[k], x, &push))
            for (int which = 0; which < CONTACT_PAIR_BEFORE; which++)
                add_force(c, r->list[k].nodes[which], contact_push_on(&push, which));
    return true;
}

bool surface_contact_force(const surface_contact *c, dem_index i, const double *x, vec2 *force)
{
    const pair_rows *r = c->rows;
    bool is_pushed = false;
    contact_push push;
    *force = (vec2){0.0, 0.0};
    for (dem_index slot = r->first[i]; slot >= 0; slot = r->next[slot]) {
        const int which = pair_rows_which(slot);
        if (which == CONTACT_PAIR_BEFORE || !contact_pair_push(pair_rows_pair(r, slot), x, &push)) continue;
        *force = vec2_add(*force, contact_push_on(&push, which));
        is_pushed = true;
    }
    return is_pushed;
}

/* ---- energy and stiffness ---- */

double surface_contact_energy(const surface_contact *c, const double *x)
{
    exact_sum sum = {0};
    for (dem_index k = 0; k < c->rows->n; k++) exact_sum_add(&sum, contact_pair_energy(&c->rows->list[k], x));
    return reduce_sum(&sum);
}

double surface_contact_node_energy(const surface_contact *c, dem_index i, const double *x)
{
    const pair_rows *r = c->rows;
    double sum = 0.0;
    for (dem_index slot = r->first[i]; slot >= 0; slot = r->next[slot])
        sum += contact_pair_energy(pair_rows_pair(r, slot), x);
    return sum;
}

static double distance_at(const contact_pair *p, const double *x)
{
    return contact_pair_distance(vec2_at(x, p->nodes[CONTACT_PAIR_NODE]), vec2_at(x, p->nodes[CONTACT_PAIR_FIRST]),
                                 vec2_at(x, p->nodes[CONTACT_PAIR_SECOND]));
}

/* A vertex that is taken off pushes nothing away, but comes with an edge that does. */
surface_gaps surface_contact_gaps(const surface_contact *c, const double *x)
{
    surface_gaps out = {.least = INFINITY, .least_share = INFINITY};
    contact_push push;
    for (dem_index k = 0; k < c->rows->n; k++) {
        const contact_pair *p = &c->rows->list[k];
        if (!contact_pair_push(p, x, &push)) continue;
        const double gap = distance_at(p, x);
        out.pushing++;
        out.least = fmin(out.least, gap);
        out.least_share = fmin(out.least_share, gap / p->thickness);
    }
    return out;
}

/* Sums over the pairs of each node, N/m, are kept where forces are, as their first components. */
double surface_contact_stiffening(surface_contact *c, const double *inverse_mass, const double *x)
{
    const pair_rows *r = &c->candidates.pairs;
    double largest = 0.0, added[CONTACT_PAIR_NODES];
    forget_forces(c);
    if (surface_contact_follow(c, x) != DEM_OK) return INFINITY;
    for (dem_index k = 0; k < r->n; k++)
        if (contact_pair_stiffness(&r->list[k], x, added))
            for (int which = 0; which < CONTACT_PAIR_BEFORE; which++)
                add_force(c, r->list[k].nodes[which], (vec2){added[which], 0.0});
    for (dem_index j = 0; j < c->n_pushed; j++)
        largest = fmax(largest, vec2_at(c->force, c->pushed[j]).x * inverse_mass[c->pushed[j]]);
    forget_forces(c);
    return largest;
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
        c->is_near[k] = distance_at(p, x0) < reach || distance_at(p, x1) < reach;
        if (c->is_near[k]) TRY(pair_rows_add(&c->near, p));
    }
    return pair_rows_link(&c->near);
}

/* The list must hold at the end of the step with what makes a pair near to spare. */
dem_status surface_contact_begin_step(surface_contact *c, const double *x0, const double *x1)
{
    TRY(pair_list_follow(&c->candidates, x1, fmin(c->near_margin / c->candidates.margin, 1.0)));
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
    if (find_crossing(&c->near, x0, x1, crossing)) return SURFACE_CONTACT_CROSSED;
    for (dem_index k = 0; k < all->n; k++)
        if (!c->is_near[k] && contact_pair_push(&all->list[k], x1, &push)) return SURFACE_CONTACT_OUTGROWN;
    return SURFACE_CONTACT_SOUND;
}
