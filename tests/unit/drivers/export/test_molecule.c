/* SPDX-License-Identifier: BSD-3-Clause */
#include "unit/drivers/export/exported.h"

#include "molecule.h"

static exported e;

static void make(molecule *m, exported_how how, dem_index first)
{
    exported_open(&e, how);
    e.task.frames.frame[0] = first;
    assert_true(molecule_make(m, &e.task));
}

static void end(molecule *m)
{
    molecule_free(m);
    exported_close(&e);
}

TEST(types_are_of_mass_and_of_spring)
{
    CLEANUP(end) molecule m;
    make(&m, exported_usual(), 0);
    const dem_index atoms[] = {0, 1, 2}, bonds[] = {0, 2, 1};
    assert_int_equal(m.atoms.n, 3);
    assert_memory_equal(m.atoms.of, atoms, sizeof atoms);
    assert_true(m.atoms.values[1].a == 0.0 && m.atoms.values[2].a == 1.0); /* as heavy, but fixed */
    assert_int_equal(m.bonds.n, 3);
    assert_memory_equal(m.bonds.of, bonds, sizeof bonds);
    assert_close(m.longest, 5.0, 0.0);
}

/* In the frame at 0.25 s all is whole, in that at 0.5 s nothing is. */
TEST(broken_springs_are_no_bonds)
{
    exported_how how = exported_usual();
    how.breaks = true;
    CLEANUP(end) molecule m;
    make(&m, how, 1);
    assert_int_equal(m.n_bonds, 3);
    assert_null(strstr(m.omissions, "broken"));
    end(&m);
    make(&m, how, 2);
    assert_int_equal(m.n_bonds, 0);
    assert_true(m.gone[0] != 0.0 && m.gone[2] != 0.0);
    assert_non_null(strstr(m.omissions, "the loss of stiffness beside 1 broken triangle,"));
}

TEST(the_start_is_not_rounded)
{
    CLEANUP(end) molecule m;
    make(&m, exported_usual(), 0);
    assert_true(m.t == 0.0 && m.v[0] == 0.1 && m.x[5] == 5.0);
}

TEST(a_later_frame_is_as_it_is_in_the_file)
{
    for (int in_double = 0; in_double < 2; in_double++) {
        CLEANUP(end) molecule m;
        exported_how how = exported_usual();
        double v[9];
        how.double_precision = in_double;
        make(&m, how, 2);
        assert_ok(dem_reader_read(e.reader, dem_reader_array_find(e.reader, "velocity"), 2, v));
        assert_true(m.t == 0.5 && m.v[0] == v[0] && m.v[3] == v[4] && m.v[0] != 0.1);
    }
}

TEST(without_frames_it_is_the_lattice)
{
    CLEANUP(end) molecule m;
    exported_how how = exported_usual();
    how.frame_interval = 0.0;
    exported_open(&e, how);
    assert_int_equal(e.task.frames.n, 0);
    assert_true(molecule_make(&m, &e.task));
    assert_true(m.x[5] == 5.0 && m.v[0] == 0.1);
}

TEST(the_box_has_room)
{
    CLEANUP(end) molecule m;
    make(&m, exported_usual(), 0);
    const molecule_box box = molecule_box_of(&m, m.x);
    assert_close(box.low[0], -5.3, 1e-15);
    assert_close(box.high[0], 8.3, 2e-15);
    assert_close(box.low[1], -4.4, 1e-15);
    assert_close(box.high[1], 10.4, 2e-15);
}

TEST(what_is_left_out_is_reported)
{
    CLEANUP(end) molecule m;
    exported_how how = exported_usual();
    make(&m, how, 0);
    assert_string_equal(m.omissions, "left out: the folding guard of 1 triangle, 1 obstacle, gravity, which a run "
                                     "without a deck does not state");
    end(&m);
    how.n_obstacles = 0, how.resolved = "&solver mass_damping = 2 /";
    make(&m, how, 0);
    assert_string_equal(m.omissions, "left out: the folding guard of 1 triangle, the damping of masses, 2 1/s");
}
