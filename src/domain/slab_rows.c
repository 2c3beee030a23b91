/* SPDX-License-Identifier: BSD-3-Clause */
#include "domain/slab_rows.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/reduce.h"
#include "base/sorted.h"
#include "base/status.h"
#include "domain/domain.h"
#include "lattice/lattice.h"

/* ---- places ---- */

/* What all ranks know of a slab. */
typedef struct place {
    dem_index first, n[LATTICE_ITEMS]; /* number of the first own node; own nodes, owned springs, triangles */
} place;

/* Behind the last own node. */
static dem_index end_own(const slab_rows *s)
{
    const dem_index *own = s->first + s->ranks->rank;
    return s->first_own + (own[1] - own[0]);
}

bool slab_rows_owns(const slab_rows *s, dem_index i)
{
    return i >= s->first_own && i < end_own(s);
}

dem_index slab_rows_number(const slab_rows *s, dem_index i)
{
    if (slab_rows_owns(s, i)) return s->first[s->ranks->rank] + (i - s->first_own);
    return s->rim[i < s->first_own ? i : i - (end_own(s) - s->first_own)];
}

/* The own node of the slab that has a number in the whole. */
static dem_index own_node(const slab_rows *s, dem_index number)
{
    return s->first_own + (number - s->first[s->ranks->rank]);
}

int slab_rows_owner(const slab_rows *s, dem_index number)
{
    return (int)sorted_first(s->first, s->ranks->size + 1, number + 1) - 1;
}

static bool is_own(const dem_slab *slab, dem_index i)
{
    return i >= slab->first_own && i < slab->first_own + slab->n_own;
}

/* Numbers owned springs or triangles from 0 on.  \return how many there are */
static dem_index number_owned(dem_index *number, const dem_slab *slab, const dem_index *corner, int arity, dem_index n)
{
    dem_index owned = 0;
    for (dem_index k = 0; k < n; k++) number[k] = is_own(slab, domain_lowest(corner + arity * k, arity)) ? owned++ : -1;
    return owned;
}

static dem_status make_rows(slab_rows *s, const dem_slab *slab, place *own)
{
    const dem_lattice *l = s->lattice;
    s->first = lattice_zeros(s->ranks->size + 1, sizeof *s->first);
    s->number[LATTICE_SPRINGS] = lattice_zeros(l->n_springs, sizeof *s->number[0]);
    s->number[LATTICE_TRIANGLES] = lattice_zeros(l->n_triangles, sizeof *s->number[0]);
    CHECK(s->first && s->number[LATTICE_SPRINGS] && s->number[LATTICE_TRIANGLES], DEM_ERROR_MEMORY,
          "out of memory for a slab of %lld nodes", (long long)l->n_nodes);
    TRY(node_rows_create(&s->springs, l->ends, 2, l->n_springs, l->n_nodes));
    TRY(node_rows_create(&s->triangles, l->triangles, 3, l->n_triangles, l->n_nodes));
    own->first = slab->first_node;
    own->n[LATTICE_NODES] = slab->n_own;
    own->n[LATTICE_SPRINGS] = number_owned(s->number[LATTICE_SPRINGS], slab, l->ends, 2, l->n_springs);
    own->n[LATTICE_TRIANGLES] = number_owned(s->number[LATTICE_TRIANGLES], slab, l->triangles, 3, l->n_triangles);
    return DEM_OK;
}

/* Each rank tells all others.  \param[out] all  [ranks] */
static dem_status tell_places(const ranks *r, const place *own, place *all)
{
    bundle *sent = calloc((size_t)r->size, sizeof *sent), *received = calloc((size_t)r->size, sizeof *received);
    bool has_room = sent != NULL && received != NULL;
    for (int k = 0; has_room && k < r->size; k++) has_room = bundle_add(&sent[k], own, sizeof *own);
    dem_status status = has_room ? DEM_OK : status_fail(DEM_ERROR_MEMORY, "out of memory for %d ranks", r->size);
    status = reduce_status(r, status, 0.0);
    if (status == DEM_OK) status = bundles_exchange(r, sent, received);
    for (int k = 0; status == DEM_OK && k < r->size; k++) {
        dem_index at = 0;
        bundle_take(k == r->rank ? &sent[k] : &received[k], &at, &all[k], sizeof all[k]);
    }
    bundles_free(sent, r->size);
    bundles_free(received, r->size);
    free(sent);
    free(received);
    return status;
}

/* Where the slab of this rank is among all. */
static void add_places(slab_rows *s, const place *all)
{
    for (int k = 0; k < s->ranks->size; k++) {
        s->first[k] = s->n[LATTICE_NODES];
        for (int of = LATTICE_SPRINGS; of < LATTICE_ITEMS && k == s->ranks->rank; of++) {
            const lattice_items items = (lattice_items)of;
            for (dem_index q = 0; q < lattice_count(s->lattice, items); q++)
                if (s->number[of][q] >= 0) s->number[of][q] += s->n[of];
        }
        for (int of = 0; of < LATTICE_ITEMS; of++) s->n[of] += all[k].n[of];
    }
    s->first[s->ranks->size] = s->n[LATTICE_NODES];
}

static dem_status check_places(const slab_rows *s, const dem_slab *slab, const place *all)
{
    for (int k = 0; k < s->ranks->size; k++)
        CHECK(all[k].first == s->first[k], DEM_ERROR_ARGUMENT,
              "the slab of rank %d begins with node %lld, but those of the ranks before have %lld nodes", k,
              (long long)all[k].first, (long long)s->first[k]);
    CHECK(s->n[LATTICE_NODES] == slab->n_nodes, DEM_ERROR_ARGUMENT,
          "the slabs of %d ranks have %lld nodes, but the whole %lld", s->ranks->size, (long long)s->n[LATTICE_NODES],
          (long long)slab->n_nodes);
    return DEM_OK;
}

/* ---- arrays ---- */

/* Which arrays some rank has, and which some rank lacks. */
typedef struct presence {
    uint32_t has, lacks;
} presence;

static void join_presence(void *packet, const void *other)
{
    presence *p = packet;
    const presence *q = other;
    p->has |= q->has;
    p->lacks |= q->lacks;
}

/* What assembling leaves out where all would be 0, as it may be in one slab and not in another. */
static bool stands_for_zeros(const lattice_array *a)
{
    return a->offset == offsetof(dem_lattice, viscosity) || a->offset == offsetof(dem_lattice, guard) ||
           a->offset == offsetof(dem_lattice, area_stiffness) || a->offset == offsetof(dem_lattice, coupling);
}

/* Makes what only others have.  \param differing  bit k: some rank has lattice_arrays[k], and some lacks it */
static dem_status fill_in(dem_lattice *l, uint32_t differing)
{
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        if ((differing >> k & 1) == 0 || lattice_array_of(l, a) != NULL) continue;
        CHECK(stands_for_zeros(a), DEM_ERROR_ARGUMENT, "the slabs do not have the same arrays");
        void *zeros = lattice_zeros(lattice_count(l, a->of), a->size);
        CHECK(zeros != NULL, DEM_ERROR_MEMORY, "out of memory for a slab of %lld nodes", (long long)l->n_nodes);
        lattice_array_put(l, a, zeros);
    }
    return DEM_OK;
}

/* Node numbers are no items. */
static dem_status find_arrays(slab_rows *s)
{
    presence p = {0};
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        if (lattice_array_is_corners(a) || lattice_count(s->lattice, a->of) == 0) continue;
        *(lattice_array_of(s->lattice, a) != NULL ? &p.has : &p.lacks) |= (uint32_t)1 << k;
    }
    s->ranks->reduce(s->ranks->self, &p, sizeof p, join_presence);
    s->arrays = p.has;
    return reduce_status(s->ranks, fill_in(s->lattice, p.has & p.lacks), 0.0);
}

/* ---- public ---- */

static dem_status complete(slab_rows *s, const dem_slab *slab, const place *own)
{
    place *all = calloc((size_t)s->ranks->size, sizeof *all);
    dem_status status = all != NULL ? DEM_OK : status_fail(DEM_ERROR_MEMORY, "out of memory");
    status = reduce_status(s->ranks, status, 0.0);
    if (status == DEM_OK) status = tell_places(s->ranks, own, all);
    if (status == DEM_OK) {
        add_places(s, all);
        status = reduce_status(s->ranks, check_places(s, slab, all), 0.0);
    }
    free(all);
    TRY(status);
    return find_arrays(s);
}

dem_status slab_rows_create(slab_rows *out, const ranks *r, dem_slab *slab)
{
    place own;
    *out = (slab_rows){.ranks = r, .lattice = &slab->lattice, .first_own = slab->first_own, .rim = slab->rim};
    TRY(reduce_status(r, make_rows(out, slab, &own), 0.0));
    return complete(out, slab, &own);
}

void slab_rows_free(slab_rows *s)
{
    free(s->first);
    for (int of = 0; of < LATTICE_ITEMS; of++) free(s->number[of]);
    node_rows_free(&s->springs);
    node_rows_free(&s->triangles);
    *s = (slab_rows){0};
}

/* ---- a row ---- */

static bool pack_items(const slab_rows *s, lattice_items of, dem_index at, bundle *to)
{
    bool has_room = true;
    for (int k = 0; has_room && k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        if (a->of != of || !slab_rows_has(s, k)) continue;
        has_room = bundle_add(to, (const char *)lattice_array_of(s->lattice, a) + (size_t)at * a->size, a->size);
    }
    return has_room;
}

/* Springs or triangles. */
typedef struct tuples {
    lattice_items of;
    int arity;
    const dem_index *corner; /* [n][arity] */
    const node_rows *rows;
} tuples;

static tuples springs_of(const slab_rows *s)
{
    return (tuples){LATTICE_SPRINGS, 2, s->lattice->ends, &s->springs};
}

static tuples triangles_of(const slab_rows *s)
{
    return (tuples){LATTICE_TRIANGLES, 3, s->lattice->triangles, &s->triangles};
}

static bool is_owned_by(const tuples *t, dem_index k, dem_index i)
{
    return domain_lowest(t->corner + t->arity * k, t->arity) == i;
}

static dem_index count_owned(const tuples *t, dem_index i)
{
    dem_index n = 0;
    for (int32_t p = t->rows->row[i]; p < t->rows->row[i + 1]; p++) n += is_owned_by(t, t->rows->list[p], i);
    return n;
}

/* Nodes of a spring or triangle but for node i itself; some come more than once. */
static dem_index count_next(const tuples *t, dem_index i)
{
    return (dem_index)(t->arity - 1) * (t->rows->row[i + 1] - t->rows->row[i]);
}

static bool pack_tuples(const slab_rows *s, const tuples *t, dem_index i, bundle *to)
{
    bool has_room = true;
    for (int32_t p = t->rows->row[i]; p < t->rows->row[i + 1]; p++)
        for (int c = 0; has_room && c < t->arity; c++) {
            const dem_index corner = t->corner[t->arity * t->rows->list[p] + c], number = slab_rows_number(s, corner);
            has_room = corner == i || bundle_add(to, &number, sizeof number);
        }
    return has_room;
}

static bool pack_owned(const slab_rows *s, const tuples *t, dem_index i, bundle *to)
{
    bool has_room = true;
    for (int32_t p = t->rows->row[i]; has_room && p < t->rows->row[i + 1]; p++) {
        const dem_index k = t->rows->list[p];
        dem_index head[4] = {s->number[t->of][k]}; /* and the nodes */
        if (!is_owned_by(t, k, i)) continue;
        for (int c = 0; c < t->arity; c++) head[1 + c] = slab_rows_number(s, t->corner[t->arity * k + c]);
        has_room = bundle_add(to, head, (size_t)(1 + t->arity) * sizeof *head) && pack_items(s, t->of, k, to);
    }
    return has_room;
}

bool slab_rows_pack_next(const slab_rows *s, dem_index number, bundle *to)
{
    const dem_index i = own_node(s, number);
    const tuples springs = springs_of(s), triangles = triangles_of(s);
    const dem_index n = count_next(&springs, i) + count_next(&triangles, i);
    return bundle_add(to, &n, sizeof n) && pack_tuples(s, &springs, i, to) && pack_tuples(s, &triangles, i, to);
}

bool slab_rows_pack(const slab_rows *s, dem_index number, bundle *to)
{
    const dem_index i = own_node(s, number);
    const tuples springs = springs_of(s), triangles = triangles_of(s);
    const dem_index head[] = {number, count_owned(&springs, i), count_owned(&triangles, i)};
    return bundle_add(to, head, sizeof head) && slab_rows_pack_next(s, number, to) &&
           pack_items(s, LATTICE_NODES, i, to) && pack_owned(s, &springs, i, to) && pack_owned(s, &triangles, i, to);
}
