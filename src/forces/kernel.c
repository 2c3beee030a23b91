/* SPDX-License-Identifier: BSD-3-Clause */
/* Accelerations of all nodes, equations (3) and (4), by a sweep over the blocks of the layout, shared among threads
 * (docs/algorithms.md, How forces are evaluated). What is not in blocks, and what is rare, is evaluated row by row
 * behind the sweep: nodes on which the guard acts, nodes with given forces. Where something has broken or softened the
 * sweep reads a layout of what is left (elastic/trimmed_layout.c), which kernel_follow() keeps up. The contact of
 * surfaces is added to what is there then, and last the external force. Each node's sum is that of
 * forces_own_acceleration() in the same order, so the bits depend neither on the instruction set nor on the number of
 * threads. The arithmetic of a block is in elastic/sweep_body.h, that of a row in forces.h; contact forces are added
 * elsewhere (contact/contact_forces.c). Which instruction sets there are is in kernel_functions.c. */
#include "forces/kernel.h"

#include <stdlib.h>
#include <string.h>

#include "base/aligned.h"
#include "base/grow.h"
#include "base/status.h"
#include "forces/kernel_functions.h"

enum { EIGHT = sizeof(uint64_t) };

/* ---- set-up ---- */

/* Each thread has a ring of its own, of two parts where springs are damped. If the layout has renumbered the nodes,
 * there is room for packed copies in its order; the inverse masses among them never change. */
static dem_status allocate(kernel *k)
{
    const layout *l = &k->model->layout;
    const size_t n = (size_t)l->n_nodes;
    /* Two numbers for each force; the forces of damping are behind those of the springs. */
    k->ring_size = 2 * (size_t)l->ring_length * (l->damped ? 2 : 1); /* a multiple of 16 */
    k->rings = aligned_zeros((size_t)team_threads(k->team) * k->ring_size);
    k->guarded = calloc((size_t)l->n_blocks + EIGHT, sizeof *k->guarded);
    k->sums = calloc((size_t)k->n_shares, sizeof *k->sums);
    if (l->order != NULL) k->packed = aligned_zeros(7 * n);
    CHECK(k->rings && k->guarded && k->sums && (k->packed || l->order == NULL), DEM_ERROR_MEMORY,
          "out of memory for the forces of %zu nodes", n);
    for (size_t q = 0; q < n && k->packed != NULL; q++) k->packed[q] = k->model->inverse_mass[l->order[q]];
    return border_blocks_create(&k->border, k->model->domain, l->n_blocks);
}

/* Each share evaluates again what reaches into it from below. There are more shares than threads only where that is at
 * most a thirtieth. */
static int count_shares(const team *t, const layout *l)
{
    const int n = team_shares(t, l->n_nodes), threads = team_threads(t);
    const dem_index large = l->n_blocks / (30 * (l->reach + 1));
    return n <= threads || n <= large ? n : threads;
}

/* `auto` is replaced by what it stands for, so that kernel->kind says which instructions run. */
dem_status kernel_create(kernel *out, const dem_model *model, dem_kernel kind, team *t)
{
    TRY(dem_kernel_check(kind));
    if (kind == DEM_KERNEL_AUTO) kind = kernel_functions_fastest();
    const kernel_functions *of = kernel_functions_of(kind);
    kernel k = {.model = model,
                .kind = kind,
                .team = t,
                .n_shares = count_shares(t, &model->layout),
                .n_trimmed = -1,
                .sweep = of->sweep,
                .sweep_guard = of->sweep_guard,
                .sweep_strain = of->sweep_strain,
                .fold_pass = of->fold_pass,
                .ops = of->ops};
    const dem_status status = allocate(&k);
    if (status == DEM_OK)
        *out = k;
    else
        kernel_destroy(&k);
    return status;
}

void kernel_destroy(kernel *k)
{
    free(k->rings);
    free(k->guarded);
    free(k->sums);
    free(k->packed);
    border_blocks_free(&k->border);
    free(k->limit);
    free(k->strained);
    trimmed_layout_destroy(&k->trimmed);
    free(k->beside);
    *k = (kernel){0};
}

/* ---- what has broken ---- */

static trimmed_elements elements_of(const element_state *e)
{
    return (trimmed_elements){element_state_springs(e), element_state_triangles(e)};
}

static dem_status trim_all(kernel *k, const element_state *e)
{
    const dem_model *m = k->model;
    const trimmed_elements left = elements_of(e);
    trimmed_layout_destroy(&k->trimmed);
    TRY(trimmed_layout_create(&k->trimmed, &m->layout, &m->springs, &m->triangles, &m->couplings, e->tension != NULL));
    return trimmed_layout_follow(&k->trimmed, &left, e->damaged, e->n_damaged);
}

static dem_status add_beside(kernel *k, const dem_index *nodes, int n)
{
    CHECK(grow_array((void **)&k->beside, &k->beside_capacity, k->n_beside + n, sizeof *k->beside), DEM_ERROR_MEMORY,
          "out of memory for the layout of springs");
    memcpy(k->beside + k->n_beside, nodes, (size_t)n * sizeof *nodes);
    k->n_beside += n;
    return DEM_OK;
}

/* Springs that a triangle holds need not be between its corners. */
static dem_status list_beside(kernel *k, const element_state *e, dem_index element)
{
    const dem_lattice *l = e->lattice;
    const dem_index spring = element - l->n_triangles;
    if (spring >= 0) return add_beside(k, &l->ends[2 * spring], 2);
    for (dem_index p = e->row[element]; p < e->row[element + 1]; p++) TRY(add_beside(k, &l->ends[2 * e->spring[p]], 2));
    return add_beside(k, &l->triangles[3 * element], 3);
}

/* All at once, so that a block is trimmed once. */
static dem_status trim(kernel *k, const element_state *e, const dem_index *list, dem_index n)
{
    const trimmed_elements left = elements_of(e);
    k->n_beside = 0;
    for (dem_index j = 0; j < n; j++) TRY(list_beside(k, e, list[j]));
    return trimmed_layout_follow(&k->trimmed, &left, k->beside, k->n_beside);
}

void kernel_follow(kernel *k, const element_state *e, const dem_index *list, dem_index n)
{
    if (e == NULL) return;
    const bool known = list != NULL && k->n_trimmed >= 0 && k->n_trimmed + n == element_state_n_failures(e);
    const dem_status status = known ? trim(k, e, list, n) : trim_all(k, e);
    k->n_trimmed = status == DEM_OK ? element_state_n_failures(e) : -1;
    if (status != DEM_OK) trimmed_layout_destroy(&k->trimmed);
}

/* What has been trimmed may have been mended since. Then as many other elements may fail, so that their number says
 * nothing any more. */
static void forget_mended(kernel *k, const element_state *e)
{
    if (e == NULL || element_state_n_failures(e) < k->n_trimmed) k->n_trimmed = -1;
}

/* Whether the trimmed layout is that of the elements as they are: inside a step more may have failed. */
static bool is_trimmed(const kernel *k, const element_state *e)
{
    return e != NULL && element_state_n_failures(e) == k->n_trimmed;
}

bool kernel_is_trimmed(kernel *k, const element_state *e)
{
    forget_mended(k, e);
    return e == NULL || e->n_damaged == 0 || is_trimmed(k, e);
}

const layout *kernel_layout(const kernel *k, const element_state *e)
{
    return is_trimmed(k, e) ? &k->trimmed.layout : &k->model->layout;
}

/* ---- evaluation ---- */

/* A loop over nodes or blocks that is divided into shares. */
typedef struct loop {
    const kernel *kernel;
    const sweep *sweep;           /* over blocks; */
    const sweep_fused_step *step; /* to be begun; or */
    const double *from;           /* [n_nodes][2] to be put in another order */
    double *to;
} loop;

static void run(const loop *l, team_work *work)
{
    team_run(l->kernel->team, l->kernel->n_shares, work, l);
}

/* Takes an array [n][2] into the layout's order. */
static void pack_share(const void *context, int share, int thread)
{
    const loop *p = context;
    const layout *l = &p->kernel->model->layout;
    const dem_index end = team_share(l->n_nodes, p->kernel->n_shares, share + 1);
    (void)thread;
    for (dem_index q = team_share(l->n_nodes, p->kernel->n_shares, share); q < end; q++)
        vec2_put(p->to, q, vec2_at(p->from, l->order[q]));
}

static void pack(const kernel *k, const double *from, double *to)
{
    run(&(loop){.kernel = k, .from = from, .to = to}, pack_share);
}

static void unpack_share(const void *context, int share, int thread)
{
    const loop *p = context;
    const layout *l = &p->kernel->model->layout;
    const dem_index end = team_share(l->n_nodes, p->kernel->n_shares, share + 1);
    (void)thread;
    for (dem_index q = team_share(l->n_nodes, p->kernel->n_shares, share); q < end; q++)
        vec2_put(p->to, l->order[q], vec2_at(p->from, q));
}

/* Consecutive blocks. */
typedef struct stretch {
    dem_index first, last; /* `last` is behind */
} stretch;

/* Those of a share: for all shares the same number up to one. */
static stretch stretch_of(const kernel *k, int share)
{
    const dem_index n = k->model->layout.n_blocks;
    return (stretch){team_share(n, k->n_shares, share), team_share(n, k->n_shares, share + 1)};
}

/* A share without blocks leaves a sum of 0. */
static void sweep_share(const void *context, int share, int thread)
{
    const loop *p = context;
    const kernel *k = p->kernel;
    const stretch b = stretch_of(k, share);
    double *ring = k->rings + (size_t)thread * k->ring_size;
    sweep s = *p->sweep;
    s.drift_end = b.last - s.layout->ahead;
    k->sums[share] = b.first < b.last ? k->sweep(&s, b.first, b.last, ring) : 0.0;
}

/* The first block from one on of which a flag is set; the number of blocks if there is none. Most are not: they are
 * passed by eights, with zeros behind the last one. */
static dem_index next_flag(const uint8_t *flags, dem_index block, dem_index n)
{
    for (uint64_t eight = 0; block < n; block += EIGHT) {
        memcpy(&eight, flags + block, sizeof eight);
        if (eight != 0) break;
    }
    while (block < n && flags[block] == 0) block++;
    return block < n ? block : n;
}

/* Whether a node is the lowest corner of a triangle that is folded, or nearly so: areas differ by rounding from corner
 * to corner. */
static bool has_folded(const triangles *t, dem_index i, const double *x)
{
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++)
        if (t->next[p] > i && t->last[p] > i && triangles_guard(t, p) > 0.0 &&
            triangles_area(t, i, p, x) < TRIANGLES_ROUNDED * TRIANGLES_GUARD_ONSET * triangles_rest_area(t, i, p))
            return true;
    return false;
}

/* A node behind the last block may be the lowest corner of triangles that have corners in the last ones. */
static void flag_rest(const kernel *k, const double *x)
{
    const layout *l = &k->model->layout;
    for (dem_index q = LAYOUT_LANES * l->n_blocks; q < l->n_nodes && l->n_blocks > 0; q++)
        if (has_folded(&k->model->triangles, layout_node(l, q), x)) k->guarded[l->n_blocks - 1] |= 1;
}

/* From the lowest corners of triangles that are folded, or nearly so, to all nodes on which the guard acts: other
 * corners are up to `ahead` blocks behind, and where nodes are renumbered as many before.
 * \param x  in the order of the nodes */
static void find_guarded(const kernel *k, const sweep *s, const double *x)
{
    const dem_index n = s->layout->n_blocks, ahead = s->layout->ahead;
    const dem_index before = s->layout->order != NULL ? ahead : 0;
    sweep all_corners = *s;
    if (!s->looks_at_lowest || s->guarded == NULL) return;
    all_corners.looks_at_lowest = false;
    if (before > 0) flag_rest(k, x);
    for (dem_index block = 0, end = 0; block < n; block++) {
        if (block >= end) {
            const dem_index next = next_flag(k->guarded, block, n);
            if (next == n) return;
            if (next - before > block) block = next - before;
            end = next + 1;
        }
        if (k->guarded[block] != 0) end = block + ahead + 1;
        k->sweep_guard(&all_corners, block, block + 1);
    }
}

/* The sum tells whether all accelerations are finite, and bounds them: its bits are of no consequence. */
static double sweep_blocks(const kernel *k, const sweep *s)
{
    double sum = 0.0;
    run(&(loop){.kernel = k, .sweep = s}, sweep_share);
    for (int share = 0; share < k->n_shares; share++) sum += k->sums[share];
    return sum;
}

void kernel_drift(const kernel *k, const sweep_fused_step *p, dem_index first, dem_index last)
{
    const dem_index at = vec2_row(first);
    const double *const start[3] = {p->x0 + at, p->v0 + at, p->a0 + at};
    k->ops->drift(p->x1 + at, p->v1 + at, start, p->h, vec2_row(last - first));
}

/* Drifts those ends of a share of blocks that other shares read, and nodes in no block. It is done for all shares
 * before any of them is swept. The sweep drifts the middle of a share by itself, just ahead of where it reads, but for
 * the border with other ranks. */
static void drift_ends(const void *context, int share, int thread)
{
    const kernel *k = ((const loop *)context)->kernel;
    const sweep_fused_step *p = ((const loop *)context)->step;
    const layout *l = &k->model->layout;
    const stretch b = stretch_of(k, share);
    (void)thread;
    const dem_index low = b.first + l->ahead < b.last ? b.first + l->ahead : b.last;
    const dem_index high = b.last - l->ahead > low ? b.last - l->ahead : low;
    kernel_drift(k, p, LAYOUT_LANES * b.first, LAYOUT_LANES * low);
    kernel_drift(k, p, LAYOUT_LANES * high, share + 1 < k->n_shares ? LAYOUT_LANES * b.last : l->n_nodes);
}

void kernel_begin_step(const kernel *k, const sweep_fused_step *step)
{
    run(&(loop){.kernel = k, .step = step}, drift_ends);
    for (dem_index j = 0; j < k->border.n; j++) {
        const dem_index first = LAYOUT_LANES * k->border.list[j];
        kernel_drift(k, step, first, first + LAYOUT_LANES);
    }
}

/* Extrapolates the velocity of a node again in a fused step, since the sweep has already added its kick. Its place is
 * known, and that of a ghost has not come by a drift. */
static void extrapolate_again(const kernel *k, const kernel_state *y, dem_index i)
{
    const sweep_fused_step *p = y->fused_step;
    if (p == NULL) return;
    const dem_index at = vec2_row(i);
    const double *const start[3] = {p->x0 + at, p->v0 + at, p->a0 + at};
    double place[2];
    k->ops->drift(place, p->v1 + at, start, p->h, vec2_row(1));
}

/* Puts an acceleration in place of what the sweep has left there. In a fused step the node, extrapolated again, is
 * kicked.
 * \return what it adds to the sum of the sweep */
static double put_row(const kernel *k, const kernel_state *y, dem_index i, vec2 a)
{
    const sweep_fused_step *p = y->fused_step;
    vec2_put(y->a, i, a);
    const dem_index at = vec2_row(i);
    if (p != NULL) k->ops->kick(p->v1 + at, p->a0 + at, y->a + at, p->h, vec2_row(1));
    return sweep_term(a);
}

double kernel_accelerate_row(const kernel *k, const forces *f, const kernel_state *y, dem_index i)
{
    extrapolate_again(k, y, i);
    return put_row(k, y, i, forces_body_acceleration(f, i, y->x, y->v));
}

/* u = v, for the nodes for which the sweep does not do it.  \return 0 if all are finite */
static double copy_velocities(const kernel_state *y, dem_index first, dem_index last)
{
    double sum = 0.0;
    for (dem_index c = vec2_row(first); c < vec2_row(last) && y->u != NULL; c++) sum += 0.0 * (y->u[c] = y->v[c]);
    return sum;
}

/* The sum over a state. The sweep of the whole body evaluates broken springs, too, whose lengths may be anything, and
 * its sum may be not finite because of them; their nodes have been evaluated again by then. */
static double sum_up(const kernel_state *y, dem_index n)
{
    double sum = 0.0;
    for (dem_index i = 0; i < n; i++) sum += sweep_term(vec2_at(y->a, i));
    for (dem_index c = 0; c < vec2_row(n) && y->u != NULL; c++) sum += 0.0 * y->u[c];
    return sum;
}

/* The first place from q on at which the guard acts; the end of the blocks if there is none. */
static dem_index next_guarded(const kernel *k, dem_index q)
{
    const dem_index n = k->model->layout.n_blocks, end = LAYOUT_LANES * n;
    if (k->model->layout.corners.entries.n == 0) return end;
    while (q < end && !(k->guarded[q / LAYOUT_LANES] >> q % LAYOUT_LANES & 1))
        q = k->guarded[q / LAYOUT_LANES] >> q % LAYOUT_LANES
                ? q + 1
                : LAYOUT_LANES * next_flag(k->guarded, q / LAYOUT_LANES + 1, n);
    return q < end ? q : end;
}

/* Evaluates row by row what the sweep leaves out: nodes behind the last block, nodes on which the guard acts, nodes
 * with given forces, and where the layout is not trimmed nodes beside an element that is not whole. A node may come up
 * twice, with the same result. */
static double accelerate_rest(const kernel *k, const forces *f, const kernel_state *y)
{
    const layout *l = &k->model->layout;
    double sum = 0.0;
    for (dem_index q = LAYOUT_LANES * l->n_blocks; q < l->n_nodes; q++)
        sum += kernel_accelerate_row(k, f, y, layout_node(l, q));
    for (dem_index q = next_guarded(k, 0); q < LAYOUT_LANES * l->n_blocks && !y->is_unfolded;
         q = next_guarded(k, q + 1))
        sum += kernel_accelerate_row(k, f, y, layout_node(l, q));
    for (dem_index d = 0; f->elements != NULL && !is_trimmed(k, f->elements) && d < f->elements->n_damaged; d++)
        sum += kernel_accelerate_row(k, f, y, f->elements->damaged[d]);
    for (dem_index p = 0; forces_push(f) && p < f->boundaries->n; p++) {
        const boundary_condition *push = &f->boundaries->list[p];
        for (dem_index j = 0; push->share != NULL && j < push->n_all; j++)
            sum += kernel_accelerate_row(k, f, y, push->nodes[j]);
    }
    return sum;
}

/* a += f/m with the forces f of other surfaces, on the nodes that feel any. Positions in a fused step are known by
 * now. */
static double push_surfaces(const kernel *k, const forces *f, const kernel_state *y)
{
    const compact_pairs *c = &f->surfaces->compact;
    double sum = 0.0;
    if (!surface_contact_evaluate(f->surfaces, y->x)) return (double)NAN;
    for (dem_index j = 0; j < c->n_nodes; j++) {
        const dem_index i = c->nodes[j];
        const vec2 force = vec2_at(c->force, j);
        if (!surface_contact_acts(force)) continue;
        extrapolate_again(k, y, i);
        sum += put_row(k, y, i, forces_with(f, i, vec2_at(y->a, i), force));
    }
    return sum;
}

/* a += f/m with the forces f of obstacles on the surfaces of rigid bodies. */
static double push_rigid(const forces *f, const kernel_state *y)
{
    rigid_contact *c = f->rigid;
    double sum = 0.0;
    if (!rigid_contact_evaluate(c, y->v[f->clock], y->x)) return (double)NAN;
    for (dem_index k = 0; k < c->n; k++) sum += rigid_contact_accelerate(c, k, y->a);
    return sum;
}

/* a += f/m with the external force f, evaluated for all nodes in one call. */
static double push(const forces *f, const kernel_state *y)
{
    external_force *c = f->external;
    double sum = 0.0;
    external_force_evaluate_all(c, y->v[f->clock], y->x, y->v);
    for (dem_index i = 0; i < c->n_nodes; i++) {
        const vec2 a = forces_with(f, i, vec2_at(y->a, i), vec2_at(c->value, i));
        vec2_put(y->a, i, a);
        sum += sweep_term(a);
    }
    return sum;
}

/* A fused step evaluates a block before all positions and velocities of the new state exist, so forces must not depend
 * on velocities or time, no power of friction is known, and a rigid body must not have to be put together; packed
 * copies have no drift of their own. */
bool kernel_can_fuse(const kernel *k, const forces *f)
{
    return k->packed == NULL && !forces_are_damped(f) && !forces_are_driven(f) && !forces_have_friction(f) &&
           f->model->rigid.n == 0;
}

/* Pack if nodes are renumbered, sweep, unpack, then the rows and the external force.
 * Packed velocities are needed for damping only. */
double kernel_accelerate(kernel *k, const forces *f, const kernel_state *y)
{
    const layout *l = &k->model->layout;
    const dem_index n = l->n_nodes;
    forget_mended(k, f->elements);
    sweep s = {.layout = kernel_layout(k, f->elements),
               .inverse_mass = k->model->inverse_mass,
               .gravity = {f->gravity[0], f->gravity[1]},
               .mass_damping = f->mass_damping,
               .x = y->x,
               .v = y->v,
               .u = y->u,
               .a = y->a,
               .guarded = y->is_unfolded && !l->stiff ? NULL : k->guarded,
               .looks_at_lowest = !l->stiff,
               .limit = y->fused_step != NULL ? k->limit : NULL,
               .strained = k->strained,
               .fused_step = y->fused_step,
               .drifted = k->border.is_in};
    k->watched = s.limit != NULL ? y->x : NULL;
    /* The sweep knows the layout's order only. `packed` has 1/m first, x from n on, v from 3 n on and a from 5 n on. */
    if (k->packed != NULL) {
        pack(k, y->x, k->packed + n);
        if (l->damped || f->mass_damping != 0.0) pack(k, y->v, k->packed + 3 * n);
        s.inverse_mass = k->packed;
        s.x = k->packed + n;
        s.v = k->packed + 3 * n;
        s.a = k->packed + 5 * n;
        s.u = NULL;
    }
    /* From here on arrays are in the caller's order again. */
    double sum = sweep_blocks(k, &s);
    find_guarded(k, &s, y->x);
    if (k->packed != NULL) run(&(loop){.kernel = k, .from = s.a, .to = y->a}, unpack_share);
    sum += copy_velocities(y, k->packed != NULL ? 0 : LAYOUT_LANES * l->n_blocks, n);
    sum += accelerate_rest(k, f, y);
    if (f->elements != NULL && !isfinite(sum)) sum = sum_up(y, n);
    if (f->surfaces != NULL) sum += push_surfaces(k, f, y);
    if (f->rigid != NULL) sum += push_rigid(f, y);
    return f->external != NULL ? sum + push(f, y) : sum;
}

/* ---- strains ---- */

/* The nodes of a block; those behind the last block count as one. */
static dem_index end_of_block(const layout *l, dem_index block)
{
    return block < l->n_blocks ? LAYOUT_LANES * (block + 1) : l->n_nodes;
}

/* Whether the block of node i has the spring to j. A spring belongs to the block of its lower node; where nodes are
 * renumbered, and behind the blocks, to that of both. */
static bool belongs_to(const layout *l, dem_index block, dem_index i, dem_index j)
{
    return l->order != NULL || block >= l->n_blocks || j > i;
}

/* Lengths with the strains of the limits, for springs from a shortest to a longest length at rest. */
static void find_lengths(sweep_limits *limit, double rest_min, double rest_max)
{
    const bool alike = rest_max <= (1.0 + 1e-9) * rest_min;
    limit->shortest = rest_max * (1.0 - ((double)limit->squeeze - 1e-12));
    limit->longest = alike ? rest_min * (1.0 + ((double)limit->stretch - 1e-12)) : -1.0;
}

/* The least thresholds of the springs of a block. */
static sweep_limits least_of_block(const kernel *k, const kernel_threshold *threshold, dem_index block)
{
    const layout *l = &k->model->layout;
    const springs *s = &k->model->springs;
    sweep_limits least = {.stretch = INFINITY, .squeeze = INFINITY};
    double rest_min = (double)INFINITY, rest_max = 0.0;
    for (dem_index q = LAYOUT_LANES * block; q < end_of_block(l, block); q++)
        for (dem_index i = layout_node(l, q), p = s->row[i]; p < s->row[i + 1]; p++) {
            if (!belongs_to(l, block, i, s->neighbour[p])) continue;
            least.stretch = fminf(least.stretch, threshold[s->spring[p]].stretch);
            least.squeeze = fminf(least.squeeze, threshold[s->spring[p]].squeeze);
            rest_min = fmin(rest_min, s->rest_length_of[s->spring[p]]);
            rest_max = fmax(rest_max, s->rest_length_of[s->spring[p]]);
        }
    find_lengths(&least, rest_min, rest_max);
    return least;
}

dem_status kernel_watch(kernel *k, const kernel_threshold *threshold)
{
    const dem_index n_blocks = k->model->layout.n_blocks;
    k->limit = malloc(((size_t)n_blocks + 1) * sizeof *k->limit);
    k->strained = calloc((size_t)n_blocks + EIGHT, 1);
    CHECK(k->limit && k->strained, DEM_ERROR_MEMORY, "out of memory for the strains of %lld blocks",
          (long long)n_blocks);
    for (dem_index block = 0; block <= n_blocks; block++) k->limit[block] = least_of_block(k, threshold, block);
    return DEM_OK;
}

static void strain_share(const void *context, int share, int thread)
{
    const loop *p = context;
    const stretch b = stretch_of(p->kernel, share);
    (void)thread;
    p->kernel->sweep_strain(p->sweep, b.first, b.last);
}

/* Which nodes have strained springs. */
static void find_strained(kernel *k, const element_state *e, const double *x)
{
    const layout *l = &k->model->layout;
    if (k->packed != NULL) pack(k, x, k->packed + l->n_nodes);
    forget_mended(k, e);
    const sweep s = {.layout = kernel_layout(k, e),
                     .x = k->packed != NULL ? k->packed + l->n_nodes : x,
                     .limit = k->limit,
                     .strained = k->strained};
    run(&(loop){.kernel = k, .sweep = &s}, strain_share);
}

/* Of place q. */
static dem_index block_of(const layout *l, dem_index q)
{
    return q < LAYOUT_LANES * l->n_blocks ? q / LAYOUT_LANES : l->n_blocks;
}

typedef struct squares {
    double least, most;
} squares;

/* Squares of lengths over those at rest that do not count; those within 1e-12 of a limit may. */
static squares squares_of(sweep_limits limit)
{
    const double least = 1.0 - ((double)limit.squeeze - 1e-12), most = 1.0 + ((double)limit.stretch - 1e-12);
    return (squares){least > 0.0 ? least * least : -1.0, most * most};
}

/* The springs of the node at place q that belong to its block. */
static void visit_place(const kernel *k, const element_state *e, const double *x, dem_index q, kernel_visitor *visit,
                        void *context)
{
    const layout *l = &k->model->layout;
    const springs *s = &k->model->springs;
    const dem_index i = layout_node(l, q), block = block_of(l, q);
    const squares within = squares_of(k->limit[block]);
    const springs_integrity left = element_state_springs(element_state_at(e, i));
    const vec2 xi = vec2_at(x, i);
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        if (!belongs_to(l, block, i, s->neighbour[p])) continue;
        const vec2 d = vec2_sub(vec2_at(x, s->neighbour[p]), xi);
        const double square = vec2_dot(d, d), rest = s->rest_length_of[s->spring[p]];
        const bool is_within = square < within.most * (rest * rest) && square > within.least * (rest * rest);
        if (!is_within && !springs_is_broken(left, s->spring[p])) visit(context, i, p);
    }
}

static void visit_block(const kernel *k, const element_state *e, const double *x, dem_index block,
                        kernel_visitor *visit, void *context)
{
    for (unsigned lane = 0, nodes = k->strained[block]; nodes >> lane != 0; lane++)
        if (nodes >> lane & 1) visit_place(k, e, x, LAYOUT_LANES * block + lane, visit, context);
}

/* What a fused step has found is asked for once: the next who asks may have changed the positions. */
void kernel_visit_strained(kernel *k, const element_state *e, const double *x, kernel_visitor *visit, void *context)
{
    const layout *l = &k->model->layout;
    if (k->watched != x) find_strained(k, e, x);
    k->watched = NULL;
    for (dem_index block = 0; (block = next_flag(k->strained, block, l->n_blocks)) < l->n_blocks; block++)
        visit_block(k, e, x, block, visit, context);
    for (dem_index q = LAYOUT_LANES * l->n_blocks; q < l->n_nodes; q++) visit_place(k, e, x, q, visit, context);
}

/* ---- the guard ---- */

static void guard_share(const void *context, int share, int thread)
{
    const loop *p = context;
    const stretch b = stretch_of(p->kernel, share);
    (void)thread;
    p->kernel->sweep_guard(p->sweep, b.first, b.last);
}

triangles_room kernel_room_to_fold(const kernel *k, const double *x, const double *v)
{
    const layout *l = &k->model->layout;
    const triangles_room in = k->fold_pass(l, x, v),
                         behind = triangles_room_to_fold(&k->model->triangles, LAYOUT_LANES * l->n_blocks, x, v);
    return (triangles_room){fmin(in.way, behind.way), fmax(in.speed, behind.speed)};
}

double kernel_guard_bound(const kernel *k, const forces *f, const double *x, dem_index q)
{
    const layout *l = &k->model->layout;
    const dem_index i = layout_node(l, q);
    return triangles_guard_bound(&k->model->triangles, element_state_triangles(f->elements), i, x) *
           k->model->inverse_mass[i];
}

/* The frequency is at most sqrt(omega_max^2 + the largest kernel_guard_bound()): returned in units of omega_max. The
 * sweep is used only to find the nodes on which the guard acts. */
double kernel_stiffening(kernel *k, const forces *f, const double *x)
{
    const layout *l = &k->model->layout;
    const double omega = k->model->omega_max;
    double added = 0.0;
    forget_mended(k, f->elements);
    if (k->model->triangles.row[l->n_nodes] == 0 || !(omega > 0.0)) return 1.0;
    if (k->packed != NULL) pack(k, x, k->packed + l->n_nodes);
    /* Positions are all that is needed to find the nodes on which the guard acts. */
    const sweep s = {.layout = kernel_layout(k, f->elements),
                     .x = k->packed != NULL ? k->packed + l->n_nodes : x,
                     .guarded = k->guarded,
                     .looks_at_lowest = true};
    run(&(loop){.kernel = k, .sweep = &s}, guard_share);
    find_guarded(k, &s, x);
    for (dem_index q = next_guarded(k, 0); q < LAYOUT_LANES * l->n_blocks; q = next_guarded(k, q + 1))
        added = fmax(added, kernel_guard_bound(k, f, x, q));
    for (dem_index q = LAYOUT_LANES * l->n_blocks; q < l->n_nodes; q++)
        added = fmax(added, kernel_guard_bound(k, f, x, q));
    return sqrt(1.0 + added / (omega * omega));
}
