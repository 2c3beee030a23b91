/* SPDX-License-Identifier: BSD-3-Clause */
#include "unit/drivers/export/exported.h"

#include "still.h"

TEST(a_frame_is_read_with_what_is_wanted)
{
    static const char *const names[] = {"velocity", "none", "strain", "body"};
    const still_choice choice = {.names = names, .n_names = 4};
    CLEANUP(exported_close) exported e;
    CLEANUP(still_free) still s;
    double x[6];
    exported_open(&e, exported_usual());
    assert_true(still_open(&s, &e.task, &choice));
    assert_int_equal(s.n_arrays, 2); /* strain is of springs */
    assert_true(still_read(&s, 2));
    assert_ok(dem_reader_positions(e.reader, 2, x));
    assert_memory_equal(s.x, x, sizeof x);
    assert_non_null(still_values(&s, "velocity"));
    assert_close(still_values(&s, "velocity")[6], 0.0, 0.0); /* of the fixed node */
    assert_null(still_values(&s, "strain"));
    assert_false(still_read(&s, 3));
    assert_int_equal(e.outcome.code, EXIT_INVALID);
}

TEST(without_names_all_are_wanted)
{
    CLEANUP(exported_close) exported e;
    still s;
    exported_open(&e, exported_usual());
    for (int of_springs = 0; of_springs < 2; of_springs++) {
        const still_choice choice = {.of_springs = of_springs};
        assert_true(still_open(&s, &e.task, &choice));
        assert_int_equal(s.n_arrays, of_springs ? 3 : 6);
        for (dem_index a = 0; a < s.n_arrays; a++) assert_int_equal(s.arrays[a].what->of_springs, of_springs);
        still_free(&s);
    }
}
