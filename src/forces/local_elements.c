/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs and triangles near an event are evaluated many times in short order: at every stage of the step, before the
 * event and after it. Here each spring is evaluated once for both of its ends, in loops of which compilers make vector
 * instructions, and each coupled triangle once for its corners. Then nodes add up what acts on them in the order of
 * their rows, so that they have the bits of forces_of_elements(). An area has its own rounding at each corner, and is
 * computed there; but where triangles have a guard alone, it is first seen whether any of them is near its onset. */
#include "forces/local_elements.h"

#include <math.h>
#include <string.h>

#include "base/grow.h"
#include "base/row_pair.h"
#include "base/status.h"

void local_elements_destroy(local_elements *e)
{
    const local_lists *own = &e->own;
    void *const arrays[LOCAL_ELEMENTS_ARRAYS] = {own->places,       own->bonds,  own->pulls,   own->pushes,
                                                 own->guarded,      own->pushed, own->pulled,  own->rest_length,
                                                 own->inverse_mass, own->onset,  own->coupled, e->both,
                                                 e->coupled_force,  e->corners,  e->known};
    for (int k = 0; k < LOCAL_ELEMENTS_ARRAYS; k++) free(arrays[k]);
    *e = (local_elements){0};
}

/* ---- memory ---- */

/* How many slots nodes have in the rows of springs, triangles and couplings. */
typedef struct slot_counts {
    dem_index springs, triangles, couplings;
} slot_counts;

static slot_counts count_slots(const dem_model *model, const local_nodes *nodes)
{
    const springs *s = &model->springs;
    const triangles *t = &model->triangles;
    const couplings *c = &model->couplings;
    slot_counts n = {0};
    for (dem_index j = 0; j < local_nodes_n_moving(nodes); j++) {
        const dem_index i = nodes->list[j];
        n.springs += s->row[i + 1] - s->row[i];
        n.triangles += t->row[i + 1] - t->row[i];
        n.couplings += c->n > 0 ? c->row[i + 1] - c->row[i] : 0;
    }
    return n;
}

#define ROOM(array, n) grow_array((void **)&e->array, room++, n, sizeof *e->array)

/* What is written while forces are evaluated, with room for these elements. */
static dem_status reserve_scratch(local_elements *e, const local_nodes *nodes, slot_counts n)
{
    dem_index *room = e->room + LOCAL_ELEMENTS_LISTS;
    CHECK(ROOM(both, 4 * n.springs + 4) && ROOM(coupled_force, 3 * n.couplings) && ROOM(corners, n.triangles) &&
              ROOM(known, 2 * nodes->n),
          DEM_ERROR_MEMORY, "out of memory for what is near an event");
    return DEM_OK;
}

/* No list has more entries than there are slots. */
static dem_status reserve(local_elements *e, const local_nodes *nodes, slot_counts n)
{
    dem_index *room = e->room;
    CHECK(ROOM(own.places, local_nodes_n_moving(nodes) + 1) && ROOM(own.bonds, n.springs) &&
              ROOM(own.pulls, n.springs) && ROOM(own.pushes, n.couplings) && ROOM(own.guarded, n.triangles) &&
              ROOM(own.pushed, n.springs) && ROOM(own.pulled, n.springs) && ROOM(own.rest_length, n.springs) &&
              ROOM(own.inverse_mass, local_nodes_n_moving(nodes)) && ROOM(own.onset, n.triangles) &&
              ROOM(own.coupled, n.couplings),
          DEM_ERROR_MEMORY, "out of memory for what is near an event");
    return reserve_scratch(e, nodes, n);
}

#undef ROOM

/* ---- lists ---- */

/* How long the lists are so far: those of the present node end there. */
static void add_bond(local_elements *e, local_places *to, dem_index j, int32_t other, dem_index p)
{
    const springs *s = &e->forces->model->springs;
    const springs_integrity integrity = element_state_springs(e->forces->elements);
    const dem_index k = to->bonds++, spring = s->spring[p];
    e->lists.bonds[k] = (local_bond){2 * (int32_t)j, 2 * other};
    e->lists.rest_length[k] = s->rest_length_of[spring];
    e->lists.pushed[k] = e->lists.pulled[k] = s->stiffness_of[spring];
    if (integrity.pushed == NULL) return;
    e->lists.pushed[k] *= springs_left(integrity, spring, 0.0);
    e->lists.pulled[k] *= springs_left(integrity, spring, 1.0);
}

/* The bond that is listed at a node with this one as its second. */
static dem_index find_bond(const local_elements *e, dem_index first, dem_index second)
{
    dem_index k = e->lists.places[first].bonds;
    while (e->lists.bonds[k].second != 2 * second) k++;
    return k;
}

/* All neighbours of a node that moves are local nodes, but for those behind springs that are broken. One with a lower
 * number has listed the spring. */
static void add_springs(local_elements *e, local_places *to, const local_nodes *nodes, dem_index j)
{
    const springs *s = &e->forces->model->springs;
    const springs_integrity integrity = element_state_springs(e->forces->elements);
    const dem_index i = nodes->list[j];
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const int32_t other = nodes->number[s->neighbour[p]];
        if (springs_is_broken(integrity, s->spring[p])) continue;
        if (other > j) add_bond(e, to, j, other, p);
        if (!e->lists.by_node) continue;
        const dem_index bond = other > j ? to->bonds - 1 : find_bond(e, other, j);
        e->lists.pulls[to->pulls++] = (int32_t)(4 * bond + (other < j ? 2 : 0));
    }
}

/* Without an area term triangles only have to be known to be off. */
static void add_triangles(local_elements *e, local_places *to, const local_nodes *nodes, dem_index j)
{
    const triangles *t = &e->forces->model->triangles;
    const triangles_integrity integrity = element_state_triangles(e->forces->elements);
    const dem_index i = nodes->list[j];
    to->corners += t->row[i + 1] - t->row[i];
    for (dem_index p = t->row[i]; p < t->row[i + 1] && t->area_stiffness_of == NULL; p++) {
        const int32_t next = nodes->number[t->next[p]], last = nodes->number[t->last[p]];
        if (next < j || last < j || triangles_broken(t, integrity, p)) continue;
        e->lists.onset[to->guarded] = TRIANGLES_GUARD_ONSET * triangles_rest_area(t, i, p);
        e->lists.guarded[to->guarded++] = (local_guarded){{(int32_t)j, next, last}};
    }
}

static void add_coupled(local_elements *e, local_places *to, const local_nodes *nodes, dem_index k)
{
    const couplings *c = &e->forces->model->couplings;
    local_coupled *new = &e->lists.coupled[to->coupled++];
    new->own = c->list[k];
    new->left = couplings_left(c, element_state_triangles(e->forces->elements), k);
    for (int q = 0; q < 3; q++) new->own.corner[q] = nodes->number[c->list[k].corner[q]];
}

/* Which of the coupled triangles that are listed at a node is this one. */
static dem_index find_coupled(const local_elements *e, dem_index first, dem_index triangle)
{
    dem_index k = e->lists.places[first].coupled;
    while (e->lists.coupled[k].own.triangle != triangle) k++;
    return k;
}

static void add_couplings(local_elements *e, local_places *to, const local_nodes *nodes, dem_index j)
{
    const couplings *c = &e->forces->model->couplings;
    const triangles_integrity integrity = element_state_triangles(e->forces->elements);
    const dem_index i = nodes->list[j];
    for (dem_index p = c->row[i]; p < c->row[i + 1]; p++) {
        const coupled_triangle *own = &c->list[c->slot[p] / 3];
        dem_index first = j;
        if (couplings_broken(c, integrity, c->slot[p] / 3)) continue;
        for (int q = 0; q < 3; q++)
            if (nodes->number[own->corner[q]] < first) first = nodes->number[own->corner[q]];
        if (first == j) add_coupled(e, to, nodes, c->slot[p] / 3);
        const dem_index k = first == j ? to->coupled - 1 : find_coupled(e, first, own->triangle);
        e->lists.pushes[to->pushes++] = (int32_t)(3 * k + c->slot[p] % 3);
    }
}

/* Nothing is known of the triangles yet. */
static void begin(local_elements *e)
{
    e->have_corners = false;
    e->n_known = e->n_slack = 0;
    e->leeway = (double)INFINITY;
}

dem_status local_elements_list(local_elements *e, const local_nodes *nodes, bool by_node)
{
    local_places to = {0};
    TRY(reserve(e, nodes, count_slots(e->forces->model, nodes)));
    e->own.by_node = by_node;
    e->lists = e->own;
    begin(e);
    e->lists.places[0] = to;
    for (dem_index j = 0; j < local_nodes_n_moving(nodes); j++) {
        e->lists.inverse_mass[j] = e->forces->model->inverse_mass[nodes->list[j]];
        add_springs(e, &to, nodes, j);
        if (by_node) add_triangles(e, &to, nodes, j);
        if (by_node && e->forces->model->couplings.n > 0) add_couplings(e, &to, nodes, j);
        e->lists.places[j + 1] = to;
    }
    return DEM_OK;
}

dem_status local_elements_take(local_elements *e, const local_nodes *nodes, const local_lists *lists)
{
    const local_places *end = &lists->places[local_nodes_n_moving(nodes)];
    TRY(reserve_scratch(e, nodes, (slot_counts){end->bonds, end->corners, end->coupled}));
    e->lists = *lists;
    begin(e);
    return DEM_OK;
}

/* ---- lists after a break ---- */

/* A pull of nothing, behind all bonds: it changes no sum that begins with 0. */
static int32_t no_pull(local_elements *e, dem_index n)
{
    const dem_index pull = 4 * e->lists.places[n].bonds;
    e->both[pull] = e->both[pull + 1] = 0.0;
    return (int32_t)pull;
}

/* Of a spring that is whole still. Its other end is a local node. */
static int32_t pull_of(local_elements *e, dem_index j, dem_index other, dem_index p)
{
    const springs *s = &e->forces->model->springs;
    const springs_integrity integrity = element_state_springs(e->forces->elements);
    const dem_index k = other > j ? find_bond(e, j, other) : find_bond(e, other, j), spring = s->spring[p];
    e->lists.pushed[k] = springs_left(integrity, spring, 0.0) * s->stiffness_of[spring];
    e->lists.pulled[k] = springs_left(integrity, spring, 1.0) * s->stiffness_of[spring];
    return (int32_t)(4 * k + (other < j ? 2 : 0));
}

/* Those of springs that have broken since leave, and the rest stays in order. */
static void renew_pulls(local_elements *e, const local_nodes *nodes, dem_index j, int32_t none)
{
    const springs *s = &e->forces->model->springs;
    const springs_integrity integrity = element_state_springs(e->forces->elements);
    const dem_index i = nodes->list[j];
    int32_t to = e->lists.places[j].pulls;
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++)
        if (!springs_is_broken(integrity, s->spring[p]))
            e->lists.pulls[to++] = pull_of(e, j, nodes->number[s->neighbour[p]], p);
    while (to < e->lists.places[j + 1].pulls) e->lists.pulls[to++] = none;
}

/* Guards of what has broken still count where it is asked whether all are off: if they are not, each triangle is asked
 * by itself. */
dem_status local_elements_renew(local_elements *e, const local_nodes *nodes)
{
    if (e->lists.places != e->own.places || !e->lists.by_node || e->forces->model->couplings.n > 0)
        return local_elements_list(e, nodes, e->lists.by_node);
    const int32_t none = no_pull(e, local_nodes_n_moving(nodes));
    for (dem_index j = 0; j < nodes->end[0]; j++) renew_pulls(e, nodes, j, none);
    e->have_corners = false;
    return DEM_OK;
}

/* The other corners of the triangles at all nodes that are accelerated. */
static void list_corners(local_elements *e, const local_nodes *nodes)
{
    const triangles *t = &e->forces->model->triangles;
    const triangles_integrity integrity = element_state_triangles(e->forces->elements);
    local_corners *to = e->corners;
    for (dem_index j = 0; j < local_nodes_n_moving(nodes); j++)
        for (dem_index i = nodes->list[j], p = t->row[i]; p < t->row[i + 1]; p++)
            *to++ = triangles_broken(t, integrity, p)
                        ? (local_corners){-1, -1, 0.0}
                        : (local_corners){nodes->number[t->next[p]], nodes->number[t->last[p]],
                                          triangles_rest_area(t, i, p)};
    e->have_corners = true;
}

/* ---- forces ---- */

/* Forces (1) of bonds k and `other`, which may be the same, on the first of their ends. The pull is the tension over
 * the length: times the vector between the ends it is the force on the first one. */
INLINE void forces_of_two(const local_elements *e, dem_index k, dem_index other, const double *x, row_pair force[2])
{
    const local_bond *bond[2] = {&e->lists.bonds[k], &e->lists.bonds[other]};
    const row_pair one = row_pair_at(x + bond[0]->second, 0) - row_pair_at(x + bond[0]->first, 0);
    const row_pair two = row_pair_at(x + bond[1]->second, 0) - row_pair_at(x + bond[1]->first, 0);
    const row_pair length = row_pair_lengths(one, two);
    const row_pair rest = {e->lists.rest_length[k], e->lists.rest_length[other]};
    const row_pair pulled = {e->lists.pulled[k], e->lists.pulled[other]},
                   pushed = {e->lists.pushed[k], e->lists.pushed[other]};
    const row_pair_bits tension = length > rest;
    const row_pair stiffness = (row_pair)(((row_pair_bits)pulled & tension) | ((row_pair_bits)pushed & ~tension));
    const row_pair factor = springs_pull_two(stiffness, rest, length);
    force[0] = factor[0] * one;
    force[1] = factor[1] * two;
}

/* On both of their ends. */
INLINE void pull_two(local_elements *e, dem_index k, dem_index other, const double *x)
{
    row_pair force[2];
    forces_of_two(e, k, other, x, force);
    row_pair_put(e->both + 4 * k, 0, force[0]);
    row_pair_put(e->both + 4 * k + 2, 0, -force[0]);
    row_pair_put(e->both + 4 * other, 0, force[1]);
    row_pair_put(e->both + 4 * other + 2, 0, -force[1]);
}

/* Of the first n bonds. */
static void pull(local_elements *e, dem_index n, const double *x)
{
    for (dem_index k = 0; k + 1 < n; k += 2) pull_two(e, k, k + 1, x);
    if (n % 2 == 1) pull_two(e, n - 1, n - 1, x);
}

/* Adds the force of a bond to its ends. */
INLINE void add_bond_force(const local_bond *bond, row_pair force, double *f)
{
    row_pair_put(f + bond->first, 0, row_pair_at(f + bond->first, 0) + force);
    row_pair_put(f + bond->second, 0, row_pair_at(f + bond->second, 0) - force);
}

/* Forces of the first n bonds, added up in their order. f has room for one ring more, in which the other ends collect
 * sums that are not whole. */
static void add_up_bonds(const local_elements *e, dem_index n, dem_index n_nodes, const double *x, double *f)
{
    row_pair force[2];
    memset(f, 0, 2 * (size_t)n_nodes * sizeof *f);
    for (dem_index k = 0; k < n; k += 2) {
        const dem_index next = k + 1 < n ? k + 1 : k;
        forces_of_two(e, k, next, x, force);
        add_bond_force(&e->lists.bonds[k], force[0], f);
        if (next > k) add_bond_force(&e->lists.bonds[next], force[1], f);
    }
}

static void push_coupled(local_elements *e, dem_index n, const double *x)
{
    for (dem_index k = 0; k < n; k++) {
        const local_coupled *c = &e->lists.coupled[k];
        const coupled_edges edges = couplings_edges(&c->own, x);
        for (int q = 0; q < 3; q++) e->coupled_force[3 * k + q] = couplings_force_at(&edges, c->left, q);
    }
}

/* ---- guards ---- */

/* A guard is off for certain where the area is larger than its onset by more than the areas of one triangle at its
 * corners may differ by rounding. */
static const double margin = 1.01;

/* The second where one is not a number; fmin() is a call. */
static inline double smaller(double a, double b)
{
    return a < b ? a : b;
}

/* How far each coordinate of the corners of a triangle may go without its guard coming on; < 0: it may be on. Where all
 * go by d, its area changes by at most S d + 4 d^2, with S the sum of the sizes of the components of two edges; that is
 * at most 2 S d for d <= S/4. */
static double leeway_of(const local_elements *e, dem_index k, const double *x)
{
    const local_guarded *g = &e->lists.guarded[k];
    const row_pair from = row_pair_at(x + 2 * g->corner[0], 0);
    const row_pair u = row_pair_at(x + 2 * g->corner[1], 0) - from, w = row_pair_at(x + 2 * g->corner[2], 0) - from;
    const row_pair products = u * (row_pair){w[1], w[0]}, sizes = row_pair_absolute(u) + row_pair_absolute(w);
    const double spare = 0.5 * (products[0] - products[1]) - margin * e->lists.onset[k], size = sizes[0] + sizes[1];
    return spare >= 0.0 ? smaller(0.5 * spare / size, 0.25 * size) : -1.0;
}

/* The leeway of all triangles that are asked for so far; nodes are known where they were when they were first. */
static void find_leeway(local_elements *e, dem_index n_nodes, dem_index n, const double *x)
{
    for (; e->n_known < n_nodes; e->n_known++) vec2_put(e->known, e->n_known, vec2_at(x, e->n_known));
    for (; e->n_slack < n; e->n_slack++) e->leeway = smaller(leeway_of(e, e->n_slack, e->known), e->leeway);
}

/* Whether no one of n coordinates has gone further than the leeway: no difference has a sign. Where one is not a number
 * springs pull by none either. */
static bool are_near(const local_elements *e, dem_index n, const double *x)
{
    const double *restrict known = e->known, leeway = e->leeway;
    uint64_t signs = 0;
    for (dem_index k = 0; k < n; k++) {
        const double left = leeway - fabs(x[k] - known[k]);
        uint64_t bits;
        memcpy(&bits, &left, sizeof bits);
        signs |= bits;
    }
    return signs >> 63 == 0;
}

/* Whether the first n guards are off, each by itself. */
static bool are_off(const local_elements *e, dem_index n, const double *x)
{
    bool off = true;
    for (dem_index k = 0; k < n && off; k++) {
        const local_guarded *g = &e->lists.guarded[k];
        off = vec2_triangle_area(vec2_at(x, g->corner[0]), vec2_at(x, g->corner[1]), vec2_at(x, g->corner[2])) >
              margin * e->lists.onset[k];
    }
    return off;
}

/* Whether triangles push nothing at the nodes of a ring or nearer, where the first n_moved nodes have moved since the
 * last time. */
static bool are_slack(local_elements *e, const local_nodes *nodes, dem_index n_moved, int ring, const double *x)
{
    const dem_index n = e->lists.places[nodes->end[ring]].guarded, n_nodes = nodes->end[ring + 1];
    const dem_index n_other = e->were_near && n_moved < n_nodes ? n_moved : n_nodes;
    if (e->forces->model->triangles.area_stiffness_of != NULL) return false;
    find_leeway(e, n_nodes, n, x);
    e->were_near = are_near(e, 2 * n_other, x);
    return e->were_near || are_off(e, n, x);
}

/* ---- sums ---- */

static row_pair force_of_springs(const local_elements *e, dem_index j)
{
    const double *both = e->both;
    const int32_t *pull = e->lists.pulls + e->lists.places[j].pulls;
    const int32_t *const end = e->lists.pulls + e->lists.places[j + 1].pulls;
    row_pair sum = {0.0, 0.0};
    for (; pull < end; pull++) sum += row_pair_aligned(both + *pull);
    return sum;
}

/* Of springs and couplings. */
static vec2 force_of_bonds(const local_elements *e, dem_index j)
{
    const row_pair sum = force_of_springs(e, j);
    vec2 force = {sum[0], sum[1]};
    for (dem_index p = e->lists.places[j].pushes; p < e->lists.places[j + 1].pushes; p++)
        force = vec2_add(force, e->coupled_force[e->lists.pushes[p]]);
    return force;
}

static vec2 force_of_triangles(const local_elements *e, dem_index j, dem_index i, const double *x)
{
    const triangles *t = &e->forces->model->triangles;
    const triangles_integrity integrity = element_state_triangles(e->forces->elements);
    const local_corners *own = e->corners + e->lists.places[j].corners;
    vec2 force = {0.0, 0.0};
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++, own++) {
        if (own->next < 0) continue;
        const vec2 corner[3] = {vec2_at(x, j), vec2_at(x, own->next), vec2_at(x, own->last)};
        force = triangles_add_force(t, integrity, p, own->rest_area, corner, force);
    }
    return force;
}

/* Where triangles act on a node, their force is added though it may be 0, as forces_of_elements() does. A sum that
 * begins with 0 does not become -0, and so stays as it is where all of them are 0. */
static void add_up_by_node(local_elements *e, const local_nodes *nodes, dem_index n_moved, int ring, const double *x,
                           double *f)
{
    const dem_index n = nodes->end[ring];
    if (are_slack(e, nodes, n_moved, ring, x)) {
        const bool coupled = e->lists.places[n].pushes > 0;
        for (dem_index j = 0; j < n && !coupled; j++) row_pair_put(f + 2 * j, 0, force_of_springs(e, j));
        for (dem_index j = 0; j < n && coupled; j++) vec2_put(f, j, force_of_bonds(e, j));
        return;
    }
    if (!e->have_corners) list_corners(e, nodes);
    for (dem_index j = 0; j < n; j++) {
        const bool none = e->lists.places[j].corners == e->lists.places[j + 1].corners;
        const vec2 force = force_of_bonds(e, j), further = force_of_triangles(e, j, nodes->list[j], x);
        vec2_put(f, j, none ? force : vec2_add(force, further));
    }
}

/* A spring or a coupled triangle is listed at the first of its nodes: where only the first n_moved nodes have moved the
 * others pull as before. */
void local_elements_push_moved(local_elements *e, const local_nodes *nodes, dem_index n_moved, int ring,
                               const double *x, double *f)
{
    const dem_index n = nodes->end[ring], n_pulling = n_moved < n ? n_moved : n;
    if (!e->lists.by_node) {
        add_up_bonds(e, e->lists.places[n].bonds, nodes->end[ring + 1], x, f);
        return;
    }
    pull(e, e->lists.places[n_pulling].bonds, x);
    push_coupled(e, e->lists.places[n_pulling].coupled, x);
    add_up_by_node(e, nodes, n_moved, ring, x, f);
}

void local_elements_push(local_elements *e, const local_nodes *nodes, int ring, const double *x, double *f)
{
    local_elements_push_moved(e, nodes, nodes->end[ring + 1], ring, x, f);
}
