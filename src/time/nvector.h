/* SPDX-License-Identifier: BSD-3-Clause */
/* Vectors for SUNDIALS. A copy shares its numbers with the original until one of the two is given others, so that what
 * ARKODE keeps of a step is not copied; linear combinations are one pass; norms do not depend on the order of their
 * sums, and nothing depends on the number of threads. */
#ifndef DEM_TIME_NVECTOR_H
#define DEM_TIME_NVECTOR_H

#include <sundials/sundials_nvector.h>

#include "base/array_ops.h"
#include "base/team.h"

typedef struct nvector_space nvector_space;

/** Borrows the operations and the team. Reserves memory for n_vectors vectors, clones included, as N_VClone() of
 *  SUNDIALS 6 crashes when it gets none. NULL without memory. Free with nvector_space_free(), after its vectors. */
nvector_space *nvector_space_create(dem_index length, const array_ops *operations, team *t, int n_vectors);
void nvector_space_free(nvector_space *s);

/** A vector of the space with undefined numbers; NULL without memory. For N_VDestroy(). */
N_Vector nvector_create(nvector_space *s, SUNContext context);

/** The numbers of a vector, to be read. */
const double *nvector_values(N_Vector v);

/** Numbers for a vector that is to be written as a whole: undefined, and shared with no other. */
double *nvector_fresh(N_Vector v);

/** The numbers of a vector, to be changed in part; vectors that share them change with it. */
double *nvector_shared(N_Vector v);

/** From now on `to` has the numbers of `from`. */
void nvector_share(N_Vector from, N_Vector to);

#endif
