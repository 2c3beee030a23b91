/* SPDX-License-Identifier: BSD-3-Clause */
/* observers.c: which calls observers get, in which order, and whose frame comes next. */
#include "verification/support.h"

#include <string.h>

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
    assert_ok(observers_step(&a, NULL));
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
    assert_ok(observers_step(&a, NULL));
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
    assert_int_equal(observers_step(&a, NULL), DEM_STOPPED);
    assert_int_equal(observers_frame(&a, 2, NULL), DEM_ERROR_MEMORY);
    assert_ok(observers_frame(&a, 0, NULL));
    expect("e1e2e3s1s2s3f3f1");
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
