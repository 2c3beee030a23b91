/* SPDX-License-Identifier: BSD-3-Clause */
/* observers.c: which calls observers get, in which order, and whose frame comes next. */
#include "unit/simulation/runs.h"

#include "harness/message.h"
#include "simulation/observers.h"

/* The calls of several observers: the context of each is its letter in one diary. */
typedef struct voice {
    char letter;
    dem_status value;
} voice;

static char diary[64];

static dem_status note(void *context, char kind)
{
    const voice *v = context;
    const size_t n = strlen(diary);
    assert_true(n + 2 < sizeof diary);
    diary[n] = kind;
    diary[n + 1] = v->letter;
    return v->value;
}

static dem_status on_frame(void *context, const dem_simulation *simulation)
{
    assert_null(simulation);
    return note(context, 'f');
}

static dem_status on_step(void *context, const dem_simulation *simulation)
{
    assert_null(simulation);
    return note(context, 's');
}

static dem_status on_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    assert_null(simulation);
    assert_close(event->t, 0.75, 0.0);
    return note(context, 'e');
}

static dem_status on_break(void *context, const dem_simulation *simulation, const dem_break *what)
{
    assert_null(simulation);
    assert_int_equal(what->triangle, 7);
    return note(context, 'b');
}

static void join(observers *a, voice *v, double interval)
{
    const dem_observer observer = SIZED(dem_observer, .interval = interval, .frame = on_frame, .step = on_step,
                                        .event = on_event, .broken = on_break, .context = v);
    assert_ok(observers_add(a, &observer, -1.0));
}

static void expect(const char *text)
{
    assert_string_equal(diary, text);
    memset(diary, 0, sizeof diary);
}

/* ---- joining ---- */

TEST(at_most_eight_are_admitted)
{
    observers a = {0};
    voice v = {'a', DEM_OK};
    const dem_observer one_more = {.struct_size = sizeof(dem_observer), .interval = 1.0};
    for (int k = 0; k < OBSERVERS_MOST; k++) join(&a, &v, 1.0);
    assert_int_equal(observers_add(&a, &one_more, -1.0), DEM_ERROR_ARGUMENT);
    assert_message_parts("at most 8 observers");
    assert_int_equal(a.n, 8);
}

TEST(an_interval_is_finite)
{
    observers a = {0};
    const dem_observer endless = {.struct_size = sizeof(dem_observer), .interval = (double)INFINITY},
                       none = {.struct_size = sizeof(dem_observer), .interval = fabs((double)NAN)};
    assert_int_equal(observers_add(&a, &endless, -1.0), DEM_ERROR_ARGUMENT);
    assert_message_parts("the interval between frames is inf s");
    assert_int_equal(observers_add(&a, &none, -1.0), DEM_ERROR_ARGUMENT);
    assert_int_equal(a.n, 0);
}

/* The search for the first frame later than a time that a damaged checkpoint gave once went on without end. */
TEST(frames_too_many_to_be_numbered_are_refused)
{
    observers a = {0};
    const dem_observer dense = {.struct_size = sizeof(dem_observer), .interval = 1e-3};
    assert_int_equal(observers_add(&a, &dense, 1e300), DEM_ERROR_ARGUMENT);
    assert_message_parts("frames 0.001 s * 1e+300 s");
    assert_int_equal(a.n, 0);
    assert_ok(observers_add(&a, &dense, 4e12));
    assert_int_equal(a.members[0].next_frame, 4000000000000001);
}

/* ---- telling ---- */

TEST(all_are_called_in_the_order_in_which_they_came)
{
    observers a = {0};
    voice first = {'1', DEM_OK}, second = {'2', DEM_OK};
    const dem_event event = {.t = 0.75};
    assert_false(observers_want_events(&a) || observers_want_breaks(&a));
    join(&a, &first, 0.0);
    join(&a, &second, 0.0);
    assert_true(observers_want_events(&a) && observers_want_breaks(&a));
    assert_ok(observers_event(&a, NULL, &event));
    assert_ok(observers_broken(&a, NULL, &(dem_break){.triangle = 7}));
    assert_ok(observers_step(&a, NULL, &(accepted_step){.t = 0.5}));
    assert_ok(observers_frame(&a, 1, NULL));
    expect("e1e2b1b2s1s2f2");
}

TEST(observers_without_a_function_are_left_out)
{
    observers a = {0};
    voice v = {'v', DEM_OK};
    const dem_observer deaf = {.struct_size = sizeof(dem_observer), .interval = 1.0};
    const dem_event event = {.t = 0.75};
    double t = -1.0;
    assert_ok(observers_add(&a, &deaf, -1.0));
    assert_false(observers_want_events(&a) || observers_want_breaks(&a));
    assert_ok(observers_event(&a, NULL, &event));
    assert_ok(observers_broken(&a, NULL, &(dem_break){.triangle = 7}));
    assert_ok(observers_step(&a, NULL, &(accepted_step){.t = 0.5}));
    assert_int_equal(observers_due(&a, 10.0, 10.0, &t), -1);
    join(&a, &v, 0.0); /* interval 0: no frames either */
    assert_int_equal(observers_due(&a, 10.0, 10.0, &t), -1);
    assert_close(t, -1.0, 0.0);
    assert_ok(observers_event(&a, NULL, &event));
    expect("ev");
}

/* An observer that comes later is called all the same. */
TEST(the_first_status_that_is_not_ok_is_returned)
{
    observers a = {0};
    voice content = {'1', DEM_OK}, stops = {'2', DEM_STOPPED}, fails = {'3', DEM_ERROR_MEMORY};
    const dem_event event = {.t = 0.75};
    join(&a, &content, 1.0);
    join(&a, &stops, 1.0);
    join(&a, &fails, 1.0);
    assert_int_equal(observers_event(&a, NULL, &event), DEM_STOPPED);
    assert_int_equal(observers_step(&a, NULL, &(accepted_step){.t = 0.5}), DEM_STOPPED);
    assert_int_equal(observers_frame(&a, 2, NULL), DEM_ERROR_MEMORY);
    assert_ok(observers_frame(&a, 0, NULL));
    expect("e1e2e3s1s2s3f3f1");
}

/* ---- steps that are seen ---- */

TEST(how_often_steps_are_seen_is_possible)
{
    observers a = {0};
    const dem_observer wrong[] = {SIZED(dem_observer, .step_every = -1), SIZED(dem_observer, .step_interval = -1e-3),
                                  SIZED(dem_observer, .step_interval = (double)INFINITY)};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        assert_int_equal(observers_add(&a, &wrong[k], -1.0), DEM_ERROR_ARGUMENT);
    assert_message_parts("steps are to be seen every 0 of them and every inf s; both must be 0 or more");
    assert_int_equal(a.n, 0);
}

enum { MOST_SEEN = 4000 };

/* What an observer has been shown. */
typedef struct sight {
    int n;
    double t[MOST_SEEN];
    bool touches[MOST_SEEN];       /* whether something has touched in the step that ends there, */
    bool has_events[MOST_SEEN];    /* and whether there was an event in it */
    dem_index counted[MOST_SEEN];  /* steps */
    dem_index n_events, n_noticed; /* so far, and at the step before */
    double stop_at;                /* s; 0: nowhere */
    dem_checkpoint *kept;          /* the fourth checkpoint, if it is to be kept, */
    bool keeps;
    int n_checkpoints;
} sight;

static dem_status see_step(void *context, const dem_simulation *simulation)
{
    sight *s = context;
    const dem_progress now = ask_progress(simulation);
    assert_true(s->n < MOST_SEEN);
    s->t[s->n] = now.t;
    s->has_events[s->n] = s->n_events > s->n_noticed;
    s->touches[s->n] = s->has_events[s->n] || now.n_contacts > 0;
    s->counted[s->n++] = ask_counts(simulation).steps;
    s->n_noticed = s->n_events;
    const bool stops = s->stop_at > 0.0 && now.t >= s->stop_at;
    if (stops) s->stop_at = 0.0;
    return stops ? DEM_STOPPED : DEM_OK;
}

static dem_status see_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    (void)simulation;
    (void)event;
    ((sight *)context)->n_events++;
    return DEM_OK;
}

static dem_status see_checkpoint(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    sight *s = context;
    (void)simulation;
    if (!s->keeps || ++s->n_checkpoints != 4) return DEM_OK;
    assert_ok(dem_checkpoint_write(checkpoint, "observers.checkpoint"));
    return dem_checkpoint_read(&s->kept, "observers.checkpoint");
}

/* How often an observer looks. */
typedef struct habit {
    dem_index every;
    double interval;
    dem_index touching;
} habit;

static const habit habits[] = {{0, 0.0, 0},       {7, 0.0, 0},     {0, 1.1e-4, 0}, {13, 2.3e-4, 0},
                               {1000000, 0.0, 1}, {16, 1.1e-3, 1}, {1, 0.0, 0}};
enum { HABITS = sizeof habits / sizeof *habits };

static void watch(dem_simulation *simulation, sight *sights)
{
    for (int k = 0; k < HABITS; k++) {
        const dem_observer o = {.struct_size = sizeof o,
                                .step = see_step,
                                .event = see_event,
                                .checkpoint = see_checkpoint,
                                .context = &sights[k],
                                .step_every = habits[k].every,
                                .step_interval = habits[k].interval,
                                .step_touching = habits[k].touching};
        assert_ok(dem_simulation_observe(simulation, &o));
    }
}

/* The number of the step's end in the run, which begins with 0. */
static bool is_wanted(const sight *all, const habit *h, int number)
{
    const double t = all->t[number], before = number > 0 ? all->t[number - 1] : -1.0;
    if ((h->every == 0 && h->interval == 0.0) || (h->every > 0 && number % h->every == 0)) return true;
    if (h->touching != 0 && all->touches[number]) return true;
    if (h->touching != 0 && number + 1 < all->n && all->has_events[number + 1]) return true;
    for (int k = 0; h->interval > 0.0 && k * h->interval <= t; k++)
        if (k * h->interval > before) return true;
    return false;
}

/* The first observer sees all; from one of its steps on. */
static void assert_seen(const sight *all, const habit *h, const sight *seen, double from)
{
    int n = 0;
    for (int k = 0; k < all->n; k++) {
        if (!(all->t[k] > from) || !is_wanted(all, h, k)) continue;
        assert_true(n < seen->n);
        assert_close(seen->t[n++], all->t[k], 0.0);
    }
    assert_int_equal(seen->n, n);
}

static dem_options short_steps(dem_method method, dem_contact_method contact)
{
    dem_options options = dem_options_default();
    options.method = method;
    options.contact = contact;
    options.checkpoint_steps = 40;
    return options;
}

static void check_habits(dem_method method, dem_contact_method contact)
{
    CLEANUP(free_memory) sight *sights = calloc(HABITS, sizeof *sights);
    assert_non_null(sights);
    const dem_options options = short_steps(method, contact);
    dem_model *model = make_falling(0.5);
    dem_simulation *simulation = simulate(model, &options);
    watch(simulation, sights);
    sights[3].stop_at = 0.3 * t_whole;
    assert_int_equal(dem_simulation_advance(simulation, t_whole), DEM_STOPPED);
    for (int k = 3; k <= 10; k++) assert_ok(dem_simulation_advance(simulation, t_whole * (k + 0.3) / 10.3));
    const dem_index n_events = sights[0].n_events;
    assert_true(sights[0].n > 150 && n_events > 20);
    for (int k = 0; k < HABITS; k++) assert_seen(&sights[0], &habits[k], &sights[k], -1.0);
    assert_true(sights[4].n > 20 && sights[4].n < sights[0].n / 2);
    assert_true(sights[5].n > sights[4].n && sights[2].n > 40 && sights[2].n < 60);
    const snapshot watched = snap(simulation), alone = run_with(model, &options);
    assert_same(&watched, &alone);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
}

/* Of a body that falls on a slope and leaves it, over several advances, one of which an observer ends. */
TEST(every_observer_sees_the_steps_that_it_has_asked_for)
{
    check_habits(DEM_METHOD_FEHLBERG45, DEM_CONTACT_LOCAL);
    check_habits(DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
}

TEST(where_the_body_stops_at_events_the_same_steps_are_seen)
{
    check_habits(DEM_METHOD_VERLET, DEM_CONTACT_EXACT);
}

/* From a checkpoint on the steps are those of the run that was not cut. */
TEST(a_resumed_run_shows_the_steps_that_were_left)
{
    CLEANUP(free_memory) sight *sights = calloc(2 * HABITS, sizeof *sights);
    assert_non_null(sights);
    sight *rest = sights + HABITS;
    const dem_options options = short_steps(DEM_METHOD_VERLET, DEM_CONTACT_LOCAL);
    dem_model *model = make_falling(0.5);
    dem_simulation *simulation = simulate(model, &options);
    sights[0].keeps = true;
    watch(simulation, sights);
    assert_ok(dem_simulation_advance(simulation, t_whole));
    dem_simulation_destroy(simulation);
    assert_non_null(sights[0].kept);
    assert_ok(dem_simulation_resume(&simulation, model, &options, sights[0].kept));
    const double from = ask_progress(simulation).t;
    watch(simulation, rest);
    assert_ok(dem_simulation_advance(simulation, t_whole));
    assert_true(rest[0].n > 50 && rest[0].n < sights[0].n - 50);
    for (int k = 0; k < HABITS; k++) assert_seen(&sights[0], &habits[k], &rest[k], from);
    dem_checkpoint_destroy(sights[0].kept);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
}

/* ---- frames ---- */

/* Intervals 3 and 2, shown up to 6: at 0, 0, 2, 3, 4, 6, 6; of two at once the first to come. */
TEST(frames_come_in_the_order_of_time)
{
    static const double times[7] = {0.0, 0.0, 2.0, 3.0, 4.0, 6.0, 6.0};
    static const int whose[7] = {0, 1, 1, 0, 1, 0, 1};
    observers a = {0};
    voice first = {'1', DEM_OK}, second = {'2', DEM_OK};
    double t;
    join(&a, &first, 3.0);
    join(&a, &second, 2.0);
    for (int k = 0; k < 7; k++) {
        assert_int_equal(observers_due(&a, 7.0, 6.0, &t), whose[k]);
        assert_close(t, times[k], 0.0);
        assert_ok(observers_frame(&a, whose[k], NULL));
    }
    assert_int_equal(observers_due(&a, 7.0, 6.0, &t), -1);   /* beyond what is asked for */
    assert_int_equal(observers_due(&a, 7.0, 100.0, &t), -1); /* beyond the step */
    assert_int_equal(observers_due(&a, 8.0, 100.0, &t), 1);
    expect("f1f2f2f1f2f1f2");
}

/* 3 * 0.1 is above 0.3 by rounding; the frame is shown where the step reaches as far. */
TEST(a_frame_at_the_end_is_not_lost_to_rounding)
{
    observers a = {0};
    voice v = {'v', DEM_OK};
    double t;
    join(&a, &v, 0.1);
    a.members[0].next_frame = 3;
    assert_true(3 * 0.1 > 0.3);
    assert_int_equal(observers_due(&a, 0.4, 0.3, &t), 0);
    assert_close(t, 3 * 0.1, 0.0);
    assert_int_equal(observers_due(&a, 0.3, 0.3, &t), -1);
    assert_int_equal(observers_due(&a, 0.4, 0.3 - 1e-9, &t), -1);
}
