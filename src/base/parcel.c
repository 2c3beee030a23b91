/* SPDX-License-Identifier: BSD-3-Clause */
/* First the sizes, so that all memory is there before an array is sent. Ranks that have no part in it wait along, as
 * exchanges are collective. */
#include "base/parcel.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/reduce.h"
#include "base/status.h"

static const size_t no_array = SIZE_MAX; /* as a size */

/* Pointers of all kinds have the same representation here, as lattice/lattice_arrays.c has it, too. */
static void *array_of(const parcel_item *item)
{
    void *array;
    memcpy(&array, item->at, sizeof array);
    return array;
}

static void put_array(const parcel_item *item, void *array)
{
    memcpy(item->at, &array, sizeof array);
}

void parcel_add(parcel *p, void *at, size_t size)
{
    if (p->lacks_memory || !grow_array((void **)&p->items, &p->capacity, p->n + 1, sizeof *p->items))
        p->lacks_memory = true;
    else
        p->items[p->n++] = (parcel_item){at, size};
}

void parcel_pass(const ranks *r, int to, void *bytes, size_t size)
{
    const bool sends = r->rank == 0, takes_part = sends || r->rank == to;
    const int other = sends ? to : 0;
    const ranks_message full = {other, size, bytes}, empty = {other, 0, NULL};
    r->exchange(r->self, takes_part ? 1 : 0, sends ? &full : &empty, sends ? &empty : &full);
}

/* Without memory no array is kept. */
static dem_status allocate(parcel *p, const size_t *sizes)
{
    bool lacks_memory = false;
    for (dem_index k = 0; k < p->n; k++) {
        parcel_item *item = &p->items[k];
        item->size = sizes[k] != no_array ? sizes[k] : 0;
        put_array(item, sizes[k] != no_array && !lacks_memory ? malloc(item->size + 1) : NULL);
        lacks_memory = lacks_memory || (sizes[k] != no_array && array_of(item) == NULL);
    }
    for (dem_index k = 0; k < p->n && lacks_memory; k++) {
        free(array_of(&p->items[k]));
        put_array(&p->items[k], NULL);
    }
    CHECK(!lacks_memory, DEM_ERROR_MEMORY, "out of memory for what rank 0 sends");
    return DEM_OK;
}

static void note_sizes(const parcel *p, size_t *sizes)
{
    for (dem_index k = 0; k < p->n; k++) sizes[k] = array_of(&p->items[k]) != NULL ? p->items[k].size : no_array;
}

/* \param n  arrays, known to all ranks */
static dem_status pass_arrays(const ranks *r, int to, parcel *p, dem_index n, size_t *sizes)
{
    if (r->rank == 0) note_sizes(p, sizes);
    parcel_pass(r, to, sizes, (size_t)n * sizeof *sizes);
    TRY(reduce_status(r, r->rank == to ? allocate(p, sizes) : DEM_OK, 0.0));
    for (dem_index k = 0; k < n; k++) {
        const bool takes_part = k < p->n;
        parcel_pass(r, to, takes_part ? array_of(&p->items[k]) : NULL,
                    takes_part && array_of(&p->items[k]) != NULL ? p->items[k].size : 0);
    }
    return DEM_OK;
}

static dem_status check_memory(const parcel *p, const size_t *sizes)
{
    CHECK(!p->lacks_memory && sizes != NULL, DEM_ERROR_MEMORY, "out of memory for a list of what rank 0 sends");
    return DEM_OK;
}

dem_status parcel_send(const ranks *r, int to, parcel *p)
{
    const dem_index n = (dem_index)reduce_max(r, (double)p->n);
    size_t *sizes = malloc(((size_t)n + 1) * sizeof *sizes);
    dem_status status = reduce_status(r, check_memory(p, sizes), 0.0);
    if (status == DEM_OK) status = pass_arrays(r, to, p, n, sizes);
    free(sizes);
    free(p->items);
    *p = (parcel){0};
    return status;
}
