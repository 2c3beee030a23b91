/* SPDX-License-Identifier: BSD-3-Clause */
/* What the keys of &probe mean: from the groups to nodes and springs of the lattice. */
#ifndef DEM_PROBES_H
#define DEM_PROBES_H

#include <dem/trajectory.h>

#include "placement.h"
#include "schema.h"

/* What can be said without geometry. */
void probes_check(const schema_deck *groups, namelist_errors *errors);

/* Takes the default of 'body' away where a probe is found by its number: stated, it is a fault. */
void probes_drop_unused(schema_deck *groups);

/* Finds what is probed, for a deck without faults; faults are appended to `errors`. Returns false only when memory runs
 * out. Free with probes_free in any case.
 * \param[out] out     [number of &probe groups]
 * \param      bodies  [number of &body groups] */
bool probes_find(dem_probe *out, const schema_deck *groups, const dem_lattice *lattice, const placement *bodies,
                 namelist_errors *errors);
void probes_free(dem_probe *probes, size_t n);

/* Where what is probed is at rest, m: the node, or the middle of the spring or gauge. */
void probes_place(double at[2], const dem_probe *p, const dem_lattice *lattice);

#endif
