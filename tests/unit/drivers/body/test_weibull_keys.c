/* SPDX-License-Identifier: BSD-3-Clause */
/* weibull_keys.c: which keys of a material whose strengths scatter go together, and what they say. */
#include "unit/reading.h"

#include "weibull_keys.h"

#define RAW "&run t_end = 1 /\n&body shape = 'disc', material = 'm' /\n&material name = 'm', density = 1,"

static void assert_checked(const char *text, const char *expected)
{
    char got[2048];
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    CLEANUP(drop_resolved) resolved r = resolve_clean(text);
    weibull_keys_check(&r.deck, &errors);
    list_faults(&errors, got, sizeof got);
    assert_line_parts(got, expected);
}

TEST(a_shape_goes_with_a_volume_and_a_kind_of_fracture)
{
    assert_checked(RAW "fracture = 'stress', strength = 1 /", "");
    assert_checked(RAW "fracture = 'stress', strength = 1, weibull = 8, weibull_volume = 1 /", "");
    assert_checked(RAW "fracture = 'stretch', weibull = 8, weibull_volume = 1, strength_seed = 4 /", "");
    assert_checked(RAW "fracture = 'stress', strength = 1,\n weibull = 8 /",
                   "4:2 'weibull' * needs 'weibull_volume' * 'strength'");
    assert_checked(RAW "fracture = 'stretch',\n weibull = 8 /",
                   "4:2 'weibull' * needs 'weibull_volume' * 'critical_stretch'");
    assert_checked(RAW "fracture = 'stress', fracture_energy = 1,\n weibull = 8, weibull_volume = 1 /",
                   "4:2 'weibull' * needs 'strength' * 'fracture_energy'");
    assert_checked(RAW "fracture = 'stress',\n weibull_volume = 8 /", "4:2 'weibull_volume' * without 'weibull'");
    assert_checked(RAW "fracture = 'stress',\n strength_seed = 8 /", "4:2 'strength_seed' * without 'weibull'");
    assert_checked(RAW "\n weibull = 8 /", "4:2 'weibull' * not used by fracture 'none'");
    assert_checked(RAW "\n weibull = 8,\n weibull_volume = 1,\n strength_seed = 1 /",
                   "4:2 'weibull' * 'none'\n5:2 'weibull_volume' * 'none'\n6:2 'strength_seed' * 'none'");
}

TEST(shape_volume_and_seed_are_numbers_of_a_law)
{
    static const char *const bad[] = {"weibull = 0.9",        "weibull = 0",        "weibull = -2",
                                      "weibull = nan",        "weibull_volume = 0", "weibull_volume = -1",
                                      "weibull_volume = nan", "strength_seed = -1", "strength_seed = 0.5"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        char text[256];
        (void)snprintf(text, sizeof text, RAW "fracture = 'stress',\n %s /", bad[k]);
        CLEANUP(drop_resolved) resolved r = {0};
        assert_true(namelist_parse(&r.list, text, strlen(text), &r.errors));
        if (r.errors.n == 0) assert_true(schema_resolve(&r.deck, &r.list, &r.errors));
        if (r.errors.n != 1) fail_msg("'%s' has %zu faults", bad[k], r.errors.n);
        assert_int_equal(r.errors.list[0].place.line, 4);
    }
}

TEST(a_material_has_its_law)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(RAW "fracture = 'stress', weibull = 8, weibull_volume = 3, strength_seed = 5 /\n"
                                   "&material name = 'n', density = 1 /\n&body shape = 'disc', material = 'n' /");
    const dem_weibull law = weibull_keys_law(&r.deck, schema_get(&r.deck, "body", 0));
    assert_close(law.shape, 8.0, 0.0);
    assert_close(law.volume, 3.0, 0.0);
    assert_int_equal(law.seed, 5);
    assert_close(weibull_keys_law(&r.deck, schema_get(&r.deck, "body", 1)).shape, 0.0, 0.0);
}

TEST(a_seed_stays_where_strengths_scatter)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(RAW "fracture = 'stress', weibull = 8, weibull_volume = 3 /\n"
                                   "&material name = 'n', density = 1, fracture = 'stress' /");
    weibull_keys_drop_unused(&r.deck);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "material", 0), "strength_seed")->count, 1);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "material", 1), "strength_seed")->count, 0);
}
