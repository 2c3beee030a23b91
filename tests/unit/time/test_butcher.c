/* SPDX-License-Identifier: BSD-3-Clause */
/* butcher.c: names, tables that end with the solution, stability on the imaginary axis in closed form. */
#include "verification/support.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "harness/message.h"
#include "time/butcher.h"

TEST(every_method_has_a_name_by_which_it_is_found)
{
    dem_method found;
    for (int k = 0; k <= DEM_METHOD_VERLET; k++) {
        dem_method_traits traits = {.struct_size = sizeof traits};
        if (dem_method_describe(&traits, (dem_method)k) != DEM_OK) continue;
        assert_ok(dem_method_find(&found, traits.name));
        assert_int_equal(found, k);
    }
    assert_ok(dem_method_find(&found, "verner89"));
    assert_int_equal(found, DEM_METHOD_VERNER89);
    assert_int_equal(dem_method_find(&found, "euler"), DEM_ERROR_ARGUMENT);
    assert_message_parts("no method is called 'euler'");
}

TEST(what_is_not_there_is_refused_with_the_reason)
{
    dem_method_traits traits = {.struct_size = sizeof traits};
    butcher_table table;
    int number[2] = {0, 0};
    assert_int_equal(dem_method_describe(&traits, (dem_method)20), DEM_ERROR_ARGUMENT);
    assert_message_parts("method 20");
    assert_int_equal(butcher_load(&table, (dem_method)-1), DEM_ERROR_ARGUMENT);
    assert_int_equal(butcher_load(&table, DEM_METHOD_VERLET), DEM_ERROR_ARGUMENT);
    assert_int_equal(sscanf(dem_version_sundials(), "%d.%d", &number[0], &number[1]), 2);
    const bool old = 100 * number[0] + number[1] < 607;
    for (int k = DEM_METHOD_VERNER67; k <= DEM_METHOD_VERNER89; k++) {
        assert_int_equal(dem_method_describe(&traits, (dem_method)k), old ? DEM_ERROR_ARGUMENT : DEM_OK);
        if (old) assert_non_null(strstr(dem_status_message(), "' needs SUNDIALS 6.7 or later, this is 6."));
        assert_true(isnan(dem_method_growth((dem_method)k, 0.5)) == old);
    }
}

/* A last stage at the end of the step is the solution; the stages before are consistent, c_i = sum of a_ij; the weights
 * are those of a quadrature that is exact for a linear rate. */
TEST(a_last_stage_at_the_end_of_the_step_is_the_solution)
{
    for (int k = 0; k < DEM_METHOD_VERLET; k++) {
        butcher_table t;
        double sum = 0.0, moment = 0.0;
        if (butcher_load(&t, (dem_method)k) != DEM_OK) continue;
        for (int i = 0; i < t.stages; i++) {
            double row = 0.0;
            for (int j = 0; j < t.stages; j++) row += t.a[i * t.stages + j];
            assert_close(row, t.c[i], 1e-12);
            sum += t.b[i];
            moment += t.b[i] * t.c[i];
        }
        assert_close(sum, 1.0, 1e-12);
        assert_close(moment, 0.5, 1e-12);
        for (int j = 0; j < t.stages && t.c[t.stages - 1] == 1.0; j++)
            assert_close(t.a[(t.stages - 1) * t.stages + j], t.b[j], 1e-14);
    }
}

/* Heun's method has two stages: v' = v + h (a_0 + a_1)/2 from a_1 at the end of Euler's step. */
TEST(a_table_of_its_own_has_no_stage_for_arkode)
{
    butcher_table own, longer;
    assert_ok(butcher_load_own(&own, DEM_METHOD_HEUN12));
    assert_ok(butcher_load(&longer, DEM_METHOD_HEUN12));
    assert_int_equal(own.stages, 2);
    assert_int_equal(longer.stages, 3);
    assert_close(own.a[2], 1.0, 0.0);
    assert_close(own.b[0], 0.5, 0.0);
    assert_close(own.b[1], 0.5, 0.0);
    assert_int_equal(butcher_load_own(&own, DEM_METHOD_VERLET), DEM_ERROR_ARGUMENT);
}

/* R(z) of s = p stages is the exponential series: |R|^2 = 1 - z^4/12 + z^6/36 for p = 3, 1 - z^6/72 + z^8/576 for 4. */
TEST(growth_is_that_of_the_stability_polynomials)
{
    static const double z[] = {0.1, 0.5, 1.0, 2.0, 2.8, 3.0};
    for (size_t k = 0; k < sizeof z / sizeof *z; k++) {
        const double z2 = z[k] * z[k], z6 = z2 * z2 * z2;
        assert_close(dem_method_growth(DEM_METHOD_BS23, z[k]), sqrt(1.0 - z2 * z2 / 12.0 + z6 / 36.0), 1e-13);
        assert_close(dem_method_growth(DEM_METHOD_RK4, z[k]), sqrt(1.0 - z6 / 72.0 + z6 * z2 / 576.0), 1e-13);
    }
    assert_close(dem_method_growth(DEM_METHOD_VERLET, 2.0), 1.0, 0.0);
    const double grown = dem_method_growth(DEM_METHOD_VERLET, 2.4); /* l + 1/l = z^2 - 2 */
    assert_close(grown + 1.0 / grown, 2.4 * 2.4 - 2.0, 1e-13);
}

/* To the thousandth that is searched. Fehlberg's grows by 9.1e-4 z^6 from the start, Dormand and Prince's is damped up
 * to 0.997. */
TEST(the_stability_bounds_are_those_known)
{
    static const struct {
        dem_method method;
        double stable, usable;
    } known[] = {{DEM_METHOD_FEHLBERG45, 0.0, 1.09}, {DEM_METHOD_DOPRI45, 0.997, 1.334},
                 {DEM_METHOD_CASHKARP45, 0.0, 1.25}, {DEM_METHOD_ZONNEVELD34, 2.8284, 2.829},
                 {DEM_METHOD_BS23, 1.7320, 1.734},   {DEM_METHOD_RK4, 2.8284, 2.829},
                 {DEM_METHOD_VERLET, 2.0, 2.0}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        dem_method_traits traits = {.struct_size = sizeof traits};
        assert_ok(dem_method_describe(&traits, known[k].method));
        assert_close(traits.stable, known[k].stable, 1.1e-3);
        assert_close(traits.usable, known[k].usable, 1.1e-3);
    }
    assert_close(dem_method_growth(DEM_METHOD_FEHLBERG45, 0.1) - 1.0, 9.1e-10, 0.1e-10);
}

/* By hand. Classical: rows 1/2, 1/2, 1 and the end, 1/3 1/2 + 1/3 1/2 + 1/6 = 1/2. Heun's: a stage at the end, and
 * weights of 1/2. Verlet's is that of a parabola. Fehlberg's sixth stage reaches furthest. */
TEST(steps_reach_as_far_as_their_tables_say)
{
    static const struct {
        dem_method method;
        step_reach expected;
    } known[] = {
        {DEM_METHOD_RK4, {1.0, 0.5, 1.0}}, {DEM_METHOD_HEUN12, {1.0, 0.5, 1.0}}, {DEM_METHOD_VERLET, {1.0, 0.5, 1.0}}};
    step_reach found;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        assert_ok(butcher_reach(&found, known[k].method));
        assert_close(found.time, known[k].expected.time, 1e-15);
        assert_close(found.position, known[k].expected.position, 1e-15);
        assert_close(found.velocity, known[k].expected.velocity, 1e-15);
    }
    const double fourth = 16428.0 / 2197.0, fifth = 439.0 / 216.0 + 8.0 + 3680.0 / 513.0 + 845.0 / 4104.0;
    const double sixth = 2.0 / 4.0 + 3544.0 / 2565.0 * 3.0 / 8.0 + 1859.0 / 4104.0 * fourth + 11.0 / 40.0 * fifth;
    assert_ok(butcher_reach(&found, DEM_METHOD_FEHLBERG45));
    assert_close(found.time, 1.0, 1e-15);
    assert_close(found.position, sixth, 1e-13);
    assert_int_equal(butcher_reach(&found, (dem_method)-1), DEM_ERROR_ARGUMENT);
}

/* By hand. Classical: the second stage moves by v_0 and the third by a ring of v_1, so that at the end velocities have
 * the two rings of its acceleration. Each second one of Fehlberg's five stages brings a ring. */
TEST(rings_about_a_node_have_a_part_in_its_step)
{
    static const struct {
        dem_method method;
        int rings;
    } known[] = {{DEM_METHOD_HEUN12, 1}, {DEM_METHOD_RK4, 2}, {DEM_METHOD_FEHLBERG45, 3}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        butcher_table table;
        assert_ok(butcher_load(&table, known[k].method));
        assert_int_equal(butcher_rings(&table), known[k].rings);
    }
}

TEST(methods_that_end_in_a_stage_and_verlets_integrate_no_ghosts)
{
    assert_int_equal(butcher_rings_of(DEM_METHOD_FEHLBERG45), 3);
    assert_int_equal(butcher_rings_of(DEM_METHOD_DOPRI45), 0);
    assert_int_equal(butcher_rings_of(DEM_METHOD_RK4), 0);
    assert_int_equal(butcher_rings_of(DEM_METHOD_VERLET), 0);
}
