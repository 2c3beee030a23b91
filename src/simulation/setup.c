/* SPDX-License-Identifier: BSD-3-Clause */
/* Creates a simulation, from a model or from a checkpoint, and destroys it. Set-up goes from what nothing else needs to
 * what needs it all: layout of the state, boundary conditions and external force, options with their defaults, kernel,
 * contacts, event sources and their queue, and last the integrator, which takes over the state. Here contact and forces
 * are handed to src/events as tables of functions. A failure at any place leaves what dem_simulation_destroy() can
 * free. */
#include <stdlib.h>
#include <string.h>

#include "base/aligned.h"
#include "base/checkpoint_entries.h"
#include "base/freed_memory.h"
#include "base/rank_order.h"
#include "base/reduce.h"
#include "base/status.h"
#include "contact/contact_constraints.h"
#include "simulation/body_contact.h"
#include "simulation/guard_bound.h"
#include "simulation/breaking.h"
#include "simulation/checkpoint.h"
#include "simulation/led_run.h"
#include "simulation/likeness.h"
#include "simulation/options.h"
#include "simulation/query.h"
#include "simulation/right_hand_side.h"
#include "simulation/shared_checkpoint.h"
#include "simulation/step_parts.h"
#include "simulation/unseen_steps.h"

/* What is seen of it. */
static dem_status allocate_seen(dem_simulation *s)
{
    const obstacle_set *o = &s->model->obstacles;
    const size_t n = (size_t)state_size(&s->layout);
    s->frame = malloc(n * sizeof *s->frame);
    s->measures = calloc(1, sizeof *s->measures);
    s->survey = calloc(1, sizeof *s->survey);
    s->field = calloc(1, sizeof *s->field);
    s->bodies = calloc((size_t)s->model->n_bodies, sizeof *s->bodies);
    s->inertia = calloc((size_t)s->model->n_bodies, sizeof *s->inertia);
    if (o->is_asked) s->poses = calloc((size_t)o->n, sizeof *s->poses);
    CHECK(s->frame && s->measures && s->survey && s->field && s->bodies && s->inertia && (s->poses || !o->is_asked),
          DEM_ERROR_MEMORY, "out of memory for the state of %lld nodes", (long long)s->model->lattice.n_nodes);
    return DEM_OK;
}

static dem_status allocate(dem_simulation *s)
{
    s->y = s->initial = aligned_zeros((size_t)state_size(&s->layout));
    CHECK(s->y, DEM_ERROR_MEMORY, "out of memory for the state of %lld nodes", (long long)s->model->lattice.n_nodes);
    return allocate_seen(s);
}

/* Changes of one candidate in a step beyond which it is taken again, shorter (docs/algorithms.md, Refused states). */
enum { most_changes_in_step = 50 };

/* Changes of one candidate in a step after which a contact that turns back sticks until the step ends. */
enum { turns_in_step = 20 };

/* What contacts need of the options. A storm is more than max_impacts changes of one candidate within 1/omega_max, the
 * shortest time in which a lattice moves. */
static contact_rule rule_of(const dem_simulation *s)
{
    const dem_model *model = s->model;
    const dem_options *o = &s->options;
    const bool can_shorten = run_is_local(s) && o->fixed_step == 0.0;
    return (contact_rule){.penetration_tolerance = o->penetration_tolerance,
                          .position_error = o->rtol * o->spacing,
                          .rest_speed = o->rest_speed,
                          .window = o->window,
                          .max_step = o->max_step,
                          .storm_time = model->omega_max > 0.0 ? 1.0 / model->omega_max : 2.0 * o->max_step,
                          .max_impacts = o->max_impacts,
                          .most_in_step = can_shorten ? most_changes_in_step : 0,
                          .turns_in_step = run_is_local(s) ? turns_in_step : 0,
                          .vertices = o->vertices != 0,
                          .layout = s->layout,
                          .team = model->obstacles.is_asked ? NULL : s->team};
}

static forces forces_of(const dem_simulation *s)
{
    const dem_options *o = &s->options;
    return (forces){.model = s->model,
                    .gravity = {o->gravity[0], o->gravity[1]},
                    .mass_damping = o->mass_damping,
                    .boundaries = s->boundaries.n > 0 ? &s->boundaries : NULL,
                    .surfaces = s->surfaces,
                    .rigid = s->rigid,
                    .external = s->external,
                    .clock = state_total_index(&s->layout, STATE_TIME)};
}

/* Contact is the first source of events, and so comes first of those at the same time. */
static dem_status set_up_sources(dem_simulation *s)
{
    TRY(contact_source_create(&s->contact_events, &s->automaton));
    TRY(source_list_add(&s->sources, contact_source_events(&s->contact_events)));
    return breaking_create(s);
}

/* Local corrections have the tolerances of the integrator, and the order of its method; with fixed steps their errors
 * are not controlled. */
static dem_status set_up_queue(dem_simulation *s)
{
    const dem_options *o = &s->options;
    const domain *d = s->model->domain;
    const dem_index n_nodes = d != NULL ? d->n_whole : s->layout.n_nodes;
    dem_method_traits method = {.struct_size = sizeof method};
    TRY(dem_method_describe(&method, o->method));
    local_springs_create(&s->local_springs, &s->forces, &s->layout);
    s->local_forces = local_springs_forces(&s->local_springs);
    s->closed_contacts = contact_constraints_of(&s->automaton);
    return event_queue_create(
        &s->queue, &(event_queue_parts){.layout = &s->layout,
                                        .forces = &s->local_forces,
                                        .constraints = &s->closed_contacts,
                                        .sources = &s->sources,
                                        .is_common = d != NULL ? d->is_common : NULL,
                                        .rule = {method.order, o->rtol * o->spacing, o->rtol * o->v_scale, n_nodes},
                                        .happens = s->model->obstacles.n > 0 || run_may_break(s),
                                        .controlled = !(o->fixed_step > 0.0)});
}

/* Nodes of a share: to claim it takes less than a hundredth of any loop over them. */
enum { SHARE_NODES = 2000 };

/* Where fewer threads can be created than are worth it, the options say how many work. */
static void create_team(dem_simulation *s)
{
    dem_options *o = &s->options;
    s->team = team_create(o->threads, o->thread_nodes < SHARE_NODES ? o->thread_nodes : SHARE_NODES);
    o->threads = team_threads(s->team);
}

/* What ranks that share a model cannot do yet. */
static dem_status check_shared(const dem_simulation *s)
{
    const dem_options *o = &s->options;
    if (s->model->domain == NULL) return DEM_OK;
    CHECK(o->bodies == DEM_BODIES_NONE || (s->model->touching != NULL && s->model->touching->has_all),
          DEM_ERROR_ARGUMENT,
          "bodies touch in a model of which ranks share no surfaces: it has to be made for options in which they do");
    return DEM_OK;
}

/* Positions, velocities and accelerations are exchanged. */
static dem_status set_up_domain(dem_simulation *s)
{
    const dem_model *model = s->model;
    s->shared = right_hand_side_domain(s);
    return halo_create(&s->halo, model->ranks, model->domain, s->layout.dim, 3);
}

static dem_status set_up(dem_simulation *s)
{
    const dem_model *model = s->model;
    const dem_options *o = &s->options;
    const size_t block = (size_t)state_row(&s->layout, model->lattice.n_nodes) * sizeof *s->y;
    exact_sum given = {0}; /* before the run: no work */
    TRY(check_shared(s));
    TRY(reduce_status(model->ranks,
                      boundary_conditions_compile(&s->boundaries, o->boundaries, o->n_boundaries, &model->lattice,
                                                  model->domain, model->obstacles.n),
                      0.0));
    s->options.boundaries = NULL;
    TRY(external_force_create(&s->external, o, s->layout.dim, model->lattice.n_nodes, model->domain));
    TRY(held_forces_create(&s->held_forces, &s->boundaries, s->external, &s->layout));
    TRY(options_fill(&s->options, model, &s->boundaries));
    TRY(body_contact_create(s));
    TRY(guard_bound_create(s));
    s->forces = forces_of(s);
    TRY(allocate(s));
    memcpy(s->y, model->lattice.position, block);
    memcpy(s->y + state_velocities(&s->layout), model->lattice.velocity, block);
    boundary_conditions_give_velocities(&s->boundaries, model->lattice.mass, 0.0, s->y + state_velocities(&s->layout),
                                        &given);
    if (model->domain != NULL) TRY(set_up_domain(s));
    create_team(s);
    TRY(kernel_create(&s->kernel, model, o->kernel, s->team));
    s->options.kernel = s->kernel.kind;
    TRY(survey_create(s->survey, &s->kernel));
    stress_field_create(s->field, &s->kernel);
    TRY(likeness_check_motions(s, 0.0));
    const contact_rule rule = rule_of(s);
    TRY(automaton_create(&s->automaton, &s->forces, &rule));
    TRY(reduce_status(s->model->ranks, automaton_check_start(&s->automaton, 0.0, s->y), 0.0));
    TRY(set_up_sources(s));
    if (run_is_local(s)) TRY(set_up_queue(s));
    TRY(unseen_steps_create(s));
    const ode_problem problem = right_hand_side_problem(s);
    TRY(integrator_create(&s->integrator, &problem, 0.0, s->y));
    s->y = integrator_state(&s->integrator);
    free(s->initial);
    s->initial = NULL;
    TRY(dem_checkpoint_create(&s->checkpoint));
    TRY(overlap_create(&s->overlap, &model->lattice, model->ranks, model->domain));
    overlap_look(&s->overlap, &model->lattice, s->t, s->y);
    query_at(s, 0.0, s->y);
    return DEM_OK;
}

/* Of a whole of which ranks have the parts, which leads their run and is not advanced itself. */
static dem_status set_up_leader(dem_simulation *s)
{
    TRY(allocate_seen(s));
    TRY(dem_checkpoint_create(&s->checkpoint));
    s->overlap.found.node = s->overlap.found.triangle = -1;
    query_at(s, 0.0, s->frame);
    return DEM_OK;
}

/* What a simulation goes on from. */
typedef struct start {
    const dem_checkpoint *checkpoint; /* of the whole; NULL: another rank has it, */
    slab_migration *kept;             /* and ranks the state, if they share out nodes anew; or NULL */
} start;

/* Of a model that ranks share rank 0 has the checkpoint. What is of a part becomes its last checkpoint where nobody has
 * that of the whole. */
static dem_status restore_part(dem_simulation *s, const start *from)
{
    dem_checkpoint *part = NULL;
    TRY(dem_checkpoint_create(&part));
    dem_status status = shared_checkpoint_scatter(s, from->checkpoint, from->kept, part);
    if (status == DEM_OK) status = checkpoint_restore(s, part);
    if (status == DEM_OK && from->kept != NULL) status = checkpoint_entries_move(s->checkpoint, part, NULL);
    dem_checkpoint_destroy(part);
    return status;
}

/* Goes on from a checkpoint: contacts have been taken up before, and no checkpoint is due at once, as the run has just
 * begun from one. The state is shown, which may ask the user's force. */
static dem_status resume(dem_simulation *s, const start *from)
{
    if (s->model->domain == NULL)
        TRY(checkpoint_restore(s, from->checkpoint));
    else
        TRY(restore_part(s, from));
    query_at(s, s->t, s->y);
    const dem_status status = query_ask(s);
    if (run_force_failed(s)) return run_force_failure(s);
    TRY(status);
    TRY(likeness_check_force(s));
    s->started = s->has_checkpoint = true;
    const bool has_whole = from->checkpoint != NULL && from->kept == NULL;
    return has_whole ? checkpoint_entries_copy(s->checkpoint, from->checkpoint) : DEM_OK;
}

/* Parts check what they go on from. */
static dem_status resume_leader(dem_simulation *s, const dem_checkpoint *checkpoint)
{
    s->has_checkpoint = true;
    return checkpoint_entries_copy(s->checkpoint, checkpoint);
}

/* \param from  NULL: it begins at rest positions */
static dem_status create(dem_simulation **out, const dem_model *model, const dem_options *options, const start *from)
{
    CHECK(out != NULL && model != NULL && options != NULL, DEM_ERROR_ARGUMENT, "dem_simulation_create: %s is NULL",
          out == NULL ? "out" : (model == NULL ? "model" : "options"));
    dem_options own;
    TRY(reduce_status(model->ranks, options_read(&own, options), 0.0));
    TRY(model_rows_renew(model)); /* a part of a model that ranks share has them */
    freed_memory_return(model->lattice.n_nodes);
    dem_simulation *s = calloc(1, sizeof *s);
    CHECK_MEMORY(s);
    s->model = model;
    s->options = own;
    s->layout = state_layout_of(model->lattice.dim, model->lattice.n_nodes, model->obstacles.n,
                                model->obstacles.bounds.speed > 0.0);
    const bool leads = model->part != NULL;
    dem_status status = reduce_status(s->model->ranks, leads ? set_up_leader(s) : set_up(s), 0.0);
    if (status == DEM_OK && from != NULL) status = leads ? resume_leader(s, from->checkpoint) : resume(s, from);
    freed_memory_return(model->lattice.n_nodes);
    if (status == DEM_OK)
        *out = s;
    else
        dem_simulation_destroy(s);
    return status;
}

dem_status dem_simulation_create(dem_simulation **out, const dem_model *model, const dem_options *options)
{
    return create(out, model, options, NULL);
}

dem_status dem_simulation_resume(dem_simulation **out, const dem_model *model, const dem_options *options,
                                 const dem_checkpoint *checkpoint)
{
    const bool is_elsewhere = model != NULL && model->ranks->rank > 0;
    CHECK(checkpoint != NULL || is_elsewhere, DEM_ERROR_ARGUMENT, "dem_simulation_resume: checkpoint is NULL");
    return create(out, model, options, &(start){.checkpoint = is_elsewhere ? NULL : checkpoint});
}

dem_status slab_migration_resume(dem_simulation **out, const dem_model *part, const dem_options *options,
                                 const dem_checkpoint *checkpoint, slab_migration *kept)
{
    return create(out, part, options, &(start){checkpoint, kept});
}

void dem_simulation_destroy(dem_simulation *s)
{
    if (s == NULL) return;
    led_run_destroy(s->leads);
    rank_order_forget(&s->kept);
    step_parts_destroy(s);
    breaking_destroy(s);
    boundary_conditions_free(&s->boundaries);
    rigid_contact_destroy(s->rigid);
    surface_load_free(&s->pushing);
    external_force_destroy(s->external);
    held_forces_destroy(&s->held_forces);
    halo_destroy(&s->halo);
    free(s->frame);
    free(s->measures);
    if (s->field != NULL) stress_field_destroy(s->field);
    free(s->field);
    free(s->survey);
    free(s->bodies);
    free(s->inertia);
    free(s->poses);
    dem_checkpoint_destroy(s->checkpoint);
    dem_checkpoint_destroy(s->rollback);
    team_destroy(s->team);
    free(s);
}

dem_status dem_simulation_observe(dem_simulation *s, const dem_observer *observer)
{
    CHECK(s != NULL && observer != NULL, DEM_ERROR_ARGUMENT, "dem_simulation_observe: %s is NULL",
          s == NULL ? "simulation" : "observer");
    CHECK(!s->advanced, DEM_ERROR_ARGUMENT, "observers come before the first advance");
    const dem_simulation *steps = s->leads != NULL ? led_run_part(s->leads) : s;
    return observers_add(&s->observers, observer, integrator_counts(&steps->integrator).steps > 0 ? s->t : -1.0);
}
