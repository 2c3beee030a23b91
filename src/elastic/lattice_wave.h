/* SPDX-License-Identifier: BSD-3-Clause */
/* Several steps of Verlet's method in one pass over the lattice rows of a body, whose state stands in an array for each
 * component as long as it is in the cache. */
#ifndef DEM_ELASTIC_LATTICE_WAVE_H
#define DEM_ELASTIC_LATTICE_WAVE_H

#include "base/team.h"
#include "elastic/lattice_step.h"

enum { LATTICE_WAVE_MOST = 16 };

/** Steps of one length. The arrays at the end are not those at the start; [n_nodes][2]. */
typedef struct lattice_wave_steps {
    int n;        /* 1 to lattice_wave_most() */
    double h;     /* s */
    vec2 gravity; /* m/s^2 */
    const double *x0, *v0, *a0;
    double *x1, *v1, *a1;
    const dem_index *watched; /* [n_watched] nodes, ascending */
    dem_index n_watched;
    double square[LATTICE_WAVE_MOST]; /* filled: of the highest speed of watched nodes at each end, m^2/s^2, */
    double sum[LATTICE_WAVE_MOST];    /* and the sum of sweep_term() of all accelerations there */
} lattice_wave_steps;

typedef struct lattice_wave lattice_wave;

/** Room for waves by a function for steps of lattice rows, in threads of a team. Free with lattice_wave_free().
 *  \param[out] out  NULL: the body has no lattice rows  \return DEM_ERROR_MEMORY */
dem_status lattice_wave_create(lattice_wave **out, const lattice_rows_input *from, lattice_step_function *step,
                               team *t);
void lattice_wave_free(lattice_wave *w);

/** Whether a wave takes less time than single steps, which may have more threads: it has shares for half of the team at
 *  least. */
bool lattice_wave_pays(const lattice_wave *w);

/** How many steps a wave takes at most: lattice rows on their way stay in the second cache, or nearly. */
int lattice_wave_most(const lattice_wave *w);

/** Takes the steps, where no element has failed.
 *  \return false if something is not finite, or the guard may act somewhere at an end of a step: the arrays at the end
 *  are undefined then */
bool lattice_wave_run(lattice_wave *w, lattice_wave_steps *steps);

#endif
