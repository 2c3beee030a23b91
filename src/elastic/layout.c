/* SPDX-License-Identifier: BSD-3-Clause */
/* Compiles springs and triangles for the sweep (docs/algorithms.md, How forces are evaluated). Eight nodes with numbers
 * in sequence are a block, one node to a lane. The file turns what the eight do into entries: one instruction for all
 * lanes, such as "evaluate the spring to the node 1 further on". Which lanes take part is found in lane_groups.c.
 * An entry has offsets relative to its block, not node numbers. In a regular lattice most blocks therefore have equal
 * entries and coefficients, which are stored once (base/intern.h) and stay in the cache. A spring is evaluated once, by
 * its lower node, and its force is left in a ring buffer (ring_streams.h). Both ends then sum up forces in the order of
 * their own rows, so the sums have the bits of springs_force(). A coupled triangle is evaluated once, too, by its
 * lowest corner, and leaves a force for each of its corners.
 * The arithmetic is not here but in sweep_body.h, and the numbering of distant neighbours is in renumber.c. */
#include "elastic/layout.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"
#include "elastic/lane_groups.h"
#include "elastic/lane_slots.h"
#include "elastic/renumber.h"
#include "elastic/ring_streams.h"

enum {
    whole = 0xffff,    /* mask of all lanes */
    usual_span = 1024, /* nodes: the ring for so many fits into the cache, so that no other order is sought, */
    least_rows = 8     /* nor where there are so many rows, which vectors take as they are */
};

/* A ring may take this and 64 bytes for each node: more memory is not worth it. */
static const dem_index ring_bytes = 1 << 22;

/* The work in hand: the items of the eight lanes of a block, the entries made of them so far, and the ring. */
typedef struct builder {
    layout *l;
    const springs *s;
    const triangles *t;
    const couplings *c;
    int32_t *place;        /* [n_nodes] of each node; NULL: its number */
    int32_t *force;        /* [n_springs] place in the ring */
    int32_t *corner_force; /* [3 n] the same of each corner of coupled triangles */
    dem_index *slot;       /* of one lane */
    lane_groups groups;
    dem_index n_entries, entry_capacity;
    layout_entry *entries; /* [n_entries] of the block in hand */
    ring_streams ring;
} builder;

/* Entries know places only. */
static int32_t place_of(const builder *b, dem_index node)
{
    return lane_slots_place(b->place, node);
}

/* ---- arrays that grow ---- */

/* Appends an entry to the block in hand. */
static dem_status add_entry(builder *b, layout_entry entry)
{
    CHECK(grow_array((void **)&b->entries, &b->entry_capacity, b->n_entries + 1, sizeof *b->entries), DEM_ERROR_MEMORY,
          "out of memory for the layout of springs");
    b->entries[b->n_entries++] = entry;
    return DEM_OK;
}

/* The entries added since the last call are what this block does. A block that does the same as an earlier one gets the
 * earlier one's span. */
static dem_status close_block(builder *b, layout_part *part, dem_index block)
{
    const dem_index n = b->n_entries;
    b->n_entries = 0;
    return intern_find(&part->entries, b->entries, n, &part->span[block]);
}

/* Stores one operand for each lane, for entries whose operands do not lie side by side. */
static dem_status add_list(layout *l, const int32_t *index, int32_t *number)
{
    CHECK(l->n_lists < INT32_MAX / LAYOUT_LANES, DEM_ERROR_MODEL, "too many springs");
    CHECK(grow_array((void **)&l->lists, &l->list_capacity, l->n_lists + 1, LAYOUT_LANES * sizeof *l->lists),
          DEM_ERROR_MEMORY, "out of memory for the layout of springs");
    memcpy(l->lists + LAYOUT_LANES * l->n_lists, index, LAYOUT_LANES * sizeof *index);
    *number = (int32_t)(LAYOUT_LANES * l->n_lists++);
    return DEM_OK;
}

/* ---- entries of a group ---- */

/* Lists one operand of the group, lane by lane. A lane that takes no part reads `idle` + `step` * lane: a valid place,
 * whose result is masked out or never read. Places are doubled, since operands are pairs of numbers. */
static dem_status list_operand(builder *b, size_t operand, int32_t idle, int32_t step, int32_t *number)
{
    int32_t index[LAYOUT_LANES];
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        index[lane] = idle + step * lane;
        if (b->groups.taken[lane])
            memcpy(&index[lane], (const char *)lane_groups_item(&b->groups, lane) + operand, sizeof index[lane]);
        index[lane] *= 2;
    }
    return add_list(b->l, index, number);
}

/* LAYOUT_ADD needs no mask: all eight lanes take part. */
static uint8_t kind_of(const builder *b, bool gathered)
{
    if (gathered) return LAYOUT_GATHERED;
    return lane_groups_mask(&b->groups) == whole ? LAYOUT_ADD : LAYOUT_MASKED;
}

/* Stores the coefficients of the group, in the order in which the vectors hold the lanes (layout_lane). A lane that
 * takes no part has the leader's, so that incomplete groups share their sets with whole ones. */
static dem_status set_of(builder *b, intern *sets, dem_index width, const lane_item *leader, int32_t *place)
{
    double values[LANE_ITEM_WIDTH * LAYOUT_LANES];
    intern_span span;
    for (int q = 0; q < LAYOUT_LANES; q++) {
        const lane_item *a = b->groups.taken[q] ? lane_groups_item(&b->groups, q) : leader;
        for (dem_index k = 0; k < width; k++) values[k * LAYOUT_LANES + layout_lane(q)] = a->set[k];
    }
    TRY(intern_find(sets, values, width * LAYOUT_LANES, &span));
    *place = span.first;
    return DEM_OK;
}

/* Whether eight nodes in sequence from `first` on exist: lanes that take no part are loaded with the others. */
static bool in_range(const builder *b, int32_t first)
{
    return first >= 0 && (dem_index)first + LAYOUT_LANES <= b->l->n_nodes;
}

/* An entry for triangles, which read the next and the last corner of each lane's node. */
static dem_status add_triangles(builder *b, const lane_item *leader, int32_t row, intern *sets)
{
    const dem_index width = sets == &b->l->areas ? 3 : 6;
    const bool gathered =
        !lane_groups_side_by_side(&b->groups, leader) || !in_range(b, leader->base) || !in_range(b, leader->last);
    layout_entry e = {
        .at = 2 * (leader->base - row), .to = 2 * (leader->last - row), .mask = lane_groups_mask(&b->groups)};
    e.kind = kind_of(b, gathered);
    if (gathered) TRY(list_operand(b, offsetof(lane_item, at), row, 1, &e.at));
    if (gathered) TRY(list_operand(b, offsetof(lane_item, to), row, 1, &e.to));
    TRY(set_of(b, sets, width, leader, &e.set));
    return add_entry(b, e);
}

/* ---- springs ---- */

/* The items of the springs whose lower ends are in this block: those whose other end has a higher place. */
static void list_springs(builder *b, dem_index block)
{
    const springs *s = b->s;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index n = lane_slots_springs(s, b->place, layout_node(b->l, LAYOUT_LANES * block + lane), b->slot);
        for (dem_index k = 0; k < n; k++) {
            const dem_index p = b->slot[k], m = s->spring[p];
            const int32_t j = place_of(b, s->neighbour[p]);
            b->groups.items[lane * b->groups.most + k] = (lane_item){
                .at = j,
                .base = j - lane,
                .last = j - lane,
                .element = m,
                .set = {s->stiffness_of[m], s->rest_length_of[m], s->viscosity_of != NULL ? s->viscosity_of[m] : 0.0}};
        }
        b->groups.n[lane] = n;
    }
}

/* Entries that evaluate springs. `force` notes where in the ring each spring's force will be, for lay_terms(). */
static dem_status lay_springs(builder *b, dem_index block)
{
    layout *l = b->l;
    const int32_t row = (int32_t)(LAYOUT_LANES * block), at_row = row & (int32_t)(l->ring_rows - 1);
    dem_index slot = 0;
    int32_t start = 0;
    list_springs(b, block);
    lane_groups_choose(&b->groups);
    for (const lane_item *leader = lane_groups_take(&b->groups); leader != NULL;
         leader = lane_groups_take(&b->groups), slot++) {
        const bool gathered = !lane_groups_side_by_side(&b->groups, leader) || !in_range(b, leader->base);
        layout_entry e = {
            .at = 2 * (leader->base - row), .mask = lane_groups_mask(&b->groups), .kind = kind_of(b, gathered)};
        TRY(ring_streams_find(&b->ring, gathered ? -1 - slot : leader->base - row, block, &start));
        e.to = 2 * start;
        if (gathered) TRY(list_operand(b, offsetof(lane_item, at), row, 1, &e.at));
        TRY(set_of(b, &l->bonds, l->damped ? 3 : 2, leader, &e.set));
        TRY(add_entry(b, e));
        for (int lane = 0; lane < LAYOUT_LANES; lane++)
            if (b->groups.taken[lane]) b->force[lane_groups_item(&b->groups, lane)->element] = start + at_row + lane;
    }
    return close_block(b, &l->springs, block);
}

/* ---- coupled triangles ---- */

/* The items of the triangles whose lowest corners are in this block. */
static void list_couplings(builder *b, dem_index block)
{
    const couplings *c = b->c;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index n = lane_slots_couplings(c, b->place, layout_node(b->l, LAYOUT_LANES * block + lane), b->slot);
        for (dem_index m = 0; m < n; m++) {
            const dem_index slot = c->slot[b->slot[m]];
            const coupled_triangle *t = &c->list[slot / 3];
            const int q = (int)(slot % 3);
            const int32_t next = place_of(b, t->corner[(q + 1) % 3]), last = place_of(b, t->corner[(q + 2) % 3]);
            lane_item *own = &b->groups.items[lane * b->groups.most + m];
            *own = (lane_item){.at = next, .to = last, .base = next - lane, .last = last - lane, .element = slot};
            for (int k = 0; k < 3; k++) {
                own->set[k] = t->rest_length[(q + k) % 3];
                own->set[3 + k] = t->coupling[(q + k) % 3];
            }
        }
        b->groups.n[lane] = n;
    }
}

/* Three streams for the forces of the group in hand, by its number in the block. */
static dem_status place_forces(builder *b, dem_index block, dem_index group)
{
    const layout *l = b->l;
    const int32_t at_row = (int32_t)(LAYOUT_LANES * block & (l->ring_rows - 1));
    const int64_t beyond_springs = (int64_t)1 << 40; /* keys of the streams of springs are below */
    int32_t start[3];
    for (int c = 0; c < 3; c++) {
        TRY(ring_streams_find(&b->ring, beyond_springs + 3 * group + c, block, &start[c]));
        for (int lane = 0; lane < LAYOUT_LANES; lane++) {
            const dem_index slot = b->groups.taken[lane] ? lane_groups_item(&b->groups, lane)->element : 0;
            if (b->groups.taken[lane]) b->corner_force[slot / 3 * 3 + (slot + c) % 3] = start[c] + at_row + lane;
        }
    }
    return add_entry(b, (layout_entry){.at = 2 * start[0], .to = 2 * start[1], .set = 2 * start[2]});
}

/* Entries that evaluate coupled triangles, each in two parts. */
static dem_status lay_couplings(builder *b, dem_index block)
{
    layout *l = b->l;
    const int32_t row = (int32_t)(LAYOUT_LANES * block);
    dem_index group = 0;
    list_couplings(b, block);
    lane_groups_choose(&b->groups);
    for (const lane_item *leader = lane_groups_take(&b->groups); leader != NULL;
         leader = lane_groups_take(&b->groups)) {
        TRY(add_triangles(b, leader, row, &l->couples));
        TRY(place_forces(b, block, group++));
    }
    return close_block(b, &l->couplings, block);
}

/* ---- terms ---- */

/* The items of the sum over a node's row, in the order of the row. `negative` marks springs that the other end
 * evaluates. */
static void list_terms(builder *b, dem_index block)
{
    const springs *s = b->s;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index row = LAYOUT_LANES * block + lane, i = layout_node(b->l, row);
        b->groups.n[lane] = s->row[i + 1] - s->row[i];
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
            const int32_t j = place_of(b, s->neighbour[p]), force = b->force[s->spring[p]];
            b->groups.items[lane * b->groups.most + p - s->row[i]] = (lane_item){
                .at = force, .base = ring_streams_base(&b->ring, force, lane), .last = j - lane, .negative = j < row};
        }
    }
}

/* The same of coupled triangles: a force for each corner, and nothing to subtract. */
static void list_coupling_terms(builder *b, dem_index block)
{
    const couplings *c = b->c;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index i = layout_node(b->l, LAYOUT_LANES * block + lane);
        b->groups.n[lane] = c->row[i + 1] - c->row[i];
        for (int32_t k = 0; k < b->groups.n[lane]; k++) {
            const int32_t force = b->corner_force[c->slot[c->row[i] + k]];
            b->groups.items[lane * b->groups.most + k] =
                (lane_item){.at = force, .base = ring_streams_base(&b->ring, force, lane), .last = k};
        }
    }
}

/* Entries that sum up forces. The forces of the block itself and of lower ones are in the ring by then. */
static dem_status lay_terms(builder *b, layout_part *part, dem_index block)
{
    layout *l = b->l;
    const int32_t at_row = (int32_t)(LAYOUT_LANES * block & (l->ring_rows - 1));
    lane_groups_choose(&b->groups);
    for (const lane_item *leader = lane_groups_take(&b->groups); leader != NULL;
         leader = lane_groups_take(&b->groups)) {
        const bool gathered = !lane_groups_side_by_side(&b->groups, leader);
        layout_entry e = {
            .at = 2 * (leader->base - at_row), .mask = lane_groups_mask(&b->groups), .kind = kind_of(b, gathered)};
        e.to = lane_groups_upper(&b->groups);
        if (e.kind == LAYOUT_ADD && leader->negative) e.kind = LAYOUT_SUBTRACT;
        if (gathered) TRY(list_operand(b, offsetof(lane_item, at), 0, 0, &e.at));
        TRY(add_entry(b, e));
    }
    return close_block(b, part, block);
}

/* ---- corners of triangles ---- */

/* Keeps how many blocks away the positions are that triangles read; springs read no further than `reach`. Verlet's
 * fused step drifts so far ahead. */
static void look_ahead(layout *l, dem_index block, int32_t place)
{
    const dem_index way = place / LAYOUT_LANES - block, ahead = (way > 0 ? way : -way) + 1;
    if (ahead > l->ahead) l->ahead = ahead;
}

/* The triangle in slot p of the row of node i, in a lane: the other two corners, and the coefficients. A triangle
 * without guard has the onset -inf, which no area is below. */
static lane_item triangle_of(const builder *b, int lane, dem_index i, dem_index p)
{
    const triangles *t = b->t;
    const int32_t next = place_of(b, t->next[p]), last = place_of(b, t->last[p]);
    const double rest_area = triangles_rest_area(t, i, p);
    const double onset = triangles_guard(t, p) > 0.0 ? TRIANGLES_GUARD_ONSET * rest_area : -INFINITY;
    const double kappa = t->area_stiffness_of != NULL ? t->area_stiffness_of[t->triangle[p]] : 0.0;
    return (lane_item){
        .at = next, .to = last, .base = next - lane, .last = last - lane, .set = {rest_area, onset, kappa}};
}

/* The items of the triangles at each node. */
static void list_corners(builder *b, dem_index block)
{
    const triangles *t = b->t;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index i = layout_node(b->l, LAYOUT_LANES * block + lane);
        b->groups.n[lane] = t->row[i + 1] - t->row[i];
        for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
            const lane_item own = triangle_of(b, lane, i, p);
            look_ahead(b->l, block, own.at);
            look_ahead(b->l, block, own.to);
            b->groups.items[lane * b->groups.most + p - t->row[i]] = own;
        }
    }
}

/* Ascending by the next corner, so that lanes with equal neighbours have the same order. */
static void insert(lane_item *items, dem_index n, lane_item own)
{
    for (; n > 0 && items[n - 1].at > own.at; n--) items[n] = items[n - 1];
    items[n] = own;
}

/* Those of the triangles of which it has the lowest number: from there their areas are seen, wherever the nodes have
 * their places. */
static void list_lowest(builder *b, dem_index block)
{
    const triangles *t = b->t;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index i = layout_node(b->l, LAYOUT_LANES * block + lane);
        b->groups.n[lane] = 0;
        for (dem_index p = t->row[i]; p < t->row[i + 1]; p++)
            if (t->next[p] > i && t->last[p] > i)
                insert(b->groups.items + lane * b->groups.most, b->groups.n[lane]++, triangle_of(b, lane, i, p));
    }
}

static dem_status lay_triangles(builder *b, layout_part *part, dem_index block)
{
    const int32_t row = (int32_t)(LAYOUT_LANES * block);
    for (const lane_item *leader = lane_groups_take(&b->groups); leader != NULL; leader = lane_groups_take(&b->groups))
        TRY(add_triangles(b, leader, row, &b->l->areas));
    return close_block(b, part, block);
}

/* Entries for triangles: always the k-th triangle of each node in the order of its row, as triangles_force() sums
 * them. */
static dem_status lay_corners(builder *b, dem_index block)
{
    list_corners(b, block);
    lane_groups_by_slot(&b->groups);
    return lay_triangles(b, &b->l->corners, block);
}

/* In what order triangles are looked at does not matter. */
static dem_status lay_lowest(builder *b, dem_index block)
{
    list_lowest(b, block);
    lane_groups_choose(&b->groups);
    return lay_triangles(b, &b->l->lowest, block);
}

/* ---- all blocks ---- */

/* A node with springs to a great part of the others needs a stream for each of them, and a long ring: then blocks are
 * given up, and every node is evaluated row by row. */
static bool worth_it(const builder *b)
{
    return ring_streams_length(&b->ring) * 16 <= ring_bytes + 64 * b->l->n_nodes;
}

/* Springs come before terms, since terms need to know where in the ring the forces are. The terms of a block refer to
 * this block and lower ones only. */
static dem_status lay_blocks(builder *b)
{
    layout *l = b->l;
    for (dem_index block = 0; block < l->n_blocks; block++) {
        TRY(lay_springs(b, block));
        if (l->coupled) TRY(lay_couplings(b, block));
        if (!worth_it(b)) {
            l->n_blocks = b->ring.n = 0;
            break;
        }
        list_terms(b, block);
        TRY(lay_terms(b, &l->terms, block));
        if (l->coupled) {
            list_coupling_terms(b, block);
            TRY(lay_terms(b, &l->coupling_terms, block));
        }
        TRY(lay_corners(b, block));
        TRY(lay_lowest(b, block));
    }
    l->ring_length = ring_streams_length(&b->ring);
    intern *const pools[] = {
        &l->springs.entries,        &l->terms.entries, &l->corners.entries, &l->lowest.entries, &l->couplings.entries,
        &l->coupling_terms.entries, &l->bonds,         &l->areas,           &l->couples};
    for (size_t k = 0; k < sizeof pools / sizeof *pools; k++) TRY(intern_settle(pools[k]));
    return DEM_OK;
}

static dem_status allocate_order(builder *b)
{
    layout *l = b->l;
    l->order = malloc((size_t)l->n_nodes * sizeof *l->order);
    b->place = malloc((size_t)l->n_nodes * sizeof *b->place);
    CHECK(l->order && b->place, DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)l->n_nodes);
    return DEM_OK;
}

/* Whether nodes stay as they are numbered, so many places from their neighbours. */
static bool keeps_order(const springs *s, dem_index span)
{
    return span <= usual_span || (least_rows * span <= s->n_nodes && renumber_is_by_rows(s));
}

/* Renumbers the nodes if neighbours are far apart as they are numbered and at most half as far after renumbering. Nodes
 * in rows stay as they are, however long rows are: their neighbours lie side by side, and only what is not renumbered
 * is taken in waves. Then sets the sizes that follow from the distance: how far blocks reach, and the length of the
 * ring, a power of 2 so that a place in it is found with a mask. */
static dem_status choose_order(builder *b)
{
    layout *l = b->l;
    dem_index span = renumber_span(b->s, NULL);
    if (!keeps_order(b->s, span)) {
        TRY(allocate_order(b));
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
    for (l->ring_rows = LAYOUT_LANES; l->ring_rows < LAYOUT_LANES * (l->reach + 3);) l->ring_rows *= 2;
    b->ring.rows = l->ring_rows;
    return DEM_OK;
}

dem_index layout_most_items(const springs *s, const triangles *t, const couplings *c)
{
    dem_index most = 0;
    for (dem_index i = 0; i < s->n_nodes; i++) {
        const dem_index n[3] = {s->row[i + 1] - s->row[i], t->row[i + 1] - t->row[i], c->row[i + 1] - c->row[i]};
        for (int k = 0; k < 3; k++) most = n[k] > most ? n[k] : most;
    }
    return most;
}

static dem_status allocate(builder *b)
{
    const dem_index most = layout_most_items(b->s, b->t, b->c);
    layout *l = b->l;
    const size_t n = (size_t)l->n_blocks + 1;
    b->force = malloc(((size_t)b->s->n_springs + 1) * sizeof *b->force);
    b->corner_force = malloc((3 * (size_t)b->c->n + 1) * sizeof *b->corner_force);
    b->slot = malloc(((size_t)most + 1) * sizeof *b->slot);
    layout_part *const parts[] = {&l->springs, &l->terms, &l->corners, &l->lowest, &l->couplings, &l->coupling_terms};
    bool complete = lane_groups_create(&b->groups, most) && b->force && b->corner_force && b->slot;
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const bool needed = l->coupled || (parts[k] != &l->couplings && parts[k] != &l->coupling_terms);
        *parts[k] = (layout_part){needed ? calloc(n, sizeof(intern_span)) : NULL, {.unit = sizeof(layout_entry)}};
        complete = complete && (!needed || parts[k]->span != NULL);
    }
    CHECK(complete, DEM_ERROR_MEMORY, "out of memory for %lld springs", (long long)b->s->n_springs);
    return choose_order(b);
}

/* Places are of 32 bits, which halves the memory of entries; springs_compile() has refused larger lattices. */
dem_status layout_compile(layout *out, const springs *s, const triangles *t, const couplings *c)
{
    layout l = {.n_nodes = s->n_nodes,
                .n_blocks = s->n_nodes / LAYOUT_LANES,
                .damped = s->viscosity_of != NULL,
                .stiff = t->area_stiffness_of != NULL,
                .coupled = c->n > 0};
    builder b = {.l = &l, .s = s, .t = t, .c = c};
    l.bonds.unit = l.areas.unit = l.couples.unit = sizeof(double); /* the unit of the entries is set in allocate() */
    dem_status status = allocate(&b);
    if (status == DEM_OK) status = lay_blocks(&b);
    lane_groups_free(&b.groups);
    free(b.force);
    free(b.corner_force);
    free(b.place);
    free(b.slot);
    ring_streams_free(&b.ring);
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
    free_part(&l->lowest);
    free_part(&l->couplings);
    free_part(&l->coupling_terms);
    intern_free(&l->bonds);
    intern_free(&l->areas);
    intern_free(&l->couples);
    free(l->order);
    free(l->lists);
    *l = (layout){0};
}
