/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds nodes breadth first, then lists springs by local numbers. */
#include "events/neighbourhood.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"

dem_status neighbourhood_create(neighbourhood *out, const state_layout *l, const forces *acting, const constraints *c,
                                int n_rings)
{
    const dem_index n = l->n_nodes;
    neighbourhood b = {.layout = *l,
                       .acting = acting,
                       .constraints = c,
                       .plain = forces_are_plain(acting),
                       .n_rings = n_rings,
                       .number = malloc((size_t)n * sizeof *b.number)};
    CHECK(b.number != NULL, DEM_ERROR_MEMORY, "out of memory for the neighbours of %lld nodes", (long long)n);
    for (dem_index i = 0; i < n; i++) b.number[i] = -1;
    *out = b;
    return DEM_OK;
}

void neighbourhood_destroy(neighbourhood *b)
{
    free(b->number);
    free(b->nodes);
    free(b->bonds);
    free(b->stiffness);
    free(b->groups);
    *b = (neighbourhood){0};
}

/* ---- rings ---- */

static dem_status add_node(neighbourhood *b, dem_index i)
{
    if (b->number[i] >= 0) return DEM_OK;
    CHECK(grow_array((void **)&b->nodes, &b->capacity, b->n + 1, sizeof *b->nodes), DEM_ERROR_MEMORY,
          "out of memory for what is near a contact");
    b->number[i] = (int32_t)b->n;
    b->nodes[b->n++] = (neighbourhood_node){.i = i};
    return DEM_OK;
}

static dem_status add_neighbours(neighbourhood *b, dem_index i)
{
    for (forces_neighbours j = forces_neighbours_of(b->acting, i); forces_next_neighbour(&j);) TRY(add_node(b, j.node));
    return DEM_OK;
}

static dem_status note_group(neighbourhood *b, dem_index group, int ring, bool *is_new)
{
    *is_new = false;
    for (dem_index g = 0; g < b->n_groups; g++)
        if (b->groups[g].group == group) return DEM_OK;
    CHECK(grow_array((void **)&b->groups, &b->group_capacity, b->n_groups + 1, sizeof *b->groups), DEM_ERROR_MEMORY,
          "out of memory for what is near a contact");
    b->groups[b->n_groups++] = (neighbourhood_group){group, ring};
    *is_new = true;
    return DEM_OK;
}

static dem_status add_tied_node(void *context, dem_index i)
{
    return add_node(context, i);
}

/* Adds the group of constraints at a node, with all its nodes. */
static dem_status add_group(neighbourhood *b, dem_index j, int ring)
{
    const dem_index group = constraints_group_at(b->constraints, b->nodes[j].i);
    bool is_new;
    b->nodes[j].grouped = group >= 0;
    if (group < 0) return DEM_OK;
    TRY(note_group(b, group, ring, &is_new));
    return is_new ? b->constraints->each_node(b->constraints->self, group, add_tied_node, b) : DEM_OK;
}

static dem_status close_ring(neighbourhood *b, int ring)
{
    for (dem_index j = ring > 0 ? b->end[ring - 1] : 0; j < b->n && ring < b->n_rings; j++) TRY(add_group(b, j, ring));
    b->end[ring] = b->n;
    return DEM_OK;
}

/* ---- springs ---- */

static dem_status reserve_bonds(neighbourhood *b, dem_index n)
{
    if (n <= b->bond_capacity) return DEM_OK;
    neighbourhood_bond *bonds = malloc(2 * (size_t)n * sizeof *bonds);
    double *reals = malloc(10 * (size_t)n * sizeof *reals);
    if (bonds == NULL || reals == NULL) {
        free(bonds);
        free(reals);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for what is near a contact");
    }
    free(b->bonds);
    free(b->stiffness);
    b->bond_capacity = 2 * n;
    b->bonds = bonds;
    b->stiffness = reals;
    b->rest_length = reals + 2 * n;
    b->dx = reals + 4 * n;
    b->dy = reals + 6 * n;
    b->pull = reals + 8 * n;
    return DEM_OK;
}

/* Lists the springs of a node, but those listed from their other end. */
static void add_bonds(neighbourhood *b, dem_index j)
{
    const springs *s = &b->acting->model->springs;
    const dem_index i = b->nodes[j].i;
    const unsigned char *broken = element_state_springs(element_state_at(b->acting->elements, i));
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const int32_t other = b->number[s->neighbour[p]];
        if (other < j || springs_broken(s, broken, p)) continue;
        b->bonds[b->n_bonds] = (neighbourhood_bond){(int32_t)j, other};
        b->stiffness[b->n_bonds] = s->stiffness[p];
        b->rest_length[b->n_bonds++] = s->rest_length[p];
    }
}

static dem_status list_bonds(neighbourhood *b)
{
    const springs *s = &b->acting->model->springs;
    dem_index most = 0;
    for (dem_index j = 0; j < b->end[b->n_rings - 1]; j++) most += s->row[b->nodes[j].i + 1] - s->row[b->nodes[j].i];
    TRY(reserve_bonds(b, most));
    b->n_bonds = 0;
    for (int ring = 0; ring < b->n_rings; ring++) {
        for (dem_index j = ring > 0 ? b->end[ring - 1] : 0; j < b->end[ring]; j++) add_bonds(b, j);
        b->bonds_end[ring] = b->n_bonds;
    }
    return DEM_OK;
}

dem_status neighbourhood_gather(neighbourhood *b, const dem_index *seeds, dem_index n_seeds)
{
    for (dem_index j = 0; j < b->n; j++) b->number[b->nodes[j].i] = -1;
    b->n = b->n_groups = 0;
    for (dem_index j = 0; j < n_seeds; j++) TRY(add_node(b, seeds[j]));
    TRY(close_ring(b, 0));
    for (int ring = 1; ring <= b->n_rings; ring++) {
        const dem_index first = ring > 1 ? b->end[ring - 2] : 0, last = b->end[ring - 1];
        for (dem_index j = first; j < last; j++) TRY(add_neighbours(b, b->nodes[j].i));
        TRY(close_ring(b, ring));
    }
    return b->plain ? list_bonds(b) : DEM_OK;
}

dem_status neighbourhood_regroup(neighbourhood *b)
{
    bool is_new;
    b->n_groups = 0;
    for (int ring = 0; ring < b->n_rings; ring++)
        for (dem_index j = ring > 0 ? b->end[ring - 1] : 0; j < b->end[ring]; j++) {
            const dem_index group = constraints_group_at(b->constraints, b->nodes[j].i);
            b->nodes[j].grouped = group >= 0;
            if (group >= 0) TRY(note_group(b, group, ring, &is_new));
        }
    return DEM_OK;
}

/* ---- accelerations ---- */

void neighbourhood_put(const neighbourhood *b, const neighbourhood_state *s, dem_index n)
{
    double *v = s->y + state_velocities(&b->layout);
    for (dem_index j = 0; j < n; j++) {
        vec2_put(s->y, b->nodes[j].i, vec2_at(s->x, j));
        vec2_put(v, b->nodes[j].i, vec2_at(s->v, j));
    }
}

/* Forces (1) of springs on the nodes of some rings; f [n][2] has room for one ring more. Compilers make vector
 * instructions of the loop in the middle. */
static void pull(const neighbourhood *b, int rings, const double *x, double *f)
{
    const dem_index n = b->bonds_end[rings];
    double *restrict dx = b->dx, *restrict dy = b->dy, *restrict factor = b->pull;
    for (dem_index k = 0; k < n; k++) {
        const vec2 d = vec2_sub(vec2_at(x, b->bonds[k].second), vec2_at(x, b->bonds[k].first));
        dx[k] = d.x;
        dy[k] = d.y;
    }
    for (dem_index k = 0; k < n; k++)
        factor[k] = springs_pull(b->stiffness[k], b->rest_length[k], sqrt(dx[k] * dx[k] + dy[k] * dy[k]));
    memset(f, 0, 2 * (size_t)b->end[rings + 1] * sizeof *f);
    for (dem_index k = 0; k < n; k++) {
        const neighbourhood_bond bond = b->bonds[k];
        const vec2 force = {factor[k] * dx[k], factor[k] * dy[k]};
        vec2_put(f, bond.first, vec2_add(vec2_at(f, bond.first), force));
        vec2_put(f, bond.second, vec2_sub(vec2_at(f, bond.second), force));
    }
}

static void accelerate_plain(const neighbourhood *b, int rings, const neighbourhood_state *s, double *a)
{
    const forces *f = b->acting;
    pull(b, rings, s->x, a);
    for (dem_index j = 0; j < b->end[rings]; j++)
        vec2_put(a, j, forces_acceleration_by(f, b->nodes[j].i, vec2_at(a, j), vec2_at(s->v, j)));
}

void neighbourhood_push(const neighbourhood *b, int rings, double t, const double *x, const double *v)
{
    external_force *c = b->acting->external;
    if (c == NULL) return;
    for (dem_index j = 0; j < b->end[rings]; j++) c->some[j] = b->nodes[j].i;
    external_force_evaluate(c, &(dem_force_query){t, b->end[rings], c->some, x, v});
}

void neighbourhood_accelerate(neighbourhood *b, int rings, const neighbourhood_state *s, double *a)
{
    const forces *f = b->acting;
    const constraints *c = b->constraints;
    const double *v = s->y + state_velocities(&b->layout);
    if (b->plain) accelerate_plain(b, rings, s, a);
    for (dem_index j = 0; j < b->end[rings] && !b->plain; j++)
        vec2_put(a, j, forces_own_acceleration(f, b->nodes[j].i, s->y, v));
    neighbourhood_push(b, rings, v[f->clock], s->x, s->v);
    for (dem_index j = 0; j < b->end[rings] && f->external != NULL; j++)
        vec2_put(a, j, forces_with_external(f, b->nodes[j].i, vec2_at(a, j), vec2_at(f->external->value, j)));
    for (dem_index g = 0; g < b->n_groups; g++)
        if (b->groups[g].ring <= rings) c->solve(c->self, b->groups[g].group, (constraint_state){s->t, s->y});
    for (dem_index j = 0; j < b->end[rings] && b->n_groups > 0; j++)
        if (b->nodes[j].grouped) vec2_put(a, j, vec2_at(c->a, b->nodes[j].i));
}
