/* SPDX-License-Identifier: BSD-3-Clause */
/* What a triangle must have so that a crack through a lattice of its like takes a given energy for its area
 * (docs/fracture.md, Strength and toughness). The size of a triangle is the edge a of the equilateral one of its area,
 * and E the modulus of the plate in plane stress that the body is. */
#ifndef DEM_LATTICE_CRACK_BAND_H
#define DEM_LATTICE_CRACK_BAND_H

/** a, m, of a triangle of an area, m^2. */
double crack_band_size(double area);

/** Strength, Pa, of a brittle triangle of size a, m, with which the fracture energy of the lattice, J/m^2, is as
 *  given. */
double crack_band_strength(double modulus, double fracture_energy, double size);

/** The largest size, m, of triangles that have this strength, Pa, and this fracture energy, J/m^2. */
double crack_band_coarsest(double modulus, double fracture_energy, double strength);

/** G E/(strength^2 a) of triangles with this dem_lattice.softening, and the other way round; 1 where brittle ones take
 *  more. */
double crack_band_toughness(double softening);
double crack_band_softening_of(double toughness);

/** dem_lattice.softening of a triangle of size a, m; 1 where it is too large. */
double crack_band_softening(double modulus, double fracture_energy, double strength, double size);

#endif
