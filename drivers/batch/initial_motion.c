/* SPDX-License-Identifier: BSD-3-Clause */
#include "initial_motion.h"

void initial_motion_velocity(const dem_lattice *l, dem_index body, double v[2])
{
    double mass = 0.0, momentum[2] = {0.0, 0.0};
    for (dem_index i = 0; i < l->n_nodes; i++) {
        if (body >= 0 && l->body != NULL && l->body[i] != body) continue;
        mass += l->mass[i];
        for (int c = 0; c < 2 && l->velocity != NULL; c++) momentum[c] += l->mass[i] * l->velocity[2 * i + c];
    }
    for (int c = 0; c < 2; c++) v[c] = momentum[c] / mass;
}
