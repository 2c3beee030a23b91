/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes are chosen in the body's own coordinates, in its rest shape; values are along the axes of space. */
#include "loading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "conditional_keys.h"
#include "material.h"

static const conditional_key where_keys[] = {{"side", "side", true},
                                             {"box", "box", true},
                                             {"centre", "disc", true},
                                             {"radius", "disc", true},
                                             {"nodes", "list", true}};
static const conditional_key kind_keys[] = {{"components", "fix, velocity, displacement", false},
                                            {"velocity", "velocity", true},
                                            {"displacement", "displacement", true},
                                            {"force", "force", true},
                                            {"traction", "traction", true},
                                            {"ramp", "velocity, displacement, force, traction", false}};
static const conditional_keys by_where = {"boundary", "where", sizeof where_keys / sizeof *where_keys, where_keys};
static const conditional_keys by_kind = {"boundary", "kind", sizeof kind_keys / sizeof *kind_keys, kind_keys};

/* A group with the body that it is about. */
typedef struct target {
    const schema_instance *group;
    const placement *body;
    const dem_lattice *lattice;
    double reach; /* m, half the shortest spring of the body: what counts as its outermost nodes */
} target;

static namelist_place place_of(const schema_instance *group, const char *key)
{
    return schema_value_of(group, key)->place;
}

static const double *reals_of(const schema_instance *group, const char *key)
{
    return schema_value_of(group, key)->reals;
}

static bool is(const schema_instance *group, const char *key, const char *word)
{
    return strcmp(schema_text(group, key), word) == 0;
}

/* ---- checks ---- */

static void check_kind(const schema_instance *group, namelist_errors *errors)
{
    const schema_value *ramp = schema_value_of(group, "ramp");
    if (is(group, "kind", "displacement") && !ramp->faulty && !(schema_real(group, "ramp") > 0.0))
        namelist_errors_add(errors, ramp->given ? ramp->place : group->place,
                            "'ramp' in &boundary must be > 0 for kind 'displacement'");
    if (is(group, "kind", "traction") && is(group, "where", "list"))
        namelist_errors_add(errors, place_of(group, "where"),
                            "kind 'traction' in &boundary needs edges: 'where' must be 'side', 'box', 'disc' or 'all'");
}

static void check_box(const schema_instance *group, namelist_errors *errors)
{
    const schema_value *box = schema_value_of(group, "box");
    if (box->count == 4 && !box->faulty && (box->reals[0] > box->reals[2] || box->reals[1] > box->reals[3]))
        namelist_errors_add(errors, box->place, "'box' in &boundary must be its lower left and its upper right corner");
}

void loading_check_all(const schema_deck *groups, namelist_errors *errors)
{
    const size_t n_bodies = schema_count(groups, "body");
    for (size_t k = 0; k < schema_count(groups, "boundary"); k++) {
        const schema_instance *group = schema_get(groups, "boundary", k);
        const double body = schema_real(group, "body");
        conditional_keys_check(group, &by_where, errors);
        conditional_keys_check(group, &by_kind, errors);
        check_kind(group, errors);
        check_box(group, errors);
        if (body > (double)n_bodies && n_bodies > 0)
            namelist_errors_add(errors, place_of(group, "body"), "there is no body %.0f: the deck has %zu", body,
                                n_bodies);
    }
}

void loading_drop_unused(schema_deck *groups)
{
    conditional_keys_drop(groups, &by_where);
    conditional_keys_drop(groups, &by_kind);
}

/* ---- choosing nodes ---- */

/* Rest position in the body's own coordinates. */
static void own_place(const target *t, dem_index i, double own[2])
{
    placement_own(t->body, t->lattice->x + 2 * i, own);
}

/* Which coordinate defines a side, and in which sense it grows outwards. */
static void side_axis(const schema_instance *group, int *axis, double *sense)
{
    *axis = is(group, "side", "top") || is(group, "side", "bottom");
    *sense = is(group, "side", "right") || is(group, "side", "top") ? 1.0 : -1.0;
}

static double outermost(const target *t, int axis, double sense)
{
    double most = -(double)INFINITY, own[2];
    for (dem_index i = t->body->first; i < t->body->first + t->body->n_nodes; i++) {
        own_place(t, i, own);
        most = fmax(most, sense * own[axis]);
    }
    return most;
}

static bool in_box(const double own[2], const double *box, double slack)
{
    return own[0] >= box[0] - slack && own[0] <= box[2] + slack && own[1] >= box[1] - slack && own[1] <= box[3] + slack;
}

/* Rounding of the way back to own coordinates must not decide. */
static const double blur = 1e-6;

static bool chosen(const target *t, dem_index i, int axis, double sense, double most)
{
    const schema_instance *group = t->group;
    const double slack = blur * t->reach;
    double own[2];
    own_place(t, i, own);
    if (is(group, "where", "side")) return sense * own[axis] >= most - t->reach - slack;
    if (is(group, "where", "box")) return in_box(own, reals_of(group, "box"), slack);
    if (is(group, "where", "all")) return true;
    const double *centre = reals_of(group, "centre");
    return hypot(own[0] - centre[0], own[1] - centre[1]) <= schema_real(group, "radius") + slack;
}

/* Nodes of a list, numbered within the body from 0 as in its lattice file; false where one is not there. */
static bool take_list(const target *t, dem_index *nodes, dem_index *n, namelist_errors *errors)
{
    const schema_value *list = schema_value_of(t->group, "nodes");
    for (int k = 0; k < list->count; k++) {
        const double number = list->reals[k];
        for (int q = 0; q < k; q++)
            if (list->reals[q] == number) {
                namelist_errors_add(errors, list->place, "'nodes' in &boundary has node %.0f twice", number);
                return false;
            }
        if (number >= (double)t->body->n_nodes) {
            namelist_errors_add(errors, list->place, "'nodes' in &boundary has node %.0f; the body has nodes 0 to %lld",
                                number, (long long)t->body->n_nodes - 1);
            return false;
        }
        nodes[(*n)++] = t->body->first + (dem_index)number;
    }
    return true;
}

/* Fills nodes; false for a fault. */
static bool take_nodes(const target *t, dem_index *nodes, dem_index *n, namelist_errors *errors)
{
    int axis = 0;
    double sense = 1.0;
    *n = 0;
    if (is(t->group, "where", "list")) return take_list(t, nodes, n, errors);
    if (is(t->group, "where", "side")) side_axis(t->group, &axis, &sense);
    const double most = outermost(t, axis, sense);
    for (dem_index i = t->body->first; i < t->body->first + t->body->n_nodes; i++)
        if (chosen(t, i, axis, sense, most)) nodes[(*n)++] = i;
    if (*n > 0) return true;
    namelist_errors_add(errors, place_of(t->group, "where"),
                        "&boundary chooses no node of body %.0f: places are in the body's own coordinates",
                        schema_real(t->group, "body"));
    return false;
}

/* ---- what is done to them ---- */

/* Shares of a traction, m^2: by the edges' lengths, of a side by what they have along it. */
static bool share_traction(const target *t, const dem_boundary *b, double *share, namelist_errors *errors)
{
    const double angle = t->body->angle, along[2] = {cos(angle), sin(angle)}, across[2] = {-sin(angle), cos(angle)};
    const double *direction = NULL;
    int axis = 0;
    double sense, sum = 0.0;
    if (is(t->group, "where", "side")) {
        side_axis(t->group, &axis, &sense);
        direction = axis == 1 ? along : across;
    }
    if (dem_lattice_edge_shares(t->lattice, b->nodes, b->n_nodes, direction, share) != DEM_OK) return false;
    for (dem_index k = 0; k < b->n_nodes; k++) sum += share[k];
    if (!(sum > 0.0))
        namelist_errors_add(errors, place_of(t->group, "where"),
                            "&boundary chooses no edge of body %.0f for its traction: both nodes of one must be chosen",
                            schema_real(t->group, "body"));
    return true;
}

static dem_boundary_kind kind_of(const schema_instance *group)
{
    if (is(group, "kind", "displacement")) return DEM_BOUNDARY_DISPLACEMENT;
    return is(group, "kind", "force") || is(group, "kind", "traction") ? DEM_BOUNDARY_FORCE : DEM_BOUNDARY_VELOCITY;
}

static int32_t components_of(const schema_instance *group)
{
    if (is(group, "components", "x")) return DEM_COMPONENT_X;
    return is(group, "components", "y") ? DEM_COMPONENT_Y : DEM_COMPONENT_X | DEM_COMPONENT_Y;
}

/* Memory is the only thing that ends this; faults leave a boundary without nodes. */
static bool build_one(dem_boundary *out, const target *t, dem_lattice *lattice, namelist_errors *errors)
{
    const double *value = is(t->group, "kind", "fix") ? NULL : reals_of(t->group, schema_text(t->group, "kind"));
    dem_index *nodes = malloc((size_t)t->body->n_nodes * sizeof *nodes);
    *out = (dem_boundary){.struct_size = sizeof(dem_boundary),
                          .kind = kind_of(t->group),
                          .components = components_of(t->group),
                          .nodes = nodes,
                          .ramp = schema_real(t->group, "ramp")};
    for (int c = 0; c < 2 && value != NULL; c++) out->value[c] = value[c];
    if (nodes == NULL) return false;
    if (!take_nodes(t, nodes, &out->n_nodes, errors)) return true;
    if (is(t->group, "kind", "traction")) {
        double *share = malloc((size_t)out->n_nodes * sizeof *share);
        out->share = share;
        return share != NULL && share_traction(t, out, share, errors);
    }
    if (out->kind == DEM_BOUNDARY_FORCE) return true;
    return dem_lattice_exclude(lattice, nodes, out->n_nodes) == DEM_OK;
}

/* Half the shortest spring of a body, m. */
static double reach_of(const dem_lattice *lattice, const placement *body)
{
    double shortest = (double)INFINITY;
    for (dem_index k = 0; k < lattice->n_springs; k++) {
        const dem_index i = lattice->ends[2 * k];
        if (i >= body->first && i < body->first + body->n_nodes) shortest = fmin(shortest, lattice->rest_length[k]);
    }
    return isfinite(shortest) ? 0.5 * shortest : 0.0;
}

/* The boundary, from 1, that a component of one of b's nodes has already, and that node; or 0, and b has them now. */
static size_t take_components(const dem_boundary *b, size_t number, size_t *owner, dem_index *node)
{
    for (dem_index p = 0; p < b->n_nodes; p++)
        for (int c = 0; c < 2; c++) {
            size_t *const mine = &owner[2 * b->nodes[p] + c];
            if (!(b->components & (DEM_COMPONENT_X << c))) continue;
            *node = b->nodes[p];
            if (*mine != 0) return *mine;
            *mine = number;
        }
    return 0;
}

/* No component has two motions. */
static bool check_motions(const dem_boundary *list, size_t n, const dem_lattice *lattice, const schema_deck *groups,
                          namelist_errors *errors)
{
    size_t *owner = calloc(2 * (size_t)lattice->n_nodes + 1, sizeof *owner);
    for (size_t k = 0; k < n && owner != NULL; k++) {
        dem_index i = 0;
        const size_t other = list[k].kind == DEM_BOUNDARY_FORCE ? 0 : take_components(&list[k], k + 1, owner, &i);
        if (other == 0) continue;
        namelist_errors_add(errors, schema_get(groups, "boundary", k)->place,
                            "&boundary prescribes the motion of node %lld at (%g, %g) m, as the one in line %d does",
                            (long long)i, lattice->x[2 * i], lattice->x[2 * i + 1],
                            schema_get(groups, "boundary", other - 1)->place.line);
    }
    free(owner);
    return owner != NULL;
}

bool loading_build(dem_boundary **list, dem_index *n, dem_lattice *lattice, const placement *bodies,
                   const schema_deck *groups, namelist_errors *errors)
{
    const size_t count = schema_count(groups, "boundary");
    *n = 0;
    *list = calloc(count + 1, sizeof **list);
    for (size_t k = 0; *list != NULL && k < count; k++) {
        const schema_instance *group = schema_get(groups, "boundary", k);
        const placement *body = &bodies[(size_t)schema_real(group, "body") - 1];
        const target t = {group, body, lattice, reach_of(lattice, body)};
        const bool good = build_one(&(*list)[(*n)++], &t, lattice, errors);
        if (!good) return false;
    }
    return *list != NULL && check_motions(*list, count, lattice, groups, errors);
}

bool loading_asked(double force[2], const schema_deck *groups, size_t k)
{
    if (k >= schema_count(groups, "boundary")) return false;
    const schema_instance *group = schema_get(groups, "boundary", k);
    if (!is(group, "kind", "traction") || !is(group, "where", "side")) return false;
    const schema_instance *body = schema_get(groups, "body", (size_t)schema_real(group, "body") - 1);
    if (!is(body, "shape", "rectangle")) return false;
    int axis;
    double sense;
    side_axis(group, &axis, &sense);
    const double length = reals_of(body, "size")[1 - axis], area = length * material_of(groups, body).thickness;
    for (int c = 0; c < 2; c++) force[c] = area * reals_of(group, "traction")[c];
    return true;
}

void loading_free(dem_boundary *list, dem_index n)
{
    for (dem_index k = 0; k < n; k++) {
        free((void *)list[k].nodes);
        free((void *)list[k].share);
    }
    free(list);
}
