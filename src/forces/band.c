/* SPDX-License-Identifier: BSD-3-Clause */
/* A band is swept with a ring of its own state; then what the sweep leaves out is evaluated row by row as in kernel.c:
 * nodes on which the guard acts, and nodes behind the last block. */
#include "forces/band.h"

/* What stands behind the ring. */
typedef struct guard_look {
    dem_index end;     /* blocks up to here may have corners of triangles that are folded, or nearly so; */
    uint8_t guarded[]; /* [blocks_of_band()] sweep.guarded, of the band */
} guard_look;

static dem_index blocks_of_band(const layout *l)
{
    return l->ahead;
}

dem_index band_nodes(const kernel *k)
{
    const layout *l = &k->model->layout;
    return k->packed == NULL && l->n_blocks > 0 ? LAYOUT_LANES * blocks_of_band(l) : 0;
}

size_t band_scratch(const kernel *k)
{
    const size_t flags = (size_t)blocks_of_band(&k->model->layout);
    return k->ring_size + (sizeof(guard_look) + flags + sizeof(double) - 1) / sizeof(double);
}

bool band_is_possible(kernel *k, const forces *f, const double *x, int n_stages)
{
    return kernel_can_fuse(k, f) && kernel_is_trimmed(k, f->elements) &&
           (f->surfaces == NULL || surface_contact_begin_stages(f->surfaces, x, n_stages));
}

bool band_was_possible(const forces *f, int n_stages)
{
    return f->surfaces == NULL || surface_contact_stayed_apart(f->surfaces, n_stages);
}

static double accelerate_row(const forces *f, const band *b, dem_index i)
{
    const vec2 a = forces_body_acceleration(f, i, b->x, b->v);
    vec2_put(b->a, i, a);
    return sweep_term(a);
}

/* The nodes of a block on which the guard acts. */
static double accelerate_guarded(const forces *f, const band *b, dem_index block, unsigned guarded)
{
    double sum = 0.0;
    for (dem_index lane = 0; guarded >> lane != 0; lane++)
        if (guarded >> lane & 1) sum += accelerate_row(f, b, LAYOUT_LANES * block + lane);
    return sum;
}

/* Takes note of the blocks in which triangles with a lowest corner in this one may have others. */
static void note_lowest(guard_look *look, const sweep *s, dem_index block)
{
    if (s->guarded[block] != 0) look->end = block + s->layout->ahead + 1;
}

/* Of a band that does not go on from the one before: whose triangles have corners in it. */
static void look_behind(const kernel *k, const sweep *s, dem_index first, guard_look *look)
{
    const dem_index from = first > s->layout->ahead ? first - s->layout->ahead : 0;
    sweep behind = *s;
    behind.guarded = look->guarded - from;
    look->end = 0;
    k->sweep_guard(&behind, from, first);
    for (dem_index block = from; block < first; block++) note_lowest(look, &behind, block);
}

/* From the lowest corners of triangles to all nodes of the band on which the guard acts. */
static void find_guarded(const kernel *k, const sweep *s, const dem_index blocks[2], guard_look *look)
{
    sweep all_corners = *s;
    all_corners.looks_at_lowest = false;
    for (dem_index block = blocks[0]; block < blocks[1]; block++) {
        note_lowest(look, s, block);
        if (block < look->end) k->sweep_guard(&all_corners, block, block + 1);
    }
}

double band_accelerate(const kernel *k, const forces *f, const band *b)
{
    const layout *l = &k->model->layout;
    const dem_index first = b->first / LAYOUT_LANES, end = b->end / LAYOUT_LANES;
    const dem_index last = end < l->n_blocks ? end : l->n_blocks;
    guard_look *look = (guard_look *)(b->scratch + k->ring_size);
    const sweep s = {.layout = kernel_layout(k, f->elements),
                     .goes_on = b->goes_on,
                     .inverse_mass = k->model->inverse_mass,
                     .gravity = {f->gravity[0], f->gravity[1]},
                     .x = b->x,
                     .v = b->v,
                     .a = b->a,
                     .guarded = look->guarded - first,
                     .looks_at_lowest = !l->stiff};
    if (f->surfaces != NULL && b->is_own)
        surface_contact_take_stage(f->surfaces, b->stage, (const dem_index[2]){b->first, b->end}, b->x);
    if (s.looks_at_lowest && !b->goes_on && first < last) look_behind(k, &s, first, look);
    double sum = first < last ? k->sweep(&s, first, last, b->scratch) : 0.0;
    if (s.looks_at_lowest) find_guarded(k, &s, (const dem_index[]){first, last}, look);
    for (dem_index block = first; block < last; block++)
        if (s.guarded[block] != 0) sum += accelerate_guarded(f, b, block, s.guarded[block]);
    for (dem_index i = first > l->n_blocks ? b->first : LAYOUT_LANES * l->n_blocks; i < b->end; i++)
        sum += accelerate_row(f, b, i);
    return sum;
}
