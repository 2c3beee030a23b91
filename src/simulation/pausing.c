/* SPDX-License-Identifier: BSD-3-Clause */
/* Quasi-static fracture: from a break on the ramps of boundary conditions stand still, until the residual of damped
 * bodies is small again (docs/method.md, Quasi-static runs). So what breaks next breaks under a load that has grown
 * since, and not by the waves of the break before. Prescribed velocities jump to 0 and back; the kinetic energy that
 * this takes is work from outside. */
#include "simulation/pausing.h"

#include <math.h>

#include "base/reduce.h"
#include "base/status.h"
#include "simulation/query.h"

enum { between_looks = 16 }; /* steps: a look costs as much as half an evaluation */

static const char entry[] = "pause"; /* of a checkpoint */

typedef struct numbers {
    double late, since; /* s */
    dem_index stands, unlooked;
} numbers;

/* Prescribed velocities follow their ramps, which have stopped or gone on at t. */
static void give_velocities(dem_simulation *s, double t, double *y)
{
    double *v = y + state_velocities(&s->layout);
    exact_sum energy = {0};
    boundary_conditions_give_velocities(&s->boundaries, s->model->lattice.mass, t, v, &energy);
    v[state_total_index(&s->layout, STATE_WORK)] += reduce_sum(s->model->ranks, &energy);
}

bool pausing_begin(dem_simulation *s, double t, double *y)
{
    load_clock *clock = &s->boundaries.clock;
    if (!(s->options.pause > 0.0)) return false;
    s->unlooked_pause = 0;
    if (clock->stands) return false;
    load_clock_stop(clock, t);
    give_velocities(s, t, y);
    return true;
}

bool pausing_end_step(dem_simulation *s, bool broken)
{
    load_clock *clock = &s->boundaries.clock;
    if (broken) return pausing_begin(s, s->t, s->y);
    if (!clock->stands || ++s->unlooked_pause < between_looks) return false;
    s->unlooked_pause = 0;
    if (!(query_residual(s) <= s->options.pause)) return false;
    load_clock_go_on(clock, s->t);
    give_velocities(s, s->t, s->y);
    return true;
}

/* ---- checkpoints ---- */

dem_status pausing_save(const dem_simulation *s, dem_checkpoint *checkpoint)
{
    const load_clock *clock = &s->boundaries.clock;
    const numbers n = {clock->late, clock->since, clock->stands, s->unlooked_pause};
    return s->options.pause > 0.0 ? dem_checkpoint_put(checkpoint, entry, &n, sizeof n) : DEM_OK;
}

dem_status pausing_restore(dem_simulation *s, const dem_checkpoint *checkpoint)
{
    numbers n;
    size_t size;
    const bool found = dem_checkpoint_find(checkpoint, entry, &size) != NULL;
    CHECK(!found || s->options.pause > 0.0, DEM_ERROR_IO,
          "the checkpoint is of a run with the option pause, and this run is without it");
    if (!found) return DEM_OK;
    TRY(dem_checkpoint_get(checkpoint, entry, &n, sizeof n));
    CHECK(isfinite(n.late) && n.late >= 0.0 && isfinite(n.since) && n.since >= (n.stands == 1 ? n.late : 0.0) &&
              (n.stands == 0 || n.stands == 1) && n.unlooked >= 0 && n.unlooked < between_looks,
          DEM_ERROR_IO, "the pause in the checkpoint is impossible: ramps %g s late, %s since %g s", n.late,
          n.stands != 0 ? "standing" : "going on", n.since);
    s->boundaries.clock = (load_clock){n.late, n.since, n.stands != 0};
    s->unlooked_pause = (int)n.unlooked;
    return DEM_OK;
}
