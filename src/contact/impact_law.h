/* SPDX-License-Identifier: BSD-3-Clause */
/* What an impact does, and which contacts last: pure functions of normals, velocities and forces. */
#ifndef DEM_CONTACT_IMPACT_LAW_H
#define DEM_CONTACT_IMPACT_LAW_H

#include "base/vec2.h"

/** A surface that is touched. */
typedef struct impact_surface {
    vec2 normal;        /* unit, out of the obstacle */
    double restitution; /* eta, 0 to 1 */
    double friction;    /* mu */
    dem_friction_law law;
    vec2 drift; /* m/s, velocity of the surface in the frame of the corner, to which velocities are relative */
} impact_surface;

/** Velocity after an impact with one or two surfaces. For one it is (9), v - (1 + eta) n (n.v) if n.v < 0, with (8)
 *  as eta = 1. For two it is Moreau's law: v - sum (1 + eta_s) p_s n_s, where sum p_s n_s, p_s <= 0, is the
 *  projection of v on the cone of the inward normals. Where both act in an acute corner both have the smaller eta:
 *  two different ones could give energy there.
 *  Where exactly one acts, friction changes the tangential velocity: by Coulomb's law by at most mu (1 + eta) |v_n|,
 *  not beyond 0; by (10) to mu v_t.
 *  \param[out] kick  [n] what each surface adds to the velocity */
vec2 impact_law_rebound(const impact_surface *surface, int n, vec2 v, vec2 *kick);

/** Height of the hop to which repeated impacts tend under a constant push a, each taken at a depth of 1 and put back on
 *  the surface: v'^2 = eta^2 (v^2 + 2 a) tends to 2 a eta^2/(1 - eta^2). At most 50, and 0 for eta = 1, where there is
 *  no limit. */
double impact_law_kept_up(const impact_surface *surface);

/** Which of one or two surfaces hold a node at rest on them against `force` (N): the set for which no reaction pulls
 *  and nothing accelerates inwards. Bit s is set if surface s holds; reaction[s] is then its force, N, else 0. */
int impact_law_holding(const impact_surface *surface, int n, vec2 force, double *reaction);

#endif
