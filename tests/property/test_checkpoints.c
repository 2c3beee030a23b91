/* SPDX-License-Identifier: BSD-3-Clause */
/* A run that is resumed from any of its checkpoints goes on to the last bit: random bodies run through, and again from
 * each checkpoint by a new simulation of a new model, with another number of threads, by both methods of contact; all
 * that is reported of events, steps and frames, and all that can be seen at the end, is the same. `test_checkpoints
 * [CASES [FIRST_SEED [EVERY]]]`, of the checkpoints. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/motion.h"
#include "scene.h"

static long n_cases = 2, first_seed = 1, every = 3;

enum { MOST_CHECKPOINTS = 400 };

/* What is reported of a run, as one number for each step: the hash of all before. */
typedef struct diary {
    uint64_t hash;
    dem_index n_checkpoints, n_frames, n_events;
    dem_checkpoint *checkpoints[MOST_CHECKPOINTS];
    uint64_t at[MOST_CHECKPOINTS]; /* the hash when the checkpoint was taken */
} diary;

static void enter(diary *d, const void *bytes, size_t n)
{
    const unsigned char *b = bytes;
    for (size_t k = 0; k < n; k++) d->hash = (d->hash ^ b[k]) * UINT64_C(0x100000001b3);
}

static void enter_all(diary *d, const dem_simulation *simulation)
{
    const dem_model_size size = ask_sizes(dem_simulation_model(simulation));
    const dem_counts counts = ask_counts(simulation);
    motion s;
    motion_see(simulation, &s);
    enter(d, &s.t, sizeof s.t);
    enter(d, &s.step, sizeof s.step);
    enter(d, s.x, 2 * (size_t)size.n_nodes * sizeof *s.x);
    enter(d, s.v, 2 * (size_t)size.n_nodes * sizeof *s.v);
    enter(d, &s.energy, sizeof s.energy);
    enter(d, &counts, sizeof counts);
    for (dem_index k = 0; k < s.n_contacts; k++) enter(d, &s.contacts[k].force, 2 * sizeof(double));
    for (dem_index k = 0; k < size.n_obstacles; k++) {
        const dem_obstacle_load load = ask_obstacle(simulation, k);
        enter(d, load.impulse, sizeof load.impulse);
        enter(d, load.friction_impulse, sizeof load.friction_impulse);
    }
}

static dem_status on_step(void *context, const dem_simulation *simulation)
{
    enter_all(context, simulation);
    return DEM_OK;
}

static dem_status on_frame(void *context, const dem_simulation *simulation)
{
    ((diary *)context)->n_frames++;
    return on_step(context, simulation);
}

static dem_status on_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    diary *d = context;
    (void)simulation;
    d->n_events++;
    enter(d, &event->t, sizeof event->t);
    enter(d, &event->node, sizeof event->node);
    enter(d, event->impulse, sizeof event->impulse);
    return DEM_OK;
}

/* Keeps a copy, by way of its entries. */
static dem_status on_checkpoint(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    diary *d = context;
    assert_ptr_equal(dem_simulation_checkpoint(simulation), checkpoint);
    assert_true(d->n_checkpoints < MOST_CHECKPOINTS);
    assert_ok(dem_checkpoint_write(checkpoint, "checkpoints.checkpoint"));
    assert_ok(dem_checkpoint_read(&d->checkpoints[d->n_checkpoints], "checkpoints.checkpoint"));
    d->at[d->n_checkpoints++] = d->hash;
    return DEM_OK;
}

static dem_observer observer_of(diary *d, int keeps)
{
    return (dem_observer)SIZED(dem_observer, .interval = 7e-6, .frame = on_frame, .step = on_step, .event = on_event,
                               .checkpoint = keeps ? on_checkpoint : NULL, .context = d);
}

/* ---- runs ---- */

typedef struct manner {
    dem_method method;
    dem_contact_method contact;
    int threads;
} manner;

static void set(scene *sc, unsigned long seed, manner how)
{
    scene_random(sc, seed);
    sc->options.method = how.method;
    sc->options.contact = how.contact;
    sc->options.threads = how.threads;
    sc->options.thread_nodes = 1;
    sc->options.checkpoint_steps = 5 + (dem_index)(seed % 7);
}

static void run_through(unsigned long seed, manner how, diary *d)
{
    CLEANUP(scene_free) scene sc;
    CLEANUP(support_close) support_run run;
    const dem_observer observer = observer_of(d, 1);
    set(&sc, seed, how);
    support_open(&run, &sc.body, sc.obstacles, sc.n, &sc.options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    assert_ok(dem_simulation_advance(run.simulation, 0.25 * sc.t_end));
    enter_all(d, run.simulation);
}

static uint64_t go_on_from(unsigned long seed, manner how, const diary *whole, dem_index k)
{
    CLEANUP(scene_free) scene sc;
    CLEANUP(free_simulation) dem_simulation *simulation;
    diary d = {.hash = whole->at[k]};
    const dem_observer observer = observer_of(&d, 0);
    set(&sc, seed, how);
    CLEANUP(free_model) dem_model *model = support_model(&sc.body, sc.obstacles, sc.n);
    assert_ok(dem_simulation_resume(&simulation, model, &sc.options, whole->checkpoints[k]));
    assert_ok(dem_simulation_observe(simulation, &observer));
    assert_ok(dem_simulation_advance(simulation, 0.25 * sc.t_end));
    enter_all(&d, simulation);
    return d.hash;
}

static long n_events;

static void check(unsigned long seed, manner how)
{
    diary whole = {.hash = UINT64_C(0xcbf29ce484222325)};
    run_through(seed, how, &whole);
    assert_true(whole.n_checkpoints > 1);
    n_events += whole.n_events;
    for (dem_index k = 0; k < whole.n_checkpoints; k++) {
        if (k % every == 0) {
            const manner again = {how.method, how.contact, 1 + (int)(k % 2)};
            if (go_on_from(seed, again, &whole, k) != whole.hash)
                fail_msg("seed %lu, method %d, contact %d: resumed from checkpoint %lld of %lld the run is another",
                         seed, (int)how.method, (int)how.contact, (long long)k, (long long)whole.n_checkpoints);
        }
        dem_checkpoint_destroy(whole.checkpoints[k]);
    }
}

TEST(every_checkpoint_leads_to_the_same_end)
{
    static const dem_method methods[3] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_RK4};
    for (long k = 0; k < n_cases; k++)
        for (int m = 0; m < (k % 4 == 0 ? 3 : 1); m++)
            for (int c = 0; c < 2; c++)
                check((unsigned long)(first_seed + k),
                      (manner){methods[m], c == 0 ? DEM_CONTACT_LOCAL : DEM_CONTACT_EXACT, 1});
    assert_true(n_events > 20 * n_cases);
    print_message("# %ld events in %ld scenes\n", n_events, n_cases);
}

int main(int argc, char **argv)
{
    if (argc > 1) n_cases = atol(argv[1]);
    if (argc > 2) first_seed = atol(argv[2]);
    if (argc > 3) every = atol(argv[3]);
    return test_run();
}
