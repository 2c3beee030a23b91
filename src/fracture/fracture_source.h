/* SPDX-License-Identifier: BSD-3-Clause */
/* Fracture as a source of events: an element breaks, or softens, at the time in the step at which its utilisation is 1.
 * Its keys are the numbers of elements (fracture/utilisation.h). */
#ifndef DEM_FRACTURE_FRACTURE_SOURCE_H
#define DEM_FRACTURE_FRACTURE_SOURCE_H

#include "events/event_source.h"
#include "forces/kernel.h"
#include "fracture/break_search.h"
#include "fracture/failing_elements.h"
#include "fracture/strain_filter.h"

/** Steps have as many numbers, from 1 on. */
enum { FRACTURE_SOURCE_NUMBERS = 63 };

typedef struct fracture_source {
    const dem_model *model;
    element_state *elements;
    kernel *kernel;           /* watches strains */
    exact_sum *taken;         /* J, by all that has broken or softened: the ledger's */
    dem_index most;           /* elements that may break in a step; for more it is rejected */
    const dense_output *step; /* the accepted one */
    strain_filter filter;
    break_search search;       /* when elements break or soften; */
    uint8_t number;            /* of the step, up to FRACTURE_SOURCE_NUMBERS */
    uint8_t *asked;            /* [n_nodes] the number of the step in which the stress at one was looked at last */
    uint8_t *seen;             /* [n_triangles] the same of triangles, with the ways in which it was */
    failing_elements *failing; /* those that do so next, or have done so last */
    bool jumped;               /* some have, and others may be over their limits at once */
    double looked;             /* s, of the last event in the step, NAN: there was none; what is due at this time */
    dem_index generation;      /* has come of it, and is of this generation (event_source.h) */
    dem_index n_failed, capacity, broken_capacity;
    dem_index *failed;      /* [n_failed] what has broken or softened in the step so far, in this order; */
    dem_index *broken;      /* [breaks.n] what has broken of it, */
    break_list breaks;      /* the same, as it is reported */
    dem_index n_damaged;    /* nodes beside broken elements before the step */
    exact_sum taken_before; /* J */
} fracture_source;

/** Borrows all four.  \param most  elements that may break in a step, or -1 for any number
 *  \param by  the kernel of the same model, by which strained springs are found from now on
 *  \return DEM_ERROR_MEMORY. Free with fracture_source_destroy() */
dem_status fracture_source_create(fracture_source *out, const dem_model *model, element_state *elements,
                                  exact_sum *taken, dem_index most, kernel *by);
void fracture_source_destroy(fracture_source *s);

/** \return DEM_ERROR_MODEL if an element is beyond its limit at positions x [n][2] */
dem_status fracture_source_check_start(const fracture_source *s, const double *x);

/** Whether something has broken in the step. */
static inline bool fracture_source_has_broken(const fracture_source *s)
{
    return s->breaks.n > 0;
}

/** Whether something has broken or softened in the step. */
static inline bool fracture_source_has_failed(const fracture_source *s)
{
    return s->n_failed > 0;
}

/** Whether all that breaks in the step has been found.  \return DEM_ERROR_MEMORY if it has not */
dem_status fracture_source_found(const fracture_source *s);

/** Where the whole body stops at events: when something breaks or softens first in a step, from its start; infinity if
 *  nothing does before its end.  \param state  [2 dim n_rows] scratch */
double fracture_source_first(fracture_source *s, const dense_output *step, double *state);

/** Then breaks or softens, in the state y of that time, what is due first, and all that is over its limit in
 *  consequence.
 *  \return DEM_ERROR_INTEGRATOR if that is too much, DEM_ERROR_MEMORY: some has broken, to be taken back */
dem_status fracture_source_break(fracture_source *s, const double *y);

/** Likewise breaks all that is over its limit in a state y at t that a program has changed, between two steps. */
dem_status fracture_source_break_at_start(fracture_source *s, double t, const double *y);

/** Takes back all that has broken in the step.  \param self  the source */
void fracture_source_undo(void *self);

/** `s` must stay where it is. */
event_source fracture_source_events(fracture_source *s);

#endif
