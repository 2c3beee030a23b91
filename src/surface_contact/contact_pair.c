/* SPDX-License-Identifier: BSD-3-Clause */
/* One contact pair of the node p and the edge AB, with Z before A on the surface. With r = p - A, t = B - A, z = A - Z,
 * s = r.t/t.t and g = (r x t)/|t|, which is > 0 in front of the edge:
 *   edge:    0 <= s < 1 and 0 < g < delta: the potential at g, along the edge's normal (t_y, -t_x)/|t|;
 *   vertex:  |r| < delta: the potential at |r|, along r,
 *              once between two edges, r.z >= 0 and r.t < 0, outside a convex vertex, z x t > 0;
 *              taken off once beside both edges, r.z < 0 and r.t >= 0, in front of both, r x t > 0 and r x z > 0.
 * s < 1 is computed as (p - B).t < 0, so that two edges and their vertex compare the same numbers: no node falls
 * between them by rounding. For the same reason a vertex that is straight but for rounding counts as convex for a node
 * in front of both edges. What is behind an edge is not pushed, so a body that is squeezed does not push itself from
 * inside. Which pairs there are is the business of pair_list.c. */
#include "surface_contact/contact_pair.h"

#include "surface_contact/contact_potential.h"

/* The vectors of a pair. */
typedef struct pair_vectors {
    vec2 r, t, z;
    vec2 end; /* p - B */
} pair_vectors;

static pair_vectors vectors_of(const contact_pair *p, const double *x)
{
    const vec2 node = vec2_at(x, p->nodes[CONTACT_PAIR_NODE]), a = vec2_at(x, p->nodes[CONTACT_PAIR_FIRST]);
    const vec2 b = vec2_at(x, p->nodes[CONTACT_PAIR_SECOND]), before = vec2_at(x, p->nodes[CONTACT_PAIR_BEFORE]);
    return (pair_vectors){vec2_sub(node, a), vec2_sub(b, a), vec2_sub(a, before), vec2_sub(node, b)};
}

/* How often the vertex counts: 1, -1 or 0. The node before it is its neighbour, and no partner of it. */
static double vertex_count(const contact_pair *p, const pair_vectors *v)
{
    const bool beside = vec2_dot(v->r, v->t) >= 0.0, beside_last = vec2_dot(v->r, v->z) < 0.0;
    if (p->nodes[CONTACT_PAIR_NODE] == p->nodes[CONTACT_PAIR_BEFORE] || beside != beside_last) return 0.0;
    const bool in_front = vec2_cross(v->r, v->t) > 0.0 && vec2_cross(v->r, v->z) > 0.0;
    if (beside) return in_front ? -1.0 : 0.0;
    return in_front || vec2_cross(v->z, v->t) > 0.0 ? 1.0 : 0.0;
}

/* Where the node is with respect to edge and vertex. */
typedef struct pair_place {
    double u_edge;   /* distance over thickness; 0: the edge does not push */
    double share;    /* s */
    vec2 normal;     /* of the edge */
    double u_vertex; /* distance over thickness; 0: the vertex does not push */
    double count;    /* 1 or -1 */
    vec2 direction;  /* from the vertex to the node */
} pair_place;

/* Most pairs end without a root or a division. */
static bool find_place(const contact_pair *p, const double *x, pair_place *out)
{
    const pair_vectors v = vectors_of(p, x);
    const double along = vec2_dot(v.r, v.t), front = vec2_cross(v.r, v.t), square = vec2_dot(v.t, v.t);
    const double limit = p->thickness * p->thickness, radius = vec2_dot(v.r, v.r);
    const bool beside = along >= 0.0 && vec2_dot(v.end, v.t) < 0.0;
    const bool by_edge = beside && front > 0.0 && front * front < limit * square;
    const double count = radius < limit ? vertex_count(p, &v) : 0.0;
    *out = (pair_place){.count = count};
    if (by_edge) {
        const double length = sqrt(square);
        out->u_edge = front / length / p->thickness;
        out->share = along / square;
        out->normal = (vec2){v.t.y / length, -v.t.x / length};
    }
    if (count != 0.0) {
        const double distance = sqrt(radius);
        out->u_vertex = distance / p->thickness;
        out->direction = vec2_scale(1.0 / distance, v.r);
    }
    return by_edge || count != 0.0;
}

bool contact_pair_push(const contact_pair *p, const double *x, contact_push *out)
{
    pair_place at;
    *out = (contact_push){0};
    if (!find_place(p, x, &at)) return false;
    out->share = at.share;
    if (at.u_edge > 0.0) out->by_edge = vec2_scale(p->weight * contact_potential_pressure(at.u_edge), at.normal);
    if (at.count != 0.0)
        out->by_vertex = vec2_scale(at.count * p->weight * contact_potential_pressure(at.u_vertex), at.direction);
    return true;
}

double contact_pair_energy(const contact_pair *p, const double *x)
{
    pair_place at;
    double sum = 0.0;
    if (!find_place(p, x, &at)) return 0.0;
    if (at.u_edge > 0.0) sum += contact_potential_energy(at.u_edge);
    if (at.count != 0.0) sum += at.count * contact_potential_energy(at.u_vertex);
    return p->weight * p->thickness * sum;
}

/* A vertex that is taken off only softens the node, and counts as nothing here. */
bool contact_pair_stiffness(const contact_pair *p, const double *x, double added[CONTACT_PAIR_NODES])
{
    pair_place at;
    if (!find_place(p, x, &at)) return false;
    const double twice = 2.0 * p->weight / p->thickness;
    const double edge = at.u_edge > 0.0 ? twice * contact_potential_stiffness(at.u_edge) : 0.0;
    const double vertex = at.count > 0.0 ? twice * contact_potential_stiffness(at.u_vertex) : 0.0;
    added[CONTACT_PAIR_NODE] = edge + vertex;
    added[CONTACT_PAIR_FIRST] = (1.0 - at.share) * edge + vertex;
    added[CONTACT_PAIR_SECOND] = at.share * edge;
    added[CONTACT_PAIR_BEFORE] = 0.0;
    return true;
}

double contact_pair_distance(vec2 point, vec2 a, vec2 b)
{
    const vec2 r = vec2_sub(point, a), t = vec2_sub(b, a);
    const double s = vec2_dot(r, t) / vec2_dot(t, t);
    return vec2_norm(vec2_along(r, -fmin(fmax(s, 0.0), 1.0), t));
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
