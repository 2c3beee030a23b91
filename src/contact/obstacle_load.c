/* SPDX-License-Identifier: BSD-3-Clause */
/* What is reported of an obstacle besides its reaction (forces/diagnostics.c): where its motion law has it, and the
 * power F.w of its lasting contacts, of which the ledger has the integral (contact_set.c). */
#include "contact/obstacle_load.h"

#include "base/exact_sum.h"

static vec2 force_of(const dem_contact *c)
{
    const vec2 normal = vec2_at(c->normal, 0), tangent = {normal.y, -normal.x};
    return vec2_along(vec2_scale(c->force, normal), c->friction[0], tangent);
}

void obstacle_load_add_motion(dem_obstacle_load *load, const pose *at, dem_index obstacle, const dem_contact *list,
                              dem_index n)
{
    exact_sum power = {0};
    for (dem_index k = 0; k < n; k++)
        if (list[k].obstacle == obstacle)
            exact_sum_add(&power, vec2_dot(force_of(&list[k]), pose_velocity(at, vec2_at(list[k].x, 0))));
    vec2_put(load->displacement, 0, vec2_sub(at->centre, at->origin));
    load->angle = at->angle;
    load->power = exact_sum_value(&power);
}
