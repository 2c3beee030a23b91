/* SPDX-License-Identifier: BSD-3-Clause */
/* source_list.c: sources go into a checkpoint and come back, in their order, and each one's failure is heard of. */
#include "verification/support.h"

#include <string.h>

#include "events/source_list.h"

/* What a source remembers, and when it was restored. */
typedef struct counter {
    const char *entry;
    dem_index count;
    double t, y; /* s; the first number of the state */
} counter;

static dem_status counter_save(const void *self, dem_checkpoint *checkpoint)
{
    const counter *c = self;
    return dem_checkpoint_put(checkpoint, c->entry, &c->count, sizeof c->count);
}

static dem_status counter_restore(void *self, const dem_checkpoint *checkpoint, double t, const double *y)
{
    counter *c = self;
    c->t = t;
    c->y = *y;
    return dem_checkpoint_get(checkpoint, c->entry, &c->count, sizeof c->count);
}

static event_source counter_source(counter *c)
{
    return (event_source){.name = c->entry, .self = c, .save = counter_save, .restore = counter_restore};
}

static void open_list(source_list *s, counter counters[2])
{
    *s = (source_list){0};
    for (int k = 0; k < 2; k++) assert_ok(source_list_add(s, counter_source(&counters[k])));
}

TEST(sources_keep_the_order_in_which_they_were_added)
{
    counter counters[2] = {{.entry = "one"}, {.entry = "two"}};
    CLEANUP(source_list_destroy) source_list s;
    open_list(&s, counters);
    assert_int_equal(s.n, 2);
    for (int k = 0; k < 2; k++) assert_ptr_equal(s.list[k].self, &counters[k]);
}

TEST(each_source_comes_back_from_its_own_entry)
{
    counter from[2] = {{.entry = "one", .count = 7}, {.entry = "two", .count = -3}},
            to[2] = {{.entry = "one"}, {.entry = "two"}};
    const double y = 0.25;
    source_list s;
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint;
    assert_ok(dem_checkpoint_create(&checkpoint));
    open_list(&s, from);
    assert_ok(source_list_save(&s, checkpoint));
    source_list_destroy(&s);
    open_list(&s, to);
    assert_ok(source_list_restore(&s, checkpoint, 1.5, &y));
    for (int k = 0; k < 2; k++) {
        assert_int_equal(to[k].count, from[k].count);
        assert_close(to[k].t, 1.5, 0.0);
        assert_close(to[k].y, y, 0.0);
    }
    source_list_destroy(&s);
}

TEST(a_checkpoint_without_the_entry_of_a_source_is_refused)
{
    counter one = {.entry = "one", .count = 7}, both[2] = {{.entry = "one"}, {.entry = "two"}};
    const double y = 0.0;
    source_list s = {0};
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint;
    assert_ok(dem_checkpoint_create(&checkpoint));
    assert_ok(source_list_add(&s, counter_source(&one)));
    assert_ok(source_list_save(&s, checkpoint));
    source_list_destroy(&s);
    open_list(&s, both);
    assert_int_equal(source_list_restore(&s, checkpoint, 0.0, &y), DEM_ERROR_IO);
    assert_non_null(strstr(dem_status_message(), "two"));
    source_list_destroy(&s);
}
