/* SPDX-License-Identifier: BSD-3-Clause */
/* The fracture energy of a triangle follows from its strength, softening and size, as these follow from it where it is
 * given (lattice/crack_band.h). Young's modulus E of the plate is in what lattices have: with the springs' (4/3) E/(1 +
 * nu) and the area term's kappa/h = E (3 nu - 1)/(2 (1 - nu^2)), of squares that are isotropic too, the ratio of both
 * is 3 (3 nu - 1)/(8 (1 - nu)). */
#include "model/crack_energy.h"

#include <math.h>
#include <stdlib.h>

#include "base/exact_sum.h"
#include "base/status.h"
#include "base/vec2.h"
#include "lattice/cell.h"
#include "lattice/crack_band.h"
#include "lattice/lattice.h"

static double area_of(const dem_lattice *l, dem_index t)
{
    return vec2_area_of(l->x, &l->triangles[3 * t]);
}

double crack_length(const dem_lattice *lattice, dem_index triangle)
{
    return sqrt(area_of(lattice, triangle) / sqrt(3.0));
}

static double thickness_of(const dem_lattice *l, dem_index t)
{
    return l->thickness != NULL ? l->thickness[t] : 1.0;
}

static double plate_modulus(const dem_lattice *l, dem_index t)
{
    const double kappa = l->area_stiffness != NULL ? l->area_stiffness[t] : 0.0;
    const double ratio = 8.0 * kappa / (thickness_of(l, t) * l->modulus[t]), nu = (3.0 + ratio) / (9.0 + ratio);
    return 0.75 * (1.0 + nu) * l->modulus[t];
}

static bool has_energy(const dem_lattice *l, dem_index t)
{
    return l->strength != NULL && isfinite(l->strength[t]) && l->modulus != NULL && l->modulus[t] > 0.0;
}

/* J/m^2; `cell`: it is half of a square. */
static double fracture_energy(const dem_lattice *l, dem_index t, bool cell)
{
    const crack_band_kind whole =
        l->own_stress != NULL && l->own_stress[t] ? CRACK_BAND_OWN_STRESS : CRACK_BAND_CORNERS;
    const double softening = l->softening != NULL ? l->softening[t] : 1.0, strength = l->strength[t];
    const double toughness = crack_band_toughness(crack_band_of(cell ? CRACK_BAND_CELLS : whole), softening);
    return toughness * strength * strength * crack_band_size(area_of(l, t)) / plate_modulus(l, t);
}

static double sum(const dem_lattice *l, const element_state *elements, const unsigned char *half)
{
    exact_sum energy = {0};
    for (dem_index t = 0; t < l->n_triangles; t++) {
        if (!elements->triangle[t]) continue;
        if (!has_energy(l, t)) return 0.0;
        exact_sum_add(&energy, fracture_energy(l, t, half[t]) * crack_length(l, t) * thickness_of(l, t));
    }
    return exact_sum_value(&energy);
}

dem_status crack_energy(const dem_lattice *lattice, const element_state *elements, double *energy)
{
    *energy = 0.0;
    if (elements == NULL || lattice->strength == NULL) return DEM_OK;
    unsigned char *half = lattice_zeros(lattice->n_triangles, 1);
    CHECK_MEMORY(half);
    const dem_status status = cell_mark(half, lattice);
    if (status == DEM_OK) *energy = sum(lattice, elements, half);
    free(half);
    return status;
}
