/* SPDX-License-Identifier: BSD-3-Clause */
/* A run is the same to the last bit whoever watches it: random bodies alone, again, with 2 and 3 threads, cut into
 * parts, and with observers that ask for everything at events, frames, steps and some of them, or for
 * nothing. `test_bits [CASES [FIRST_SEED]]`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/motion.h"
#include "scene.h"

static long n_cases = 10, first_seed = 1;

/* All that can be seen of a simulation, as bytes. */
typedef struct picture {
    size_t n;
    unsigned char *bytes;
} picture;

static void put(picture *p, const void *from, size_t n)
{
    p->bytes = realloc(p->bytes, p->n + n + 1);
    assert_non_null(p->bytes);
    memcpy(p->bytes + p->n, from, n);
    p->n += n;
}

static picture take_picture(const dem_simulation *simulation)
{
    const dem_model_size size = ask_sizes(dem_simulation_model(simulation));
    picture p = {0};
    motion s;
    motion_see(simulation, &s);
    const dem_counts counts = ask_counts(simulation);
    put(&p, &s.t, sizeof s.t);
    put(&p, s.x, 2 * (size_t)size.n_nodes * sizeof *s.x);
    put(&p, s.v, 2 * (size_t)size.n_nodes * sizeof *s.v);
    put(&p, &s.energy, sizeof s.energy);
    put(&p, &counts, sizeof counts);
    for (dem_index k = 0; k < s.n_contacts; k++) put(&p, &s.contacts[k].force, 2 * sizeof(double));
    for (dem_index k = 0; k < size.n_obstacles; k++) {
        const dem_obstacle_load load = ask_obstacle(simulation, k);
        put(&p, load.impulse, sizeof load.impulse);
        put(&p, load.friction_impulse, sizeof load.friction_impulse);
    }
    return p;
}

/* ---- observers ---- */

/* Asks for everything, and that twice the same. */
static dem_status ask(void *context, const dem_simulation *simulation)
{
    picture once = take_picture(simulation), twice = take_picture(simulation);
    long *n = context;
    assert_int_equal(once.n, twice.n);
    assert_memory_equal(once.bytes, twice.bytes, once.n);
    free(once.bytes);
    free(twice.bytes);
    ++*n;
    return DEM_OK;
}

/* What an impact has done has been done to what is shown then. */
static dem_status ask_at_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    motion s;
    motion_see(simulation, &s);
    assert_close(s.t, event->t, 0.0);
    return ask(context, simulation);
}

static dem_status ask_nothing(void *context, const dem_simulation *simulation)
{
    (void)simulation;
    ++*(long *)context;
    return DEM_OK;
}

static dem_status hear_nothing(void *context, const dem_simulation *simulation, const dem_event *event)
{
    (void)event;
    return ask_nothing(context, simulation);
}

static const dem_observer observers[] = {
    {.struct_size = sizeof(dem_observer), .interval = 0.0},
    SIZED(dem_observer, .interval = 1e-5, .frame = ask_nothing, .step = ask_nothing, .event = hear_nothing),
    {.struct_size = sizeof(dem_observer), .interval = 3e-6, .frame = ask},
    {.struct_size = sizeof(dem_observer), .interval = 0.0, .event = ask_at_event},
    {.struct_size = sizeof(dem_observer), .interval = 7e-6, .frame = ask, .step = ask, .event = ask_at_event},
    {.struct_size = sizeof(dem_observer), .step = ask, .step_every = 5, .step_interval = 1e-5, .step_touching = 1},
};
enum { n_observers = sizeof observers / sizeof *observers };

/* ---- runs ---- */

typedef struct manner {
    int observer, threads, cuts;
} manner;

static picture run_scene(unsigned long seed, dem_method method, manner how)
{
    CLEANUP(scene_free) scene sc;
    CLEANUP(support_close) support_run run;
    long n_calls = 0;
    scene_random(&sc, seed);
    sc.options.contact = DEM_CONTACT_LOCAL;
    sc.options.method = method;
    sc.options.threads = how.threads;
    sc.options.thread_nodes = 1;
    dem_observer observer = observers[how.observer];
    observer.context = &n_calls;
    support_open(&run, &sc.body, sc.obstacles, sc.n, &sc.options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    const double t_end = 0.5 * sc.t_end;
    for (int k = 1; k <= how.cuts; k++) assert_ok(dem_simulation_advance(run.simulation, t_end * k / (how.cuts + 1.0)));
    assert_ok(dem_simulation_advance(run.simulation, t_end));
    assert_true(n_calls > 0 || observer.interval == 0.0);
    const picture p = take_picture(run.simulation);
    return p;
}

static void check_manner(unsigned long seed, dem_method method, const picture *alone, manner how)
{
    picture p = run_scene(seed, method, how);
    if (p.n != alone->n || memcmp(p.bytes, alone->bytes, p.n) != 0)
        fail_msg("seed %lu, method %d: observer %d, %d threads, %d cuts leave a trace", seed, (int)method, how.observer,
                 how.threads, how.cuts);
    free(p.bytes);
}

/* Each by Fehlberg's method; some by methods with steps of one length, Verlet's parabolas among them. */
TEST(nobody_leaves_a_trace)
{
    static const dem_method methods[3] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_RK4};
    for (long k = 0; k < n_cases; k++)
        for (int m = 0; m < (k % 4 == 0 ? 3 : 1); m++) {
            const unsigned long seed = (unsigned long)(first_seed + k);
            picture alone = run_scene(seed, methods[m], (manner){0, 1, 0});
            check_manner(seed, methods[m], &alone, (manner){0, 1, 0});
            check_manner(seed, methods[m], &alone, (manner){0, 1, 37});
            check_manner(seed, methods[m], &alone, (manner){0, 2, 0});
            check_manner(seed, methods[m], &alone, (manner){4, 3, 5});
            for (int o = 1; o < n_observers; o++) check_manner(seed, methods[m], &alone, (manner){o, 1, 0});
            free(alone.bytes);
        }
}

/* A strip of 201 columns that comes down flat on bumps: enough candidates for threads to share them. */
static picture run_strip(int threads)
{
    static const double lift[2] = {0.0, 2.5e-4}, down[2] = {1.0, -5.0};
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.0);
    double points[2 * 61];
    dem_obstacle ground = SIZED(dem_obstacle, .n_points = 61, .points = points, .restitution = 0.5, .friction = 0.3);
    dem_options options = support_options();
    CLEANUP(support_close) support_run run;
    for (int k = 0; k <= 60; k++) {
        points[2 * k] = 0.01 * (k - 30);
        points[2 * k + 1] = 2e-4 * sin(2.0 * k);
    }
    dem_lattice strip = support_rectangle(0.2, 4e-3, 1e-3, &rubber);
    dem_lattice_move(&strip, 0.0, lift);
    assert_ok(dem_lattice_launch(&strip, down));
    options.contact = DEM_CONTACT_LOCAL;
    options.threads = threads;
    options.thread_nodes = 1;
    support_open(&run, &strip, &ground, 1, &options);
    dem_lattice_free(&strip);
    assert_ok(dem_simulation_advance(run.simulation, 1e-4));
    assert_true(run.n_impacts > 100);
    const picture p = take_picture(run.simulation);
    return p;
}

TEST(threads_that_share_the_candidates_leave_no_trace)
{
    picture alone = run_strip(1);
    for (int threads = 2; threads <= 3; threads++) {
        picture p = run_strip(threads);
        assert_int_equal(p.n, alone.n);
        assert_memory_equal(p.bytes, alone.bytes, p.n);
        free(p.bytes);
    }
    free(alone.bytes);
}

int main(int argc, char **argv)
{
    if (argc > 1) n_cases = atol(argv[1]);
    if (argc > 2) first_seed = atol(argv[2]);
    return test_run();
}
