/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of other ranks come as they are asked for, each once, and are put in the order of the whole when all are there.
 * Springs and triangles come with their lowest nodes; those that go beyond the last ring are left out. What the rank
 * owns has the order of the whole in its slab, and nothing of others between: it stays in the arrays of the slab, which
 * lose what others own and get what has come, one array after the other, so that nothing of the slab is there twice. */
#include "domain/region.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/reduce.h"
#include "base/sorted.h"
#include "base/status.h"
#include "lattice/lattice.h"
#include "lattice/lattice_cut.h"

typedef struct numbers {
    dem_index n, capacity;
    dem_index *list; /* [n] */
} numbers;

/* A region in the making. Corners are numbers of the whole until it is in order. */
typedef struct draft {
    slab_rows *rows;
    bool has_own;      /* whether all own nodes are known, which then are in no list */
    numbers common;    /* nodes that any rank has marked, ascending */
    numbers known;     /* nodes that have been asked for, ascending */
    numbers next;      /* nodes next to these, as they have come */
    numbers wanted;    /* nodes to be asked for, ascending */
    dem_lattice found; /* of other ranks, in the order in which it has come */
    dem_index capacity[LATTICE_ITEMS];
    numbers number[LATTICE_ITEMS];
    bundle *asking, *asked, *giving, *given; /* [ranks] */
} draft;

static bool add(numbers *to, dem_index number)
{
    if (!grow_array((void **)&to->list, &to->capacity, to->n + 1, sizeof *to->list)) return false;
    to->list[to->n++] = number;
    return true;
}

/* The number of the first node of this rank, and the one behind its last. */
static const dem_index *own_of(const draft *d)
{
    return d->rows->first + d->rows->ranks->rank;
}

static bool is_own(const draft *d, dem_index number)
{
    const dem_index *own = own_of(d);
    return number >= own[0] && number < own[1];
}

static dem_status lacks_memory(void)
{
    return status_fail(DEM_ERROR_MEMORY, "out of memory for what a rank has of the slabs of others");
}

/* ---- rows that have come ---- */

static dem_index *count_of(dem_lattice *l, lattice_items of)
{
    dem_index *const counts[] = {&l->n_nodes, &l->n_springs, &l->n_triangles};
    return counts[of];
}

/* Whether there is array k of lattice_arrays: those that are in rows, and those of corners. */
static bool has_array(const draft *d, int k)
{
    return lattice_array_is_corners(&lattice_arrays[k]) || slab_rows_has(d->rows, k);
}

/* Makes room for one more in all of them. */
static bool make_room(draft *d, lattice_items of)
{
    dem_index room = d->capacity[of];
    const dem_index needed = *count_of(&d->found, of) + 1;
    for (int k = 0; k < LATTICE_ARRAYS && needed > d->capacity[of]; k++) {
        const lattice_array *a = &lattice_arrays[k];
        void *items = lattice_array_of(&d->found, a);
        room = d->capacity[of];
        if (a->of != of || !has_array(d, k)) continue;
        if (!grow_array(&items, &room, needed, a->size)) return false;
        lattice_array_put(&d->found, a, items);
    }
    d->capacity[of] = needed > d->capacity[of] ? room : d->capacity[of];
    return true;
}

static void take_items(draft *d, lattice_items of, const bundle *from, dem_index *at)
{
    const dem_index n = *count_of(&d->found, of);
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        if (a->of == of && slab_rows_has(d->rows, k))
            bundle_take(from, at, (char *)lattice_array_of(&d->found, a) + (size_t)n * a->size, a->size);
    }
}

static bool take_owned(draft *d, lattice_items of, dem_index *corner, int arity, const bundle *from, dem_index *at)
{
    dem_index number;
    bundle_take(from, at, &number, sizeof number);
    bundle_take(from, at, corner, (size_t)arity * sizeof *corner);
    take_items(d, of, from, at);
    ++*count_of(&d->found, of);
    return add(&d->number[of], number);
}

/* As slab_rows_pack_next() has written it. */
static bool take_next(draft *d, const bundle *from, dem_index *at)
{
    bool has_room = true;
    dem_index n;
    bundle_take(from, at, &n, sizeof n);
    for (dem_index k = 0; has_room && k < n; k++) {
        dem_index number;
        bundle_take(from, at, &number, sizeof number);
        has_room = (d->has_own && is_own(d, number)) || add(&d->next, number);
    }
    return has_room;
}

/* As slab_rows_pack() has written it. */
static bool take_row(draft *d, const bundle *from, dem_index *at)
{
    dem_index head[3];
    dem_lattice *l = &d->found;
    bundle_take(from, at, head, sizeof head);
    if (!take_next(d, from, at) || !make_room(d, LATTICE_NODES)) return false;
    take_items(d, LATTICE_NODES, from, at);
    l->n_nodes++;
    bool has_room = add(&d->number[LATTICE_NODES], head[0]);
    for (dem_index k = 0; has_room && k < head[1]; k++)
        has_room =
            make_room(d, LATTICE_SPRINGS) && take_owned(d, LATTICE_SPRINGS, l->ends + 2 * l->n_springs, 2, from, at);
    for (dem_index k = 0; has_room && k < head[2]; k++)
        has_room = make_room(d, LATTICE_TRIANGLES) &&
                   take_owned(d, LATTICE_TRIANGLES, l->triangles + 3 * l->n_triangles, 3, from, at);
    return has_room;
}

static dem_status take_rows(draft *d, const bundle *from)
{
    for (dem_index at = 0; at < from->n;)
        if (!take_row(d, from, &at)) return lacks_memory();
    return DEM_OK;
}

/* ---- rounds ---- */

/* Of an own node only what is next to it is looked for. */
static bool look_about(draft *d, dem_index number, bundle *next)
{
    dem_index at = 0;
    next->n = 0;
    return slab_rows_pack_next(d->rows, number, next) && take_next(d, next, &at);
}

static dem_status ask(draft *d)
{
    bundle next = {0};
    bool has_room = true;
    for (dem_index k = 0; has_room && k < d->wanted.n; k++) {
        const dem_index number = d->wanted.list[k];
        has_room = is_own(d, number) ? look_about(d, number, &next)
                                     : bundle_add(&d->asking[slab_rows_owner(d->rows, number)], &number, sizeof number);
    }
    bundles_free(&next, 1);
    return has_room ? DEM_OK : lacks_memory();
}

static dem_status answer(const draft *d, const bundle *questions, bundle *answers)
{
    for (dem_index at = 0; at < questions->n;) {
        dem_index number;
        bundle_take(questions, &at, &number, sizeof number);
        if (!slab_rows_pack(d->rows, number, answers)) return lacks_memory();
    }
    return DEM_OK;
}

static dem_status answer_all(draft *d)
{
    for (int k = 0; k < d->rows->ranks->size; k++) TRY(answer(d, &d->asked[k], &d->giving[k]));
    return DEM_OK;
}

static dem_status take_all(draft *d)
{
    for (int k = 0; k < d->rows->ranks->size; k++) TRY(take_rows(d, &d->given[k]));
    return DEM_OK;
}

/* Nodes to be asked for are known afterwards. */
static dem_status merge_known(draft *d)
{
    numbers all = {.list = malloc(((size_t)(d->known.n + d->wanted.n) + 1) * sizeof *all.list)};
    if (all.list == NULL) return lacks_memory();
    all.n = all.capacity = sorted_merge(all.list, d->known.list, d->known.n, d->wanted.list, d->wanted.n);
    free(d->known.list);
    d->known = all;
    return DEM_OK;
}

static dem_status exchange(draft *d)
{
    const ranks *r = d->rows->ranks;
    TRY(reduce_status(r, ask(d), 0.0));
    TRY(bundles_exchange(r, d->asking, d->asked));
    TRY(reduce_status(r, answer_all(d), 0.0));
    TRY(bundles_exchange(r, d->giving, d->given));
    TRY(reduce_status(r, take_all(d), 0.0));
    return reduce_status(r, merge_known(d), 0.0);
}

/* Gets the rows of the nodes that are wanted, none of which is known. */
static dem_status fetch(draft *d)
{
    bundle *const all[] = {d->asking, d->asked, d->giving, d->given};
    const dem_status status = exchange(d);
    for (int k = 0; k < 4; k++) bundles_free(all[k], d->rows->ranks->size);
    return status;
}

/* Of a list that is put in order those that are not known. */
static dem_status want(draft *d, numbers *from)
{
    dem_index k = 0;
    d->wanted.n = 0;
    from->n = sorted_make(from->list, from->n);
    for (dem_index q = 0; q < from->n; q++) {
        while (k < d->known.n && d->known.list[k] < from->list[q]) k++;
        const bool is_known =
            (k < d->known.n && d->known.list[k] == from->list[q]) || (d->has_own && is_own(d, from->list[q]));
        if (!is_known && !add(&d->wanted, from->list[q])) return lacks_memory();
    }
    return DEM_OK;
}

static dem_status fetch_rings(draft *d, int n)
{
    for (int ring = 0; ring < n; ring++) {
        TRY(reduce_status(d->rows->ranks, want(d, &d->next), 0.0));
        d->next.n = 0;
        TRY(fetch(d));
    }
    return DEM_OK;
}

/* ---- common and own nodes ---- */

/* \param is_common  as region_extent has it */
static dem_status list_marked(draft *d, const unsigned char *is_common)
{
    const slab_rows *s = d->rows;
    for (dem_index i = 0; i < s->lattice->n_nodes; i++)
        if (is_common[i] && slab_rows_owns(s, i) && !add(&d->wanted, slab_rows_number(s, i))) return lacks_memory();
    return DEM_OK;
}

static dem_status send_marked(draft *d)
{
    for (int k = 0; k < d->rows->ranks->size; k++)
        if (!bundle_add(&d->asking[k], d->wanted.list, (size_t)d->wanted.n * sizeof *d->wanted.list))
            return lacks_memory();
    return DEM_OK;
}

static dem_status take_marked(draft *d)
{
    const int rank = d->rows->ranks->rank;
    for (int k = 0; k < d->rows->ranks->size; k++) {
        const bundle *from = k == rank ? &d->asking[k] : &d->asked[k];
        for (dem_index at = 0; at < from->n;) {
            dem_index number;
            bundle_take(from, &at, &number, sizeof number);
            if (!add(&d->common, number)) return lacks_memory();
        }
    }
    return DEM_OK;
}

/* Of all ranks. */
static dem_status gather_marked(draft *d, const unsigned char *is_common)
{
    const ranks *r = d->rows->ranks;
    dem_status status = list_marked(d, is_common);
    if (status == DEM_OK) status = send_marked(d);
    status = reduce_status(r, status, 0.0);
    if (status == DEM_OK) status = bundles_exchange(r, d->asking, d->asked);
    if (status == DEM_OK) status = reduce_status(r, take_marked(d), 0.0);
    bundles_free(d->asking, r->size);
    bundles_free(d->asked, r->size);
    return status;
}

static dem_status fetch_common(draft *d, const region_extent *extent)
{
    TRY(gather_marked(d, extent->is_common));
    TRY(reduce_status(d->rows->ranks, want(d, &d->common), 0.0));
    TRY(fetch(d));
    return fetch_rings(d, extent->common_rings);
}

static void forget_own(numbers *list, const draft *d)
{
    dem_index kept = 0;
    for (dem_index k = 0; k < list->n; k++)
        if (!is_own(d, list->list[k])) list->list[kept++] = list->list[k];
    list->n = kept;
}

/* All that is next to own nodes, without a message: there are many. */
static dem_status take_own(draft *d)
{
    const dem_index *own = own_of(d);
    bundle next = {0};
    bool has_room = true;
    d->has_own = true;
    forget_own(&d->known, d);
    for (dem_index number = own[0]; has_room && number < own[1]; number++) has_room = look_about(d, number, &next);
    bundles_free(&next, 1);
    return has_room ? DEM_OK : lacks_memory();
}

/* ---- in the order of the whole ---- */

typedef struct arrival {
    dem_index number, at;
} arrival;

static int compare(const void *a, const void *b)
{
    const arrival *p = a, *q = b;
    return (p->number > q->number) - (p->number < q->number);
}

/* What of nodes, springs or triangles is in the region. */
typedef struct order {
    dem_index n_own, *own; /* [n_own] what this rank owns: places in the slab, ascending */
    dem_index n, *at;      /* [n] what others own: places in the draft, by numbers of the whole, */
    dem_index n_before;    /* of which so many are below those of what this rank owns */
} order;

static int arity_of(lattice_items of)
{
    static const int arity[LATTICE_ITEMS] = {[LATTICE_SPRINGS] = 2, [LATTICE_TRIANGLES] = 3};
    return arity[of];
}

static dem_index *corners_of(const dem_lattice *l, lattice_items of)
{
    return of == LATTICE_SPRINGS ? l->ends : l->triangles;
}

/* \param n_before  nodes of others before own ones
 * \return the number in the region of a node of the whole; -1: it is not there */
static dem_index node_in_region(const draft *d, dem_index n_before, dem_index number)
{
    const dem_index *own = own_of(d);
    if (is_own(d, number)) return n_before + number - own[0];
    const dem_index k = sorted_find(d->known.list, d->known.n, number);
    return k < n_before ? k : k + own[1] - own[0];
}

/* \param rows  the lattice is that of the slab; NULL: corners are numbers of the whole */
static void replace_corners(const draft *d, const slab_rows *rows, const dem_lattice *l)
{
    const dem_index n_before = sorted_first(d->known.list, d->known.n, own_of(d)[0]);
    for (int of = LATTICE_SPRINGS; of < LATTICE_ITEMS; of++) {
        const lattice_items items = (lattice_items)of;
        dem_index *corner = corners_of(l, items);
        for (dem_index k = 0; k < arity_of(items) * lattice_count(l, items); k++)
            corner[k] = node_in_region(d, n_before, rows != NULL ? slab_rows_number(rows, corner[k]) : corner[k]);
    }
}

/* Whether all corners of an item are in the region. */
static bool is_entire(const dem_lattice *l, lattice_items of, dem_index k)
{
    const int arity = arity_of(of);
    bool entire = true;
    for (int c = 0; c < arity; c++) entire = entire && corners_of(l, of)[arity * k + c] >= 0;
    return entire;
}

/* The number in the whole of item k of the slab; -1: another rank owns it. */
static dem_index number_in_slab(const slab_rows *s, lattice_items of, dem_index k)
{
    if (of != LATTICE_NODES) return s->number[of][k];
    return slab_rows_owns(s, k) ? slab_rows_number(s, k) : -1;
}

static dem_status list_owned(order *o, const slab_rows *s, lattice_items of)
{
    const dem_index n = lattice_count(s->lattice, of);
    o->own = malloc(((size_t)n + 1) * sizeof *o->own);
    if (o->own == NULL) return lacks_memory();
    for (dem_index k = 0; k < n; k++)
        if (number_in_slab(s, of, k) >= 0 && is_entire(s->lattice, of, k)) o->own[o->n_own++] = k;
    return DEM_OK;
}

static dem_status list_others(order *o, const draft *d, lattice_items of)
{
    const numbers *number = &d->number[of];
    const dem_index first = o->n_own > 0 ? number_in_slab(d->rows, of, o->own[0]) : INT64_MAX;
    arrival *list = malloc(((size_t)number->n + 1) * sizeof *list);
    o->at = malloc(((size_t)number->n + 1) * sizeof *o->at);
    const bool has_room = list != NULL && o->at != NULL;
    for (dem_index k = 0; has_room && k < number->n; k++)
        if (is_entire(&d->found, of, k)) list[o->n++] = (arrival){number->list[k], k};
    if (has_room) qsort(list, (size_t)o->n, sizeof *list, compare);
    for (dem_index k = 0; has_room && k < o->n; k++) {
        o->at[k] = list[k].at;
        o->n_before += list[k].number < first;
    }
    free(list);
    return has_room ? DEM_OK : lacks_memory();
}

/* The place in the region of item k of those that others own. */
static dem_index place_of(const order *o, dem_index k)
{
    return k < o->n_before ? k : k + o->n_own;
}

static dem_status list_numbers(region *g, const draft *d, const order *o, lattice_items of)
{
    dem_index *list = malloc(((size_t)(o->n_own + o->n) + 1) * sizeof *list);
    if (list == NULL) return lacks_memory();
    for (dem_index k = 0; k < o->n_own; k++) list[o->n_before + k] = number_in_slab(d->rows, of, o->own[k]);
    for (dem_index k = 0; k < o->n; k++) list[place_of(o, k)] = d->number[of].list[o->at[k]];
    g->number[of] = list;
    return DEM_OK;
}

/* Takes an array of the slab, in which what this rank owns comes first, over. */
static dem_status take_array(region *g, draft *d, const order *o, const lattice_array *a)
{
    const size_t size = a->size;
    char *items = realloc(lattice_array_of(d->rows->lattice, a), (size_t)(o->n_own + o->n) * size + 1);
    char *others = lattice_array_of(&d->found, a);
    if (items == NULL) return lacks_memory();
    lattice_array_put(d->rows->lattice, a, NULL);
    lattice_array_put(&g->lattice, a, items);
    memmove(items + (size_t)o->n_before * size, items, (size_t)o->n_own * size);
    for (dem_index k = 0; k < o->n; k++)
        memcpy(items + (size_t)place_of(o, k) * size, others + (size_t)o->at[k] * size, size);
    lattice_array_put(&d->found, a, NULL);
    free(others);
    return DEM_OK;
}

static dem_status list_all(region *g, draft *d, order *o)
{
    replace_corners(d, NULL, &d->found);
    replace_corners(d, d->rows, d->rows->lattice);
    for (int of = 0; of < LATTICE_ITEMS; of++) {
        TRY(list_owned(&o[of], d->rows, (lattice_items)of));
        TRY(list_others(&o[of], d, (lattice_items)of));
        TRY(list_numbers(g, d, &o[of], (lattice_items)of));
    }
    return DEM_OK;
}

static void shrink_slab(dem_lattice *slab, order *o)
{
    lattice_cut cut = {.node = NULL};
    for (int of = 0; of < LATTICE_ITEMS; of++) {
        cut.n[of] = o[of].n_own;
        cut.numbers[of] = o[of].own;
    }
    lattice_cut_shrink(slab, &cut);
    for (int of = 0; of < LATTICE_ITEMS; of++) {
        free(o[of].own);
        o[of].own = NULL;
    }
}

static dem_status put_in_order(region *g, draft *d, order *o)
{
    TRY(list_all(g, d, o));
    shrink_slab(d->rows->lattice, o);
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        if (has_array(d, k)) TRY(take_array(g, d, &o[a->of], a));
    }
    for (int of = 0; of < LATTICE_ITEMS; of++) *count_of(&g->lattice, (lattice_items)of) = o[of].n_own + o[of].n;
    return DEM_OK;
}

static dem_status mark_common(region *g, const draft *d)
{
    g->is_common = lattice_zeros(g->lattice.n_nodes, sizeof *g->is_common);
    if (g->is_common == NULL) return lacks_memory();
    const dem_index n_before = sorted_first(d->known.list, d->known.n, own_of(d)[0]);
    for (dem_index k = 0; k < d->common.n; k++) g->is_common[node_in_region(d, n_before, d->common.list[k])] = 1;
    return DEM_OK;
}

static dem_status finish(region *g, draft *d, bool has_common)
{
    order o[LATTICE_ITEMS] = {{0}};
    dem_status status = put_in_order(g, d, o);
    if (status == DEM_OK && has_common) status = mark_common(g, d);
    for (int of = 0; of < LATTICE_ITEMS; of++) {
        free(o[of].own);
        free(o[of].at);
    }
    return status;
}

/* ---- public ---- */

static dem_status open_draft(draft *d, slab_rows *rows)
{
    const size_t n = (size_t)rows->ranks->size;
    *d = (draft){.rows = rows, .found = dem_lattice_empty()};
    d->asking = calloc(n, sizeof *d->asking);
    d->asked = calloc(n, sizeof *d->asked);
    d->giving = calloc(n, sizeof *d->giving);
    d->given = calloc(n, sizeof *d->given);
    return d->asking && d->asked && d->giving && d->given ? DEM_OK : lacks_memory();
}

static void close_draft(draft *d)
{
    numbers *const lists[] = {&d->common, &d->known, &d->next, &d->wanted};
    for (int k = 0; k < 4; k++) free(lists[k]->list);
    for (int of = 0; of < LATTICE_ITEMS; of++) free(d->number[of].list);
    dem_lattice_free(&d->found);
    free(d->asking);
    free(d->asked);
    free(d->giving);
    free(d->given);
}

/* What is next to nodes that are known is collected from the first row on, but known to be asked for last. */
static dem_status gather(draft *d, const region_extent *extent)
{
    if (extent->is_common != NULL) TRY(fetch_common(d, extent));
    TRY(reduce_status(d->rows->ranks, take_own(d), 0.0));
    return fetch_rings(d, extent->rings);
}

dem_status region_create(region *out, slab_rows *rows, const region_extent *extent)
{
    draft d;
    *out = (region){.lattice = dem_lattice_empty()};
    dem_status status = reduce_status(rows->ranks, open_draft(&d, rows), 0.0);
    if (status == DEM_OK) status = gather(&d, extent);
    if (status == DEM_OK) status = reduce_status(rows->ranks, finish(out, &d, extent->is_common != NULL), 0.0);
    close_draft(&d);
    return status;
}

void region_free(region *g)
{
    dem_lattice_free(&g->lattice);
    for (int of = 0; of < LATTICE_ITEMS; of++) free(g->number[of]);
    free(g->is_common);
    *g = (region){.lattice = dem_lattice_empty()};
}
