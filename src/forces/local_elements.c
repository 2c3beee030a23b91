/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs and triangles near an event are evaluated many times in short order: at every stage of the step, before the
 * event and after it. Here each spring is evaluated once for both of its ends, in loops of which compilers make vector
 * instructions, and each coupled triangle once for its corners. Then nodes add up what acts on them in the order of
 * their rows, so that they have the bits of forces_of_elements(). An area has its own rounding at each corner, and is
 * computed there; but where triangles have a guard alone, it is first seen whether any of them is near its onset. */
#include "forces/local_elements.h"

#include <string.h>

#include "base/grow.h"
#include "base/status.h"

void local_elements_destroy(local_elements *e)
{
    void *const arrays[LOCAL_ELEMENTS_ARRAYS] = {e->places,      e->bonds,   e->pushed,  e->pulled,
                                                 e->rest_length, e->fx,      e->fy,      e->pulls,
                                                 e->corners,     e->guarded, e->coupled, e->pushes};
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

/* No list has more entries than there are slots. */
static dem_status reserve(local_elements *e, dem_index n_nodes, slot_counts n)
{
    dem_index *room = e->room;
    CHECK(ROOM(places, n_nodes + 1) && ROOM(bonds, n.springs) && ROOM(pushed, n.springs) && ROOM(pulled, n.springs) &&
              ROOM(rest_length, n.springs) && ROOM(fx, n.springs) && ROOM(fy, n.springs) && ROOM(pulls, n.springs) &&
              ROOM(corners, n.triangles) && ROOM(guarded, n.triangles) && ROOM(coupled, n.couplings) &&
              ROOM(pushes, n.couplings),
          DEM_ERROR_MEMORY, "out of memory for what is near an event");
    return DEM_OK;
}

#undef ROOM

/* ---- lists ---- */

/* Where the lists of a node begin, and so where they end so far. */
static local_places *end_of_lists(local_elements *e, dem_index j)
{
    return &e->places[j + 1];
}

static void add_bond(local_elements *e, dem_index j, int32_t other, dem_index p)
{
    const springs *s = &e->forces->model->springs;
    const springs_integrity integrity = element_state_springs(e->forces->elements);
    const dem_index k = end_of_lists(e, j)->bonds++;
    e->bonds[k] = (local_bond){(int32_t)j, other};
    e->pushed[k] = springs_left(integrity, s->spring[p], 0.0) * s->stiffness[p];
    e->pulled[k] = springs_left(integrity, s->spring[p], 1.0) * s->stiffness[p];
    e->rest_length[k] = s->rest_length[p];
}

/* The bond that is listed at a node with this one as its second. */
static dem_index find_bond(const local_elements *e, dem_index first, dem_index second)
{
    dem_index k = e->places[first].bonds;
    while (e->bonds[k].second != second) k++;
    return k;
}

/* All neighbours of a node that moves are local nodes, but for those behind springs that are broken. One with a lower
 * number has listed the spring. */
static void add_springs(local_elements *e, const local_nodes *nodes, dem_index j)
{
    const springs *s = &e->forces->model->springs;
    const springs_integrity integrity = element_state_springs(e->forces->elements);
    local_places *to = end_of_lists(e, j);
    const dem_index i = nodes->list[j];
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const int32_t other = nodes->number[s->neighbour[p]];
        if (springs_is_broken(integrity, s->spring[p])) continue;
        if (other > j) add_bond(e, j, other, p);
        if (!e->by_node) continue;
        const dem_index bond = other > j ? to->bonds - 1 : find_bond(e, other, j);
        e->pulls[to->pulls++] = (int32_t)(2 * bond + (other < j));
    }
}

static void add_triangles(local_elements *e, const local_nodes *nodes, dem_index j)
{
    const triangles *t = &e->forces->model->triangles;
    const triangles_integrity integrity = element_state_triangles(e->forces->elements);
    local_places *to = end_of_lists(e, j);
    const dem_index i = nodes->list[j];
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
        const local_corners own = {nodes->number[t->next[p]], nodes->number[t->last[p]]};
        const bool broken = triangles_broken(t, integrity, p);
        e->corners[to->corners++] = broken ? (local_corners){-1, -1} : own;
        if (broken || t->area_stiffness != NULL || own.next < j || own.last < j) continue;
        e->guarded[to->guarded++] =
            (local_guarded){{(int32_t)j, own.next, own.last}, TRIANGLES_GUARD_ONSET * t->rest_area[p]};
    }
}

static void add_coupled(local_elements *e, const local_nodes *nodes, dem_index j, dem_index k)
{
    const couplings *c = &e->forces->model->couplings;
    local_coupled *new = &e->coupled[end_of_lists(e, j)->coupled++];
    new->own = c->list[k];
    new->left = couplings_left(c, element_state_triangles(e->forces->elements), k);
    for (int q = 0; q < 3; q++) new->own.corner[q] = nodes->number[c->list[k].corner[q]];
}

/* Which of the coupled triangles that are listed at a node is this one. */
static dem_index find_coupled(const local_elements *e, dem_index first, dem_index triangle)
{
    dem_index k = e->places[first].coupled;
    while (e->coupled[k].own.triangle != triangle) k++;
    return k;
}

static void add_couplings(local_elements *e, const local_nodes *nodes, dem_index j)
{
    const couplings *c = &e->forces->model->couplings;
    const triangles_integrity integrity = element_state_triangles(e->forces->elements);
    local_places *to = end_of_lists(e, j);
    const dem_index i = nodes->list[j];
    for (dem_index p = c->row[i]; p < c->row[i + 1]; p++) {
        const coupled_triangle *own = &c->list[c->slot[p] / 3];
        dem_index first = j;
        if (couplings_broken(c, integrity, c->slot[p] / 3)) continue;
        for (int q = 0; q < 3; q++)
            if (nodes->number[own->corner[q]] < first) first = nodes->number[own->corner[q]];
        if (first == j) add_coupled(e, nodes, j, c->slot[p] / 3);
        const dem_index k = first == j ? to->coupled - 1 : find_coupled(e, first, own->triangle);
        e->pushes[to->pushes++] = (int32_t)(3 * k + c->slot[p] % 3);
    }
}

dem_status local_elements_list(local_elements *e, const local_nodes *nodes, bool by_node)
{
    const dem_index n = local_nodes_n_moving(nodes);
    e->by_node = by_node;
    TRY(reserve(e, n, count_slots(e->forces->model, nodes)));
    e->places[0] = (local_places){0};
    for (dem_index j = 0; j < n; j++) {
        e->places[j + 1] = e->places[j];
        add_springs(e, nodes, j);
        if (by_node) add_triangles(e, nodes, j);
        if (by_node && e->forces->model->couplings.n > 0) add_couplings(e, nodes, j);
    }
    return DEM_OK;
}

/* ---- forces ---- */

/* Forces (1) of the first n bonds. The pull is the tension over the length: times the vector between the ends it is the
 * force on the first one. */
static void pull(local_elements *e, dem_index n, const double *x)
{
    const double *restrict pushed = e->pushed, *restrict pulled = e->pulled, *restrict rest_length = e->rest_length;
    double *restrict fx = e->fx, *restrict fy = e->fy;
    for (dem_index k = 0; k < n; k++) {
        const vec2 d = vec2_sub(vec2_at(x, e->bonds[k].second), vec2_at(x, e->bonds[k].first));
        fx[k] = d.x;
        fy[k] = d.y;
    }
    for (dem_index k = 0; k < n; k++) {
        const double length = sqrt(fx[k] * fx[k] + fy[k] * fy[k]), in_tension = pulled[k], under_pressure = pushed[k];
        const double stiffness = length > rest_length[k] ? in_tension : under_pressure;
        const double factor = springs_pull(stiffness, rest_length[k], length);
        fx[k] = factor * fx[k];
        fy[k] = factor * fy[k];
    }
}

/* In the order of bonds. f has room for one ring more, in which the other ends collect sums that are not whole. */
static void add_up_bonds(const local_elements *e, dem_index n, dem_index n_nodes, double *f)
{
    memset(f, 0, 2 * (size_t)n_nodes * sizeof *f);
    for (dem_index k = 0; k < n; k++) {
        const local_bond bond = e->bonds[k];
        const vec2 force = {e->fx[k], e->fy[k]};
        vec2_put(f, bond.first, vec2_add(vec2_at(f, bond.first), force));
        vec2_put(f, bond.second, vec2_sub(vec2_at(f, bond.second), force));
    }
}

static void push_coupled(local_elements *e, dem_index n, const double *x)
{
    for (dem_index k = 0; k < n; k++) {
        local_coupled *c = &e->coupled[k];
        const coupled_edges edges = couplings_edges(&c->own, x);
        for (int q = 0; q < 3; q++) c->force[q] = couplings_force_at(&edges, c->left, q);
    }
}

/* Whether triangles push nothing: the first n guards are off, by more than the areas of one triangle at its corners may
 * differ by rounding. */
static bool are_slack(const local_elements *e, dem_index n, const double *x)
{
    const double margin = 1.01;
    bool slack = e->forces->model->triangles.area_stiffness == NULL;
    for (dem_index k = 0; k < n && slack; k++) {
        const local_guarded *g = &e->guarded[k];
        slack = vec2_triangle_area(vec2_at(x, g->corner[0]), vec2_at(x, g->corner[1]), vec2_at(x, g->corner[2])) >
                margin * g->onset;
    }
    return slack;
}

static vec2 force_of_springs(const local_elements *e, dem_index j)
{
    vec2 force = {0.0, 0.0};
    for (dem_index p = e->places[j].pulls; p < e->places[j + 1].pulls; p++) {
        const dem_index k = e->pulls[p] >> 1;
        force = vec2_along(force, e->pulls[p] & 1 ? -1.0 : 1.0, (vec2){e->fx[k], e->fy[k]});
    }
    for (dem_index p = e->places[j].pushes; p < e->places[j + 1].pushes; p++)
        force = vec2_add(force, e->coupled[e->pushes[p] / 3].force[e->pushes[p] % 3]);
    return force;
}

static vec2 force_of_triangles(const local_elements *e, dem_index j, dem_index i, const double *x)
{
    const triangles *t = &e->forces->model->triangles;
    const triangles_integrity integrity = element_state_triangles(e->forces->elements);
    const local_corners *own = e->corners + e->places[j].corners;
    vec2 force = {0.0, 0.0};
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++, own++) {
        if (own->next < 0) continue;
        const vec2 corner[3] = {vec2_at(x, j), vec2_at(x, own->next), vec2_at(x, own->last)};
        force = triangles_add_force(t, integrity, p, corner, force);
    }
    return force;
}

/* Where triangles act on a node, their force is added though it is 0, as forces_of_elements() does. */
void local_elements_push(local_elements *e, const local_nodes *nodes, int ring, const double *x, double *f)
{
    const dem_index n = nodes->end[ring];
    const local_places *end = &e->places[n];
    pull(e, end->bonds, x);
    if (!e->by_node) {
        add_up_bonds(e, end->bonds, nodes->end[ring + 1], f);
        return;
    }
    push_coupled(e, end->coupled, x);
    const bool slack = are_slack(e, end->guarded, x);
    for (dem_index j = 0; j < n; j++) {
        const bool none = e->places[j].corners == e->places[j + 1].corners;
        vec2 force = force_of_springs(e, j), further = {0.0, 0.0};
        if (!slack) further = force_of_triangles(e, j, nodes->list[j], x);
        vec2_put(f, j, none ? force : vec2_add(force, further));
    }
}
