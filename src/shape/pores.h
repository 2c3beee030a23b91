/* SPDX-License-Identifier: BSD-3-Clause */
/* Seeded random round pores. */
#ifndef DEM_SHAPE_PORES_H
#define DEM_SHAPE_PORES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <dem/shape.h>

typedef struct pore {
    double centre[2], radius; /* m */
} pore;

/* A region that pores may lie in: whether a disc about x is all inside. */
typedef bool (*pores_region)(void *context, const double x[2], double radius);

typedef struct pores_recipe {
    double box[4];                 /* x_min, y_min, x_max, y_max: where centres are drawn */
    size_t number;                 /* of pores, <= DEM_PORES_MAX; 0: as many as the area needs */
    double area;                   /* m^2, that all pores shall have, where number is 0; they miss it by at most half
                                        of the last one's; >= 0 */
    double radius_min, radius_max; /* m, 0 < radius_min <= radius_max: none is drawn beyond */
    dem_pore_radii distribution;
    double mean, deviation; /* m, > 0, of all numbers drawn, those beyond included; not of a uniform one, which
                                        goes from radius_min to radius_max */
    double wall;            /* m, least material between pores, and between a pore and the boundary; >= 0 */
    uint64_t seed;
} pores_recipe;

typedef struct pores {
    size_t n, n_placed; /* wanted, and how many of them have a place */
    pore *list;         /* [n] by falling radius; malloc'ed */
} pores;

typedef enum pores_status {
    PORES_PLACED,
    PORES_CROWDED,  /* list[n_placed] finds no place: its radius is set, its centre is not */
    PORES_TOO_MANY, /* the area needs more than DEM_PORES_MAX */
    PORES_RARE,     /* none of 100,000 radii drawn lies between the smallest and the largest */
    PORES_UNSOUND,  /* a recipe outside the ranges above */
    PORES_MEMORY
} pores_status;

/* Draws radii, places the largest first, each at the first admissible of at most 100,000 random centres. Same recipe,
 * same pores on every machine. The list is empty, and not to be freed, unless PORES_PLACED or PORES_CROWDED is
 * returned. */
pores_status pores_place(pores *out, const pores_recipe *recipe, pores_region fits, void *context);

#endif
