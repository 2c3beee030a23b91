/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes are shared out anew at a checkpoint, when the peaks are those that it has. */
#include "simulation/slab_migration.h"

#include <stdlib.h>

#include "base/status.h"

static dem_status begin_state(slab_migration *out, const dem_simulation *part, const double *y)
{
    const state_layout *of = &part->layout;
    const gather_items nodes = gather_nodes(part->model->domain);
    const size_t row = (size_t)of->dim * sizeof *y;
    out->layout = state_layout_without_nodes(of);
    out->quadratures = calloc((size_t)state_size(&out->layout), sizeof *out->quadratures);
    CHECK_MEMORY(out->quadratures);
    state_copy_quadratures(out->quadratures, &out->layout, y, of);
    TRY(migration_begin(&out->state[0], &nodes, row, y));
    return migration_begin(&out->state[1], &nodes, row, y + state_velocities(of));
}

static dem_status begin_peaks(slab_migration *out, const dem_model *m, const shared_peaks *peaks)
{
    const gather_items of_nodes = gather_nodes(m->domain), of_springs = gather_springs(m->domain, &m->lattice);
    for (int k = 0; k < OBSERVERS_MOST; k++) {
        const dem_peaks *p = peaks->part[k];
        if (p == NULL) continue;
        TRY(migration_begin(&out->nodes[k], &of_nodes, sizeof *p->nodes, p->nodes));
        TRY(migration_begin(&out->springs[k], &of_springs, sizeof *p->springs, p->springs));
    }
    return DEM_OK;
}

dem_status slab_migration_begin(slab_migration *out, const dem_simulation *part, const double *y,
                                const shared_peaks *peaks)
{
    *out = (slab_migration){0};
    TRY(begin_state(out, part, y));
    return begin_peaks(out, part->model, peaks);
}

void slab_migration_free(slab_migration *m)
{
    for (int k = 0; k < 2; k++) migration_free(&m->state[k]);
    for (int k = 0; k < OBSERVERS_MOST; k++) {
        migration_free(&m->nodes[k]);
        migration_free(&m->springs[k]);
    }
    free(m->quadratures);
    m->quadratures = NULL;
}

dem_status slab_migration_end_state(slab_migration *m, const dem_simulation *s, double *y)
{
    const ranks *r = s->model->ranks;
    const gather_items nodes = gather_nodes(s->model->domain);
    TRY(migration_end(&m->state[0], r, &nodes, y));
    TRY(migration_end(&m->state[1], r, &nodes, y + state_velocities(&s->layout)));
    state_copy_quadratures(y, &s->layout, m->quadratures, &m->layout);
    return DEM_OK;
}

dem_status slab_migration_end_peaks(slab_migration *m, const dem_model *part, shared_peaks *peaks)
{
    for (int k = 0; k < OBSERVERS_MOST; k++)
        if (m->nodes[k].size > 0) TRY(shared_peaks_migrate(peaks, part, k, &m->nodes[k], &m->springs[k]));
    return DEM_OK;
}
