/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction of one body on one node. With P the sum of the patterns of all pairs by which the body pushes the node
 * (friction_pattern.h), S the force that presses (below), g = P/S, and the index 0 for what was after the last step:
 *   the way is tau = (g_0 + g).(x - x_0)/2 over all nodes: the integral of g.dx by the trapezoidal rule;
 *   friction is T = T_0 + k tau, but not more than mu S in size, and acts on the nodes by -T g.
 * So the power that it takes, T g.v, is that of the spring, T d(tau)/dt, but for terms of second order in the way of a
 * step: what the spring stores it gives back, and no more. As g has neither resultant nor moment, nothing is stretched
 * where all moves as one rigid body: (g_0 + R g_0).(R x_0 - x_0) = 0 for every rotation R. After the last step the
 * gradient of tau is g_0, and these forces are the negative gradient of (T_0 + k tau)^2/(2 k).
 * S is the size of the sum N of all pushes, or the sum of their sizes less that of what is taken off beside two edges,
 * whichever is larger. Where the surface is smooth they are equal. Edges that push a node from opposite sides cancel in
 * N, and not in S. As S is continuous like P, and g is bounded, friction is continuous in positions. */
#include "surface_contact/anchor.h"

#include <math.h>

double anchor_force(const anchor *a, const anchor_load *load)
{
    const double most = a->friction * load->press;
    return fmax(-most, fmin(most, a->force + a->stiffness * load->way));
}

double anchor_ratio(const anchor *a, const anchor_load *load)
{
    return load->press > 0.0 ? anchor_force(a, load) / load->press : 0.0;
}

double anchor_energy(const anchor *a, const anchor_load *load)
{
    const double force = anchor_force(a, load);
    return 0.5 * force * force / a->stiffness;
}
