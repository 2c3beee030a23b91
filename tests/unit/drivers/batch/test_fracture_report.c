/* SPDX-License-Identifier: BSD-3-Clause */
/* fracture_report.c: a chain of six masses, 1 to 6 kg, broken behind the first and behind the third. */
#include "verification/support.h"

#include <stdio.h>
#include <string.h>

#include "fracture_report.h"

enum { N = 6 };

static void open_chain(support_run *run)
{
    double x[2 * N], masses[N];
    dem_index ends[2 * (N - 1)];
    for (dem_index i = 0; i < N; i++) {
        x[2 * i] = (double)i;
        x[2 * i + 1] = 0.0;
        masses[i] = (double)(i + 1);
    }
    for (dem_index k = 0; k < 2 * (N - 1); k++) ends[k] = (k + 1) / 2;
    CLEANUP(dem_lattice_free) dem_lattice chain = support_lattice(N, x, masses, N - 1, ends, 1.0, 1.0, NULL);
    const dem_options options = dem_options_default();
    support_open(run, &chain, NULL, 0, &options);
}

TEST(a_whole_chain_is_one_fragment)
{
    CLEANUP(support_close) support_run run;
    open_chain(&run);
    const fracture_report report = fracture_report_of(run.simulation);
    assert_int_equal(report.springs, 0);
    assert_int_equal(report.fragments, 1);
    assert_close(report.largest, 1.0, 0.0);
    assert_close(report.debris, 0.0, 0.0);
    assert_close(report.median, 21.0, 0.0);
}

/* Pieces of 1, 5 and 15 of 21 kg: half of that is reached with the last one. */
TEST(masses_of_fragments_are_those_of_their_nodes)
{
    const dem_index springs[] = {0, 2};
    CLEANUP(support_close) support_run run;
    open_chain(&run);
    assert_ok(dem_simulation_break(run.simulation, NULL, 0, springs, 2));
    const fracture_report report = fracture_report_of(run.simulation);
    assert_int_equal(report.springs, 2);
    assert_int_equal(report.fragments, 3);
    assert_close(report.largest, 15.0 / 21.0, 1e-16);
    assert_close(report.debris, 1.0 / 21.0, 1e-16);
    assert_close(report.median, 15.0, 0.0);
}

/* All nodes by themselves: 1 + 2 + 3 + 4 kg are less than half of 21, with 5 it is more. */
TEST(single_nodes_are_debris)
{
    const dem_index springs[] = {0, 1, 2, 3, 4};
    CLEANUP(support_close) support_run run;
    open_chain(&run);
    assert_ok(dem_simulation_break(run.simulation, NULL, 0, springs, 5));
    const fracture_report report = fracture_report_of(run.simulation);
    assert_int_equal(report.fragments, N);
    assert_close(report.largest, 6.0 / 21.0, 1e-16);
    assert_close(report.debris, 1.0, 1e-15);
    assert_close(report.median, 5.0, 0.0);
}
