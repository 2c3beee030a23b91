/* SPDX-License-Identifier: BSD-3-Clause */
#include "domain/balance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "domain/partition.h"

static const double least_loss = 0.05; /* of the work of the busiest rank */

dem_status balance_create(balance *b, int n_ranks)
{
    *b = (balance){.n_ranks = n_ranks};
    b->busy = calloc((size_t)n_ranks, sizeof *b->busy);
    b->reports = calloc((size_t)n_ranks, sizeof *b->reports);
    b->requests = calloc((size_t)n_ranks, sizeof *b->requests);
    b->n_own = calloc((size_t)n_ranks, sizeof *b->n_own);
    b->n_start = calloc((size_t)n_ranks, sizeof *b->n_start);
    CHECK(b->busy && b->reports && b->requests && b->n_own && b->n_start, DEM_ERROR_MEMORY,
          "out of memory for %d ranks", n_ranks);
    return DEM_OK;
}

void balance_free(balance *b)
{
    free(b->weights);
    free(b->busy);
    free(b->reports);
    free(b->requests);
    free(b->n_own);
    free(b->n_start);
    *b = (balance){0};
}

void balance_begin(balance *b, double price)
{
    b->n_shared++;
    b->price = price;
}

void balance_go_on(balance *b, double price)
{
    b->price = price;
}

/* Messages go both ways: those of rank 0 are empty.
 * \param all  [n_ranks] on rank 0, a number of 8 bytes of each rank */
static void collect(balance *b, const ranks *r, void *own, void *all)
{
    enum { SIZE = 8 };
    if (r->rank > 0) {
        const ranks_message report = {0, SIZE, own}, request = {0, 0, NULL};
        r->exchange(r->self, 1, &report, &request);
        return;
    }
    memcpy(all, own, SIZE);
    for (int k = 1; k < b->n_ranks; k++) {
        b->reports[k - 1] = (ranks_message){k, SIZE, (char *)all + (ptrdiff_t)k * SIZE};
        b->requests[k - 1] = (ranks_message){k, 0, NULL};
    }
    r->exchange(r->self, b->n_ranks - 1, b->requests, b->reports);
}

void balance_collect(balance *b, const ranks *r, double own)
{
    collect(b, r, &own, b->busy);
}

void balance_count(balance *b, const ranks *r, dem_index own)
{
    collect(b, r, &own, b->n_own);
    if (r->rank == 0 && b->n_start[0] == 0) memcpy(b->n_start, b->n_own, (size_t)b->n_ranks * sizeof *b->n_own);
}

bool balance_pays(const balance *b)
{
    double sum = 0.0, most = 0.0;
    for (int k = 0; k < b->n_ranks; k++) {
        sum += b->busy[k];
        most = fmax(most, b->busy[k]);
    }
    const double lost = most - sum / b->n_ranks;
    return lost > ldexp(b->price, b->n_shared - 1) && lost > least_loss * most;
}

/* \param owner  [nodes]
 * \param counts [n_ranks] all 0 */
static void spread(const balance *b, dem_index n_nodes, const int32_t *owner, dem_index *counts, double *weights)
{
    for (dem_index i = 0; i < n_nodes; i++) counts[owner[i]]++;
    for (dem_index i = 0; i < n_nodes; i++) weights[i] = b->busy[owner[i]] / (double)counts[owner[i]];
}

dem_status balance_weigh(balance *b, const dem_lattice *whole)
{
    double *weights = malloc((size_t)whole->n_nodes * sizeof *weights);
    int32_t *owner = malloc((size_t)whole->n_nodes * sizeof *owner);
    dem_index *counts = calloc((size_t)b->n_ranks, sizeof *counts);
    dem_status status = DEM_OK;
    if (weights == NULL || owner == NULL || counts == NULL)
        status =
            status_fail(DEM_ERROR_MEMORY, "out of memory for the weights of %lld nodes", (long long)whole->n_nodes);
    if (status == DEM_OK) status = partition_bisect_weighted(whole, b->weights, b->n_ranks, owner);
    if (status == DEM_OK) {
        spread(b, whole->n_nodes, owner, counts, weights);
        free(b->weights);
        b->weights = weights;
        weights = NULL;
    }
    free(weights);
    free(owner);
    free(counts);
    return status;
}

/* ---- ranges ---- */

void balance_ranges(const balance *b, dem_index *first)
{
    first[0] = 0;
    for (int k = 0; k < b->n_ranks; k++) first[k + 1] = first[k] + b->n_own[k];
}

/* How many of the first nodes have been so much work, in s. */
static dem_index count_until(const balance *b, double work)
{
    dem_index n = 0;
    int k = 0;
    for (; k < b->n_ranks - 1 && work > b->busy[k]; k++) {
        work -= b->busy[k];
        n += b->n_own[k];
    }
    const double share = b->busy[k] > 0.0 ? fmin(1.0, work / b->busy[k]) : 0.0;
    return n + (dem_index)(share * (double)b->n_own[k]);
}

/* Of n nodes at first. */
static dem_index least_of(dem_index n)
{
    return n / 4;
}

static dem_index most_of(dem_index n)
{
    return (5 * n + 3) / 4; /* rounded up, so that parts have no less together than all at once */
}

static dem_index larger(dem_index a, dem_index b)
{
    return a > b ? a : b;
}

static dem_index smaller(dem_index a, dem_index b)
{
    return a < b ? a : b;
}

/* What is left for the ranks behind has to be between their bounds, too. */
void balance_cut(const balance *b, dem_index *first)
{
    dem_index rest = 0, all = 0;
    double work = 0.0;
    for (int k = 0; k < b->n_ranks; k++) {
        rest += b->n_start[k];
        work += b->busy[k];
    }
    all = rest;
    first[0] = 0;
    for (int k = 0; k < b->n_ranks; k++) {
        const dem_index own = b->n_start[k], even = count_until(b, work * (k + 1) / b->n_ranks);
        rest -= own;
        const dem_index least = larger(first[k] + least_of(own), all - most_of(rest));
        const dem_index most = smaller(first[k] + most_of(own), all - least_of(rest));
        first[k + 1] = larger(least, smaller(even, most));
    }
}
