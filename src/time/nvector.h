/* SPDX-License-Identifier: BSD-3-Clause */
/* Vectors for SUNDIALS. A copy shares its numbers with the original until one of the two is given others, so that what
 * ARKODE keeps of a step is not copied; linear combinations are one pass; norms do not depend on the order of their
 * sums, and nothing depends on the number of threads. */
#ifndef DEM_TIME_NVECTOR_H
#define DEM_TIME_NVECTOR_H

#include <stdbool.h>

#include <sundials/sundials_nvector.h>

#include "base/array_ops.h"
#include "base/ranks.h"
#include "base/team.h"
#include "time/error_weights.h"

typedef struct nvector_space nvector_space;

/** What a deferred operation has to do with a vector: nothing, or it reads it, or is to write it. */
typedef enum nvector_use { NVECTOR_FREE, NVECTOR_READ, NVECTOR_DUE } nvector_use;

/** Who defers operations on the vectors of a space (deferral.h) or takes part in them, as the space sees it; `self` is
 *  its own. */
typedef struct nvector_deferral {
    void *self;
    /** Asked for every z = sum of factor_k x_k, k = 0 to n - 1: whether it is deferred, or has been carried out
     *  together with earlier ones. Then *status is 0, or -1 if one of them has failed. */
    bool (*take_sum)(void *self, int n, const double *factor, N_Vector *x, N_Vector z, int *status);
    /** Asked for the norm of a vector: whether it is known without its numbers. */
    bool (*take_norm)(void *self, N_Vector x, double *norm);
    /** Called before a vector that is due is read, and before one that is not free is written. NULL where none is. */
    void (*before_read)(void *self);
    void (*before_write)(void *self);
} nvector_deferral;

/** What the vectors of a space are like, and what they are computed with. */
typedef struct nvector_shape {
    const ranks *ranks;           /* that have vectors like these, each of a part of the numbers */
    dem_index length;             /* numbers of a vector */
    dem_index n_whole;            /* of how many numbers a norm is the mean: `length` where there is one rank */
    const error_weights *weights; /* of every norm, whatever vector ARKODE gives for them */
    const array_ops *ops;
    team *team;
} nvector_shape;

/** Borrows what the shape refers to. Reserves memory for n_vectors vectors, clones included, as N_VClone() of
 *  SUNDIALS 6 crashes when it gets none. NULL without memory. Free with nvector_space_free(), after its vectors. */
nvector_space *nvector_space_create(const nvector_shape *shape, int n_vectors);
void nvector_space_free(nvector_space *s);

/** A vector of the space with undefined numbers; NULL without memory. For N_VDestroy(). */
N_Vector nvector_create(nvector_space *s, SUNContext context);

/** From now on the norm of a vector that shares its numbers with `start` may be a bound of it: it is the state from
 *  which a step goes, of which ARKODE asks whether rounding alone is more than the error that is allowed. Where vectors
 *  have parts on other ranks it is the norm. Borrows the vector, until the last one is gone. */
void nvector_space_start(nvector_space *s, N_Vector start);

/** From now on operations may be deferred. Borrows the table, until the last vector is gone. */
void nvector_space_defer(nvector_space *s, const nvector_deferral *d);
void nvector_set_use(N_Vector v, nvector_use use);
nvector_use nvector_get_use(N_Vector v);

/** z = sum of factor_k x_k, carried out at once.  \return -1 if there are more terms than there is room for */
int nvector_combine(int n, const double *factor, N_Vector *x, N_Vector z);

/** The sum of squares of numbers times their weights on this rank, each multiplied by the scale before. */
array_ops_sum nvector_squares(N_Vector x, double scale);

/** The norm of a vector from such a sum of all ranks: infinity if a term is not finite.
 *  \param scale  a power of 2 by which it was added up; another one is put there if the sum does not hold
 *  \return whether it holds */
bool nvector_norm_of_sum(const nvector_space *s, const array_ops_sum *sum, double *scale, double *norm);

/** The numbers of a vector, to be read. */
const double *nvector_values(N_Vector v);

/** Numbers for a vector that is to be written as a whole: undefined, and shared with no other. */
double *nvector_fresh(N_Vector v);

/** The numbers of a vector, to be changed in part; vectors that share them change with it. */
double *nvector_shared(N_Vector v);

/** From now on `to` has the numbers of `from`. */
void nvector_share(N_Vector from, N_Vector to);

#endif
