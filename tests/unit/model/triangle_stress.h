/* SPDX-License-Identifier: BSD-3-Clause */
/* The own effective stress of a triangle, of which those of nodes are means. */
#ifndef TESTS_UNIT_MODEL_TRIANGLE_STRESS_H
#define TESTS_UNIT_MODEL_TRIANGLE_STRESS_H

#include "model/node_stress.h"
#include "model/spring_share.h"

static inline void add_virials(const double virial[3], double factor, double sum[3])
{
    for (int k = 0; k < 3; k++) sum[k] += factor * virial[k];
}

/* All that acts on a triangle, added up over whole lists. Pa: xx, yy, xy */
static inline void triangle_stress(const dem_model *m, const element_state *s, dem_index triangle, const double *x,
                                   double stress[3])
{
    const couplings *c = &m->couplings;
    const triangles *t = &m->triangles;
    const double volume = spring_share_volume(&m->lattice, triangle);
    double virial[3];
    stress[0] = stress[1] = stress[2] = 0.0;
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++) {
        springs_virial(&m->lattice, s->spring[p], x, virial);
        add_virials(virial, s->share[p] / volume, stress);
    }
    for (dem_index p = 0; p < c->row[c->n_nodes]; p++) {
        if (c->list[c->slot[p] / 3].triangle != triangle || c->slot[p] % 3 != 0) continue;
        couplings_virial(c, p, x, virial);
        add_virials(virial, 1.0 / volume, stress);
    }
    const dem_index i = m->lattice.triangles[3 * triangle];
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
        if (t->triangle[p] != triangle) continue;
        const double spread = triangles_virial(t, TRIANGLES_WHOLE, i, p, x);
        add_virials((const double[]){spread, spread, 0.0}, 1.0 / volume, stress);
    }
}

#endif
