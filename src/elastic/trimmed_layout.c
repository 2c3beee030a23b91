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
#include "elastic/lane_slots.h"

enum { n_parts = 5, usual_bytes = 1 << 14 };

/* ---- set-up ---- */

static dem_status copy_part(layout_part *out, const layout_part *from, dem_index n_blocks)
{
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
}

/* All but springs' sets, entries and where these are is that of the whole body. */
static dem_status copy_layout(layout *out, const layout *whole)
{
    layout_part *const parts[n_parts] = {&out->springs, &out->terms, &out->corners, &out->couplings,
                                         &out->coupling_terms};
    const layout_part *const from[n_parts] = {&whole->springs, &whole->terms, &whole->corners, &whole->couplings,
                                              &whole->coupling_terms};
    dem_status status = DEM_OK;
    *out = *whole;
    for (int k = 0; k < n_parts; k++) *parts[k] = (layout_part){0};
    out->bonds = (intern){0};
    for (int k = 0; k < n_parts && status == DEM_OK; k++) status = copy_part(parts[k], from[k], whole->n_blocks);
    if (status == DEM_OK) status = intern_copy(&out->bonds, &whole->bonds);
    if (status != DEM_OK) free_own(out);
    return status;
}

/* Bytes of what grows. */
static double bytes_of(const layout *l)
{
    const intern *const pools[] = {&l->springs.entries,   &l->terms.entries,          &l->corners.entries,
                                   &l->couplings.entries, &l->coupling_terms.entries, &l->bonds};
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
    if (l->whole->order != NULL) l->place = malloc(n * sizeof *l->place);
    CHECK(l->trimmed && l->slot && l->left && (l->place || l->whole->order == NULL), DEM_ERROR_MEMORY,
          "out of memory for the layout of springs");
    for (size_t q = 0; l->place != NULL && q < n; q++) l->place[l->whole->order[q]] = (int32_t)q;
    return DEM_OK;
}

dem_status trimmed_layout_create(trimmed_layout *out, const layout *whole, const springs *s, const triangles *t,
                                 const couplings *c)
{
    trimmed_layout l = {.whole = whole, .springs = s, .triangles = t, .couplings = c};
    dem_status status = allocate(&l);
    if (status == DEM_OK) status = copy_layout(&l.layout, whole);
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
    free(l->entries);
    *l = (trimmed_layout){0};
}

/* ---- what is left of the items of the lanes ---- */

static dem_index node_of(const trimmed_layout *l, dem_index block, int lane)
{
    return layout_node(l->whole, LAYOUT_LANES * block + lane);
}

static double of_triangle(const trimmed_elements *e, dem_index triangle)
{
    return e->broken[triangle] ? 0.0 : 1.0;
}

static void fill_springs(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index n = lane_slots_springs(l->springs, l->place, node_of(l, block, lane), l->slot);
        for (dem_index k = 0; k < n; k++) l->left[lane * l->most + k] = e->integrity[l->springs->spring[l->slot[k]]];
    }
}

static void fill_terms(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const springs *s = l->springs;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index i = node_of(l, block, lane);
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++)
            l->left[lane * l->most + p - s->row[i]] = e->integrity[s->spring[p]];
    }
}

static void fill_corners(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const triangles *t = l->triangles;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index i = node_of(l, block, lane);
        for (dem_index p = t->row[i]; p < t->row[i + 1]; p++)
            l->left[lane * l->most + p - t->row[i]] = of_triangle(e, t->triangle[p]);
    }
}

static void fill_couplings(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const couplings *c = l->couplings;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index n = lane_slots_couplings(c, l->place, node_of(l, block, lane), l->slot);
        for (dem_index k = 0; k < n; k++)
            l->left[lane * l->most + k] = of_triangle(e, c->list[c->slot[l->slot[k]] / 3].triangle);
    }
}

static void fill_coupling_terms(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const couplings *c = l->couplings;
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const dem_index i = node_of(l, block, lane);
        for (dem_index p = c->row[i]; p < c->row[i + 1]; p++)
            l->left[lane * l->most + p - c->row[i]] = of_triangle(e, c->list[c->slot[p] / 3].triangle);
    }
}

/* ---- entries ---- */

enum { every_lane = 0xffff, one_lane = 3 };

static unsigned lane_bits(int lane)
{
    return (unsigned)one_lane << 2 * lane;
}

/* The mask of an entry without the lanes of which nothing is left. `next` counts the items of each lane. */
static unsigned whole_lanes(const trimmed_layout *l, unsigned mask, const dem_index *next)
{
    unsigned kept = 0;
    for (int lane = 0; lane < LAYOUT_LANES; lane++)
        if ((mask & lane_bits(lane)) && l->left[lane * l->most + next[lane]] > 0.0) kept |= lane_bits(lane);
    return kept;
}

/* A set in which the springs of these lanes have the stiffness and the viscosity that are left. Those of others do not
 * count: they are as in the whole body, so that more sets are equal. */
static dem_status find_set(trimmed_layout *l, unsigned mask, const dem_index *next, int32_t *set)
{
    double values[3 * LAYOUT_LANES];
    const dem_index n = (l->whole->damped ? 3 : 2) * LAYOUT_LANES;
    bool weaker = false;
    intern_span span;
    memcpy(values, (const double *)l->whole->bonds.items + *set, (size_t)n * sizeof *values);
    for (int lane = 0; lane < LAYOUT_LANES; lane++) {
        const double left = mask & lane_bits(lane) ? l->left[lane * l->most + next[lane]] : 1.0;
        if (left == 1.0) continue;
        weaker = true;
        for (dem_index k = layout_lane(lane); k < n; k += 2 * LAYOUT_LANES) values[k] *= left;
    }
    if (!weaker) return DEM_OK;
    TRY(intern_find(&l->layout.bonds, values, n, &span));
    *set = span.first;
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

/* What a block does in one part, `width` entries for each of its steps, of the items that `left` is filled with. */
static dem_status trim_part(trimmed_layout *l, layout_part *part, const layout_part *whole, dem_index block, int width)
{
    const intern_span span = whole->span[block];
    dem_index next[LAYOUT_LANES] = {0};
    bool changed = false;
    l->n_entries = 0;
    for (int32_t p = span.first; p < span.end; p += width) {
        layout_entry e[2];
        memcpy(e, (const layout_entry *)whole->entries.items + p, (size_t)width * sizeof *e);
        const unsigned mask = e->mask, kept = whole_lanes(l, mask, next);
        const int32_t set = e->set;
        if (part == &l->layout.springs) TRY(find_set(l, kept, next, &e->set));
        changed = changed || kept != mask || e->set != set;
        e->mask = (uint16_t)kept;
        if (e->kind != LAYOUT_GATHERED && kept != every_lane) e->kind = LAYOUT_MASKED;
        if (kept != 0) TRY(add_entries(l, e, width));
        for (int lane = 0; lane < LAYOUT_LANES; lane++) next[lane] += (mask & lane_bits(lane)) != 0;
    }
    part->span[block] = span;
    return changed ? intern_find(&part->entries, l->entries, l->n_entries, &part->span[block]) : DEM_OK;
}

/* A place of the whole body's pools means the same in the trimmed ones, which begin with a copy of them. */
static dem_status trim_block(trimmed_layout *l, const trimmed_elements *e, dem_index block)
{
    const layout *whole = l->whole;
    fill_springs(l, e, block);
    TRY(trim_part(l, &l->layout.springs, &whole->springs, block, 1));
    fill_terms(l, e, block);
    TRY(trim_part(l, &l->layout.terms, &whole->terms, block, 1));
    fill_corners(l, e, block);
    TRY(trim_part(l, &l->layout.corners, &whole->corners, block, 1));
    if (!whole->coupled) return DEM_OK;
    fill_couplings(l, e, block);
    TRY(trim_part(l, &l->layout.couplings, &whole->couplings, block, 2));
    fill_coupling_terms(l, e, block);
    return trim_part(l, &l->layout.coupling_terms, &whole->coupling_terms, block, 1);
}

/* Without what blocks had at earlier times. */
static dem_status begin_anew(trimmed_layout *l, const trimmed_elements *e)
{
    free_own(&l->layout);
    TRY(copy_layout(&l->layout, l->whole));
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
