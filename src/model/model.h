/* SPDX-License-Identifier: BSD-3-Clause */
/* The compiled, immutable problem: nodes, springs in CSR, triangles, obstacles. It has no state of a run. */
#ifndef DEM_MODEL_MODEL_H
#define DEM_MODEL_MODEL_H

#include "base/ranks.h"
#include "base/slab_recipe.h"
#include "domain/domain.h"
#include "elastic/couplings.h"
#include "elastic/layout.h"
#include "elastic/springs.h"
#include "elastic/triangles.h"
#include "lattice/lattice_source.h"
#include "model/csr_view.h"
#include "model/rigid_bodies.h"
#include "model/stress.h"
#include "model/surface.h"
#include "model/touching_bodies.h"
#include "obstacle/obstacle.h"

/** Hands over an array of the lattice of which ranks have the parts (whole_of_parts_visit()), on rank 0, which has the
 *  others take part in it.
 *  \param array  its number in lattice_arrays */
typedef dem_status model_array_asker(const dem_model *whole, int array, rows_taker *take, void *context);

/* By what rank 0 has slabs made again. */
typedef struct slab_source {
    const ranks *ranks; /* which outlive the model */
    slab_maker maker;
    void *recipe; /* [size] owned */
    size_t size;
    double price;   /* s, which it took rank 0 to have them made */
    dem_index hash; /* whole_of_parts_hash() of them */
} slab_source;

struct dem_model {
    const ranks *ranks;           /* that share it */
    bool ends_ranks;              /* whether their table ends with the model */
    domain *domain;               /* of this one; NULL: all nodes are here */
    dem_model *part;              /* of a whole that has no arrays: what this rank has of it. NULL: arrays are here */
    model_array_asker *ask_array; /* likewise, for those of the whole */
    slab_source slabs;            /* likewise: by what all ranks make them */
    touching_bodies *touching;    /* of the domain, if bodies may touch each other in it; else NULL */
    dem_lattice lattice;          /* flags, body, position and velocity always filled; */
    dem_lattice borrowed;         /* those of its arrays that are the caller's; NULL: they are of the model */
    bool lacks_rows;              /* whether what is in rows here has been given up */
    springs springs;
    csr_view *csr; /* of the springs, for programs */
    triangles triangles;
    bool edges_are_springs; /* whether triangles have springs along all of their edges */
    couplings couplings;
    surface surface;    /* nodes and edges that may touch obstacles at events */
    rigid_bodies rigid; /* which have neither springs nor triangles nor surface here */
    stress_map stress;
    layout layout; /* of springs and triangles, for sweeps over all nodes */
    obstacle_set obstacles;
    double *inverse_mass; /* [n_nodes] 1/kg; 0 where the node is fixed, or a ghost */
    dem_index n_bodies;
    double spacing;   /* m */
    double omega_max; /* rad/s */
    double mass;      /* kg */
};

/** Finds the scales of a model (model_scales.c): spacing, bound of the frequencies, mass, number of bodies, whether
 *  edges are springs. It has its ranks, and all else of it is compiled. Collective.
 *  \param given  [n_springs] what triangles give to springs, of which some may be beside the domain
 *                (coupled_bound_given()); NULL: all are here
 *  \return DEM_ERROR_MEMORY, DEM_ERROR_MODEL if a frequency is not finite; on all ranks */
dem_status model_find_scales(dem_model *m, const double *given);

/** Compiles what forces are computed with (model_rows.c): springs and triangles in rows, couplings, their layout. All
 *  that follows from the lattice. Free with model_rows_free(), after a failure, too.
 *  \return DEM_ERROR_MEMORY, DEM_ERROR_MODEL for more springs or triangles than rows can number */
dem_status model_rows_compile(dem_model *m);
void model_rows_free(dem_model *m);

/** Frees that until model_rows_renew(), while nobody looks at it: no simulation of the model is advanced. Where
 *  something may break it stays, as who shows what is broken reads it. */
void model_rows_give_up(const dem_model *m);

/** Compiles it again, as it was, if it has been given up.
 *  \return as model_rows_compile(); then it stays given up */
dem_status model_rows_renew(const dem_model *m);

/** The number of node i in the whole lattice, of which the model may have a part. */
static inline dem_index model_node(const dem_model *m, dem_index i)
{
    return domain_number(m->domain, i);
}

#endif
