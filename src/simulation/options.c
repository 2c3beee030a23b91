/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks the options of a simulation and fills in the defaults that depend on the model: the longest step from the
 * highest frequency and the method's stability, the scale of speeds, the penetration tolerance, the window
 * (docs/method.md, Integration in time; docs/algorithms.md, Why 0.1). After options_fill() no option is left to be
 * decided elsewhere. */
#include "simulation/options.h"

#include "base/cores.h"
#include "base/reduce.h"
#include "base/status.h"
#include "base/struct_size.h"

/* `force_context` was the last member when sizes began to be honoured: what is added comes after it. */
static const struct_kind kind = {"dem_options", STRUCT_SIZE_WITH(dem_options, force_context), sizeof(dem_options)};

static const double adaptive_share = 0.5;   /* of 1/omega_max: longest step */
static const double fixed_share = 0.125;    /* of the stability bound: steps of methods that do not choose theirs */
static const double window_share = 0.1;     /* of 1/omega_max: default window, by the table in docs/algorithms.md */
static const dem_index thread_nodes = 2500; /* of a thread: docs/performance.md */

dem_status options_read(dem_options *ours, const dem_options *theirs)
{
    *ours = dem_options_default();
    TRY(struct_size_read(&kind, ours, theirs));
    return options_check(ours);
}

static dem_status check_friction(const dem_options *o)
{
    bool any = o->contact_friction > 0.0;
    CHECK(o->n_body_frictions >= 0 && (o->n_body_frictions == 0 || o->body_friction != NULL), DEM_ERROR_ARGUMENT,
          "n_body_frictions is %lld, body_friction is %s", (long long)o->n_body_frictions,
          o->body_friction != NULL ? "given" : "NULL");
    for (dem_index b = 0; b < o->n_body_frictions; b++) {
        CHECK(isfinite(o->body_friction[b]) && o->body_friction[b] >= 0.0, DEM_ERROR_ARGUMENT,
              "body_friction of body %lld must be >= 0, got %g", (long long)b, o->body_friction[b]);
        any = any || o->body_friction[b] > 0.0;
    }
    CHECK(!any || o->bodies != DEM_BODIES_NONE, DEM_ERROR_ARGUMENT,
          "contact_friction and body_friction are of bodies that touch, but the option bodies is none");
    return DEM_OK;
}

dem_status options_check(const dem_options *o)
{
    const double lengths[] = {
        o->spacing,    o->v_scale,           o->max_step,        o->fixed_step, o->penetration_tolerance,
        o->rest_speed, o->contact_thickness, o->contact_friction};
    static const char *const names[] = {
        "spacing",    "v_scale",           "max_step",        "fixed_step", "penetration_tolerance",
        "rest_speed", "contact_thickness", "contact_friction"};
    CHECK(isfinite(o->gravity[0]) && isfinite(o->gravity[1]), DEM_ERROR_ARGUMENT, "gravity (%g, %g) is not finite",
          o->gravity[0], o->gravity[1]);
    CHECK(o->gravity[2] == 0.0, DEM_ERROR_ARGUMENT, "gravity has a third component in the plane: %g", o->gravity[2]);
    CHECK(o->rtol >= 1e-13 && o->rtol <= 0.1, DEM_ERROR_ARGUMENT, "rtol must be in [1e-13, 0.1], got %g", o->rtol);
    for (int k = 0; k < 8; k++)
        CHECK(isfinite(lengths[k]) && lengths[k] >= 0.0, DEM_ERROR_ARGUMENT, "%s must be >= 0, got %g", names[k],
              lengths[k]);
    CHECK(isfinite(o->mass_damping) && o->mass_damping >= 0.0, DEM_ERROR_ARGUMENT, "mass_damping must be >= 0, got %g",
          o->mass_damping);
    CHECK(isfinite(o->window), DEM_ERROR_ARGUMENT, "window must be finite, got %g", o->window);
    CHECK(o->threads >= 1 && o->threads <= 1024, DEM_ERROR_ARGUMENT, "threads must be in [1, 1024], got %d",
          o->threads);
    CHECK(o->thread_nodes >= 0, DEM_ERROR_ARGUMENT, "thread_nodes must be >= 0, got %lld", (long long)o->thread_nodes);
    CHECK(o->contact == DEM_CONTACT_LOCAL || o->contact == DEM_CONTACT_EXACT, DEM_ERROR_ARGUMENT,
          "unknown contact method %d", (int)o->contact);
    CHECK(o->max_impacts >= 1, DEM_ERROR_ARGUMENT, "max_impacts must be >= 1, got %lld", (long long)o->max_impacts);
    CHECK(o->bodies >= DEM_BODIES_NONE && o->bodies <= DEM_BODIES_ALL, DEM_ERROR_ARGUMENT,
          "unknown contact of bodies %d", (int)o->bodies);
    CHECK(o->contact_stiffness == 0.0 || (o->contact_stiffness >= 0.01 && o->contact_stiffness <= 100.0),
          DEM_ERROR_ARGUMENT, "contact_stiffness must be in [0.01, 100], got %g", o->contact_stiffness);
    CHECK(o->pause >= 0.0 && o->pause <= 0.1, DEM_ERROR_ARGUMENT, "pause must be in [0, 0.1], got %g", o->pause);
    TRY(check_friction(o));
    CHECK(o->checkpoint_steps >= 0, DEM_ERROR_ARGUMENT, "checkpoint_steps must be >= 0, got %lld",
          (long long)o->checkpoint_steps);
    return DEM_OK;
}

/* Largest of the initial speed, that of boundaries and obstacles, the speed after the drop to the nearest obstacle, and
 * 1e-3 of the speed of sound, which is omega_max a/2 in a chain of spacing a. A rigid body drops by a spacing at
 * least. */
static double default_v_scale(const dem_options *o, const dem_model *model, const boundary_conditions *b)
{
    const dem_lattice *l = &model->lattice;
    double speed = 1e-3 * 0.5 * model->omega_max * o->spacing, drop = INFINITY;
    speed = fmax(speed, fmax(boundary_conditions_speed(b), model->obstacles.bounds.speed));
    for (dem_index i = 0; i < l->n_nodes; i++) speed = fmax(speed, vec2_norm(vec2_at(l->velocity, i)));
    for (dem_index k = 0; k < model->surface.n_nodes; k++)
        drop = fmin(drop, dem_model_gap(model, &l->position[vec2_row(model->surface.nodes[k])]));
    for (dem_index k = 0; k < model->rigid.n_nodes; k++)
        drop = fmin(drop, fmax(o->spacing, dem_model_gap(model, &l->position[vec2_row(model->rigid.nodes[k])])));
    speed = reduce_max(model->ranks, speed);
    drop = reduce_min(model->ranks, drop);
    const double g = hypot(o->gravity[0], o->gravity[1]);
    return isfinite(drop) && drop > 0.0 ? fmax(speed, sqrt(2.0 * g * drop)) : speed;
}

/* Largest rate at which damping slows anything, 1/s. */
static double damping_rate(const dem_options *o, const dem_model *m)
{
    return reduce_max(m->ranks, springs_damping_bound(&m->springs, m->lattice.x, m->inverse_mass)) + o->mass_damping;
}

/* As many threads as pay, up to those that were asked for: a step of few nodes ends before another thread has begun. */
static void fill_threads(dem_options *o, dem_index n_nodes)
{
    const dem_index nodes = o->thread_nodes > 0 ? o->thread_nodes : thread_nodes;
    const dem_index pay = n_nodes / nodes > 1 ? n_nodes / nodes : 1;
    int most = o->threads;
    if (most > 1 && o->thread_nodes == 0 && cores_allowed() < most) most = cores_allowed();
    o->threads = (int32_t)(pay < most ? pay : most);
    o->thread_nodes = nodes;
}

dem_status options_fill(dem_options *o, const dem_model *model, const boundary_conditions *b)
{
    if (o->spacing == 0.0) o->spacing = model->spacing;
    CHECK(o->spacing > 0.0, DEM_ERROR_ARGUMENT, "a model without springs needs the option spacing, in m");
    dem_method_traits method = {.struct_size = sizeof method};
    TRY(dem_method_describe(&method, o->method));
    if (o->fixed_step > 0.0) o->max_step = o->fixed_step;
    const double rate = damping_rate(o, model);
    CHECK(isfinite(rate), DEM_ERROR_ARGUMENT, "damping of springs or masses is too strong to compute with");
    const double needed = model->obstacles.bounds.step_rate;
    if (o->max_step == 0.0 && model->omega_max > 0.0)
        o->max_step =
            fmin((method.adaptive ? adaptive_share : fixed_share * method.stable) / fmax(model->omega_max, rate),
                 1.0 / needed);
    CHECK(o->max_step > 0.0, DEM_ERROR_ARGUMENT, "a model %s needs the option max_step, in s",
          model->rigid.n > 0 ? "of rigid bodies alone" : "without springs");
    CHECK(needed * o->max_step <= 1.0 + 1e-9, DEM_ERROR_ARGUMENT,
          "obstacles that oscillate or turn need steps of at most %g s (1/20 of a period, 0.05 rad): max_step and "
          "fixed_step must not be longer, got %g s",
          1.0 / needed, o->max_step);
    if (!method.adaptive) o->fixed_step = o->max_step;
    if (o->penetration_tolerance == 0.0) o->penetration_tolerance = 1e-6 * o->spacing;
    if (o->window < 0.0 && o->contact == DEM_CONTACT_EXACT && model->omega_max > 0.0)
        o->window = window_share * fmin(1.0 / model->omega_max, 2.0 * o->max_step);
    o->window = fmax(o->window, 0.0);
    fill_threads(o, model->lattice.n_nodes);
    if (o->contact_stiffness == 0.0) o->contact_stiffness = 1.0;
    if (o->v_scale == 0.0) o->v_scale = default_v_scale(o, model, b);
    CHECK(o->v_scale > 0.0, DEM_ERROR_ARGUMENT, "nothing sets a scale of speed: the option v_scale is needed, in m/s");
    return DEM_OK;
}
