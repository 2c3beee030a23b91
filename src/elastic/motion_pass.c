/* SPDX-License-Identifier: BSD-3-Clause */
/* The passes over nodes; compiled once for each instruction set, whose vectors LANES names. Nodes that do not fill a
 * vector come one by one behind the others. */
#include LANES

#include "elastic/lanes_terms.h"
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

/* Terms of the sums over some nodes. */
typedef struct motion_terms {
    exact_terms kinetic, weight, place, momentum; /* the last two of pairs */
} motion_terms;

static void begin(motion_terms *t, motion_sums *out)
{
    exact_terms_begin(&t->kinetic, &out->kinetic);
    exact_terms_begin(&t->weight, &out->weight);
    exact_terms_begin(&t->place, out->place);
    exact_terms_begin(&t->momentum, out->momentum);
}

static void end(motion_terms *t)
{
    exact_terms_end(&t->kinetic);
    exact_terms_end(&t->weight);
    pairs_terms_end(&t->place);
    pairs_terms_end(&t->momentum);
}

INLINE void measure_vectors(const motion_pass *p, dem_index first, dem_index last, motion_terms *out)
{
    const bool heavy = p->gravity.x != 0.0 || p->gravity.y != 0.0;
    const pairs g = pairs_both(p->gravity.x, p->gravity.y);
    for (dem_index i = first; i < last; i += LAYOUT_LANES) {
        const pairs x = pairs_load(p->x + 2 * i), v = pairs_load(p->v + 2 * i), mass = pairs_spread(p->mass + i);
        const lanes m = numbers(mass);
        pairs_terms_add(&out->place, pairs_mul(mass, x));
        pairs_terms_add(&out->momentum, pairs_mul(mass, v));
        lanes_terms_add(&out->kinetic, lanes_mul(lanes_mul(lanes_all(0.5), m), pairs_dot(v, v)));
        if (heavy) lanes_terms_add(&out->weight, lanes_mul(lanes_mul(lanes_all(-1.0), m), pairs_dot(g, x)));
    }
}

static void measure_node(const motion_pass *p, dem_index i, motion_sums *out)
{
    const vec2 x = vec2_at(p->x, i), v = vec2_at(p->v, i);
    const double m = p->mass[i];
    exact_sum_add(&out->place[0], m * x.x);
    exact_sum_add(&out->place[1], m * x.y);
    exact_sum_add(&out->momentum[0], m * v.x);
    exact_sum_add(&out->momentum[1], m * v.y);
    exact_sum_add(&out->kinetic, 0.5 * m * vec2_dot(v, v));
    exact_sum_add(&out->weight, -m * vec2_dot(p->gravity, x));
}

void MOTION_PASS(const motion_pass *p, dem_index first, dem_index last, motion_sums *out)
{
    const dem_index whole = whole_of(first, last);
    motion_terms terms;
    begin(&terms, out);
    if (whole > first) measure_vectors(p, first, whole, &terms);
    end(&terms);
    for (dem_index i = whole; i < last; i++) measure_node(p, i, out);
}

void MOTION_PASS_SPIN(const motion_pass *p, dem_index first, dem_index last, const vec2 mean[2], motion_sums *out)
{
    const dem_index whole = whole_of(first, last);
    const pairs centre = pairs_both(mean[0].x, mean[0].y), velocity = pairs_both(mean[1].x, mean[1].y);
    exact_terms spin;
    exact_terms_begin(&spin, &out->spin);
    for (dem_index i = first; i < whole; i += LAYOUT_LANES) {
        const pairs r = pairs_sub(pairs_load(p->x + 2 * i), centre), u = pairs_sub(pairs_load(p->v + 2 * i), velocity);
        lanes_terms_add(&spin, lanes_mul(numbers(pairs_spread(p->mass + i)), pairs_cross(r, u)));
    }
    exact_terms_end(&spin);
    for (dem_index i = whole; i < last; i++) {
        const vec2 r = vec2_sub(vec2_at(p->x, i), mean[0]), u = vec2_sub(vec2_at(p->v, i), mean[1]);
        exact_sum_add(&out->spin, p->mass[i] * vec2_cross(r, u));
    }
}
