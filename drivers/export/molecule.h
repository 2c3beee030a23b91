/* SPDX-License-Identifier: BSD-3-Clause */
/* The body as LAMMPS knows it: atoms and bonds of types, E = K (r - r0)^2, and where they are at the first frame. */
#ifndef DEM_MOLECULE_H
#define DEM_MOLECULE_H

#include "kinds.h"
#include "loads.h"
#include "task.h"

enum { MOLECULE_OMISSIONS = 1024 };

typedef struct molecule_box {
    double low[2], high[2]; /* m */
} molecule_box;

typedef struct molecule {
    const task *task;
    const dem_lattice *lattice;
    kinds atoms;         /* by a: 1 where nodes are fixed, else 0; b: mass, kg */
    kinds bonds;         /* by a: stiffness, N; b: rest length, m */
    double longest;      /* rest length, m; 1 without springs */
    double t;            /* s, of the state */
    const double *x, *v; /* [n_nodes][2] m, m/s; v in the precision of the file where it is not at rest at t = 0 */
    double *gone;        /* [n_springs] not 0: broken, and no bond */
    dem_index n_bonds;   /* springs that are not broken */
    double *own[2];      /* of x and v where they are not the lattice's */
    loads loads;
    char omissions[MOLECULE_OMISSIONS]; /* what is not the run's: "" if nothing */
} molecule;

/** Free with molecule_free(), after a failure too. */
bool molecule_make(molecule *out, const task *t);
void molecule_free(molecule *m);

/** Around positions, with room at the sides.  \param x  [n_nodes][2] */
molecule_box molecule_box_of(const molecule *m, const double *x);

#endif
