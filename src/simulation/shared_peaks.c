/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts have entries of ghosts, too, which nobody asks for. */
#include "simulation/shared_peaks.h"

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
static dem_status take(const dem_model *m, const dem_peaks *whole, dem_peaks *part)
{
    const gather_items of_nodes = gather_nodes(m->domain), of_springs = gather_springs(m->domain, &m->lattice);
    const bool is_root = whole != NULL;
    if (!reduce_any(m->ranks, is_root && !whole->is_new)) return DEM_OK;
    TRY(gather_back(m->ranks, &of_nodes, sizeof *part->nodes, is_root ? whole->nodes : NULL, part->nodes));
    return gather_back(m->ranks, &of_springs, sizeof *part->springs, is_root ? whole->springs : NULL, part->springs);
}

/* The other way round, to where there is room for them, or room is made. */
static dem_status bring_nodes(const dem_model *m, dem_peaks *whole, const dem_peaks *part)
{
    const gather_items of_nodes = gather_nodes(m->domain);
    const bool is_root = whole != NULL;
    TRY(reduce_status(m->ranks, is_root ? peaks_make_node_room(whole) : DEM_OK, 0.0));
    return gather_rows(m->ranks, &of_nodes, sizeof *part->nodes, part->nodes, is_root ? whole->nodes : NULL);
}

static dem_status bring_springs(const dem_model *m, dem_peaks *whole, const dem_peaks *part)
{
    const gather_items of_springs = gather_springs(m->domain, &m->lattice);
    const bool is_root = whole != NULL;
    TRY(reduce_status(m->ranks, is_root ? peaks_make_spring_room(whole) : DEM_OK, 0.0));
    return gather_rows(m->ranks, &of_springs, sizeof *part->springs, part->springs, is_root ? whole->springs : NULL);
}

/* All ranks have peaks afterwards, or none. */
static dem_status begin(shared_peaks *s, const dem_model *m, int k)
{
    dem_peaks **own = &s->part[k];
    dem_peaks_destroy(*own);
    *own = NULL;
    dem_status status = reduce_status(m->ranks, dem_peaks_create(own, m, 1), 0.0);
    if (status == DEM_OK) status = take(m, s->whole[k], *own);
    if (status == DEM_OK) return DEM_OK;
    dem_peaks_destroy(*own);
    *own = NULL;
    return status;
}

dem_status shared_peaks_answer(shared_peaks *s, const dem_simulation *part, const rank_call *what)
{
    const dem_model *m = part->model;
    dem_peaks *whole = s->whole[what->number], **own = &s->part[what->number];
    switch (what->kind) {
    case RANK_CALL_PEAKS_TAKE:
        return begin(s, m, (int)what->number);
    case RANK_CALL_PEAKS_NODES:
        return bring_nodes(m, whole, *own);
    case RANK_CALL_PEAKS_SPRINGS:
        return bring_springs(m, whole, *own);
    default:
        return reduce_status(m->ranks, peaks_look(*own, part), 0.0);
    }
}

void shared_peaks_drop(shared_peaks *s)
{
    for (int k = 0; k < OBSERVERS_MOST; k++) {
        dem_peaks_destroy(s->part[k]);
        s->part[k] = NULL;
    }
}
