/* SPDX-License-Identifier: BSD-3-Clause */
/* A frame of a film as it is drawn: where the nodes are, and the number that gives each its colour. */
#ifndef DEM_SCENE_H
#define DEM_SCENE_H

#include <stdint.h>

#include <dem/film.h>

#include "box.h"
#include "outcome.h"
#include "quantity.h"
#include "span.h"

typedef struct scene {
    const dem_film *film;
    const quantity *shown;
    const dem_lattice *lattice;
    size_t n_values;
    double *x;              /* [n_nodes][2] m */
    double *value;          /* [n_values] of springs or nodes */
    double *work;           /* [n_values] */
    double *broken;         /* [n_springs] not 0 where a spring is no more; NULL: never */
    unsigned char *is_bare; /* [n_nodes] 1: no spring holds the node, which is drawn as a point */
    dem_index frame;
    double t;         /* s */
    box bounds;       /* of the nodes, m */
    span_reach reach; /* of the values */
} scene;

/** Without a frame yet; borrows film and quantity. False after a fault, which is told. To be freed in any case. */
bool scene_create(scene *s, const dem_film *film, const quantity *shown, outcome *o);
void scene_free(scene *s);

/** False after a fault, which is told. */
bool scene_load(scene *s, dem_index frame, outcome *o);

/** The mean length of a spring of the lattice at rest, m; 0 without springs. */
double scene_spacing(const scene *s);

/** The hash of its frame, time, places and values, after `hash`. */
uint64_t scene_hash(const scene *s, uint64_t hash);

/** The number that colours a spring, or a triangle: its own, or the mean of its nodes'. 0 without a quantity. */
double scene_spring_value(const scene *s, dem_index spring);
double scene_triangle_value(const scene *s, dem_index triangle);

#endif
