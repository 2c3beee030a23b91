/* SPDX-License-Identifier: BSD-3-Clause */
/* What a rank compiles the model of its domain from (model/domain_compile.h): the lattice about its nodes, which has
 * all that the domain depends on, and what is known of the whole alone. It is cut from the whole by the rank itself, or
 * by rank 0, which sends it (model/domain_message.h). */
#ifndef DEM_MODEL_DOMAIN_CUT_H
#define DEM_MODEL_DOMAIN_CUT_H

#include "model/whole_lattice.h"

/** The lattice about a domain has the triangles of which any corner is in the domain, with all of their corners: so of
 *  each node of the domain all triangles are there, and what is beside their sides. Springs are those that join nodes
 *  of the domain. */
typedef struct domain_cut {
    /* The domain but for its triangles, rigid bodies, an empty `touching`; no more, and on a rank that waits for it
     * nothing but zeros. */
    dem_model *model;
    dem_lattice around;  /* without positions where the motion starts at x */
    dem_index *place;    /* [nodes of the domain] their numbers in `around`, ascending */
    dem_index *triangle; /* [triangles of `around`] their numbers in the whole, ascending */
    double *given; /* [springs] what triangles give to them, where they may be coupled: found by domain_compile() */
} domain_cut;

/** An empty one, with a model. End with domain_cut_close().  \return DEM_ERROR_MEMORY */
dem_status domain_cut_open(domain_cut *out);

/** Cuts it for a rank, which need not be this one, in a time that does not depend on the whole.
 *  \param out  an empty one  \return DEM_ERROR_MODEL if the rank owns no node, DEM_ERROR_MEMORY */
dem_status domain_cut_fill(domain_cut *out, whole_lattice *whole, int rank);

/** The same of a lattice from which no other domain is cut: its arrays become those about the domain. It is empty
 *  afterwards, or as it was after a failure.
 *  \param lattice  that of the whole */
dem_status domain_cut_take(domain_cut *out, whole_lattice *whole, int rank, dem_lattice *lattice);

/** Ends it, but for the model, where that is wanted; one that is all zeros, too. */
void domain_cut_close(domain_cut *c, bool keeps_model);

#endif
