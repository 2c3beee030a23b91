/* SPDX-License-Identifier: BSD-3-Clause */
/* Of the entries of a checkpoint only the state differs from rank to rank: rows of nodes, and behind them quadratures,
 * which all ranks have alike; and what is broken, of which all have the same by other numbers. */
#include "simulation/shared_checkpoint.h"

#include <stdlib.h>
#include <string.h>

#include "base/checkpoint_entries.h"
#include "base/reduce.h"
#include "base/status.h"
#include "domain/gather.h"
#include "simulation/shared_breaks.h"

static const char entry[] = "state";

/* The state of the whole, in place of that of a part. */
static dem_status make_state(dem_checkpoint *checkpoint, const state_layout *of, double **out)
{
    void *bytes;
    const size_t size = (size_t)state_size(of) * sizeof **out;
    TRY(checkpoint_entries_make(checkpoint, entry, size, &bytes));
    *out = memset(bytes, 0, size);
    return DEM_OK;
}

dem_status shared_checkpoint_gather(const dem_simulation *s, dem_checkpoint *checkpoint)
{
    const dem_model *m = s->model;
    const state_layout *of = &s->shared.whole;
    const bool is_root = m->ranks->rank == 0;
    const double *v = s->y + state_velocities(&s->layout);
    const gather_items nodes = gather_nodes(m->domain);
    const size_t row = (size_t)of->dim * sizeof *v;
    double *whole = NULL;
    dem_status status = is_root ? make_state(checkpoint, of, &whole) : DEM_OK;
    status = reduce_status(m->ranks, status, 0.0);
    if (status == DEM_OK) status = gather_rows(m->ranks, &nodes, row, s->y, whole);
    if (status == DEM_OK) status = gather_rows(m->ranks, &nodes, row, v, is_root ? whole + state_velocities(of) : NULL);
    if (status == DEM_OK && is_root) {
        state_copy_quadratures(whole, of, s->y, &s->layout);
        status = shared_breaks_expand(s, checkpoint);
    }
    return reduce_status(m->ranks, status, 0.0);
}

/* The rows of all nodes here. */
static dem_status cut_state(const dem_simulation *s, dem_checkpoint *part)
{
    const domain *d = s->model->domain;
    const state_layout *of = &s->shared.whole;
    const size_t n = (size_t)state_size(&s->layout), expected = (size_t)state_size(of) * sizeof(double);
    const size_t row = (size_t)of->dim * sizeof(double);
    size_t size;
    const double *whole = dem_checkpoint_find(part, entry, &size);
    CHECK(whole != NULL && size == expected, DEM_ERROR_IO, "the checkpoint has %zu bytes of state, %zu are expected",
          size, expected);
    double *y = calloc(n, sizeof *y), *v = y + state_velocities(&s->layout);
    CHECK(y != NULL, DEM_ERROR_MEMORY, "out of memory for a checkpoint");
    for (dem_index i = 0; i < d->n_nodes; i++) {
        memcpy(y + of->dim * i, whole + of->dim * d->number[i], row);
        memcpy(v + of->dim * i, whole + state_velocities(of) + of->dim * d->number[i], row);
    }
    state_copy_quadratures(y, &s->layout, whole, of);
    const dem_status status = dem_checkpoint_put(part, entry, y, n * sizeof *y);
    free(y);
    return status;
}

dem_status shared_checkpoint_scatter(const dem_simulation *s, const dem_checkpoint *whole, dem_checkpoint *part)
{
    const ranks *r = s->model->ranks;
    TRY(reduce_status(r, r->rank == 0 ? checkpoint_entries_copy(part, whole) : DEM_OK, 0.0));
    TRY(checkpoint_entries_share(r, whole, part));
    TRY(reduce_status(r, cut_state(s, part), 0.0));
    return reduce_status(r, shared_breaks_cut(s, part), 0.0);
}
