/* SPDX-License-Identifier: BSD-3-Clause */
/* From a caller's shape to a lattice, an area, and random pores: dem/shape.h. */
#include <dem/shape.h>

#include <stdlib.h>

#include "base/status.h"
#include "base/struct_size.h"
#include "lattice/lattice.h"
#include "shape/area.h"
#include "shape/pores.h"
#include "shape/shape_input.h"
#include "shape/smoothing.h"
#include "shape/triangle_numbers.h"

/* ---- lattice ---- */

/* A void that takes nothing is an error where it is not in the body at all; one between nodes is only small. */
static dem_status check_voids(const shape *s, const dem_shape *ours, const dem_lattice *lattice,
                              dem_shape_report *report)
{
    for (dem_index k = 0; k < ours->n_voids; k++) {
        const outline *hole = &s->voids[k];
        if (shape_has_void(s, hole) || shape_takes(s, hole, lattice, NULL)) continue;
        report->idle_void = k;
        return shape_input_refuse_void(ours, s, k);
    }
    return DEM_OK;
}

static dem_status cut(dem_lattice *lattice, const shape *s, dem_shape_report *report)
{
    smoothing out = {0};
    if (!s->smooth) return shape_cut(lattice, s);
    const dem_status status = smoothing_apply(&out, lattice, s, NULL);
    report->n_rim = out.n_rim;
    report->n_off = out.n_off;
    report->n_cut = out.n_cut;
    report->farthest = out.farthest;
    return status;
}

/* The messages of what is below speak of rectangles around the shape. */
static dem_status triangulate(dem_lattice *lattice, const shape *s, const dem_shape *ours, dem_shape_report *report)
{
    dem_status status = shape_input_check_size(ours, shape_mesh(lattice, s));
    if (status == DEM_OK && ours->numbered) status = triangle_numbers_add(lattice);
    if (status == DEM_OK) status = check_voids(s, ours, lattice, report);
    if (status != DEM_OK) return status;
    const dem_index n = lattice->n_nodes;
    status = cut(lattice, s, report);
    CHECK(status != DEM_ERROR_MODEL, DEM_ERROR_MODEL, "%s: its outline, voids and pores leave none of %lld nodes",
          shape_input_name(ours), (long long)n);
    CHECK(status != DEM_ERROR_MEMORY, DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)n);
    return status;
}

/* The report is as far as it goes. */
static dem_status give(dem_lattice *out, dem_lattice *lattice, dem_shape_report *theirs, const dem_shape_report *report,
                       dem_status status)
{
    if (theirs != NULL) (void)struct_size_write(&STRUCT_KIND(dem_shape_report), theirs, report);
    if (status == DEM_OK)
        lattice_give(out, lattice);
    else
        dem_lattice_free(lattice);
    return status;
}

dem_status dem_shape_lattice(dem_lattice *out, const dem_shape *theirs, dem_shape_report *report)
{
    dem_shape ours;
    shape s;
    dem_shape_report own = {.struct_size = sizeof own, .idle_void = -1};
    dem_lattice lattice = dem_lattice_empty();
    TRY(lattice_check_out(out));
    if (report != NULL) TRY(struct_size_check(&STRUCT_KIND(dem_shape_report), report));
    if (report != NULL) TRY(struct_size_write(&STRUCT_KIND(dem_shape_report), report, &own));
    TRY(shape_input_read(&ours, theirs));
    TRY(shape_input_make(&s, &ours));
    dem_status status = shape_input_check_edges(&s);
    if (status == DEM_OK) status = triangulate(&lattice, &s, &ours, &own);
    shape_free(&s);
    return give(out, &lattice, report, &own, status);
}

dem_status dem_shape_area(const dem_shape *theirs, double *area)
{
    dem_shape ours;
    shape s;
    CHECK(area != NULL, DEM_ERROR_ARGUMENT, "area is NULL");
    TRY(shape_input_read(&ours, theirs));
    TRY(shape_input_make(&s, &ours));
    const double found = area_of(&s);
    shape_free(&s);
    CHECK(found >= 0.0, DEM_ERROR_MEMORY, "out of memory");
    *area = found;
    return DEM_OK;
}

/* ---- pores ---- */

static bool fits(void *context, const double x[2], double radius)
{
    return shape_fits(context, x, radius);
}

static dem_status read_recipe(pores_recipe *out, const dem_pores *theirs, dem_index capacity)
{
    static const struct_kind kind = {"dem_pores", STRUCT_SIZE_WITH(dem_pores, seed), sizeof(dem_pores)};
    dem_pores ours = {0};
    CHECK(theirs != NULL, DEM_ERROR_ARGUMENT, "recipe is NULL");
    TRY(struct_size_read(&kind, &ours, theirs));
    CHECK(ours.number >= 0 && ours.number <= DEM_PORES_MAX, DEM_ERROR_ARGUMENT,
          "the number of pores must be in [0, %d], got %lld", DEM_PORES_MAX, (long long)ours.number);
    CHECK(ours.number <= capacity, DEM_ERROR_ARGUMENT, "%lld pores, but there is room for %lld", (long long)ours.number,
          (long long)capacity);
    CHECK(ours.distribution >= DEM_PORE_RADII_UNIFORM && ours.distribution <= DEM_PORE_RADII_NORMAL, DEM_ERROR_ARGUMENT,
          "unknown distribution of radii: %d", (int)ours.distribution);
    *out = (pores_recipe){.number = (size_t)ours.number,
                          .area = ours.area,
                          .radius_min = ours.radius_min,
                          .radius_max = ours.radius_max,
                          .distribution = ours.distribution,
                          .mean = ours.mean,
                          .deviation = ours.deviation,
                          .wall = ours.wall,
                          .seed = ours.seed};
    return DEM_OK;
}

static dem_status judge(pores_status status, const pores *p, const pores_recipe *r, const char *name)
{
    switch (status) {
    case PORES_PLACED:
        return DEM_OK;
    case PORES_CROWDED:
        return status_fail(DEM_ERROR_MODEL, "pore %zu of %zu, of radius %g m, finds no place in %s with walls of %g m",
                           p->n_placed + 1, p->n, p->list[p->n_placed].radius, name, r->wall);
    case PORES_TOO_MANY:
        return status_fail(DEM_ERROR_MODEL, "the area of the pores, %g m^2, needs more than %d of such radii in %s",
                           r->area, DEM_PORES_MAX, name);
    case PORES_RARE:
        return status_fail(DEM_ERROR_ARGUMENT,
                           "the mean %g m and the deviation %g m give next to no radius from %g m to %g m", r->mean,
                           r->deviation, r->radius_min, r->radius_max);
    case PORES_UNSOUND:
        return status_fail(DEM_ERROR_ARGUMENT,
                           "no pores can be drawn with radii from %g m to %g m, mean %g m, deviation %g m, walls of "
                           "%g m, area %g m^2",
                           r->radius_min, r->radius_max, r->mean, r->deviation, r->wall, r->area);
    case PORES_MEMORY:
        break;
    }
    return status_fail(DEM_ERROR_MEMORY, "out of memory for pores");
}

static dem_status put_pores(double *out, dem_index capacity, const pores *p)
{
    CHECK((dem_index)p->n <= capacity, DEM_ERROR_ARGUMENT, "%zu pores, but there is room for %lld", p->n,
          (long long)capacity);
    for (size_t k = 0; k < p->n; k++) {
        out[3 * k] = p->list[k].centre[0];
        out[3 * k + 1] = p->list[k].centre[1];
        out[3 * k + 2] = p->list[k].radius;
    }
    return DEM_OK;
}

dem_status dem_shape_place_pores(const dem_shape *theirs, const dem_pores *recipe, double *pores_out,
                                 dem_index capacity, dem_index *n)
{
    dem_shape ours;
    shape s;
    pores_recipe own;
    pores placed;
    CHECK(pores_out != NULL && n != NULL && capacity >= 0, DEM_ERROR_ARGUMENT, "pores or n is NULL");
    TRY(read_recipe(&own, recipe, capacity));
    TRY(shape_input_read(&ours, theirs));
    TRY(shape_input_make(&s, &ours));
    outline_box(&s.outline, own.box);
    const pores_status drawn = pores_place(&placed, &own, fits, &s);
    dem_status status = judge(drawn, &placed, &own, shape_input_name(&ours));
    if (status == DEM_OK) status = put_pores(pores_out, capacity, &placed);
    if (status == DEM_OK || status == DEM_ERROR_MODEL)
        *n = drawn == PORES_TOO_MANY ? DEM_PORES_MAX : (dem_index)placed.n_placed;
    free(placed.list);
    shape_free(&s);
    return status;
}
