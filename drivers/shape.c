/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape.h"

#include <math.h>
#include <stdlib.h>

static const double rounding = 1e-9; /* of the spacing: a node on an edge stays, whatever its rounding */

static bool is_mask(const shape *s)
{
    return s->mask.solid != NULL;
}

static double void_distance(const shape *s, const double x[2])
{
    double least = (double)INFINITY;
    for (size_t k = 0; k < s->n_voids; k++) least = fmin(least, outline_distance(&s->voids[k], x[0], x[1]));
    return least;
}

static bool fits(void *context, const double x[2], double radius)
{
    return shape_fits(context, x, radius);
}

/* Whether its lattice is made to its size: a rectangle's is rounded to whole spacings. */
static bool is_fitted(const shape *s)
{
    return !is_mask(s) && (s->outline.kind == OUTLINE_RECTANGLE || s->outline.kind == OUTLINE_DISC);
}

static int is_kept(void *context, const double x[2])
{
    const shape *s = context;
    return (is_fitted(s) || shape_outline_has(s, x)) && void_distance(s, x) > -rounding * s->spacing;
}

void shape_free(shape *s)
{
    for (size_t k = 0; k < s->n_voids; k++) outline_free(&s->voids[k]);
    free(s->voids);
    outline_free(&s->outline);
    mask_free(&s->mask);
    *s = (shape){0};
}

bool shape_add_void(shape *s, outline *hole)
{
    outline *voids = realloc(s->voids, (s->n_voids + 1) * sizeof *voids);
    if (voids == NULL) {
        outline_free(hole);
        return false;
    }
    voids[s->n_voids++] = *hole;
    s->voids = voids;
    return true;
}

bool shape_outline_has(const shape *s, const double x[2])
{
    const double slack = rounding * s->spacing;
    return is_mask(s) ? mask_has(&s->mask, x, slack) : outline_distance(&s->outline, x[0], x[1]) <= slack;
}

bool shape_fits(const shape *s, const double x[2], double radius)
{
    const bool inside =
        is_mask(s) ? mask_fits(&s->mask, x, radius) : -outline_distance(&s->outline, x[0], x[1]) >= radius;
    return inside && void_distance(s, x) >= radius;
}

bool shape_takes(const shape *s, const outline *hole, const dem_lattice *lattice)
{
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        if (outline_distance(hole, lattice->x[2 * i], lattice->x[2 * i + 1]) <= -rounding * s->spacing) return true;
    return false;
}

pores_status shape_add_pores(shape *s, pores *out, pores_recipe *recipe)
{
    outline_box(&s->outline, recipe->box);
    const pores_status status = pores_place(out, recipe, fits, s);
    for (size_t k = 0; status == PORES_PLACED && k < out->n; k++) {
        const pore *p = &out->list[k];
        outline hole = {.kind = OUTLINE_DISC, .centre = {p->centre[0], p->centre[1]}, .radius = p->radius};
        if (!shape_add_void(s, &hole)) return PORES_MEMORY;
    }
    return status;
}

/* ---- lattice ---- */

/* A grid that stands on the outline's lowest point and covers it, symmetric about the middle of its box. */
static dem_status cover(dem_lattice *out, const shape *s)
{
    double box[4];
    outline_box(&s->outline, box);
    const double width = box[2] - box[0] + 2.0 * s->spacing, height = box[3] - box[1] + s->spacing;
    const double foot[2] = {0.5 * (box[0] + box[2]), box[1]};
    const dem_status status = dem_lattice_rectangle(out, width, height, s->spacing);
    if (status == DEM_OK) dem_lattice_move(out, 0.0, foot);
    return status;
}

dem_status shape_mesh(dem_lattice *out, const shape *s)
{
    const outline *o = &s->outline;
    if (o->kind == OUTLINE_DISC || o->kind == OUTLINE_RING) return dem_lattice_disc(out, o->radius, s->spacing);
    return is_fitted(s) ? dem_lattice_rectangle(out, o->size[0], o->size[1], s->spacing) : cover(out, s);
}

dem_status shape_cut(dem_lattice *lattice, const shape *s)
{
    shape cut = *s;
    return is_fitted(s) && s->n_voids == 0 ? DEM_OK : dem_lattice_cut(lattice, is_kept, &cut);
}
