/* SPDX-License-Identifier: BSD-3-Clause */
/* A band is swept with a ring of its own state; then what the sweep leaves out is evaluated row by row as in kernel.c:
 * nodes on which the guard acts, and nodes behind the last block. */
#include "forces/band.h"

/* Bits of blocks in which the guard acts stand behind the ring, eight bytes to a number. */
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
    return k->ring_size + (size_t)blocks_of_band(&k->model->layout);
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

double band_accelerate(const kernel *k, const forces *f, const band *b)
{
    const layout *l = &k->model->layout;
    const dem_index first = b->first / LAYOUT_LANES, end = b->end / LAYOUT_LANES;
    const dem_index last = end < l->n_blocks ? end : l->n_blocks;
    uint8_t *guarded = (uint8_t *)(b->scratch + k->ring_size);
    const sweep s = {.layout = kernel_layout(k, f->elements),
                     .goes_on = b->goes_on,
                     .inverse_mass = k->model->inverse_mass,
                     .gravity = {f->gravity[0], f->gravity[1]},
                     .x = b->x,
                     .v = b->v,
                     .a = b->a,
                     .guarded = guarded - first};
    if (f->surfaces != NULL && b->is_own)
        surface_contact_take_stage(f->surfaces, b->stage, (const dem_index[2]){b->first, b->end}, b->x);
    double sum = first < last ? k->sweep(&s, first, last, b->scratch) : 0.0;
    for (dem_index block = first; block < last; block++)
        if (guarded[block - first] != 0) sum += accelerate_guarded(f, b, block, guarded[block - first]);
    for (dem_index i = first > l->n_blocks ? b->first : LAYOUT_LANES * l->n_blocks; i < b->end; i++)
        sum += accelerate_row(f, b, i);
    return sum;
}
