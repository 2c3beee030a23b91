/* SPDX-License-Identifier: BSD-3-Clause */
/* An element is at its limit for the first time between two samples of the step, where the root of 1 - utilisation is
 * found; or it never is at one of the samples, and counts as whole. */
#include "fracture/break_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/bracket.h"
#include "base/grow.h"
#include "base/status.h"
#include "fracture/utilisation.h"

enum { N_SAMPLES = 8, NEIGHBOURS = 64 }; /* NEIGHBOURS: stresses within a step are those about a tip */

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

static void place(break_search *s, dem_index node)
{
    if (s->placed[node] == s->look) return;
    s->placed[node] = s->look;
    dense_output_position(s->step, s->t, node, s->state + state_row(&s->step->layout, node));
}

/* The nodes on which the stress at node i depends: those of its triangles, and of all springs that these hold. */
static void place_around(break_search *s, dem_index i)
{
    const element_state *e = s->elements;
    const stress_rows *r = s->model->stress.rows;
    place(s, i);
    for (dem_index p = e->at_row[i]; p < e->at_row[i + 1]; p++)
        for (int c = 0; c < 3; c++) place(s, e->lattice->triangles[3 * e->at[p] + c]);
    for (dem_index p = r->row[i]; p < r->row[i + 1]; p++)
        for (int end = 0; end < 2; end++) place(s, e->lattice->ends[2 * r->spring[p] + end]);
}

/* Numbers are so short that marks begin anew with them from time to time, which costs less than wider marks would. */
static void go_to(break_search *s, double t)
{
    if (t == s->t) return;
    s->t = t;
    stress_cache_begin(&s->within, s->state);
    if (++s->look != 0) return;
    memset(s->placed, 0, (size_t)s->model->lattice.n_nodes * sizeof *s->placed);
    s->look = 1;
}

static double utilisation_by(break_search *s, stress_cache *by, dem_index element)
{
    const dem_lattice *l = &s->model->lattice;
    const bool within = by == &s->within, own = utilisation_by_own_stress(l, element);
    double stress[3][3];
    for (int c = 0; c < 3; c++) {
        const dem_index i = l->triangles[3 * element + c];
        if (within && !stress_cache_has(by, i)) place_around(s, i);
        if (!own) stress_cache_find(by, i, stress[c]);
    }
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
    for (int end = 0; end < 2; end++) place(s, l->ends[2 * spring + end]);
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
    if (grow_array((void **)&s->list, &s->capacity, s->n + 1, sizeof *s->list))
        s->list[s->n++] = (break_candidate){.element = element, .end = end};
    else
        s->due.status = status_fail(DEM_ERROR_MEMORY, "out of memory for elements that break");
}

/* The root of 1 - utilisation between two times, above 0 before and not above 0 after. */
static double root(break_search *s, const break_candidate *c)
{
    const double width = dense_output_resolution(s->step);
    bracket b = {c->before, c->after, c->above, c->below, 0, 0};
    while (b.after - b.before > width) {
        const double t = bracket_trial(&b, width), margin = 1.0 - utilisation_at(s, c->element, t);
        bracket_close(&b, t, margin, margin <= 0.0);
    }
    return b.after;
}

/* Leaves out what is below its limit at the end of the step, and grows. */
static void drop_growing(break_search *s, double from)
{
    const double last = s->step->t1 - (s->step->t1 - from) / N_SAMPLES;
    dem_index n = 0;
    for (dem_index k = 0; k < s->n; k++)
        if (s->list[k].end >= 1.0 || utilisation_at(s, s->list[k].element, last) > s->list[k].end)
            s->list[n++] = s->list[k];
    s->n = n;
}

/* What is at its limit from the start needs no search. */
static void look_at_start(break_search *s, break_candidate *c, double from)
{
    c->above = 1.0 - utilisation_at(s, c->element, from);
    c->before = c->after = from;
    c->found = c->above <= 0.0;
}

static void look_at_sample(break_search *s, break_candidate *c, double t, bool last)
{
    const double margin = 1.0 - (last ? c->end : utilisation_at(s, c->element, t));
    c->found = margin <= 0.0;
    if (c->found) {
        c->after = t;
        c->below = margin;
    } else {
        c->before = t;
        c->above = margin;
    }
}

void break_search_find(break_search *s, double from)
{
    const double rest = s->step->t1 - from;
    drop_growing(s, from);
    for (dem_index j = 0; j < s->n; j++) look_at_start(s, &s->list[j], from);
    for (int k = 1; k <= N_SAMPLES; k++)
        for (dem_index j = 0; j < s->n; j++) {
            const double t = k == N_SAMPLES ? s->step->t1 : from + rest * k / N_SAMPLES;
            if (!s->list[j].found) look_at_sample(s, &s->list[j], t, k == N_SAMPLES);
        }
    for (dem_index j = 0; j < s->n; j++)
        if (s->list[j].found) due_elements_set(&s->due, s->list[j].element, root(s, &s->list[j]));
    s->n = 0;
}
