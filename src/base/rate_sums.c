/* SPDX-License-Identifier: BSD-3-Clause */
/* A sum over the contacts of the whole model for each rate. Of many obstacles most have no contact: an empty sum costs
 * next to nothing. */
#include "base/rate_sums.h"

#include <stdlib.h>

#include "base/status.h"

dem_status rate_sums_create(rate_sums *out, int dim, dem_index n_obstacles)
{
    const state_layout most = state_layout_of(dim, 0, n_obstacles, true);
    out->list = calloc((size_t)(dim * state_n_quadratures(&most)), sizeof *out->list);
    CHECK(out->list != NULL, DEM_ERROR_MEMORY, "out of memory for the forces of obstacles");
    return DEM_OK;
}

void rate_sums_free(rate_sums *s)
{
    free(s->list);
    s->list = NULL;
}

void rate_sums_take(const rate_sums *s, const state_layout *l, double *a)
{
    const dem_index first = state_row(l, state_impulse(l, 0)), n = l->dim * state_n_quadratures(l);
    for (dem_index k = 0; k < n; k++) {
        a[first + k] += exact_sum_value(&s->list[k]);
        exact_sum_clear(&s->list[k]);
    }
}
