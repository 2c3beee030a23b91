/* SPDX-License-Identifier: BSD-3-Clause */
/* What the keys of &probe mean: from the groups to nodes and springs of the lattice. */
#ifndef DEM_PROBES_H
#define DEM_PROBES_H

#include <dem/slab.h>
#include <dem/trajectory.h>

#include "placement.h"
#include "schema.h"

/* What can be said without geometry. */
void probes_check(const schema_deck *groups, namelist_errors *errors);

/* Takes the default of 'body' away where a probe is found by its number: stated, it is a fault. */
void probes_drop_unused(schema_deck *groups);

/* What is found of probes in a lattice, or in one slab of it after the other. */
typedef struct probe_end probe_end;
typedef struct probe_search {
    const schema_deck *groups;
    dem_probe *probes; /* [n] */
    size_t n;
    probe_end *ends;              /* [2 n] */
    dem_index n_nodes, n_springs; /* that have been seen */
} probe_search;

/* For a deck without faults. Returns false only when memory runs out. In any case the search is to be freed with
 * probes_forget(), and the probes with probes_free().
 * \param[out] probes  [number of &probe groups], whose numbers probes_end() puts in
 * \param      bodies  [number of &body groups], with numbers of the whole; kept */
bool probes_begin(probe_search *out, dem_probe *probes, const schema_deck *groups, const placement *bodies);

/* Looks at a slab where its nodes are in the end; slabs come in their order. A whole lattice is a slab of own nodes. */
void probes_look(probe_search *s, const dem_slab *slab);

/* Appends faults to `errors`.
 * \param[out] places  [number of &probe groups] where what is probed is at rest, m: the node, or the middle of the
 *                     spring or gauge */
void probes_end(probe_search *s, double (*places)[2], namelist_errors *errors);
void probes_forget(probe_search *s);

void probes_free(dem_probe *probes, size_t n);

#endif
