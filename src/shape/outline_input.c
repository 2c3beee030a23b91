/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/outline_input.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "base/struct_size.h"
#include "lattice/lattice.h"

static const struct_kind kind = {"dem_outline", STRUCT_SIZE_WITH(dem_outline, points), sizeof(dem_outline)};

static bool is_finite(const double x[2])
{
    return isfinite(x[0]) && isfinite(x[1]);
}

/* ---- checks ---- */

/* Squares of lengths must be numbers that can be computed with. */
static bool is_apart(const double *a, const double *b)
{
    const double x = b[0] - a[0], y = b[1] - a[1];
    return isnormal(x * x + y * y);
}

dem_status dem_points_check(const double *points, dem_index n)
{
    CHECK(points != NULL && n >= 1, DEM_ERROR_ARGUMENT, "no points");
    CHECK(is_finite(points), DEM_ERROR_ARGUMENT, "point 1, (%g, %g) m, is not finite", points[0], points[1]);
    for (dem_index k = 1; k < n; k++) {
        const double *a = points + 2 * k - 2, *b = points + 2 * k;
        CHECK(is_apart(a, b), DEM_ERROR_ARGUMENT,
              "from point %lld, (%g, %g) m, to the next, (%g, %g) m, is no length to compute with", (long long)k, a[0],
              a[1], b[0], b[1]);
    }
    return DEM_OK;
}

/* Without a last point that is the first once more. */
static dem_index count_points(const dem_outline *o)
{
    const dem_index n = o->n_points;
    const bool closed = n > 1 && memcmp(o->points, o->points + 2 * n - 2, 2 * sizeof *o->points) == 0;
    return closed ? n - 1 : n;
}

static dem_status check_polygon(const dem_outline *o)
{
    CHECK(o->points != NULL, DEM_ERROR_ARGUMENT, "the points of a polygon are NULL");
    CHECK(o->n_points >= 1 && o->n_points <= DEM_OUTLINE_MAX_POINTS + 1, DEM_ERROR_ARGUMENT,
          "a polygon must have at most %d points, got %lld", DEM_OUTLINE_MAX_POINTS, (long long)o->n_points);
    const dem_index n = count_points(o);
    CHECK(n >= 3, DEM_ERROR_ARGUMENT, "a polygon must have at least 3 points, got %lld", (long long)n);
    return dem_points_check(o->points, n);
}

static dem_status check_figure(const dem_outline *o)
{
    CHECK(is_finite(o->centre) && isfinite(o->angle), DEM_ERROR_ARGUMENT,
          "centre, (%g, %g) m, and angle, %g, must be finite", o->centre[0], o->centre[1], o->angle);
    switch (o->kind) {
    case DEM_OUTLINE_RECTANGLE:
        CHECK(lattice_is_positive(o->size[0]) && lattice_is_positive(o->size[1]), DEM_ERROR_ARGUMENT,
              "the size of a rectangle must be > 0, got %g m x %g m", o->size[0], o->size[1]);
        return DEM_OK;
    case DEM_OUTLINE_RING:
        CHECK(o->inner_radius > 0.0 && o->inner_radius < o->radius, DEM_ERROR_ARGUMENT,
              "the inner radius of a ring must be > 0 and less than its radius, %g m, got %g m", o->radius,
              o->inner_radius);
        /* fall through */
    case DEM_OUTLINE_DISC:
        CHECK(lattice_is_positive(o->radius), DEM_ERROR_ARGUMENT, "the radius must be > 0, got %g m", o->radius);
        return DEM_OK;
    case DEM_OUTLINE_POLYGON:
        return check_polygon(o);
    }
    return status_fail(DEM_ERROR_ARGUMENT, "unknown kind of outline: %d", (int)o->kind);
}

dem_status outline_input_check_edges(const outline *o)
{
    size_t edge[2];
    if (o->kind != DEM_OUTLINE_POLYGON || !outline_crossing(o, edge)) return DEM_OK;
    const double *p = o->points + 2 * edge[0], *q = o->points + 2 * edge[1];
    return status_fail(DEM_ERROR_ARGUMENT,
                       "the polygon meets itself: edge %zu, from (%g, %g) m, and edge %zu, from (%g, %g) m",
                       edge[0] + 1, p[0], p[1], edge[1] + 1, q[0], q[1]);
}

/* ---- reading ---- */

/* A struct of this version, with points that are the caller's. */
static dem_status read_struct(dem_outline *ours, const dem_outline *theirs)
{
    CHECK(theirs != NULL, DEM_ERROR_ARGUMENT, "outline is NULL");
    *ours = (dem_outline){0};
    TRY(struct_size_read(&kind, ours, theirs));
    return check_figure(ours);
}

/* Where nothing is turned or shifted no number is touched: zeros keep their signs. */
static dem_status place(outline *out, const dem_outline *o)
{
    const bool polygon = o->kind == DEM_OUTLINE_POLYGON, shifted = o->centre[0] != 0.0 || o->centre[1] != 0.0;
    const double turn[2] = {cos(o->angle), sin(o->angle)};
    *out = (outline){.kind = o->kind, .radius = o->radius, .size = {o->size[0], o->size[1]}};
    if (o->kind == DEM_OUTLINE_RING) out->inner = o->inner_radius;
    if (polygon) {
        out->n_points = (size_t)count_points(o);
        out->points = malloc(out->n_points * 2 * sizeof *out->points);
        CHECK_MEMORY(out->points);
        memcpy(out->points, o->points, out->n_points * 2 * sizeof *out->points);
    }
    if ((polygon && (shifted || o->angle != 0.0)) || (o->kind == DEM_OUTLINE_RECTANGLE && o->angle != 0.0)) {
        CHECK(outline_place(out, turn, o->centre), DEM_ERROR_MEMORY, "out of memory");
    } else if (!polygon) {
        memcpy(out->centre, o->centre, sizeof out->centre);
    }
    return DEM_OK;
}

dem_status outline_input_read(outline *out, const dem_outline *theirs)
{
    dem_outline o;
    *out = (outline){0};
    TRY(read_struct(&o, theirs));
    return place(out, &o);
}

/* Says which one of several has failed. */
static dem_status name_failure(dem_status status, const char *what, dem_index number)
{
    char text[STATUS_MESSAGE_SIZE];
    (void)snprintf(text, sizeof text, "%s", dem_status_message());
    return status_fail(status, "%s %lld: %s", what, (long long)number, text);
}

dem_status outline_input_read_all(outline **out, const dem_outline *theirs, dem_index n, const char *what)
{
    void *copies = NULL;
    *out = NULL;
    CHECK(n >= 0 && (n == 0 || theirs != NULL), DEM_ERROR_ARGUMENT, "%lld of %ss, but they are NULL", (long long)n,
          what);
    TRY(struct_size_read_array(&kind, &copies, theirs, n));
    const dem_outline *list = copies;
    outline *all = n > 0 ? calloc((size_t)n, sizeof *all) : NULL;
    dem_status status = n == 0 || all != NULL ? DEM_OK : status_fail(DEM_ERROR_MEMORY, "out of memory");
    dem_index k = 0;
    for (; status == DEM_OK && k < n; k++) {
        status = check_figure(&list[k]);
        if (status == DEM_OK) status = place(&all[k], &list[k]);
        if (status == DEM_ERROR_ARGUMENT) status = name_failure(status, what, k);
    }
    if (status == DEM_OK) {
        *out = all;
    } else {
        for (dem_index i = 0; i < k; i++) outline_free(&all[i]);
        free(all);
    }
    free(copies);
    return status;
}

/* ---- public ---- */

dem_status dem_outline_check(const dem_outline *figure)
{
    outline o;
    TRY(outline_input_read(&o, figure));
    const dem_status status = outline_input_check_edges(&o);
    outline_free(&o);
    return status;
}

dem_status dem_outline_box(const dem_outline *figure, double box[4])
{
    outline o;
    CHECK(box != NULL, DEM_ERROR_ARGUMENT, "box is NULL");
    TRY(outline_input_read(&o, figure));
    outline_box(&o, box);
    outline_free(&o);
    return DEM_OK;
}

dem_status dem_outline_distance(const dem_outline *figure, const double *x, dem_index n, double *distance)
{
    outline o;
    CHECK(n >= 0 && (n == 0 || (x != NULL && distance != NULL)), DEM_ERROR_ARGUMENT,
          "%lld points, but x or distance is "
          "NULL",
          (long long)n);
    TRY(outline_input_read(&o, figure));
    for (dem_index k = 0; k < n; k++) distance[k] = outline_distance(&o, x[2 * k], x[2 * k + 1]);
    outline_free(&o);
    return DEM_OK;
}

/* The struct alone, so that corners are found in a time that does not depend on their number. */
static dem_status read_corners(dem_outline *ours, const dem_outline *theirs)
{
    CHECK(theirs != NULL, DEM_ERROR_ARGUMENT, "outline is NULL");
    *ours = (dem_outline){0};
    TRY(struct_size_read(&kind, ours, theirs));
    CHECK(ours->kind != DEM_OUTLINE_POLYGON || (ours->points != NULL && ours->n_points >= 1), DEM_ERROR_ARGUMENT,
          "the points of a polygon are NULL");
    return DEM_OK;
}

static dem_index count_corners(const dem_outline *o)
{
    return o->kind == DEM_OUTLINE_POLYGON ? count_points(o) : (o->kind == DEM_OUTLINE_RECTANGLE ? 4 : 0);
}

dem_index dem_outline_corners(const dem_outline *figure)
{
    dem_outline o;
    return read_corners(&o, figure) == DEM_OK ? count_corners(&o) : 0;
}

/* A polygon is placed as one of a single point. */
dem_status dem_outline_corner(const dem_outline *figure, dem_index k, double x[2])
{
    dem_outline ours;
    outline o;
    CHECK(x != NULL, DEM_ERROR_ARGUMENT, "x is NULL");
    TRY(read_corners(&ours, figure));
    TRY(status_check_number("corner", k, count_corners(&ours)));
    const bool polygon = ours.kind == DEM_OUTLINE_POLYGON;
    if (polygon) {
        ours.points += 2 * k;
        ours.n_points = 1;
    }
    TRY(place(&o, &ours));
    memcpy(x, polygon ? o.points : outline_corner_at(&o, (size_t)k).x, 2 * sizeof *x);
    outline_free(&o);
    return DEM_OK;
}
