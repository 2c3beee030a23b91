/* SPDX-License-Identifier: BSD-3-Clause */
/* Restitution (8), (9), Moreau's law for a corner, and the complementarity of reactions. Nowhere else. */
#include "impact.h"

#include <stdbool.h>

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
}

vec2 impact_rebound(const impact_surface *surface, int n, vec2 v)
{
    double p[2], eta[2];
    inward_parts(surface, n, v, p);
    for (int k = 0; k < n; k++) eta[k] = surface[k].restitution;
    const bool both = n == 2 && p[0] < 0.0 && p[1] < 0.0; /* then all of v is in the cone */
    if (both && vec2_dot(surface[0].normal, surface[1].normal) < 0.0) eta[0] = eta[1] = fmin(eta[0], eta[1]);
    if (both) v = (vec2){0.0, 0.0};
    for (int k = 0; k < n; k++) v = vec2_along(v, -(both ? eta[k] : 1.0 + eta[k]) * p[k], surface[k].normal); /* (9) */
    return v;
}

int impact_holding(const impact_surface *surface, int n, vec2 force, double *reaction)
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
