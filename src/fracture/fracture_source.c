/* SPDX-License-Identifier: BSD-3-Clause */
/* Fracture as a source of events (docs/method.md, Fracture). begin() looks at the end of the step where springs are
 * strained (strain_filter.c) and nodes stressed enough, and searches the step for elements that are at their limit
 * there or nearly so; a list holds the times at which they break. What breaks at the same time, to the width of a root,
 * breaks together. After an event the elements near it are looked at again. A break changes the stresses beside it at
 * once: what is then over its limit breaks at the same instant. undo() mends what has broken in the step, to the bit.
 * Surfaces follow at the end of the step (simulation/breaking.c): new ones cannot touch anything within it. */
#include "fracture/fracture_source.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"
#include "fracture/utilisation.h"
#include "model/node_stress.h"

/* ---- set-up ---- */

/* What the kernel is given is not kept: its limits of blocks are all that is asked. */
static dem_status watch(fracture_source *s)
{
    element_state whole;
    TRY(element_state_create(&whole, &s->model->lattice, &s->model->springs));
    const dem_status status = strain_filter_create(&s->filter, s->model, &whole, BREAK_SEARCH_NEAR);
    element_state_destroy(&whole);
    TRY(status);
    s->search.by_neighbours = s->filter.have_edges;
    TRY(kernel_watch(s->kernel, s->filter.threshold));
    strain_filter_forget_thresholds(&s->filter);
    return DEM_OK;
}

static dem_status allocate(fracture_source *s)
{
    const dem_lattice *l = &s->model->lattice;
    s->asked = calloc((size_t)l->n_nodes + 1, sizeof *s->asked);
    s->seen = calloc((size_t)l->n_triangles + 1, sizeof *s->seen);
    s->failing = calloc(1, sizeof *s->failing);
    CHECK(s->asked && s->seen && s->failing, DEM_ERROR_MEMORY, "out of memory for the stresses of %lld nodes",
          (long long)l->n_nodes);
    TRY(break_search_create(&s->search, s->model, s->elements));
    return watch(s);
}

dem_status fracture_source_create(fracture_source *out, const dem_model *model, element_state *elements,
                                  exact_sum *taken, dem_index most, kernel *by)
{
    fracture_source s = {.model = model, .elements = elements, .taken = taken, .kernel = by};
    s.most = most >= 0 ? most : utilisation_n_elements(&model->lattice);
    const dem_status status = allocate(&s);
    if (status == DEM_OK)
        *out = s;
    else
        fracture_source_destroy(&s);
    return status;
}

void fracture_source_destroy(fracture_source *s)
{
    break_search_destroy(&s->search);
    if (s->failing != NULL) failing_elements_destroy(s->failing);
    free(s->failing);
    strain_filter_destroy(&s->filter);
    free(s->asked);
    free(s->seen);
    free(s->failed);
    free(s->broken);
    break_list_destroy(&s->breaks);
    *s = (fracture_source){0};
}

static dem_status refuse(const fracture_source *s, dem_index element, double utilisation)
{
    const dem_lattice *l = &s->model->lattice;
    const dem_index spring = element - l->n_triangles;
    const dem_index node = spring >= 0 ? l->ends[2 * spring] : l->triangles[3 * element];
    const double limit = spring >= 0 ? l->critical_stretch[spring] : l->strength[element], *x = &l->position[2 * node];
    const domain *d = s->model->domain; /* all ranks have what may break, by numbers of their own */
    const long long named = spring >= 0 ? domain_spring(d, spring) : domain_triangle(d, element);
    const int body = l->body != NULL ? l->body[node] : 0;
    if (spring >= 0)
        return status_fail(DEM_ERROR_MODEL,
                           "spring %lld of body %d at (%g, %g) m has the strain %g at the start, beyond its critical "
                           "stretch %g",
                           named, body, x[0], x[1], utilisation * limit, limit);
    if (l->compressive_strength != NULL && isfinite(l->compressive_strength[element]))
        return status_fail(DEM_ERROR_MODEL,
                           "triangle %lld of body %d at (%g, %g) m is at %g times what it stands at the start, by its "
                           "strength %g Pa and its compressive strength %g Pa",
                           named, body, x[0], x[1], utilisation, limit, l->compressive_strength[element]);
    return status_fail(DEM_ERROR_MODEL,
                       "triangle %lld of body %d at (%g, %g) m has the stress %g Pa at the start, beyond its strength "
                       "%g Pa",
                       named, body, x[0], x[1], utilisation * limit, limit);
}

/* What is broken already is not asked. */
static bool is_whole(const fracture_source *s, dem_index element)
{
    const dem_index spring = element - s->model->lattice.n_triangles;
    return spring >= 0 ? !springs_is_broken(element_state_springs(s->elements), spring)
                       : !s->elements->triangle[element];
}

static bool may_break(const fracture_source *s, dem_index element)
{
    return is_whole(s, element) && breakable_element(&s->model->lattice, element);
}

dem_status fracture_source_check_start(const fracture_source *s, const double *x)
{
    for (dem_index e = 0; e < utilisation_n_elements(&s->model->lattice); e++) {
        const double utilisation = may_break(s, e) ? utilisation_of(s->model, s->elements, e, x) : 0.0;
        if (utilisation >= 1.0) return refuse(s, e, utilisation);
    }
    return DEM_OK;
}

/* ---- where to look ---- */

/* Marks of steps are so short that they begin anew from time to time, which costs less than wider ones would. */
static void begin_number(fracture_source *s)
{
    const dem_lattice *l = &s->model->lattice;
    if (++s->number <= FRACTURE_SOURCE_NUMBERS) return;
    memset(s->asked, 0, (size_t)l->n_nodes * sizeof *s->asked);
    memset(s->seen, 0, (size_t)l->n_triangles * sizeof *s->seen);
    s->number = 1;
}

/* Ways in which triangles are looked at, which their marks have beside the number of the step. */
enum { NOTED = 1, ITS_CORNERS = 2, WAYS = 4 };
_Static_assert(WAYS *(FRACTURE_SOURCE_NUMBERS + 1) - 1 <= UINT8_MAX, "marks are bytes");

/* Marks a triangle.  \return whether it is for the first time in the step */
static bool is_first(fracture_source *s, dem_index triangle, unsigned way)
{
    const unsigned before = s->seen[triangle], step = WAYS * s->number,
                   now = before / WAYS == s->number ? before : step;
    s->seen[triangle] = (uint8_t)(now | way);
    return !(now & way);
}

static const double nearly = 0.999 * BREAK_SEARCH_NEAR; /* so that the last digits do not matter */

/* Whether a triangle may be near its limit by the stress at one of its corners: without confinement, which only lowers
 * it, its utilisation is a convex function of the mean of three stresses, and not larger than by each of them in the
 * mean. */
static bool may_be_near(utilisation_limits limits, const double *stress)
{
    limits.confinement = 0.0;
    if (utilisation_is_below(limits, stress, nearly)) return false;
    return !(utilisation_of_stress(limits, stress, stress, stress) < nearly);
}

static void look_at_triangles_of(fracture_source *s, dem_index i, const double *stress)
{
    const element_state *e = s->elements;
    for (dem_index p = e->at_row[i]; p < e->at_row[i + 1]; p++) {
        const dem_index t = e->at[p];
        if (!may_break(s, t) || !may_be_near(utilisation_limits_of(e->lattice, e, t), stress)) continue;
        if (is_first(s, t, NOTED)) break_search_note(&s->search, t);
    }
}

/* The stress of a node says nothing of what its triangles stand by their own. */
static void look_at_own_stresses(fracture_source *s, dem_index i)
{
    const element_state *e = s->elements;
    for (dem_index p = e->at_row[i]; p < e->at_row[i + 1]; p++) {
        const dem_index t = e->at[p];
        if (!utilisation_by_own_stress(e->lattice, t) || !may_break(s, t)) continue;
        if (is_first(s, t, NOTED)) break_search_note(&s->search, t);
    }
}

/* Most nodes are far from what the weakest triangle of all stands. */
static void ask(fracture_source *s, dem_index i)
{
    double stress[3];
    if (s->asked[i] == s->number) return;
    s->asked[i] = s->number;
    if (s->model->lattice.own_stress != NULL) look_at_own_stresses(s, i);
    break_search_stress(&s->search, i, stress);
    if (may_be_near(s->filter.weakest, stress)) look_at_triangles_of(s, i, stress);
}

/* The stress of a node is a mean of those of its triangles: a triangle whose own is far from what the weakest stands
 * brings none of its corners near that. Own stresses are known once something has broken. */
static bool may_bring_near(const fracture_source *s, dem_index triangle)
{
    double stress[3];
    if (s->elements->share == NULL) return true;
    node_stress_of_triangle(s->model, s->elements, triangle, s->step->y1, stress);
    return may_be_near(s->filter.weakest, stress);
}

static void ask_at_corners(fracture_source *s, dem_index triangle)
{
    if (s->elements->triangle[triangle] || !is_first(s, triangle, ITS_CORNERS)) return;
    if (!may_bring_near(s, triangle)) return;
    for (int c = 0; c < 3; c++) ask(s, s->model->lattice.triangles[3 * triangle + c]);
}

/* The corners of triangles that hold the second diagonal of a cell are neighbours of its ends. */
static void ask_all_around(fracture_source *s, dem_index i)
{
    const springs *own = &s->model->springs;
    ask(s, i);
    for (dem_index p = own->row[i]; p < own->row[i + 1]; p++) ask(s, own->neighbour[p]);
}

/* All that a spring over its threshold may bring to its limit: itself, and triangles with a corner at one that holds
 * it. The corners of those are asked for, or have been noted otherwise (strain_filter.c). */
static void look_near(void *self, dem_index i, dem_index slot)
{
    fracture_source *s = self;
    const springs *own = &s->model->springs;
    const element_state *e = s->elements;
    const dem_index element = s->model->lattice.n_triangles + own->spring[slot];
    bool is_edge = false;
    if (s->model->lattice.critical_stretch != NULL && may_break(s, element)) break_search_note(&s->search, element);
    if (s->model->lattice.strength == NULL) return;
    for (dem_index p = e->at_row[i]; p < e->at_row[i + 1]; p++) {
        if (!element_state_is_corner(e, e->at[p], own->neighbour[slot])) continue;
        is_edge = true;
        ask_at_corners(s, e->at[p]);
    }
    if (!is_edge) ask_all_around(s, i);
}

static void look(fracture_source *s)
{
    kernel_visit_strained(s->kernel, s->elements, s->step->y1, look_near, s);
    for (dem_index k = 0; k < s->filter.n_always; k++) ask(s, s->filter.always[k]);
    break_search_find(&s->search, s->step->t0);
}

/* What undo() goes back to. */
static void note_start(fracture_source *s)
{
    s->n_failed = s->breaks.n = 0;
    s->n_damaged = s->elements->n_damaged;
    s->taken_before = *s->taken;
}

static void fracture_source_begin(void *self, const dense_output *step, double *state)
{
    fracture_source *s = self;
    s->step = step;
    begin_number(s);
    break_search_begin(&s->search, step, state);
    s->jumped = false;
    s->looked = (double)NAN;
    note_start(s);
    look(s);
}

static event_due fracture_source_next(const void *self)
{
    const fracture_source *s = self;
    const due_elements *due = &s->search.due;
    if (due->n == 0) return (event_due){(double)INFINITY, 0, -1};
    return (event_due){due->list[0].t, due->list[0].t == s->looked ? s->generation : 0, due->list[0].element};
}

/* ---- what breaks ---- */

/* What nothing has broken of so far has to be made ready for it. */
static void add_failing(const fracture_source *s, dem_index element)
{
    if (s->failing->status == DEM_OK) s->failing->status = element_state_prepare(s->elements);
    if (s->failing->status == DEM_OK) failing_elements_add(s->failing, s->elements, element);
}

/* Adds what is due until t of the part of the list under place p: nothing there is due before it. */
static void collect(const fracture_source *s, dem_index p, double t)
{
    if (p >= s->search.due.n || s->search.due.list[p].t > t) return;
    add_failing(s, s->search.due.list[p].element);
    collect(s, 2 * p + 1, t);
    collect(s, 2 * p + 2, t);
}

/* All that is due at the time of the first, to the width of a root. */
static void find_failing(const fracture_source *s)
{
    failing_elements_clear(s->failing);
    collect(s, 0, due_elements_first(&s->search.due) + dense_output_resolution(s->step));
    failing_elements_complete(s->failing, s->elements);
}

static dem_index fracture_source_seeds(const void *self, dem_index key, dem_index *nodes, dem_index capacity)
{
    const fracture_source *s = self;
    (void)key;
    find_failing(s);
    for (dem_index j = 0; j < s->failing->n_nodes && j < capacity; j++) nodes[j] = s->failing->nodes[j];
    return s->failing->n_nodes;
}

/* Too many breaks in a step mean that it is too long for them. */
static dem_status check_number(const fracture_source *s, double t)
{
    const dem_lattice *l = &s->model->lattice;
    const dem_index n = s->breaks.n + s->failing->n_breaking, first = s->failing->nodes[0];
    CHECK(n <= s->most, DEM_ERROR_INTEGRATOR,
          "%lld triangles and springs break within one step at t = %.9g s, the last of them at (%g, %g) m at rest: "
          "stress may be uniform there, where brittle bodies break everywhere at once",
          (long long)n, t, l->x[2 * first], l->x[2 * first + 1]);
    return DEM_OK;
}

/* Appends what fails to the lists. */
static dem_status note_failing(fracture_source *s, double t, const double *x)
{
    const failing_elements *f = s->failing;
    const dem_index most = s->breaks.n + f->n_breaking;
    CHECK(grow_array((void **)&s->failed, &s->capacity, s->n_failed + f->n, sizeof *s->failed) &&
              grow_array((void **)&s->broken, &s->broken_capacity, most, sizeof *s->broken),
          DEM_ERROR_MEMORY, "out of memory for what breaks in a step");
    for (dem_index k = 0; k < f->n; k++) {
        if (!f->breaks[k]) continue;
        s->broken[s->breaks.n] = f->list[k];
        TRY(break_list_note(&s->breaks, s->model, s->elements, f->list[k], t, x));
    }
    memcpy(s->failed + s->n_failed, f->list, (size_t)f->n * sizeof *s->failed);
    s->n_failed += f->n;
    return DEM_OK;
}

/* Breaks or softens what is due at positions x. Effective stresses jump where something breaks, and what has softened
 * may be over its next limit at once. */
static dem_status break_failing(fracture_source *s, double t, const double *x)
{
    const failing_elements *f = s->failing;
    TRY(f->status);
    TRY(check_number(s, t));
    TRY(note_failing(s, t, x));
    s->jumped = f->n > 0;
    exact_sum_add(s->taken, failing_elements_fail(f, s->model, s->elements, x, &s->breaks));
    return DEM_OK;
}

static void fracture_source_prepare(void *self, const event_place *at)
{
    (void)self;
    (void)at;
}

static dem_status fracture_source_resolve(void *self, dem_index key, const event_place *at,
                                          const event_listener *listener)
{
    (void)key;
    (void)listener;
    return break_failing(self, at->t, at->state);
}

/* ---- what follows ---- */

/* What has jumped may be over its limit at once; all else is searched for when all have been noted. */
static void look_again(fracture_source *s, dem_index element, double t, bool jumped)
{
    const bool may = may_break(s, element), at_once = may && jumped && break_search_is_over(&s->search, element, t);
    due_elements_set(&s->search.due, element, at_once ? t : (double)INFINITY);
    if (may && !at_once) break_search_note(&s->search, element);
}

static void look_at_triangle(fracture_source *s, const event_place *at, dem_index triangle, dem_index node)
{
    const dem_index *corner = &s->model->lattice.triangles[3 * triangle];
    const int32_t *number = at->near->nodes.number; /* the seeds, which are the nodes of what fails, come first */
    bool jumped = false;
    for (int c = 0; c < 3; c++) {
        if (number[corner[c]] >= 0 && number[corner[c]] < number[node]) return; /* it has been looked at there */
        jumped = jumped || (s->jumped && number[corner[c]] >= 0 && number[corner[c]] < s->failing->n_nodes);
    }
    look_again(s, triangle, at->t, jumped);
}

/* Strains do not jump. */
static void look_at_spring(fracture_source *s, const event_place *at, dem_index p)
{
    const springs *all = &s->model->springs;
    look_again(s, s->model->lattice.n_triangles + all->spring[p], at->t, false);
}

/* Nodes that feel the event have another stress at the end of the step, so triangles at them may break otherwise. */
static void fracture_source_follow(void *self, const event_place *at)
{
    fracture_source *s = self;
    const dem_lattice *l = &s->model->lattice;
    const local_nodes *nodes = &at->near->nodes;
    const element_state *e = s->elements;
    const springs *all = &s->model->springs;
    s->looked = at->t;
    s->generation = at->generation + 1;
    break_search_renew(&s->search, nodes->list, nodes->n);
    for (dem_index j = 0; j < at->near->n_felt; j++) {
        const dem_index i = nodes->list[j];
        for (dem_index p = e->at_row[i]; p < e->at_row[i + 1] && l->strength != NULL; p++)
            look_at_triangle(s, at, e->at[p], i);
        for (dem_index p = all->row[i]; p < all->row[i + 1] && l->critical_stretch != NULL; p++)
            if (nodes->number[all->neighbour[p]] < nodes->number[i]) look_at_spring(s, at, p);
    }
    break_search_find(&s->search, at->t);
    s->jumped = false;
}

/* From the last to the first. */
void fracture_source_undo(void *self)
{
    fracture_source *s = self;
    while (s->n_failed > 0) element_state_mend(s->elements, s->failed[--s->n_failed]);
    s->breaks.n = 0;
    element_state_forget_nodes(s->elements, s->n_damaged);
    *s->taken = s->taken_before;
    s->jumped = false;
}

/* ---- where the whole body stops ---- */

double fracture_source_first(fracture_source *s, const dense_output *step, double *state)
{
    fracture_source_begin(s, step, state);
    return due_elements_first(&s->search.due);
}

static void find_over_limit(fracture_source *s, const double *y)
{
    failing_elements_clear(s->failing);
    for (dem_index e = 0; e < utilisation_n_elements(&s->model->lattice); e++)
        if (may_break(s, e) && utilisation_of(s->model, s->elements, e, y) >= 1.0) add_failing(s, e);
    failing_elements_complete(s->failing, s->elements);
}

/* Breaks what fails, and what is over its limit in consequence. */
static dem_status break_all(fracture_source *s, double t, const double *y)
{
    for (; s->failing->n > 0; find_over_limit(s, y)) TRY(break_failing(s, t, y));
    return s->failing->status;
}

dem_status fracture_source_found(const fracture_source *s)
{
    return s->search.due.status;
}

dem_status fracture_source_break(fracture_source *s, const double *y)
{
    find_failing(s);
    return break_all(s, s->step->end, y);
}

dem_status fracture_source_break_at_start(fracture_source *s, double t, const double *y)
{
    note_start(s);
    find_over_limit(s, y);
    return break_all(s, t, y);
}

/* ---- checkpoints ---- */

/* What is broken is in simulation/breaking.c's entries; the rest is found anew at every step. */
static dem_status fracture_source_save(const void *self, dem_checkpoint *checkpoint)
{
    (void)self;
    (void)checkpoint;
    return DEM_OK;
}

static dem_status fracture_source_restore(void *self, const dem_checkpoint *checkpoint, double t, const double *y)
{
    (void)self;
    (void)checkpoint;
    (void)t;
    (void)y;
    return DEM_OK;
}

event_source fracture_source_events(fracture_source *s)
{
    return (event_source){.name = "fracture",
                          .self = s,
                          .changes_forces = true,
                          .begin = fracture_source_begin,
                          .next = fracture_source_next,
                          .seeds = fracture_source_seeds,
                          .prepare = fracture_source_prepare,
                          .resolve = fracture_source_resolve,
                          .follow = fracture_source_follow,
                          .undo = fracture_source_undo,
                          .save = fracture_source_save,
                          .restore = fracture_source_restore};
}
