/* SPDX-License-Identifier: BSD-3-Clause */
/* The energy G that a crack takes for its area is a number of the lattice. It was measured, in strips whose sides are
 * parted (test_strip.c and test_crack_band.c in tests/verification), as
 *     G E/(strength^2 a) = 3.4               of brittle triangles,
 *                          2.0 + 1.07 q      where they soften, from q = 2 to 6,
 *                          8.42 + 1.29 (q - 6) beyond,
 * and in between the first two a straight line joins them. */
#include "lattice/crack_band.h"

#include <math.h>

static const double brittle = 3.4;

/* A line for each softening from 1 on, up to that of the next one. */
typedef struct line {
    double softening, toughness, slope;
} line;

static const line lines[] = {{1.0, 3.4, 0.74}, {2.0, 4.14, 1.07}, {6.0, 8.42, 1.29}};
enum { LINES = sizeof lines / sizeof *lines };

double crack_band_size(double area)
{
    return sqrt(4.0 * area / sqrt(3.0));
}

double crack_band_strength(double modulus, double fracture_energy, double size)
{
    return sqrt(modulus * fracture_energy / (brittle * size));
}

double crack_band_coarsest(double modulus, double fracture_energy, double strength)
{
    return modulus * fracture_energy / (strength * strength) / brittle;
}

double crack_band_toughness(double softening)
{
    const line *of = &lines[0];
    for (int k = 1; k < LINES && softening >= lines[k].softening; k++) of = &lines[k];
    return of->toughness + of->slope * (softening - of->softening);
}

double crack_band_softening_of(double toughness)
{
    const line *of = &lines[0];
    for (int k = 1; k < LINES && toughness >= lines[k].toughness; k++) of = &lines[k];
    return fmax(of->softening + (toughness - of->toughness) / of->slope, 1.0);
}

double crack_band_softening(double modulus, double fracture_energy, double strength, double size)
{
    return crack_band_softening_of(modulus * fracture_energy / (strength * strength * size));
}
