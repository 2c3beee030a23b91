/* SPDX-License-Identifier: BSD-3-Clause */
/* body_friction.c: which coefficient each body of a deck has. */
#include "body_friction.h"

#include "unit/deck_text.h"

#define RUN   "&run t_end = 1 /\n&obstacle points = -9, -9, 9, -9 /\n&contact bodies = 'others', friction = 0.2 /\n"
#define PLAIN "&material name = 'plain', youngs_modulus = 1e7, density = 1000 /\n"
#define ROUGH "&material name = 'rough', youngs_modulus = 1e7, density = 1000, friction = 0.7 /\n"
#define BODY(material, y)                                                                                              \
    "&body shape = 'rectangle', size = 0.02, 0.02, spacing = 5e-3, material = '" material "', position = 0, " y " /\n"

TEST(without_friction_of_materials_all_bodies_have_that_of_contact)
{
    CLEANUP(deck_free) deck d = deck_text_good(RUN PLAIN BODY("plain", "1") BODY("plain", "2"));
    assert_float_equal(d.options.contact_friction, 0.2, 0.0);
    assert_int_equal(d.options.n_body_frictions, 0);
    assert_null(d.options.body_friction);
}

TEST(the_friction_of_a_material_takes_the_place_of_that_of_contact)
{
    CLEANUP(deck_free)
    deck d = deck_text_good(RUN PLAIN ROUGH BODY("plain", "1") BODY("rough", "2") BODY("plain", "3"));
    const double expected[3] = {0.2, 0.7, 0.2};
    assert_int_equal(d.options.n_body_frictions, 3);
    for (int k = 0; k < 3; k++) assert_float_equal(d.options.body_friction[k], expected[k], 0.0);
}

TEST_GROUP(scratch_make, scratch_remove);
