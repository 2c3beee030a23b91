/* SPDX-License-Identifier: BSD-3-Clause */
/* A message has the rows of the first array, then those of the next. */
#include "domain/halo.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

dem_status halo_create(halo *out, const ranks *r, const domain *d, int dim, int most_arrays)
{
    halo h = {.ranks = r, .domain = d, .dim = dim};
    size_t n_rows = 0;
    for (int k = 0; k < d->n_neighbours; k++) n_rows += (size_t)(d->neighbours[k].n_sent + d->neighbours[k].n_received);
    h.rows = malloc((n_rows * (size_t)dim * (size_t)most_arrays + 1) * sizeof *h.rows);
    h.sent = calloc((size_t)d->n_neighbours + 1, sizeof *h.sent);
    h.received = calloc((size_t)d->n_neighbours + 1, sizeof *h.received);
    if (h.rows != NULL && h.sent != NULL && h.received != NULL) {
        *out = h;
        return DEM_OK;
    }
    halo_destroy(&h);
    return status_fail(DEM_ERROR_MEMORY, "out of memory for %zu ghosts", n_rows);
}

void halo_destroy(halo *h)
{
    free(h->rows);
    free(h->sent);
    free(h->received);
    *h = (halo){0};
}

static size_t row_size(const halo *h)
{
    return (size_t)h->dim * sizeof(double);
}

/* Lays the messages out in the buffer. */
static void lay_out(halo *h, int n_arrays)
{
    char *next = (char *)h->rows;
    for (int k = 0; k < h->domain->n_neighbours; k++) {
        const domain_neighbour *one = &h->domain->neighbours[k];
        const size_t to = (size_t)one->n_sent * (size_t)n_arrays * row_size(h);
        const size_t from = (size_t)one->n_received * (size_t)n_arrays * row_size(h);
        h->sent[k] = (ranks_message){one->rank, to, next};
        h->received[k] = (ranks_message){one->rank, from, next + to};
        next += to + from;
    }
}

/* How many of the n nodes, from the first one on, are numbered one after the other: of a lattice row, or a stretch of
 * it, they are copied at once. */
static dem_index count_run(const dem_index *nodes, dem_index n)
{
    dem_index k = 1;
    while (k < n && nodes[k] == nodes[0] + k) k++;
    return k;
}

static char *pack(const halo *h, char *to, const double *array, const dem_index *nodes, dem_index n)
{
    for (dem_index k = 0, run; k < n; k += run, to += (size_t)run * row_size(h)) {
        run = count_run(nodes + k, n - k);
        memcpy(to, array + h->dim * nodes[k], (size_t)run * row_size(h));
    }
    return to;
}

static const char *unpack(const halo *h, const char *from, double *array, const dem_index *nodes, dem_index n)
{
    for (dem_index k = 0, run; k < n; k += run, from += (size_t)run * row_size(h)) {
        run = count_run(nodes + k, n - k);
        memcpy(array + h->dim * nodes[k], from, (size_t)run * row_size(h));
    }
    return from;
}

void halo_exchange(halo *h, double *const *arrays, int n_arrays)
{
    const domain *d = h->domain;
    lay_out(h, n_arrays);
    for (int k = 0; k < d->n_neighbours; k++) {
        char *to = h->sent[k].bytes;
        for (int a = 0; a < n_arrays; a++) to = pack(h, to, arrays[a], d->neighbours[k].sent, d->neighbours[k].n_sent);
    }
    h->ranks->exchange(h->ranks->self, d->n_neighbours, h->sent, h->received);
    for (int k = 0; k < d->n_neighbours; k++) {
        const domain_neighbour *one = &d->neighbours[k];
        const char *from = h->received[k].bytes;
        for (int a = 0; a < n_arrays; a++) from = unpack(h, from, arrays[a], one->received, one->n_received);
    }
}
