/* SPDX-License-Identifier: BSD-3-Clause */
/* An element is at its limit for the first time between two samples of the step, where the root of 1 - utilisation is
 * found; or it never is at one of the samples, and counts as whole. Samples are taken where they may matter alone, from
 * the middle of the step on. */
#include "fracture/break_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/bracket.h"
#include "base/grow.h"
#include "base/status.h"
#include "fracture/stress_nodes.h"
#include "fracture/utilisation.h"

enum { N_SAMPLES = BREAK_SEARCH_SAMPLES };
enum { NEIGHBOURS = 64 }; /* stresses within a step are those about a tip */

/* Of stresses at the end of the step there is room for four rows of a square body: nodes are numbered row by row, and
 * looks go from row to row. */
dem_status break_search_create(break_search *out, const dem_model *model, const element_state *elements)
{
    const dem_index n = model->lattice.n_nodes;
    break_search s = {.model = model, .elements = elements};
    s.placed = calloc((size_t)n + 1, sizeof *s.placed);
    dem_status status = s.placed != NULL
                            ? stress_cache_create(&s.end, model, elements, (dem_index)sqrt(16.0 * (double)n))
                            : status_fail(DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)n);
    if (status == DEM_OK) status = stress_cache_create(&s.within, model, elements, NEIGHBOURS);
    if (status == DEM_OK) status = stress_stencil_create(&s.stencil, model, elements);
    if (status == DEM_OK)
        *out = s;
    else
        break_search_destroy(&s);
    return status;
}

void break_search_destroy(break_search *s)
{
    stress_cache_destroy(&s->end);
    stress_cache_destroy(&s->within);
    stress_stencil_destroy(s->stencil);
    due_elements_destroy(&s->due);
    free(s->placed);
    free(s->list);
    *s = (break_search){0};
}

void break_search_begin(break_search *s, const dense_output *step, double *state)
{
    s->step = step;
    s->state = state;
    s->t = (double)NAN;
    s->n = 0;
    stress_cache_begin(&s->end, step->y1);
    due_elements_clear(&s->due);
}

void break_search_renew(break_search *s, const dem_index *list, dem_index n)
{
    s->t = (double)NAN;
    for (dem_index j = 0; j < n; j++) stress_cache_forget(&s->end, list[j]);
}

/* ---- utilisations ---- */

enum { MOST_TO_PLACE = 96 };

/* Nodes that are placed together. */
typedef struct nodes_to_place {
    int n;
    int32_t list[MOST_TO_PLACE];
} nodes_to_place;

static void place(const break_search *s, double t, const nodes_to_place *nodes)
{
    dense_output_put_positions(s->step, t, nodes->list, nodes->n, s->state);
}

/* Lists a node unless it is. If there is no room for more, those that are listed are placed. */
static inline void list_node(break_search *s, int32_t node, nodes_to_place *nodes)
{
    if (nodes->n == MOST_TO_PLACE) {
        place(s, s->t, nodes);
        nodes->n = 0;
    }
    nodes->list[nodes->n] = node;
    nodes->n += s->placed[node] != s->look;
    s->placed[node] = s->look;
}

static void place_node(void *self, dem_index node)
{
    break_search *s = self;
    const int32_t list[1] = {(int32_t)node};
    if (s->placed[node] != s->look) dense_output_put_positions(s->step, s->t, list, 1, s->state);
    s->placed[node] = s->look;
}

/* Lists a node and its neighbours. */
static void list_around(break_search *s, dem_index i, nodes_to_place *nodes)
{
    const springs *own = &s->model->springs;
    list_node(s, (int32_t)i, nodes);
    for (dem_index p = own->row[i]; p < own->row[i + 1]; p++) list_node(s, own->neighbour[p], nodes);
}

/* Places what the stresses at the corners of a triangle depend on, but for those that are known. */
static void place_around(break_search *s, const dem_index *corner)
{
    nodes_to_place nodes;
    nodes.n = 0;
    for (int c = 0; c < 3; c++) {
        if (stress_cache_has(&s->within, corner[c])) continue;
        if (s->by_neighbours)
            list_around(s, corner[c], &nodes);
        else
            stress_nodes_visit(s->model, s->elements, corner[c], place_node, s);
    }
    place(s, s->t, &nodes);
}

/* Nothing has been placed. Numbers are so short that marks begin anew with them from time to time, which costs less
 * than wider marks would. */
static void forget_places(break_search *s)
{
    if (++s->look != 0) return;
    memset(s->placed, 0, (size_t)s->model->lattice.n_nodes * sizeof *s->placed);
    s->look = 1;
}

static void go_to(break_search *s, double t)
{
    if (t == s->t) return;
    s->t = t;
    stress_cache_begin(&s->within, s->state);
    forget_places(s);
}

static double utilisation_by(break_search *s, stress_cache *by, dem_index element)
{
    const dem_lattice *l = &s->model->lattice;
    const bool within = by == &s->within, own = utilisation_by_own_stress(l, element);
    const dem_index *corner = &l->triangles[3 * element];
    double stress[3][3];
    if (within) place_around(s, corner);
    for (int c = 0; c < 3 && !own; c++) stress_cache_find(by, corner[c], stress[c]);
    if (own) return utilisation_of(s->model, s->elements, element, within ? s->state : s->step->y1);
    return utilisation_of_stress(utilisation_limits_of(l, s->elements, element), stress[0], stress[1], stress[2]);
}

/* In the step, by its dense output. */
static double utilisation_at(break_search *s, dem_index element, double t)
{
    const dem_lattice *l = &s->model->lattice;
    const dem_index spring = element - l->n_triangles;
    go_to(s, t);
    if (spring < 0) return utilisation_by(s, &s->within, element);
    for (int end = 0; end < 2; end++) place_node(s, l->ends[2 * spring + end]);
    return utilisation_of(s->model, s->elements, element, s->state);
}

static double utilisation_at_end(break_search *s, dem_index element)
{
    const bool is_spring = element >= s->model->lattice.n_triangles;
    return is_spring ? utilisation_of(s->model, s->elements, element, s->step->y1)
                     : utilisation_by(s, &s->end, element);
}

void break_search_stress(break_search *s, dem_index i, double stress[3])
{
    stress_cache_find(&s->end, i, stress);
}

bool break_search_is_over(break_search *s, dem_index element, double t)
{
    return utilisation_at(s, element, t) >= 1.0;
}

/* ---- times ---- */

void break_search_note(break_search *s, dem_index element)
{
    const double end = utilisation_at_end(s, element);
    if (!(end >= BREAK_SEARCH_NEAR)) return;
    if (!grow_array((void **)&s->list, &s->capacity, s->n + 1, sizeof *s->list)) {
        s->due.status = status_fail(DEM_ERROR_MEMORY, "out of memory for elements that break");
        return;
    }
    break_candidate *new = &s->list[s->n++];
    new->element = element;
    for (int k = 0; k < N_SAMPLES; k++) new->margin[k] = (double)NAN;
    new->margin[N_SAMPLES] = 1.0 - end;
}

/* An element that is asked for at many times. */
typedef struct searched_element {
    dem_index element;
    bool is_listed;       /* the stencil has its corners, of which the stresses are what drives it */
    nodes_to_place nodes; /* on which these depend */
} searched_element;

/* Whether the corners of a triangle and all their neighbours can be placed together. */
static bool has_room(const break_search *s, const dem_index *corner)
{
    const int32_t *row = s->model->springs.row;
    dem_index n = 0;
    for (int c = 0; c < 3; c++) n += 1 + row[corner[c] + 1] - row[corner[c]];
    return n <= MOST_TO_PLACE;
}

/* Lists what is needed for its utilisations, if it can be listed. */
static void list_element(break_search *s, dem_index element, searched_element *out)
{
    const dem_lattice *l = &s->model->lattice;
    out->element = element;
    out->nodes.n = 0;
    out->is_listed = false;
    if (!s->by_neighbours || element >= l->n_triangles || utilisation_by_own_stress(l, element)) return;
    const dem_index *corner = &l->triangles[3 * element];
    if (!has_room(s, corner) || stress_stencil_list(s->stencil, corner, 3) < 3) return;
    out->is_listed = true;
    s->t = (double)NAN;
    forget_places(s);
    for (int c = 0; c < 3; c++) list_around(s, corner[c], &out->nodes);
}

/* utilisation_at(), to the same bits. */
static double utilisation_of_searched(break_search *s, const searched_element *e, double t)
{
    const stress_stencil_node *corner = s->stencil->node;
    if (!e->is_listed) return utilisation_at(s, e->element, t);
    s->t = (double)NAN; /* what was placed at another time is no more */
    place(s, t, &e->nodes);
    if (!stress_stencil_find(s->stencil, s->state)) return utilisation_at(s, e->element, t);
    const utilisation_limits limits = utilisation_limits_of(&s->model->lattice, s->elements, e->element);
    return utilisation_of_stress(limits, corner[0].stress, corner[1].stress, corner[2].stress);
}

/* s. The first sample is at `from`, the last one at the end of the step. */
static double sample_time(const break_search *s, double from, int k)
{
    return k == N_SAMPLES ? s->step->t1 : from + (s->step->t1 - from) * k / N_SAMPLES;
}

static void sample(break_search *s, const searched_element *e, break_candidate *c, double from, int k)
{
    if (isnan(c->margin[k])) c->margin[k] = 1.0 - utilisation_of_searched(s, e, sample_time(s, from, k));
}

/* Leaves out what is below its limit at the end of the step, and grows. */
static void drop_growing(break_search *s, double from)
{
    const double t = sample_time(s, from, N_SAMPLES - 1);
    dem_index n = 0;
    for (dem_index j = 0; j < s->n; j++) {
        break_candidate *c = &s->list[j];
        const bool ends_below = c->margin[N_SAMPLES] > 0.0;
        if (ends_below) c->margin[N_SAMPLES - 1] = 1.0 - utilisation_at(s, c->element, t);
        if (ends_below && !(c->margin[N_SAMPLES - 1] < c->margin[N_SAMPLES])) continue;
        s->list[n++] = *c;
    }
    s->n = n;
}

/* Whether an element may be at its limit between two samples at which it is not: by how much it may be nearer than the
 * straight line between them goes with the square of the time between them (see BREAK_SEARCH_NEAR), and as s (1 - s)
 * within it. */
static bool may_rise_between(const break_candidate *c, int first, int last)
{
    const double part = (double)(last - first) / N_SAMPLES, rise = 4.0 * (1.0 - BREAK_SEARCH_NEAR) * part * part;
    const double from = c->margin[first], nearest = 0.5 - 0.5 * (c->margin[last] - from) / rise;
    return nearest > 0.0 && nearest < 1.0 && from < rise * nearest * nearest;
}

/* The first sample at which an element is known to be at its limit; N_SAMPLES + 1: none. */
static int first_over(const break_candidate *c)
{
    int k = 0;
    while (k <= N_SAMPLES && !(c->margin[k] <= 0.0)) k++;
    return k;
}

/* Takes the samples in the middle of intervals of two times `stride` where the limit may be reached in these. */
static void halve(break_search *s, const searched_element *e, break_candidate *c, double from, int stride)
{
    for (int k = stride; k < N_SAMPLES; k += 2 * stride) {
        const int first = k - stride, last = k + stride, over = first_over(c);
        if (over <= first || isnan(c->margin[first]) || isnan(c->margin[last])) continue;
        if (over == last || may_rise_between(c, first, last)) sample(s, e, c, from, k);
    }
}

/* The root of 1 - utilisation, above 0 at the sample before and not above 0 at this one; what is at its limit from the
 * start needs no search. */
static double root(break_search *s, const searched_element *e, const break_candidate *c, double from, int over)
{
    if (over == 0) return from;
    const double width = dense_output_resolution(s->step);
    bracket b = {
        sample_time(s, from, over - 1), sample_time(s, from, over), c->margin[over - 1], c->margin[over], 0, 0};
    while (b.after - b.before > width) {
        const double t = bracket_trial(&b, width), margin = 1.0 - utilisation_of_searched(s, e, t);
        bracket_close(&b, t, margin, margin <= 0.0);
    }
    return b.after;
}

/* When an element that has been noted is at its limit. */
static void find_one(break_search *s, break_candidate *c, double from)
{
    searched_element e;
    list_element(s, c->element, &e);
    sample(s, &e, c, from, 0);
    for (int stride = N_SAMPLES / 2; stride > 0; stride /= 2) halve(s, &e, c, from, stride);
    const int over = first_over(c);
    if (over <= N_SAMPLES) due_elements_set(&s->due, c->element, root(s, &e, c, from, over));
}

void break_search_find(break_search *s, double from)
{
    drop_growing(s, from);
    for (dem_index j = 0; j < s->n; j++) find_one(s, &s->list[j], from);
    s->n = 0;
}
