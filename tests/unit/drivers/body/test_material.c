/* SPDX-License-Identifier: BSD-3-Clause */
/* material.c: what &material says, and who refers to one. Whole sentences are test_refused's and test_deck's. */
#include "unit/reading.h"

#include "material.h"

#define RUN    "&run t_end = 1 /\n"
#define RUBBER "&material name = 'rubber', youngs_modulus = 1e7, density = 1000 /\n"

TEST(a_material_is_read_by_its_name)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(RUN RUBBER "&material name = 'steel', youngs_modulus = 2e11, poissons_ratio = 0.3,\n"
                                          "  plane = 'strain', density = 7800, thickness = 0.5, guard = 0.1,\n"
                                          "  damping_time = 1e-6 /\n&body shape = 'disc', material = 'steel' /");
    const dem_material m = material_of(&r.deck, schema_get(&r.deck, "body", 0));
    assert_close(m.youngs_modulus, 2e11, 0.0);
    assert_close(m.bond_stiffness, 0.0, 0.0);
    assert_close(m.poissons_ratio, 0.3, 0.0);
    assert_int_equal(m.plane, DEM_PLANE_STRAIN);
    assert_close(m.density, 7800.0, 0.0);
    assert_close(m.thickness, 0.5, 0.0);
    assert_close(m.guard, 0.1, 0.0);
    assert_close(m.damping_time, 1e-6, 0.0);
    assert_int_equal(m.springs, DEM_SPRINGS_COUPLED);
    assert_ptr_equal(material_find(&r.deck, "rubber"), schema_get(&r.deck, "material", 0));
    assert_null(material_find(&r.deck, "rub"));
}

/* Of equal springs no nu is left to mean anything. */
TEST(a_bond_stiffness_stands_for_all_of_elasticity)
{
    CLEANUP(drop_resolved)
    resolved r =
        resolve_clean(RUN "&material name = 'raw', bond_stiffness = 3, density = 1 /\n" RUBBER
                          "&body shape = 'disc', material = 'raw' /\n&body shape = 'disc', material = 'rubber' /");
    material_drop_unused(&r.deck);
    const dem_material m = material_of(&r.deck, schema_get(&r.deck, "body", 0));
    assert_close(m.bond_stiffness, 3.0, 0.0);
    assert_close(m.youngs_modulus, 0.0, 0.0);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "material", 0), "poissons_ratio")->count, 0);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "material", 0), "plane")->count, 0);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "material", 0), "springs")->count, 0);
    assert_int_equal(m.springs, DEM_SPRINGS_INDEPENDENT);
    assert_int_equal(material_of(&r.deck, schema_get(&r.deck, "body", 1)).springs, DEM_SPRINGS_COUPLED);
    assert_close(material_of(&r.deck, schema_get(&r.deck, "body", 1)).poissons_ratio, 1.0 / 3.0, 1e-15);
}

/* Faults of the materials and of the first body's reference to one. */
static void assert_checked(const char *text, const char *expected)
{
    char got[2048];
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    CLEANUP(drop_resolved) resolved r = resolve_clean(text);
    material_check_all(&r.deck, &errors);
    material_check_user(&r.deck, schema_get(&r.deck, "body", 0), &errors);
    list_faults(&errors, got, sizeof got);
    assert_string_equal(got, expected);
}

#define BODY "&body shape = 'disc', material = 'rubber' /"

TEST(either_modulus_or_bond_stiffness_is_given)
{
    assert_checked(RUN RUBBER BODY, "");
    assert_checked(RUN "&material name = 'rubber', bond_stiffness = 1, density = 1 /\n" BODY, "");
    assert_checked(RUN "&material name = 'rubber', density = 1 /\n" BODY,
                   "2:1 'youngs_modulus' or 'bond_stiffness' in &material must be given");
    assert_checked(RUN "&material name = 'rubber', bond_stiffness = 1, density = 1,\nyoungs_modulus = 1 /\n" BODY,
                   "3:1 'youngs_modulus' in &material does not go with 'bond_stiffness'");
    assert_checked(RUN "&material name = 'rubber', bond_stiffness = 1, density = 1,\nplane = 'stress',\n"
                       "poissons_ratio = 0.2 /\n" BODY,
                   "4:1 'poissons_ratio' in &material does not go with 'bond_stiffness'\n"
                   "3:1 'plane' in &material does not go with 'bond_stiffness'");
}

TEST(a_limit_goes_with_its_kind_of_fracture)
{
#define RAW RUN "&material name = 'rubber', youngs_modulus = 1, density = 1, "
    assert_checked(RAW "fracture = 'stress', strength = 1e5 /\n" BODY, "");
    assert_checked(RAW "fracture = 'stretch', critical_stretch = 0.1 /\n" BODY, "");
    assert_checked(RAW "fracture = 'stress' /\n" BODY,
                   "2:1 'strength' or 'fracture_energy' in &material must be given for fracture 'stress'");
    assert_checked(RAW "fracture = 'stress', fracture_energy = 10 /\n" BODY, "");
    assert_checked(RAW "fracture = 'stretch', critical_stretch = 0.1,\nfracture_energy = 10 /\n" BODY,
                   "3:1 'fracture_energy' in &material is not used by fracture 'stretch'");
    assert_checked(RUN "&material name = 'rubber', bond_stiffness = 1, density = 1, fracture = 'stress',\n"
                       "fracture_energy = 10 /\n" BODY,
                   "3:1 'fracture_energy' in &material does not go with 'bond_stiffness': it needs 'youngs_modulus'");
    assert_checked(RAW "\nstrength = 1e5 /\n" BODY, "3:1 'strength' in &material is not used by fracture 'none'");
    assert_checked(RAW "fracture = 'stretch', critical_stretch = 0.1,\nstrength = 1e5 /\n" BODY,
                   "3:1 'strength' in &material is not used by fracture 'stretch'");
    CLEANUP(drop_resolved) resolved r = resolve_clean(RAW "fracture = 'stress', strength = 1e5 /\n" BODY);
    material_drop_unused(&r.deck);
    assert_close(material_of(&r.deck, schema_get(&r.deck, "body", 0)).strength, 1e5, 0.0);
    assert_close(material_of(&r.deck, schema_get(&r.deck, "body", 0)).critical_stretch, 0.0, 0.0);
}

TEST(a_compressive_strength_goes_with_a_strength_that_is_not_larger)
{
    assert_checked(RAW "fracture = 'stress', strength = 1e5, compressive_strength = 1e5 /\n" BODY, "");
    assert_checked(RAW "fracture = 'stress', strength = 1e5,\ncompressive_strength = 9e4 /\n" BODY,
                   "3:1 'compressive_strength' in &material must be >= 'strength', 100000 Pa, got 90000 Pa");
    assert_checked(RAW
                   "fracture = 'stress', strength = 1e5, fracture_energy = 10,\ncompressive_strength = 1e6 /\n" BODY,
                   "3:1 'compressive_strength' in &material does not go with 'fracture_energy', which is for bodies "
                   "that break in tension: leave one of them out");
    assert_checked(RAW "fracture = 'stress',\ncompressive_strength = 1e6 /\n" BODY,
                   "2:1 'strength' or 'fracture_energy' in &material must be given for fracture 'stress'\n"
                   "3:1 'compressive_strength' in &material needs 'strength', that in tension");
    assert_checked(RAW "fracture = 'stretch', critical_stretch = 0.1,\ncompressive_strength = 1e6 /\n" BODY,
                   "3:1 'compressive_strength' in &material is not used by fracture 'stretch'");
    CLEANUP(drop_resolved)
    resolved r = resolve_clean(RAW "fracture = 'stress', strength = 1e5, compressive_strength = 8e5 /\n" BODY);
    assert_close(material_of(&r.deck, schema_get(&r.deck, "body", 0)).compressive_strength, 8e5, 0.0);
}

TEST(the_stress_of_elements_goes_with_softening)
{
    assert_checked(RAW "fracture = 'stress', strength = 1e5, stress_average = 'corners' /\n" BODY, "");
    assert_checked(RAW "fracture = 'stress', strength = 1e5,\nstress_average = 'element' /\n" BODY,
                   "3:1 'stress_average' in &material is 'element' only with both 'strength' and 'fracture_energy'");
    assert_checked(RAW "fracture = 'stress', fracture_energy = 10,\nstress_average = 'element' /\n" BODY,
                   "3:1 'stress_average' in &material is 'element' only with both 'strength' and 'fracture_energy'");
    assert_checked(RAW "fracture = 'stretch', critical_stretch = 0.1,\nstress_average = 'element' /\n" BODY,
                   "3:1 'stress_average' in &material is not used by fracture 'stretch'");
    const char *const deck = RAW "fracture = 'stress', strength = 1e5, fracture_energy = 10,\n"
                                 "stress_average = 'element' /\n" BODY;
    assert_checked(deck, "");
    CLEANUP(drop_resolved) resolved r = resolve_clean(deck);
    assert_int_equal(material_of(&r.deck, schema_get(&r.deck, "body", 0)).stress_average, DEM_STRESS_AVERAGE_ELEMENT);
}

TEST(names_are_given_once_and_found)
{
    assert_checked(RUN RUBBER RUBBER BODY, "3:11 material 'rubber' is given twice, first in line 2");
    assert_checked(RUN RUBBER "&body shape = 'disc', material = 'rubbr' /",
                   "3:23 there is no material 'rubbr' (did you mean 'rubber'?)");
    assert_checked(RUN RUBBER "&body shape = 'disc' /",
                   "3:1 there is no material 'solid', the default of 'material' in &body; known: 'rubber'");
    assert_checked(RUN "&body shape = 'disc', material = 'rubber' /", ""); /* that there is none is reported once */
}

TEST(the_range_of_nu_is_that_of_the_plane)
{
    assert_checked(RUN "&material name = 'rubber', youngs_modulus = 1, density = 1, plane = 'strain',\n"
                       "poissons_ratio = 0.5 /\n" BODY,
                   "3:1 'poissons_ratio' in &material must be < 0.5 in plane strain, got 0.5");
    assert_checked(RUN "&material name = 'rubber', youngs_modulus = 1, density = 1, poissons_ratio = 0.5 /\n" BODY, "");
}
