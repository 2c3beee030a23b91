/* SPDX-License-Identifier: BSD-3-Clause */
/* The scales of a model. Each rank finds them of its own nodes, and all join them, so that nobody needs the whole. Rows
 * of own nodes are complete, so that their bounds have the bits of the whole; extremes and exact sums have them
 * whatever the shares. */
#include <stdlib.h>

#include "base/reduce.h"
#include "base/status.h"
#include "lattice/lattice.h"
#include "model/coupled_bound.h"
#include "model/model.h"

/* omega_max, rad/s: omega^2 <= max |2 S_i + 3 T_i + C_i|/m_i over the nodes (docs/method.md, Integration in time). S_i
 * is the sum of k n n^T over the springs of node i, since (n.(u_j - u_i))^2 <= 2 (n.u_i)^2 + 2 (n.u_j)^2; T_i that of
 * max(kappa, 0)/A0 g g^T over its triangles with g = dA/dx_i, since (sum of three)^2 <= 3 (sum of squares); and C_i, in
 * `coupled`, what coupled triangles have beside that; NULL: nothing. */
static double frequency_bound(const dem_model *m, const sym2 *coupled)
{
    const double *x = m->lattice.x;
    double squared = 0.0;
    for (dem_index i = 0; i < m->lattice.n_nodes; i++) {
        if (!domain_owns(m->domain, i)) continue;
        const sym2 bonds = springs_block(&m->springs, m->springs.stiffness_of, i, x);
        const sym2 areas = triangles_block(&m->triangles, i, x);
        const sym2 own = {2.0 * bonds.xx + 3.0 * areas.xx, 2.0 * bonds.xy + 3.0 * areas.xy,
                          2.0 * bonds.yy + 3.0 * areas.yy};
        const double bound = sym2_largest(coupled != NULL ? sym2_add(own, coupled[i]) : own) * m->inverse_mass[i];
        squared = isfinite(bound) ? fmax(squared, bound) : (double)INFINITY; /* fmax() would drop a NAN */
    }
    return sqrt(squared);
}

static dem_status find_omega(double *omega, const dem_model *m, const double *given)
{
    double *found = NULL;
    sym2 *coupled = NULL;
    dem_status status = DEM_OK;
    if (m->couplings.n > 0) {
        coupled = lattice_zeros(m->lattice.n_nodes, sizeof *coupled);
        CHECK_MEMORY(coupled);
        if (given == NULL) status = coupled_bound_given(&found, &m->lattice, &m->springs);
        if (status == DEM_OK) coupled_bound_add(&m->lattice, &m->couplings, given != NULL ? given : found, coupled);
    }
    if (status == DEM_OK) *omega = frequency_bound(m, coupled);
    free(coupled);
    free(found);
    return status;
}

/* Each edge of a triangle goes from one of its corners to the next. */
static bool edges_are_springs(const dem_model *m)
{
    const triangles *t = &m->triangles;
    for (dem_index i = 0; i < t->n_nodes; i++)
        for (dem_index p = t->row[i]; p < t->row[i + 1] && domain_owns(m->domain, i); p++)
            if (springs_between(&m->springs, i, t->next[p]) < 0) return false;
    return true;
}

/* The shortest rest length; 0: that of a lattice without springs. */
static double find_spacing(const ranks *r, const dem_lattice *l)
{
    double shortest = INFINITY;
    for (dem_index k = 0; k < l->n_springs; k++) shortest = fmin(shortest, l->rest_length[k]);
    shortest = reduce_min(r, shortest);
    return isfinite(shortest) ? shortest : 0.0;
}

static double sum_masses(const ranks *r, const domain *d, const dem_lattice *l)
{
    exact_sum mass = {0};
    dem_index end;
    for (dem_index first = 0; first < l->n_nodes; first = end)
        if (domain_run(d, first, l->n_nodes, &end)) exact_sum_add_array(&mass, l->mass + first, end - first);
    return reduce_sum(r, &mass);
}

dem_status model_find_scales(dem_model *m, const double *given)
{
    const ranks *r = m->ranks;
    double omega = 0.0;
    TRY(reduce_status(r, find_omega(&omega, m, given), 0.0));
    m->spacing = find_spacing(r, &m->lattice);
    m->omega_max = reduce_max(r, omega);
    m->n_bodies = (dem_index)reduce_max(r, (double)lattice_count_bodies(&m->lattice));
    m->edges_are_springs = !reduce_any(r, !edges_are_springs(m));
    m->mass = sum_masses(r, m->domain, &m->lattice);
    CHECK(isfinite(m->omega_max), DEM_ERROR_MODEL, "stiffness over mass is too large to compute with");
    return DEM_OK;
}
