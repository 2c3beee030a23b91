/* SPDX-License-Identifier: BSD-3-Clause */
/* What is known of a deck's lattice once it is built: nothing that comes later looks at its arrays, so that no process
 * needs to have all of them. */
#ifndef DEM_LATTICE_FACTS_H
#define DEM_LATTICE_FACTS_H

#include <stdbool.h>

#include <dem/slab.h>

#include "initial_motion.h"

/* A body of the lattice, and of its model. */
typedef struct lattice_body {
    unsigned rigid; /* DEM_NODE_RIGID, with DEM_NODE_GUIDE_X or DEM_NODE_GUIDE_Y of a guided one; 0: it is elastic */
    initial_motion motion;
} lattice_body;

/* A spring whose upper end has its mass in a slab to come, or that comes behind one. */
typedef struct lattice_spring {
    double mass[2];  /* kg, of its ends */
    double scale;    /* N m, its stiffness times its length */
    dem_index upper; /* number of the end whose mass is not known; -1: both are */
} lattice_spring;

typedef struct lattice_facts {
    initial_motion motion;
    bool may_break;          /* something of it breaks by itself, */
    bool may_soften;         /* and softens before */
    double low[2], high[2];  /* m, corners of the box of all nodes at rest */
    double damping_time;     /* s, the longest of its springs; 0: none is damped */
    double share_of_fastest; /* how long waves take along the fastest spring over how long along the mean one, for the
                                same way; 1 without springs */
    lattice_body *bodies;    /* [n_bodies] */
    dem_index n_bodies;
    double least_slowness, sum_of_slowness; /* of the n_springs so far: how long waves take along them, s/m */
    dem_index n_springs;
    lattice_spring *waiting; /* [n_waiting] for slabs to come */
    dem_index n_waiting, room;
} lattice_facts;

/* Of a lattice of which a model can be made. False when memory runs out. Free with lattice_facts_free() in any case. */
bool lattice_facts_find(lattice_facts *out, const dem_lattice *lattice);

/* The same of slabs, one after the other. The box is that of `box`, any nodes that have the outermost
 * among them. Facts are zero at first. */
bool lattice_facts_add(lattice_facts *facts, const dem_slab *slab);
void lattice_facts_find_box(lattice_facts *facts, const dem_lattice *box);
void lattice_facts_free(lattice_facts *facts);

/* The diagonal of the box of all nodes at rest, m: no body is longer. */
double lattice_facts_diagonal(const lattice_facts *facts);

/* Whether any body is rigid. */
bool lattice_facts_any_rigid(const lattice_facts *facts);

#endif
