/* SPDX-License-Identifier: BSD-3-Clause */
/* The laws of an impact of one point: restitution (8) and (9), friction by (10) or by Coulomb, Moreau's law for a
 * corner; and the complementarity of forces by which a corner holds a node (docs/method.md, The impact). They are pure
 * functions of velocities and normals, and nowhere else. Which surfaces are hit is decided in impact_target.c, what
 * counts as rest in impact_rest.c, and how the contacts of a group go together in impact_group.c. */
#include "contact/impact_law.h"

#include <stdbool.h>

static const double parallel_below = 1e-9; /* sine between two normals */

/* Parts p_s <= 0 of v with sum p_s n_s the projection of v on the cone of the inward normals, -n_s. By Moreau's
 * decomposition the rest, v - sum p_s n_s, approaches no surface, and p_s < 0 only for a surface that it is parallel
 * to:
 *   p_s <= 0,   (v - p).n_s >= 0,   p_s (v - p).n_s = 0.
 * For two surfaces there are four cases: none acts, one does, or both, which are tried in this order. */
static void inward_parts(const impact_surface *s, int n, vec2 v, double p[2])
{
    double alone[2] = {0.0, 0.0};
    p[0] = p[1] = 0.0;
    for (int k = 0; k < n; k++) alone[k] = fmin(0.0, vec2_dot(v, s[k].normal));
    if (n == 1) {
        p[0] = alone[0];
        return;
    }
    for (int k = 0; k < 2; k++) { /* one surface alone, if what is left does not run into the other */
        const vec2 left = vec2_along(v, -alone[k], s[k].normal);
        if (vec2_dot(left, s[1 - k].normal) >= 0.0) {
            p[k] = alone[k];
            return;
        }
    }
    vec2_parts(v, s[0].normal, s[1].normal, p);
    if (p[0] <= 0.0 && p[1] <= 0.0 && fabs(vec2_cross(s[0].normal, s[1].normal)) > parallel_below) return;
    const int k = alone[0] <= alone[1] ? 0 : 1; /* nearly parallel, where rounding decides: they count as one */
    p[k] = alone[k];
    p[1 - k] = 0.0;
}

/* Friction on one surface that has changed the normal velocity by `kick` = (1 + eta) abs(v_n), m/s:
 * - Coulomb: v_t' = v_t - sign(v_t) min(abs(v_t), mu kick), a tangential impulse of mu times the normal one at most;
 * - (10): v_t' = mu v_t. v_t is relative to the surface, which drifts in the frame of a corner. */
static vec2 rub(const impact_surface *s, vec2 v, double kick)
{
    const vec2 t = {s->normal.y, -s->normal.x};
    const double vt = vec2_dot(vec2_sub(v, s->drift), t), limit = s->friction * kick;
    double after = s->friction * vt; /* (10) */
    if (s->law == DEM_FRICTION_COULOMB) after = fabs(vt) <= limit ? 0.0 : vt - copysign(limit, vt);
    return vec2_along(v, after - vt, t);
}

/* Where both surfaces of a corner act, all of v is in the cone of the inward normals: v = sum p_s n_s. Then v' is
 * computed as -sum eta_s p_s n_s, without the rounding of v - sum (1 + eta_s) p_s n_s. kick[s] is what surface s adds
 * to the velocity, by which its impulse is reckoned; where one surface acts alone its friction is in it. */
vec2 impact_law_rebound(const impact_surface *surface, int n, vec2 v, vec2 *kick)
{
    double p[2], eta[2];
    inward_parts(surface, n, v, p);
    for (int k = 0; k < n; k++) eta[k] = surface[k].restitution;
    const bool both = n == 2 && p[0] < 0.0 && p[1] < 0.0; /* then all of v is in the cone */
    if (both && vec2_dot(surface[0].normal, surface[1].normal) < 0.0) eta[0] = eta[1] = fmin(eta[0], eta[1]);
    vec2 after = both ? (vec2){0.0, 0.0} : v;
    for (int k = 0; k < n; k++) {
        after = vec2_along(after, -(both ? eta[k] : 1.0 + eta[k]) * p[k], surface[k].normal); /* (9) */
        kick[k] = vec2_scale(-(1.0 + eta[k]) * p[k], surface[k].normal);
        if (p[k] == 0.0 || both) continue;
        after = rub(&surface[k], after, -(1.0 + eta[k]) * p[k]);
        kick[k] = vec2_sub(after, v);
    }
    return after;
}

double impact_law_kept_up(const impact_surface *surface)
{
    const double square = surface->restitution * surface->restitution;
    return square < 1.0 ? fmin(square / (1.0 - square), 50.0) : 0.0;
}

/* The same cone for forces: reactions N_s = -p_s >= 0, a remaining force that accelerates into no surface, and N_s > 0
 * only where that is parallel to the surface. This is the complementarity of contact for a node at rest. */
int impact_law_holding(const impact_surface *surface, int n, vec2 force, double *reaction)
{
    double p[2];
    int holding = 0;
    inward_parts(surface, n, force, p);
    for (int k = 0; k < n; k++) {
        reaction[k] = -p[k];
        if (p[k] < 0.0) holding |= 1 << k;
    }
    return holding;
}
