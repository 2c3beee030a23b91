/* SPDX-License-Identifier: BSD-3-Clause */
/* lammps.c, data.c, script.c, dump.c: the files of a run of three nodes, line by line. */
#include "unit/drivers/export/exported.h"

#include "lammps.h"

static int open_run(void **state)
{
    exported_how how = exported_usual();
    how.resolved = "&run gravity = 3, -4 /";
    return exported_begin_with(state, how);
}

TEST_WITH(the_data_file_is_the_body, open_run, exported_end)
{
    exported *e = *test_state;
    assert_true(lammps_export(&e->task));
    exported_expect(e, "run.data",
                    "LAMMPS data file by dem_export of run at t = 0 s, units = si, 2-d\n"
                    "# left out: the folding guard of 1 triangle, 1 obstacle\n");
    exported_expect(e, "run.data", "\n3 atoms\n3 bonds\n3 atom types\n3 bond types\n\n");
    exported_expect(e, "run.data", "-2.5 2.5 zlo zhi\n\nMasses\n\n1 1\n2 2\n3 2 # fixed\n");
    exported_expect(e, "run.data",
                    "\nBond Coeffs # harmonic\n\n1 1 3\n2 0.59999999999999998 5\n3 1 4\n"
                    "\nAtoms # bond\n\n1 1 1 0 1 0\n2 1 2 3 1 0\n3 1 3 3 5 0\n"
                    "\nVelocities\n\n1 0.10000000000000001 -0.25 0\n2 0.10000000000000001 -0.25 0\n3 0 0 0\n"
                    "\nBonds\n\n1 1 1 2\n2 3 2 3\n3 2 3 1\n");
}

static int open_broken_run(void **state)
{
    exported_how how = exported_usual();
    how.breaks = true;
    return exported_begin_with(state, how);
}

/* From the frame behind the break on. */
TEST_WITH(the_data_file_has_no_broken_bonds, open_broken_run, exported_end)
{
    exported *e = *test_state;
    e->task.frames.frame[0] = 2;
    assert_true(lammps_export(&e->task));
    exported_expect(e, "run.data", "\n3 atoms\n0 bonds\n");
    assert_null(strstr(exported_text(e, "run.data"), "\nBonds\n"));
    assert_null(strstr(exported_text(e, "run.data"), "\n1 1 1 2\n"));
}

TEST_WITH(the_input_moves_what_is_free, open_run, exported_end)
{
    exported *e = *test_state;
    assert_true(lammps_export(&e->task));
    exported_expect(e, "in.run", "\nvariable time index 0.5\nvariable n index ");
    exported_expect(e, "in.run",
                    "pair_style none\nbond_style harmonic\nspecial_bonds lj 0 1 1\ncomm_modify cutoff 12.5\n"
                    "neighbor 2.5 bin\nread_data run.data\n\ngroup free type 1:2\nfix move free nve\n"
                    "fix weight free gravity 5 vector 0.59999999999999998 -0.80000000000000004 0\n"
                    "fix plane all enforce2d\n");
}

TEST_WITH(the_dumps_are_the_frames, open_run, exported_end)
{
    exported *e = *test_state;
    double v[9];
    char line[256];
    assert_true(lammps_export(&e->task));
    exported_expect(e, "run.dump", "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS ss ss pp\n");
    exported_expect(e, "run.dump",
                    "ITEM: ATOMS id mol type x y z displacement_x displacement_y displacement_z stress_xx stress_yy "
                    "stress_zz stress_xy stress_yz stress_xz vx vy vz von_mises\n1 1 1 0 1 0 0 0 0 0 0 0 0 0 0 "
                    "0.100000001 -0.25 0 0\n");
    assert_ok(dem_reader_read(e->reader, dem_reader_array_find(e->reader, "velocity"), 2, v));
    (void)snprintf(line, sizeof line, " %.9g %.9g 0 ", v[0], v[1]);
    exported_expect(e, "run.dump", line);
    exported_expect(e, "run.local.dump",
                    "ITEM: ENTRIES index btype batom1 batom2 force strain\n1 1 1 2 0 0\n2 3 2 3 0 0\n3 2 3 1 0 0\n"
                    "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ENTRIES\n3\n");
}

TEST_WITH(files_in_the_way_stop_it_before_it_begins, open_run, exported_end)
{
    exported *e = *test_state;
    exported_put(e, "run.local.dump", "mine");
    assert_false(lammps_export(&e->task));
    assert_int_equal(e->outcome.code, EXIT_TAKEN);
    assert_false(exported_has(e, "run.data"));
}

TEST_WITH(names_are_words, open_run, exported_end)
{
    exported *e = *test_state;
    e->task.name = "a$b";
    assert_false(lammps_export(&e->task));
    assert_int_equal(e->outcome.code, EXIT_USAGE);
}
