/* SPDX-License-Identifier: BSD-3-Clause */
/* The schema: checks against the table, and defaults. */
#include "unit/reading.h"

#define MATERIAL "&material youngs_modulus = 1e7, density = 1050 /\n"
#define BODY     "&body shape = 'disc', radius = 0.1, spacing = 0.02 /\n"
#define RUN      "&run t_end = 1 /\n"

static void assert_errors(const char *text, const char *expected)
{
    char got[4096];
    resolved r = resolve(text);
    list_faults(&r.errors, got, sizeof got);
    drop_resolved(&r);
    assert_string_equal(got, expected);
}

/* The faults of a key in an otherwise good deck, whose first line is "&body <keys>". */
static void assert_body_errors(const char *keys, const char *expected)
{
    char text[512];
    (void)snprintf(text, sizeof text, "&body %s /\n%s%s", keys, RUN, MATERIAL);
    assert_errors(text, expected);
}

/* ---- what is read --------------------------------------------------------------------------------------------- */

TEST(given_values_and_defaults_are_distinguished)
{
    CLEANUP(drop_resolved) resolved r = resolve_clean("&run t_end = 2 /" MATERIAL BODY);
    const schema_instance *run = schema_get(&r.deck, "run", 0);
    assert_true(schema_value_of(run, "t_end")->given);
    assert_close(schema_real(run, "t_end"), 2, 0);
    assert_false(schema_value_of(run, "gravity")->given);
    assert_int_equal(schema_value_of(run, "gravity")->count, 2);
    assert_close(schema_value_of(run, "gravity")->reals[1], -9.81, 0);
    assert_string_equal(schema_text(run, "title"), "");
}

TEST(a_key_without_default_stays_not_given)
{
    CLEANUP(drop_resolved) resolved r = resolve_clean(RUN MATERIAL BODY);
    const schema_instance *body = schema_get(&r.deck, "body", 0);
    assert_int_equal(schema_value_of(body, "clearance")->count, 0);
    assert_close(schema_real(body, "clearance"), 0, 0);
    assert_string_equal(schema_text(body, "file"), "");
}

TEST(groups_stand_in_the_order_of_the_table_then_of_the_file)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean("&body shape='disc' angle=1/ &material youngs_modulus=1 density=1/ &body shape='disc' "
                               "angle=2/" RUN);
    assert_string_equal(r.deck.instances[0].group->name, "run");
    assert_int_equal(schema_count(&r.deck, "body"), 2);
    assert_close(schema_real(schema_get(&r.deck, "body", 1), "angle"), 2, 0);
    assert_null(schema_get(&r.deck, "body", 2));
}

TEST(only_groups_that_do_not_repeat_get_an_instance_of_defaults)
{
    CLEANUP(drop_resolved) resolved r = resolve_clean(RUN MATERIAL BODY);
    assert_int_equal(schema_count(&r.deck, "solver"), 1);
    assert_int_equal(schema_count(&r.deck, "void"), 0);
    assert_string_equal(schema_text(schema_get(&r.deck, "solver", 0), "method"), "fehlberg45");
}

TEST(places_are_of_the_key_or_of_the_group)
{
    CLEANUP(drop_resolved) resolved r = resolve_clean("\n&run\n  t_end = 1 /" MATERIAL BODY);
    const schema_instance *run = schema_get(&r.deck, "run", 0);
    assert_int_equal(schema_value_of(run, "t_end")->place.line, 3);
    assert_int_equal(schema_value_of(run, "t_end")->place.column, 3);
    assert_int_equal(schema_value_of(run, "title")->place.line, 2);
}

TEST(an_integer_does_for_a_real)
{
    CLEANUP(drop_resolved) resolved r = resolve_clean("&run t_end = 3 gravity = 0, -10 /" MATERIAL BODY);
    assert_close(schema_value_of(schema_get(&r.deck, "run", 0), "gravity")->reals[1], -10, 0);
}

static void assert_gravity(const char *assignment, double x, double y)
{
    char text[512];
    (void)snprintf(text, sizeof text, "&run t_end = 3 %s /%s", assignment, MATERIAL BODY);
    CLEANUP(drop_resolved) resolved r = resolve_clean(text);
    const schema_value *gravity = schema_value_of(schema_get(&r.deck, "run", 0), "gravity");
    assert_int_equal(gravity->count, 2);
    assert_close(gravity->reals[0], x, 0);
    assert_close(gravity->reals[1], y, 0);
}

TEST(null_values_keep_defaults)
{
    assert_gravity("gravity = , 5", 0, 5);
    assert_gravity("gravity = 5, , title = ,", 5, -9.81);
    assert_gravity("gravity = 5, 6, , ,", 5, 6);
    assert_gravity("gravity = 2*", 0, -9.81);
}

TEST(a_null_value_gives_nothing)
{
    CLEANUP(drop_resolved) resolved r = resolve_clean("&run t_end = 3 gravity = , /" MATERIAL BODY);
    assert_false(schema_value_of(schema_get(&r.deck, "run", 0), "gravity")->given);
}

TEST(elements_without_assignment_keep_defaults)
{
    assert_gravity("gravity(2) = -3", 0, -3);
    assert_gravity("gravity(1) = 3", 3, -9.81);
}

TEST(subscripted_assignments_combine)
{
    static const double expected[] = {1, 2, 3, 4, 5, 6};
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(RUN MATERIAL BODY
                               "&obstacle points(2:6:2) = 2, 4, 6 points(1)=1 points(3) = 3, points(5:) = 5 /");
    const schema_value *points = schema_value_of(schema_get(&r.deck, "obstacle", 0), "points");
    assert_int_equal(points->count, 6);
    for (int k = 0; k < 6; k++) assert_close(points->reals[k], expected[k], 0);
}

TEST(the_nearest_name_is_found_in_any_case)
{
    static const char *const names[] = {"spacing", "shape", "size", "youngs_modulus"};
    size_t k = 99;
    assert_true(schema_nearest("shpae", names, 4, &k));
    assert_int_equal(k, 1);
    assert_true(schema_nearest("SPACING", names, 4, &k));
    assert_int_equal(k, 0);
    assert_true(schema_nearest("youngs", names, 4, &k));
    assert_int_equal(k, 3);
}

TEST(long_names_are_near_to_nothing)
{
    char text[301];
    const char *const names[] = {text, "aab"};
    size_t k = 99;
    memset(text, 'a', 300);
    text[300] = '\0';
    assert_false(schema_nearest(text, names, 2, &k));
    assert_true(schema_nearest("aaa", names, 2, &k));
    assert_int_equal(k, 1);
    char deck[512];
    (void)snprintf(deck, sizeof deck, RUN MATERIAL BODY "&contact %s = 1 /", text);
    assert_errors(deck, "4:10 unknown key 'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa' in &contact");
}

TEST(what_was_at_fault_is_known)
{
    CLEANUP(drop_resolved)
    resolved r = resolve(RUN MATERIAL "&body shape = 'disc', radus = 1, spacing = , size(0) = 1, clearance = 'x'\n"
                                      " position 2 /\n&obstacel /");
    const schema_instance *body = schema_get(&r.deck, "body", 0);
    assert_int_equal(r.errors.n, 5);
    assert_true(r.deck.misspelt);
    static const char *const faulty[] = {"radius", "size", "clearance", "position"};
    static const char *const good[] = {"shape", "spacing", "velocity"};
    for (int k = 0; k < 4; k++) assert_true(schema_value_of(body, faulty[k])->faulty);
    for (int k = 0; k < 3; k++) assert_false(schema_value_of(body, good[k])->faulty);
    drop_resolved(&r);
    r = resolve("&weather /\n" RUN MATERIAL BODY);
    assert_false(r.deck.misspelt);
}

TEST(values_can_be_dropped_and_texts_replaced)
{
    CLEANUP(drop_resolved) resolved r = resolve_clean(RUN MATERIAL "&body shape = 'disc', file = 'a', radius = 2 /");
    schema_instance *body = &r.deck.instances[2];
    assert_string_equal(body->group->name, "body");
    schema_drop(body, "radius");
    schema_drop(body, "material");
    schema_drop(body, "size");
    assert_int_equal(schema_value_of(body, "radius")->count, 0);
    assert_false(schema_value_of(body, "radius")->given);
    assert_close(schema_real(body, "radius"), 0.0, 0.0);
    assert_string_equal(schema_text(body, "material"), "");
    assert_true(schema_set_text(body, "file", "/somewhere/b"));
    assert_string_equal(schema_text(body, "file"), "/somewhere/b");
    assert_true(schema_value_of(body, "file")->given);
}

TEST(a_far_name_is_not_suggested)
{
    static const char *const names[] = {"spacing", "shape", "size"};
    size_t k;
    assert_false(schema_nearest("velocity", names, 3, &k));
    assert_false(schema_nearest("si", names, 2, &k)); /* distance 5 to "shape", "spacing"; too short to begin one */
    assert_false(schema_nearest("", names, 3, &k));
}

/* ---- errors --------------------------------------------------------------------------------------------------- */

TEST(an_unknown_key_names_the_nearest)
{
    assert_body_errors("shape = 'disc' spaceing = 1 qqqqqqq = 2",
                       "1:22 unknown key 'spaceing' in &body (did you mean 'spacing'?)\n"
                       "1:35 unknown key 'qqqqqqq' in &body");
}

TEST(a_misspelt_key_is_not_missed_as_well)
{
    assert_errors(RUN "&material youngs = 1, density = 1 /" BODY,
                  "2:11 unknown key 'youngs' in &material (did you mean 'youngs_modulus'?)");
}

TEST(a_renamed_key_is_refused_with_its_new_name)
{
    assert_errors(RUN MATERIAL BODY "&contact skin = 1e-8 /",
                  "4:10 unknown key 'skin' in &contact: it is called 'penetration_tolerance' now");
    assert_body_errors("shape = 'disc' skin = 1", "1:22 unknown key 'skin' in &body (did you mean 'spin'?)");
}

TEST(components_are_unknown_keys)
{
    assert_body_errors("shape = 'disc' size%x = 1", "1:22 unknown key 'size%x' in &body (did you mean 'size'?)");
}

TEST(an_unknown_group_names_the_nearest)
{
    assert_errors("&rum t_end = 1 /\n&xylophone /\n" MATERIAL BODY, "1:1 unknown group &rum (did you mean &run?)\n"
                                                                    "2:1 unknown group &xylophone");
}

TEST(required_groups_must_be_given)
{
    assert_errors("", "1:1 &run must be given\n1:1 &body must be given");
}

TEST(required_keys_must_be_given)
{
    assert_errors("&run t_end = , /\n" MATERIAL "&body /", "1:1 't_end' in &run must be given\n"
                                                           "3:1 'shape' in &body must be given");
}

TEST(a_group_that_does_not_repeat_is_given_once)
{
    assert_errors(RUN MATERIAL BODY "&solver /\n&solver /", "5:1 &solver is given twice, first in line 4");
}

TEST(a_key_is_given_once)
{
    assert_errors(RUN MATERIAL BODY "&solver rtol = 1e-5,\n rtol = 1e-6 rtol(1) = 1e-7 /",
                  "5:2 key 'rtol' is given twice in &solver, first in line 4\n"
                  "5:14 key 'rtol' is given twice in &solver, first in line 4");
}

TEST(an_element_is_given_once)
{
    assert_body_errors("shape = 'disc' size(1:2) = 1, 2\n size(2) = 3",
                       "2:2 'size(2)' is given twice in &body, first in line 1");
}

TEST(an_element_without_default_may_not_be_left_out)
{
    assert_errors(RUN MATERIAL BODY "&obstacle points = 1, 2, , 4 /\n&obstacle points(1:2) = 1, 2 points(5) = 3 /",
                  "4:11 'points(3)' in &obstacle is not given\n5:11 'points(3)' in &obstacle is not given");
}

TEST(types_are_checked)
{
    assert_body_errors("shape = disc angle = '3mm' spacing = 3mm radius = .true. material = 5",
                       "1:15 'shape' in &body expects a string in quotes, got disc\n"
                       "1:28 'angle' in &body expects a real, got '3mm'\n"
                       "1:44 'spacing' in &body expects a real, got '3mm'\n"
                       "1:57 'radius' in &body expects a real, got '.true.'\n"
                       "1:75 'material' in &body expects a string in quotes, got 5");
}

TEST(a_real_does_not_do_for_an_integer)
{
    assert_errors(RUN MATERIAL BODY "&pores number = 3.5 radius = 1, 2 seed = 9007199254740993 /",
                  "4:17 'number' in &pores expects an integer, got '3.5'\n"
                  "4:42 'seed' in &pores must be at most 2^53, got 9007199254740993");
}

TEST(numbers_of_values_are_checked)
{
    assert_body_errors("shape = 'disc' size = 1 angle = 1, 2 radius(3) = 1",
                       "1:22 'size' in &body expects 2 values, got 1\n"
                       "1:31 'angle' in &body expects 1 value, got 2\n"
                       "1:44 'radius' in &body expects 1 value, got 3");
    assert_errors(RUN MATERIAL BODY "&obstacle points = 1, 2 /",
                  "4:11 'points' in &obstacle expects at least 4 values, got 2");
    assert_errors(RUN MATERIAL BODY "&probe name = 'a', place = 1, number = 1, 2, 3 /",
                  "4:20 'place' in &probe expects 2 to 4 values, got 1\n"
                  "4:31 'number' in &probe expects 1 to 2 values, got 3");
}

TEST(the_number_of_values_comes_before_their_ranges)
{
    assert_body_errors("shape = 'disc' radius = 0,03 spacing = 0, 3 angle = 1,5 clearance = -1, 1",
                       "1:22 'radius' in &body expects 1 value, got 2; a decimal point is written '.', not ','\n"
                       "1:36 'spacing' in &body expects 1 value, got 2\n"
                       "1:51 'angle' in &body expects 1 value, got 2; a decimal point is written '.', not ','\n"
                       "1:63 'clearance' in &body expects 1 value, got 2");
    assert_body_errors("shape = 'disc' size = 0.1,0.2,3 velocity = 0, -9,81 radius = 2*1 position = 1",
                       "1:22 'size' in &body expects 2 values, got 3\n"
                       "1:39 'velocity' in &body expects 2 values, got 3; a decimal point is written '.', not ','\n"
                       "1:59 'radius' in &body expects 1 value, got 2\n"
                       "1:72 'position' in &body expects 2 values, got 1");
}

TEST(ranges_are_checked)
{
    assert_errors(RUN "&material youngs_modulus = 0, density = -5, guard = -1e-3, poissons_ratio = 1 /\n" BODY
                      "&obstacle points = 4*0 restitution = 1.5 /\n&solver rtol = 1e-14 /\n&output deflate = 10 /",
                  "2:28 'youngs_modulus' in &material must be > 0, got 0\n"
                  "2:41 'density' in &material must be > 0, got -5\n"
                  "2:53 'guard' in &material must be >= 0, got -1e-3\n"
                  "2:77 'poissons_ratio' in &material must be in (-1, 1), got 1\n"
                  "4:38 'restitution' in &obstacle must be in [0, 1], got 1.5\n"
                  "5:16 'rtol' in &solver must be in [1e-13, 1e-1], got 1e-14\n"
                  "6:19 'deflate' in &output must be in [0, 9], got 10");
}

TEST(ends_of_ranges_belong_to_them)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(RUN MATERIAL BODY "&obstacle points = 4*0 restitution = 1 /\n&solver rtol = 1e-1 /"
                                                 "&output deflate = 9 / &body shape = 'disc' clearance = 0 /");
}

TEST(choices_are_listed_with_the_nearest)
{
    assert_body_errors("shape = 'rectangel' lattice = 'cubic'",
                       "1:15 'shape' in &body must be 'rectangle', 'disc', 'ring', 'polygon', 'mask', 'mesh' or "
                       "'file', got 'rectangel' (did you mean 'rectangle'?)\n"
                       "1:37 'lattice' in &body must be 'triangular' or 'square', got 'cubic'");
    assert_errors(RUN MATERIAL BODY "&output precision = 'Double' /",
                  "4:21 'precision' in &output must be 'single' or 'double', got 'Double' (did you mean 'double'?)");
}

TEST(every_bad_element_is_reported_but_a_repeated_one_once)
{
    assert_body_errors("shape = 'disc' size = -1, 0", "1:29 'size' in &body must be > 0, got -1\n"
                                                      "1:33 'size' in &body must be > 0, got 0");
    assert_body_errors("shape = 'disc' size = 2*-1", "1:29 'size' in &body must be > 0, got -1");
}

TEST(a_fault_of_the_syntax_is_not_reported_again)
{
    assert_errors("&run t_end 20e-3 gravity = nan /\n" MATERIAL BODY, "1:6 '=' is missing after 't_end'\n"
                                                                      "1:28 'gravity': 'nan' is not a finite number");
}

TEST(the_default_stands_in_for_a_fault)
{
    CLEANUP(drop_resolved)
    resolved r = resolve(RUN "&material youngs_modulus = 1e7, density = 1, thickness = -2 /" BODY);
    const schema_instance *material = schema_get(&r.deck, "material", 0);
    assert_int_equal(r.errors.n, 1);
    assert_close(schema_real(material, "thickness"), 1, 0);
}
