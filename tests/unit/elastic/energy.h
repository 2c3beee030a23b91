/* SPDX-License-Identifier: BSD-3-Clause */
/* Energies of all springs and triangles, element by element in the order of their lists, as exact sums: what the pass
 * of the survey over eight nodes at a time is compared with. */
#ifndef DEM_TEST_ELASTIC_ENERGY_H
#define DEM_TEST_ELASTIC_ENERGY_H

#include "base/exact_sum.h"
#include "elastic/couplings.h"
#include "elastic/springs.h"
#include "elastic/triangles.h"

static inline void energy_add_springs(exact_sum *sum, const dem_lattice *l, springs_integrity q, const double *x)
{
    for (dem_index k = 0; k < l->n_springs; k++) {
        const double strain = springs_strain_of(l, k, x), left = springs_left(q, k, strain);
        if (!springs_is_broken(q, k))
            exact_sum_add(sum, left * springs_energy_of(l->stiffness[k], l->rest_length[k], strain));
    }
}

static inline void energy_add_couplings(exact_sum *sum, const couplings *c, triangles_integrity q, const double *x)
{
    for (dem_index k = 0; k < c->n; k++) {
        const coupled_edges e = couplings_edges(&c->list[k], x);
        for (int corner = 0; corner < 3 && !couplings_broken(c, q, k); corner++)
            exact_sum_add(sum, couplings_left(c, q, k) * couplings_energy_term(&c->list[k], &e, corner));
    }
}

/* Each from the row of its lowest corner. */
static inline void energy_add_triangles(exact_sum sum[2], const triangles *t, triangles_integrity q, const double *x)
{
    for (dem_index i = 0; i < t->n_nodes; i++)
        for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
            if (t->next[p] < i || t->last[p] < i || triangles_broken(t, q, p)) continue;
            const triangles_energies e = triangles_energies_at(t, q, i, p, x);
            exact_sum_add(&sum[0], e.area);
            exact_sum_add(&sum[1], e.guard);
        }
}

static inline double energy_springs(const dem_lattice *l, springs_integrity q, const double *x)
{
    exact_sum sum = {0};
    energy_add_springs(&sum, l, q, x);
    return exact_sum_value(&sum);
}

static inline double energy_couplings(const couplings *c, triangles_integrity q, const double *x)
{
    exact_sum sum = {0};
    energy_add_couplings(&sum, c, q, x);
    return exact_sum_value(&sum);
}

/* Of area terms and the guard. */
static inline void energy_triangles(const triangles *t, const double *x, double *area, double *guard)
{
    exact_sum sum[2] = {{.n_terms = 0}};
    energy_add_triangles(sum, t, TRIANGLES_WHOLE, x);
    *area = exact_sum_value(&sum[0]);
    *guard = exact_sum_value(&sum[1]);
}

#endif
