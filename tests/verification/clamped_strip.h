/* SPDX-License-Identifier: BSD-3-Clause */
/* A strip between two sides that are held or pulled, with a crack from its left end along its middle: what is ahead of
 * the crack has the energy G = E e^2 H/(2 (1 - nu^2)) per area of it, e = D/H the strain by which the sides have parted
 * (plane stress; the sides hold the strip along itself). 1e9 Pa, 1000 kg/m^3: waves run at c = 1000 m/s; a = 1 cm. */
#ifndef DEM_TEST_CLAMPED_STRIP_H
#define DEM_TEST_CLAMPED_STRIP_H

#include "support.h"

#define CLAMPED_STRIP_MODULUS 1e9
#define CLAMPED_STRIP_DENSITY 1000.0
#define CLAMPED_STRIP_SPACING 0.01
#define CLAMPED_STRIP_SPEED   1000.0 /* c = sqrt(E/density) */
#define CLAMPED_STRIP_LIMIT   1e-3   /* strength/E, or critical stretch: small enough for what is linear, to 1e-3 */

typedef struct clamped_strip {
    double begin, end, bottom, height; /* m, of the strip */
    double middle;                     /* m, where the crack is */
    dem_index n_sides[2];              /* nodes of the lower and the upper side */
    dem_index *sides[2];               /* owned */
} clamped_strip;

/** Its material, which breaks by stress or by stretch. */
dem_material clamped_strip_material(bool by_stretch, double nu);

/** Of a lattice that is a strip.  Free with clamped_strip_free(). */
clamped_strip clamped_strip_of(const dem_lattice *l);
void clamped_strip_free(clamped_strip *s);

/** (D/H)^2 of a strip in which G is 1 E limit^2 a. */
double clamped_strip_unit(const clamped_strip *s, double nu);

/** The strip starts with its sides parted by `parted`, m, uniformly stretched. */
void clamped_strip_stretch(const clamped_strip *s, dem_lattice *l, double parted);

/** What is nearer than 4 spacings to the sides and to the right end does not break: corners of a strip might. */
void clamped_strip_strengthen(const clamped_strip *s, dem_lattice *l);

/** Prescribes both sides, which part at `speed`, m/s. Borrows the sides.  \param[out] pull  [2] */
void clamped_strip_hold(const clamped_strip *s, double speed, dem_boundary *pull);

/** s, half of the longest step of Verlet's method: for what comes to rest, or moves slowly. */
double clamped_strip_long_step(const dem_lattice *l);

/** The centre of a triangle, m. */
double clamped_strip_centre(const dem_lattice *l, dem_index triangle, int axis);

/** Whether the middle line crosses a triangle. */
bool clamped_strip_crosses(const clamped_strip *s, const dem_lattice *l, dem_index triangle);

/** Breaks the triangles that the middle line crosses between x = from and to.  \return how many they are */
dem_index clamped_strip_cut(const clamped_strip *s, dem_simulation *simulation, const dem_lattice *l, double from,
                            double to);

#endif
