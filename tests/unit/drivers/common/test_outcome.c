/* SPDX-License-Identifier: BSD-3-Clause */
/* outcome.c: the first fault decides. What is printed, tests/deck looks at. */
#include "unit/close.h"

#include <stdio.h>
#include <string.h>

#include <dem/dem.h>

#include "outcome.h"

TEST(the_first_fault_is_the_outcome)
{
    outcome o = {0};
    outcome_fail(&o, EXIT_IO, "a.nml:1:2", "no %s", "disk");
    outcome_fail(&o, EXIT_MEMORY, "b.nml", "none");
    assert_int_equal(o.code, EXIT_IO);
    assert_string_equal(o.message, "a.nml:1:2: error: no disk");
}

TEST(a_failure_of_the_library_has_its_code)
{
    static const struct {
        dem_status status;
        exit_code code;
    } all[] = {{DEM_ERROR_MEMORY, EXIT_MEMORY},    {DEM_ERROR_ARGUMENT, EXIT_INVALID},
               {DEM_ERROR_MODEL, EXIT_INVALID},    {DEM_ERROR_INTEGRATOR, EXIT_NUMERICS},
               {DEM_ERROR_CONTACT, EXIT_NUMERICS}, {DEM_ERROR_IO, EXIT_IO}};
    char expected[1024];
    dem_model *model;
    assert_int_equal(dem_model_create(&model, NULL, NULL, 0), DEM_ERROR_ARGUMENT);
    (void)snprintf(expected, sizeof expected, "deck: error: %s", dem_status_message());
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        outcome o = {0};
        outcome_fail_status(&o, all[k].status, "deck");
        assert_int_equal(o.code, all[k].code);
        assert_string_equal(o.message, expected);
    }
}

TEST(a_long_message_is_cut)
{
    char where[OUTCOME_MESSAGE + 10];
    outcome o = {0};
    memset(where, 'x', sizeof where);
    where[sizeof where - 1] = '\0';
    outcome_fail(&o, EXIT_IO, where, "y");
    assert_true(strlen(o.message) < OUTCOME_MESSAGE);
}
