/* SPDX-License-Identifier: BSD-3-Clause */
/* What files get of *fields*, numbers of all nodes, springs or triangles. The rows of a field are on the ranks that own
 * them, if a simulation leads some. Ranks make what files want of slices of them, *portions*, each of which goes to the
 * rank that writes it. Who gives such an order does not see where rows are, and who has rows passed on does not know
 * what becomes of them. */
#ifndef DEM_BASE_FIELD_ORDER_H
#define DEM_BASE_FIELD_ORDER_H

#include <stddef.h>

#include <dem/dem.h>

#include "base/rows_taker.h"
#include "base/team.h"

typedef enum field_kind {
    FIELD_POSITIONS,         /**< [nodes][2] double, as others are where nothing else is said; m */
    FIELD_DISPLACEMENTS,     /**< [nodes][2] from the places at rest, m */
    FIELD_VELOCITIES,        /**< [nodes][2] m/s */
    FIELD_STRESS,            /**< [nodes][3] as dem_simulation_stress() has it; the next ones have names of getters */
    FIELD_CONTACT_FORCES,    /**< [nodes][2] */
    FIELD_CONTACT_PRESSURES, /**< [nodes] */
    FIELD_STRAINS,           /**< [springs] */
    FIELD_FORCES,            /**< [springs] */
    FIELD_FRAGMENTS,         /**< [nodes] dem_index */
    FIELD_DAMAGE,            /**< [nodes] */
    FIELD_BROKEN_SPRINGS,    /**< [springs] unsigned char */
    FIELD_BROKEN_TRIANGLES   /**< [triangles] unsigned char */
} field_kind;

/** An order. The rows of all are divided into stripes, as team_share() does it, each of which one rank writes. */
typedef struct field_order {
    field_kind field;
    int n_stripes;    /**< 1: rank 0 writes all */
    size_t size;      /**< bytes */
    const void *what; /**< [size] what is to be made of rows */
    void *target;     /**< on rank 0, for what it writes; NULL elsewhere */
    team *team;       /**< of this rank, whose threads work on it; NULL: the caller alone */
    void **kept;      /**< of this rank, as rank_order_obey() has it. The simulation sets it, and the team of ranks */
} field_order;

/** What has been made of whole slices, ROWS_CHUNK rows each but for the last one of a stripe. Those of a stripe are
 *  divided into shares: portions of a share come in the order of their rows, those of different shares in any order. */
typedef struct field_portion {
    int stripe, share;
    dem_index first, n; /**< rows of the stripe */
    const void *bytes;  /**< [size] */
    size_t size;
} field_portion;

/** The rank of those of a run that writes a stripe. Ranks of one machine mostly have numbers one behind the other, so
 *  that stripes are spread over machines. */
static inline int field_writer(int n_ranks, int n_stripes, int stripe)
{
    return (int)team_share(n_ranks, n_stripes, stripe);
}

/** Has an order carried out for the state that is seen. Defined in simulation/field_order.c, as those who write files
 *  see no more of a simulation than its public headers.
 *  \return as the getter of the field, or the functions below on any rank */
dem_status field_order_give(const dem_simulation *simulation, const field_order *o);

/* What ranks do of an order, as output/rank_work.c defines it. */

/** Begins a stripe, on the rank that writes it. */
dem_status field_order_begin(const field_order *o, int stripe, int n_shares);

/** Makes a portion, on any rank.
 *  \param rows             those of the portion
 *  \param[in,out] portion  its rows are known; bytes are valid up to the next call */
dem_status field_order_make(const field_order *o, const void *rows, field_portion *portion);

/** Takes a portion, on the rank that writes it. */
dem_status field_order_take(const field_order *o, const field_portion *portion);

/** Ends the stripe, on that rank. */
dem_status field_order_end(const field_order *o, int stripe);

#endif
