/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/shape_input.h"

#include <math.h>
#include <string.h>

#include "base/status.h"
#include "base/struct_size.h"
#include "lattice/lattice.h"
#include "shape/outline_input.h"

static const struct_kind kind = {"dem_shape", STRUCT_SIZE_WITH(dem_shape, name), sizeof(dem_shape)};
static const struct_kind image_kind = {"dem_image", STRUCT_SIZE_WITH(dem_image, solid), sizeof(dem_image)};

const char *shape_input_name(const dem_shape *ours)
{
    return ours->name != NULL ? ours->name : "the shape";
}

dem_status shape_input_read(dem_shape *ours, const dem_shape *theirs)
{
    CHECK(theirs != NULL, DEM_ERROR_ARGUMENT, "shape is NULL");
    *ours = (dem_shape){0};
    TRY(struct_size_read(&kind, ours, theirs));
    CHECK((ours->outline != NULL) != (ours->image != NULL), DEM_ERROR_ARGUMENT,
          "%s must have an outline or an image, and not both", shape_input_name(ours));
    CHECK(ours->grid == DEM_GRID_TRIANGLES || ours->grid == DEM_GRID_SQUARES, DEM_ERROR_ARGUMENT, "unknown grid: %d",
          (int)ours->grid);
    CHECK(ours->edge == DEM_EDGE_STEPPED || ours->edge == DEM_EDGE_SMOOTH, DEM_ERROR_ARGUMENT, "unknown edge: %d",
          (int)ours->edge);
    CHECK(ours->edge == DEM_EDGE_STEPPED || (ours->grid == DEM_GRID_TRIANGLES && ours->image == NULL),
          DEM_ERROR_ARGUMENT, "smooth edges are for triangles in an outline, neither for squares nor for an image");
    CHECK(ours->n_pores >= 0 && (ours->n_pores == 0 || ours->pores != NULL), DEM_ERROR_ARGUMENT,
          "%lld pores, but they are NULL", (long long)ours->n_pores);
    return DEM_OK;
}

dem_status shape_input_refuse_void(const dem_shape *ours, const shape *s, dem_index k)
{
    const double *inside = shape_void_point(&s->voids[k]);
    return status_fail(DEM_ERROR_MODEL, "void %lld takes no node of %s: it lies at (%g, %g) m", (long long)k,
                       shape_input_name(ours), inside[0], inside[1]);
}

dem_status shape_input_check_size(const dem_shape *ours, dem_status made)
{
    CHECK(made != DEM_ERROR_MODEL, DEM_ERROR_ARGUMENT, "%s would have more nodes than 2^40 with the spacing %g m",
          shape_input_name(ours), ours->spacing);
    return made;
}

/* ---- body ---- */

/* The frame of an image stands on the origin. */
static dem_status read_image(shape *s, const dem_image *theirs)
{
    dem_image image = {0};
    TRY(struct_size_read(&image_kind, &image, theirs));
    CHECK(image.width >= 1 && image.width <= DEM_IMAGE_MAX_SIDE && image.height >= 1 &&
              image.height <= DEM_IMAGE_MAX_SIDE && image.solid != NULL,
          DEM_ERROR_ARGUMENT, "an image must have 1 to %d pixels each way, got %lld x %lld", DEM_IMAGE_MAX_SIDE,
          (long long)image.width, (long long)image.height);
    CHECK(lattice_is_positive(image.pixel), DEM_ERROR_ARGUMENT, "the side of a pixel must be > 0, got %g m",
          image.pixel);
    CHECK(mask_create(&s->mask, &image), DEM_ERROR_MEMORY, "out of memory for an image of %lld x %lld pixels",
          (long long)image.width, (long long)image.height);
    s->outline.size[0] = (double)s->mask.width * s->mask.scale;
    s->outline.size[1] = (double)s->mask.height * s->mask.scale;
    s->outline.centre[1] = 0.5 * s->outline.size[1];
    return DEM_OK;
}

/* What the spacing must not exceed, m. */
static void measure(double size[2], const outline *o)
{
    double box[4];
    outline_box(o, box);
    for (int c = 0; c < 2; c++) size[c] = box[c + 2] - box[c];
    if (o->kind == DEM_OUTLINE_RECTANGLE) memcpy(size, o->size, sizeof o->size); /* without rounding */
    if (o->kind == DEM_OUTLINE_DISC) size[0] = size[1] = o->radius;
    if (o->kind == DEM_OUTLINE_RING) size[0] = size[1] = o->radius - o->inner;
}

/* Where areas underflow a smooth edge is left as it is: the lattice will be refused for that when it is assembled. */
static dem_status read_body(shape *s, const dem_shape *ours)
{
    double size[2];
    TRY(ours->image != NULL ? read_image(s, ours->image) : outline_input_read(&s->outline, ours->outline));
    measure(size, &s->outline);
    CHECK(lattice_is_positive(ours->spacing) && ours->spacing <= size[0] && ours->spacing <= size[1],
          DEM_ERROR_ARGUMENT, "%s of %g m x %g m cannot have the spacing %g m", shape_input_name(ours), size[0],
          size[1], ours->spacing);
    s->spacing = ours->spacing;
    s->squares = ours->grid == DEM_GRID_SQUARES;
    s->smooth = ours->edge == DEM_EDGE_SMOOTH && isnormal(s->spacing * s->spacing);
    return DEM_OK;
}

/* ---- voids ---- */

static dem_status add_pores(shape *s, const dem_shape *ours)
{
    for (dem_index k = 0; k < ours->n_pores; k++) {
        const double *p = ours->pores + 3 * k;
        outline hole = {.kind = DEM_OUTLINE_DISC, .centre = {p[0], p[1]}, .radius = p[2]};
        CHECK(isfinite(p[0]) && isfinite(p[1]) && lattice_is_positive(p[2]), DEM_ERROR_ARGUMENT,
              "pore %lld: at (%g, %g) m with the radius %g m", (long long)k, p[0], p[1], p[2]);
        CHECK(shape_add_void(s, &hole), DEM_ERROR_MEMORY, "out of memory for %lld pores", (long long)ours->n_pores);
    }
    return DEM_OK;
}

static dem_status read_all(shape *s, const dem_shape *ours)
{
    TRY(read_body(s, ours));
    TRY(outline_input_read_all(&s->voids, ours->voids, ours->n_voids, "void"));
    s->n_voids = (size_t)ours->n_voids;
    return add_pores(s, ours);
}

dem_status shape_input_make(shape *out, const dem_shape *ours)
{
    *out = (shape){0};
    const dem_status status = read_all(out, ours);
    if (status != DEM_OK) shape_free(out);
    return status;
}

dem_status shape_input_check_edges(const shape *s)
{
    for (size_t k = 0; k <= s->n_voids; k++) TRY(outline_input_check_edges(shape_edge_at(s, k)));
    return DEM_OK;
}
