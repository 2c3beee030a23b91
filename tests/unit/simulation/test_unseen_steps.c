/* SPDX-License-Identifier: BSD-3-Clause */
/* unseen_steps.c: runs in which nobody sees most steps beside the same runs with an observer of steps, all of which are
 * single then. Everything is to be the same to the bit: the state, frames, events and counts. */
#include "verification/support.h"

#include <string.h>

#include "forces/step_wave.h"
#include "harness/kernel_of_rows.h"

/* What the calls of the wave have come to. */
static struct tally {
    int steps, failures;
} waves;

bool real_step_wave_run(step_wave *w, const forces *f, step_wave_steps *steps) __asm__("__real_step_wave_run");
bool wrapped_step_wave_run(step_wave *w, const forces *f, step_wave_steps *steps) __asm__("__wrap_step_wave_run");

bool wrapped_step_wave_run(step_wave *w, const forces *f, step_wave_steps *steps)
{
    const bool holds = real_step_wave_run(w, f, steps);
    waves.steps += holds ? steps->n : 0;
    waves.failures += !holds;
    return holds;
}

/* ---- runs ---- */

static const double spacing = 1e-3, speed = 4.0; /* m, m/s */

/* Of 0.45 an area term acts, so that waves go by blocks of the layout, else by lattice rows. */
static double poissons_ratio = 1.0 / 3.0;

/* Waves by blocks pay from 250,000 nodes on. */
static double plate_width(void)
{
    return poissons_ratio > 0.4 ? 0.5 : 0.16;
}

/* A plate that flies down and swells: with a bell of speed about its middle. */
static dem_lattice make_plate(double swelling)
{
    const double width = plate_width(), height = 0.874 * width;
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = poissons_ratio,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    dem_lattice plate = support_rectangle(width, height, spacing, &rubber);
    CLEANUP(free_memory) double *v = malloc(2 * (size_t)plate.n_nodes * sizeof *v);
    assert_non_null(v);
    const double lift[2] = {0.0, -support_bottom(&plate)};
    dem_lattice_move(&plate, 0.0, lift);
    for (dem_index i = 0; i < plate.n_nodes; i++) {
        const double x = plate.x[2 * i] - 0.5 * width, y = plate.x[2 * i + 1] - 0.5 * height;
        const double bell = exp(-25.0 * (x * x + y * y) / (width * width));
        v[2 * i] = swelling * x * bell;
        v[2 * i + 1] = swelling * y * bell - speed;
    }
    support_start(&plate, NULL, v);
    return plate;
}

/* Over a floor, so many m below. */
static dem_model *make_model(double swelling, double height)
{
    const double points[4] = {-2.0, -height, 2.0, -height};
    const dem_obstacle floor = {.struct_size = sizeof floor, .n_points = 2, .points = points, .restitution = 0.5};
    CLEANUP(dem_lattice_free) dem_lattice plate = make_plate(swelling);
    return support_model(&plate, &floor, height > 0.0 ? 1 : 0);
}

/* Over another one at rest, so many m below. */
static dem_model *make_pair(double swelling, double height)
{
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .guard = 0.02);
    CLEANUP(dem_lattice_free) dem_lattice plate = make_plate(swelling);
    CLEANUP(dem_lattice_free) dem_lattice other = support_rectangle(0.6 * plate_width(), 0.01, spacing, &rubber);
    const double down[2] = {0.2 * plate_width(), -height - support_top(&other)};
    dem_lattice_move(&other, 0.0, down);
    assert_ok(dem_lattice_append(&plate, &other));
    return support_model(&plate, NULL, 0);
}

enum { FRAMES = 16 };

/* What observers have seen. */
typedef struct diary {
    int n_frames, n_events;
    dem_index n_steps, n_checkpoints;
    double frames[FRAMES][2]; /* when, and a number that all positions and velocities have part in */
    double last_event;
    int n_residuals;      /* at the ends of every seventh step, */
    double residual;      /* N, the last of them */
    dem_checkpoint *kept; /* the second checkpoint */
} diary;

static double sum_up(const motion *m, dem_index n)
{
    double sum = 0.0;
    for (dem_index k = 0; k < 2 * n; k++) sum += (double)(k % 17 + 1) * m->x[k] + (double)(k % 19 + 1) * m->v[k];
    return sum;
}

static motion see(const dem_simulation *simulation)
{
    motion m;
    assert_ok(motion_see(simulation, &m));
    return m;
}

static dem_status on_frame(void *context, const dem_simulation *simulation)
{
    diary *d = context;
    const motion m = see(simulation);
    assert_true(d->n_frames < FRAMES);
    d->frames[d->n_frames][0] = m.t;
    d->frames[d->n_frames++][1] = sum_up(&m, ask_sizes(dem_simulation_model(simulation)).n_nodes);
    return DEM_OK;
}

static dem_status on_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    diary *d = context;
    (void)simulation;
    d->n_events++;
    d->last_event = event->t;
    return DEM_OK;
}

static dem_status on_step(void *context, const dem_simulation *simulation)
{
    diary *d = context;
    d->n_steps++;
    const double residual = dem_simulation_residual(simulation);
    if (ask_counts(simulation).steps % 7 != 0 || isinf(residual)) return DEM_OK; /* it is of the state before a step */
    d->n_residuals++;
    d->residual = residual;
    return DEM_OK;
}

static dem_status on_checkpoint(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    diary *d = context;
    (void)simulation;
    if (++d->n_checkpoints != 2) return DEM_OK;
    assert_ok(dem_checkpoint_write(checkpoint, "unseen_steps.checkpoint"));
    return dem_checkpoint_read(&d->kept, "unseen_steps.checkpoint");
}

/* Steps are a quarter of the bound of stability. */
typedef struct plan {
    int threads;
    bool seen;       /* whether an observer sees every step, */
    int few;         /* else, if > 0, one sees the multiples of it, */
    bool touching;   /* and those in which something touches */
    int every;       /* steps between checkpoints */
    double interval; /* steps between frames */
    double ends[3];  /* steps to the ends of advances; 0: none */
    dem_bodies bodies;
} plan;

/* What a run has come to. */
typedef struct outcome {
    diary diary;
    motion end;
    double sum;
    dem_counts counts;
    dem_index n_pushing; /* pairs of surfaces */
    struct tally waves;
} outcome;

static dem_options options_of(const plan *p)
{
    dem_options options = dem_options_default();
    if (poissons_ratio < 0.4) options.kernel = kernel_of_rows();
    options.method = DEM_METHOD_VERLET;
    options.threads = p->threads;
    options.thread_nodes = 1;
    options.checkpoint_steps = p->every;
    options.bodies = p->bodies;
    return options;
}

static dem_simulation *open_run(const dem_model *model, const plan *p, const dem_checkpoint *from, diary *d)
{
    const dem_options options = options_of(p);
    dem_simulation *simulation;
    assert_ok(from != NULL ? dem_simulation_resume(&simulation, model, &options, from)
                           : dem_simulation_create(&simulation, model, &options));
    const dem_observer observer = {.struct_size = sizeof observer,
                                   .interval = p->interval * ask_options(simulation).fixed_step,
                                   .frame = on_frame,
                                   .event = on_event,
                                   .checkpoint = on_checkpoint,
                                   .step = p->seen || p->few > 0 ? on_step : NULL,
                                   .step_every = p->few,
                                   .step_touching = p->touching,
                                   .context = d};
    assert_ok(dem_simulation_observe(simulation, &observer));
    return simulation;
}

static outcome run_from(const dem_model *model, const plan *p, const dem_checkpoint *from)
{
    outcome o = {0};
    waves = (struct tally){0};
    dem_simulation *simulation = open_run(model, p, from, &o.diary);
    const double began = see(simulation).t, h = ask_options(simulation).fixed_step;
    for (int k = 0; k < 3 && p->ends[k] > 0.0; k++)
        if (p->ends[k] * h > began) assert_ok(dem_simulation_advance(simulation, p->ends[k] * h));
    o.waves = waves;
    o.end = see(simulation);
    o.sum = sum_up(&o.end, ask_sizes(model).n_nodes);
    o.counts = ask_counts(simulation);
    o.n_pushing = ask_surfaces(simulation).pushing;
    o.end.x = o.end.v = NULL;
    dem_simulation_destroy(simulation);
    return o;
}

static void assert_alike(const outcome *a, const outcome *b)
{
    assert_memory_equal(&a->end, &b->end, offsetof(motion, contacts));
    assert_memory_equal(&a->sum, &b->sum, sizeof a->sum);
    assert_memory_equal(&a->counts, &b->counts, sizeof a->counts);
    assert_int_equal(a->n_pushing, b->n_pushing);
    assert_int_equal(a->diary.n_events, b->diary.n_events);
    assert_memory_equal(&a->diary.last_event, &b->diary.last_event, sizeof(double));
    if (a->diary.n_residuals > 0 && b->diary.n_residuals > 0) {
        assert_true(a->diary.residual == b->diary.residual);
    }
}

/* Quadratures, too. */
static void assert_alike_checkpoints(const dem_checkpoint *a, const dem_checkpoint *b)
{
    size_t sizes[2];
    assert_int_equal(a == NULL, b == NULL);
    if (a == NULL) return;
    const void *state = dem_checkpoint_find(a, "state", &sizes[0]), *other = dem_checkpoint_find(b, "state", &sizes[1]);
    assert_true(state != NULL && other != NULL && sizes[0] == sizes[1]);
    assert_memory_equal(state, other, sizes[0]);
}

static void assert_alike_frames(const outcome *a, const outcome *b)
{
    assert_int_equal(a->diary.n_frames, b->diary.n_frames);
    assert_memory_equal(a->diary.frames, b->diary.frames, sizeof a->diary.frames);
}

/* Runs with unseen steps in 1 and 3 threads, and from a checkpoint, beside one with single steps. */
static outcome compare(const dem_model *model, plan p)
{
    plan single = p;
    single.seen = true;
    single.few = 0;
    single.threads = 1;
    outcome seen = run_from(model, &single, NULL), unseen = {0};
    assert_int_equal(seen.waves.steps, 0);
    assert_int_equal(seen.diary.n_steps, seen.counts.steps); /* all but the one in hand, and the start */
    for (p.threads = 1; p.threads <= 3; p.threads += 2) {
        dem_checkpoint_destroy(unseen.diary.kept);
        unseen = run_from(model, &p, NULL);
        assert_alike(&seen, &unseen);
        assert_alike_frames(&seen, &unseen);
        assert_alike_checkpoints(seen.diary.kept, unseen.diary.kept);
    }
    p.threads = 1;
    if (unseen.diary.kept != NULL) {
        const outcome resumed = run_from(model, &p, unseen.diary.kept);
        assert_alike(&unseen, &resumed);
        dem_checkpoint_destroy(resumed.diary.kept);
    }
    dem_checkpoint_destroy(unseen.diary.kept);
    dem_checkpoint_destroy(seen.diary.kept);
    unseen.diary.kept = NULL;
    return unseen;
}

/* ---- what stays the same ---- */

/* Some 80 steps above the floor, then it touches; frames and two ends of advances fall between. */
TEST(a_run_onto_a_floor_is_that_by_single_steps)
{
    dem_model *model = make_model(30.0, 3e-4);
    const outcome o = compare(model, (plan){.every = 40, .interval = 17.3, .ends = {31.4, 90.0, 130.2}});
    dem_model_destroy(model);
    assert_true(o.diary.n_events > 100);
    assert_true(o.waves.steps > 30 && o.waves.steps < 100);
}

/* What is known of the floor goes on through all steps, without a checkpoint that would begin anew. */
TEST(what_is_unseen_counts_as_a_way)
{
    dem_model *model = make_model(0.0, 3e-4);
    const outcome o = compare(model, (plan){.every = 1000, .ends = {105.5}});
    dem_model_destroy(model);
    assert_true(o.diary.n_events > 100);
    assert_true(o.waves.steps > 30);
}

/* Nearly all steps are unseen without frames: 16 between looks at overlaps, and one by itself at the end. */
TEST(a_free_flight_has_hardly_a_single_step)
{
    dem_model *model = make_model(30.0, 0.0);
    const outcome o = compare(model, (plan){.every = 40, .ends = {70.5}});
    dem_model_destroy(model);
    assert_int_equal(o.counts.steps, 71);
    assert_true(o.waves.steps >= 65);
}

TEST(a_plate_without_lattice_rows_takes_steps_at_once_too)
{
    poissons_ratio = 0.45;
    dem_model *model = make_model(30.0, 0.0);
    const outcome o = compare(model, (plan){.every = 40, .ends = {40.5}});
    dem_model_destroy(model);
    poissons_ratio = 1.0 / 3.0;
    assert_true(o.waves.steps >= 30);
}

/* Two plates that push each other after some 80 steps, at the last of which they are near. */
TEST(bodies_that_meet_take_the_steps_before_at_once)
{
    dem_model *model = make_pair(0.0, 5e-4);
    const outcome o =
        compare(model, (plan){.every = 100, .interval = 17.3, .ends = {13.4, 90.2}, .bodies = DEM_BODIES_OTHERS});
    dem_model_destroy(model);
    assert_true(o.n_pushing > 0);
    assert_true(o.waves.steps > 30 && o.waves.steps < 85);
}

/* Waves go up to the ends that are seen, 7 steps apart, and to those of looks and checkpoints. In contact all are. That
 * the surface of the plate stays apart from itself is known ahead. */
TEST(between_steps_that_are_seen_others_are_not)
{
    dem_model *model = make_model(30.0, 3e-4);
    const outcome o = compare(model, (plan){.every = 48,
                                            .interval = 17.3,
                                            .few = 7,
                                            .touching = true,
                                            .ends = {31.4, 105.2},
                                            .bodies = DEM_BODIES_ALL});
    dem_model_destroy(model);
    assert_true(o.diary.n_events > 100);
    assert_true(o.waves.steps > 30 && o.waves.steps < 100);
    assert_true(o.diary.n_steps > 105 / 7 + 5 && o.diary.n_steps < 50);
    assert_int_equal(o.diary.n_residuals, 105 / 7);
}

/* Where the guard acts steps are single, which are halved then; it is asked after now and then. */
TEST(a_plate_on_which_the_guard_acts_is_taken_singly)
{
    dem_model *model = make_model(-8000.0, 0.0);
    const outcome o = compare(model, (plan){.every = 256, .ends = {50.0, 70.5}});
    dem_model_destroy(model);
    assert_true(o.waves.failures > 0);
}
