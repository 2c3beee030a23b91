/* SPDX-License-Identifier: BSD-3-Clause */
/* The pattern of a pair of the node p and the edge AB, between Z before A and C after B. With F_i the force on node i
 * and J a quarter turn to the left, each node has J F_i. These sum up to 0 as the forces do. The moment of J F_i about
 * p is V_i = (x_i - p).F_i; each end is balanced by a couple, half of it on either of its edges: a couple of moment -V
 * on an edge e consists of (V/e.e) J e at its first end and the opposite at the second.
 * So each end has what belongs to the force on it and to its own edges alone. Over all pairs of p that force is
 * continuous, since it is a derivative of the potential, and so is the pattern where p passes the end of an edge. */
#include "surface_contact/friction_pattern.h"

static vec2 to_the_left(vec2 a)
{
    return (vec2){-a.y, a.x};
}

/* Adds what takes a moment off, on the edge from one node of the pair to another. */
static void add_couple(friction_pattern *out, int first, int second, double moment, const double *x)
{
    const vec2 edge = vec2_sub(vec2_at(x, out->nodes[second]), vec2_at(x, out->nodes[first]));
    const vec2 force = vec2_scale(moment / vec2_dot(edge, edge), to_the_left(edge));
    out->at[first] = vec2_add(out->at[first], force);
    out->at[second] = vec2_sub(out->at[second], force);
}

friction_pattern friction_pattern_make(const contact_push *push, const double *x)
{
    const dem_index *nodes = push->pair->nodes;
    const vec2 node = vec2_at(x, nodes[CONTACT_PAIR_NODE]);
    friction_pattern out = {.at = {{0.0, 0.0}}};
    double half[CONTACT_PAIR_NODES]; /* V_i/2 */
    for (int k = 0; k < CONTACT_PAIR_NODES; k++) {
        const vec2 force = contact_push_on(push, k);
        out.nodes[k] = nodes[k];
        out.at[k] = to_the_left(force);
        half[k] = 0.5 * vec2_dot(vec2_sub(vec2_at(x, nodes[k]), node), force);
    }
    add_couple(&out, CONTACT_PAIR_BEFORE, CONTACT_PAIR_FIRST, half[CONTACT_PAIR_FIRST], x);
    add_couple(&out, CONTACT_PAIR_FIRST, CONTACT_PAIR_SECOND, half[CONTACT_PAIR_FIRST] + half[CONTACT_PAIR_SECOND], x);
    add_couple(&out, CONTACT_PAIR_SECOND, CONTACT_PAIR_AFTER, half[CONTACT_PAIR_SECOND], x);
    return out;
}

friction_pattern friction_pattern_scale(double factor, const friction_pattern *p)
{
    friction_pattern out = *p;
    for (int k = 0; k < CONTACT_PAIR_NODES; k++) out.at[k] = vec2_scale(factor, p->at[k]);
    return out;
}

double friction_pattern_dot(const friction_pattern *p, const double *v)
{
    double sum = 0.0;
    for (int k = 0; k < CONTACT_PAIR_NODES; k++) sum += vec2_dot(p->at[k], vec2_at(v, p->nodes[k]));
    return sum;
}

double friction_pattern_way(const friction_pattern *p, const double *x0, const double *x)
{
    double sum = 0.0;
    for (int k = 0; k < CONTACT_PAIR_NODES; k++)
        sum += vec2_dot(p->at[k], vec2_sub(vec2_at(x, p->nodes[k]), vec2_at(x0, p->nodes[k])));
    return sum;
}
