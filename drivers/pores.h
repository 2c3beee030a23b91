/* SPDX-License-Identifier: BSD-3-Clause */
/* Seeded random round pores (GSL random numbers). */
#ifndef DEM_PORES_H
#define DEM_PORES_H

#include <dem/dem.h>

/* More than this many in one recipe are refused: placing takes time of order number^2. */
#define PORES_MAX 10000

typedef struct pore {
    double centre[2], radius; /* m */
} pore;

/* A region that pores may lie in: signed distance of x to its boundary, > 0 inside, m. */
typedef double (*pores_region)(void *context, const double x[2]);

typedef struct pores_recipe {
    double box[4];                 /* x_min, y_min, x_max, y_max: where centres are drawn */
    size_t number;                 /* of pores, <= PORES_MAX */
    double radius_min, radius_max; /* m, uniform between them; 0 < radius_min <= radius_max */
    double wall;                   /* m, least material between pores, and between a pore and the boundary; >= 0 */
    unsigned long seed;
} pores_recipe;

/* Draws radii, places the largest first, each at the first admissible of at most 100,000 random centres. Same recipe,
 * same pores on every machine. Sets no message: that is left to the caller, who knows what the numbers are called.
 * \param[out] out       [recipe->number] by falling radius
 * \param[out] n_placed  pores before the first that finds no place
 * \return DEM_ERROR_MODEL if one finds no place: its radius is out[*n_placed].radius, its centre is not set;
 *         DEM_ERROR_ARGUMENT for a recipe outside the ranges above; DEM_ERROR_MEMORY */
dem_status pores_place(pore *out, size_t *n_placed, const pores_recipe *recipe, pores_region region, void *context);

#endif
