/* SPDX-License-Identifier: BSD-3-Clause */
#include "page_content.h"

#include <stdlib.h>
#include <string.h>

#include "choice.h"
#include "snapshot.h"
#include "strip.h"

static bool fail_memory(outcome *o)
{
    outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory");
    return false;
}

/* ---- frames and quantities ---- */

static bool find_frames(page_content *p, outcome *o)
{
    dem_index n;
    (void)dem_reader_times(p->reader, &n);
    if (!choice_find(&p->frames, p->reader, p->asked, o)) return false;
    if (p->frames.n == 0 && !frame_list_all(&p->frames, n)) return fail_memory(o);
    p->n_asked = p->frames.n;
    return true;
}

static void add_quantity(page_content *p, const quantity *q)
{
    const dem_lattice *l = p->lattice;
    page_quantity *added = &p->quantity[p->n_quantities++];
    *added = (page_quantity){.shown = *q};
    added->fills = quantity_fills_triangles(q, l);
    added->n_cells = (size_t)(added->fills ? l->n_triangles : l->n_springs);
}

/* Whether the file has the k-th, and the lattice what it is of. */
static bool has_quantity(const page_content *p, size_t k, quantity *q)
{
    return quantity_at(q, p->reader, k) && (!q->source->of_springs || p->lattice->n_springs > 0);
}

/* The one asked for, else the first of nodes where that fills triangles or there are no springs, else the first of
 * all. */
static bool find_first(page_content *p, outcome *o)
{
    quantity q;
    if (p->asked->color == NULL && (p->lattice->n_triangles > 0 || p->lattice->n_springs == 0))
        for (size_t k = 0; k < QUANTITY_KNOWN; k++)
            if (has_quantity(p, k, &q) && !q.source->of_springs) return add_quantity(p, &q), true;
    if (!quantity_find(&q, p->reader, p->asked->color, o)) return false;
    add_quantity(p, &q);
    return true;
}

static bool find_quantities(page_content *p, outcome *o)
{
    quantity q;
    if (!find_first(p, o)) return false;
    for (size_t k = 0; k < QUANTITY_KNOWN; k++)
        if (has_quantity(p, k, &q) && strcmp(q.name, p->quantity[0].shown.name) != 0) add_quantity(p, &q);
    p->n_found = p->n_quantities;
    return true;
}

static bool find_bare(page_content *p, outcome *o)
{
    p->is_bare = malloc((size_t)p->lattice->n_nodes);
    if (p->is_bare == NULL) return fail_memory(o);
    p->n_bare = (size_t)snapshot_bare(p->lattice, p->is_bare);
    return true;
}

static bool find_history(page_content *p, outcome *o)
{
    const dem_reader_column *column = dem_reader_column_find(p->reader, "history", "t");
    if (column == NULL || column->n_rows == 0) return true;
    p->history = timeline_open(p->reader, p->asked->input, o);
    if (p->history == NULL) return false;
    p->n_rows = p->history->n;
    return true;
}

bool page_content_open(page_content *p, const dem_reader *reader, const request *asked, outcome *o)
{
    *p = (page_content){.reader = reader, .lattice = dem_reader_lattice(reader), .asked = asked};
    return find_frames(p, o) && find_quantities(p, o) && find_bare(p, o) && find_history(p, o);
}

void page_content_close(page_content *p)
{
    frame_list_free(&p->frames);
    timeline_close(p->history);
    free(p->is_bare);
    free(p->box);
    *p = (page_content){0};
}

void page_content_thin(page_content *p, size_t n)
{
    const size_t all = p->frames.n;
    if (n >= all) return;
    for (size_t k = 0; k < n; k++) {
        const size_t from = n > 1 ? (k * (all - 1) + (n - 1) / 2) / (n - 1) : 0;
        p->frames.frame[k] = p->frames.frame[from];
    }
    p->frames.n = n;
}

bool page_content_draws(const page_content *p, bool fills)
{
    size_t k = 0;
    while (k < p->n_quantities && p->quantity[k].fills != fills) k++;
    return k < p->n_quantities;
}

/* ---- what the frames have in common ---- */

static bool survey_quantity(page_content *p, page_quantity *q, box *bodies, outcome *o)
{
    snapshot s;
    colour_range_extent reach = colour_range_extent_none();
    bool good = snapshot_create(&s, p->reader, &q->shown, o);
    for (size_t k = 0; k < p->frames.n && good; k++) {
        good = snapshot_load(&s, p->frames.frame[k], o);
        if (!good) break;
        p->box[k] = s.bounds;
        *bodies = box_join(*bodies, s.bounds);
        reach = colour_range_extent_join(reach, s.reach);
    }
    snapshot_free(&s);
    const request all_values = {.has_range = false};
    q->range = choice_range(q == p->quantity ? p->asked : &all_values, q->shown.scale, reach);
    return good;
}

bool page_content_survey(page_content *p, outcome *o)
{
    box bodies = box_empty();
    p->box = malloc(p->frames.n * sizeof *p->box);
    if (p->box == NULL) return fail_memory(o);
    for (size_t k = 0; k < p->n_quantities; k++)
        if (!survey_quantity(p, &p->quantity[k], &bodies, o)) return false;
    p->view = p->asked->has_zoom ? p->asked->zoom : strip_view_of_all(bodies, p->reader);
    return true;
}
