/* SPDX-License-Identifier: BSD-3-Clause */
/* A simulation and its state. The time loop is in simulation.c, the right-hand side of the ODE in right_hand_side.c,
 * what observers and callers see in query.c, what a checkpoint contains in checkpoint.c. */
#ifndef DEM_SIMULATION_PRIVATE_H
#define DEM_SIMULATION_PRIVATE_H

#include "base/reduce.h"
#include "base/state.h"
#include "base/status.h"
#include "base/team.h"
#include "contact/contact_source.h"
#include "domain/halo.h"
#include "events/event_queue.h"
#include "forces/held_forces.h"
#include "forces/kernel.h"
#include "forces/local_springs.h"
#include "forces/rigid_motion.h"
#include "forces/step_wave.h"
#include "forces/stress_field.h"
#include "forces/survey.h"
#include "fracture/fracture_source.h"
#include "model/overlap.h"
#include "simulation/observers.h"
#include "surface_contact/approach_bound.h"
#include "surface_contact/surface_load.h"
#include "time/integrator.h"

/* Results from the state as seen; each is computed once, when it is first asked for. */
typedef struct run_measures {
    bool has_events, has_state, has_contacts, has_held_forces, has_poses, has_survey, has_stress, has_energy,
        has_bodies, has_inertia, has_surfaces, has_pairs, has_rigid, has_ghosts, has_elements;
    dem_index n_contacts;
    const dem_contact *contacts; /* [n_contacts] closed ones */
    dem_energy energy;
    dem_surfaces surfaces;
} run_measures;

/* What observers of this rank have returned for steps, not DEM_OK, about which ranks tell each other at the end of the
 * next attempt. */
typedef struct run_stop {
    dem_status status;
    char message[STATUS_MESSAGE_SIZE];
    bool is_known; /* that there is such a status on some rank */
} run_stop;

typedef struct led_run led_run;

/* What steps need that nobody sees. */
typedef struct run_unseen {
    step_wave *wave;     /* NULL: there are none */
    dem_index n_surface; /* nodes of the surface that may touch obstacles; */
    dem_index *surface;  /* [n_surface] ascending */
    int wait, last_wait; /* steps until they are tried again, and how many those were after the last failure; */
    int last_pause;      /* and how many they are after ranks have not agreed on any */
} run_unseen;

/** Flags say where a run is:
 *  - not `started`: the contacts of the initial motion, or of one that was set, have still to be taken up;
 *  - between steps: y is the state at t, which the integrator starts from next;
 *  - `in_hand`: an accepted step from t to path.end whose start is y; with `local` its events are resolved in the
 *    queue, with `exact` it ends with one if `at_event` or `at_break`. An advance may end here.
 *  What is seen (seen_t, seen) may be at any time of the step in hand. */
struct dem_simulation {
    const dem_model *model;
    dem_options options;          /* every default replaced */
    state_layout layout;          /* of y */
    ode_domain shared;            /* of a model that ranks share */
    halo halo;                    /* likewise, of its ghosts */
    run_stop stop;                /* what observers have asked for, where ranks share the model */
    led_run *leads;               /* the run that ranks make for this one; NULL: it makes its own */
    bool is_led;                  /* whether this is a part of such a run, */
    struct dem_simulation *whole; /* and of which on rank 0; NULL: on others */
    double culprit;               /* the first node here whose derivative was not finite, by its number in the whole */
    team *team;                   /* for loops over nodes; NULL: they run in the caller alone */
    boundary_conditions boundaries;
    external_force *external;  /* NULL: none */
    surface_contact *surfaces; /* contact of bodies with each other; NULL: none */
    rigid_contact *rigid;      /* of rigid bodies with obstacles; NULL: none */
    surface_load pushing;      /* pairs of them in the state as seen, if `measures` has them */
    dem_index crossings;       /* steps rejected because of them */
    approach_bound unfolded;   /* how near triangles may have come to the onset of their guard */
    bool outgrown;             /* events in the step in hand have brought surfaces nearer than the step knew */
    held_forces held_forces;   /* external ones, in the state as seen, if `measures` has them */
    pose *poses;               /* [obstacles] likewise; NULL: no function of the caller moves any */
    forces forces;             /* on nodes, without those of contacts */
    kernel kernel;
    overlap overlap;
    automaton automaton;
    contact_source contact_events; /* those inside steps */
    element_state elements;        /* empty as long as all are whole */
    mesh_boundary boundary;        /* of those that are whole, if so many are broken: */
    dem_index n_outside;           /* 0: there is none yet */
    surface *outline;              /* that may touch obstacles; NULL: the model's, or there are none */
    exact_sum fracture;            /* J, taken by breaking */
    fracture_source breaks;        /* inside steps; empty: nothing breaks by itself */
    break_list given;              /* what the program has broken, of which observers know nothing yet */
    local_springs local_springs;
    local_forces local_forces;   /* those of local_springs, as events see them */
    constraints closed_contacts; /* as events see them */
    source_list sources;         /* of events */
    event_queue queue;           /* of the events inside steps; empty if the whole body stops at them */
    integrator integrator;
    double t;           /* s, of y */
    double step;        /* s, length of the last committed step */
    double *y;          /* [2 dim n_rows] state (x, v) after the last committed step, the integrator's */
    double *initial;    /* [2 dim n_rows] state before there is an integrator */
    double *frame;      /* [2 dim n_rows] state interpolated to a frame or to t_end */
    dense_output path;  /* the step in hand */
    bool in_hand;       /* whether there is one */
    bool at_event;      /* whether it ends with one of contact, */
    bool at_break;      /* or with a break */
    bool started;       /* whether the contacts of the initial state have been taken up */
    bool advanced;      /* whether the run has begun: no more observers */
    bool advancing;     /* whether an advance is under way */
    double seen_t;      /* s, of what observers and callers see: */
    const double *seen; /* y or frame */
    run_measures *measures;
    survey *survey;          /* of the state as seen, if `measures` has it */
    stress_field *field;     /* of the same, likewise */
    dem_body_motion *bodies; /* [bodies] in the state as seen, if `measures` has them, */
    double *inertia;         /* [bodies] kg m^2, likewise */
    int unlooked;            /* steps since overlaps were looked for */
    int unlooked_pause;      /* in a pause of the ramps: steps since the residual was looked at */
    dem_index events;
    dem_index since_checkpoint;     /* steps since the last checkpoint */
    dem_checkpoint *checkpoint;     /* the last one, */
    bool has_checkpoint;            /* if there is one */
    dem_checkpoint *rollback;       /* the state before contacts change, in case the external force fails, */
    bool has_rollback;              /* if there is one */
    dem_index n_inside, n_reported; /* events inside the step in hand; those of them that observers know */
    dem_index n_broken, n_known;    /* breaks, likewise */
    observers observers;
    void *kept; /* for orders of writers of files (base/field_order.h), where the simulation leads no run */
    run_unseen unseen;
};

/* Whether other ranks have some of the nodes: a team of one steps as a process alone does. */
static inline bool run_is_shared(const dem_simulation *s)
{
    return s->model->ranks->size > 1;
}

/* Whether a function of the caller has failed on this rank: the external force, or the motion of an obstacle. */
static inline bool run_own_force_failed(const dem_simulation *s)
{
    if (s->external == NULL && !s->model->obstacles.is_asked) return false;
    return external_force_failed(s->external) || surface_failed(&s->automaton.set.scene);
}

/* The same on any rank. */
static inline bool run_force_failed(const dem_simulation *s)
{
    if (s->external == NULL && !s->model->obstacles.is_asked) return false;
    return reduce_any(s->model->ranks, run_own_force_failed(s));
}

/* The status and message of that failure on all ranks, which is over then. A rank may have failed in a later evaluation
 * than another one: that of the first counts, as in a process alone. */
static inline dem_status run_force_failure(const dem_simulation *s)
{
    const double key = external_force_failed(s->external) ? s->external->key : 0.0;
    dem_status own = surface_failed(&s->automaton.set.scene) ? given_motion_failure() : DEM_OK;
    if (external_force_failed(s->external)) own = external_force_failure(s->external);
    return reduce_status(s->model->ranks, own, key);
}

/* Accepted steps since the start of the run, with the one in hand. */
static inline dem_index run_count_steps(const dem_simulation *s)
{
    return integrator_counts(&s->integrator).steps;
}

/* Whether elements break by themselves. */
static inline bool run_may_break(const dem_simulation *s)
{
    return s->breaks.model != NULL;
}

/* What rigid bodies keep when their shapes are put back. */
static inline rigid_invariant run_keeps(const dem_simulation *s)
{
    return s->options.method == DEM_METHOD_VERLET ? RIGID_MOTION_MOMENTUM : RIGID_MOTION_SPIN;
}

static inline bool run_is_local(const dem_simulation *s)
{
    return s->options.contact == DEM_CONTACT_LOCAL;
}

/* Whether there were events inside the step in hand, on any rank; none with `exact`. */
static inline bool run_had_events(const dem_simulation *s)
{
    return run_is_local(s) && !s->queue.quiet;
}

/** Whether something has touched in the step that was taken last, of which the end is seen now. */
bool run_touches(const dem_simulation *s);

#endif
