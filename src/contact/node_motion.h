/* SPDX-License-Identifier: BSD-3-Clause */
/* Positions and velocities of nodes on the dense output of a step, as vectors of two components. */
#ifndef DEM_CONTACT_NODE_MOTION_H
#define DEM_CONTACT_NODE_MOTION_H

#include "base/vec2.h"
#include "time/dense_output.h"

static inline vec2 node_motion_position(const dense_output *p, double t, dem_index node)
{
    double x[STATE_DIM_MOST];
    dense_output_position(p, t, node, x);
    return (vec2){x[0], x[1]};
}

static inline vec2 node_motion_velocity(const dense_output *p, double t, dem_index node)
{
    double v[STATE_DIM_MOST];
    dense_output_velocity(p, t, node, v);
    return (vec2){v[0], v[1]};
}

#endif
