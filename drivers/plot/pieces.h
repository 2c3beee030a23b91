/* SPDX-License-Identifier: BSD-3-Clause */
/* Colours of fragments. That of one is of the node with the least hash among its nodes: where something breaks off,
 * what is left keeps its colour, the more surely the more it is, and so the colours stay over a film, though every
 * frame has them by itself. What still has half of the mass of its body or more is grey. */
#ifndef DEM_PIECES_H
#define DEM_PIECES_H

#include <stdbool.h>

#include <dem/reader.h>

typedef struct pieces {
    const dem_lattice *lattice;
    double *body_mass; /* [bodies] kg */
    dem_index n_bodies;
} pieces;

/** Borrows the lattice. False without memory. */
bool pieces_create(pieces *p, const dem_lattice *lattice);
void pieces_free(pieces *p);

/** Places in the palette of pieces: 0 of grey, or that of a node's fragment.
 *  \param fragment    [n_nodes] the lowest node of the fragment of each; what is no such number counts as grey
 *  \param[out] value  [n_nodes] */
void pieces_shade(const pieces *p, const double *fragment, double *value);

#endif
