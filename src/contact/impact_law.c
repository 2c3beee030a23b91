/* SPDX-License-Identifier: BSD-3-Clause */
/* Restitution (8), (9), friction (10) and Coulomb's, Moreau's law for a corner, and the complementarity of reactions.
 * These laws are nowhere else. */
#include "contact/impact_law.h"

#include <stdbool.h>

static const double parallel_below = 1e-9; /* sine between two normals */

/* Parts p[s] <= 0 of v that the cone of the inward normals holds: the projection of v on it. */
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

/* Friction where a surface has changed the normal velocity by `kick`, m/s. */
static vec2 rub(const impact_surface *s, vec2 v, double kick)
{
    const vec2 t = {s->normal.y, -s->normal.x};
    const double vt = vec2_dot(vec2_sub(v, s->drift), t), limit = s->friction * kick;
    double after = s->friction * vt; /* (10) */
    if (s->law == DEM_FRICTION_COULOMB) after = fabs(vt) <= limit ? 0.0 : vt - copysign(limit, vt);
    return vec2_along(v, after - vt, t);
}

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
