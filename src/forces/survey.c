/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs and triangles are measured chunk by chunk of the layout's blocks, nodes run by run of the nodes of a body
 * (elastic/energy_pass.c, elastic/motion_pass.c); chunks and runs are joined in their order afterwards. One by one come
 * nodes behind the last block, nodes with elements that are not whole, triangles on which the guard acts, and springs
 * of rigid bodies, which no layout has. The pass finds how large the extreme strains are; which springs have them is
 * found by a second look at the few blocks where they occur. An element belongs to its node of the lowest number, from
 * where the area of a triangle is seen, and is measured by the rank that owns that one: neither depends on the layout,
 * whose order is another one on each rank. */
#include "forces/survey.h"

#include <stdlib.h>
#include <string.h>

#include "base/aligned.h"
#include "base/grow.h"
#include "base/reduce.h"
#include "base/status.h"
#include "elastic/lane_slots.h"
#include "elastic/rigid_nodes.h"

/* ---- set-up ---- */

#ifndef DEM_X86_KERNELS
#define energy_pass_avx2        energy_pass_portable
#define energy_pass_avx512      energy_pass_portable
#define motion_pass_avx2        motion_pass_portable
#define motion_pass_avx512      motion_pass_portable
#define motion_pass_spin_avx2   motion_pass_spin_portable
#define motion_pass_spin_avx512 motion_pass_spin_portable
#endif

typedef struct survey_row {
    energy_pass_function *energies;
    motion_pass_function *motions;
    motion_spin_function *spins;
} survey_row;

static const survey_row rows[] = {
    [DEM_KERNEL_PORTABLE] = {energy_pass_portable, motion_pass_portable, motion_pass_spin_portable},
    [DEM_KERNEL_AVX2] = {energy_pass_avx2, motion_pass_avx2, motion_pass_spin_avx2},
    [DEM_KERNEL_AVX512] = {energy_pass_avx512, motion_pass_avx512, motion_pass_spin_avx512},
};

enum { RUN_NODES = SURVEY_CHUNK * LAYOUT_LANES };

/* Cuts the own nodes into runs: first counts them, then lists them. */
static dem_index cut(const dem_model *m, survey_run *runs)
{
    const dem_lattice *l = &m->lattice;
    dem_index n = 0;
    for (dem_index first = 0, last = 0, end; first < l->n_nodes; first = last) {
        const bool counts = domain_run(m->domain, first, l->n_nodes, &end);
        while (last < end && l->body[last] == l->body[first] && last - first < RUN_NODES) last++;
        if (!counts) continue;
        if (runs != NULL) runs[n] = (survey_run){first, last, l->body[first]};
        n++;
    }
    return n;
}

/* The masses of bodies never change. */
static void weigh(survey *s)
{
    const dem_lattice *l = &s->model->lattice;
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (domain_owns(s->model->domain, i)) exact_sum_add(&s->bodies[l->body[i]].kinetic, l->mass[i]);
    for (dem_index b = 0; b < s->model->n_bodies; b++) s->mass[b] = reduce_sum(s->model->ranks, &s->bodies[b].kinetic);
}

static dem_status find_places(survey *s)
{
    const layout *l = &s->model->layout;
    const size_t n = (size_t)l->n_nodes;
    if (l->order == NULL) return DEM_OK;
    s->place = malloc((n + 1) * sizeof *s->place);
    s->packed = aligned_reals(2 * n);
    CHECK(s->place && s->packed, DEM_ERROR_MEMORY, "out of memory for the energies of %zu nodes", n);
    for (dem_index q = 0; q < l->n_nodes; q++) s->place[l->order[q]] = (int32_t)q;
    return DEM_OK;
}

static dem_status allocate(survey *s)
{
    const size_t blocks = (size_t)s->model->layout.n_blocks + 1, bodies = (size_t)s->model->n_bodies + 1;
    const size_t groups = (size_t)s->n_groups + 1, runs = (size_t)s->n_runs + 1;
    s->skipped = calloc(blocks, sizeof *s->skipped);
    s->folded = calloc(blocks, sizeof *s->folded);
    s->least = malloc(groups * sizeof *s->least);
    s->largest = malloc(groups * sizeof *s->largest);
    s->chunks = calloc((size_t)s->n_chunks + 1, sizeof *s->chunks);
    s->runs = malloc(runs * sizeof *s->runs);
    s->moving = calloc(runs, sizeof *s->moving);
    s->bodies = calloc(bodies, sizeof *s->bodies);
    s->mass = calloc(bodies, sizeof *s->mass);
    CHECK(s->skipped && s->folded && s->least && s->largest && s->chunks && s->runs && s->moving && s->bodies &&
              s->mass,
          DEM_ERROR_MEMORY, "out of memory for the energies of %lld nodes", (long long)s->model->lattice.n_nodes);
    return DEM_OK;
}

/* Whether a spring or a triangle of so many nodes is measured here. */
static bool is_own(const survey *s, const dem_index *nodes, int n)
{
    return domain_owns(s->model->domain, domain_lowest(nodes, n));
}

/* What the layout evaluates at a node: how much of it is measured here, and how much elsewhere. */
typedef struct node_share {
    dem_index own, others;
} node_share;

static void count_in(node_share *share, bool is_here)
{
    share->own += is_here;
    share->others += !is_here;
}

/* A pass measures springs and couplings at their lowest node by place, and triangles at that by number. */
static node_share share_of(const survey *s, dem_index i)
{
    const springs *bonds = &s->model->springs;
    const couplings *c = &s->model->couplings;
    node_share share = {0, 0};
    count_in(&share, domain_owns(s->model->domain, i));
    for (dem_index p = bonds->row[i]; p < bonds->row[i + 1]; p++) {
        const dem_index ends[2] = {i, bonds->neighbour[p]};
        if (lane_slots_place(s->place, ends[1]) > lane_slots_place(s->place, i)) count_in(&share, is_own(s, ends, 2));
    }
    for (dem_index p = c->row[i]; p < c->row[i + 1]; p++)
        if (lane_slots_is_lowest(c, s->place, p, i)) count_in(&share, is_own(s, c->list[c->slot[p] / 3].corner, 3));
    return share;
}

/* Where the layout has the order of numbers it evaluates all at the node whose owner measures it: then no node has
 * both. */
static dem_status find_others(survey *s)
{
    const layout *l = &s->model->layout;
    dem_index capacity = 0;
    if (s->model->domain == NULL) return DEM_OK;
    s->others = calloc((size_t)l->n_blocks + 1, sizeof *s->others);
    CHECK_MEMORY(s->others);
    for (dem_index q = 0; q < LAYOUT_LANES * l->n_blocks; q++) {
        const dem_index i = layout_node(l, q);
        const node_share share = share_of(s, i);
        if (share.others > 0) s->others[q / LAYOUT_LANES] |= (uint8_t)(1u << q % LAYOUT_LANES);
        if (share.others == 0 || share.own == 0) continue;
        CHECK(grow_array((void **)&s->shared, &capacity, s->n_shared + 1, sizeof *s->shared), DEM_ERROR_MEMORY,
              "out of memory for the energies of %lld nodes", (long long)l->n_nodes);
        s->shared[s->n_shared++] = i;
    }
    return DEM_OK;
}

static dem_status set_up(survey *s)
{
    const dem_index n_blocks = s->model->layout.n_blocks;
    s->n_groups = (n_blocks + ENERGY_PASS_GROUP - 1) / ENERGY_PASS_GROUP;
    s->n_chunks = (n_blocks + SURVEY_CHUNK - 1) / SURVEY_CHUNK;
    s->n_runs = cut(s->model, NULL);
    TRY(allocate(s));
    (void)cut(s->model, s->runs);
    weigh(s);
    TRY(find_places(s));
    return find_others(s);
}

dem_status survey_create(survey *out, const kernel *k)
{
    const survey_row *row = &rows[k->kind];
    survey s = {.model = k->model,
                .team = k->team,
                .n_shares = team_shares(k->team, k->model->lattice.n_nodes),
                .measure_energies = row->energies,
                .measure_motions = row->motions,
                .measure_spins = row->spins};
    const dem_status status = set_up(&s);
    if (status == DEM_OK)
        *out = s;
    else
        survey_destroy(&s);
    return status;
}

void survey_destroy(survey *s)
{
    free(s->place);
    free(s->packed);
    free(s->others);
    free(s->shared);
    free(s->skipped);
    free(s->folded);
    free(s->least);
    free(s->largest);
    free(s->chunks);
    free(s->runs);
    free(s->moving);
    free(s->bodies);
    free(s->mass);
    *s = (survey){0};
}

/* ---- extreme strains ---- */

/* The ends of a spring, the lower number first. */
typedef struct spring_ends {
    dem_index low, high;
} spring_ends;

static spring_ends ends_of(const dem_lattice *l, dem_index spring)
{
    const dem_index *ends = &l->ends[2 * spring];
    return ends[0] < ends[1] ? (spring_ends){ends[0], ends[1]} : (spring_ends){ends[1], ends[0]};
}

/* Of springs with equal strains the first one by its ends is named: this does not depend on the order of springs. */
static bool ends_before(spring_ends a, spring_ends b)
{
    return a.low != b.low ? a.low < b.low : a.high < b.high;
}

static bool is_before(const dem_lattice *l, dem_index spring, dem_index other)
{
    return ends_before(ends_of(l, spring), ends_of(l, other));
}

/* The extremes so far, and their springs; -1: none. */
typedef struct extreme_strains {
    double min, max;
    dem_index least, largest;
} extreme_strains;

/* Keeps spring k if its strain is beyond the extremes so far, or equal to one of them and first by its ends. */
static void measure_spring(const dem_lattice *l, dem_index k, double strain, extreme_strains *e)
{
    if (e->least < 0 || strain < e->min || (strain == e->min && is_before(l, k, e->least))) {
        e->min = strain;
        e->least = k;
    }
    if (e->largest < 0 || strain > e->max || (strain == e->max && is_before(l, k, e->largest))) {
        e->max = strain;
        e->largest = k;
    }
}

/* ---- one by one ---- */

/* A survey under way, and what is measured one by one. */
typedef struct taking {
    survey *s;
    const forces *f;
    const double *x, *v;
    springs_integrity springs;
    triangles_integrity triangles;
    exact_sum kinetic, weight, elastic, area, guard;
    extreme_strains extremes;
    dem_strain strain;
} taking;

static dem_index place_of(const taking *t, dem_index node)
{
    return lane_slots_place(t->s->place, node);
}

static void add_spring(taking *t, dem_index k, double strain)
{
    const dem_lattice *l = &t->s->model->lattice;
    if (springs_is_broken(t->springs, k)) return;
    const double left = springs_left(t->springs, k, strain);
    measure_spring(l, k, strain, &t->extremes);
    exact_sum_add(&t->elastic, left * springs_energy_of(l->stiffness[k], l->rest_length[k], strain));
}

/* Those to nodes at higher places. */
static void add_springs(taking *t, dem_index i)
{
    const springs *s = &t->s->model->springs;
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const dem_index ends[2] = {i, s->neighbour[p]};
        if (place_of(t, ends[1]) > place_of(t, i) && is_own(t->s, ends, 2))
            add_spring(t, s->spring[p], springs_strain(s, i, p, t->x));
    }
}

/* Of rigid bodies. */
static void add_rigid_springs(taking *t)
{
    const dem_lattice *l = &t->s->model->lattice;
    if (t->s->model->rigid.n == 0) return;
    for (dem_index k = 0; k < l->n_springs; k++)
        if (rigid_nodes_have(l, l->ends[2 * k]) && is_own(t->s, &l->ends[2 * k], 2))
            add_spring(t, k, springs_strain_of(l, k, t->x));
}

static void add_couplings(taking *t, dem_index i)
{
    const couplings *c = &t->s->model->couplings;
    for (dem_index p = c->row[i]; p < c->row[i + 1]; p++) {
        const dem_index k = c->slot[p] / 3;
        if (!lane_slots_is_lowest(c, t->s->place, p, i) || !is_own(t->s, c->list[k].corner, 3)) continue;
        if (couplings_broken(c, t->triangles, k)) continue;
        const coupled_edges e = couplings_edges(&c->list[k], t->x);
        for (int q = 0; q < 3; q++)
            exact_sum_add(&t->elastic, couplings_left(c, t->triangles, k) * couplings_energy_term(&c->list[k], &e, q));
    }
}

/* Of the triangles of which own node i is the lowest corner: what a pass measures, if it has not, and what the guard
 * does to them. */
static void add_triangles(taking *t, dem_index i, bool passed)
{
    const triangles *all = &t->s->model->triangles;
    for (dem_index p = all->row[i]; p < all->row[i + 1]; p++) {
        if (all->next[p] < i || all->last[p] < i) continue;
        if (triangles_broken(all, t->triangles, p)) continue;
        const triangles_energies e = triangles_energies_at(all, t->triangles, i, p, t->x);
        if (!passed) exact_sum_add(&t->area, e.area);
        if (!passed && e.ratio < t->strain.area_min) t->strain.area_min = e.ratio;
        if (e.ratio >= TRIANGLES_GUARD_ONSET) continue;
        exact_sum_add(&t->guard, e.guard);
        t->strain.guarded += triangles_guard(all, p) > 0.0;
        t->strain.inverted += e.ratio <= 0.0;
    }
}

static void add_node(taking *t, dem_index i)
{
    add_springs(t, i);
    if (t->s->model->couplings.n > 0) add_couplings(t, i);
    if (domain_owns(t->s->model->domain, i)) add_triangles(t, i, false);
}

/* Behind the blocks, beside elements that are not whole, at nodes of which other ranks measure a part, and where a pass
 * has found folded triangles. */
static void add_rest(taking *t)
{
    const layout *l = &t->s->model->layout;
    const element_state *e = t->f->elements;
    for (dem_index block = 0; block < l->n_blocks; block++)
        for (int q = 0; q < LAYOUT_LANES && t->s->folded[block] != 0; q++)
            if (t->s->folded[block] >> q & 1) add_triangles(t, layout_node(l, LAYOUT_LANES * block + q), true);
    for (dem_index q = LAYOUT_LANES * l->n_blocks; q < l->n_nodes; q++) add_node(t, layout_node(l, q));
    for (dem_index d = 0; e != NULL && d < e->n_damaged; d++)
        if (place_of(t, e->damaged[d]) < LAYOUT_LANES * l->n_blocks) add_node(t, e->damaged[d]);
    for (dem_index k = 0; k < t->s->n_shared; k++)
        if (element_state_at(e, t->s->shared[k]) == NULL) add_node(t, t->s->shared[k]);
    add_rigid_springs(t);
}

/* Triangles that neither area term nor guard acts on are in no layout: then all are looked at by the lattice's list. */
static void measure_idle_triangles(taking *t)
{
    const dem_lattice *l = &t->s->model->lattice;
    if (t->s->model->triangles.row[l->n_nodes] == 3 * l->n_triangles) return;
    t->strain = (dem_strain){.area_min = 1.0};
    for (dem_index k = 0; k < l->n_triangles; k++) {
        if (t->f->elements != NULL && t->f->elements->triangle[k]) continue;
        const dem_index *c = &l->triangles[3 * k];
        if (!is_own(t->s, c, 3)) continue;
        /* From the lattice's rest positions, as triangles_compile() has it: the ratio is exactly 1 at rest. */
        const double rest_area = vec2_area_of(l->x, c);
        const double ratio = vec2_area_of(t->x, c) / rest_area;
        if (ratio < t->strain.area_min) t->strain.area_min = ratio;
        t->strain.guarded += ratio < TRIANGLES_GUARD_ONSET && l->guard != NULL && l->guard[k] > 0.0;
        t->strain.inverted += ratio <= 0.0;
    }
}

/* ---- passes ---- */

static void skip_damaged(taking *t)
{
    const element_state *e = t->f->elements;
    const dem_index end = LAYOUT_LANES * t->s->model->layout.n_blocks;
    if (e == NULL || e->n_damaged == 0) return;
    for (dem_index b = 0; b < t->s->model->layout.n_blocks; b++)
        t->s->skipped[b] = t->s->others != NULL ? t->s->others[b] : 0;
    for (dem_index d = 0; d < e->n_damaged; d++) {
        const dem_index q = place_of(t, e->damaged[d]);
        if (q < end) t->s->skipped[q / LAYOUT_LANES] |= (uint8_t)(1u << q % LAYOUT_LANES);
    }
}

static void pack_share(const void *context, int share, int thread)
{
    const taking *t = context;
    const survey *s = t->s;
    const layout *l = &s->model->layout;
    const dem_index end = team_share(l->n_nodes, s->n_shares, share + 1);
    (void)thread;
    for (dem_index q = team_share(l->n_nodes, s->n_shares, share); q < end; q++)
        vec2_put(s->packed, q, vec2_at(t->x, l->order[q]));
}

static void measure_chunk(const survey *s, const energy_pass *p, dem_index first, dem_index last, energy_sums *out)
{
    exact_sum_clear(&out->elastic);
    exact_sum_clear(&out->area);
    s->measure_energies(p, first, last, out);
}

static void clear_motions(motion_sums *m)
{
    exact_sum_clear(&m->kinetic);
    exact_sum_clear(&m->weight);
    for (int c = 0; c < 2; c++) {
        exact_sum_clear(&m->place[c]);
        exact_sum_clear(&m->momentum[c]);
    }
}

static void measure_run(const survey *s, const motion_pass *p, dem_index k)
{
    clear_motions(&s->moving[k]);
    s->measure_motions(p, s->runs[k].first, s->runs[k].last, &s->moving[k]);
}

/* Chunks and runs go side by side, as what they read is mostly the same. */
static void measure_share(const void *context, int share, int thread)
{
    const taking *t = context;
    const survey *s = t->s;
    const dem_index n_blocks = s->model->layout.n_blocks, n = s->n_chunks > s->n_runs ? s->n_chunks : s->n_runs;
    const bool damaged = t->f->elements != NULL && t->f->elements->n_damaged > 0;
    const energy_pass energies = {.layout = &s->model->layout,
                                  .x = s->packed != NULL ? s->packed : t->x,
                                  .skipped = damaged ? s->skipped : s->others,
                                  .folded = s->folded,
                                  .least = s->least,
                                  .largest = s->largest};
    const motion_pass motions = {s->model->lattice.mass, t->x, t->v, {t->f->gravity[0], t->f->gravity[1]}};
    const dem_index end = team_share(n, s->n_shares, share + 1);
    (void)thread;
    for (dem_index k = team_share(n, s->n_shares, share); k < end; k++) {
        const dem_index first = SURVEY_CHUNK * k,
                        last = first + SURVEY_CHUNK < n_blocks ? first + SURVEY_CHUNK : n_blocks;
        if (k < s->n_chunks) measure_chunk(s, &energies, first, last, &s->chunks[k]);
        if (k < s->n_runs) measure_run(s, &motions, k);
    }
}

/* Sums of bodies. */
static void join_runs(survey *s)
{
    for (dem_index b = 0; b < s->model->n_bodies; b++) clear_motions(&s->bodies[b]);
    for (dem_index k = 0; k < s->n_runs; k++) {
        motion_sums *body = &s->bodies[s->runs[k].body], *own = &s->moving[k];
        exact_sum_join(&body->kinetic, &own->kinetic);
        exact_sum_join(&body->weight, &own->weight);
        for (int c = 0; c < 2; c++) {
            exact_sum_join(&body->place[c], &own->place[c]);
            exact_sum_join(&body->momentum[c], &own->momentum[c]);
        }
    }
}

/* Energies of all bodies. */
static void join_bodies(taking *t)
{
    const survey *s = t->s;
    for (dem_index b = 0; b < s->model->n_bodies; b++) {
        exact_sum_join(&t->kinetic, &s->bodies[b].kinetic);
        exact_sum_join(&t->weight, &s->bodies[b].weight);
    }
}

static void join_chunks(taking *t)
{
    for (dem_index k = 0; k < t->s->n_chunks; k++) {
        energy_sums *own = &t->s->chunks[k];
        exact_sum_join(&t->elastic, &own->elastic);
        exact_sum_join(&t->area, &own->area);
        if (own->area_min < t->strain.area_min) t->strain.area_min = own->area_min;
    }
}

/* The springs of a group of blocks that are whole. */
static void look_at_group(taking *t, dem_index group)
{
    const layout *l = &t->s->model->layout;
    const springs *s = &t->s->model->springs;
    const dem_index first = LAYOUT_LANES * ENERGY_PASS_GROUP * group, end = LAYOUT_LANES * l->n_blocks;
    for (dem_index q = first; q < end && q < first + LAYOUT_LANES * ENERGY_PASS_GROUP; q++) {
        const dem_index i = layout_node(l, q);
        const bool is_shared = t->s->others != NULL && t->s->others[q / LAYOUT_LANES] >> q % LAYOUT_LANES & 1;
        if (is_shared || element_state_at(t->f->elements, i) != NULL) continue;
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++)
            if (place_of(t, s->neighbour[p]) > q)
                measure_spring(&t->s->model->lattice, s->spring[p], springs_strain(s, i, p, t->x), &t->extremes);
    }
}

/* Looks at the groups in which the extremes of all groups occur. */
static void find_extremes(taking *t)
{
    const survey *s = t->s;
    double least = (double)INFINITY, largest = -(double)INFINITY;
    for (dem_index g = 0; g < s->n_groups; g++) {
        if (s->least[g] < least) least = s->least[g];
        if (s->largest[g] > largest) largest = s->largest[g];
    }
    for (dem_index g = 0; g < s->n_groups && least <= largest; g++)
        if (s->least[g] == least || s->largest[g] == largest) look_at_group(t, g);
}

/* A strain that may be an extreme, and its spring in the whole lattice; -1: none. */
typedef struct named_strain {
    double strain;
    spring_ends ends;
    dem_index spring;
} named_strain;

/* What ranks tell each other of strains. */
typedef struct strain_packet {
    named_strain least, largest;
    double area_min;
    dem_index guarded, inverted;
} strain_packet;

static void keep(named_strain *own, const named_strain *theirs, bool beyond)
{
    const bool is_first = theirs->strain == own->strain && ends_before(theirs->ends, own->ends);
    if (theirs->spring >= 0 && (own->spring < 0 || beyond || is_first)) *own = *theirs;
}

static void join_strains(void *packet, const void *other)
{
    strain_packet *own = packet;
    const strain_packet *theirs = other;
    keep(&own->least, &theirs->least, theirs->least.strain < own->least.strain);
    keep(&own->largest, &theirs->largest, theirs->largest.strain > own->largest.strain);
    if (theirs->area_min < own->area_min) own->area_min = theirs->area_min;
    own->guarded += theirs->guarded;
    own->inverted += theirs->inverted;
}

static named_strain name_strain(const dem_model *m, double strain, dem_index spring)
{
    const domain *d = m->domain;
    if (spring < 0) return (named_strain){.strain = strain, .spring = -1};
    const spring_ends ends = ends_of(&m->lattice, spring);
    return (named_strain){strain, {domain_number(d, ends.low), domain_number(d, ends.high)}, domain_spring(d, spring)};
}

static dem_strain reduce(const taking *t)
{
    const dem_model *m = t->s->model;
    const extreme_strains *e = &t->extremes;
    strain_packet all = {.least = name_strain(m, e->min, e->least),
                         .largest = name_strain(m, e->max, e->largest),
                         .area_min = t->strain.area_min,
                         .guarded = t->strain.guarded,
                         .inverted = t->strain.inverted};
    m->ranks->reduce(m->ranks->self, &all, sizeof all, join_strains);
    return (dem_strain){.min = all.least.strain,
                        .max = all.largest.strain,
                        .spring_min = all.least.spring,
                        .spring_max = all.largest.spring,
                        .area_min = all.area_min,
                        .guarded = all.guarded,
                        .inverted = all.inverted};
}

static survey_energies sum_energies(const taking *t)
{
    const exact_sum *const sums[] = {&t->kinetic, &t->elastic, &t->area, &t->guard, &t->weight};
    double values[5];
    reduce_sums(t->s->model->ranks, sums, 5, values);
    return (survey_energies){values[0], values[1], values[2], values[3], values[4]};
}

void survey_take(survey *s, const forces *f, const double *x, const double *v)
{
    taking t = {.s = s,
                .f = f,
                .x = x,
                .v = v,
                .springs = element_state_springs(f->elements),
                .triangles = element_state_triangles(f->elements),
                .extremes = {.least = -1, .largest = -1},
                .strain = {.area_min = 1.0}};
    skip_damaged(&t);
    if (s->packed != NULL) team_run(s->team, s->n_shares, pack_share, &t);
    team_run(s->team, s->n_shares, measure_share, &t);
    join_chunks(&t);
    join_runs(s);
    join_bodies(&t);
    find_extremes(&t);
    add_rest(&t);
    measure_idle_triangles(&t);
    s->strain = reduce(&t);
    s->energies = sum_energies(&t);
}

/* ---- motion of bodies ---- */

/* A pass over the nodes of bodies. */
typedef struct body_pass {
    const survey *s;
    motion_pass nodes;
    const dem_body_motion *motion; /* [n_bodies] about which angular momenta are taken */
} body_pass;

static void motions_share(const void *context, int share, int thread)
{
    const body_pass *p = context;
    const survey *s = p->s;
    const dem_index end = team_share(s->n_runs, s->n_shares, share + 1);
    (void)thread;
    for (dem_index k = team_share(s->n_runs, s->n_shares, share); k < end; k++) measure_run(s, &p->nodes, k);
}

void survey_take_motions(survey *s, const double *x, const double *v)
{
    const body_pass p = {.s = s, .nodes = {.mass = s->model->lattice.mass, .x = x, .v = v}};
    team_run(s->team, s->n_shares, motions_share, &p);
    join_runs(s);
}

/* Centre of mass of a body and its velocity. */
static void find_means(const survey *s, dem_index body, dem_body_motion *motion)
{
    const motion_sums *m = &s->bodies[body];
    const exact_sum *const sums[] = {&m->place[0], &m->place[1], &m->momentum[0], &m->momentum[1]};
    double values[4];
    reduce_sums(s->model->ranks, sums, 4, values);
    vec2_put(motion->centre, 0, vec2_scale(1.0 / s->mass[body], (vec2){values[0], values[1]}));
    vec2_put(motion->velocity, 0, vec2_scale(1.0 / s->mass[body], (vec2){values[2], values[3]}));
}

static void spin_share(const void *context, int share, int thread)
{
    const body_pass *p = context;
    const survey *s = p->s;
    const dem_index end = team_share(s->n_runs, s->n_shares, share + 1);
    (void)thread;
    for (dem_index k = team_share(s->n_runs, s->n_shares, share); k < end; k++) {
        const dem_body_motion *m = &p->motion[s->runs[k].body];
        const vec2 mean[2] = {vec2_at(m->centre, 0), vec2_at(m->velocity, 0)};
        exact_sum_clear(&s->moving[k].spin);
        s->measure_spins(&p->nodes, s->runs[k].first, s->runs[k].last, mean, &s->moving[k]);
    }
}

/* Centre of mass and its velocity come first, since the angular momentum is taken about them. */
void survey_bodies(survey *s, const double *x, const double *v, dem_body_motion *motion)
{
    const body_pass p = {s, {.mass = s->model->lattice.mass, .x = x, .v = v}, motion};
    for (dem_index b = 0; b < s->model->n_bodies; b++) {
        motion[b] = (dem_body_motion){.mass = s->mass[b]};
        find_means(s, b, &motion[b]);
    }
    team_run(s->team, s->n_shares, spin_share, &p);
    for (dem_index b = 0; b < s->model->n_bodies; b++) exact_sum_clear(&s->bodies[b].spin);
    for (dem_index k = 0; k < s->n_runs; k++) exact_sum_join(&s->bodies[s->runs[k].body].spin, &s->moving[k].spin);
    for (dem_index b = 0; b < s->model->n_bodies; b++)
        motion[b].angular_momentum[2] = reduce_sum(s->model->ranks, &s->bodies[b].spin);
}

void survey_inertia(survey *s, const double *x, const dem_body_motion *motion, double *inertia)
{
    const double *mass = s->model->lattice.mass;
    double terms[RUN_NODES];
    for (dem_index b = 0; b < s->model->n_bodies; b++) exact_sum_clear(&s->bodies[b].spin);
    for (const survey_run *r = s->runs; r < s->runs + s->n_runs; r++) {
        const vec2 centre = vec2_at(motion[r->body].centre, 0);
        for (dem_index i = r->first; i < r->last; i++) {
            const vec2 arm = vec2_sub(vec2_at(x, i), centre);
            terms[i - r->first] = mass[i] * vec2_dot(arm, arm);
        }
        exact_sum_add_array(&s->bodies[r->body].spin, terms, r->last - r->first);
    }
    for (dem_index b = 0; b < s->model->n_bodies; b++) inertia[b] = reduce_sum(s->model->ranks, &s->bodies[b].spin);
}
