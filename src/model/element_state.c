/* SPDX-License-Identifier: BSD-3-Clause */
/* What is broken in a simulation: a flag for each triangle, the integrity of each spring, a flag for each node beside
 * an element that is not whole, and the list of these nodes. Where triangles soften there are also how many times each
 * has done so, what this leaves of it, and what is left of each spring in tension. The model stays as it is, so several
 * simulations of one model may have different states. The flags of nodes let the force on an intact node skip the state
 * of its elements, and the list tells the sweep over all nodes where its layout has to be trimmed (kernel_follow() in
 * forces/kernel.c), or which nodes to evaluate once more, one by one, as long as it is not. When an element breaks is
 * decided elsewhere. As long as all are whole there are only the flags, and the list of triangles at each node.
 *
 * A triangle that breaks takes what it gave to its springs. What is left is what the lattice would have had without the
 * triangle from the start, so that a crack that opens in a run is as stiff as one that is cut before. */
#include "model/element_state.h"

#include <stdlib.h>

#include "base/status.h"
#include "model/closed_crack.h"
#include "model/spring_holders.h"
#include "model/spring_share.h"

/* Shares are multiples of 2^-52, so that differences of them are exact and do not depend on the order in which
 * triangles break, and a break can be taken back to the bit. */
static const double unit = 0x1p-52;

/* One more item than needed in each array, so that no allocation is of no bytes. */
static dem_status allocate_flags(element_state *s)
{
    const dem_lattice *l = s->lattice;
    const size_t n = (size_t)l->n_nodes, n_triangles = (size_t)l->n_triangles;
    CHECK(l->n_springs < INT32_MAX && 6 * l->n_triangles < INT32_MAX, DEM_ERROR_MODEL,
          "%lld springs and %lld triangles that may break are more than the library takes", (long long)l->n_springs,
          (long long)l->n_triangles);
    s->triangle = calloc(n_triangles + 1, sizeof *s->triangle);
    s->node = calloc(n + 1, sizeof *s->node);
    s->at_row = calloc(n + 2, sizeof *s->at_row);
    s->at = malloc((3 * n_triangles + 1) * sizeof *s->at);
    CHECK(s->triangle && s->node && s->at_row && s->at, DEM_ERROR_MEMORY,
          "out of memory for the state of %lld triangles", (long long)l->n_triangles);
    return DEM_OK;
}

/* Nothing has softened. */
static dem_status allocate_softening(element_state *s)
{
    const dem_lattice *l = s->lattice;
    s->tension = malloc(((size_t)l->n_springs + 1) * sizeof *s->tension);
    s->level = calloc((size_t)l->n_triangles + 1, sizeof *s->level);
    s->left = malloc(((size_t)l->n_triangles + 1) * sizeof *s->left);
    CHECK(s->tension && s->level && s->left, DEM_ERROR_MEMORY, "out of memory for the state of %lld triangles",
          (long long)l->n_triangles);
    for (dem_index k = 0; k < l->n_springs; k++) s->tension[k] = 1.0;
    for (dem_index t = 0; t < l->n_triangles; t++) s->left[t] = 1.0;
    return DEM_OK;
}

static dem_status allocate(element_state *s)
{
    const dem_lattice *l = s->lattice;
    const size_t n_springs = (size_t)l->n_springs;
    s->integrity = malloc((n_springs + 1) * sizeof *s->integrity);
    s->damaged = malloc(((size_t)l->n_nodes + 1) * sizeof *s->damaged);
    s->row = calloc((size_t)l->n_triangles + 2, sizeof *s->row);
    s->held = calloc(n_springs + 1, sizeof *s->held);
    CHECK(s->integrity && s->damaged && s->row && s->held, DEM_ERROR_MEMORY,
          "out of memory for the state of %lld springs", (long long)l->n_springs);
    for (dem_index k = 0; k < l->n_springs; k++) s->integrity[k] = 1.0;
    return l->softening != NULL ? allocate_softening(s) : DEM_OK;
}

/* at_row[i + 2] counts the triangles at node i first; summed up, at_row[i + 1] is where the next one goes, and in the
 * end where the row ends. */
static void list_triangles(element_state *s)
{
    const dem_lattice *l = s->lattice;
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) s->at_row[l->triangles[k] + 2]++;
    for (dem_index i = 0; i < l->n_nodes; i++) s->at_row[i + 2] += s->at_row[i + 1];
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) s->at[s->at_row[l->triangles[k] + 1]++] = (int32_t)(k / 3);
}

/* The same of the springs that a triangle holds. */
static void count(void *context, dem_index spring, dem_index triangle, double share)
{
    element_state *s = context;
    (void)spring;
    (void)share;
    if (triangle >= 0) s->row[triangle + 2]++;
}

static void enter(void *context, dem_index spring, dem_index triangle, double share)
{
    element_state *s = context;
    if (triangle < 0) return;
    const dem_index p = s->row[triangle + 1]++;
    s->spring[p] = (int32_t)spring;
    s->held[spring] = 1;
    s->share[p] = nearbyint(share / unit) * unit;
}

/* By the rounding the shares of a spring may miss 1 by a few units, which the first of its triangles gets: without any
 * triangle nothing is left of it. */
static void complete_shares(element_state *s)
{
    const dem_index n_slots = s->row[s->lattice->n_triangles];
    double *missing = s->integrity; /* 1 as yet */
    for (dem_index p = 0; p < n_slots; p++) missing[s->spring[p]] -= s->share[p];
    for (dem_index p = 0; p < n_slots; p++) {
        s->share[p] += missing[s->spring[p]];
        missing[s->spring[p]] = 0.0;
    }
    for (dem_index k = 0; k < s->lattice->n_springs; k++) s->integrity[k] = 1.0;
}

static dem_status list_springs(element_state *s, spring_holders *holders)
{
    const dem_index n = s->lattice->n_triangles;
    spring_holders_count(holders, count, s);
    for (dem_index t = 0; t < n; t++) s->row[t + 2] += s->row[t + 1];
    const size_t slots = (size_t)s->row[n + 1] + 1;
    s->spring = malloc(slots * sizeof *s->spring);
    s->share = malloc(slots * sizeof *s->share);
    CHECK(s->spring && s->share, DEM_ERROR_MEMORY, "out of memory for what %lld triangles hold", (long long)n);
    spring_holders_visit(holders, enter, s);
    complete_shares(s);
    return DEM_OK;
}

dem_status element_state_begin(element_state *out, const dem_lattice *lattice, const springs *s)
{
    element_state state = {.lattice = lattice, .springs = s};
    const dem_status status = allocate_flags(&state);
    if (status == DEM_OK) list_triangles(&state);
    if (status == DEM_OK)
        *out = state;
    else
        element_state_destroy(&state);
    return status;
}

/* What is needed once an element is not whole. */
static void free_parts(element_state *s)
{
    free(s->integrity);
    free(s->tension);
    free(s->level);
    free(s->left);
    free(s->damaged);
    free(s->row);
    free(s->spring);
    free(s->share);
    free(s->held);
}

dem_status element_state_prepare(element_state *s)
{
    if (s->integrity != NULL) return DEM_OK;
    element_state ready = *s;
    spring_holders holders = {0};
    dem_status status = allocate(&ready);
    if (status == DEM_OK) status = spring_holders_create(&holders, s->lattice, s->springs);
    if (status == DEM_OK) status = list_springs(&ready, &holders);
    spring_holders_free(&holders);
    if (status == DEM_OK)
        *s = ready;
    else
        free_parts(&ready);
    return status;
}

dem_status element_state_create(element_state *out, const dem_lattice *lattice, const springs *s)
{
    TRY(element_state_begin(out, lattice, s));
    const dem_status status = element_state_prepare(out);
    if (status != DEM_OK) element_state_destroy(out);
    return status;
}

void element_state_destroy(element_state *s)
{
    free_parts(s);
    free(s->triangle);
    free(s->node);
    free(s->at_row);
    free(s->at);
    *s = (element_state){0};
}

/* Notes a node beside an element that is not whole, once. The list cannot overflow, since each node enters it at most
 * once. */
static void damage(element_state *s, dem_index node)
{
    if (s->node[node]) return;
    s->node[node] = 1;
    s->damaged[s->n_damaged++] = node;
}

/* The ends of a spring need not be corners of a triangle that holds it: the second diagonal of a cell. */
static void damage_ends(element_state *s, dem_index spring)
{
    for (int end = 0; end < 2; end++) damage(s, s->lattice->ends[2 * spring + end]);
}

static void damage_corners(element_state *s, dem_index triangle)
{
    for (int corner = 0; corner < 3; corner++) damage(s, s->lattice->triangles[3 * triangle + corner]);
}

/* The spring may have been broken alone before: then nothing is left to take from. */
static void take(double *integrity, double share)
{
    *integrity = *integrity > share ? *integrity - share : 0.0;
}

/* The element keeps its place in all arrays; those who read its numbers ask for its state. */
void element_state_break_spring(element_state *s, dem_index spring)
{
    s->n_broken += s->integrity[spring] > 0.0;
    s->integrity[spring] = 0.0;
    if (s->tension != NULL) s->tension[spring] = 0.0;
    damage_ends(s, spring);
}

/* What a triangle of which `left` is left gives to the spring in slot p in tension. */
static double share_in_tension(const element_state *s, dem_index p, double left)
{
    return nearbyint(left * s->share[p] / unit) * unit;
}

/* The edge from corner c to the next one that a spring is; -1: none. */
static int edge_of(const dem_lattice *l, dem_index triangle, dem_index spring)
{
    const dem_index *corner = &l->triangles[3 * triangle], *end = &l->ends[2 * spring];
    for (int c = 0; c < 3; c++) {
        const dem_index a = corner[c], b = corner[(c + 1) % 3];
        if ((a == end[0] && b == end[1]) || (a == end[1] && b == end[0])) return c;
    }
    return -1;
}

/* What the spring in slot p would have of a coupled triangle under pressure if nothing of it were left in tension. */
static double closed_part(const element_state *s, dem_index triangle, dem_index p)
{
    const dem_lattice *l = s->lattice;
    double share[3] = {0.0}, part[3];
    for (dem_index q = s->row[triangle]; q < s->row[triangle + 1]; q++) {
        const dem_index k = s->spring[q];
        share[edge_of(l, triangle, k)] = s->share[q] * springs_rate(l, k);
    }
    closed_crack_parts(l, triangle, share, part);
    return part[edge_of(l, triangle, s->spring[p])];
}

/* The same as share_in_tension() under pressure: all of it, but of coupled triangles. */
static double share_under_pressure(const element_state *s, dem_index triangle, dem_index p, double left)
{
    if (left == 1.0 || !triangles_are_coupled(s->lattice->coupling, triangle)) return s->share[p];
    return nearbyint((left + (1.0 - left) * closed_part(s, triangle, p)) * s->share[p] / unit) * unit;
}

/* What is left of a triangle that is not broken. */
static double left_of(const element_state *s, dem_index triangle)
{
    return s->left != NULL ? s->left[triangle] : 1.0;
}

double element_state_share(const element_state *s, dem_index triangle, dem_index p, bool pulled)
{
    const double left = left_of(s, triangle);
    return pulled ? share_in_tension(s, p, left) : share_under_pressure(s, triangle, p, left);
}

void element_state_break_triangle(element_state *s, dem_index triangle)
{
    if (s->triangle[triangle]) return;
    s->triangle[triangle] = 1;
    s->n_broken++;
    damage_corners(s, triangle);
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++) {
        take(&s->integrity[s->spring[p]], share_under_pressure(s, triangle, p, left_of(s, triangle)));
        if (s->tension != NULL) take(&s->tension[s->spring[p]], share_in_tension(s, p, s->left[triangle]));
        damage_ends(s, s->spring[p]);
    }
}

/* Gives a triangle that is not broken another level. */
static void change_level(element_state *s, dem_index triangle, int level)
{
    const double left = softening_left(s->lattice->softening[triangle], level);
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++) {
        const dem_index k = s->spring[p];
        const double before = s->left[triangle];
        s->tension[k] += share_in_tension(s, p, left) - share_in_tension(s, p, before);
        s->integrity[k] += share_under_pressure(s, triangle, p, left) - share_under_pressure(s, triangle, p, before);
    }
    s->n_softenings += level - s->level[triangle];
    s->level[triangle] = (unsigned char)level;
    s->left[triangle] = left;
}

void element_state_soften(element_state *s, dem_index triangle)
{
    damage_corners(s, triangle);
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++) damage_ends(s, s->spring[p]);
    change_level(s, triangle, s->level[triangle] + 1);
}

void element_state_break(element_state *s, dem_index element)
{
    const dem_index spring = element - s->lattice->n_triangles;
    if (spring >= 0)
        element_state_break_spring(s, spring);
    else
        element_state_break_triangle(s, element);
}

static void mend_spring(element_state *s, dem_index spring)
{
    s->n_broken--;
    s->integrity[spring] = 1.0;
    if (s->tension != NULL) s->tension[spring] = 1.0;
}

static void mend_triangle(element_state *s, dem_index triangle)
{
    s->n_broken--;
    s->triangle[triangle] = 0;
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++) {
        s->integrity[s->spring[p]] += share_under_pressure(s, triangle, p, left_of(s, triangle));
        if (s->tension != NULL) s->tension[s->spring[p]] += share_in_tension(s, p, s->left[triangle]);
    }
}

void element_state_mend(element_state *s, dem_index element)
{
    const dem_index spring = element - s->lattice->n_triangles;
    if (spring >= 0)
        mend_spring(s, spring);
    else if (s->triangle[element])
        mend_triangle(s, element);
    else
        change_level(s, element, s->level[element] - 1);
}

void element_state_forget_nodes(element_state *s, dem_index n)
{
    while (s->n_damaged > n) s->node[s->damaged[--s->n_damaged]] = 0;
}

static void follow_springs(element_state *s, const element_state *part, const domain *d)
{
    for (dem_index k = 0; k < part->lattice->n_springs; k++) {
        s->integrity[d->spring[k]] = part->integrity[k];
        if (s->tension != NULL) s->tension[d->spring[k]] = part->tension[k];
    }
}

static void follow_triangles(element_state *s, const element_state *part, const domain *d)
{
    for (dem_index t = 0; t < part->lattice->n_triangles; t++) {
        s->triangle[d->triangle[t]] = part->triangle[t];
        if (s->level == NULL) continue;
        s->level[d->triangle[t]] = part->level[t];
        s->left[d->triangle[t]] = part->left[t];
    }
}

void element_state_follow_part(element_state *s, const element_state *part, const domain *d)
{
    element_state_forget_nodes(s, 0);
    for (dem_index k = 0; k < part->n_damaged; k++) damage(s, d->number[part->damaged[k]]);
    follow_springs(s, part, d);
    follow_triangles(s, part, d);
    s->n_broken = part->n_broken;
    s->n_softenings = part->n_softenings;
}

/* ---- what is gone ---- */

double element_state_damage(const element_state *s, dem_index triangle)
{
    if (s == NULL) return 0.0;
    return s->triangle[triangle] ? 1.0 : 1.0 - triangles_left(element_state_triangles(s), triangle);
}

double element_state_node_damage(const element_state *s, dem_index node)
{
    double volume = 0.0, gone = 0.0;
    if (element_state_at(s, node) == NULL) return 0.0;
    for (dem_index p = s->at_row[node]; p < s->at_row[node + 1]; p++) {
        const double own = spring_share_volume(s->lattice, s->at[p]);
        volume += own;
        gone += element_state_damage(s, s->at[p]) * own;
    }
    return volume > 0.0 ? gone / volume : 0.0;
}
