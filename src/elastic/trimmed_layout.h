/* SPDX-License-Identifier: BSD-3-Clause */
/* The layout of a body of which something has broken or softened: that of the whole body, from which broken springs and
 * triangles have been taken out, block by block, and in which the others have the stiffness that is left. A sweep of it
 * gives what rows give in which broken elements are passed over, to the bit. The layout of the whole body, which
 * belongs to the model, stays as it is. */
#ifndef DEM_ELASTIC_TRIMMED_LAYOUT_H
#define DEM_ELASTIC_TRIMMED_LAYOUT_H

#include "elastic/layout.h"

/** What is left of the elements. */
typedef struct trimmed_elements {
    springs_integrity springs;
    triangles_integrity triangles;
} trimmed_elements;

typedef struct trimmed_layout {
    layout layout; /* for sweeps: entries and sets are its own, order and lists those of `whole` */
    const layout *whole;
    const springs *springs;
    const triangles *triangles;
    const couplings *couplings;
    int32_t *place;    /* [n_nodes] of each node; NULL: its number */
    uint32_t *trimmed; /* [n_blocks] number of the call in which a block was trimmed last; 0: it never was */
    uint32_t call;     /* the present one */
    double settled;    /* bytes of entries and sets when they were last made anew */
    dem_index most;    /* items of a lane */
    dem_index *slot;   /* [most] scratch */
    double *left;      /* [LAYOUT_LANES][most] scratch: what is left of each item, 0: it is broken, */
    double *pulled;    /* and what is in tension */
    dem_index n_entries, entry_capacity;
    layout_entry *entries; /* [n_entries] of the block in hand */
} trimmed_layout;

/** Nothing is trimmed yet. Borrows all four. Free with trimmed_layout_destroy().
 *  \param softens  whether elements may not be as stiff in tension as under pressure
 *  \return DEM_ERROR_MEMORY */
dem_status trimmed_layout_create(trimmed_layout *out, const layout *whole, const springs *s, const triangles *t,
                                 const couplings *c, bool softens);
void trimmed_layout_destroy(trimmed_layout *l);

/** Trims the blocks of n nodes. Where the elements of no other nodes have changed the layout is then that of what is
 *  left.
 *  \return DEM_ERROR_MEMORY, DEM_ERROR_MODEL for more entries than numbers: it is then of no use any more */
dem_status trimmed_layout_follow(trimmed_layout *l, const trimmed_elements *left, const dem_index *nodes, dem_index n);

#endif
