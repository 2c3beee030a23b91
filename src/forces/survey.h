/* SPDX-License-Identifier: BSD-3-Clause */
/* What is measured on a state in one pass over all nodes, with the vector instructions of the kernel, in threads:
 * energies of nodes, springs and triangles, extreme strains, the motion of bodies. Every kernel and every number of
 * threads gives the same bits. */
#ifndef DEM_FORCES_SURVEY_H
#define DEM_FORCES_SURVEY_H

#include "elastic/energy_pass.h"
#include "elastic/motion_pass.h"
#include "forces/kernel.h"

/** J. */
typedef struct survey_energies {
    double kinetic, elastic, area, guard, weight;
} survey_energies;

/** Nodes of one body, one after another. */
typedef struct survey_run {
    dem_index first, last; /* `last` is behind */
    dem_index body;
} survey_run;

typedef struct survey {
    const dem_model *model;
    energy_pass_function *measure_energies;
    motion_pass_function *measure_motions;
    motion_spin_function *measure_spins;
    team *team;
    int n_shares;    /* of its loops */
    int32_t *place;  /* [n_nodes] of each node in the layout, and */
    double *packed;  /* [n_nodes][2] positions in its order; both NULL: that of the nodes */
    uint8_t *others; /* [n_blocks] nodes at which the layout has something that other ranks measure, as
                                `skipped`; NULL: there are none */
    dem_index n_shared;
    dem_index *shared;       /* [n_shared] those of them at which something is measured here, too, one by one */
    uint8_t *skipped;        /* [n_blocks] as energy_pass has them, as the next three are */
    uint8_t *folded;         /* [n_blocks] */
    double *least, *largest; /* [n_groups] */
    dem_index n_groups, n_chunks, n_runs;
    energy_sums *chunks; /* [n_chunks] of SURVEY_CHUNK blocks each */
    survey_run *runs;    /* [n_runs] */
    motion_sums *moving; /* [n_runs] */
    motion_sums *bodies; /* [n_bodies] of the last survey, as the next two are */
    survey_energies energies;
    dem_strain strain; /* as dem_simulation_strain() tells it, of all ranks */
    double *mass;      /* [n_bodies] kg */
} survey;

enum { SURVEY_CHUNK = 128 }; /* a multiple of ENERGY_PASS_GROUP */

/** Borrows the kernel's model.  \param k  whose instructions and threads are used
 *  \return DEM_ERROR_MEMORY. Free with survey_destroy(). */
dem_status survey_create(survey *out, const kernel *k);
void survey_destroy(survey *s);

/** Measures a state. Collective.
 *  \param f     gravity, and what is left of elements
 *  \param x, v  [n_nodes][2], those of ghosts and common nodes among them */
void survey_take(survey *s, const forces *f, const double *x, const double *v);

/** Measures no more than survey_bodies() asks for. */
void survey_take_motions(survey *s, const double *x, const double *v);

/** Motion of every body in the state of the last survey: centre of mass, velocity of that, angular momentum about it.
 *  Collective.
 *  \param x, v  of that state  \param[out] motion  [n_bodies] */
void survey_bodies(survey *s, const double *x, const double *v, dem_body_motion *motion);

/** Moments of inertia of all bodies about their centres of mass, kg m^2. Collective.
 *  \param motion  [n_bodies] as survey_bodies() finds it at x  \param[out] inertia  [n_bodies] */
void survey_inertia(survey *s, const double *x, const dem_body_motion *motion, double *inertia);

#endif
