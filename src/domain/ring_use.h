/* SPDX-License-Identifier: BSD-3-Clause */
/* How many rings of ghosts steps have a use for, and where they pay. Ghosts beyond the first ring are integrated on
 * several ranks: they must not be many beside the nodes that there are. Which options have a use for which is
 * said in simulation/shared_use.c. */
#ifndef DEM_DOMAIN_RING_USE_H
#define DEM_DOMAIN_RING_USE_H

#include <dem/dem.h>

/** Where rings have a place. */
typedef struct ring_room {
    dem_index least_nodes; /* of a rank, on the mean: with fewer there is one ring */
    int part;              /* > 0: ghosts of all ranks together are at most this part of all nodes */
} ring_room;

typedef struct ring_use {
    int most, least; /* rings; of fewer than `least` one is as good */
    ring_room stiff, /* of bodies with area terms or couplings, */
        slack;       /* and of those on which springs and guards alone act, which may have lattice rows */
} ring_use;

/** Of steps that exchange ghosts at every evaluation. */
static inline ring_use ring_use_none(void)
{
    return (ring_use){1, 1, {0, 1}, {0, 1}};
}

/** Of steps through whose stages ghosts are integrated, with just so many rings. With less nodes a rank's state is in
 *  the second cache, and stages need no wave: there exchanges take no longer than the rings do. */
static inline ring_use ring_use_of_stages(int rings)
{
    return (ring_use){rings, rings, {12000, 8}, {12000, 8}};
}

/** Of several steps at once, a ring each; fewer are taken at once where fewer rings fit. With less nodes two ranks on a
 *  third cache of 32 MiB have their states in it, and single steps are as fast, but not as steps by lattice rows, which
 *  leave out half of all ghosts, and gain the more the more steps are one wave. */
static inline ring_use ring_use_of_steps(int least, int most)
{
    return (ring_use){most, least, {175000, 16}, {12000, 12}};
}

#endif
