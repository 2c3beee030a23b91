/* SPDX-License-Identifier: BSD-3-Clause */
/* Groups what eight nodes do with their springs and triangles into entries for all lanes. */
#include "elastic/layout.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"
#include "elastic/renumber.h"

enum {
    whole = 0xffff, /* mask of all lanes */
    most_widths = 3,
    usual_span = 1024, /* nodes: a ring of so many is in the cache, no other order is looked for */
    most_rounds = 2    /* entries per item of the fullest lane, up to which operands that lie side by side are sought */
};

static const dem_index ring_bytes = 1 << 22; /* as much and 64 bytes a node: more memory is not worth it */

/* What one lane does. */
typedef struct item {
    int32_t at, to;     /* operands of this lane */
    int32_t base, last; /* where they would begin for lane 0 if all lay side by side */
    dem_index spring;
    bool negative;
    double set[most_widths];
} item;

typedef struct builder {
    layout *l;
    const springs *s;
    const triangles *t;
    int32_t *place; /* [n_nodes] of each node; NULL: its number */
    int32_t *force; /* [n_springs] place in the ring */
    dem_index most; /* items of a lane */
    item *items;    /* [LAYOUT_LANES][most] */
    dem_index n[LAYOUT_LANES], next[LAYOUT_LANES];
    bool taken[LAYOUT_LANES]; /* by the group in hand */
    dem_index n_entries, entry_capacity;
    layout_entry *entries; /* [n_entries] of the block in hand */
    bool by_slot;          /* groups are the next items of all lanes, wherever they are */
    dem_index n_streams, stream_capacity;
    int64_t *key, *used; /* [n_streams] what a stream of the ring was used for, and the last block that did */
} builder;

static dem_index node_at(const layout *l, dem_index q)
{
    return l->order != NULL ? l->order[q] : q;
}

static int32_t place_of(const builder *b, dem_index node)
{
    return b->place != NULL ? b->place[node] : (int32_t)node;
}

/* ---- arrays that grow ---- */

static dem_status add_entry(builder *b, layout_entry entry)
{
    CHECK(grow_array((void **)&b->entries, &b->entry_capacity, b->n_entries + 1, sizeof *b->entries), DEM_ERROR_MEMORY,
          "out of memory for the layout of springs");
    b->entries[b->n_entries++] = entry;
    return DEM_OK;
}

/* What has been added is what the block does. */
static dem_status close_block(builder *b, layout_part *part, dem_index block)
{
    const dem_index n = b->n_entries;
    b->n_entries = 0;
    return intern_find(&part->entries, b->entries, n, &part->span[block]);
}

static dem_status add_list(layout *l, const int32_t *index, int32_t *number)
{
    CHECK(l->n_lists < INT32_MAX / LAYOUT_LANES, DEM_ERROR_MODEL, "too many springs");
    CHECK(grow_array((void **)&l->lists, &l->list_capacity, l->n_lists + 1, LAYOUT_LANES * sizeof *l->lists),
          DEM_ERROR_MEMORY, "out of memory for the layout of springs");
    memcpy(l->lists + LAYOUT_LANES * l->n_lists, index, LAYOUT_LANES * sizeof *index);
    *number = (int32_t)(LAYOUT_LANES * l->n_lists++);
    return DEM_OK;
}

/* ---- groups of items ---- */

static const item *head(const builder *b, int lane)
{
    return b->next[lane] < b->n[lane] ? &b->items[lane * b->most + b->next[lane]] : NULL;
}

static bool fits(const builder *b, const item *a, const item *leader)
{
    return b->by_slot || (a->base == leader->base && a->last == leader->last && a->negative == leader->negative);
}

/* The item that comes first, and all that can be taken with it; NULL: none is left. */
static const item *take_group(builder *b)
{
    const item *leader = NULL;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const item *a = head(b, lane);
        if (a != NULL && (leader == NULL || (!b->by_slot && a->last < leader->last))) leader = a;
    }
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const item *a = leader != NULL ? head(b, lane) : NULL;
        b->taken[lane] = a != NULL && fits(b, a, leader);
    }
    for (int lane = 0; lane < LAYOUT_LANES; lane++) b->next[lane] += b->taken[lane];
    return leader;
}

static void rewind_items(builder *b)
{
    for (int lane = 0; lane < LAYOUT_LANES; lane++) b->next[lane] = 0;
}

/* Whether operands side by side make few enough groups. */
static void choose_groups(builder *b)
{
    dem_index fullest = 0, groups = 0;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) fullest = b->n[lane] > fullest ? b->n[lane] : fullest;
    b->by_slot = false;
    rewind_items(b);
    while (groups <= most_rounds * fullest && take_group(b) != NULL) groups++;
    b->by_slot = groups > most_rounds * fullest;
    rewind_items(b);
}

/* The item of a lane in the group just taken. */
static const item *taken_of(const builder *b, int lane)
{
    return &b->items[lane * b->most + b->next[lane] - 1];
}

/* Two bits for each lane that takes part; of these, for each that is the upper node. */
static uint16_t mask_of(const builder *b)
{
    unsigned mask = 0;
    for (int lane = 0; lane < LAYOUT_LANES; lane++)
        if (b->taken[lane]) mask |= 3u << (2 * lane);
    return (uint16_t)mask;
}

static uint16_t upper_of(const builder *b)
{
    unsigned mask = 0;
    for (int lane = 0; lane < LAYOUT_LANES; lane++)
        if (b->taken[lane] && taken_of(b, lane)->negative) mask |= 3u << (2 * lane);
    return (uint16_t)mask;
}

static bool side_by_side(const builder *b, const item *leader)
{
    bool all = true;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const item *a = b->taken[lane] ? taken_of(b, lane) : leader;
        all = all && a->base == leader->base && a->last == leader->last && a->negative == leader->negative;
    }
    return all;
}

/* One operand of the group as a list; lanes that take no part have `idle`, and so on from there by `step`. */
static dem_status list_operand(builder *b, size_t operand, int32_t idle, int32_t step, int32_t *number)
{
    int32_t index[LAYOUT_LANES];
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        index[lane] = idle + step * lane;
        if (b->taken[lane]) memcpy(&index[lane], (const char *)taken_of(b, lane) + operand, sizeof index[lane]);
        index[lane] *= 2;
    }
    return add_list(b->l, index, number);
}

static uint8_t kind_of(const builder *b, bool gathered)
{
    if (gathered) return LAYOUT_GATHERED;
    return mask_of(b) == whole ? LAYOUT_ADD : LAYOUT_MASKED;
}

/* Where the coefficients of the group are; lanes that take no part have the leader's. */
static dem_status set_of(builder *b, intern *sets, dem_index width, const item *leader, int32_t *place)
{
    double values[most_widths * LAYOUT_LANES];
    intern_span span;
    for (int q = 0; q < LAYOUT_LANES; q++) {
        const item *a = b->taken[q] ? taken_of(b, q) : leader;
        for (dem_index k = 0; k < width; k++) values[k * LAYOUT_LANES + layout_lane(q)] = a->set[k];
    }
    TRY(intern_find(sets, values, width * LAYOUT_LANES, &span));
    *place = span.first;
    return DEM_OK;
}

static bool in_range(const builder *b, int32_t first)
{
    return first >= 0 && (dem_index)first + LAYOUT_LANES <= b->l->n_nodes;
}

/* ---- springs ---- */

/* The stream of the ring that was used for this, else the one not used for longest. */
static dem_status find_stream(builder *b, int64_t key, dem_index block, dem_index *stream)
{
    dem_index found = -1;
    for (dem_index k = 0; k < b->n_streams && (found < 0 || b->key[found] != key); k++)
        if (b->used[k] != block && (found < 0 || b->key[k] == key || b->used[k] < b->used[found])) found = k;
    if (found < 0) {
        dem_index capacity = b->stream_capacity;
        CHECK(grow_array((void **)&b->key, &capacity, b->n_streams + 1, sizeof *b->key), DEM_ERROR_MEMORY,
              "out of memory for the layout of springs");
        CHECK(grow_array((void **)&b->used, &b->stream_capacity, b->n_streams + 1, sizeof *b->used), DEM_ERROR_MEMORY,
              "out of memory for the layout of springs");
        found = b->n_streams++;
    }
    b->key[found] = key;
    b->used[found] = block;
    *stream = found;
    return DEM_OK;
}

static void sort_by_place(item *list, dem_index n)
{
    for (dem_index k = 1; k < n; k++)
        for (dem_index p = k; p > 0 && list[p].at < list[p - 1].at; p--) {
            const item kept = list[p];
            list[p] = list[p - 1];
            list[p - 1] = kept;
        }
}

static void list_springs(builder *b, dem_index block)
{
    const springs *s = b->s;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index row = LAYOUT_LANES * block + lane, i = node_at(b->l, row);
        item *list = &b->items[lane * b->most];
        dem_index n = 0;
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
            const int32_t j = place_of(b, s->neighbour[p]);
            if (j < row) continue;
            list[n++] = (item){.at = j, .base = j - lane, .last = j - lane, .spring = s->spring[p]};
            list[n - 1].set[0] = s->stiffness[p];
            list[n - 1].set[1] = s->rest_length[p];
            list[n - 1].set[2] = s->viscosity != NULL ? s->viscosity[p] : 0.0;
        }
        sort_by_place(list, n);
        b->n[lane] = n;
    }
}

static dem_status lay_springs(builder *b, dem_index block)
{
    layout *l = b->l;
    const int32_t row = (int32_t)(LAYOUT_LANES * block), at_row = row & (int32_t)(l->ring_rows - 1);
    dem_index stream = 0, slot = 0;
    list_springs(b, block);
    choose_groups(b);
    for (const item *leader = take_group(b); leader != NULL; leader = take_group(b), slot++) {
        const bool gathered = !side_by_side(b, leader) || !in_range(b, leader->base);
        layout_entry e = {.at = 2 * (leader->base - row), .mask = mask_of(b), .kind = kind_of(b, gathered)};
        TRY(find_stream(b, gathered ? -1 - slot : leader->base - row, block, &stream));
        CHECK(2 * (stream + 1) * (l->ring_rows + LAYOUT_LANES) < INT32_MAX, DEM_ERROR_MODEL,
              "too many springs at a node");
        const int32_t start = (int32_t)(stream * (l->ring_rows + LAYOUT_LANES));
        e.to = 2 * start;
        if (gathered) TRY(list_operand(b, offsetof(item, at), row, 1, &e.at));
        TRY(set_of(b, &l->bonds, l->damped ? 3 : 2, leader, &e.set));
        TRY(add_entry(b, e));
        for (int lane = 0; lane < LAYOUT_LANES; lane++)
            if (b->taken[lane]) b->force[taken_of(b, lane)->spring] = start + at_row + lane;
    }
    return close_block(b, &l->springs, block);
}

/* ---- terms ---- */

/* Where the ring would have the force for lane 0. Behind its end it repeats its first eight. */
static int32_t ring_base(const layout *l, int32_t force, int lane)
{
    const int32_t stride = (int32_t)(l->ring_rows + LAYOUT_LANES), stream = force / stride;
    return stream * stride + ((force - stream * stride - lane) & (int32_t)(l->ring_rows - 1));
}

static void list_terms(builder *b, dem_index block)
{
    const springs *s = b->s;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index row = LAYOUT_LANES * block + lane, i = node_at(b->l, row);
        b->n[lane] = s->row[i + 1] - s->row[i];
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
            const int32_t j = place_of(b, s->neighbour[p]), force = b->force[s->spring[p]];
            b->items[lane * b->most + p - s->row[i]] =
                (item){.at = force, .base = ring_base(b->l, force, lane), .last = j - lane, .negative = j < row};
        }
    }
}

static dem_status lay_terms(builder *b, dem_index block)
{
    layout *l = b->l;
    const int32_t at_row = (int32_t)(LAYOUT_LANES * block & (l->ring_rows - 1));
    list_terms(b, block);
    choose_groups(b);
    for (const item *leader = take_group(b); leader != NULL; leader = take_group(b)) {
        const bool gathered = !side_by_side(b, leader);
        layout_entry e = {.at = 2 * (leader->base - at_row), .mask = mask_of(b), .kind = kind_of(b, gathered)};
        e.to = upper_of(b);
        if (e.kind == LAYOUT_ADD && leader->negative) e.kind = LAYOUT_SUBTRACT;
        if (gathered) TRY(list_operand(b, offsetof(item, at), 0, 0, &e.at));
        TRY(add_entry(b, e));
    }
    return close_block(b, &l->terms, block);
}

/* ---- corners of triangles ---- */

static void look_ahead(layout *l, dem_index block, int32_t place)
{
    const dem_index way = place / LAYOUT_LANES - block, ahead = (way > 0 ? way : -way) + 1;
    if (ahead > l->ahead) l->ahead = ahead;
}

static void list_corners(builder *b, dem_index block)
{
    const triangles *t = b->t;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index i = node_at(b->l, LAYOUT_LANES * block + lane);
        b->n[lane] = t->row[i + 1] - t->row[i];
        for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
            const int32_t next = place_of(b, t->next[p]), last = place_of(b, t->last[p]);
            look_ahead(b->l, block, next);
            look_ahead(b->l, block, last);
            const double onset = t->guard[p] > 0.0 ? TRIANGLES_GUARD_ONSET * t->rest_area[p] : -INFINITY;
            b->items[lane * b->most + p - t->row[i]] =
                (item){.at = next,
                       .to = last,
                       .base = next - lane,
                       .last = last - lane,
                       .set = {t->rest_area[p], onset, t->area_stiffness != NULL ? t->area_stiffness[p] : 0.0}};
        }
    }
}

static dem_status lay_corners(builder *b, dem_index block)
{
    layout *l = b->l;
    const int32_t row = (int32_t)(LAYOUT_LANES * block);
    list_corners(b, block);
    b->by_slot = true;
    rewind_items(b);
    for (const item *leader = take_group(b); leader != NULL; leader = take_group(b)) {
        const bool gathered = !side_by_side(b, leader) || !in_range(b, leader->base) || !in_range(b, leader->last);
        layout_entry e = {.at = 2 * (leader->base - row), .to = 2 * (leader->last - row), .mask = mask_of(b)};
        e.kind = kind_of(b, gathered);
        if (gathered) TRY(list_operand(b, offsetof(item, at), row, 1, &e.at));
        if (gathered) TRY(list_operand(b, offsetof(item, to), row, 1, &e.to));
        TRY(set_of(b, &l->areas, 3, leader, &e.set));
        TRY(add_entry(b, e));
    }
    return close_block(b, &l->corners, block);
}

/* ---- all blocks ---- */

static bool worth_it(const builder *b)
{
    const layout *l = b->l;
    return b->n_streams * (l->ring_rows + LAYOUT_LANES) * 16 <= ring_bytes + 64 * l->n_nodes;
}

static dem_status lay_blocks(builder *b)
{
    layout *l = b->l;
    for (dem_index block = 0; block < l->n_blocks; block++) {
        TRY(lay_springs(b, block));
        if (!worth_it(b)) {
            l->n_blocks = b->n_streams = 0;
            break;
        }
        TRY(lay_terms(b, block));
        TRY(lay_corners(b, block));
    }
    l->ring_length = b->n_streams * (l->ring_rows + LAYOUT_LANES);
    intern *const pools[] = {&l->springs.entries, &l->terms.entries, &l->corners.entries, &l->bonds, &l->areas};
    for (size_t k = 0; k < sizeof pools / sizeof *pools; k++) TRY(intern_settle(pools[k]));
    return DEM_OK;
}

/* An order by distance, if neighbours are far apart as they are numbered and nearer so. */
static dem_status choose_order(builder *b)
{
    layout *l = b->l;
    dem_index span = renumber_span(b->s, NULL);
    if (span > usual_span) {
        l->order = malloc((size_t)l->n_nodes * sizeof *l->order);
        b->place = malloc((size_t)l->n_nodes * sizeof *b->place);
        CHECK(l->order && b->place, DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)l->n_nodes);
        renumber_by_distance(b->s, l->order, b->place);
        const dem_index better = renumber_span(b->s, b->place);
        if (2 * better > span) {
            free(l->order);
            free(b->place);
            l->order = b->place = NULL;
        } else {
            span = better;
        }
    }
    l->reach = (span + LAYOUT_LANES - 1) / LAYOUT_LANES;
    l->ahead = l->reach + 1; /* other lanes of an entry read up to seven nodes further */
    for (l->ring_rows = LAYOUT_LANES; l->ring_rows < LAYOUT_LANES * (l->reach + 2);) l->ring_rows *= 2;
    return DEM_OK;
}

static dem_status allocate(builder *b)
{
    layout *l = b->l;
    const size_t n = (size_t)l->n_blocks + 1;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const dem_index bonds = b->s->row[i + 1] - b->s->row[i], corners = b->t->row[i + 1] - b->t->row[i];
        b->most = bonds > b->most ? bonds : b->most;
        b->most = corners > b->most ? corners : b->most;
    }
    b->items = malloc(LAYOUT_LANES * ((size_t)b->most + 1) * sizeof *b->items);
    b->force = malloc(((size_t)b->s->n_springs + 1) * sizeof *b->force);
    l->springs = (layout_part){calloc(n, sizeof(intern_span)), {.unit = sizeof(layout_entry)}};
    l->terms = (layout_part){calloc(n, sizeof(intern_span)), {.unit = sizeof(layout_entry)}};
    l->corners = (layout_part){calloc(n, sizeof(intern_span)), {.unit = sizeof(layout_entry)}};
    CHECK(b->items && b->force && l->springs.span && l->terms.span && l->corners.span, DEM_ERROR_MEMORY,
          "out of memory for %lld springs", (long long)b->s->n_springs);
    return choose_order(b);
}

dem_status layout_compile(layout *out, const springs *s, const triangles *t)
{
    layout l = {.n_nodes = s->n_nodes,
                .n_blocks = s->n_nodes / LAYOUT_LANES,
                .damped = s->viscosity != NULL,
                .stiff = t->area_stiffness != NULL};
    builder b = {.l = &l, .s = s, .t = t};
    CHECK(s->n_nodes < INT32_MAX / 2 && s->n_springs < INT32_MAX / 2, DEM_ERROR_MODEL,
          "%lld nodes and %lld springs are more than the library takes", (long long)s->n_nodes,
          (long long)s->n_springs);
    l.bonds.unit = l.areas.unit = sizeof(double);
    dem_status status = allocate(&b);
    if (status == DEM_OK) status = lay_blocks(&b);
    free(b.items);
    free(b.force);
    free(b.place);
    free(b.key);
    free(b.used);
    free(b.entries);
    if (status == DEM_OK)
        *out = l;
    else
        layout_free(&l);
    return status;
}

static void free_part(layout_part *part)
{
    free(part->span);
    intern_free(&part->entries);
}

void layout_free(layout *l)
{
    free_part(&l->springs);
    free_part(&l->terms);
    free_part(&l->corners);
    intern_free(&l->bonds);
    intern_free(&l->areas);
    free(l->order);
    free(l->lists);
    *l = (layout){0};
}
