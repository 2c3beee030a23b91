/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/csr_view.h"

#include <stdlib.h>

#include "base/on_demand.h"
#include "base/status.h"

struct csr_view {
    const springs *springs;
    on_demand made;
    dem_index *numbers; /* rows, neighbours and springs, one behind the other */
    double *strengths;  /* stiffnesses, rest lengths and viscosities likewise */
};

dem_status csr_view_create(csr_view **out, const springs *s)
{
    csr_view *v = calloc(1, sizeof *v);
    CHECK_MEMORY(v);
    v->springs = s;
    const dem_status status = on_demand_create(&v->made);
    if (status == DEM_OK)
        *out = v;
    else
        free(v);
    return status;
}

void csr_view_free(csr_view *v)
{
    if (v == NULL) return;
    on_demand_destroy(&v->made);
    free(v->numbers);
    free(v->strengths);
    free(v);
}

static void copy_numbers(dem_index *to, const int32_t *from, dem_index n)
{
    for (dem_index k = 0; k < n; k++) to[k] = from[k];
}

static void copy_by_slot(double *to, const double *from, const springs *s)
{
    for (dem_index p = 0; p < s->row[s->n_nodes]; p++) to[p] = from[s->spring[p]];
}

static dem_status make(void *self)
{
    csr_view *v = self;
    const springs *s = v->springs;
    const dem_index rows = s->n_nodes + 1, slots = s->row[s->n_nodes];
    dem_index *numbers = malloc((size_t)(rows + 2 * slots) * sizeof *numbers);
    double *strengths = malloc((size_t)(3 * slots + 1) * sizeof *strengths);
    if (numbers == NULL || strengths == NULL) {
        free(numbers);
        free(strengths);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for the rows of %lld springs", (long long)s->n_springs);
    }
    copy_numbers(numbers, s->row, rows);
    copy_numbers(numbers + rows, s->neighbour, slots);
    copy_numbers(numbers + rows + slots, s->spring, slots);
    copy_by_slot(strengths, s->stiffness_of, s);
    copy_by_slot(strengths + slots, s->rest_length_of, s);
    if (s->viscosity_of != NULL) copy_by_slot(strengths + 2 * slots, s->viscosity_of, s);
    v->numbers = numbers;
    v->strengths = strengths;
    return DEM_OK;
}

dem_status csr_view_show(csr_view *v, dem_csr *out)
{
    const springs *s = v->springs;
    const dem_index rows = s->n_nodes + 1, slots = s->row[s->n_nodes];
    TRY(on_demand_make(&v->made, make, v));
    *out = (dem_csr){sizeof *out,
                     s->n_nodes,
                     v->numbers,
                     v->numbers + rows,
                     v->numbers + rows + slots,
                     v->strengths,
                     v->strengths + slots,
                     s->viscosity_of != NULL ? v->strengths + 2 * slots : NULL};
    return DEM_OK;
}
