/* SPDX-License-Identifier: BSD-3-Clause */
/* csv.c: heads and rows of a run of three nodes. All numbers are compared in tests/deck/test_export.py. */
#include "unit/drivers/export/exported.h"

#include "csv.h"

TEST_WITH(nodes_and_springs_have_rows_for_each_frame, exported_begin, exported_end)
{
    exported *e = *test_state;
    assert_true(csv_export(&e->task));
    exported_expect(e, "run.nodes.csv",
                    "frame,t [s],node,x [m],y [m],body,displacement_x [m],displacement_y [m],displacement_z [m],id,"
                    "stress_xx [Pa],stress_yy [Pa],stress_zz [Pa],stress_xy [Pa],stress_yz [Pa],stress_xz [Pa],"
                    "velocity_x [m/s],velocity_y [m/s],velocity_z [m/s],von_mises [Pa]\r\n"
                    "0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0.100000001,-0.25,0,0\r\n0,0,1,3,1,0,");
    exported_expect(e, "run.springs.csv",
                    "frame,t [s],spring,first,second,broken,force [N],strain [1]\r\n0,0,0,0,1,0,0,0\r\n"
                    "0,0,1,1,2,0,0,0\r\n0,0,2,2,0,0,0,0\r\n1,0.25,0,0,1,0,");
}

TEST_WITH(tables_have_their_columns, exported_begin, exported_end)
{
    exported *e = *test_state;
    assert_true(csv_export(&e->task));
    exported_expect(e, "run.probes.tip.csv",
                    "t [s],stress_xx [Pa],stress_yy [Pa],stress_xy [Pa],v_x [m/s],v_y [m/s],von_mises [Pa],x_x [m],"
                    "x_y [m]\r\n0,0,0,0,0.10000000000000001,-0.25,0,0,1\r\n");
    exported_expect(e, "run.history.csv", "body_angular_momentum_0 [kg m^2/s],body_centre_0_x [m],body_centre_0_y [m]");
    exported_expect(e, "run.frames.csv",
                    "area_energy [J],boundary_energy [J],contact_energy [J],contacts,damping_energy [J]");
    assert_false(exported_has(e, "run.events.csv"));
}

TEST_WITH(files_in_the_way_stop_it_before_it_begins, exported_begin, exported_end)
{
    exported *e = *test_state;
    exported_put(e, "run.springs.csv", "mine");
    assert_false(csv_export(&e->task));
    assert_int_equal(e->outcome.code, EXIT_TAKEN);
    assert_false(exported_has(e, "run.history.csv"));
}
