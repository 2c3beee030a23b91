/* SPDX-License-Identifier: BSD-3-Clause */
/* How packets of ranks are joined (base/ranks.h). Sums are of integers, and the others choose one of two by a total
 * order, so that each is commutative and associative to the bit. */
#include "base/reduce.h"

#include <string.h>

#include "base/status.h"

static void join_min(void *packet, const void *other)
{
    double *const own = packet;
    const double theirs = *(const double *)other;
    if (theirs < *own) *own = theirs;
}

double reduce_min(const ranks *r, double own)
{
    r->reduce(r->self, &own, sizeof own, join_min);
    return own;
}

static void join_max(void *packet, const void *other)
{
    double *const own = packet;
    *own = reduce_larger(*own, *(const double *)other);
}

double reduce_max(const ranks *r, double own)
{
    r->reduce(r->self, &own, sizeof own, join_max);
    return own;
}

static void join_any(void *packet, const void *other)
{
    bool *const own = packet;
    *own = *own || *(const bool *)other;
}

bool reduce_any(const ranks *r, bool own)
{
    r->reduce(r->self, &own, sizeof own, join_any);
    return own;
}

typedef struct likeness {
    uint64_t least, most;
} likeness;

static void join_likenesses(void *packet, const void *other)
{
    likeness *const own = packet;
    const likeness *theirs = other;
    if (theirs->least < own->least) own->least = theirs->least;
    if (theirs->most > own->most) own->most = theirs->most;
}

bool reduce_alike(const ranks *r, uint64_t own)
{
    likeness all = {own, own};
    r->reduce(r->self, &all, sizeof all, join_likenesses);
    return all.least == all.most;
}

static void join_count(void *packet, const void *other)
{
    *(dem_index *)packet += *(const dem_index *)other;
}

dem_index reduce_count(const ranks *r, dem_index own)
{
    r->reduce(r->self, &own, sizeof own, join_count);
    return own;
}

enum { COUNTS_MOST = 256 };

typedef struct several_counts {
    dem_index n, counts[COUNTS_MOST]; /* [n] are sent */
} several_counts;

static void join_counts(void *packet, const void *other)
{
    several_counts *own = packet;
    for (dem_index k = 0; k < own->n; k++) own->counts[k] += ((const several_counts *)other)->counts[k];
}

void reduce_counts(const ranks *r, dem_index *counts, dem_index n)
{
    for (dem_index first = 0; first < n && r->size > 1; first += COUNTS_MOST) {
        several_counts all = {.n = n - first < COUNTS_MOST ? n - first : COUNTS_MOST};
        const size_t size = (size_t)all.n * sizeof *counts;
        memcpy(all.counts, counts + first, size);
        r->reduce(r->self, &all, offsetof(several_counts, counts) + size, join_counts);
        memcpy(counts + first, all.counts, size);
    }
}

static void join_sum(void *packet, const void *other)
{
    exact_sum more = *(const exact_sum *)other;
    exact_sum_join(packet, &more);
}

double reduce_sum(const ranks *r, const exact_sum *own)
{
    if (r->size == 1) return exact_sum_value(own); /* a copy would take longer than most sums */
    exact_sum all = *own;
    r->reduce(r->self, &all, sizeof all, join_sum);
    return exact_sum_value(&all);
}

typedef struct several {
    int n;
    exact_sum sums[REDUCE_SUMS_MOST]; /* [n] are sent */
} several;

static void join_several(void *packet, const void *other)
{
    several *own = packet;
    for (int k = 0; k < own->n; k++) join_sum(&own->sums[k], &((const several *)other)->sums[k]);
}

void reduce_sums(const ranks *r, const exact_sum *const *own, int n, double *values)
{
    several all = {.n = n};
    if (r->size > 1) {
        for (int k = 0; k < n; k++) all.sums[k] = *own[k];
        r->reduce(r->self, &all, offsetof(several, sums) + (size_t)n * sizeof(exact_sum), join_several);
    }
    for (int k = 0; k < n; k++) values[k] = exact_sum_value(r->size > 1 ? &all.sums[k] : own[k]);
}

static void join_squares(void *packet, const void *other)
{
    array_ops_add(packet, other);
}

array_ops_sum reduce_squares(const ranks *r, array_ops_sum own)
{
    r->reduce(r->self, &own, sizeof own, join_squares);
    return own;
}

typedef struct report {
    bool is_known;
    double values[REDUCE_REPORT_MOST];
} report;

static void join_reports(void *packet, const void *other)
{
    if (!((const report *)packet)->is_known) *(report *)packet = *(const report *)other;
}

void reduce_report(const ranks *r, bool is_here, double *values, int n)
{
    report all = {.is_known = is_here};
    if (r->size == 1) return;
    for (int k = 0; k < n && is_here; k++) all.values[k] = values[k];
    r->reduce(r->self, &all, sizeof all, join_reports);
    for (int k = 0; k < n; k++) values[k] = all.values[k];
}

/* ---- failures ---- */

/* One that has not failed has no rank. */
typedef struct failure {
    dem_status status;
    int rank;
    double key;
} failure;

static bool is_before(const failure *a, const failure *b)
{
    if (a->status == DEM_OK || b->status == DEM_OK) return a->status != DEM_OK && b->status == DEM_OK;
    return a->key != b->key ? a->key < b->key : a->rank < b->rank;
}

static void join_failures(void *packet, const void *other)
{
    if (is_before(other, packet)) *(failure *)packet = *(const failure *)other;
}

/* Of all texts but one nothing is left, not even a first character. */
static void join_texts(void *packet, const void *other)
{
    if (*(const char *)packet == '\0') memcpy(packet, other, STATUS_MESSAGE_SIZE);
}

dem_status reduce_status(const ranks *r, dem_status own, double key)
{
    failure first = {own, r->rank, key};
    r->reduce(r->self, &first, sizeof first, join_failures);
    if (r->size == 1 || first.status == DEM_OK) return first.status;
    char text[STATUS_MESSAGE_SIZE] = "";
    if (first.rank == r->rank) (void)strcpy(text, dem_status_message());
    r->reduce(r->self, text, sizeof text, join_texts);
    return status_repeat(first.status, text);
}
