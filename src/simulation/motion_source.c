/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/motion_source.h"

#include <string.h>

#include "base/status.h"
#include "simulation/led_run.h"
#include "simulation/shared_field.h"

static dem_status copy(const dem_simulation *s, shared_field_kind field, double *out)
{
    dem_state state = {.struct_size = sizeof state};
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_FIELD, (dem_index)field, out);
    TRY(dem_simulation_state(s, &state));
    memcpy(out, field == SHARED_FIELD_POSITIONS ? state.x : state.v,
           (size_t)state_row(&s->layout, s->model->lattice.n_nodes) * sizeof *out);
    return DEM_OK;
}

dem_status dem_private_positions(const dem_simulation *simulation, double *out)
{
    return copy(simulation, SHARED_FIELD_POSITIONS, out);
}

dem_status dem_private_velocities(const dem_simulation *simulation, double *out)
{
    return copy(simulation, SHARED_FIELD_VELOCITIES, out);
}
