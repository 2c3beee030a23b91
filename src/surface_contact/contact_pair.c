/* SPDX-License-Identifier: BSD-3-Clause */
/* One contact pair of the node p and the edge AB, with Z before A on the surface. With r = p - A, t = B - A, z = A - Z,
 * s = r.t/t.t and g = (r x t)/|t|, which is > 0 in front of the edge:
 *   edge:    0 <= s < 1 and 0 < g < delta: the potential at g, along the edge's normal (t_y, -t_x)/|t|;
 *   vertex:  |r| < delta: the potential at |r|, along r,
 *              once between two edges, r.z >= 0 and r.t < 0, outside a convex vertex, z x t > 0;
 *              taken off once beside both edges, r.z < 0 and r.t >= 0, in front of both, r x t > 0 and r x z > 0,
 *              or of one inside a concave vertex, z x t < 0, where a node of the same body may come if it is crushed;
 *              at the free end of a wall, z = -t, once beyond it, r.t < 0;
 *   an end beyond which the surface does not touch the node: taken off beside and in front of the edge alone.
 * A pair that fills a crack pushes while the node is nearer than the room r, the distance of the two when the triangle
 * broke, at most its height at rest: W = weight r (1 - g/r)^2/2 T(s). T is 1 in the middle of the edge and falls to 0
 * with its slope at both ends: T = q^2 (3 - 2 q), q = 4 s (1 - s), so that no force jumps where the faces slide along
 * each other.
 * s < 1 is computed as (p - B).t < 0, so that two edges and their vertex compare the same numbers: no node falls
 * between them by rounding. For the same reason a vertex that is straight but for rounding counts as convex for a node
 * in front of both edges. What is behind an edge is not pushed, so a body that is squeezed does not push itself from
 * inside. Which pairs there are is the business of pair_list.c. */
#include "surface_contact/contact_pair.h"

/* The vectors of a pair. */
typedef struct pair_vectors {
    vec2 r, t, z;
} pair_vectors;

static pair_vectors vectors_of(const contact_pair *p, const double *x)
{
    const vec2 node = vec2_at(x, p->nodes[CONTACT_PAIR_NODE]), a = vec2_at(x, p->nodes[CONTACT_PAIR_FIRST]);
    const vec2 b = vec2_at(x, p->nodes[CONTACT_PAIR_SECOND]), before = vec2_at(x, p->nodes[CONTACT_PAIR_BEFORE]);
    return (pair_vectors){vec2_sub(node, a), vec2_sub(b, a), vec2_sub(a, before)};
}

/* A free end, where the edge before is the other side of the edge: z = -t. Just beside it the edge pushes in front. */
static double free_end_count(const pair_vectors *v)
{
    const double along = vec2_dot(v->r, v->t);
    return along < 0.0 || (along == 0.0 && vec2_cross(v->r, v->t) <= 0.0) ? 1.0 : 0.0;
}

/* How often the first end counts for a node near it: 1, -1 or 0. */
static double vertex_count(const contact_pair *p, const double *x)
{
    const pair_vectors v = vectors_of(p, x);
    if (p->nodes[CONTACT_PAIR_BEFORE] == p->nodes[CONTACT_PAIR_SECOND]) return free_end_count(&v);
    const bool beside = vec2_dot(v.r, v.t) >= 0.0, beside_last = vec2_dot(v.r, v.z) < 0.0;
    if (p->ends_at_first) return beside && vec2_cross(v.r, v.t) > 0.0 ? -1.0 : 0.0;
    if (beside != beside_last) return 0.0;
    const int n_in_front = (vec2_cross(v.r, v.t) > 0.0) + (vec2_cross(v.r, v.z) > 0.0);
    const double turn = vec2_cross(v.z, v.t);
    if (beside) return n_in_front == 2 || (n_in_front == 1 && turn < 0.0) ? -1.0 : 0.0;
    return n_in_front == 2 || turn > 0.0 ? 1.0 : 0.0;
}

/* From an end of the edge to the node. */
static vec2 from_end(const contact_pair *p, int end, const double *x)
{
    return vec2_sub(vec2_at(x, p->nodes[CONTACT_PAIR_NODE]), vec2_at(x, p->nodes[end]));
}

/* Whether the second end is taken off: then the edge or its first end is near the node, too. */
static bool takes_off(const contact_pair *p, const double *x)
{
    if (!p->ends_at_second) return false;
    const vec2 r = from_end(p, CONTACT_PAIR_FIRST, x), end = from_end(p, CONTACT_PAIR_SECOND, x);
    const vec2 t = vec2_sub(vec2_at(x, p->nodes[CONTACT_PAIR_SECOND]), vec2_at(x, p->nodes[CONTACT_PAIR_FIRST]));
    return vec2_dot(end, t) < 0.0 && vec2_cross(r, t) > 0.0 && vec2_dot(end, end) < p->thickness * p->thickness;
}

/* Where the node is with respect to edge and vertex. */
typedef struct pair_place {
    double u_edge;   /* distance over thickness; 0: the edge does not push */
    double share;    /* s */
    double u_vertex; /* distance over thickness; 0: the vertex does not push */
    double count;    /* 1 or -1 */
    double u_second; /* distance over thickness; 0: the second end is not taken off */
} pair_place;

static bool find_place(const contact_pair *p, const double *x, pair_place *out)
{
    const edge_terms e = contact_pair_terms(p, x);
    *out = (pair_place){.count = e.near_first ? vertex_count(p, x) : 0.0};
    if (e.by_edge) {
        out->u_edge = e.front / sqrt(e.square) / p->thickness;
        out->share = e.along / e.square;
    }
    if (out->count != 0.0) out->u_vertex = sqrt(e.radius) / p->thickness;
    if (takes_off(p, x)) out->u_second = vec2_norm(from_end(p, CONTACT_PAIR_SECOND, x)) / p->thickness;
    return e.by_edge || out->count != 0.0 || out->u_second > 0.0;
}

/* ---- what fills a crack ---- */

typedef struct filling_place {
    double share, left;  /* s, 1 - g/r */
    double taper, slope; /* T and dT/ds */
    double gap, length;  /* m, g and |t| */
} filling_place;

static filling_place place_filling(const contact_pair *p, const edge_terms *e)
{
    const double length = sqrt(e->square), gap = e->front / length, s = e->along / e->square, q = 4.0 * s * (1.0 - s);
    return (filling_place){.share = s,
                           .left = 1.0 - gap / p->thickness,
                           .taper = q * q * (3.0 - 2.0 * q),
                           .slope = 24.0 * q * (1.0 - q) * (1.0 - 2.0 * s),
                           .gap = gap,
                           .length = length};
}

/* dW/dg acts along the normal n like any push by the edge. dW/ds acts along ds/dr = t/t.t on the node and
 * ds/dt = (g n - s t)/t.t on the second end. */
static bool push_filling(const contact_pair *p, const double *x, contact_push *out)
{
    const edge_terms e = contact_pair_terms(p, x);
    *out = (contact_push){.pair = p};
    if (!e.by_edge) return false;
    const filling_place at = place_filling(p, &e);
    const vec2 normal = {e.t.y / at.length, -e.t.x / at.length};
    const double along = 0.5 * p->weight * p->thickness * at.left * at.left * at.slope / e.square;
    const vec2 across = vec2_along(vec2_scale(at.gap, normal), -at.share, e.t);
    out->share = at.share;
    out->by_edge = vec2_scale(p->weight * at.left * at.taper, normal);
    out->by_second = vec2_scale(along, across);
    out->by_vertex = vec2_scale(-along, vec2_add(e.t, across));
    return true;
}

static double filling_energy(const contact_pair *p, const double *x)
{
    const edge_terms e = contact_pair_terms(p, x);
    if (!e.by_edge) return 0.0;
    const filling_place at = place_filling(p, &e);
    return 0.5 * p->weight * p->thickness * at.left * at.left * at.taper;
}

/* With T' of 3.5 and T'' of 24 at most; W is no larger than along the normal alone where the faces have not slid. */
static bool stiffen_filling(const contact_pair *p, const double *x, double added[CONTACT_PAIR_PUSHED])
{
    const edge_terms e = contact_pair_terms(p, x);
    if (!e.by_edge) return false;
    const filling_place at = place_filling(p, &e);
    const double slid = at.left * p->thickness / at.length;
    const double most = 2.0 * p->weight / p->thickness * (1.0 + 3.5 * slid + 12.0 * slid * slid);
    for (int which = 0; which < CONTACT_PAIR_PUSHED; which++) added[which] = most;
    return true;
}

/* ---- forces ---- */

/* The force on the node by an end that counts so often, N. */
static vec2 push_by_end(const contact_pair *p, int end, double count, const double *x)
{
    const vec2 r = from_end(p, end, x);
    const double distance = vec2_norm(r);
    return vec2_scale(count * p->weight * contact_potential_pressure(distance / p->thickness),
                      vec2_scale(1.0 / distance, r));
}

bool contact_pair_push_ends(const contact_pair *p, bool near_first, const double *x, contact_push *out)
{
    const double count = near_first ? vertex_count(p, x) : 0.0;
    const bool taken_off = takes_off(p, x);
    if (count != 0.0) out->by_vertex = push_by_end(p, CONTACT_PAIR_FIRST, count, x);
    if (taken_off) out->by_second = push_by_end(p, CONTACT_PAIR_SECOND, -1.0, x);
    return count != 0.0 || taken_off;
}

bool contact_pair_push(const contact_pair *p, const double *x, contact_push *out)
{
    if (p->fills) return push_filling(p, x, out);
    const edge_terms e = contact_pair_terms(p, x);
    *out = (contact_push){.pair = p};
    if (e.by_edge) {
        const edge_push push = contact_pair_edge(e, p->thickness);
        out->share = push.share;
        out->by_edge = vec2_scale(p->weight * push.pressure, push.normal);
    }
    return contact_pair_push_ends(p, e.near_first, x, out) || e.by_edge;
}

/* The first end, where it is taken off, pulls the node; the second is never anything else. */
double contact_push_size(const contact_push *push, const double *x)
{
    const vec2 r = from_end(push->pair, CONTACT_PAIR_FIRST, x);
    const double by_first = copysign(vec2_norm(push->by_vertex), vec2_dot(push->by_vertex, r));
    return vec2_norm(push->by_edge) + by_first - vec2_norm(push->by_second);
}

/* ---- energy and stiffness ---- */

double contact_pair_energy(const contact_pair *p, const double *x)
{
    pair_place at;
    double sum = 0.0;
    if (p->fills) return filling_energy(p, x);
    if (!find_place(p, x, &at)) return 0.0;
    if (at.u_edge > 0.0) sum += contact_potential_energy(at.u_edge);
    if (at.count != 0.0) sum += at.count * contact_potential_energy(at.u_vertex);
    if (at.u_second > 0.0) sum -= contact_potential_energy(at.u_second);
    return p->weight * p->thickness * sum;
}

/* A vertex that is taken off only softens the node, and counts as nothing here. */
bool contact_pair_stiffness(const contact_pair *p, const double *x, double added[CONTACT_PAIR_PUSHED])
{
    pair_place at;
    if (p->fills) return stiffen_filling(p, x, added);
    if (!find_place(p, x, &at)) return false;
    const double twice = 2.0 * p->weight / p->thickness;
    const double edge = at.u_edge > 0.0 ? twice * contact_potential_stiffness(at.u_edge) : 0.0;
    const double vertex = at.count > 0.0 ? twice * contact_potential_stiffness(at.u_vertex) : 0.0;
    added[CONTACT_PAIR_NODE] = edge + vertex;
    added[CONTACT_PAIR_FIRST] = (1.0 - at.share) * edge + vertex;
    added[CONTACT_PAIR_SECOND] = at.share * edge;
    return true;
}

/* Whether the node is between the ends of the edge at a part of the way. */
static bool is_between(const pair_vectors *start, const pair_vectors *way, double part)
{
    const vec2 r = vec2_along(start->r, part, way->r), t = vec2_along(start->t, part, way->t);
    const double along = vec2_dot(r, t);
    return along >= 0.0 && along <= vec2_dot(t, t);
}

/* r x t = c0 + c1 T + c2 T^2 at the part T of the way. The roots of the quadratic are q/c2 and c0/q, of which neither
 * loses digits; without a square term the first is not finite and drops out. */
bool contact_pair_crosses(const contact_pair *p, const double *x0, const double *x1, double *when)
{
    const pair_vectors start = vectors_of(p, x0), end = vectors_of(p, x1);
    const pair_vectors way = {.r = vec2_sub(end.r, start.r), .t = vec2_sub(end.t, start.t)};
    const double c0 = vec2_cross(start.r, start.t), c2 = vec2_cross(way.r, way.t);
    const double c1 = vec2_cross(start.r, way.t) + vec2_cross(way.r, start.t);
    const double square = c1 * c1 - 4.0 * c0 * c2;
    if (!(square >= 0.0)) return false;
    const double q = -0.5 * (c1 + copysign(sqrt(square), c1)), roots[2] = {q / c2, c0 / q};
    *when = INFINITY;
    for (int k = 0; k < 2; k++)
        if (roots[k] >= 0.0 && roots[k] <= 1.0 && is_between(&start, &way, roots[k])) *when = fmin(*when, roots[k]);
    return *when <= 1.0;
}
