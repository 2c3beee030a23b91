/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/rows_taker.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

dem_status rows_hand_over(const void *rows, size_t size, dem_index n, rows_taker *take, void *context)
{
    for (dem_index first = 0; first < n; first += ROWS_CHUNK) {
        const dem_index left = n - first;
        TRY(take(context, first, left < ROWS_CHUNK ? left : ROWS_CHUNK, (const char *)rows + (size_t)first * size));
    }
    return DEM_OK;
}

dem_status rows_pass_on(const rows_source *from, rows_taker *take, void *context)
{
    const dem_index most = from->n < ROWS_CHUNK ? from->n : ROWS_CHUNK;
    void *rows = malloc((size_t)most * from->size + 1);
    CHECK_MEMORY(rows);
    dem_status status = DEM_OK;
    for (dem_index first = 0; first < from->n && status == DEM_OK; first += ROWS_CHUNK) {
        const dem_index n = from->n - first < ROWS_CHUNK ? from->n - first : ROWS_CHUNK;
        status = from->read(from->context, first, n, rows);
        if (status == DEM_OK) status = take(context, first, n, rows);
    }
    free(rows);
    return status;
}

dem_status rows_taker_copy(void *copy, dem_index first, dem_index n, const void *rows)
{
    const rows_copy *c = copy;
    memcpy((char *)c->out + (size_t)first * c->size, rows, (size_t)n * c->size);
    return DEM_OK;
}

dem_status rows_reader_copy(void *here, dem_index first, dem_index n, void *rows)
{
    const rows_here *h = here;
    memcpy(rows, (const char *)h->rows + (size_t)first * h->size, (size_t)n * h->size);
    return DEM_OK;
}

dem_status rows_taker_pick(void *pick, dem_index first, dem_index n, const void *rows)
{
    const rows_pick *p = pick;
    for (dem_index k = 0; k < p->n; k++) {
        const dem_index at = p->list[k] - first;
        if (at >= 0 && at < n)
            memcpy((char *)p->out + (size_t)k * p->size, (const char *)rows + (size_t)at * p->size, p->size);
    }
    return DEM_OK;
}
