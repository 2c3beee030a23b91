/* SPDX-License-Identifier: BSD-3-Clause */
/* query.c: what is seen of a simulation, and when. */
#include "ask.h"
#include "harness/message.h"
#include "runs.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

TEST(a_new_simulation_shows_the_initial_state)
{
    const double v[2] = {3.0, 4.0};
    const dem_options options = point_options();
    dem_state now = {.struct_size = sizeof now};
    CLEANUP(free_model) dem_model *model = make_point(v, 0.5);
    CLEANUP(free_simulation) dem_simulation *simulation = simulate(model, &options);
    dem_simulation_state(simulation, &now);
    assert_close(now.t, 0.0, 0.0);
    assert_close(now.x[1], 1.0, 0.0);
    assert_close(now.v[0], 3.0, 0.0);
    assert_int_equal(now.n_contacts, 0);
    assert_close(ask_energy(simulation).kinetic, 25.0, 0.0);
    assert_close(ask_energy(simulation).gravity, 2.0 * 9.81, 0.0);
    assert_int_equal(ask_counts(simulation).steps, 0);
}

/* ---- what callers of other headers, and wrong arguments, get ---- */

/* Every function that fills a struct, with the number of its first thing. */
typedef struct getter {
    const char *name;
    size_t size;
    dem_status (*ask)(const dem_simulation *simulation, dem_index number, void *out);
    bool numbered;
} getter;

#define PLAIN(function, type)                                                                                          \
    static dem_status get_##type(const dem_simulation *simulation, dem_index number, void *out)                        \
    {                                                                                                                  \
        (void)number;                                                                                                  \
        return function(simulation, out);                                                                              \
    }
#define NUMBERED(function, type)                                                                                       \
    static dem_status get_##type(const dem_simulation *simulation, dem_index number, void *out)                        \
    {                                                                                                                  \
        return function(simulation, number, out);                                                                      \
    }
#define OF_MODEL(function, type)                                                                                       \
    static dem_status get_##type(const dem_simulation *simulation, dem_index number, void *out)                        \
    {                                                                                                                  \
        (void)number;                                                                                                  \
        return function(simulation == NULL ? NULL : dem_simulation_model(simulation), out);                            \
    }
PLAIN(dem_simulation_state, dem_state)
PLAIN(dem_simulation_progress, dem_progress)
PLAIN(dem_simulation_energy, dem_energy)
PLAIN(dem_simulation_strain, dem_strain)
PLAIN(dem_simulation_overlap, dem_overlap)
PLAIN(dem_simulation_surfaces, dem_surfaces)
PLAIN(dem_simulation_counts, dem_counts)
PLAIN(dem_simulation_options, dem_options)
NUMBERED(dem_simulation_contact, dem_contact)
NUMBERED(dem_simulation_body, dem_body_motion)
NUMBERED(dem_simulation_obstacle, dem_obstacle_load)
NUMBERED(dem_simulation_boundary, dem_boundary_load)
OF_MODEL(dem_model_sizes, dem_model_size)
OF_MODEL(dem_model_csr, dem_csr)
#define ENTRY(type, numbered)                                                                                          \
    {                                                                                                                  \
#type, sizeof(type), get_##type, numbered                                                                      \
    }
static const getter getters[] = {
    ENTRY(dem_state, false),        ENTRY(dem_energy, false),     ENTRY(dem_strain, false),
    ENTRY(dem_overlap, false),      ENTRY(dem_counts, false),     ENTRY(dem_options, false),
    ENTRY(dem_contact, true),       ENTRY(dem_body_motion, true), ENTRY(dem_obstacle_load, true),
    ENTRY(dem_boundary_load, true), ENTRY(dem_surfaces, false),   ENTRY(dem_model_size, false),
    ENTRY(dem_csr, false),          ENTRY(dem_progress, false)};
enum { n_getters = sizeof getters / sizeof getters[0], largest = 4096 };

/* A node that rests on the floor, and a boundary that loads it. */
static void rest_loaded(dem_simulation **simulation, dem_model **model)
{
    static const dem_index node = 0;
    const dem_boundary load = SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .components = 3, .n_nodes = 1,
                                    .nodes = &node, .value = {0.0, -1.0});
    dem_options options = point_options();
    options.boundaries = &load;
    options.n_boundaries = 1;
    *model = make_point(NULL, 0.0);
    *simulation = simulate(*model, &options);
    assert_ok(dem_simulation_advance(*simulation, 2.0));
}

/* A caller of an older header has a shorter struct, allocated here with its size so that a memory checker sees what is
 * written beyond; one of a newer header has a longer one. */
TEST(a_struct_is_written_as_far_as_the_callers_size_goes)
{
    dem_simulation *simulation;
    CLEANUP(free_model) dem_model *model;
    rest_loaded(&simulation, &model);
    for (int g = 0; g < n_getters; g++) {
        const size_t whole = getters[g].size, head = sizeof whole;
        CLEANUP(free_memory) char *full = calloc(1, whole + 16);
        const size_t longer = whole + 16;
        assert_non_null(full);
        memcpy(full, &longer, head);
        assert_ok(getters[g].ask(simulation, 0, full));
        assert_memory_equal(full, &longer, head);
        for (size_t k = whole; k < longer; k++) assert_int_equal(full[k], 0);
        for (size_t size = 2 * head; size < whole; size += head) {
            CLEANUP(free_memory) char *shorter = malloc(size);
            assert_non_null(shorter);
            memcpy(shorter, &size, head);
            assert_ok(getters[g].ask(simulation, 0, shorter));
            assert_memory_equal(shorter, &size, head);
            assert_memory_equal(shorter + head, full + head, size - head);
        }
    }
    dem_simulation_destroy(simulation);
}

TEST(a_struct_without_a_size_and_null_are_refused_and_nothing_is_written)
{
    dem_simulation *simulation;
    CLEANUP(free_model) dem_model *model;
    rest_loaded(&simulation, &model);
    for (int g = 0; g < n_getters; g++)
        for (size_t size = 0; size < 16; size += 15) {
            unsigned char out[largest], untouched[largest];
            char message[256];
            memset(out, 7, sizeof out);
            memcpy(out, &size, sizeof size);
            memcpy(untouched, out, sizeof out);
            (void)snprintf(message, sizeof message, "%s: struct_size is %zu, at least 16 expected", getters[g].name,
                           size);
            assert_int_equal(getters[g].ask(simulation, 0, out), DEM_ERROR_ARGUMENT);
            assert_message_parts(message);
            assert_int_equal(getters[g].ask(NULL, 0, out), DEM_ERROR_ARGUMENT);
            assert_int_equal(getters[g].ask(simulation, 0, NULL), DEM_ERROR_ARGUMENT);
            assert_non_null(strstr(dem_status_message(), " is NULL"));
            assert_memory_equal(out, untouched, sizeof out);
        }
    dem_simulation_destroy(simulation);
}

TEST(a_number_out_of_range_is_refused_and_nothing_is_written)
{
    dem_simulation *simulation;
    CLEANUP(free_model) dem_model *model;
    rest_loaded(&simulation, &model);
    for (int g = 0; g < n_getters; g++)
        for (dem_index number = -1; number <= 1 && getters[g].numbered; number += 2) {
            unsigned char out[largest], untouched[largest];
            memset(out, 7, sizeof out);
            memcpy(out, &getters[g].size, sizeof(size_t));
            memcpy(untouched, out, sizeof out);
            assert_int_equal(getters[g].ask(simulation, number, out), DEM_ERROR_ARGUMENT);
            assert_non_null(strstr(dem_status_message(), number < 0 ? " -1: there are 1" : " 1: there are 1"));
            assert_memory_equal(out, untouched, sizeof out);
        }
    dem_simulation_destroy(simulation);
}

TEST(arrays_that_are_null_and_a_node_that_is_not_there_are_refused)
{
    dem_simulation *simulation;
    CLEANUP(free_model) dem_model *model;
    double stress[3] = {7.0, 7.0, 7.0};
    rest_loaded(&simulation, &model);
    assert_int_equal(dem_simulation_strains(simulation, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_forces(simulation, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_stress(simulation, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_force_at(simulation, 0, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_force_at(simulation, 0, stress), DEM_ERROR_ARGUMENT); /* it has no springs */
    assert_int_equal(dem_simulation_stress_at(simulation, 0, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_stress_at(simulation, 1, stress), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_stress_at(NULL, 0, stress), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_contact_forces(simulation, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_contact_forces(NULL, stress), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_contact_pressures(simulation, NULL), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_contact_pressures(NULL, stress), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_pair(simulation, 0, NULL), DEM_ERROR_ARGUMENT);
    assert_close(stress[0], 7.0, 0.0);
    assert_true(isnan(dem_simulation_residual(NULL)));
    assert_true(isnan(dem_simulation_ramp_time(NULL)));
    assert_true(isnan(dem_simulation_fastest(NULL)));
    assert_null(dem_simulation_model(NULL));
    assert_null(dem_simulation_checkpoint(NULL));
    dem_simulation_destroy(simulation);
}

/* At rest on the floor after the plastic impact: m g, and m g t of impulse from the beginning on, up to the step in
 * hand. */
TEST(an_obstacle_feels_the_weight_that_rests_on_it)
{
    const dem_options options = point_options();
    dem_state now = {.struct_size = sizeof now};
    CLEANUP(free_model) dem_model *model = make_point(NULL, 0.0);
    CLEANUP(free_simulation) dem_simulation *simulation = simulate(model, &options);
    assert_ok(dem_simulation_advance(simulation, 2.0));
    const dem_obstacle_load load = ask_obstacle(simulation, 0);
    dem_simulation_state(simulation, &now);
    assert_int_equal(load.n_contacts, 1);
    assert_int_equal(now.n_contacts, 1);
    assert_int_equal(ask_contact(simulation, 0).nodes[0], 0);
    assert_close(load.reaction[0], 0.0, 0.0);
    assert_close(load.reaction[1], 2.0 * 9.81, 1e-14);
    assert_close(load.impulse[1], 2.0 * 9.81 * 2.0, 2.0 * 9.81 * 0.031);
}

/* One step of 0.8 s, in the middle of which the node hits the floor, after sqrt(2 / 9.81) = 0.45 s. A look at any time
 * in it sees what has happened until then, in whatever order one looks. */
typedef struct look {
    double t[2];
    dem_index impacts[2];
    double lost[2];
    int n;
} look;

static dem_status see(void *context, const dem_simulation *simulation)
{
    look *seen = context;
    dem_state now = {.struct_size = sizeof now};
    dem_simulation_state(simulation, &now);
    assert_true(seen->n < 2);
    seen->t[seen->n] = now.t;
    seen->impacts[seen->n] = ask_counts(simulation).impacts;
    seen->lost[seen->n++] = ask_energy(simulation).impact;
    return DEM_OK;
}

/* Frames at 0 and 0.4 s are before the impact, the end at 0.6 s is after it; eta = 0.5 leaves a quarter of the energy
 * m g h, to the penetration tolerance of 1e-6 m. */
TEST(what_is_seen_within_a_step_is_without_later_events)
{
    dem_options options = point_options();
    look seen = {.n = 0};
    const dem_observer observer = SIZED(dem_observer, .interval = 0.4, .frame = see, .context = &seen);
    options.method = DEM_METHOD_RK4;
    options.max_step = options.fixed_step = 0.8;
    CLEANUP(free_model) dem_model *model = make_point(NULL, 0.5);
    CLEANUP(free_simulation) dem_simulation *simulation = simulate(model, &options);
    assert_ok(dem_simulation_observe(simulation, &observer));
    assert_ok(dem_simulation_advance(simulation, 0.6));
    assert_int_equal(seen.n, 2);
    assert_close(seen.t[1], 0.4, 0.0);
    assert_int_equal(seen.impacts[1], 0);
    assert_close(seen.lost[1], 0.0, 0.0);
    assert_int_equal(ask_counts(simulation).impacts, 1);
    assert_int_equal(ask_counts(simulation).steps, 1);
    assert_close(ask_energy(simulation).impact, 0.75 * 2.0 * 9.81, 1e-4);
}

/* ---- what only looks does not call the program's function ---- */

typedef struct pusher {
    long calls, fails_at; /* fails_at: the number of the call, from 1; 0: none */
    long poses;           /* calls of rise() */
} pusher;

static dem_status push(void *context, const dem_force_query *query, double *force)
{
    pusher *p = context;
    for (dem_index k = 0; k < 2 * query->n; k++) force[k] = 0.5 * query->x[k] - 0.3 * query->v[k];
    return ++p->calls == p->fails_at ? DEM_ERROR_IO : DEM_OK;
}

/* A floor that goes up. */
static dem_status rise(void *context, double t, dem_pose *pose)
{
    pusher *p = context;
    p->poses++;
    pose->velocity[1] = 0.05;
    pose->place[1] = 0.05 * t;
    return DEM_OK;
}

/* Two nodes, one above the other and joined by a spring, fall on a floor, on which the lower one stays; the upper one
 * goes straight down. */
static dem_simulation *drop_pair(dem_model **model, dem_contact_method contact, const dem_observer *observer, pusher *p)
{
    const double x[4] = {0.0, 0.1, 0.0, 1.1}, mass[2] = {1.0, 2.0}, v[4] = {0.0, -3.0, 0.0, -3.0};
    const dem_index ends[2] = {0, 1}, upper = 1;
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .motion = rise,
                                        .motion_context = p, .most_speed = 0.06, .most_acceleration = 1.0);
    const dem_boundary rail = SIZED(dem_boundary, .components = DEM_COMPONENT_X, .n_nodes = 1, .nodes = &upper);
    dem_options options = dem_options_default();
    dem_lattice lattice = support_lattice(2, x, mass, 1, ends, 1.0, 1000.0, NULL);
    support_start(&lattice, NULL, v);
    lattice.flags[upper] = 0;
    assert_ok(dem_model_create(model, &lattice, &obstacle, 1));
    dem_lattice_free(&lattice);
    options.contact = contact;
    options.checkpoint_steps = 5;
    options.n_boundaries = 1;
    options.boundaries = &rail;
    options.force = push;
    options.force_context = p;
    dem_simulation *simulation = NULL;
    assert_ok(dem_simulation_create(&simulation, *model, &options));
    assert_ok(dem_simulation_observe(simulation, observer));
    return simulation;
}

/* Calls every function that takes a simulation and changes nothing. */
static void look_at_all(const dem_simulation *s)
{
    dem_state now = {.struct_size = sizeof now};
    double strain, force, stress[6], of_contact[4], pressure[2], damage[2], of_cracks;
    double place[4], velocity[4];
    assert_ok(dem_simulation_state(s, &now));
    for (dem_index k = 0; k < now.n_contacts; k++) (void)ask_contact(s, k);
    const dem_progress there = ask_progress(s);
    assert_true(there.t == now.t && there.step == now.step && there.n_contacts == now.n_contacts);
    assert_ok(dem_simulation_gather(s, place, velocity));
    assert_memory_equal(place, now.x, sizeof place);
    assert_memory_equal(velocity, now.v, sizeof velocity);
    (void)ask_energy(s);
    (void)ask_strain(s);
    assert_ok(dem_simulation_strains(s, &strain));
    assert_ok(dem_simulation_damage(s, NULL, damage));
    assert_ok(dem_simulation_forces(s, &force));
    assert_ok(dem_simulation_force_at(s, 0, &force));
    assert_ok(dem_simulation_stress(s, stress));
    assert_ok(dem_simulation_stress_at(s, 1, stress));
    (void)ask_overlap(s);
    (void)ask_surfaces(s);
    assert_int_equal(ask_pair(s, 0).node, 0);
    assert_ok(dem_simulation_contact_forces(s, of_contact));
    assert_ok(dem_simulation_contact_pressures(s, pressure));
    (void)ask_counts(s);
    (void)ask_body(s, 0);
    assert_ok(dem_simulation_inertia(s, 0, &force));
    assert_int_equal(dem_simulation_inertia(s, 1, &force), DEM_ERROR_ARGUMENT);
    (void)ask_obstacle(s, 0);
    (void)ask_boundary(s, 0);
    double fastest = 0.0;
    for (int i = 0; i < 2; i++) fastest = fmax(fastest, fabs(now.v[2 * i]) + fabs(now.v[2 * i + 1]));
    assert_close(dem_simulation_fastest(s), fastest, 0.0);
    (void)dem_simulation_residual(s);
    (void)dem_simulation_ramp_time(s);
    (void)dem_simulation_checkpoint(s);
    (void)dem_model_gap(dem_simulation_model(s), now.x);
    (void)ask_options(s);
    assert_ok(dem_simulation_broken(s, NULL, NULL));
    dem_index *fragment = calloc((size_t)dem_model_lattice(dem_simulation_model(s))->n_nodes, sizeof *fragment);
    dem_index n_fragments;
    assert_ok(dem_simulation_fragments(s, &n_fragments, fragment));
    free(fragment);
    assert_int_equal(ask_fracture(s).fragments, n_fragments);
    assert_ok(dem_simulation_crack_energy(s, &of_cracks));
}

static dem_status only_look(void *context, const dem_simulation *simulation)
{
    const pusher *p = context;
    const long before = p->calls, poses = p->poses;
    look_at_all(simulation);
    assert_int_equal(p->calls, before);
    assert_int_equal(p->poses, poses);
    assert_true(isfinite(ask_boundary(simulation, 0).force[0]) || before == 0);
    return DEM_OK;
}

static dem_status only_look_at_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    (void)event;
    return only_look(context, simulation);
}

static dem_status only_look_at_checkpoint(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    (void)checkpoint;
    return only_look(context, simulation);
}

static dem_observer looker(pusher *p)
{
    return (dem_observer)SIZED(dem_observer, .interval = 0.007, .frame = only_look, .step = only_look,
                               .event = only_look_at_event, .checkpoint = only_look_at_checkpoint, .context = p);
}

enum { n_advances = 12 }; /* of 0.01 s each, with the impact after some 0.03 s */

TEST(no_getter_calls_a_function_of_the_program)
{
    for (int contact = DEM_CONTACT_LOCAL; contact <= DEM_CONTACT_EXACT; contact++) {
        pusher p = {0};
        const dem_observer observer = looker(&p);
        CLEANUP(free_model) dem_model *model;
        CLEANUP(free_simulation)
        dem_simulation *simulation = drop_pair(&model, (dem_contact_method)contact, &observer, &p);
        only_look(&p, simulation);
        for (int k = 1; k <= n_advances; k++) {
            assert_ok(dem_simulation_advance(simulation, 0.01 * k));
            only_look(&p, simulation);
        }
        assert_true(ask_counts(simulation).impacts > 0);
        assert_int_equal(ask_state(simulation).n_contacts, 1);
        assert_close(ask_obstacle(simulation, 0).displacement[1], 0.05 * 0.01 * n_advances, 1e-15);
        assert_ok(dem_simulation_set_motion(simulation, NULL, NULL));
        const long before = p.calls, poses = p.poses;
        look_at_all(simulation);
        assert_int_equal(p.calls, before);
        assert_int_equal(p.poses, poses);
        assert_true(isnan(ask_obstacle(simulation, 0).displacement[1]));
        assert_true(isnan(ask_boundary(simulation, 0).force[0]));
    }
}

/* Whichever call fails, the advance that makes it returns its status. */
TEST(a_force_that_fails_is_reported_by_the_advance_that_asked)
{
    for (int contact = DEM_CONTACT_LOCAL; contact <= DEM_CONTACT_EXACT; contact++) {
        bool failed = true;
        for (long call = 1; failed; call++) {
            pusher p = {.fails_at = call};
            const dem_observer observer = looker(&p);
            CLEANUP(free_model) dem_model *model;
            CLEANUP(free_simulation)
            dem_simulation *simulation = drop_pair(&model, (dem_contact_method)contact, &observer, &p);
            failed = false;
            for (int k = 1; k <= n_advances && !failed; k++) {
                const dem_status status = dem_simulation_advance(simulation, 0.01 * k);
                failed = p.calls >= call;
                assert_int_equal(status, failed ? DEM_ERROR_IO : DEM_OK);
            }
            look_at_all(simulation);
            if (failed) assert_ok(dem_simulation_advance(simulation, 0.01 * n_advances));
        }
    }
}
