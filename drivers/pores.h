/* SPDX-License-Identifier: BSD-3-Clause */
/* Seeded random round pores (GSL random numbers). */
#ifndef DEM_PORES_H
#define DEM_PORES_H

#include <dem/dem.h>

typedef struct pore {
    double centre[2], radius; /* m */
} pore;

/* A region that pores may lie in: signed distance of x to its boundary, > 0 inside, m. */
typedef double (*pores_region)(void *context, const double x[2]);

typedef struct pores_recipe {
    double box[4];               /* x_min, y_min, x_max, y_max: where centres are drawn */
    size_t number;               /* of pores */
    double radius_min, radius_max; /* m, uniform between them */
    double wall;                 /* m, least material between pores, and between a pore and the boundary */
    unsigned long seed;
} pores_recipe;

/* Draws radii, places the largest first, each at the first admissible of at most 100,000 random centres. Same recipe, same
 * pores on every machine. DEM_ERROR_ARGUMENT when one finds no place, with number and radius in the message.
 * \param[out] out  [recipe->number] */
dem_status pores_place(pore *out, const pores_recipe *recipe, pores_region region, void *context);

#endif
