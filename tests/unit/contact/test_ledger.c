/* SPDX-License-Identifier: BSD-3-Clause */
/* ledger.c: sums of impulses by obstacle, counts by kind of event, and what the listener says. */
#include "verification/support.h"

#include "contact/ledger.h"

enum { SCRIPT = 4 };

/* A listener that says the status it is given, and remembers what it heard. */
typedef struct hearer {
    dem_status says[SCRIPT];
    int n_heard;
    const dem_event *heard[SCRIPT];
} hearer;

static dem_status hear(void *context, const dem_event *event)
{
    hearer *h = context;
    assert_true(h->n_heard < SCRIPT);
    h->heard[h->n_heard] = event;
    return h->says[h->n_heard++];
}

TEST(a_new_ledger_is_empty)
{
    CLEANUP(ledger_destroy) contact_ledger b;
    assert_ok(ledger_create(&b, 3));
    for (int k = 0; k < 6; k++) {
        assert_close(exact_sum_value(&b.impulse[k]), 0.0, 0.0);
        assert_close(exact_sum_value(&b.friction_impulse[k]), 0.0, 0.0);
    }
    assert_close(exact_sum_value(&b.impact), 0.0, 0.0);
    assert_close(exact_sum_value(&b.projection), 0.0, 0.0);
    assert_int_equal(b.counts.impacts + b.counts.closings + b.counts.releases, 0);
    ledger_destroy(&b);
    assert_null(b.impulse);
    assert_ok(ledger_create(&b, 0)); /* a model may have no obstacles */
}

TEST(impulses_add_up_for_each_obstacle_by_itself)
{
    static const double impulse[6] = {1.0, -2.0, 0.0, 0.0, 4.0, 8.0}, friction[6] = {0.5, 0.25, 0.0, 0.0, -1.0, 2.0};
    CLEANUP(ledger_destroy) contact_ledger b;
    assert_ok(ledger_create(&b, 3));
    ledger_add_impulse(&b, 0, (vec2){1.0, -2.0}, (vec2){0.5, 0.25});
    ledger_add_impulse(&b, 2, (vec2){1.0, 3.0}, (vec2){-2.0, 1.5});
    ledger_add_impulse(&b, 2, (vec2){3.0, 5.0}, (vec2){1.0, 0.5});
    for (int k = 0; k < 6; k++) {
        assert_close(exact_sum_value(&b.impulse[k]), impulse[k], 0.0); /* sums of small binary fractions are exact */
        assert_close(exact_sum_value(&b.friction_impulse[k]), friction[k], 0.0);
    }
}

TEST(a_copy_keeps_memory_of_its_own)
{
    static const double impulses[8] = {0.0, 0.0, 1.0, -2.0, 0.0, 0.0, 0.5, 0.25};
    CLEANUP(ledger_destroy) contact_ledger from;
    CLEANUP(ledger_destroy) contact_ledger to;
    double list[8];
    assert_ok(ledger_create(&from, 2));
    assert_ok(ledger_create(&to, 2));
    ledger_add_impulse(&to, 0, (vec2){1e300, 1.0}, (vec2){1e-300, 1.0}); /* which the copy replaces */
    ledger_add_impulse(&from, 1, (vec2){1.0, -2.0}, (vec2){0.5, 0.25});
    from.impact = exact_sum_of(3.0), from.counts.slips = 7;
    ledger_copy(&to, &from, 2);
    ledger_add_impulse(&from, 1, (vec2){1.0, 1.0}, (vec2){1.0, 1.0});
    ledger_list_impulses(&to, 2, list);
    for (int k = 0; k < 8; k++) assert_close(list[k], impulses[k], 0.0);
    assert_close(exact_sum_value(&to.impact), 3.0, 0.0);
    assert_int_equal(to.counts.slips, 7);
}

TEST(a_list_of_impulses_begins_a_ledger_anew)
{
    static const double begun[8] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};
    CLEANUP(ledger_destroy) contact_ledger b;
    double list[8];
    assert_ok(ledger_create(&b, 2));
    ledger_add_impulse(&b, 1, (vec2){1.0, -2.0}, (vec2){0.5, 0.25});
    ledger_begin_impulses(&b, 2, begun);
    ledger_list_impulses(&b, 2, list);
    assert_memory_equal(list, begun, sizeof list);
}

/* Events forwards and backwards: sums of doubles would differ in their last digits. */
TEST(sums_do_not_depend_on_the_order_of_events)
{
    enum { EVENTS = 100 };
    double sums[2][8];
    for (int way = 0; way < 2; way++) {
        CLEANUP(ledger_destroy) contact_ledger b;
        assert_ok(ledger_create(&b, 2));
        for (int e = 0; e < EVENTS; e++) {
            const int k = way == 0 ? e : EVENTS - 1 - e;
            const vec2 impulse = {sin(k), exp(0.1 * k) * cos(k)};
            ledger_add_impulse(&b, k % 2, impulse, vec2_scale(0.3, impulse));
        }
        ledger_list_impulses(&b, 2, sums[way]);
    }
    assert_memory_equal(sums[0], sums[1], sizeof sums[0]);
}

static void enter(contact_ledger *b, dem_event_kind kind, dem_index other, int times)
{
    const event_listener deaf = {0};
    contact_instant now = {.listener = &deaf};
    const dem_event event = {.kind = kind, .other = other};
    for (int k = 0; k < times; k++) ledger_enter(b, &event, &now);
    assert_int_equal(now.listener_status, DEM_OK);
}

/* Every kind another number of times, so that no two can be exchanged unseen. */
TEST(every_kind_of_event_has_its_count)
{
    CLEANUP(ledger_destroy) contact_ledger b;
    assert_ok(ledger_create(&b, 1));
    enter(&b, DEM_EVENT_IMPACT, -1, 3);
    enter(&b, DEM_EVENT_IMPACT, 0, 2); /* node 0 is a node: an edge on a vertex */
    enter(&b, DEM_EVENT_RELEASE, -1, 7);
    enter(&b, DEM_EVENT_SLIP, 4, 11);
    enter(&b, DEM_EVENT_STICK, -1, 13);
    enter(&b, DEM_EVENT_PASS, 4, 17);
    assert_int_equal(b.counts.impacts, 5);
    assert_int_equal(b.counts.vertex_impacts, 2);
    assert_int_equal(b.counts.releases, 7);
    assert_int_equal(b.counts.slips, 11);
    assert_int_equal(b.counts.sticks, 13);
    assert_int_equal(b.counts.passings, 17);
    assert_int_equal(b.counts.closings, 0);
    assert_int_equal(b.counts.early + b.counts.late + b.counts.events, 0); /* counted elsewhere */
}

TEST(a_close_event_is_reported_but_counted_where_it_is_done)
{
    const dem_event event = {.kind = DEM_EVENT_CLOSE, .other = 4};
    hearer h = {0};
    const event_listener listener = {hear, &h};
    contact_instant now = {.listener = &listener};
    const dem_counts none = {0};
    CLEANUP(ledger_destroy) contact_ledger b;
    assert_ok(ledger_create(&b, 1));
    ledger_enter(&b, &event, &now);
    assert_memory_equal(&b.counts, &none, sizeof none);
    assert_int_equal(h.n_heard, 1);
    assert_ptr_equal(h.heard[0], &event);
}

/* The later ones are heard all the same, and do not replace the first. */
TEST(the_first_status_other_than_ok_is_kept)
{
    const dem_event event = {.kind = DEM_EVENT_SLIP, .other = -1};
    hearer h = {.says = {DEM_OK, DEM_STOPPED, DEM_ERROR_IO, DEM_OK}};
    const event_listener listener = {hear, &h};
    contact_instant now = {.listener = &listener};
    CLEANUP(ledger_destroy) contact_ledger b;
    assert_ok(ledger_create(&b, 1));
    ledger_enter(&b, &event, &now);
    assert_int_equal(now.listener_status, DEM_OK);
    for (int k = 1; k < SCRIPT; k++) {
        ledger_enter(&b, &event, &now);
        assert_int_equal(now.listener_status, DEM_STOPPED);
    }
    assert_int_equal(h.n_heard, SCRIPT);
    assert_int_equal(b.counts.slips, SCRIPT);
}
