/* SPDX-License-Identifier: BSD-3-Clause */
/* solid_material.c: plates and limits against closed forms. What is refused is in test_assemble.c. */
#include "verification/support.h"

#include "lattice/solid_material.h"

static const dem_material glass = SIZED(dem_material, .youngs_modulus = 70e9, .poissons_ratio = 0.22, .density = 2500.0,
                                        .thickness = 3e-3, .strength = 60e6, .fracture_energy = 60.0);

/* Lame's constants do not know of plates: C11 - C12 = 2 G and, of plane strain, C12 = lambda. A few roundings. */
TEST(a_plate_of_plane_strain_has_lames_constants)
{
    dem_material m = glass;
    m.plane = DEM_PLANE_STRAIN;
    const solid_plate p = solid_material_plate(&m);
    const double shear = 70e9 / (2.0 * 1.22), lambda = 70e9 * 0.22 / (1.22 * (1.0 - 0.44));
    const double c11 = p.modulus / (1.0 - p.ratio * p.ratio) / m.thickness, c12 = p.ratio * c11;
    assert_close(c11 - c12, 2.0 * shear, 1e-14 * shear);
    assert_close(c12, lambda, 1e-14 * lambda);
    assert_close(solid_material_spring_modulus(&m), 8.0 / 3.0 * shear * m.thickness, 1e-14 * shear);
    assert_close(solid_material_area_modulus(&m, 0.5), (lambda - shear) * m.thickness, 1e-13 * shear);
}

/* With l = E G/strength^2 triangles are small enough up to l/3.4, at which they are brittle. */
TEST(triangles_soften_up_to_the_size_that_is_brittle)
{
    const double coarsest = 70e9 * 60.0 / (60e6 * 60e6) / 3.4;
    assert_true(solid_material_softens(&glass));
    assert_ok(solid_material_check_size(&glass, false, 0.999 * coarsest));
    assert_int_equal(solid_material_check_size(&glass, false, 1.001 * coarsest), DEM_ERROR_ARGUMENT);
    const double half = 0.25 * sqrt(3.0) * (0.5 * coarsest) * (0.5 * coarsest); /* of edges half as long */
    const solid_limits limits = solid_material_limits(&glass, false, half);
    assert_close(limits.strength, 60e6, 0.0);
    assert_close(2.0 + 1.07 * limits.softening, 6.8, 1e-12); /* the line of q from 2 to 6 */
    assert_true(isinf(limits.compressive_strength));
}

TEST(a_fracture_energy_alone_gives_a_strength)
{
    dem_material m = glass;
    m.strength = 0.0;
    const double size = 1e-3, area = 0.25 * sqrt(3.0) * size * size;
    const solid_limits limits = solid_material_limits(&m, false, area);
    assert_true(!solid_material_softens(&m));
    assert_close(limits.strength, sqrt(70e9 * 60.0 / (3.4 * size)), 1e-14 * limits.strength);
    assert_close(limits.softening, 1.0, 0.0);
}

TEST(what_is_not_given_is_never_reached)
{
    dem_material m = glass;
    m.strength = m.fracture_energy = 0.0;
    assert_true(isinf(solid_material_limits(&m, false, 1e-6).strength));
    assert_true(isinf(solid_material_critical_stretch(&m)));
    m.critical_stretch = 0.01;
    assert_close(solid_material_critical_stretch(&m), 0.01, 0.0);
}
