/* SPDX-License-Identifier: BSD-3-Clause */
#include "domain/balance.h"

#include <math.h>
#include <stdlib.h>

#include "base/status.h"
#include "domain/partition.h"

static const double least_loss = 0.05; /* of the work of the busiest rank */

dem_status balance_create(balance *b, int n_ranks)
{
    *b = (balance){.n_ranks = n_ranks};
    b->busy = calloc((size_t)n_ranks, sizeof *b->busy);
    b->reports = calloc((size_t)n_ranks, sizeof *b->reports);
    b->requests = calloc((size_t)n_ranks, sizeof *b->requests);
    CHECK(b->busy != NULL && b->reports != NULL && b->requests != NULL, DEM_ERROR_MEMORY, "out of memory for %d ranks",
          n_ranks);
    return DEM_OK;
}

void balance_free(balance *b)
{
    free(b->weights);
    free(b->busy);
    free(b->reports);
    free(b->requests);
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

/* Messages go both ways: those of rank 0 are empty. */
void balance_collect(balance *b, const ranks *r, double own)
{
    if (r->rank > 0) {
        const ranks_message report = {0, sizeof own, &own}, request = {0, 0, NULL};
        r->exchange(r->self, 1, &report, &request);
        return;
    }
    b->busy[0] = own;
    for (int k = 1; k < b->n_ranks; k++) {
        b->reports[k - 1] = (ranks_message){k, sizeof own, &b->busy[k]};
        b->requests[k - 1] = (ranks_message){k, 0, NULL};
    }
    r->exchange(r->self, b->n_ranks - 1, b->requests, b->reports);
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
