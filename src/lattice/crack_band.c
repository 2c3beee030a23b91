/* SPDX-License-Identifier: BSD-3-Clause */
/* The energy G that a crack takes for its area is a number of the lattice. It was measured, in strips whose sides are
 * parted (test_strip.c and test_crack_band.c in tests/verification), as
 *     G E/(strength^2 a) = 3.4               of brittle triangles,
 *                          2.0 + 1.07 q      where they soften, from q = 2 to 6,
 *                          8.42 + 1.29 (q - 6) beyond,
 * and in between the first two a straight line joins them; where their own stress lets triangles soften it is
 * 0.2 + 0.48 q in irregular meshes, used from q = 3 on. Of cells it depends on the direction of their sides and on
 * Poisson's ratio, by 12 % on both sides of lines through 3.3, 3.8, 4.8, 8.4 and 16.8 at q = 1, 2, 3, 6 and 12. */
#include "lattice/crack_band.h"

#include <math.h>

static const crack_band bands[] = {
    [CRACK_BAND_CORNERS] = {3, {{1.0, 3.4, 0.74}, {2.0, 4.14, 1.07}, {6.0, 8.42, 1.29}}},
    [CRACK_BAND_OWN_STRESS] = {1, {{3.0, 1.64, 0.48}}},
    [CRACK_BAND_CELLS] = {4, {{1.0, 3.3, 0.5}, {2.0, 3.8, 1.0}, {3.0, 4.8, 1.2}, {6.0, 8.4, 1.4}}},
};

const crack_band *crack_band_of(crack_band_kind kind)
{
    return &bands[kind];
}

double crack_band_size(double area)
{
    return sqrt(4.0 * area / sqrt(3.0));
}

double crack_band_strength(const crack_band *band, double modulus, double fracture_energy, double size)
{
    return sqrt(modulus * fracture_energy / (band->lines[0].toughness * size));
}

double crack_band_coarsest(const crack_band *band, double modulus, double fracture_energy, double strength)
{
    return modulus * fracture_energy / (strength * strength) / band->lines[0].toughness;
}

double crack_band_toughness(const crack_band *band, double softening)
{
    const crack_band_line *of = &band->lines[0];
    for (int k = 1; k < band->n && softening >= band->lines[k].softening; k++) of = &band->lines[k];
    return of->toughness + of->slope * (softening - of->softening);
}

double crack_band_softening_of(const crack_band *band, double toughness)
{
    const crack_band_line *of = &band->lines[0];
    for (int k = 1; k < band->n && toughness >= band->lines[k].toughness; k++) of = &band->lines[k];
    return fmax(of->softening + (toughness - of->toughness) / of->slope, band->lines[0].softening);
}
