/* SPDX-License-Identifier: BSD-3-Clause */
/* Of the entries of a checkpoint only the state differs from rank to rank: rows of nodes, and behind them quadratures,
 * which all ranks have alike; and what is broken, of which all have the same by other numbers. */
#include "simulation/shared_checkpoint.h"

#include <string.h>

#include "base/checkpoint_entries.h"
#include "base/reduce.h"
#include "base/status.h"
#include "domain/gather.h"
#include "simulation/shared_breaks.h"

static const char entry[] = "state", quadratures[] = "quadratures";

/* An entry that is a state, at first zero, in place of what there is. */
static dem_status make_state(dem_checkpoint *checkpoint, const char *name, const state_layout *of, double **out)
{
    void *bytes;
    const size_t size = (size_t)state_size(of) * sizeof **out;
    TRY(checkpoint_entries_make(checkpoint, name, size, &bytes));
    *out = memset(bytes, 0, size);
    return DEM_OK;
}

static dem_status gather_state(const dem_simulation *s, dem_checkpoint *checkpoint)
{
    const dem_model *m = s->model;
    const state_layout *of = &s->shared.whole;
    const bool is_root = m->ranks->rank == 0;
    const double *v = s->y + state_velocities(&s->layout);
    const gather_items nodes = gather_nodes(m->domain);
    const size_t row = (size_t)of->dim * sizeof *v;
    double *whole = NULL;
    dem_status status = is_root ? make_state(checkpoint, entry, of, &whole) : DEM_OK;
    status = reduce_status(m->ranks, status, 0.0);
    if (status == DEM_OK) status = gather_rows(m->ranks, &nodes, row, s->y, whole);
    if (status == DEM_OK) status = gather_rows(m->ranks, &nodes, row, v, is_root ? whole + state_velocities(of) : NULL);
    if (status == DEM_OK && is_root) state_copy_quadratures(whole, of, s->y, &s->layout);
    return status;
}

dem_status shared_checkpoint_gather(const dem_simulation *s, dem_checkpoint *checkpoint)
{
    const ranks *r = s->model->ranks;
    if (!s->is_led) TRY(gather_state(s, checkpoint));
    return reduce_status(r, r->rank == 0 ? shared_breaks_expand(s, checkpoint) : DEM_OK, 0.0);
}

const double *shared_checkpoint_state(const dem_simulation *part)
{
    size_t size;
    return dem_checkpoint_find(part->checkpoint, entry, &size);
}

/* ---- the other way round ---- */

/* Names with a point are those of observers, which rank 0 alone has. Rows of nodes go to those who have these. */
static bool is_for_all(const char *name)
{
    return strcmp(name, entry) != 0 && strchr(name, '.') == NULL;
}

/* The quadratures of the whole's state, which may be in a file, as a state of no nodes.
 * \param number  0: those of positions, 1: of velocities */
static dem_status read_quadratures(const state_layout *of, const dem_checkpoint *whole, const state_layout *none,
                                   int number, double *y)
{
    const dem_index n = state_row(of, state_n_quadratures(of));
    const dem_index from = number * state_velocities(of) + state_row(of, state_impulse(of, 0));
    const dem_index to = number * state_velocities(none) + state_row(none, state_impulse(none, 0));
    return checkpoint_entries_read(whole, entry, (size_t)from * sizeof *y, (size_t)n * sizeof *y, y + to);
}

/* On rank 0 what all ranks get: entries, and the quadratures, unless they have them. */
static dem_status choose(const state_layout *of, const dem_checkpoint *whole, bool has_state, dem_checkpoint *part)
{
    const state_layout none = state_layout_without_nodes(of);
    double *y;
    TRY(checkpoint_entries_check(whole, entry, (size_t)state_size(of) * sizeof *y));
    TRY(checkpoint_entries_choose(part, whole, is_for_all));
    if (has_state) return DEM_OK;
    TRY(make_state(part, quadratures, &none, &y));
    for (int number = 0; number < 2; number++) TRY(read_quadratures(of, whole, &none, number, y));
    return DEM_OK;
}

/* The rows of all nodes here. */
static dem_status spread_state(const dem_simulation *s, const dem_checkpoint *whole, const dem_checkpoint *part,
                               double *y)
{
    const ranks *r = s->model->ranks;
    const state_layout *of = &s->shared.whole, none = state_layout_without_nodes(of);
    const gather_items nodes = gather_nodes(s->model->domain);
    const size_t row = (size_t)of->dim * sizeof(double);
    size_t size;
    checkpoint_row_source x = {whole, entry, 0, row}, v = {whole, entry, (size_t)of->n_rows * row, row};
    TRY(gather_back(r, &nodes, row, checkpoint_entries_row_reader, &x, y));
    TRY(gather_back(r, &nodes, row, checkpoint_entries_row_reader, &v, y + state_velocities(&s->layout)));
    state_copy_quadratures(y, &s->layout, dem_checkpoint_find(part, quadratures, &size), &none);
    return DEM_OK;
}

dem_status shared_checkpoint_scatter(const dem_simulation *s, const dem_checkpoint *whole, slab_migration *kept,
                                     dem_checkpoint *part)
{
    const ranks *r = s->model->ranks;
    double *y = NULL;
    TRY(reduce_status(r, r->rank == 0 ? choose(&s->shared.whole, whole, kept != NULL, part) : DEM_OK, 0.0));
    TRY(checkpoint_entries_share(r, part));
    TRY(reduce_status(r, make_state(part, entry, &s->layout, &y), 0.0));
    TRY(kept != NULL ? slab_migration_end_state(kept, s, y) : spread_state(s, whole, part, y));
    return reduce_status(r, shared_breaks_cut(s, part), 0.0);
}
