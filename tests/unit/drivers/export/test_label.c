/* SPDX-License-Identifier: BSD-3-Clause */
#include "unit/close.h"

#include "label.h"

TEST(components_have_their_names)
{
    assert_string_equal(label_component("von_mises", 0, 1), "");
    assert_string_equal(label_component("velocity", 2, 3), "z");
    assert_string_equal(label_component("x", 1, 2), "y");
    assert_string_equal(label_component("stress", 2, 3), "xy");
    assert_string_equal(label_component("peak_stress", 3, 6), "xy");
    assert_string_equal(label_component("stress", 2, 6), "zz");
    assert_string_equal(label_component("principal_stress", 1, 2), "2");
    assert_string_equal(label_component("mine", 8, 9), "9");
    assert_string_equal(label_component("mine", 9, 12), "");
}
