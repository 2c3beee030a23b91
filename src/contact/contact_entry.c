/* SPDX-License-Identifier: BSD-3-Clause */
/* The entry `contacts` of a checkpoint: what candidates have to remember so that a run goes on to the same bits. Closed
 * contacts with their state, forces and place of sticking, the obstacles that nodes have gone behind, and the counters
 * of storms are remembered; clearances, groups and the broad phase are not, as they are measured anew at every
 * checkpoint, also by the run that writes it. The entry is a list of structs of numbers of 8 bytes, without gaps: one
 * for each candidate that differs from one that has never touched anything. What else a checkpoint holds is in
 * src/simulation/checkpoint.c. */
#include "contact/contact_entry.h"

#include <math.h>
#include <stdlib.h>

#include "base/status.h"

typedef struct point_entry {
    dem_index feature, slide, held;
    double place, force, friction;
} point_entry;

typedef struct candidate_entry {
    dem_index k, n_closed, behind[2], storm;
    double storm_start;
    point_entry closed[2];
} candidate_entry;

/* Whether a candidate differs from one that has never touched anything. */
static bool remembers(const contact_candidate *candidate)
{
    return candidate->n_closed > 0 || candidate->behind[0] >= 0 || candidate->behind[1] >= 0 || candidate->storm.n > 0;
}

static candidate_entry describe(const contact_candidate *candidate, dem_index k)
{
    candidate_entry e = {k,
                         candidate->n_closed,
                         {candidate->behind[0], candidate->behind[1]},
                         candidate->storm.n,
                         candidate->storm.start,
                         {{0}}};
    for (int q = 0; q < candidate->n_closed; q++) {
        const contact_point *point = &candidate->closed[q];
        e.closed[q] =
            (point_entry){point->feature, point->slide, point->held, point->place, point->force, point->friction};
    }
    return e;
}

dem_status contact_entry_put(const contact_set *c, dem_checkpoint *checkpoint)
{
    dem_index n = 0;
    for (dem_index k = 0; k < c->n; k++) n += remembers(&c->list[k]);
    candidate_entry *list = malloc(((size_t)n + 1) * sizeof *list);
    CHECK(list != NULL, DEM_ERROR_MEMORY, "out of memory for the contacts of a checkpoint");
    n = 0;
    for (dem_index k = 0; k < c->n; k++)
        if (remembers(&c->list[k])) list[n++] = describe(&c->list[k], k);
    const dem_status status = dem_checkpoint_put(checkpoint, "contacts", list, (size_t)n * sizeof *list);
    free(list);
    return status;
}

static bool is_within(dem_index value, dem_index low, dem_index high)
{
    return value >= low && value <= high;
}

/* Whether an entry can be that of a candidate of this set: numbers within their ranges, and finite. Files are not
 * trusted; nothing that is used as an index later escapes this check. */
static bool is_possible(const contact_set *c, const candidate_entry *e)
{
    const obstacle_set *o = &c->scene.model->obstacles;
    if (!is_within(e->k, 0, c->n - 1) || !is_within(e->n_closed, 0, 2)) return false;
    if (!is_within(e->behind[0], -1, o->n - 1) || !is_within(e->behind[1], -1, o->n - 1)) return false;
    if (e->storm < 0 || !isfinite(e->storm_start)) return false;
    const dem_index n_features = candidate_is_edge(&c->list[e->k]) ? o->n_vertices : o->n_segments;
    for (dem_index q = 0; q < e->n_closed; q++) {
        const point_entry *point = &e->closed[q];
        if (!is_within(point->feature, 0, n_features - 1) || !is_within(point->slide, -1, 1)) return false;
        if (!is_within(point->held, 0, 1) || !isfinite(point->place)) return false;
        if (!isfinite(point->force) || !isfinite(point->friction)) return false;
    }
    return e->n_closed < 2 || e->closed[0].feature != e->closed[1].feature;
}

/* As at the start of a run: no contacts, no clearance, behind nothing. */
static void forget(contact_candidate *candidate)
{
    *candidate = candidate_reset(candidate);
    candidate->behind[0] = candidate->behind[1] = -1;
    candidate->is_new = false;
    candidate->storm = (contact_storm){0};
}

static void restore(contact_candidate *candidate, const candidate_entry *e)
{
    candidate->n_closed = (int)e->n_closed;
    candidate->storm.n = e->storm;
    candidate->storm.start = e->storm_start;
    for (int q = 0; q < 2; q++) candidate->behind[q] = e->behind[q];
    for (int q = 0; q < candidate->n_closed; q++) {
        const point_entry *point = &e->closed[q];
        candidate->closed[q] = (contact_point){.feature = point->feature,
                                               .slide = (int)point->slide,
                                               .held = point->held != 0,
                                               .place = point->place,
                                               .force = point->force,
                                               .friction = point->friction};
    }
}

/* Entries ascend by candidate, so that none comes twice. */
dem_status contact_entry_get(contact_set *c, const dem_checkpoint *checkpoint)
{
    size_t size;
    dem_index last = -1;
    const candidate_entry *list = dem_checkpoint_find(checkpoint, "contacts", &size);
    CHECK(list != NULL && size % sizeof *list == 0, DEM_ERROR_IO, "the checkpoint has no contacts");
    for (dem_index k = 0; k < c->n; k++) forget(&c->list[k]);
    for (size_t k = 0; k < size / sizeof *list; k++) {
        CHECK(is_possible(c, &list[k]) && list[k].k > last, DEM_ERROR_IO,
              "entry %zu of the contacts in the checkpoint is impossible", k);
        last = list[k].k;
        restore(&c->list[last], &list[k]);
    }
    return DEM_OK;
}
