/* SPDX-License-Identifier: BSD-3-Clause */
/* A material of a solid as assembling reads it: whether it can be one, what its formulas for plane stress are given,
 * and what its triangles stand. `diagonal` is the stiffness of a cell's diagonal over a side's. */
#ifndef DEM_LATTICE_SOLID_MATERIAL_H
#define DEM_LATTICE_SOLID_MATERIAL_H

#include <stdbool.h>

#include <dem/dem.h>

/** Whether a triangulation can be made of it.
 *  \return DEM_ERROR_ARGUMENT, with what is wrong and its number */
dem_status solid_material_check(const dem_material *m);

/** Whether cells of it are stable: all that a triangulation needs, and a diagonal that is weak enough. */
dem_status solid_material_check_cells(const dem_material *m, double diagonal);

/** Whether triangles soften before they break: strength and fracture energy are both given. */
bool solid_material_softens(const dem_material *m);

/** Of one that softens, whether triangles, or halves of cells, of a size, m, are small enough for that. */
dem_status solid_material_check_size(const dem_material *m, bool cells, double size);

/** The plate in plane stress that moves like the solid: E h, N/m, and nu; 0 where the stiffness of springs is given. */
typedef struct solid_plate {
    double modulus, ratio;
} solid_plate;

solid_plate solid_material_plate(const dem_material *m);

/** (8/3) G h, N/m, which gives the stiffness of springs. */
double solid_material_spring_modulus(const dem_material *m);

/** kappa, N/m, of the area term. */
double solid_material_area_modulus(const dem_material *m, double diagonal);

/** The strain at which its springs break; infinity: never. */
double solid_material_critical_stretch(const dem_material *m);

/** Whether triangles break by their own stress. */
bool solid_material_breaks_by_own_stress(const dem_material *m);

/** What limits a triangle, as the lattice has it. */
typedef struct solid_limits {
    double strength, softening, compressive_strength, confinement;
} solid_limits;

/** Of a triangle, or a half of a cell, of an area, m^2. */
solid_limits solid_material_limits(const dem_material *m, bool cells, double area);

#endif
