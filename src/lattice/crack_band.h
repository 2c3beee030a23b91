/* SPDX-License-Identifier: BSD-3-Clause */
/* What a triangle must have so that a crack through a lattice of its like takes a given energy for its area
 * (docs/fracture.md, Strength and toughness). The size of a triangle is the edge a of the equilateral one of its area,
 * and E the modulus of the plate in plane stress that the body is. */
#ifndef DEM_LATTICE_CRACK_BAND_H
#define DEM_LATTICE_CRACK_BAND_H

/** From a softening q = dem_lattice.softening on, up to that of the next line: G E/(strength^2 a) there, and how much
 *  more it is for each 1 more of q. */
typedef struct crack_band_line {
    double softening, toughness, slope;
} crack_band_line;

/** G E/(strength^2 a) of triangles that soften. The first line has the least. */
typedef struct crack_band {
    int n;
    crack_band_line lines[4];
} crack_band;

/** Of triangles that the mean of their corners' stresses breaks, which may be brittle, of those that their own stress
 *  breaks, and of halves of cells, by the former. */
typedef enum crack_band_kind { CRACK_BAND_CORNERS, CRACK_BAND_OWN_STRESS, CRACK_BAND_CELLS } crack_band_kind;

const crack_band *crack_band_of(crack_band_kind kind);

/** a, m, of a triangle of an area, m^2. */
double crack_band_size(double area);

/** Strength, Pa, of a brittle triangle of size a, m, with which the fracture energy of the lattice, J/m^2, is as
 *  given. */
double crack_band_strength(const crack_band *band, double modulus, double fracture_energy, double size);

/** The largest size, m, of triangles that have this strength, Pa, and this fracture energy, J/m^2. */
double crack_band_coarsest(const crack_band *band, double modulus, double fracture_energy, double strength);

/** G E/(strength^2 a) of triangles with this softening, and the other way round: the least one where that takes more
 *  than is given. */
double crack_band_toughness(const crack_band *band, double softening);
double crack_band_softening_of(const crack_band *band, double toughness);

#endif
