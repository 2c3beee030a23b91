/* SPDX-License-Identifier: BSD-3-Clause */
/* Outlines by their signed distance. Square roots only, so that pores lie at the same places on every machine. */
#include "shape.h"

#include <math.h>
#include <stdlib.h>

/* Signed distance to a rectangle or disc about the origin, > 0 outside. */
static double distance(const shape_outline *o, double x, double y)
{
    if (o->disc) return sqrt(x * x + y * y) - o->radius;
    const double dx = fabs(x) - 0.5 * o->size[0], dy = fabs(y) - 0.5 * o->size[1];
    const double ox = fmax(dx, 0.0), oy = fmax(dy, 0.0);
    return sqrt(ox * ox + oy * oy) + fmin(fmax(dx, dy), 0.0);
}

static double void_distance(const shape *s, const double x[2])
{
    double least = (double)INFINITY;
    for (size_t k = 0; k < s->n_voids; k++) {
        const shape_void *v = &s->voids[k];
        least = fmin(least, distance(&v->outline, x[0] - v->centre[0], x[1] - v->centre[1]));
    }
    return least;
}

static double depth(void *context, const double x[2])
{
    return shape_depth(context, x);
}

static int is_kept(void *context, const double x[2])
{
    const shape *s = context;
    return void_distance(s, x) > -1e-9 * s->spacing; /* a node on the rim stays, whatever its rounding */
}

void shape_free(shape *s)
{
    free(s->voids);
    *s = (shape){0};
}

bool shape_add_void(shape *s, const shape_void *v)
{
    shape_void *voids = realloc(s->voids, (s->n_voids + 1) * sizeof *voids);
    if (voids == NULL) return false;
    voids[s->n_voids++] = *v;
    s->voids = voids;
    return true;
}

double shape_outline_depth(const shape *s, const double x[2])
{
    const double middle = s->outline.disc ? 0.0 : 0.5 * s->outline.size[1];
    return -distance(&s->outline, x[0], x[1] - middle);
}

double shape_depth(const shape *s, const double x[2])
{
    return fmin(shape_outline_depth(s, x), void_distance(s, x));
}

bool shape_takes(const shape *s, const shape_void *hole, const dem_lattice *lattice)
{
    shape_void only = *hole;
    shape alone = {.spacing = s->spacing, .n_voids = 1, .voids = &only};
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        if (!is_kept(&alone, lattice->x + 2 * i)) return true;
    return false;
}

dem_status shape_add_pores(shape *s, pores_recipe *recipe, size_t *n_placed, double *radius)
{
    const double half = s->outline.disc ? s->outline.radius : 0.5 * s->outline.size[0];
    const double box[4] = {-half, s->outline.disc ? -half : 0.0, half, s->outline.disc ? half : s->outline.size[1]};
    pore *list = calloc(recipe->number + 1, sizeof *list);
    if (list == NULL) return DEM_ERROR_MEMORY;
    for (int c = 0; c < 4; c++) recipe->box[c] = box[c];
    dem_status status = pores_place(list, n_placed, recipe, depth, s);
    if (status == DEM_ERROR_MODEL) *radius = list[*n_placed].radius;
    for (size_t k = 0; status == DEM_OK && k < recipe->number; k++) {
        const shape_void v = {.outline = {.disc = true, .radius = list[k].radius},
                              .centre = {list[k].centre[0], list[k].centre[1]}};
        if (!shape_add_void(s, &v)) status = DEM_ERROR_MEMORY;
    }
    free(list);
    return status;
}

dem_status shape_mesh(dem_lattice *out, const shape *s)
{
    if (s->outline.disc) return dem_lattice_disc(out, s->outline.radius, s->spacing);
    return dem_lattice_rectangle(out, s->outline.size[0], s->outline.size[1], s->spacing);
}

dem_status shape_cut(dem_lattice *lattice, const shape *s)
{
    shape cut = *s;
    return s->n_voids > 0 ? dem_lattice_cut(lattice, is_kept, &cut) : DEM_OK;
}
