/* SPDX-License-Identifier: BSD-3-Clause */
#include "unit/drivers/export/exported.h"

#include "loads.h"

static loads find(const char *resolved)
{
    CLEANUP(exported_close) exported e;
    loads l;
    exported_how how = exported_usual();
    how.resolved = resolved;
    exported_open(&e, how);
    assert_true(loads_find(&l, &e.task));
    assert_int_equal(e.outcome.code, EXIT_DONE);
    return l;
}

TEST(a_deck_says_what_acts)
{
    const loads l =
        find("&run\n    t_end = 1\n    gravity = 1.5, -9.81\n/\n&solver\n    mass_damping = 3 ! default\n/\n");
    assert_true(l.known);
    assert_close(l.gravity[0], 1.5, 0.0);
    assert_close(l.gravity[1], -9.81, 0.0);
    assert_close(l.mass_damping, 3.0, 0.0);
}

TEST(a_run_without_a_deck_does_not)
{
    assert_false(find(NULL).known);
    assert_false(find("&run gravity = 1, /= x").known);
}
