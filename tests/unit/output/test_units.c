/* SPDX-License-Identifier: BSD-3-Clause */
/* units.c: that the table is docs/output.md's is tested with the exported tables. */
#include "unit/close.h"

#include "output/units.h"

TEST(a_name_has_its_unit)
{
    assert_string_equal(units_of("t"), "s");
    assert_string_equal(units_of("boundary_energy"), "J");
    assert_string_equal(units_of("body_angular_momentum"), "kg m^2/s");
    assert_string_equal(units_of("peak_stress"), "Pa");
    assert_string_equal(units_of("strain"), "1");
    assert_string_equal(units_of("friction"), "J");
}

TEST(what_counts_or_is_unknown_has_none)
{
    assert_string_equal(units_of("steps"), "");
    assert_string_equal(units_of("stres"), "");
    assert_string_equal(units_of(""), "");
}
