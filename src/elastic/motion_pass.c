/* SPDX-License-Identifier: BSD-3-Clause */
/* The passes over nodes; compiled once for each instruction set, whose vectors LANES names. Nodes that do not fill a
 * vector come one by one behind the others. Sums have twice the digits of a double, so that they do not depend on how
 * nodes are numbered. */
#include LANES

#include "elastic/lanes_twofold.h"
#include "elastic/motion_pass.h"

/* How many of the nodes from `first` on fill vectors. */
static dem_index whole_of(dem_index first, dem_index last)
{
    return last - (last - first) % LAYOUT_LANES;
}

/* One number for each of eight nodes. */
INLINE lanes numbers(pairs spread)
{
    return pairs_dot(spread, pairs_both(1.0, 0.0));
}

INLINE void measure_vectors(const motion_pass *p, dem_index first, dem_index last, motion_sums *out)
{
    const bool heavy = p->gravity.x != 0.0 || p->gravity.y != 0.0;
    const pairs g = pairs_both(p->gravity.x, p->gravity.y);
    lanes_twofold kinetic = lanes_twofold_none(), weight = lanes_twofold_none();
    pairs_twofold place = pairs_twofold_none(), momentum = pairs_twofold_none();
    for (dem_index i = first; i < last; i += LAYOUT_LANES) {
        const pairs x = pairs_load(p->x + 2 * i), v = pairs_load(p->v + 2 * i), mass = pairs_spread(p->mass + i);
        const lanes m = numbers(mass);
        pairs_twofold_add(&place, pairs_mul(mass, x));
        pairs_twofold_add(&momentum, pairs_mul(mass, v));
        lanes_twofold_add(&kinetic, lanes_mul(lanes_mul(lanes_all(0.5), m), pairs_dot(v, v)));
        if (heavy) lanes_twofold_add(&weight, lanes_mul(lanes_mul(lanes_all(-1.0), m), pairs_dot(g, x)));
    }
    lanes_twofold_join(&kinetic, &out->kinetic);
    lanes_twofold_join(&weight, &out->weight);
    pairs_twofold_join(&place, out->place);
    pairs_twofold_join(&momentum, out->momentum);
}

static void measure_node(const motion_pass *p, dem_index i, motion_sums *out)
{
    const vec2 x = vec2_at(p->x, i), v = vec2_at(p->v, i);
    const double m = p->mass[i];
    twofold_add(&out->place[0], m * x.x);
    twofold_add(&out->place[1], m * x.y);
    twofold_add(&out->momentum[0], m * v.x);
    twofold_add(&out->momentum[1], m * v.y);
    twofold_add(&out->kinetic, 0.5 * m * vec2_dot(v, v));
    twofold_add(&out->weight, -m * vec2_dot(p->gravity, x));
}

void MOTION_PASS(const motion_pass *p, dem_index first, dem_index last, motion_sums *out)
{
    const dem_index whole = whole_of(first, last);
    *out = (motion_sums){0};
    if (whole > first) measure_vectors(p, first, whole, out);
    for (dem_index i = whole; i < last; i++) measure_node(p, i, out);
}

twofold MOTION_PASS_SPIN(const motion_pass *p, dem_index first, dem_index last, const vec2 mean[2])
{
    const dem_index whole = whole_of(first, last);
    const pairs centre = pairs_both(mean[0].x, mean[0].y), velocity = pairs_both(mean[1].x, mean[1].y);
    lanes_twofold spin = lanes_twofold_none();
    twofold sum = {0};
    for (dem_index i = first; i < whole; i += LAYOUT_LANES) {
        const pairs r = pairs_sub(pairs_load(p->x + 2 * i), centre), u = pairs_sub(pairs_load(p->v + 2 * i), velocity);
        lanes_twofold_add(&spin, lanes_mul(numbers(pairs_spread(p->mass + i)), pairs_cross(r, u)));
    }
    lanes_twofold_join(&spin, &sum);
    for (dem_index i = whole; i < last; i++) {
        const vec2 r = vec2_sub(vec2_at(p->x, i), mean[0]), u = vec2_sub(vec2_at(p->v, i), mean[1]);
        twofold_add(&sum, p->mass[i] * vec2_cross(r, u));
    }
    return sum;
}
