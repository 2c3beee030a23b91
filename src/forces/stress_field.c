/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs and coupled triangles first, then nodes and blocks that need them (model/stress_pass.c). Then come one by one
 * nodes that a pass over blocks does not have or on which the guard acts, and nodes beside elements that are not whole,
 * whose stress is that of model/node_stress.c. */
#include "forces/stress_field.h"

#include <stdlib.h>

#include "base/aligned.h"
#include "model/node_stress.h"

#ifndef DEM_X86_KERNELS
#define stress_pass_springs_avx2     stress_pass_springs_portable
#define stress_pass_springs_avx512   stress_pass_springs_portable
#define stress_pass_nodes_avx2       stress_pass_nodes_portable
#define stress_pass_nodes_avx512     stress_pass_nodes_portable
#define stress_pass_areas_avx2       stress_pass_areas_portable
#define stress_pass_areas_avx512     stress_pass_areas_portable
#define stress_pass_couplings_avx2   stress_pass_couplings_portable
#define stress_pass_couplings_avx512 stress_pass_couplings_portable
#define stress_pass_corners_avx2     stress_pass_corners_portable
#define stress_pass_corners_avx512   stress_pass_corners_portable
#endif

typedef struct stress_field_row {
    stress_pass_function *springs, *nodes, *areas, *couplings, *corners;
} stress_field_row;

static const stress_field_row rows[] = {
    [DEM_KERNEL_PORTABLE] = {stress_pass_springs_portable, stress_pass_nodes_portable, stress_pass_areas_portable,
                             stress_pass_couplings_portable, stress_pass_corners_portable},
    [DEM_KERNEL_AVX2] = {stress_pass_springs_avx2, stress_pass_nodes_avx2, stress_pass_areas_avx2,
                         stress_pass_couplings_avx2, stress_pass_corners_avx2},
    [DEM_KERNEL_AVX512] = {stress_pass_springs_avx512, stress_pass_nodes_avx512, stress_pass_areas_avx512,
                           stress_pass_couplings_avx512, stress_pass_corners_avx512},
};

void stress_field_create(stress_field *out, const kernel *k)
{
    const stress_field_row *row = &rows[k->kind];
    *out = (stress_field){.model = k->model,
                          .springs = row->springs,
                          .nodes = row->nodes,
                          .areas = row->areas,
                          .couplings = row->couplings,
                          .corners = row->corners,
                          .team = k->team,
                          .n_shares = team_shares(k->team, k->model->lattice.n_nodes)};
}

void stress_field_destroy(stress_field *s)
{
    free(s->virial);
    free(s->coupled);
    free(s->guarded);
    *s = (stress_field){0};
}

/* Only who asks for stresses of all nodes needs it. */
static bool allocate(stress_field *s)
{
    const dem_model *m = s->model;
    if (s->virial == NULL) s->virial = aligned_reals(4 * (size_t)m->lattice.n_springs);
    if (s->coupled == NULL) s->coupled = aligned_zeros(4 * (size_t)m->couplings.n);
    if (s->guarded == NULL) s->guarded = calloc((size_t)m->layout.n_blocks + 1, sizeof *s->guarded);
    return s->virial != NULL && s->coupled != NULL && s->guarded != NULL;
}

/* Blocks have the nodes' own numbers only where nothing is renumbered. */
static dem_index blocks_of(const stress_field *s)
{
    const layout *l = &s->model->layout;
    return l->order == NULL && l->corners.entries.n > 0 ? l->n_blocks : 0;
}

/* Work of the field on a state. */
typedef struct taking {
    const stress_field *s;
    const element_state *elements;
    stress_pass pass;
    bool areas; /* whether triangles add to stresses */
} taking;

/* The guard's onset is rounded, and so are areas. */
static bool may_add_areas(const stress_field *s, double area_min)
{
    return s->model->layout.stiff || !(area_min > TRIANGLES_GUARD_ONSET * (1.0 + 1e-9));
}

/* What area terms and the guard make of the stress of a node, as stress_of_node() adds it up. */
static void add_areas(const taking *t, dem_index i)
{
    const dem_model *m = t->s->model;
    double spread = 0.0;
    for (dem_index p = m->triangles.row[i]; p < m->triangles.row[i + 1]; p++)
        spread += triangles_virial(&m->triangles, TRIANGLES_WHOLE, i, p, t->pass.x) / (3.0 * m->stress.rows->volume[i]);
    t->pass.stress[3 * i] += spread;
    t->pass.stress[3 * i + 1] += spread;
}

static void springs_share(const void *context, int share, int thread)
{
    const taking *t = context;
    const dem_index n = t->s->model->lattice.n_springs, m = t->s->model->couplings.n;
    const int n_shares = t->s->n_shares;
    (void)thread;
    t->s->springs(&t->pass, team_share(n, n_shares, share), team_share(n, n_shares, share + 1));
    t->s->couplings(&t->pass, team_share(m, n_shares, share), team_share(m, n_shares, share + 1));
}

/* The nodes of some blocks, and the last share those behind. */
static void nodes_share(const void *context, int share, int thread)
{
    const taking *t = context;
    const stress_field *s = t->s;
    const dem_model *m = s->model;
    const dem_index n_blocks = blocks_of(s), n = m->lattice.n_nodes, groups = n / LAYOUT_LANES;
    const dem_index first = team_share(groups, s->n_shares, share);
    const dem_index last = team_share(groups, s->n_shares, share + 1);
    const dem_index end = share + 1 < s->n_shares ? LAYOUT_LANES * last : n;
    (void)thread;
    s->nodes(&t->pass, LAYOUT_LANES * first, end);
    if (first < n_blocks && t->areas) s->areas(&t->pass, first, last < n_blocks ? last : n_blocks);
    for (dem_index i = LAYOUT_LANES * first; i < end; i++) {
        const dem_index block = i / LAYOUT_LANES;
        if (block >= n_blocks || (t->areas && s->guarded[block] >> i % LAYOUT_LANES & 1)) add_areas(t, i);
    }
    if (m->couplings.n > 0) s->corners(&t->pass, LAYOUT_LANES * first, end);
    for (dem_index i = LAYOUT_LANES * first; i < end && t->elements != NULL; i++)
        if (element_state_at(t->elements, i) != NULL)
            node_stress(m, t->elements, NODE_STRESS_CARRIED, i, t->pass.x, t->pass.stress + 3 * i);
}

bool stress_field_take(stress_field *s, const element_state *elements, const double *x, double area_min, double *stress)
{
    const dem_model *m = s->model;
    const bool has_memory = allocate(s);
    const taking t = {s,
                      elements,
                      {&m->lattice, &m->stress, &m->layout, x, s->virial, s->coupled, stress, s->guarded},
                      may_add_areas(s, area_min)};
    if (has_memory) {
        team_run(s->team, s->n_shares, springs_share, &t);
        team_run(s->team, s->n_shares, nodes_share, &t);
    }
    for (dem_index i = 0; i < m->lattice.n_nodes && !has_memory; i++)
        node_stress(m, elements, NODE_STRESS_CARRIED, i, x, stress + 3 * i);
    return has_memory;
}

void stress_field_strains(const stress_field *s, const element_state *elements, double *strain)
{
    const springs_integrity q = element_state_springs(elements);
    for (dem_index k = 0; k < s->model->lattice.n_springs; k++) strain[k] = s->virial[4 * k + 3];
    for (dem_index k = 0; k < s->model->lattice.n_springs && q.pushed != NULL; k++)
        if (springs_is_broken(q, k)) strain[k] = 0.0;
}
