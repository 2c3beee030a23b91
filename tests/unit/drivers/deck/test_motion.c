/* SPDX-License-Identifier: BSD-3-Clause */
/* motion.c: keys of motions go with their kinds, and arrive in the obstacle. */
#include "unit/reading.h"

#include "motion.h"

static void check(const char *keys, const char *message)
{
    char text[512];
    (void)snprintf(text, sizeof text, "&obstacle points = 0, 0, 1, 0%s /\n", keys);
    resolved r = resolve(text);
    namelist_errors_free(&r.errors);
    r.errors = (namelist_errors){0};
    motion_check(schema_get(&r.deck, "obstacle", 0), &r.errors);
    if (message == NULL) {
        assert_int_equal(r.errors.n, 0);
    } else {
        assert_int_equal(r.errors.n, 1);
        assert_string_equal(r.errors.list[0].text, message);
    }
    drop_resolved(&r);
}

TEST(a_velocity_alone_is_a_translation)
{
    check("", NULL);
    check(", velocity = 1, 2", NULL);
    check(", velocity = 1, 2, ramp = 0.1", NULL);
    check(", motion = 'translate', velocity = 1, 2", NULL);
}

TEST(keys_need_their_motion)
{
    check(", ramp = 0.1", "'ramp' in &obstacle is given without a motion");
    check(", motion = 'fixed', ramp = 0.1", "'ramp' in &obstacle is given without a motion");
    check(", amplitude = 1, 2", "'amplitude' in &obstacle is given without motion = 'oscillate'");
    check(", motion = 'translate', velocity = 1, 2, spin = 1",
          "'spin' in &obstacle is given without motion = 'rotate'");
    check(", motion = 'rotate', spin = 1, velocity = 1, 2",
          "'velocity' in &obstacle is given without motion = 'translate'");
    check(", motion = 'fixed', velocity = 1, 2", "'velocity' in &obstacle is given without motion = 'translate'");
}

TEST(motions_need_their_keys)
{
    check(", motion = 'translate'", "'velocity' in &obstacle must be given for motion 'translate'");
    check(", motion = 'oscillate', amplitude = 0, 1", "'frequency' in &obstacle must be given for motion 'oscillate'");
    check(", motion = 'oscillate', frequency = 2", "'amplitude' in &obstacle must be given for motion 'oscillate'");
    check(", motion = 'rotate', pivot = 0, 1", "'spin' in &obstacle must be given for motion 'rotate'");
    check(", motion = 'fixed', 'rotate', spin = 1", "'motion' in &obstacle has 'fixed' together with another kind");
    check(", motion = 'rotate', 'translate', 'rotate', velocity = 1, 0, spin = 1",
          "'motion' in &obstacle has 'rotate' twice");
}

TEST(numbers_arrive_under_their_names)
{
    resolved r = resolve("&obstacle points = 0, 0, 1, 0, motion = 'rotate', 'oscillate', spin = 3, pivot = 4, 5,\n"
                         "amplitude = 6, 7, frequency = 8, phase = 9, ramp = 10 /\n");
    dem_obstacle made = {.struct_size = sizeof made};
    motion_drop_unused(&r.deck);
    motion_check(schema_get(&r.deck, "obstacle", 0), &r.errors);
    motion_set(&made, schema_get(&r.deck, "obstacle", 0));
    assert_true(made.spin == 3.0 && made.pivot[0] == 4.0 && made.pivot[1] == 5.0 && made.velocity[0] == 0.0);
    assert_true(made.amplitude[0] == 6.0 && made.amplitude[1] == 7.0 && made.frequency == 8.0);
    assert_true(made.phase == 9.0 && made.ramp == 10.0);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "obstacle", 0), "velocity")->count, 0);
    drop_resolved(&r);
}
