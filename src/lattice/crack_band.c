/* SPDX-License-Identifier: BSD-3-Clause */
/* The energy G that a crack takes for its area is a number of the lattice. It was measured, in strips whose sides are
 * parted (test_strip.c and test_crack_band.c in tests/verification), as
 *     G E/(strength^2 a) = 3.4               of brittle triangles,
 *                          2.0 + 1.07 q      where they soften, from q = 2 on,
 * and in between a straight line joins the two. */
#include "lattice/crack_band.h"

#include <math.h>

static const double brittle = 3.4, offset = 2.0, slope = 1.07, joint = 2.0;

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
    const double at_joint = offset + slope * joint;
    if (softening >= joint) return offset + slope * softening;
    return brittle + (softening - 1.0) * (at_joint - brittle) / (joint - 1.0);
}

double crack_band_softening_of(double toughness)
{
    const double at_joint = offset + slope * joint;
    if (toughness >= at_joint) return (toughness - offset) / slope;
    return fmax(1.0 + (joint - 1.0) * (toughness - brittle) / (at_joint - brittle), 1.0);
}

double crack_band_softening(double modulus, double fracture_energy, double strength, double size)
{
    return crack_band_softening_of(modulus * fracture_energy / (strength * strength * size));
}
