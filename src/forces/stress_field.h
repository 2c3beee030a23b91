/* SPDX-License-Identifier: BSD-3-Clause */
/* Stresses of all nodes and strains of all springs of a state, with the vector instructions of the kernel, in threads.
 * Every kernel and every number of threads gives the bits of node_stress() and springs_strains(). */
#ifndef DEM_FORCES_STRESS_FIELD_H
#define DEM_FORCES_STRESS_FIELD_H

#include "forces/kernel.h"
#include "model/stress_pass.h"

typedef struct stress_field {
    const dem_model *model;
    stress_pass_function *springs, *nodes, *areas, *couplings, *corners;
    team *team;
    int n_shares;     /* of its loops */
    double *virial;   /* [n_springs][4] as stress_pass has them, of the last state; NULL: none were wanted */
    double *coupled;  /* [couplings][4] likewise */
    uint8_t *guarded; /* [n_blocks] likewise */
} stress_field;

/** Borrows the kernel's model. There is nothing to free before the first stress_field_take().
 *  \param k  whose instructions and threads are used */
void stress_field_create(stress_field *out, const kernel *k);
void stress_field_destroy(stress_field *s);

/** Stresses at positions x [n_nodes][2], with the model's map prepared. Without memory for r x f of the springs each
 *  node computes that of its own.
 *  \param elements     NULL: all are whole
 *  \param area_min     the smallest area of whole triangles over that at rest, if it is known: spares looking for those
 *                      that the guard acts on; 0: it is not
 *  \param[out] stress  [n_nodes][3] Pa: xx, yy, xy
 *  \return whether stress_field_strains() has strains of this state now */
bool stress_field_take(stress_field *s, const element_state *elements, const double *x, double area_min,
                       double *stress);

/** Strains of the springs in the state of the last stresses, 0 of those that are broken.
 *  \param[out] strain  [n_springs] */
void stress_field_strains(const stress_field *s, const element_state *elements, double *strain);

#endif
