/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows come as they are asked for, each once, and are put in the order of the whole when all are there. Springs and
 * triangles come with their lowest nodes; those that go beyond the last ring are left out. */
#include "domain/region.h"

#include <stdlib.h>

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
    const slab_rows *rows;
    bool has_own;      /* whether own nodes are known, or about to be */
    numbers known;     /* nodes that have been asked for, ascending */
    numbers next;      /* nodes next to these, as they have come */
    numbers wanted;    /* nodes to be asked for, ascending */
    dem_lattice found; /* in the order in which they have come */
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

/* Makes room for one more in the arrays that are in rows, and in those of corners. */
static bool make_room(draft *d, lattice_items of)
{
    dem_index room = d->capacity[of];
    const dem_index needed = *count_of(&d->found, of) + 1;
    for (int k = 0; k < LATTICE_ARRAYS && needed > d->capacity[of]; k++) {
        const lattice_array *a = &lattice_arrays[k];
        void *items = lattice_array_of(&d->found, a);
        const bool is_corners =
            a->offset == offsetof(dem_lattice, ends) || a->offset == offsetof(dem_lattice, triangles);
        room = d->capacity[of];
        if (a->of != of || (!is_corners && !slab_rows_has(d->rows, k))) continue;
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

static bool take_next(draft *d, dem_index n, const bundle *from, dem_index *at)
{
    bool has_room = true;
    for (dem_index k = 0; has_room && k < n; k++) {
        dem_index number;
        bundle_take(from, at, &number, sizeof number);
        const bool is_own = slab_rows_owner(d->rows, number) == d->rows->ranks->rank;
        has_room = (d->has_own && is_own) || add(&d->next, number);
    }
    return has_room;
}

/* As slab_rows_pack() has written it. */
static bool take_row(draft *d, const bundle *from, dem_index *at)
{
    dem_index head[4];
    dem_lattice *l = &d->found;
    bundle_take(from, at, head, sizeof head);
    if (!take_next(d, head[1], from, at) || !make_room(d, LATTICE_NODES)) return false;
    take_items(d, LATTICE_NODES, from, at);
    l->n_nodes++;
    bool has_room = add(&d->number[LATTICE_NODES], head[0]);
    for (dem_index k = 0; has_room && k < head[2]; k++)
        has_room =
            make_room(d, LATTICE_SPRINGS) && take_owned(d, LATTICE_SPRINGS, l->ends + 2 * l->n_springs, 2, from, at);
    for (dem_index k = 0; has_room && k < head[3]; k++)
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

static dem_status ask(draft *d)
{
    for (dem_index k = 0; k < d->wanted.n; k++) {
        const dem_index number = d->wanted.list[k];
        if (!bundle_add(&d->asking[slab_rows_owner(d->rows, number)], &number, sizeof number)) return lacks_memory();
    }
    return DEM_OK;
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
    const int rank = d->rows->ranks->rank;
    for (int k = 0; k < d->rows->ranks->size; k++)
        TRY(answer(d, k == rank ? &d->asking[k] : &d->asked[k], &d->giving[k]));
    return DEM_OK;
}

static dem_status take_all(draft *d)
{
    const int rank = d->rows->ranks->rank;
    for (int k = 0; k < d->rows->ranks->size; k++) TRY(take_rows(d, k == rank ? &d->giving[k] : &d->given[k]));
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
        const bool is_known = k < d->known.n && d->known.list[k] == from->list[q];
        if (!is_known && !add(&d->wanted, from->list[q])) return lacks_memory();
    }
    from->n = 0;
    return DEM_OK;
}

static dem_status fetch_list(draft *d, numbers *from)
{
    TRY(reduce_status(d->rows->ranks, want(d, from), 0.0));
    return fetch(d);
}

static dem_status fetch_rings(draft *d, int n)
{
    for (int ring = 0; ring < n; ring++) TRY(fetch_list(d, &d->next));
    return DEM_OK;
}

/* ---- common and own nodes ---- */

/* Own ones that may touch obstacles. */
static dem_status list_touching(draft *d)
{
    const slab_rows *s = d->rows;
    for (dem_index i = 0; i < s->lattice.n_nodes; i++)
        if (slab_rows_owns(s, i) && (s->lattice.flags[i] & DEM_NODE_CONTACT) != 0 &&
            !add(&d->wanted, s->first_node + i))
            return lacks_memory();
    return DEM_OK;
}

static dem_status send_touching(draft *d)
{
    for (int k = 0; k < d->rows->ranks->size; k++)
        if (!bundle_add(&d->asking[k], d->wanted.list, (size_t)d->wanted.n * sizeof *d->wanted.list))
            return lacks_memory();
    return DEM_OK;
}

static dem_status take_touching(draft *d, numbers *all)
{
    const int rank = d->rows->ranks->rank;
    for (int k = 0; k < d->rows->ranks->size; k++) {
        const bundle *from = k == rank ? &d->asking[k] : &d->asked[k];
        for (dem_index at = 0; at < from->n;) {
            dem_index number;
            bundle_take(from, &at, &number, sizeof number);
            if (!add(all, number)) return lacks_memory();
        }
    }
    return DEM_OK;
}

/* Of all ranks. */
static dem_status gather_touching(draft *d, numbers *all)
{
    const ranks *r = d->rows->ranks;
    dem_status status = list_touching(d);
    if (status == DEM_OK) status = send_touching(d);
    status = reduce_status(r, status, 0.0);
    if (status == DEM_OK) status = bundles_exchange(r, d->asking, d->asked);
    if (status == DEM_OK) status = reduce_status(r, take_touching(d, all), 0.0);
    bundles_free(d->asking, r->size);
    bundles_free(d->asked, r->size);
    return status;
}

static dem_status fetch_common(draft *d, int n_rings)
{
    numbers touching = {0};
    dem_status status = gather_touching(d, &touching);
    if (status == DEM_OK) status = fetch_list(d, &touching);
    free(touching.list);
    return status == DEM_OK ? fetch_rings(d, n_rings) : status;
}

static dem_status list_own(draft *d)
{
    const dem_index *own = d->rows->first + d->rows->ranks->rank;
    numbers list = {0};
    dem_status status = DEM_OK;
    for (dem_index number = own[0]; status == DEM_OK && number < own[1]; number++)
        if (!add(&list, number)) status = lacks_memory();
    if (status == DEM_OK) status = want(d, &list);
    free(list.list);
    return status;
}

/* Row by row, without a message: there are many. */
static dem_status take_own(draft *d)
{
    bundle row = {0};
    dem_status status = DEM_OK;
    d->has_own = true;
    for (dem_index k = 0; status == DEM_OK && k < d->wanted.n; k++) {
        row.n = 0;
        status = slab_rows_pack(d->rows, d->wanted.list[k], &row) ? take_rows(d, &row) : lacks_memory();
    }
    bundles_free(&row, 1);
    return status;
}

static dem_status fetch_own(draft *d)
{
    dem_status status = list_own(d);
    if (status == DEM_OK) status = take_own(d);
    if (status == DEM_OK) status = merge_known(d);
    return reduce_status(d->rows->ranks, status, 0.0);
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

/* What of the draft is in the region. */
typedef struct order {
    arrival *list;
    dem_index n[LATTICE_ITEMS], *at[LATTICE_ITEMS]; /* [n] places in the draft, by numbers of the whole */
    dem_index *node;                                /* [nodes] the number in the region of each in the draft */
} order;

/* Corners become places in the draft; -1: not in the region. */
static void find_corners(const draft *d, const order *o, dem_index *corner, dem_index n)
{
    for (dem_index k = 0; k < n; k++) {
        const dem_index place = sorted_find(d->known.list, d->known.n, corner[k]);
        corner[k] = place >= 0 ? o->at[LATTICE_NODES][place] : -1;
    }
}

static bool is_entire(const dem_index *corner, int arity)
{
    bool entire = true;
    for (int c = 0; c < arity; c++) entire = entire && corner[c] >= 0;
    return entire;
}

/* Those that are in the region, by number.  \param corner  [n][arity] NULL: all are */
static void sort(order *o, const draft *d, lattice_items of, const dem_index *corner, int arity)
{
    dem_index n = 0;
    for (dem_index k = 0; k < d->number[of].n; k++)
        if (corner == NULL || is_entire(corner + arity * k, arity)) o->list[n++] = (arrival){d->number[of].list[k], k};
    qsort(o->list, (size_t)n, sizeof *o->list, compare);
    for (dem_index k = 0; k < n; k++) o->at[of][k] = o->list[k].at;
    o->n[of] = n;
}

static dem_status allocate(order *o, region *g, const draft *d)
{
    dem_index most = 0;
    bool has_room = true;
    for (int of = 0; of < LATTICE_ITEMS; of++) {
        const size_t n = (size_t)d->number[of].n + 1;
        most = d->number[of].n > most ? d->number[of].n : most;
        o->at[of] = malloc(n * sizeof *o->at[of]);
        g->number[of] = malloc(n * sizeof *g->number[of]);
        has_room = has_room && o->at[of] != NULL && g->number[of] != NULL;
    }
    o->list = malloc(((size_t)most + 1) * sizeof *o->list);
    o->node = malloc(((size_t)d->number[LATTICE_NODES].n + 1) * sizeof *o->node);
    return has_room && o->list != NULL && o->node != NULL ? DEM_OK : lacks_memory();
}

static dem_status put_in_order(region *g, order *o, draft *d)
{
    dem_lattice *l = &d->found;
    TRY(allocate(o, g, d));
    sort(o, d, LATTICE_NODES, NULL, 0);
    for (dem_index k = 0; k < o->n[LATTICE_NODES]; k++) o->node[o->at[LATTICE_NODES][k]] = k;
    find_corners(d, o, l->ends, 2 * l->n_springs);
    find_corners(d, o, l->triangles, 3 * l->n_triangles);
    sort(o, d, LATTICE_SPRINGS, l->ends, 2);
    sort(o, d, LATTICE_TRIANGLES, l->triangles, 3);
    for (int of = 0; of < LATTICE_ITEMS; of++)
        for (dem_index k = 0; k < o->n[of]; k++) g->number[of][k] = d->number[of].list[o->at[of][k]];
    const lattice_cut cut = {.n = {o->n[LATTICE_NODES], o->n[LATTICE_SPRINGS], o->n[LATTICE_TRIANGLES]},
                             .numbers = {o->at[LATTICE_NODES], o->at[LATTICE_SPRINGS], o->at[LATTICE_TRIANGLES]},
                             .node = o->node};
    return lattice_cut_create(&g->lattice, l, &cut);
}

static dem_status finish(region *g, draft *d)
{
    order o = {0};
    const dem_status status = put_in_order(g, &o, d);
    for (int of = 0; of < LATTICE_ITEMS; of++) free(o.at[of]);
    free(o.list);
    free(o.node);
    return status;
}

/* ---- public ---- */

static dem_status open_draft(draft *d, const slab_rows *rows)
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
    numbers *const lists[] = {&d->known, &d->next, &d->wanted};
    for (int k = 0; k < 3; k++) free(lists[k]->list);
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
    if (extent->has_common) TRY(fetch_common(d, extent->common_rings));
    TRY(fetch_own(d));
    return fetch_rings(d, extent->rings);
}

dem_status region_create(region *out, const slab_rows *rows, const region_extent *extent)
{
    draft d;
    *out = (region){.lattice = dem_lattice_empty()};
    dem_status status = reduce_status(rows->ranks, open_draft(&d, rows), 0.0);
    if (status == DEM_OK) status = gather(&d, extent);
    if (status == DEM_OK) status = reduce_status(rows->ranks, finish(out, &d), 0.0);
    close_draft(&d);
    return status;
}

void region_free(region *g)
{
    dem_lattice_free(&g->lattice);
    for (int of = 0; of < LATTICE_ITEMS; of++) free(g->number[of]);
    *g = (region){.lattice = dem_lattice_empty()};
}
