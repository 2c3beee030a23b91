/* SPDX-License-Identifier: BSD-3-Clause */
/* An entry of a block says for each lane that takes part what it does next in its own order: that of its row, or of its
 * upper nodes (lane_slots.h). So the item behind each lane of each entry is found by counting, and those of broken
 * elements leave: their lanes are masked, entries without lanes go, and a spring that is weaker has a set of
 * coefficients of its own. Which lanes share an entry, and where forces lie in the ring, stays as it is, so a block can
 * be trimmed without its neighbours. Sums of a node have the same terms in the same order as its row, hence its bits.
 * Broken springs may be evaluated in lanes of an entry in which others are whole; nobody collects their forces.
 * Lists of entries and sets of earlier times stay behind when a block is trimmed again; when they are half of what
 * there is, all blocks that are not whole are trimmed anew. */
#include "elastic/trimmed_layout.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"
#include "elastic/lane_groups.h"
#include "elastic/lane_slots.h"

enum { n_parts = 5, usual_bytes = 1 << 14 };

/* ---- set-up ---- */

static dem_status copy_part(layout_part *out, const layout_part *from, dem_index n_blocks)
{
    if (from->span == NULL) return DEM_OK;
    *out = (layout_part){.span = malloc(((size_t)n_blocks + 1) * sizeof *out->span)};
    CHECK_MEMORY(out->span);
    memcpy(out->span, from->span, (size_t)n_blocks * sizeof *out->span);
    return intern_copy(&out->entries, &from->entries);
}

static void free_part(layout_part *part)
{
    free(part->span);
    intern_free(&part->entries);
    part->span = NULL;
}

static void free_own(layout *l)
{
    layout_part *const parts[n_parts] = {&l->springs, &l->terms, &l->corners, &l->couplings, &l->coupling_terms};
    for (int k = 0; k < n_parts; k++) free_part(parts[k]);
    intern_free(&l->bonds);
    if (!l->softened) return;
    intern_free(&l->areas);
    intern_free(&l->couples);
}

static dem_status copy_sets(layout *out, const layout *whole)
{
    TRY(intern_copy(&out->bonds, &whole->bonds));
    if (!out->softened) return DEM_OK;
    TRY(intern_copy(&out->areas, &whole->areas));
    return intern_copy(&out->couples, &whole->couples);
}

/* Sets that may change, entries and where these are: all else is that of the whole body. In `lowest` broken triangles
 * stay, which only cost a second look where they are folded. */
static dem_status copy_layout(layout *out, const layout *whole, bool softens)
{
    layout_part *const parts[n_parts] = {&out->springs, &out->terms, &out->corners, &out->couplings,
                                         &out->coupling_terms};
    const layout_part *const from[n_parts] = {&whole->springs, &whole->terms, &whole->corners, &whole->couplings,
                                              &whole->coupling_terms};
    dem_status status = DEM_OK;
    *out = *whole;
    for (int k = 0; k < n_parts; k++) *parts[k] = (layout_part){0};
    out->softened = softens;
    out->bonds = (intern){0};
    if (softens) out->areas = out->couples = (intern){0};
    for (int k = 0; k < n_parts && status == DEM_OK; k++) status = copy_part(parts[k], from[k], whole->n_blocks);
    if (status == DEM_OK) status = copy_sets(out, whole);
    if (status != DEM_OK) free_own(out);
    return status;
}

/* Bytes of what grows. */
static double bytes_of(const layout *l)
{
    const intern *const pools[] = {
        &l->springs.entries,        &l->terms.entries, &l->corners.entries, &l->couplings.entries,
        &l->coupling_terms.entries, &l->bonds,         &l->areas,           &l->couples};
    double sum = 0.0;
    for (size_t k = 0; k < sizeof pools / sizeof *pools; k++) sum += (double)pools[k]->n * (double)pools[k]->unit;
    return sum;
}

static dem_status allocate(trimmed_layout *l)
{
    const size_t n = (size_t)l->whole->n_nodes;
    l->most = layout_most_items(l->springs, l->triangles, l->couplings);
    l->trimmed = calloc((size_t)l->whole->n_blocks + 1, sizeof *l->trimmed);
    l->slot = malloc(((size_t)l->most + 1) * sizeof *l->slot);
    l->left = malloc(LAYOUT_LANES * ((size_t)l->most + 1) * sizeof *l->left);
    l->pulled = malloc(LAYOUT_LANES * ((size_t)l->most + 1) * sizeof *l->pulled);
    if (l->whole->order != NULL) l->place = malloc(n * sizeof *l->place);
    CHECK(l->trimmed && l->slot && l->left && l->pulled && (l->place || l->whole->order == NULL), DEM_ERROR_MEMORY,
          "out of memory for the layout of springs");
    for (size_t q = 0; l->place != NULL && q < n; q++) l->place[l->whole->order[q]] = (int32_t)q;
    return DEM_OK;
}

dem_status trimmed_layout_create(trimmed_layout *out, const layout *whole, const springs *s, const triangles *t,
                                 const couplings *c, bool softens)
{
    trimmed_layout l = {.whole = whole, .springs = s, .triangles = t, .couplings = c};
    dem_status status = allocate(&l);
    if (status == DEM_OK) status = copy_layout(&l.layout, whole, softens);
    l.settled = bytes_of(whole);
    if (status == DEM_OK)
        *out = l;
    else
        trimmed_layout_destroy(&l);
    return status;
}

void trimmed_layout_destroy(trimmed_layout *l)
{
    free_own(&l->layout);
    free(l->place);
    free(l->trimmed);
    free(l->slot);
    free(l->left);
    free(l->pulled);
    free(l->entries);
    *l = (trimmed_layout){0};
}

/* ---- what is left of the items of the lanes ---- */

static dem_index node_of(const trimmed_layout *l, dem_index block, int lane)
{
    return layout_node(l->whole, LAYOUT_LANES * block + lane);
}

/* Item k of a lane: what is left of it, and what is in tension. */
static void put(trimmed_layout *l, int lane, dem_index k, double left, double pulled)
{
    l->left[lane * l->most + k] = left;
    l->pulled[lane * l->most + k] = pulled;
}

static void put_spring(trimmed_layout *l, const trimmed_elements *e, int lane, dem_index k, dem_index spring)
{
    put(l, lane, k, springs_left(e->springs, spring, 0.0), springs_left(e->springs, spring, 1.0));
}

/* Terms are of forces that have been evaluated. */
static void put_term(trimmed_layout *l, int lane, dem_index k, bool broken)
{
    put(l, lane, k, broken ? 0.0 : 1.0, 1.0);
}

static void fill_springs(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const springs *s = l->springs;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index n = lane_slots_springs(s, l->place, node_of(l, block, lane), l->slot);
        for (dem_index k = 0; k < n; k++) put_spring(l, e, lane, k, s->spring[l->slot[k]]);
    }
}

static void fill_terms(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const springs *s = l->springs;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index i = node_of(l, block, lane);
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++)
            put_term(l, lane, p - s->row[i], springs_is_broken(e->springs, s->spring[p]));
    }
}

static void put_corner(trimmed_layout *l, const trimmed_elements *e, int lane, dem_index k, dem_index p)
{
    const triangles *t = l->triangles;
    if (t->area_stiffness_of == NULL || triangles_broken(t, e->triangles, p))
        put_term(l, lane, k, triangles_broken(t, e->triangles, p));
    else
        put(l, lane, k, triangles_area_left(t, e->triangles, p, false), triangles_area_left(t, e->triangles, p, true));
}

static void fill_corners(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const int32_t *row = l->triangles->row;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index i = node_of(l, block, lane);
        for (dem_index p = row[i]; p < row[i + 1]; p++) put_corner(l, e, lane, p - row[i], p);
    }
}

static void fill_couplings(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const couplings *c = l->couplings;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index n = lane_slots_couplings(c, l->place, node_of(l, block, lane), l->slot);
        for (dem_index k = 0; k < n; k++) {
            const dem_index t = c->slot[l->slot[k]] / 3;
            put(l, lane, k, couplings_broken(c, e->triangles, t) ? 0.0 : 1.0, couplings_left(c, e->triangles, t));
        }
    }
}

static void fill_coupling_terms(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const couplings *c = l->couplings;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index i = node_of(l, block, lane);
        for (dem_index p = c->row[i]; p < c->row[i + 1]; p++)
            put_term(l, lane, p - c->row[i], couplings_broken(c, e->triangles, c->slot[p] / 3));
    }
}

/* ---- entries ---- */

/* How one part is trimmed. Of coefficients `width` for each lane, `stiffness` and `viscosity` are the numbers of those;
 * -1: there is none. */
typedef struct trimming {
    layout_part *part;
    const layout_part *whole;
    int n_entries; /* of each of its steps */
    intern *sets;  /* NULL: none that would change */
    const intern *whole_sets;
    int width, stiffness, viscosity;
} trimming;

enum { every_lane = 0xffff, one_lane = 3 };

static unsigned lane_bits(int lane)
{
    return (unsigned)one_lane << 2 * lane;
}

/* What is left of the items of an entry. */
typedef struct remains {
    unsigned mask;       /* its lanes without those of which nothing is left; of these: */
    bool weaker, softer; /* some are not whole; and have less in tension than under pressure */
} remains;

/* `next` counts the items of each lane, and goes on by those of these lanes. */
static remains pass_lanes(const trimmed_layout *l, unsigned mask, dem_index *next)
{
    remains r = {0, false, false};
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        if (!(mask & lane_bits(lane))) continue;
        const dem_index item = lane * l->most + next[lane]++;
        const double left = l->left[item], pulled = l->pulled[item];
        if (!(left > 0.0)) continue;
        r.mask |= lane_bits(lane);
        r.weaker = r.weaker || left != 1.0 || pulled != 1.0;
        r.softer = r.softer || pulled != left;
    }
    return r;
}

/* Of a set as wide as its layout has it: the stiffness, and the viscosity where there is one, of what is left of the
 * items of these lanes; and behind it the stiffness in tension, or of coupled triangles what is left of the couplings.
 * Those of other lanes do not count: they are as in the whole body, so that more sets are equal. */
static void fill_set(const trimmed_layout *l, const trimming *t, unsigned mask, const dem_index *passed, double *values)
{
    double *own = t->stiffness >= 0 ? values + t->stiffness * LAYOUT_LANES : NULL;
    double *behind = values + t->width * LAYOUT_LANES;
    for (int q = 0; q < LAYOUT_LANES; q++) behind[q] = own != NULL ? own[q] : 1.0;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index item = lane * l->most + passed[lane] - 1;
        const int q = layout_lane(lane);
        if (!(mask & lane_bits(lane))) continue;
        behind[q] *= l->pulled[item];
        if (own != NULL) own[q] *= l->left[item];
        if (t->viscosity >= 0) values[t->viscosity * LAYOUT_LANES + q] *= l->pulled[item];
    }
}

/* A set of its own for an entry of which something has softened, or a spring has lost a triangle. `passed` counts the
 * items of each lane up to those of the entry. */
static dem_status find_set(trimmed_layout *l, const trimming *t, const dem_index *passed, remains r, layout_entry *e)
{
    double values[(LANE_ITEM_WIDTH + 1) * LAYOUT_LANES];
    intern_span span;
    if (t->sets == NULL || !r.weaker) return DEM_OK;
    memcpy(values, (const double *)t->whole_sets->items + e->set, (size_t)(t->width * LAYOUT_LANES) * sizeof *values);
    fill_set(l, t, r.mask, passed, values);
    TRY(intern_find(t->sets, values, (t->width + r.softer) * LAYOUT_LANES, &span));
    e->set = span.first;
    e->soft = r.softer;
    return DEM_OK;
}

static dem_status add_entries(trimmed_layout *l, const layout_entry *from, dem_index n)
{
    CHECK(grow_array((void **)&l->entries, &l->entry_capacity, l->n_entries + n, sizeof *from), DEM_ERROR_MEMORY,
          "out of memory for the layout of springs");
    memcpy(l->entries + l->n_entries, from, (size_t)n * sizeof *from);
    l->n_entries += n;
    return DEM_OK;
}

/* What a block does in one part, of the items that `left` and `pulled` are filled with. Runs of whole rows take no soft
 * entries, which are therefore never said to be whole. */
static dem_status trim_part(trimmed_layout *l, const trimming *t, dem_index block)
{
    const intern_span span = t->whole->span[block];
    dem_index next[LAYOUT_LANES] = {0};
    bool changed = false;
    l->n_entries = 0;
    for (int32_t p = span.first; p < span.end; p += t->n_entries) {
        layout_entry e[2];
        memcpy(e, (const layout_entry *)t->whole->entries.items + p, (size_t)t->n_entries * sizeof *e);
        const unsigned mask = e->mask;
        const int32_t set = e->set;
        const remains r = pass_lanes(l, mask, next);
        e->mask = (uint16_t)r.mask;
        TRY(find_set(l, t, next, r, e));
        changed = changed || e->mask != mask || e->set != set;
        if (e->kind != LAYOUT_GATHERED && (e->mask != every_lane || e->soft)) e->kind = LAYOUT_MASKED;
        if (e->mask != 0) TRY(add_entries(l, e, t->n_entries));
    }
    t->part->span[block] = span;
    return changed ? intern_find(&t->part->entries, l->entries, l->n_entries, &t->part->span[block]) : DEM_OK;
}

/* A place of the whole body's pools means the same in the trimmed ones, which begin with a copy of them. Sets of areas
 * and couplings stay as they are where nothing softens. */
static dem_status trim_block(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const layout *whole = l->whole;
    layout *own = &l->layout;
    const bool damped = whole->damped, soft = own->softened;
    const trimming of_springs = {&own->springs, &whole->springs, 1, &own->bonds,
                                 &whole->bonds, 2 + damped,      0, damped ? 2 : -1},
                   of_corners = {&own->corners, &whole->corners, 1, soft ? &own->areas : NULL, &whole->areas, 3, 2, -1},
                   of_couplings = {
                       &own->couplings, &whole->couplings, 2, soft ? &own->couples : NULL, &whole->couples, 6, -1, -1};
    fill_springs(l, e, block);
    TRY(trim_part(l, &of_springs, block));
    fill_terms(l, e, block);
    TRY(trim_part(l, &(trimming){&own->terms, &whole->terms, .n_entries = 1}, block));
    fill_corners(l, e, block);
    TRY(trim_part(l, &of_corners, block));
    if (!whole->coupled) return DEM_OK;
    fill_couplings(l, e, block);
    TRY(trim_part(l, &of_couplings, block));
    fill_coupling_terms(l, e, block);
    return trim_part(l, &(trimming){&own->coupling_terms, &whole->coupling_terms, .n_entries = 1}, block);
}

/* Without what blocks had at earlier times. */
static dem_status begin_anew(trimmed_layout *l, const trimmed_elements *e)
{
    const bool softens = l->layout.softened;
    free_own(&l->layout);
    TRY(copy_layout(&l->layout, l->whole, softens));
    for (dem_index block = 0; block < l->whole->n_blocks; block++)
        if (l->trimmed[block] != 0) TRY(trim_block(l, e, block));
    l->settled = bytes_of(&l->layout);
    return DEM_OK;
}

dem_status trimmed_layout_follow(trimmed_layout *l, const trimmed_elements *left, const dem_index *nodes, dem_index n)
{
    l->call++;
    for (dem_index j = 0; j < n; j++) {
        const dem_index block = lane_slots_place(l->place, nodes[j]) / LAYOUT_LANES;
        if (block >= l->whole->n_blocks || l->trimmed[block] == l->call) continue;
        l->trimmed[block] = l->call;
        TRY(trim_block(l, left, block));
    }
    return bytes_of(&l->layout) > 2.0 * l->settled + usual_bytes ? begin_anew(l, left) : DEM_OK;
}
