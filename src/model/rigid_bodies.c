/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds the rigid bodies of a lattice, and measures means and moments over them. A body is rigid as a whole: all of its
 * nodes have the same flags, none is fixed, and places and velocities are those of a rigid motion. How forces move such
 * a body is in forces/rigid_motion.c. */
#include "model/rigid_bodies.h"

#include <stdlib.h>

#include "base/exact_sum.h"
#include "base/status.h"

/* Of the flags of a node, those that all nodes of a body have in common. */
enum { GUIDES = DEM_NODE_GUIDE_X | DEM_NODE_GUIDE_Y, COMMON = DEM_NODE_RIGID | GUIDES };

/* Over the size of the body, or its largest speed: what counts as rigid. Callers compute with rounding. */
static const double tolerance = 1e-9;

/* ---- sums over a body ---- */

/* Number k of the vectors of one body: they are listed by nodes, or in the order of the body (`nodes` NULL). */
typedef struct vector_list {
    const dem_index *nodes;
    const double *at;
    vec2 less;
} vector_list;

static vec2 vector_of(const vector_list *l, dem_index k)
{
    return vec2_sub(vec2_at(l->at, l->nodes != NULL ? l->nodes[k] : k), l->less);
}

/* Sum of m a.b, or of m a x b. */
static double sum_products(const rigid_body *b, bool crossed, vector_list first, vector_list second)
{
    exact_sum sum = {0};
    double terms[EXACT_SUM_BLOCK];
    for (dem_index begin = 0; begin < b->n_nodes; begin += EXACT_SUM_BLOCK) {
        const int n = exact_sum_block(begin, b->n_nodes);
        for (int q = 0; q < n; q++) {
            const vec2 p = vector_of(&first, begin + q), w = vector_of(&second, begin + q);
            terms[q] = b->masses[begin + q] * (crossed ? vec2_cross(p, w) : vec2_dot(p, w));
        }
        exact_sum_take(&sum, terms, n);
    }
    return exact_sum_value(&sum);
}

static double sum_masses(const rigid_body *b)
{
    exact_sum sum = {0};
    exact_sum_add_array(&sum, b->masses, b->n_nodes);
    return exact_sum_value(&sum);
}

/* Mean of vectors by mass. */
static vec2 mean_of(const rigid_body *b, vector_list vectors)
{
    exact_sum sum[2] = {0};
    double terms[2][EXACT_SUM_BLOCK];
    for (dem_index begin = 0; begin < b->n_nodes; begin += EXACT_SUM_BLOCK) {
        const int n = exact_sum_block(begin, b->n_nodes);
        for (int q = 0; q < n; q++) {
            const vec2 a = vector_of(&vectors, begin + q);
            terms[0][q] = b->masses[begin + q] * a.x;
            terms[1][q] = b->masses[begin + q] * a.y;
        }
        for (int c = 0; c < 2; c++) exact_sum_take(&sum[c], terms[c], n);
    }
    return (vec2){exact_sum_value(&sum[0]) / b->mass, exact_sum_value(&sum[1]) / b->mass};
}

vec2 rigid_body_mean(const rigid_body *b, const double *vectors)
{
    const vec2 middle = vec2_at(vectors, b->middle);
    return vec2_add(middle, mean_of(b, (vector_list){b->nodes, vectors, middle}));
}

static vector_list by_nodes(const rigid_body *b, rigid_vectors v)
{
    return (vector_list){b->nodes, v.at, v.less};
}

double rigid_body_dot(const rigid_body *b, rigid_vectors first, rigid_vectors second)
{
    return sum_products(b, false, by_nodes(b, first), by_nodes(b, second));
}

double rigid_body_cross(const rigid_body *b, rigid_vectors first, rigid_vectors second)
{
    return sum_products(b, true, by_nodes(b, first), by_nodes(b, second));
}

/* ---- where it is and how it moves ---- */

/* Turned by the angle q, the shape s is as near as possible to the places r about the centre if the sum of
 * m (R(q) s).r is as large as possible: cos q is to sin q as the sum of m s.r is to that of m s x r. */
pose rigid_body_pose(const rigid_body *b, const double *x)
{
    const vec2 centre = rigid_body_mean(b, x);
    const vector_list shape = {NULL, b->shape, {0.0, 0.0}}, places = {b->nodes, x, centre};
    const vec2 along = {sum_products(b, false, shape, places), sum_products(b, true, shape, places)};
    return (pose){.centre = centre, .axis = vec2_scale(1.0 / vec2_norm(along), along)};
}

static double size_of(const rigid_body *b)
{
    double size = 0.0;
    for (dem_index k = 0; k < b->n_nodes; k++) size = fmax(size, vec2_norm(vec2_at(b->shape, k)));
    return size;
}

/* The worst node so far: that with the largest difference of two vectors, or with one that is not a number. */
typedef struct worst_node {
    dem_index node;
    double off;
} worst_node;

static void compare(worst_node *worst, dem_index node, vec2 a, vec2 b)
{
    const double off = vec2_norm(vec2_sub(a, b));
    if (!(off <= worst->off)) *worst = (worst_node){node, off};
}

static dem_index judge(const worst_node *worst, double scale)
{
    return worst->off <= tolerance * scale ? -1 : worst->node;
}

dem_index rigid_body_misplaced(const rigid_body *b, const double *x)
{
    const pose at = rigid_body_pose(b, x);
    worst_node worst = {-1, 0.0};
    for (dem_index k = 0; k < b->n_nodes; k++)
        compare(&worst, b->nodes[k], vec2_at(x, b->nodes[k]), pose_outside(&at, vec2_at(b->shape, k)));
    return judge(&worst, size_of(b));
}

/* A guide lets nothing but the velocity along it through. */
dem_index rigid_body_deviating(const rigid_body *b, const double *x, const double *v)
{
    const vec2 mean = rigid_body_mean(b, v);
    const rigid_vectors places = {x, rigid_body_mean(b, x)}, velocities = {v, mean};
    pose at = {.centre = places.less, .velocity = mean};
    worst_node worst = {-1, 0.0};
    double fastest = 0.0;
    if (b->guide == DEM_GUIDE_NONE)
        at.spin = rigid_body_cross(b, places, velocities) / rigid_body_dot(b, places, places);
    else
        at.velocity = b->guide == DEM_GUIDE_X ? (vec2){mean.x, 0.0} : (vec2){0.0, mean.y};
    for (dem_index k = 0; k < b->n_nodes; k++) {
        const dem_index i = b->nodes[k];
        fastest = fmax(fastest, vec2_norm(vec2_at(v, i)));
        compare(&worst, i, vec2_at(v, i), pose_velocity(&at, vec2_at(x, i)));
    }
    return judge(&worst, fastest);
}

/* ---- compilation ---- */

static unsigned common_flags(const dem_lattice *l, dem_index node)
{
    return l->flags[node] & COMMON;
}

static dem_status check_node(const dem_lattice *l, dem_index node, dem_index first)
{
    const long long i = (long long)node, body = (long long)l->body[node];
    const unsigned flags = common_flags(l, node);
    CHECK(flags == common_flags(l, first), DEM_ERROR_MODEL,
          "node %lld has other flags of rigid bodies than node %lld: body %lld is rigid as a whole or not at all", i,
          (long long)first, body);
    CHECK(flags == 0 || flags & DEM_NODE_RIGID, DEM_ERROR_MODEL,
          "node %lld has a guide, but its body %lld is not rigid", i, body);
    CHECK((flags & GUIDES) != GUIDES, DEM_ERROR_MODEL, "node %lld: body %lld has a guide along x and one along y", i,
          body);
    CHECK(flags == 0 || !(l->flags[node] & DEM_NODE_FIXED), DEM_ERROR_MODEL,
          "node %lld is fixed, but its body %lld is rigid", i, body);
    return DEM_OK;
}

/* `first` [bodies] is filled with the first node of each body.  \return the first fault */
static dem_status check_nodes(const dem_lattice *l, dem_index *first)
{
    for (dem_index i = 0; i < l->n_nodes; i++) first[i] = -1;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        dem_index *of_body = &first[l->body[i]];
        if (*of_body < 0) *of_body = i;
        TRY(check_node(l, i, *of_body));
    }
    return DEM_OK;
}

static dem_guide guide_of(unsigned flags)
{
    if (flags & DEM_NODE_GUIDE_X) return DEM_GUIDE_X;
    return flags & DEM_NODE_GUIDE_Y ? DEM_GUIDE_Y : DEM_GUIDE_NONE;
}

static dem_status allocate(rigid_bodies *r, dem_index n_bodies, dem_index n_rigid, dem_index n_nodes)
{
    const size_t n = (size_t)n_rigid;
    r->n_nodes = n_rigid;
    r->list = calloc((size_t)n_bodies, sizeof *r->list);
    r->of_node = malloc((size_t)n_nodes * sizeof *r->of_node);
    r->nodes = malloc(n * sizeof *r->nodes);
    r->masses = malloc(n * sizeof *r->masses);
    r->shapes = malloc(2 * n * sizeof *r->shapes);
    CHECK(r->list && r->of_node && r->nodes && r->masses && r->shapes, DEM_ERROR_MEMORY,
          "out of memory for %lld rigid bodies", (long long)n_bodies);
    return DEM_OK;
}

/* Lists the rigid bodies. `first` [bodies] has the first node of each, and then its number in the list, or -1. */
static void list_bodies(rigid_bodies *r, const dem_lattice *l, dem_index *first)
{
    for (dem_index body = 0; body < l->n_nodes; body++) {
        const dem_index node = first[body];
        const unsigned flags = node >= 0 ? common_flags(l, node) : 0;
        first[body] = flags != 0 ? r->n : -1;
        if (flags != 0) r->list[r->n++] = (rigid_body){.number = body, .guide = guide_of(flags), .middle = node};
    }
    for (dem_index i = 0; i < l->n_nodes; i++) {
        r->of_node[i] = first[l->body[i]];
        if (r->of_node[i] >= 0) r->list[r->of_node[i]].n_nodes++;
    }
}

/* Each body has its part of the arrays, which is filled in the order of nodes. `next` [bodies of the list] says where
 * each goes on. */
static void list_nodes(rigid_bodies *r, const dem_lattice *l, dem_index *next)
{
    dem_index from = 0;
    for (dem_index k = 0; k < r->n; k++) {
        rigid_body *b = &r->list[k];
        b->nodes = r->nodes + from;
        b->masses = r->masses + from;
        b->shape = r->shapes + vec2_row(from);
        next[k] = from;
        from += b->n_nodes;
    }
    for (dem_index i = 0; i < l->n_nodes; i++) {
        if (r->of_node[i] < 0) continue;
        const dem_index at = next[r->of_node[i]]++;
        r->nodes[at] = i;
        r->masses[at] = l->mass[i];
        vec2_put(r->shapes, at, vec2_at(l->x, i));
    }
}

static dem_index nearest_to(const rigid_body *b, const double *x, vec2 place)
{
    dem_index nearest = b->nodes[0];
    for (dem_index k = 1; k < b->n_nodes; k++)
        if (vec2_norm(vec2_sub(vec2_at(x, b->nodes[k]), place)) < vec2_norm(vec2_sub(vec2_at(x, nearest), place)))
            nearest = b->nodes[k];
    return nearest;
}

/* Takes the mean from a shape. What rounding leaves of it would be a force in every step of a body that turns, so this
 * is done twice. */
static void centre_shape(const rigid_body *b, double *shape)
{
    const vector_list arms = {NULL, shape, {0.0, 0.0}};
    const vec2 mean = mean_of(b, arms);
    for (dem_index k = 0; k < b->n_nodes; k++) vec2_put(shape, k, vec2_sub(vec2_at(shape, k), mean));
}

/* Shapes hold the places at rest so far. */
static void measure(const rigid_bodies *r, rigid_body *b, const dem_lattice *l)
{
    double *shape = r->shapes + (b->shape - r->shapes);
    b->mass = sum_masses(b);
    b->middle = nearest_to(b, l->x, rigid_body_mean(b, l->x));
    centre_shape(b, shape);
    centre_shape(b, shape);
    const vector_list arms = {NULL, shape, {0.0, 0.0}};
    b->inertia = sum_products(b, false, arms, arms);
}

static dem_status check_motion(const rigid_body *b, const dem_lattice *l)
{
    CHECK(b->inertia > 0.0, DEM_ERROR_MODEL, "rigid body %lld has all its mass in one place", (long long)b->number);
    const dem_index misplaced = rigid_body_misplaced(b, l->position);
    CHECK(misplaced < 0, DEM_ERROR_MODEL,
          "the initial position (%g, %g) m of node %lld deforms its body %lld, which is rigid",
          l->position[2 * misplaced], l->position[2 * misplaced + 1], (long long)misplaced, (long long)b->number);
    const dem_index deviating = rigid_body_deviating(b, l->position, l->velocity);
    CHECK(deviating < 0, DEM_ERROR_MODEL,
          "the initial velocity (%g, %g) m/s of node %lld is not that of a rigid motion of its body %lld%s",
          l->velocity[2 * deviating], l->velocity[2 * deviating + 1], (long long)deviating, (long long)b->number,
          b->guide != DEM_GUIDE_NONE ? " along its guide" : "");
    return DEM_OK;
}

static dem_status compile(rigid_bodies *r, const dem_lattice *l, dem_index *first)
{
    dem_index n_bodies = 0, n_nodes = 0;
    TRY(check_nodes(l, first));
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const bool rigid = (l->flags[i] & DEM_NODE_RIGID) != 0;
        n_nodes += rigid;
        n_bodies += rigid && first[l->body[i]] == i;
    }
    if (n_bodies == 0) return DEM_OK;
    TRY(allocate(r, n_bodies, n_nodes, l->n_nodes));
    list_bodies(r, l, first);
    list_nodes(r, l, first);
    for (dem_index k = 0; k < r->n; k++) measure(r, &r->list[k], l);
    for (dem_index k = 0; k < r->n; k++) TRY(check_motion(&r->list[k], l));
    return DEM_OK;
}

dem_status rigid_bodies_compile(rigid_bodies *out, const dem_lattice *lattice)
{
    rigid_bodies r = {0};
    dem_index *first = malloc((size_t)lattice->n_nodes * sizeof *first);
    CHECK_MEMORY(first);
    const dem_status status = compile(&r, lattice, first);
    free(first);
    if (status == DEM_OK)
        *out = r;
    else
        rigid_bodies_free(&r);
    return status;
}

void rigid_bodies_link(rigid_bodies *r)
{
    dem_index first = 0;
    for (dem_index b = 0; b < r->n; b++) {
        r->list[b].nodes = r->nodes + first;
        r->list[b].masses = r->masses + first;
        r->list[b].shape = r->shapes + 2 * first;
        first += r->list[b].n_nodes;
    }
}

static void cut_bodies(rigid_bodies *r, const rigid_bodies *whole, const dem_index *number)
{
    for (dem_index k = 0; k < whole->n_nodes; k++) {
        r->nodes[k] = number[whole->nodes[k]];
        r->of_node[r->nodes[k]] = whole->of_node[whole->nodes[k]];
    }
    for (; r->n < whole->n; r->n++) {
        r->list[r->n] = whole->list[r->n];
        r->list[r->n].middle = number[whole->list[r->n].middle];
    }
    rigid_bodies_link(r);
}

dem_status rigid_bodies_cut(rigid_bodies *out, const rigid_bodies *whole, const dem_index *number, dem_index n_nodes)
{
    rigid_bodies r = {0};
    *out = r;
    if (whole->n == 0) return DEM_OK;
    const dem_status status = allocate(&r, whole->n, whole->n_nodes, n_nodes);
    if (status == DEM_OK) {
        for (dem_index i = 0; i < n_nodes; i++) r.of_node[i] = -1;
        memcpy(r.masses, whole->masses, (size_t)whole->n_nodes * sizeof *r.masses);
        memcpy(r.shapes, whole->shapes, 2 * (size_t)whole->n_nodes * sizeof *r.shapes);
        cut_bodies(&r, whole, number);
        *out = r;
    } else {
        rigid_bodies_free(&r);
    }
    return status;
}

void rigid_bodies_free(rigid_bodies *r)
{
    free(r->list);
    free(r->of_node);
    free(r->nodes);
    free(r->masses);
    free(r->shapes);
    *r = (rigid_bodies){0};
}
