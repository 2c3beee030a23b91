/* SPDX-License-Identifier: BSD-3-Clause */
/* What can be a solid, its stiffness as a plate in plane stress, for which all formulas of assembling are
 * (docs/method.md, The solid), and what limits its triangles: of a given strength and fracture energy one follows from
 * the other by the size of triangles, or both make them soften (crack_band.h). */
#include "lattice/solid_material.h"

#include <math.h>

#include "base/status.h"
#include "lattice/crack_band.h"
#include "lattice/lattice.h"

/* ---- checks ---- */

/* E and nu, or one stiffness for all springs, but not both. nu must be below 1 in plane stress and below 1/2 in plane
 * strain: there the material becomes incompressible. */
static dem_status check_elasticity(const dem_material *m)
{
    const double nu = m->poissons_ratio, highest = m->plane == DEM_PLANE_STRAIN ? 0.5 : 1.0;
    if (m->bond_stiffness != 0.0) {
        CHECK(lattice_is_positive(m->bond_stiffness), DEM_ERROR_ARGUMENT, "the bond stiffness must be > 0: %g N",
              m->bond_stiffness);
        CHECK(m->youngs_modulus == 0.0, DEM_ERROR_ARGUMENT,
              "a material has Young's modulus, %g Pa, or a bond stiffness, %g N, not both", m->youngs_modulus,
              m->bond_stiffness);
        return DEM_OK;
    }
    CHECK(lattice_is_positive(m->youngs_modulus), DEM_ERROR_ARGUMENT, "Young's modulus must be > 0: %g Pa",
          m->youngs_modulus);
    CHECK(m->plane == DEM_PLANE_STRESS || m->plane == DEM_PLANE_STRAIN, DEM_ERROR_ARGUMENT,
          "plane is %d, which is neither stress nor strain", (int)m->plane);
    CHECK(nu > -1.0 && nu < highest, DEM_ERROR_ARGUMENT, "Poisson's ratio must be in (-1, %g) in plane %s: %g", highest,
          m->plane == DEM_PLANE_STRAIN ? "strain" : "stress", nu);
    return DEM_OK;
}

/* What breaks it; 0: nothing does. */
static dem_status check_limits(const dem_material *m)
{
    CHECK(isfinite(m->strength) && m->strength >= 0.0, DEM_ERROR_ARGUMENT, "strength must be >= 0: %g Pa", m->strength);
    CHECK(isfinite(m->critical_stretch) && m->critical_stretch >= 0.0, DEM_ERROR_ARGUMENT,
          "critical_stretch must be >= 0: %g", m->critical_stretch);
    CHECK(isfinite(m->fracture_energy) && m->fracture_energy >= 0.0, DEM_ERROR_ARGUMENT,
          "fracture_energy must be >= 0: %g J/m^2", m->fracture_energy);
    CHECK(m->fracture_energy == 0.0 || (m->critical_stretch == 0.0 && m->bond_stiffness == 0.0), DEM_ERROR_ARGUMENT,
          "a fracture energy, %g J/m^2, goes neither with a critical stretch nor with a bond stiffness",
          m->fracture_energy);
    CHECK(m->stress_average == DEM_STRESS_AVERAGE_CORNERS || m->stress_average == DEM_STRESS_AVERAGE_ELEMENT,
          DEM_ERROR_ARGUMENT, "stress_average is %d, which is neither corners nor element", (int)m->stress_average);
    CHECK(m->stress_average == DEM_STRESS_AVERAGE_CORNERS || (m->strength > 0.0 && m->fracture_energy > 0.0),
          DEM_ERROR_ARGUMENT, "the stress of elements breaks them with a strength and a fracture energy only");
    CHECK(isfinite(m->compressive_strength) && m->compressive_strength >= 0.0, DEM_ERROR_ARGUMENT,
          "compressive_strength must be >= 0: %g Pa", m->compressive_strength);
    if (m->compressive_strength == 0.0) return DEM_OK;
    CHECK(m->strength > 0.0 && m->fracture_energy == 0.0, DEM_ERROR_ARGUMENT,
          "a compressive strength, %g Pa, goes with a strength, and without a fracture energy",
          m->compressive_strength);
    CHECK(m->compressive_strength >= m->strength, DEM_ERROR_ARGUMENT,
          "compressive_strength must be at least the strength, %g Pa: %g Pa", m->strength, m->compressive_strength);
    return DEM_OK;
}

/* What every rule of assembly needs: a mass and a thickness, and no negative guard or damping. */
dem_status solid_material_check(const dem_material *m)
{
    CHECK(m != NULL, DEM_ERROR_ARGUMENT, "material is NULL");
    TRY(check_elasticity(m));
    CHECK(m->springs == DEM_SPRINGS_INDEPENDENT || m->springs == DEM_SPRINGS_COUPLED, DEM_ERROR_ARGUMENT,
          "springs is %d, which is neither independent nor coupled", (int)m->springs);
    CHECK(m->springs == DEM_SPRINGS_INDEPENDENT || m->bond_stiffness == 0.0, DEM_ERROR_ARGUMENT,
          "springs of a given bond stiffness, %g N, cannot be coupled", m->bond_stiffness);
    CHECK(lattice_is_positive(m->density), DEM_ERROR_ARGUMENT, "density must be > 0: %g kg/m^3", m->density);
    CHECK(lattice_is_positive(m->thickness), DEM_ERROR_ARGUMENT, "thickness must be > 0: %g m", m->thickness);
    CHECK(isfinite(m->guard) && m->guard >= 0.0, DEM_ERROR_ARGUMENT, "guard must be >= 0: %g", m->guard);
    CHECK(isfinite(m->damping_time) && m->damping_time >= 0.0, DEM_ERROR_ARGUMENT, "damping_time must be >= 0: %g s",
          m->damping_time);
    return check_limits(m);
}

/* ---- stiffness ---- */

/* Plane strain is plane stress with E/(1 - nu^2) and nu/(1 - nu). With a given stiffness of springs E and nu are
 * unknown. */
solid_plate solid_material_plate(const dem_material *m)
{
    const double nu = m->poissons_ratio, modulus = m->youngs_modulus * m->thickness;
    if (m->bond_stiffness > 0.0) return (solid_plate){0.0, 0.0};
    if (m->plane == DEM_PLANE_STRESS) return (solid_plate){modulus, nu};
    return (solid_plate){modulus / (1.0 - nu * nu), nu / (1.0 - nu)};
}

/* (8/3) G h = (4/3) E h/(1 + nu), N/m, which is E h at nu = 1/3, to the bit. */
double solid_material_spring_modulus(const dem_material *m)
{
    const solid_plate p = solid_material_plate(m);
    return p.modulus * ((4.0 / 3.0) / (1.0 + p.ratio));
}

/* kappa, N/m: what the springs leave of C12 h = nu E h/(1 - nu^2), to which diagonals give r E h/(1 + nu). At r = 1/2,
 * which is isotropic, it is (lambda - G) h and 0 at nu = 1/3, to the bit. With equal springs there is none. */
double solid_material_area_modulus(const dem_material *m, double diagonal)
{
    const solid_plate p = solid_material_plate(m);
    const double nu = p.ratio, r = diagonal;
    return m->bond_stiffness > 0.0 ? 0.0 : p.modulus * ((1.0 + r) * nu - r) / (1.0 - nu * nu);
}

/* ---- cells ---- */

/* A cell warps when its corners move by turns along the same direction. Both diagonals keep their lengths; the sides
 * resist alone, and the areas of the two triangles change by the same amount, one up, one down. The stiffness of this
 * is
 *     k + 2 kappa = E h ((1 + nu) - 2 r (1 - nu))/(1 - nu^2),
 * which is positive if r < (1 + nu)/(2 (1 - nu)). Bodies whose cells are stable are stable. */
static dem_status check_diagonal(solid_plate p, double diagonal)
{
    const double limit = 0.5 * (1.0 + p.ratio) / (1.0 - p.ratio);
    CHECK(
        diagonal < limit, DEM_ERROR_ARGUMENT,
        "the stiffness of a diagonal over a side's must be less than %g, or cells warp, at Poisson's ratio %g in plane "
        "stress: %g",
        limit, p.ratio, diagonal);
    return DEM_OK;
}

dem_status solid_material_check_cells(const dem_material *m, double diagonal)
{
    TRY(solid_material_check(m));
    CHECK(m->springs == DEM_SPRINGS_INDEPENDENT, DEM_ERROR_ARGUMENT,
          "coupled springs are those of triangles, but cells are asked for");
    CHECK(m->stress_average == DEM_STRESS_AVERAGE_CORNERS, DEM_ERROR_ARGUMENT,
          "the stress of elements breaks triangles, but cells are asked for");
    return m->bond_stiffness == 0.0 ? check_diagonal(solid_material_plate(m), diagonal) : DEM_OK;
}

/* ---- limits ---- */

/* The modulus of the plate in plane stress that moves like the solid, Pa. */
static double plate_modulus(const dem_material *m)
{
    return solid_material_plate(m).modulus / m->thickness;
}

bool solid_material_breaks_by_own_stress(const dem_material *m)
{
    return m->stress_average == DEM_STRESS_AVERAGE_ELEMENT;
}

bool solid_material_softens(const dem_material *m)
{
    return m->fracture_energy > 0.0 && m->strength > 0.0;
}

static const crack_band *band_of(const dem_material *m, bool cells)
{
    if (cells) return crack_band_of(CRACK_BAND_CELLS);
    return crack_band_of(solid_material_breaks_by_own_stress(m) ? CRACK_BAND_OWN_STRESS : CRACK_BAND_CORNERS);
}

/* A limit that is not given is never reached. */
static double limit_or_never(double given)
{
    return given > 0.0 ? given : (double)INFINITY;
}

double solid_material_critical_stretch(const dem_material *m)
{
    return limit_or_never(m->critical_stretch);
}

/* With a strength and a fracture energy triangles soften; with the energy alone the strength follows from the size. */
solid_limits solid_material_limits(const dem_material *m, bool cells, double area)
{
    const crack_band *band = band_of(m, cells);
    const double modulus = plate_modulus(m), energy = m->fracture_energy, size = crack_band_size(area);
    const bool pressed = m->plane == DEM_PLANE_STRAIN && m->compressive_strength > 0.0;
    solid_limits limits = {.strength = limit_or_never(m->strength),
                           .softening = 1.0,
                           .compressive_strength = limit_or_never(m->compressive_strength),
                           .confinement = pressed ? m->compressive_strength / m->strength : 0.0};
    if (solid_material_softens(m))
        limits.softening = crack_band_softening_of(band, modulus * energy / (m->strength * m->strength * size));
    else if (energy > 0.0)
        limits.strength = crack_band_strength(band, modulus, energy, size);
    return limits;
}

dem_status solid_material_check_size(const dem_material *m, bool cells, double size)
{
    const double edge = cells ? sqrt(0.5 * sqrt(3.0)) : 1.0;
    const double coarsest = crack_band_coarsest(band_of(m, cells), plate_modulus(m), m->fracture_energy, m->strength);
    CHECK(size <= coarsest, DEM_ERROR_ARGUMENT,
          "%s of %g m are too large for a strength of %g Pa and a fracture energy of %g J/m^2, which need %g m at "
          "most",
          cells ? "squares" : "triangles with edges", edge * size, m->strength, m->fracture_energy, edge * coarsest);
    return DEM_OK;
}
