/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/step_parts.h"

#include <stdlib.h>

#include "simulation/unseen_steps.h"

/* Before there is an integrator the state is in `initial`. */
void step_parts_destroy(dem_simulation *s)
{
    integrator_destroy(&s->integrator);
    free(s->initial);
    s->y = s->initial = NULL;
    s->seen = s->frame;
    unseen_steps_destroy(s);
    kernel_destroy(&s->kernel);
    overlap_destroy(&s->overlap);
    event_queue_destroy(&s->queue);
    source_list_destroy(&s->sources);
    contact_source_destroy(&s->contact_events);
    local_springs_destroy(&s->local_springs);
    automaton_destroy(&s->automaton);
    surface_contact_destroy(s->surfaces);
    s->surfaces = s->forces.surfaces = NULL;
    if (s->survey != NULL) survey_destroy(s->survey);
}
