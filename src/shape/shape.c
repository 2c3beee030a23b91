/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/shape.h"

#include <math.h>
#include <stdlib.h>

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

static bool is_kept(void *context, const double *x)
{
    const shape *s = context;
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

bool shape_takes(const shape *s, const outline *hole, const dem_lattice *lattice)
{
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        if (outline_distance(hole, lattice->x[2 * i], lattice->x[2 * i + 1]) <= -shape_slack(s)) return true;
    return false;
}

/* ---- lattice ---- */

static dem_status make_grid(dem_lattice *out, const shape *s, const double size[2], const double foot[2])
{
    const dem_status status = s->squares ? dem_lattice_squares(out, size[0], size[1], s->spacing)
                                         : dem_lattice_rectangle(out, size[0], size[1], s->spacing);
    if (status == DEM_OK) dem_lattice_move(out, 0.0, foot);
    return status;
}

/* A grid that stands on the outline's lowest point and covers it, symmetric about the middle of its box. */
static dem_status cover(dem_lattice *out, const shape *s)
{
    double box[4];
    outline_box(&s->outline, box);
    const double size[2] = {box[2] - box[0] + 2.0 * s->spacing, box[3] - box[1] + s->spacing};
    return make_grid(out, s, size, (double[2]){0.5 * (box[0] + box[2]), box[1]});
}

/* Triangles with a node in the centre. */
static dem_status make_disc(dem_lattice *out, const shape *s, double radius)
{
    const double *centre = s->outline.centre;
    const dem_status status = dem_lattice_disc(out, radius, s->spacing);
    if (status == DEM_OK && (centre[0] != 0.0 || centre[1] != 0.0)) dem_lattice_move(out, 0.0, centre);
    return status;
}

static dem_status cover_disc(dem_lattice *out, const shape *s)
{
    const double reach = s->spacing * (floor(s->outline.radius / s->spacing + rounding) + 1.0);
    const double *centre = s->outline.centre;
    if (!s->squares) return make_disc(out, s, s->outline.radius);
    return make_grid(out, s, (double[2]){2.0 * reach, 2.0 * reach}, (double[2]){centre[0], centre[1] - reach});
}

/* With two spacings, or rows, about it; what is not smooth has a node, or a row, in the same place. */
static dem_status cover_widely(dem_lattice *out, const shape *s)
{
    const double below = 2.0 * sqrt3_2 * s->spacing, around = 2.0 * s->spacing;
    double box[4];
    if (s->outline.kind == DEM_OUTLINE_DISC || s->outline.kind == DEM_OUTLINE_RING)
        return make_disc(out, s, s->outline.radius + around);
    outline_box(&s->outline, box);
    const double size[2] = {box[2] - box[0] + 2.0 * around, box[3] - box[1] + 2.5 * below};
    return make_grid(out, s, size, (double[2]){0.5 * (box[0] + box[2]), box[1] - below});
}

dem_status shape_mesh(dem_lattice *out, const shape *s)
{
    const outline *o = &s->outline;
    if (s->smooth) return cover_widely(out, s);
    if (o->kind == DEM_OUTLINE_DISC || o->kind == DEM_OUTLINE_RING) return cover_disc(out, s);
    return is_fitted(s) ? make_grid(out, s, o->size, (double[2]){o->centre[0], o->centre[1] - 0.5 * o->size[1]})
                        : cover(out, s);
}

void shape_keep_cells(bool *keep, dem_index n_triangles)
{
    for (dem_index t = 0; t + 1 < n_triangles; t += 2) keep[t] = keep[t + 1] = keep[t] != 0 && keep[t + 1] != 0;
}

static dem_status cut_cells(dem_lattice *lattice, const shape *s)
{
    const dem_index n = lattice->n_triangles;
    bool *node = malloc((size_t)lattice->n_nodes), *keep = malloc((size_t)n);
    dem_status status = node != NULL && keep != NULL ? DEM_OK : DEM_ERROR_MEMORY;
    shape cut = *s;
    for (dem_index i = 0; status == DEM_OK && i < lattice->n_nodes; i++)
        node[i] = is_kept(&cut, lattice->x + 2 * i) != 0;
    for (dem_index t = 0; status == DEM_OK && t < n; t++) {
        const dem_index *corner = lattice->triangles + 3 * t;
        keep[t] = node[corner[0]] && node[corner[1]] && node[corner[2]];
    }
    if (status == DEM_OK) {
        shape_keep_cells(keep, n);
        status = dem_lattice_trim(lattice, keep);
    }
    free(node);
    free(keep);
    return status;
}

dem_status shape_cut(dem_lattice *lattice, const shape *s)
{
    shape cut = *s;
    if (s->squares) return cut_cells(lattice, s);
    return is_fitted(s) && s->n_voids == 0 ? DEM_OK : dem_lattice_cut(lattice, is_kept, &cut);
}
