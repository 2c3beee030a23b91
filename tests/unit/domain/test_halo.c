/* SPDX-License-Identifier: BSD-3-Clause */
/* halo.c: after an exchange ghosts have what their owners have, in one array and in two at once. */
#include "unit/domain/shared_lattice.h"

#include "domain/halo.h"
#include "harness/rank_threads.h"

enum { N_RANKS = 6 };

typedef struct exchange {
    const dem_lattice *lattice;
    const int32_t *owner;
    dem_index wrong[N_RANKS]; /* numbers that are not as they should be; -1: no halo */
} exchange;

static double value(dem_index number, int component)
{
    return sin(1.0 + (double)number) + component;
}

/* Ghosts have NAN first. */
static void fill(const domain *d, double *array, int first)
{
    for (dem_index k = 0; k < 2 * d->n_nodes; k++)
        array[k] = d->is_own[k / 2] ? value(d->number[k / 2], first + (int)(k % 2)) : (double)NAN;
}

static dem_index count_wrong(const domain *d, const double *array, int first)
{
    dem_index n = 0;
    for (dem_index k = 0; k < 2 * d->n_nodes; k++) n += array[k] != value(d->number[k / 2], first + (int)(k % 2));
    return n;
}

static void swap_rows(const ranks *r, void *context)
{
    exchange *e = context;
    domain d;
    halo h;
    e->wrong[r->rank] = -1;
    const domain_shares shares = {.n_ranks = r->size, .owner = e->owner};
    if (domain_create(&d, e->lattice, &shares, r->rank) != DEM_OK || halo_create(&h, r, &d, 2, 2) != DEM_OK) return;
    double *const arrays[] = {calloc(2 * (size_t)d.n_nodes, sizeof(double)),
                              calloc(2 * (size_t)d.n_nodes, sizeof(double))};
    fill(&d, arrays[0], 0);
    fill(&d, arrays[1], 10);
    halo_exchange(&h, arrays, 2);
    e->wrong[r->rank] = count_wrong(&d, arrays[0], 0) + count_wrong(&d, arrays[1], 10);
    fill(&d, arrays[1], 20);
    halo_exchange(&h, arrays + 1, 1);
    e->wrong[r->rank] += count_wrong(&d, arrays[1], 20);
    free(arrays[0]);
    free(arrays[1]);
    halo_destroy(&h);
    domain_free(&d);
}

TEST(ghosts_get_what_their_owners_have)
{
    CLEANUP(dem_lattice_free) dem_lattice l = shared_disc();
    CLEANUP(free_memory) int32_t *owner = shared_owners(&l, N_RANKS);
    exchange e = {.lattice = &l, .owner = owner};
    rank_threads_run(N_RANKS, swap_rows, &e);
    for (int k = 0; k < N_RANKS; k++) assert_int_equal(e.wrong[k], 0);
}
