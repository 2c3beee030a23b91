/* SPDX-License-Identifier: BSD-3-Clause */
/* quantity.c: which numbers give the colours. */
#include "unit/drivers/plot/trajectory_fixture.h"

#include <string.h>

#include "quantity.h"

TEST(the_default_is_the_strain)
{
    trajectory_fixture *f = *test_state;
    quantity q;
    outcome o = {0};
    assert_true(quantity_find(&q, f->reader, NULL, &o));
    assert_string_equal(q.name, "strain");
    assert_int_equal(q.scale, PALETTE_DIVERGING);
    assert_int_equal(quantity_count(&q, dem_reader_lattice(f->reader)), dem_reader_lattice(f->reader)->n_springs);
}

TEST(none_has_no_numbers)
{
    trajectory_fixture *f = *test_state;
    quantity q;
    outcome o = {0};
    assert_true(quantity_find(&q, f->reader, "none", &o));
    assert_null(q.source);
    assert_int_equal(quantity_count(&q, dem_reader_lattice(f->reader)), 0);
}

static double *read_all(const trajectory_fixture *f, const char *name)
{
    quantity q;
    outcome o = {0};
    assert_true(quantity_find(&q, f->reader, name, &o));
    double *value = malloc((quantity_count(&q, dem_reader_lattice(f->reader)) + 1) * sizeof *value);
    assert_non_null(value);
    CLEANUP(free_memory)
    double *rows = malloc((quantity_count(&q, dem_reader_lattice(f->reader)) + 1) * 6 * sizeof *rows);
    assert_non_null(rows);
    trajectory_fixture_ok(quantity_read(&q, f->reader, 0, value, rows));
    return value;
}

/* At the start all move alike: (0.5, -2) m/s, to the 24 bits of a float. */
TEST(vectors_are_taken_by_length_and_component)
{
    trajectory_fixture *f = *test_state;
    double *speed = read_all(f, "speed"), *x = read_all(f, "velocity_x"), *y = read_all(f, "velocity_y");
    for (dem_index k = 0; k < dem_reader_lattice(f->reader)->n_nodes; k++) {
        assert_close(x[k], 0.5, 1e-7);
        assert_close(y[k], -2.0, 1e-7);
        assert_close(speed[k], sqrt(4.25), 1e-6);
    }
    free(speed), free(x), free(y);
}

/* xy stands fourth in a tensor of VTK. */
TEST(components_of_stress_are_those_named)
{
    trajectory_fixture *f = *test_state;
    const dem_reader_array *stress = dem_reader_array_find(f->reader, "stress");
    static const char *const names[] = {"stress_xx", "stress_yy", "stress_xy"};
    static const int column[] = {0, 1, 3};
    const dem_index n = dem_reader_lattice(f->reader)->n_nodes;
    double *all = malloc((size_t)n * 6 * sizeof *all), *one = malloc((size_t)n * sizeof *one);
    double *rows = malloc((size_t)n * 6 * sizeof *rows);
    trajectory_fixture_ok(dem_reader_read(f->reader, stress, TRAJECTORY_FIXTURE_FRAMES - 1, all));
    for (int c = 0; c < 3; c++) {
        quantity q;
        outcome o = {0};
        assert_true(quantity_find(&q, f->reader, names[c], &o));
        trajectory_fixture_ok(quantity_read(&q, f->reader, TRAJECTORY_FIXTURE_FRAMES - 1, one, rows));
        for (dem_index k = 0; k < n; k++) assert_close(one[k], all[6 * k + column[c]], 0.0);
    }
    free(all), free(one), free(rows);
}

TEST(what_the_file_lacks_is_refused)
{
    trajectory_fixture *f = *test_state;
    quantity q;
    outcome o = {0};
    assert_true(quantity_is_known("principal_1"));
    assert_false(quantity_find(&q, f->reader, "principal_1", &o));
    assert_int_equal(o.code, EXIT_INVALID);
    assert_non_null(strstr(o.message, "principal_stress"));
    assert_false(quantity_is_known("colour"));
    assert_true(quantity_is_known("contact_pressure"));
    assert_false(quantity_find(&q, f->reader, "contact_pressure", &o));
}

/* By their number: the first is the default, and each is what its name finds. */
TEST(all_that_have_a_name_can_be_asked_for)
{
    trajectory_fixture *f = *test_state;
    int found = 0;
    for (size_t k = 0; k < QUANTITY_KNOWN; k++) {
        quantity q, same;
        outcome o = {0};
        if (!quantity_at(&q, f->reader, k)) continue;
        assert_true(quantity_find(&same, f->reader, q.name, &o));
        assert_ptr_equal(q.source, same.source);
        assert_int_equal(q.part, same.part);
        if (found++ == 0) assert_string_equal(q.name, "strain");
    }
    assert_in_range(found, 8, QUANTITY_KNOWN - 1);
}

TEST_GROUP(trajectory_fixture_begin, trajectory_fixture_end);
