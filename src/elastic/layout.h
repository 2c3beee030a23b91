/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs and triangles in the order in which a sweep over all nodes takes them: eight nodes at a time, one to a lane.
 * Each spring is evaluated once, by its lower node, and its force is left in a ring buffer, from where both of its ends
 * collect it in the order of their rows: so the sums have the bits of a sum over the row. Coupled triangles are treated
 * alike, with a force for each corner.
 * layout.c says how the entries are found, sweep_body.h how they are carried out. */
#ifndef DEM_ELASTIC_LAYOUT_H
#define DEM_ELASTIC_LAYOUT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/intern.h"
#include "elastic/couplings.h"
#include "elastic/layout_lanes.h"
#include "elastic/springs.h"
#include "elastic/triangles.h"

/** Where the coefficients of node q of a block stand among eight: vectors that are interleaved from x0 y0 .. x3 y3 and
 *  x4 y4 .. x7 y7 hold the nodes in the order 0 4 1 5 2 6 3 7. */
static inline int layout_lane(int q)
{
    return 2 * (q % 4) + q / 4;
}

typedef enum layout_kind {
    LAYOUT_ADD,      /**< all lanes take part, their operands lie side by side */
    LAYOUT_SUBTRACT, /**< the same of terms of which all nodes are the upper ends: subtracted */
    LAYOUT_MASKED,   /**< some lanes take part, operands lie side by side */
    LAYOUT_GATHERED  /**< `at`, and `to` of corners, are lists of one operand for each lane */
} layout_kind;

/** What the lanes of a block do at the same time. Operands are places in arrays of pairs, counted in numbers. Where the
 *  operands of the lanes lie side by side, `at` is that of lane 0 relative to the block's first node, so that blocks
 *  which do the same have equal entries. Otherwise it is the number of a list with an absolute place for each lane. */
typedef struct layout_entry {
    int32_t at;    /* of springs: upper node; of terms: force in the ring; of corners: next node */
    int32_t to;    /* of springs: force in the ring; of terms: mask of the upper nodes; of corners: last node */
    int32_t set;   /* where its coefficients are */
    uint16_t mask; /* two bits for each lane that takes part */
    uint8_t kind;
    uint8_t soft; /* 1: some of its springs or triangles have another stiffness in tension, behind the coefficients of
                     the set, or of coupled triangles a share of their couplings */
} layout_entry;

/* A coupled triangle has two entries: the first one like that of a corner, and in `at`, `to` and `set` of the second
 * one the places in the ring of the forces on its lowest corner, the next and the last. */

/** Entries by block. */
typedef struct layout_part {
    intern_span *span; /* [n_blocks]; NULL: of couplings where there are none */
    intern entries;
} layout_part;

typedef struct layout {
    dem_index n_nodes;
    dem_index n_blocks;                    /* of LAYOUT_LANES nodes; up to seven nodes behind them are for the caller */
    int32_t *order;                        /* [n_nodes] the node at each place; NULL: places are node numbers */
    bool damped, stiff;                    /* whether springs are damped, and whether there is an area term */
    bool coupled;                          /* whether there are couplings */
    bool softened;                         /* whether entries may be soft */
    layout_part springs;                   /* what a block evaluates */
    layout_part terms;                     /* what its nodes sum up, in the order of their rows */
    layout_part corners;                   /* its triangles */
    layout_part lowest;                    /* those of which its nodes have the lowest numbers, in any order */
    layout_part couplings, coupling_terms; /* the same of coupled triangles as `springs` and `terms` */
    dem_index n_lists, list_capacity;
    int32_t *lists;        /* [n_lists][LAYOUT_LANES] operands */
    intern bonds;          /* [LAYOUT_LANES] of stiffness, rest length; viscosity */
    intern areas;          /* [LAYOUT_LANES] of rest area, area below which the guard acts, area stiffness */
    intern couples;        /* [LAYOUT_LANES] of three rest lengths and three couplings, from the lowest corner on */
    dem_index reach;       /* blocks: springs go no further up or down */
    dem_index ahead;       /* blocks: positions are read no further away */
    dem_index ring_rows;   /* nodes whose forces the ring holds, a power of 2: of `reach` + 3 blocks or more */
    dem_index ring_length; /* forces in the ring */
} layout;

/** The node at place q. */
static inline dem_index layout_node(const layout *l, dem_index q)
{
    return l->order != NULL ? l->order[q] : q;
}

/** Springs, triangles or coupled triangles of a node, at most. */
dem_index layout_most_items(const springs *s, const triangles *t, const couplings *c);

/** Compiles. A lattice in which a node has springs to a great part of the others gets no blocks. Free with
 *  layout_free(). */
dem_status layout_compile(layout *out, const springs *s, const triangles *t, const couplings *c);
void layout_free(layout *l);

#endif
