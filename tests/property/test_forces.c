/* SPDX-License-Identifier: BSD-3-Clause */
/* Random scenes in random fields of force: nobody sinks in, the ledger stays closed, also when nodes are put elsewhere
 * between advances; a run is the same to the bit with
 * more threads, in parts, watched, and resumed from its checkpoints; and a force that fails leaves a state from which
 * the run goes on. `test_forces [CASES [FIRST_SEED]]`. */
#include <stdlib.h>
#include <string.h>

#include "field.h"
#include "harness/cleanup_gsl.h"
#include "harness/motion.h"
#include "judge.h"

static long n_cases = 3, first_seed = 1;

typedef struct manner {
    dem_method method;
    dem_contact_method contact;
    int threads, cuts;
} manner;

/* A scene with its field. */
typedef struct stage {
    scene scene;
    field field;
    dem_model *model;
    dem_simulation *simulation;
} stage;

static void open_stage(stage *s, unsigned long seed, manner how, const dem_checkpoint *checkpoint)
{
    scene_random(&s->scene, seed);
    field_random(&s->field, &s->scene, seed);
    dem_options *o = &s->scene.options;
    o->method = how.method;
    o->contact = how.contact;
    o->threads = how.threads;
    o->thread_nodes = 1;
    o->checkpoint_steps = 20;
    o->force = field_act;
    o->force_context = &s->field;
    assert_ok(dem_model_create(&s->model, &s->scene.body, s->scene.obstacles, s->scene.n));
    if (checkpoint != NULL)
        assert_ok(dem_simulation_resume(&s->simulation, s->model, o, checkpoint));
    else
        assert_ok(dem_simulation_create(&s->simulation, s->model, o));
}

static void close_stage(stage *s)
{
    dem_simulation_destroy(s->simulation);
    dem_model_destroy(s->model);
    scene_free(&s->scene);
}

/* ---- what is looked at on the way ---- */

typedef struct watch {
    const scene *scene;
    boundary_condition boundary;
    double start, open, scale, depth; /* J, J, J, m */
    double last;                      /* s, of the last frame or event reported */
    long n_frames, n_events;
    int round;
} watch;

static dem_status on_step(void *context, const dem_simulation *simulation)
{
    watch *w = context;
    const dem_energy e = ask_energy(simulation);
    const double ledger = e.ledger;
    motion s;
    motion_see(simulation, &s);
    if (s.t == 0.0) w->start = ledger;
    w->scale = fmax(w->scale, e.motion + e.impact + e.friction + e.damping);
    w->open = fmax(w->open, fabs(ledger - w->start));
    w->round |= ask_counts(simulation).behind > 0;
    w->depth = fmax(w->depth, fmax(judge_nodes(w->scene, s.x), judge_vertices(w->scene, &w->boundary, s.x)));
    return DEM_OK;
}

static void hear(watch *w, const dem_simulation *simulation, double t)
{
    motion s;
    motion_see(simulation, &s);
    assert_close(s.t, t, 0.0);
    assert_true(t >= w->last);
    w->last = t;
}

static dem_status on_frame(void *context, const dem_simulation *simulation)
{
    watch *w = context;
    motion s;
    motion_see(simulation, &s);
    hear(w, simulation, s.t);
    assert_close(s.t, 1e-4 * (double)w->n_frames, 1e-15);
    w->n_frames++;
    return DEM_OK;
}

static dem_status on_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    watch *w = context;
    hear(w, simulation, event->t);
    w->n_events++;
    return DEM_OK;
}

static void watch_stage(watch *w, stage *s)
{
    const dem_observer observer =
        SIZED(dem_observer, .interval = 1e-4, .frame = on_frame, .step = on_step, .event = on_event, .context = w);
    *w = (watch){.scene = &s->scene};
    judge_boundary(&w->boundary, &s->scene.body);
    assert_ok(dem_simulation_observe(s->simulation, &observer));
}

/* As test_random.c judges scenes without: five penetration tolerances, 2e-3; Verlet's energies waver by (omega h)^2/4,
 * and omega h is 1/4 at most. */
static void judge(const watch *w, const stage *s, unsigned long seed)
{
    const dem_options o = ask_options(s->simulation);
    const double penetration_tolerance = o.penetration_tolerance,
                 most = o.method == DEM_METHOD_VERLET ? 1.0 / 64.0 : 2e-3;
    if (!(w->open <= most * w->scale)) fail_msg("seed %lu: the ledger is open by %g of %g J", seed, w->open, w->scale);
    if (!(w->depth <= 5.0 * penetration_tolerance) && !w->round)
        fail_msg("seed %lu: %g penetration tolerances deep", seed, w->depth / penetration_tolerance);
}

static const dem_contact_method contacts[2] = {DEM_CONTACT_LOCAL, DEM_CONTACT_EXACT};

TEST(the_ledger_stays_closed)
{
    long n_events = 0;
    for (long k = 0; k < 2 * n_cases; k++) {
        const unsigned long seed = (unsigned long)(first_seed + k / 2);
        CLEANUP(close_stage) stage s;
        watch w;
        open_stage(&s, seed, (manner){DEM_METHOD_FEHLBERG45, contacts[k % 2], 1, 0}, NULL);
        watch_stage(&w, &s);
        if (dem_simulation_advance(s.simulation, s.scene.t_end) != DEM_OK)
            fail_msg("seed %lu: %s", seed, dem_status_message());
        assert_true(w.n_frames > 10);
        judge(&w, &s, seed);
        n_events += w.n_events;
        free(w.boundary.ends);
    }
    print_message("# %ld events in %ld runs\n", n_events, 2 * n_cases);
    assert_true(n_events > 50 * n_cases);
}

/* ---- kicks ---- */

/* All nodes elsewhere, a thousandth nearer to the first, if that is not inside of something, and some faster. */
static int kick(stage *s, gsl_rng *rng)
{
    const dem_index n = 2 * s->scene.body.n_nodes;
    motion now;
    CLEANUP(free_memory) double *x = malloc((size_t)n * sizeof *x), *v = malloc((size_t)n * sizeof *v);
    assert_true(x != NULL && v != NULL);
    motion_see(s->simulation, &now);
    for (dem_index k = 0; k < n; k++) {
        x[k] = now.x[k] - 1e-3 * (now.x[k] - now.x[k % 2]);
        v[k] = 0.8 * now.v[k] + field_uniform(rng, 1.0);
    }
    const dem_status status = dem_simulation_set_motion(s->simulation, x, v);
    if (status != DEM_OK) {
        assert_int_equal(status, DEM_ERROR_MODEL);
        assert_ok(dem_simulation_set_motion(s->simulation, NULL, v));
    }
    motion_see(s->simulation, &now);
    assert_memory_equal(now.v, v, (size_t)n * sizeof *v);
    return status == DEM_OK;
}

TEST(kicks_enter_the_ledger)
{
    long n_moved = 0, n_events = 0;
    for (long k = 0; k < 2 * n_cases; k++) {
        const unsigned long seed = (unsigned long)(first_seed + k / 2);
        CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
        CLEANUP(close_stage) stage s;
        watch w;
        assert_non_null(rng);
        gsl_rng_set(rng, seed);
        open_stage(&s, seed, (manner){DEM_METHOD_FEHLBERG45, contacts[k % 2], 1, 0}, NULL);
        watch_stage(&w, &s);
        for (int part = 1; part <= 8; part++) {
            if (dem_simulation_advance(s.simulation, 0.0625 * part * s.scene.t_end) != DEM_OK)
                fail_msg("seed %lu: %s", seed, dem_status_message());
            n_moved += kick(&s, rng);
        }
        judge(&w, &s, seed);
        n_events += w.n_events;
        free(w.boundary.ends);
    }
    print_message("# %ld times moved, %ld events in %ld runs\n", n_moved, n_events, 2 * n_cases);
    assert_true(n_moved > 4 * n_cases && n_events > 50 * n_cases);
}

/* ---- bits ---- */

static void compare(const stage *a, const stage *b, unsigned long seed, const char *what)
{
    const size_t size = 2 * (size_t)a->scene.body.n_nodes * sizeof(double);
    motion one, other;
    motion_see(a->simulation, &one);
    motion_see(b->simulation, &other);
    if (one.n_contacts != other.n_contacts || memcmp(one.x, other.x, size) != 0 || memcmp(one.v, other.v, size) != 0)
        fail_msg("seed %lu: another run %s", seed, what);
}

static void go(stage *s, unsigned long seed, manner how, const dem_checkpoint *checkpoint)
{
    open_stage(s, seed, how, checkpoint);
    const double t_end = 0.25 * s->scene.t_end;
    for (int k = 1; k <= how.cuts; k++) assert_ok(dem_simulation_advance(s->simulation, t_end * k / (how.cuts + 1.0)));
    assert_ok(dem_simulation_advance(s->simulation, t_end));
}

TEST(nobody_leaves_a_trace)
{
    static const dem_method methods[3] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_HEUN12};
    for (long k = 0; k < n_cases; k++) {
        const unsigned long seed = (unsigned long)(first_seed + k);
        const manner how = {methods[k % 3], contacts[k % 2], 1, 0};
        const manner others[] = {{how.method, how.contact, 2, 0}, {how.method, how.contact, 1, 17}};
        stage alone, other;
        go(&alone, seed, how, NULL);
        for (int o = 0; o < 2; o++) {
            go(&other, seed, others[o], NULL);
            compare(&alone, &other, seed, o == 0 ? "with 2 threads" : "in parts");
            if (o == 0) assert_int_equal(alone.field.calls, other.field.calls);
            assert_memory_equal(&(dem_energy[1]){ask_energy(alone.simulation)},
                                &(dem_energy[1]){ask_energy(other.simulation)}, sizeof(dem_energy));
            close_stage(&other);
        }
        go(&other, seed, how, dem_simulation_checkpoint(alone.simulation));
        compare(&alone, &other, seed, "from its last checkpoint");
        close_stage(&other);
        close_stage(&alone);
    }
}

/* ---- failures ---- */

/* The states that a run goes through, as hashes of all that can be seen of them. */
typedef struct diary {
    dem_index n;
    struct {
        double t;
        uint64_t hash;
    } page[4096];
} diary;

static uint64_t add(uint64_t hash, const void *bytes, size_t n)
{
    const unsigned char *b = bytes;
    for (size_t k = 0; k < n; k++) hash = (hash ^ b[k]) * UINT64_C(0x100000001b3);
    return hash;
}

static uint64_t hash_of(const dem_simulation *simulation, const motion *s)
{
    const dem_model *model = dem_simulation_model(simulation);
    const size_t size = 2 * (size_t)ask_sizes(model).n_nodes * sizeof(double);
    const dem_counts c = ask_counts(simulation);
    const dem_index counts[3] = {c.events, c.impacts, c.releases};
    uint64_t hash = add(UINT64_C(0xcbf29ce484222325), s->x, size);
    hash = add(add(add(hash, s->v, size), &s->energy, sizeof s->energy), counts, sizeof counts);
    for (dem_index k = 0; k < s->n_contacts; k++) {
        const dem_contact *at = &s->contacts[k];
        hash = add(add(hash, &at->state, sizeof at->state), &at->force, 2 * sizeof(double));
    }
    return hash;
}

static dem_status enter(void *context, const dem_simulation *simulation)
{
    diary *d = context;
    motion s;
    motion_see(simulation, &s);
    assert_true(d->n < 4096);
    d->page[d->n].t = s.t;
    d->page[d->n++].hash = hash_of(simulation, &s);
    return DEM_OK;
}

static void write_diary(diary *d, stage *s, unsigned long seed, manner how)
{
    const dem_observer observer = {.struct_size = sizeof(dem_observer), .step = enter, .context = d};
    d->n = 0;
    open_stage(s, seed, how, NULL);
    (void)enter(d, s->simulation); /* contacts have not been looked for */
    assert_ok(dem_simulation_observe(s->simulation, &observer));
    assert_ok(dem_simulation_advance(s->simulation, 0.25 * s->scene.t_end));
}

/* Fails at one call, or at one about a single node (< 0), leaves a state that the run goes through, and goes on from
 * there. */
static void stumble(const diary *d, unsigned long seed, manner how, long call, dem_status wanted)
{
    CLEANUP(close_stage) stage s;
    watch w;
    motion state;
    dem_index page = 0;
    open_stage(&s, seed, how, NULL);
    watch_stage(&w, &s);
    s.field.fails_at = call > 0 ? call : 0;
    s.field.fails_at_alone = call < 0 ? -call : 0;
    s.field.status = wanted;
    const double t_end = 0.25 * s.scene.t_end;
    const dem_status status = dem_simulation_advance(s.simulation, t_end);
    assert_int_equal(call > 0 ? s.field.calls : -s.field.alone, call);
    assert_int_equal(status, wanted == DEM_OK ? DEM_ERROR_INTEGRATOR : wanted);
    assert_non_null(strstr(dem_status_message(), "the external force"));
    motion_see(s.simulation, &state);
    const uint64_t hash = hash_of(s.simulation, &state);
    while (page < d->n && (d->page[page].t != state.t || d->page[page].hash != hash)) page++;
    if (page == d->n) fail_msg("seed %lu: call %ld leaves a state of its own at t = %g s", seed, call, state.t);
    w.last = state.t; /* what was reported for later has not happened */
    if (dem_simulation_advance(s.simulation, t_end) != DEM_OK)
        fail_msg("seed %lu, call %ld: %s", seed, call, dem_status_message());
    judge(&w, &s, seed);
    free(w.boundary.ends);
}

TEST(a_force_that_fails_leaves_the_last_state)
{
    static const dem_status statuses[3] = {DEM_STOPPED, DEM_OK, DEM_ERROR_IO};
    static const dem_method methods[3] = {DEM_METHOD_RK4, DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET};
    static diary d;
    enum { most = 10 };
    for (long k = 0; k < n_cases; k++) {
        const unsigned long seed = (unsigned long)(first_seed + k);
        const manner how = {methods[k % 3], contacts[k % 2], 1, 0};
        CLEANUP(close_stage) stage whole;
        write_diary(&d, &whole, seed, how);
        for (long n = 0; n < most; n++) {
            const long call = n < 4 ? n + 1 : whole.field.calls * (n - 3) / (most - 3) - n % 3;
            if (call > 0) stumble(&d, seed, how, call, statuses[n % 3]);
        }
        for (long n = 1; n <= most && n <= whole.field.alone; n++)
            stumble(&d, seed, how, -whole.field.alone * n / most, statuses[n % 3]);
    }
}

int main(int argc, char **argv)
{
    if (argc > 1) n_cases = atol(argv[1]);
    if (argc > 2) first_seed = atol(argv[2]);
    return test_run();
}
