/* SPDX-License-Identifier: BSD-3-Clause */
/* One anchor of the node p at the point C = A + w (B - A) of the edge AB. With t along the edge, n = t turned to the
 * left, rho = ((p - C).t, (p - C).n), d = N turned to the left over |N|, in the same frame, and the index 0 for what
 * they were after the last step:
 *   the shift is tau = tau_0 + (rho - rho_0).(d_0 + d)/2, the way along d by the trapezoidal rule;
 *   friction is T = k tau, but not more than mu |N| in size, against d on the node.
 * With F_i the forces of a pair on its nodes, which sum up to N on the node over all pairs, friction adds
 *   -(T/|N|) (F_i turned to the left),
 * of which the sum is 0 as that of F_i is, and the moment -(T/|N|) V with V = sum of x_i.F_i; at A and B come c e and
 * -c e, e = (B - A turned to the left), c = -(T/|N|) V/|B - A|^2, of which the moment is the opposite. All of it is a
 * continuous function of positions, since F_i are. Where one edge pushes, or one vertex, these forces are the negative
 * gradient of k tau^2/2 after the last step. */
#include "surface_contact/anchor.h"

/* The edge of an anchor, and where its node is to it. */
typedef struct anchor_frame {
    vec2 along, across; /* t, n */
    double length;      /* m */
    vec2 from_first;    /* p - A */
    vec2 place;         /* rho */
} anchor_frame;

static vec2 to_the_left(vec2 a)
{
    return (vec2){-a.y, a.x};
}

static vec2 seen_from(const anchor_frame *f, vec2 a)
{
    return (vec2){vec2_dot(a, f->along), vec2_dot(a, f->across)};
}

static anchor_frame frame_at(const anchor *a, const double *x)
{
    const vec2 first = vec2_at(x, a->nodes[CONTACT_PAIR_FIRST]);
    const vec2 edge = vec2_sub(vec2_at(x, a->nodes[CONTACT_PAIR_SECOND]), first);
    const vec2 from_first = vec2_sub(vec2_at(x, a->nodes[CONTACT_PAIR_NODE]), first);
    const double length = vec2_norm(edge);
    const vec2 along = vec2_scale(1.0 / length, edge);
    anchor_frame out = {.along = along, .across = to_the_left(along), .length = length, .from_first = from_first};
    out.place = seen_from(&out, vec2_along(from_first, -a->weight, edge));
    return out;
}

static vec2 direction_at(const anchor_frame *f, vec2 normal)
{
    return seen_from(f, vec2_scale(1.0 / vec2_norm(normal), to_the_left(normal)));
}

double anchor_shift(const anchor *a, vec2 normal, const double *x)
{
    const anchor_frame f = frame_at(a, x);
    const vec2 direction = direction_at(&f, normal);
    if (!(vec2_dot(direction, a->direction) > 0.0)) return 0.0;
    return a->shift + 0.5 * vec2_dot(vec2_sub(f.place, a->place), vec2_add(a->direction, direction));
}

double anchor_ratio(const anchor *a, vec2 normal, const double *x)
{
    const double ratio = a->stiffness * anchor_shift(a, normal, x) / vec2_norm(normal);
    return fmax(-a->friction, fmin(a->friction, ratio));
}

double anchor_energy(const anchor *a, vec2 normal, const double *x)
{
    const double force = anchor_ratio(a, normal, x) * vec2_norm(normal);
    return 0.5 * force * force / a->stiffness;
}

void anchor_turn_push(const contact_push *push, double ratio, const double *x, vec2 out[ANCHOR_NODES])
{
    const dem_index *nodes = push->pair->nodes;
    const vec2 first = vec2_at(x, nodes[CONTACT_PAIR_FIRST]);
    const vec2 edge = vec2_sub(vec2_at(x, nodes[CONTACT_PAIR_SECOND]), first);
    double sum = 0.0;
    for (int which = 0; which < ANCHOR_NODES; which++) {
        const vec2 force = contact_push_on(push, which);
        sum += vec2_dot(vec2_sub(vec2_at(x, nodes[which]), first), force);
        out[which] = vec2_scale(-ratio, to_the_left(force));
    }
    const vec2 couple = vec2_scale(-ratio * sum / vec2_dot(edge, edge), to_the_left(edge));
    out[CONTACT_PAIR_FIRST] = vec2_add(out[CONTACT_PAIR_FIRST], couple);
    out[CONTACT_PAIR_SECOND] = vec2_sub(out[CONTACT_PAIR_SECOND], couple);
}

/* The gradient of tau after the last step: d at p, -(1 - w) d - (h/L) n at A and -w d + (h/L) n at B, with h the part
 * of p - C to the left of d. */
void anchor_stiffness(const anchor *a, const double *x, double added[ANCHOR_NODES])
{
    const anchor_frame f = frame_at(a, x);
    const vec2 d = a->direction, turn = {0.0, vec2_cross(d, f.place) / f.length};
    const vec2 gradient[ANCHOR_NODES] = {d, vec2_sub(vec2_scale(a->weight - 1.0, d), turn),
                                         vec2_add(vec2_scale(-a->weight, d), turn)};
    double sum = 0.0;
    for (int k = 0; k < ANCHOR_NODES; k++) sum += vec2_norm(gradient[k]);
    for (int k = 0; k < ANCHOR_NODES; k++) added[k] = a->stiffness * sum * vec2_norm(gradient[k]);
}

static double foot_of(const anchor_frame *f)
{
    return vec2_dot(f->from_first, f->along) / f->length;
}

double anchor_foot(const anchor *a, const double *x)
{
    const anchor_frame f = frame_at(a, x);
    return foot_of(&f);
}

void anchor_put(anchor *a, vec2 normal, double shift, const double *x)
{
    anchor_frame f = frame_at(a, x);
    a->weight = fmin(fmax(foot_of(&f), 0.0), 1.0);
    f = frame_at(a, x);
    a->place = f.place;
    a->direction = direction_at(&f, normal);
    a->shift = shift;
}
