/* SPDX-License-Identifier: BSD-3-Clause */
/* The scales of a model: spacing, bound of the frequencies, mass, number of bodies, whether edges are springs. Each
 * rank finds them of its own nodes, and all join them, so that nobody needs the whole. */
#ifndef DEM_MODEL_MODEL_SCALES_H
#define DEM_MODEL_MODEL_SCALES_H

#include "base/ranks.h"
#include "domain/domain.h"
#include "elastic/couplings.h"

typedef struct model_scales {
    dem_index n_bodies;
    bool edges_are_springs; /* whether triangles have springs along all of their edges */
    double spacing;         /* m */
    double omega_max;       /* rad/s */
    double mass;            /* kg */
} model_scales;

/** What a rank finds them of. */
typedef struct model_scales_input {
    const domain *domain;       /* NULL: all nodes are own ones */
    const dem_lattice *lattice; /* of the domain */
    const springs *springs;
    const triangles *triangles;
    const couplings *couplings;
    const double *inverse_mass; /* [n_nodes] */
    const double *given;        /* [n_springs] what triangles give to springs, of which some may be beside the domain
                                   (coupled_bound_given()); NULL: all are here */
} model_scales_input;

/** Finds them, the same on all ranks. Collective.  \return DEM_ERROR_MEMORY, on all ranks */
dem_status model_scales_find(model_scales *out, const ranks *r, const model_scales_input *of);

#endif
