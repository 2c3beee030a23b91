/* SPDX-License-Identifier: BSD-3-Clause */
/* units.c: that the table is docs/output.md's is tested with the exported tables. */
#include "unit/close.h"

#include "output/units.h"

TEST(a_name_has_its_unit)
{
    assert_string_equal(units_of("history", "t"), "s");
    assert_string_equal(units_of("history", "boundary_energy"), "J");
    assert_string_equal(units_of("history", "body_angular_momentum"), "kg m^2/s");
    assert_string_equal(units_of("history", "peak_stress"), "Pa");
    assert_string_equal(units_of("history", "strain"), "1");
    assert_string_equal(units_of("history", "friction"), "J");
    assert_string_equal(units_of(NULL, "contact_pressure"), "Pa");
}

TEST(a_work_in_the_history_is_a_number_elsewhere)
{
    assert_string_equal(units_of("history", "obstacle"), "J");
    assert_string_equal(units_of("events", "obstacle"), "");
    assert_string_equal(units_of(NULL, "obstacle"), "");
}

TEST(what_counts_or_is_unknown_has_none)
{
    assert_string_equal(units_of("history", "steps"), "");
    assert_string_equal(units_of("history", "stres"), "");
    assert_string_equal(units_of("history", ""), "");
}
