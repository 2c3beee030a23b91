/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction of one body on one node. With P the sum of the patterns of all pairs by which the body pushes the node
 * (friction_pattern.h), g = P/|N|, and the index 0 for what was after the last step:
 *   the way is tau = (g_0 + g).(x - x_0)/2 over all nodes: the integral of g.dx by the trapezoidal rule;
 *   friction is T = T_0 + k tau, but not more than mu |N| in size, and acts on the nodes by -T g.
 * So the power that it takes, T g.v, is that of the spring, T d(tau)/dt, but for terms of second order in the way of a
 * step: what the spring stores it gives back, and no more. As g has neither resultant nor moment, nothing is stretched
 * where all moves as one rigid body: (g_0 + R g_0).(R x_0 - x_0) = 0 for every rotation R. After the last step the
 * gradient of tau is g_0, and these forces are the negative gradient of (T_0 + k tau)^2/(2 k). They are continuous in
 * positions, since P is, but for a node that edges of one body push from opposite sides: where their sum N goes through
 * 0, T g jumps. */
#include "surface_contact/anchor.h"

#include <math.h>

double anchor_force(const anchor *a, const anchor_load *load)
{
    const double most = a->friction * vec2_norm(load->normal);
    if (vec2_dot(load->normal, a->normal) < 0.0) return 0.0;
    return fmax(-most, fmin(most, a->force + a->stiffness * load->way));
}

double anchor_ratio(const anchor *a, const anchor_load *load)
{
    const double normal = vec2_norm(load->normal);
    return normal > 0.0 ? anchor_force(a, load) / normal : 0.0;
}

double anchor_energy(const anchor *a, const anchor_load *load)
{
    const double force = anchor_force(a, load);
    return 0.5 * force * force / a->stiffness;
}
