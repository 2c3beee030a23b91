/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts have entries of ghosts, too, which nobody asks for. */
#include "simulation/shared_peaks.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "domain/gather.h"
#include "simulation/private.h"

int shared_peaks_number(const shared_peaks *s, const dem_peaks *whole)
{
    for (int k = 0; k < OBSERVERS_MOST; k++)
        if (s->whole[k] == whole) return k;
    return -1;
}

/* From rank 0 to all, unless there are none yet. */
static dem_status take(const dem_model *m, dem_peaks *whole, dem_peaks *part)
{
    const gather_items of_nodes = gather_nodes(m->domain), of_springs = gather_springs(m->domain, &m->lattice);
    if (!reduce_any(m->ranks, whole != NULL && !whole->is_new)) return DEM_OK;
    TRY(gather_back(m->ranks, &of_nodes, sizeof *part->nodes, peaks_read_nodes, whole, part->nodes));
    return gather_back(m->ranks, &of_springs, sizeof *part->springs, peaks_read_springs, whole, part->springs);
}

/* The other way round, to whom rank 0 has named. */
static dem_status hand_over(const shared_peaks *s, const dem_model *m, const dem_peaks *part, bool of_nodes)
{
    if (of_nodes) {
        const gather_items items = gather_nodes(m->domain);
        return gather_chunks(m->ranks, &items, sizeof *part->nodes, part->nodes, s->take, s->context);
    }
    const gather_items items = gather_springs(m->domain, &m->lattice);
    return gather_chunks(m->ranks, &items, sizeof *part->springs, part->springs, s->take, s->context);
}

static dem_status copy(void **to, const void *from, size_t size)
{
    free(*to);
    *to = malloc(size + 1);
    CHECK(*to != NULL, DEM_ERROR_MEMORY, "out of memory for the peaks of a checkpoint");
    memcpy(*to, from, size);
    return DEM_OK;
}

static dem_status keep(dem_peaks *kept, const dem_peaks *part)
{
    TRY(copy((void **)&kept->nodes, part->nodes, (size_t)part->n_nodes * sizeof *part->nodes));
    return copy((void **)&kept->springs, part->springs, (size_t)part->n_springs * sizeof *part->springs);
}

static void drop_part(dem_peaks **own)
{
    dem_peaks_destroy(*own);
    *own = NULL;
}

/* Without any yet. */
static dem_status renew(dem_peaks **own, const dem_model *m)
{
    drop_part(own);
    return reduce_status(m->ranks, dem_peaks_create(own, m, 1), 0.0);
}

/* All ranks have peaks afterwards, or none. */
static dem_status begin(shared_peaks *s, const dem_model *m, int k)
{
    dem_peaks **own = &s->part[k];
    dem_status status = renew(own, m);
    if (status == DEM_OK) status = take(m, s->whole[k], *own);
    if (status != DEM_OK) drop_part(own);
    return status;
}

static dem_status take_over(const dem_model *m, migrating_rows *of_nodes, migrating_rows *of_springs, dem_peaks *part)
{
    const gather_items here = gather_nodes(m->domain), springs_here = gather_springs(m->domain, &m->lattice);
    TRY(migration_end(of_nodes, m->ranks, &here, part->nodes));
    return migration_end(of_springs, m->ranks, &springs_here, part->springs);
}

dem_status shared_peaks_migrate(shared_peaks *s, const dem_model *m, int k, migrating_rows *of_nodes,
                                migrating_rows *of_springs)
{
    dem_peaks **own = &s->part[k];
    dem_status status = renew(own, m);
    if (status == DEM_OK) status = take_over(m, of_nodes, of_springs, *own);
    if (status == DEM_OK) status = reduce_status(m->ranks, keep(&s->kept[k], *own), 0.0);
    if (status != DEM_OK) drop_part(own);
    return status;
}

dem_status shared_peaks_answer(shared_peaks *s, const dem_simulation *part, const rank_call *what)
{
    const dem_model *m = part->model;
    dem_peaks *own = s->part[what->number], *kept = &s->kept[what->number];
    switch (what->kind) {
    case RANK_CALL_PEAKS_TAKE:
        return begin(s, m, (int)what->number);
    case RANK_CALL_PEAKS_NODES:
        return hand_over(s, m, own, true);
    case RANK_CALL_PEAKS_SPRINGS:
        return hand_over(s, m, own, false);
    case RANK_CALL_PEAKS_KEEP:
        return reduce_status(m->ranks, keep(kept, own), 0.0);
    case RANK_CALL_PEAKS_KEPT_NODES:
        return hand_over(s, m, kept, true);
    case RANK_CALL_PEAKS_KEPT_SPRINGS:
        return hand_over(s, m, kept, false);
    default:
        return reduce_status(m->ranks, peaks_look(own, part), 0.0);
    }
}

void shared_peaks_drop(shared_peaks *s)
{
    for (int k = 0; k < OBSERVERS_MOST; k++) {
        dem_peaks_destroy(s->part[k]);
        s->part[k] = NULL;
        peaks_give_up(&s->kept[k]);
    }
}
