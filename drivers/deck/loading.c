/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes are chosen in the body's own coordinates, in its rest shape; values are along the axes of space. */
#include "loading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "conditional_keys.h"
#include "material.h"
#include "slab_nodes.h"

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

/* A group with the body that it is about, and the nodes that it chooses. */
struct loading_target {
    const schema_instance *group;
    const placement *body; /* by numbers of the whole */
    double reach;          /* m, half the shortest spring of the body: what counts as its outermost nodes */
    double most;           /* m, how far out the outermost is, of a side */
    double sum;            /* m^2, of shares */
    dem_index *nodes;      /* [n] by numbers of the whole, */
    double *share;         /* [n] m^2, of a traction */
    dem_index n, node_room, share_room;
};

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

/* Which coordinate defines a side, and in which sense it grows outwards. */
static void side_axis(const schema_instance *group, int *axis, double *sense)
{
    *axis = is(group, "side", "top") || is(group, "side", "bottom");
    *sense = is(group, "side", "right") || is(group, "side", "top") ? 1.0 : -1.0;
}

/* Of the nodes that a lattice has of a body. */
static double outermost(const dem_lattice *lattice, const placement *body, const schema_instance *group)
{
    int axis;
    double most = -(double)INFINITY, own[2], sense;
    side_axis(group, &axis, &sense);
    for (dem_index i = body->first; i < body->first + body->n_nodes; i++) {
        placement_own(body, lattice->x + 2 * i, own);
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

/* Whether a place of the body in space is one that the group names. */
static bool is_there(const loading_target *t, const double x[2])
{
    const schema_instance *group = t->group;
    const double slack = blur * t->reach;
    double own[2], sense;
    int axis;
    placement_own(t->body, x, own);
    side_axis(group, &axis, &sense);
    if (is(group, "where", "side")) return sense * own[axis] >= t->most - t->reach - slack;
    if (is(group, "where", "box")) return in_box(own, reals_of(group, "box"), slack);
    if (is(group, "where", "all")) return true;
    const double *centre = reals_of(group, "centre");
    return hypot(own[0] - centre[0], own[1] - centre[1]) <= schema_real(group, "radius") + slack;
}

/* Nodes of a slab, those of its rim, too. \return how many; \param[out] list  [n_nodes] */
static dem_index choose(const loading_target *t, dem_index *list, const dem_slab *slab)
{
    dem_index n = 0;
    for (dem_index i = 0; i < slab->lattice.n_nodes; i++) {
        const dem_index number = slab_nodes_number(slab, i) - t->body->first;
        if (number >= 0 && number < t->body->n_nodes && is_there(t, slab->lattice.x + 2 * i)) list[n++] = i;
    }
    return n;
}

static bool append_node(loading_target *t, dem_index number, double share)
{
    if (!grow_array((void **)&t->nodes, &t->node_room, t->n + 1, sizeof *t->nodes) ||
        !grow_array((void **)&t->share, &t->share_room, t->n + 1, sizeof *t->share))
        return false;
    t->nodes[t->n] = number;
    t->share[t->n++] = share;
    t->sum += share;
    return true;
}

/* Nodes of a list, numbered within the body from 0 as in its lattice file; a fault where one is not there. */
static bool take_list(loading_target *t, namelist_errors *errors)
{
    const schema_value *list = schema_value_of(t->group, "nodes");
    for (int k = 0; k < list->count; k++) {
        const double number = list->reals[k];
        for (int q = 0; q < k; q++)
            if (list->reals[q] == number) {
                namelist_errors_add(errors, list->place, "'nodes' in &boundary has node %.0f twice", number);
                return true;
            }
        if (number >= (double)t->body->n_nodes) {
            namelist_errors_add(errors, list->place, "'nodes' in &boundary has node %.0f; the body has nodes 0 to %lld",
                                number, (long long)t->body->n_nodes - 1);
            return true;
        }
        if (!append_node(t, t->body->first + (dem_index)number, 0.0)) return false;
    }
    return true;
}

/* ---- what is done to them ---- */

/* Shares of a traction, m^2: by the edges' lengths, of a side by what they have along it. An own node has all of its
 * edges in the slab. */
static bool share_traction(const loading_target *t, double *share, const dem_slab *slab, const dem_index *list,
                           dem_index n)
{
    const double angle = t->body->angle, along[2] = {cos(angle), sin(angle)}, across[2] = {-sin(angle), cos(angle)};
    const double *direction = NULL;
    int axis;
    double sense;
    side_axis(t->group, &axis, &sense);
    if (is(t->group, "where", "side")) direction = axis == 1 ? along : across;
    return dem_lattice_edge_shares(&slab->lattice, list, n, direction, share) == DEM_OK;
}

/* \param list, share  [n_nodes] room */
static bool look(loading_target *t, const dem_slab *slab, dem_index *list, double *share)
{
    const dem_index n = is(t->group, "where", "list") ? 0 : choose(t, list, slab);
    bool good = true;
    for (dem_index k = 0; k < n; k++) share[k] = 0.0;
    if (n > 0 && is(t->group, "kind", "traction")) good = share_traction(t, share, slab, list, n);
    for (dem_index k = 0; k < n && good; k++)
        if (slab_nodes_own(slab, list[k])) good = append_node(t, slab_nodes_number(slab, list[k]), share[k]);
    return good;
}

bool loading_look(loading_search *s, const dem_slab *slab)
{
    const size_t room = (size_t)slab->lattice.n_nodes + 1;
    dem_index *list = malloc(room * sizeof *list);
    double *share = malloc(room * sizeof *share);
    bool good = list != NULL && share != NULL;
    for (size_t k = 0; k < s->n && good; k++) good = look(&s->targets[k], slab, list, share);
    free(list);
    free(share);
    return good;
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

bool loading_begin(loading_search *out, const schema_deck *groups, const placement *bodies, const dem_lattice *outline,
                   const placement *outlines)
{
    const size_t n = schema_count(groups, "boundary");
    *out = (loading_search){.groups = groups, .n = n, .targets = calloc(n + 1, sizeof *out->targets)};
    for (size_t k = 0; k < n && out->targets != NULL; k++) {
        const schema_instance *group = schema_get(groups, "boundary", k);
        const size_t body = (size_t)schema_real(group, "body") - 1;
        out->targets[k] =
            (loading_target){.group = group, .body = &bodies[body], .reach = reach_of(outline, &outlines[body])};
        if (is(group, "where", "side")) out->targets[k].most = outermost(outline, &outlines[body], group);
    }
    return out->targets != NULL;
}

static dem_boundary boundary_of(const loading_target *t)
{
    const double *value = is(t->group, "kind", "fix") ? NULL : reals_of(t->group, schema_text(t->group, "kind"));
    dem_boundary b = {.struct_size = sizeof(dem_boundary),
                      .kind = kind_of(t->group),
                      .components = components_of(t->group),
                      .ramp = schema_real(t->group, "ramp")};
    for (int c = 0; c < 2 && value != NULL; c++) b.value[c] = value[c];
    return b;
}

static void check_found(const loading_target *t, namelist_errors *errors)
{
    if (t->n == 0)
        namelist_errors_add(errors, place_of(t->group, "where"),
                            "&boundary chooses no node of body %.0f: places are in the body's own coordinates",
                            schema_real(t->group, "body"));
    else if (is(t->group, "kind", "traction") && !(t->sum > 0.0))
        namelist_errors_add(errors, place_of(t->group, "where"),
                            "&boundary chooses no edge of body %.0f for its traction: both nodes of one must be chosen",
                            schema_real(t->group, "body"));
}

/* Memory is the only thing that ends this; faults leave a boundary with the nodes that it has. */
static bool finish(dem_boundary *out, loading_target *t, namelist_errors *errors)
{
    *out = boundary_of(t);
    if (is(t->group, "where", "list")) {
        if (!take_list(t, errors)) return false;
    } else {
        check_found(t, errors);
    }
    out->n_nodes = t->n;
    out->nodes = t->nodes;
    t->nodes = NULL;
    if (!is(t->group, "kind", "traction")) return true;
    out->share = t->share;
    t->share = NULL;
    return true;
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
static bool check_motions(const dem_boundary *list, const loading_search *s, const dem_slab *whole,
                          namelist_errors *errors)
{
    const double *x = whole->lattice.x;
    size_t *owner = calloc(2 * (size_t)whole->n_nodes + 1, sizeof *owner);
    for (size_t k = 0; k < s->n && owner != NULL; k++) {
        dem_index i = 0;
        const size_t other = list[k].kind == DEM_BOUNDARY_FORCE ? 0 : take_components(&list[k], k + 1, owner, &i);
        if (other == 0) continue;
        namelist_errors_add(errors, schema_get(s->groups, "boundary", k)->place,
                            "&boundary prescribes the motion of node %lld at (%g, %g) m, as the one in line %d does",
                            (long long)i, x != NULL ? x[2 * i] : 0.0, x != NULL ? x[2 * i + 1] : 0.0,
                            schema_get(s->groups, "boundary", other - 1)->place.line);
    }
    free(owner);
    return owner != NULL;
}

bool loading_end(dem_boundary **list, dem_index *n, loading_search *s, const dem_slab *whole, namelist_errors *errors)
{
    bool good = true;
    *n = 0;
    *list = calloc(s->n + 1, sizeof **list);
    for (size_t k = 0; k < s->n && *list != NULL && good; k++) good = finish(&(*list)[(*n)++], &s->targets[k], errors);
    return good && *list != NULL && check_motions(*list, s, whole, errors);
}

void loading_forget(loading_search *s)
{
    for (size_t k = 0; k < s->n && s->targets != NULL; k++) {
        free(s->targets[k].nodes);
        free(s->targets[k].share);
    }
    free(s->targets);
    *s = (loading_search){0};
}

bool loading_hold(dem_lattice *lattice, const dem_boundary *list, dem_index n)
{
    for (dem_index k = 0; k < n; k++)
        if (list[k].kind != DEM_BOUNDARY_FORCE &&
            dem_lattice_exclude(lattice, list[k].nodes, list[k].n_nodes) != DEM_OK)
            return false;
    return true;
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
