/* SPDX-License-Identifier: BSD-3-Clause */
/* Other strengths for some elements than their materials have. Where strength and fracture energy were given,
 * triangles soften, and it is the energy that stays: a weaker one softens for longer, a stronger one for less, and
 * where it would have to be stronger than one of that energy that softens least, or is brittle, it is that. Of
 * brittle triangles the energy follows from the strength, and those alone have a compressive strength, which keeps
 * its ratio to it. */
#include <dem/dem.h>

#include <math.h>
#include <stdlib.h>

#include "base/status.h"
#include "lattice/cell.h"
#include "lattice/crack_band.h"
#include "lattice/lattice.h"

static dem_status check_factors(const char *what, const double *factor, dem_index n)
{
    for (dem_index k = 0; factor != NULL && k < n; k++)
        CHECK(isfinite(factor[k]) && factor[k] > 0.0, DEM_ERROR_ARGUMENT, "%s %lld: the factor must be > 0: %g", what,
              (long long)k, factor[k]);
    return DEM_OK;
}

static crack_band_kind kind_of(const dem_lattice *l, const unsigned char *half, dem_index t)
{
    if (half[t]) return CRACK_BAND_CELLS;
    return l->own_stress != NULL && l->own_stress[t] ? CRACK_BAND_OWN_STRESS : CRACK_BAND_CORNERS;
}

/* Its toughness is over strength^2 a/E. */
static void weaken_softening(dem_lattice *l, const crack_band *band, dem_index t, double factor, double of_energy)
{
    const double energy = of_energy * crack_band_toughness(band, l->softening[t]), after = energy / (factor * factor);
    l->strength[t] *= after > band->lines[0].toughness ? factor : sqrt(energy / band->lines[0].toughness);
    l->softening[t] = crack_band_softening_of(band, after);
}

static double at(const double *factor, dem_index k)
{
    return factor != NULL ? factor[k] : 1.0;
}

static dem_status weaken_triangles(dem_lattice *l, const double *strength_factor, const double *energy_factor)
{
    unsigned char *half = lattice_zeros(l->n_triangles, 1);
    CHECK_MEMORY(half);
    const dem_status status = l->softening != NULL ? cell_mark(half, l) : DEM_OK;
    for (dem_index t = 0; status == DEM_OK && t < l->n_triangles; t++) {
        if (l->softening != NULL && l->softening[t] > 1.0)
            weaken_softening(l, crack_band_of(kind_of(l, half, t)), t, at(strength_factor, t), at(energy_factor, t));
        else
            l->strength[t] *= at(strength_factor, t);
    }
    free(half);
    return status;
}

dem_status dem_lattice_weaken(dem_lattice *lattice, const double *strength_factor, const double *energy_factor,
                              const double *stretch_factor)
{
    dem_lattice l;
    TRY(lattice_check(lattice));
    TRY(lattice_read(&l, lattice));
    TRY(check_factors("triangle", strength_factor, l.n_triangles));
    TRY(check_factors("triangle", energy_factor, l.n_triangles));
    TRY(check_factors("spring", stretch_factor, l.n_springs));
    if (l.strength != NULL) TRY(weaken_triangles(&l, strength_factor, energy_factor));
    for (dem_index t = 0; t < l.n_triangles && l.compressive_strength != NULL; t++)
        l.compressive_strength[t] *= at(strength_factor, t);
    for (dem_index k = 0; k < l.n_springs && l.critical_stretch != NULL; k++)
        l.critical_stretch[k] *= at(stretch_factor, k);
    return DEM_OK;
}
