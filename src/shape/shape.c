/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"

static const double rounding = 1e-9; /* of the spacing */

static const double sqrt3_2 = 0.86602540378443864676; /* height of a row of triangles, in spacings */

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

/* Whether its lattice is made to its size: a rectangle's is rounded to whole spacings. */
static bool is_fitted(const shape *s)
{
    if (is_mask(s) || s->outline.kind == DEM_OUTLINE_RING || s->outline.kind == DEM_OUTLINE_POLYGON) return false;
    return s->outline.kind == DEM_OUTLINE_RECTANGLE || !s->squares;
}

static bool is_kept(const shape *s, const double *x)
{
    return (is_fitted(s) || shape_outline_has(s, x)) && void_distance(s, x) > -shape_slack(s);
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

double shape_slack(const shape *s)
{
    return rounding * s->spacing;
}

bool shape_outline_has(const shape *s, const double x[2])
{
    const double slack = shape_slack(s);
    return is_mask(s) ? mask_has(&s->mask, x, slack) : outline_distance(&s->outline, x[0], x[1]) <= slack;
}

const outline *shape_edge_at(const shape *s, size_t edge)
{
    return edge == 0 ? &s->outline : &s->voids[edge - 1];
}

size_t shape_edge(const shape *s, const double x[2])
{
    double least = (double)INFINITY;
    size_t nearest = 0;
    for (size_t k = 0; k <= s->n_voids; k++) {
        const double distance = fabs(outline_distance(shape_edge_at(s, k), x[0], x[1]));
        if (distance >= least) continue;
        least = distance;
        nearest = k;
    }
    return nearest;
}

double shape_distance(const shape *s, const double x[2])
{
    return fmax(outline_distance(&s->outline, x[0], x[1]), -void_distance(s, x));
}

bool shape_fits(const shape *s, const double x[2], double radius)
{
    const bool inside =
        is_mask(s) ? mask_fits(&s->mask, x, radius) : -outline_distance(&s->outline, x[0], x[1]) >= radius;
    return inside && void_distance(s, x) >= radius;
}

bool shape_has_void(const shape *s, const outline *hole)
{
    return shape_outline_has(s, shape_void_point(hole));
}

const double *shape_void_point(const outline *hole)
{
    return hole->kind == DEM_OUTLINE_POLYGON ? hole->points : hole->centre;
}

bool shape_takes(const shape *s, const outline *hole, const dem_lattice *lattice, const bool *node)
{
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        if ((node == NULL || node[i]) &&
            outline_distance(hole, lattice->x[2 * i], lattice->x[2 * i + 1]) <= -shape_slack(s))
            return true;
    return false;
}

/* ---- grid ---- */

static dem_status find_rows(shape_grid *out, const shape *s, const double size[2], const double foot[2])
{
    *out = (shape_grid){.foot = {foot[0], foot[1]}};
    return s->squares ? grid_of_squares(&out->rows, size[0], size[1], s->spacing)
                      : grid_of_rectangle(&out->rows, size[0], size[1], s->spacing);
}

/* A grid that stands on the outline's lowest point and covers it, symmetric about the middle of its box. */
static dem_status cover(shape_grid *out, const shape *s)
{
    double box[4];
    outline_box(&s->outline, box);
    const double size[2] = {box[2] - box[0] + 2.0 * s->spacing, box[3] - box[1] + s->spacing};
    return find_rows(out, s, size, (double[2]){0.5 * (box[0] + box[2]), box[1]});
}

/* Triangles with a node in the centre: those of dem_lattice_disc(). */
static dem_status find_disc(shape_grid *out, const shape *s, double radius)
{
    const double *centre = s->outline.centre;
    *out = (shape_grid){.reach = radius + rounding * s->spacing, .foot = {centre[0], centre[1]}};
    return grid_around_disc(&out->rows, out->reach, s->spacing);
}

static dem_status cover_disc(shape_grid *out, const shape *s)
{
    const double reach = s->spacing * (floor(s->outline.radius / s->spacing + rounding) + 1.0);
    const double *centre = s->outline.centre;
    if (!s->squares) return find_disc(out, s, s->outline.radius);
    return find_rows(out, s, (double[2]){2.0 * reach, 2.0 * reach}, (double[2]){centre[0], centre[1] - reach});
}

/* With two spacings, or rows, about it; what is not smooth has a node, or a row, in the same place. */
static dem_status cover_widely(shape_grid *out, const shape *s)
{
    const double below = 2.0 * sqrt3_2 * s->spacing, around = 2.0 * s->spacing;
    double box[4];
    if (s->outline.kind == DEM_OUTLINE_DISC || s->outline.kind == DEM_OUTLINE_RING)
        return find_disc(out, s, s->outline.radius + around);
    outline_box(&s->outline, box);
    const double size[2] = {box[2] - box[0] + 2.0 * around, box[3] - box[1] + 2.5 * below};
    return find_rows(out, s, size, (double[2]){0.5 * (box[0] + box[2]), box[1] - below});
}

dem_status shape_find_grid(shape_grid *out, const shape *s)
{
    const outline *o = &s->outline;
    if (s->smooth) return cover_widely(out, s);
    if (o->kind == DEM_OUTLINE_DISC || o->kind == DEM_OUTLINE_RING) return cover_disc(out, s);
    return is_fitted(s) ? find_rows(out, s, o->size, (double[2]){o->centre[0], o->centre[1] - 0.5 * o->size[1]})
                        : cover(out, s);
}

/* ---- lattice ---- */

dem_status shape_place_rows(dem_lattice *rows, const shape_grid *g)
{
    double reach = g->reach;
    if (reach > 0.0) TRY(dem_lattice_cut(rows, grid_disc_has, &reach));
    dem_lattice_move(rows, 0.0, g->foot);
    return DEM_OK;
}

dem_status shape_mesh(dem_lattice *out, const shape *s)
{
    shape_grid g;
    dem_lattice lattice;
    TRY(shape_find_grid(&g, s));
    TRY(grid_lattice(&lattice, &g.rows));
    const dem_status status = shape_place_rows(&lattice, &g);
    if (status == DEM_OK)
        *out = lattice;
    else
        dem_lattice_free(&lattice);
    return status;
}

void shape_keep_cells(bool *keep, dem_index n_triangles)
{
    for (dem_index t = 0; t + 1 < n_triangles; t += 2) keep[t] = keep[t + 1] = keep[t] != 0 && keep[t + 1] != 0;
}

void shape_mark(bool *keep, bool *node, const shape *s, const dem_lattice *lattice)
{
    for (dem_index i = 0; i < lattice->n_nodes; i++) node[i] = node[i] && is_kept(s, lattice->x + 2 * i);
    for (dem_index t = 0; t < lattice->n_triangles; t++) {
        const dem_index *corner = lattice->triangles + 3 * t;
        keep[t] = node[corner[0]] && node[corner[1]] && node[corner[2]];
    }
    if (s->squares) shape_keep_cells(keep, lattice->n_triangles);
}

static dem_status cut(dem_lattice *lattice, const shape *s)
{
    bool *node = malloc((size_t)lattice->n_nodes * sizeof *node),
         *keep = malloc((size_t)lattice->n_triangles * sizeof *keep);
    dem_status status = node != NULL && keep != NULL ? DEM_OK : DEM_ERROR_MEMORY;
    if (status == DEM_OK) {
        memset(node, true, (size_t)lattice->n_nodes * sizeof *node);
        shape_mark(keep, node, s, lattice);
        status = dem_lattice_trim(lattice, keep);
    }
    free(node);
    free(keep);
    return status;
}

dem_status shape_cut(dem_lattice *lattice, const shape *s)
{
    return is_fitted(s) && s->n_voids == 0 ? DEM_OK : cut(lattice, s);
}
