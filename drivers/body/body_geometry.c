/* SPDX-License-Identifier: BSD-3-Clause */
#include "body_geometry.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "body_checks.h"
#include "body_outline.h"
#include "image_file.h"
#include "material.h"
#include "output/slab_file.h"
#include "shape/shape_slab.h"

static const double pi = 3.14159265358979323846;

static bool has_shape(const schema_instance *group, const char *name)
{
    return schema_is(group, "shape", name);
}

/* A geometry in the making. What works on it returns DEM_OK, DEM_ERROR_MEMORY, or another status after reporting a
 * fault. */
typedef struct former {
    const schema_deck *groups;
    const schema_instance *body;
    size_t number; /* from 1 */
    const char *folder;
    namelist_errors *errors;
    char name[32];       /* "body 1" */
    dem_shape shape;     /* of what is not a mesh; points at what follows */
    dem_outline outline; /* of a body that is no image */
    dem_image image;     /* its pixels are owned */
    dem_outline *voids;  /* owned, with room for inclusions behind them */
    double *pores;       /* owned, with room for DEM_PORES_MAX more while a &pores group is placed */
    bool *is_met;        /* owned, [cracks] those that cross a triangle */
    dem_lattice lattice;
    body_geometry geometry;
} former;

static void former_free(former *f)
{
    free((void *)f->image.solid);
    free(f->voids);
    free(f->pores);
    free(f->is_met);
}

static size_t count_own(const former *f, const char *name)
{
    size_t n = 0;
    for (size_t k = 0; k < schema_count(f->groups, name); k++)
        n += (size_t)schema_real(schema_get(f->groups, name, k), "body") == f->number;
    return n;
}

/* The k-th group of a name if it is for this body, else NULL. */
static const schema_instance *own(const former *f, const char *name, size_t k)
{
    const schema_instance *group = schema_get(f->groups, name, k);
    return (size_t)schema_real(group, "body") == f->number ? group : NULL;
}

/* Passes a status on; one that speaks of a fault is reported with the library's message and what a deck can do. */
static dem_status report(const former *f, dem_status status, namelist_place place, const char *advice)
{
    if (status != DEM_OK && status != DEM_ERROR_MEMORY)
        namelist_errors_add(f->errors, place, "%s%s", dem_status_message(), advice);
    return status;
}

/* ---- pores ---- */

static dem_status report_pores(const former *f, const schema_instance *group, const dem_pores *recipe,
                               dem_status status, dem_index n_placed)
{
    const bool wall_given = schema_given(group, "wall");
    if (status == DEM_ERROR_ARGUMENT) {
        namelist_errors_add(f->errors, schema_place(group, "mean"),
                            "'mean' and 'deviation' in &pores, %g m and %g m, give next to no radius from %g m to %g m",
                            recipe->mean, recipe->deviation, recipe->radius_min, recipe->radius_max);
    } else if (status == DEM_ERROR_MODEL && n_placed == DEM_PORES_MAX) {
        namelist_errors_add(f->errors, schema_place(group, "porosity"),
                            "'porosity' in &pores, %g, needs more than %d pores of such radii in body %zu",
                            schema_real(group, "porosity"), DEM_PORES_MAX, f->number);
    } else {
        (void)report(f, status, group->place,
                     wall_given ? "; take fewer or smaller ones, or a thinner 'wall'"
                                : ", the default; take fewer or smaller ones, or a thinner 'wall'");
    }
    return status == DEM_ERROR_MEMORY ? status : DEM_ERROR_MODEL;
}

static dem_pores recipe_of(const former *f, const schema_instance *group)
{
    const double *radius = schema_reals(group, "radius"), *wall = schema_reals(group, "wall");
    return (dem_pores){.struct_size = sizeof(dem_pores),
                       .number = (dem_index)schema_real(group, "number"),
                       .area = schema_real(group, "porosity") * f->geometry.area,
                       .radius_min = radius[0],
                       .radius_max = radius[1],
                       .distribution = schema_is(group, "distribution", "normal")      ? DEM_PORE_RADII_NORMAL
                                       : schema_is(group, "distribution", "lognormal") ? DEM_PORE_RADII_LOGNORMAL
                                                                                       : DEM_PORE_RADII_UNIFORM,
                       .mean = schema_real(group, "mean"),
                       .deviation = schema_real(group, "deviation"),
                       .wall = wall != NULL ? wall[0] : 2.0 * f->shape.spacing,
                       .seed = (uint64_t)schema_real(group, "seed")};
}

/* Behind those that are there, among which they find their places. */
static dem_status add_pores(former *f, const schema_instance *group)
{
    const dem_pores recipe = recipe_of(f, group);
    const dem_index before = f->shape.n_pores, room = recipe.number > 0 ? recipe.number : DEM_PORES_MAX;
    double *pores = realloc(f->pores, (size_t)(before + room) * 3 * sizeof *pores);
    dem_index n = 0;
    if (pores == NULL) return DEM_ERROR_MEMORY;
    f->shape.pores = f->pores = pores;
    const dem_status status = dem_shape_place_pores(&f->shape, &recipe, pores + 3 * before, room, &n);
    if (status != DEM_OK) return report_pores(f, group, &recipe, status, n);
    f->shape.n_pores += n;
    f->geometry.n_pores += (size_t)n;
    for (dem_index k = before; k < before + n; k++) f->geometry.pore_area += pi * pores[3 * k + 2] * pores[3 * k + 2];
    return DEM_OK;
}

/* ---- shapes ---- */

/* What is at least `threshold` times white is material, or, with `invert`, what is darker. */
static bool make_solid(former *f, const image *picture)
{
    const double threshold = schema_real(f->body, "threshold") * picture->white;
    const bool inverted = schema_real(f->body, "invert") != 0.0;
    const size_t n = picture->width * picture->height;
    unsigned char *solid = calloc(n, sizeof *solid);
    for (size_t k = 0; solid != NULL && k < n; k++) solid[k] = (picture->grey[k] >= threshold) != inverted;
    f->image = (dem_image){.struct_size = sizeof f->image,
                           .width = (dem_index)picture->width,
                           .height = (dem_index)picture->height,
                           .pixel = schema_real(f->body, "scale"),
                           .solid = solid};
    return solid != NULL;
}

static dem_status read_image(former *f)
{
    char *path = body_geometry_file(f->folder, f->body), fault[IMAGE_FAULT];
    image picture;
    if (path == NULL) return DEM_ERROR_MEMORY;
    const image_status status = image_file_read(&picture, fault, path);
    if (status == IMAGE_REFUSED)
        namelist_errors_add(f->errors, schema_place(f->body, "file"), "body %zu: %s:%s", f->number, path, fault);
    free(path);
    if (status != IMAGE_READ) return status == IMAGE_MEMORY ? DEM_ERROR_MEMORY : DEM_ERROR_MODEL;
    const bool good = make_solid(f, &picture);
    image_free(&picture);
    if (!good) return DEM_ERROR_MEMORY;
    f->shape.image = &f->image;
    const double size[2] = {(double)f->image.width * f->image.pixel, (double)f->image.height * f->image.pixel};
    if (f->shape.spacing <= size[0] && f->shape.spacing <= size[1]) return DEM_OK;
    body_checks_refuse_spacing(f->body, "image", size, f->errors);
    return DEM_ERROR_MODEL;
}

static dem_status collect_voids(former *f)
{
    f->voids = calloc(count_own(f, "void") + f->geometry.n_inclusions + 1, sizeof *f->voids);
    if (f->voids == NULL) return DEM_ERROR_MEMORY;
    for (size_t k = 0; k < schema_count(f->groups, "void"); k++)
        if (own(f, "void", k) != NULL) f->voids[f->shape.n_voids++] = body_outline_placed(own(f, "void", k));
    f->shape.voids = f->voids;
    return DEM_OK;
}

/* Outline or image, voids, pores; the true area. */
static dem_status make_shape(former *f)
{
    f->shape = (dem_shape){.struct_size = sizeof f->shape, .numbered = true, .name = f->name};
    f->shape.spacing = f->geometry.spacing = schema_real(f->body, "spacing");
    f->shape.grid = body_geometry_has_squares(f->body) ? DEM_GRID_SQUARES : DEM_GRID_TRIANGLES;
    if (f->shape.grid == DEM_GRID_TRIANGLES && schema_is(f->body, "outline", "smooth")) f->shape.edge = DEM_EDGE_SMOOTH;
    f->outline = body_outline(f->body);
    dem_status status = DEM_OK;
    if (has_shape(f->body, "mask"))
        status = read_image(f);
    else
        f->shape.outline = &f->outline;
    if (status == DEM_OK) status = collect_voids(f);
    if (status == DEM_OK)
        status = report(f, dem_shape_area(&f->shape, &f->geometry.area), schema_place(f->body, "shape"), "");
    for (size_t k = 0; status == DEM_OK && k < schema_count(f->groups, "pores"); k++)
        if (own(f, "pores", k) != NULL) status = add_pores(f, own(f, "pores", k));
    f->geometry.area -= f->geometry.pore_area;
    return status;
}

/* ---- numbers ---- */

dem_index *body_geometry_take_numbers(dem_lattice *lattice)
{
    dem_index *numbers = calloc((size_t)lattice->n_triangles + 1, sizeof *numbers);
    for (dem_index t = 0; numbers != NULL && t < lattice->n_triangles; t++)
        numbers[t] = (dem_index)lattice->strength[t];
    free(lattice->strength);
    lattice->strength = NULL;
    return numbers;
}

/* ---- lattices ---- */

static dem_status report_void(const former *f, dem_index idle)
{
    dem_index v = 0;
    for (size_t k = 0; k < schema_count(f->groups, "void"); k++)
        if (own(f, "void", k) != NULL && v++ == idle)
            namelist_errors_add(f->errors, schema_place(own(f, "void", k), "centre"),
                                "void takes no node of body %zu: its centre is in the body's own coordinates",
                                f->number);
    return DEM_ERROR_MODEL;
}

static dem_status make_lattice(former *f)
{
    dem_shape_report *out = &f->geometry.report;
    *out = (dem_shape_report){.struct_size = sizeof *out};
    const dem_status status = dem_shape_lattice(&f->lattice, &f->shape, out);
    if (status == DEM_ERROR_MODEL && out->idle_void >= 0) return report_void(f, out->idle_void);
    if (status == DEM_ERROR_ARGUMENT) return report(f, status, schema_place(f->body, "spacing"), "");
    return report(f, status, f->body->place, body_geometry_hint(f->body));
}

/* ---- meshes ---- */

static double area_of_triangle(const dem_lattice *lattice, dem_index t)
{
    const dem_index *node = lattice->triangles + 3 * t;
    const double *a = lattice->x + 2 * node[0], *b = lattice->x + 2 * node[1], *c = lattice->x + 2 * node[2];
    return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

static dem_status read_mesh(former *f)
{
    char *path = body_geometry_file(f->folder, f->body);
    if (path == NULL) return DEM_ERROR_MEMORY;
    const dem_mesh mesh = {
        .struct_size = sizeof mesh, .path = path, .scale = schema_real(f->body, "scale"), .numbered = true};
    const dem_status status = dem_mesh_lattice(&f->lattice, &mesh);
    if (status == DEM_ERROR_MODEL || status == DEM_ERROR_IO)
        namelist_errors_add(f->errors, schema_place(f->body, "file"), "body %zu: %s", f->number, dem_status_message());
    free(path);
    if (status != DEM_OK) return status;
    double least = (double)INFINITY;
    for (dem_index t = 0; t < f->lattice.n_triangles; t++) {
        const double area = area_of_triangle(&f->lattice, t);
        least = fmin(least, area);
        f->geometry.area += area;
    }
    f->geometry.spacing = sqrt(least / 0.43301270189221932); /* sqrt(3)/4 */
    return DEM_OK;
}

const char *body_geometry_hint(const schema_instance *body)
{
    if (!has_shape(body, "mask")) return "";
    return schema_real(body, "invert") != 0.0
               ? "; dark pixels are material, as 'invert' asks"
               : "; bright pixels are material: for the dark ones give 'invert = .true.'";
}

bool body_geometry_has_squares(const schema_instance *body)
{
    return schema_is(body, "lattice", "square");
}

/* ---- inclusions ---- */

const schema_instance *body_geometry_user(const schema_deck *groups, size_t k, size_t i)
{
    const former f = {.groups = groups, .number = k + 1};
    size_t n = 0;
    if (i == 0) return schema_get(groups, "body", k);
    for (size_t g = 0; g < schema_count(groups, "inclusion"); g++)
        if (own(&f, "inclusion", g) != NULL && ++n == i) return own(&f, "inclusion", g);
    return NULL;
}

dem_material body_geometry_material(const schema_deck *groups, size_t k)
{
    const schema_instance *body = schema_get(groups, "body", k);
    dem_material m = material_of(groups, body);
    if (body_geometry_has_squares(body)) m.springs = DEM_SPRINGS_INDEPENDENT; /* it may be one of triangles, too */
    return m;
}

void body_geometry_materials(dem_material *out, const schema_deck *groups, size_t k)
{
    const former f = {.groups = groups, .number = k + 1};
    size_t n = 1;
    out[0] = body_geometry_material(groups, k);
    for (size_t i = 0; i < schema_count(groups, "inclusion"); i++)
        if (own(&f, "inclusion", i) != NULL) out[n++] = material_of(groups, own(&f, "inclusion", i));
    for (size_t i = 1; i < n && body_geometry_has_squares(schema_get(groups, "body", k)); i++)
        out[i].springs = DEM_SPRINGS_INDEPENDENT;
}

static void report_inclusion(const former *f, const schema_instance *group)
{
    namelist_errors_add(f->errors, schema_place(group, "centre"),
                        "inclusion has no triangle of body %zu: its centre is in the body's own coordinates",
                        f->number);
}

/* \param inside  [n_triangles] room */
static dem_status mark_inclusions(const former *f, dem_index *of, bool *is_met, const dem_lattice *lattice,
                                  bool *inside)
{
    const dem_index step = body_geometry_has_squares(f->body) ? 2 : 1;
    dem_index material = 0;
    for (size_t i = 0; i < schema_count(f->groups, "inclusion"); i++) {
        const schema_instance *group = own(f, "inclusion", i);
        dem_index n = 0;
        if (group == NULL) continue;
        const dem_outline o = body_outline_placed(group);
        const dem_status status = dem_lattice_inside(lattice, &o, step, inside, NULL);
        if (status != DEM_OK) return report(f, status, group->place, "");
        material++;
        for (dem_index t = 0; t < lattice->n_triangles; t++) {
            if (inside[t]) of[t] = material;
            n += inside[t];
        }
        if (is_met != NULL) {
            is_met[material - 1] = is_met[material - 1] || n > 0;
        } else if (n == 0) {
            report_inclusion(f, group);
            return DEM_ERROR_MODEL;
        }
    }
    return DEM_OK;
}

dem_status body_geometry_mark(dem_index *of, bool *is_met, const dem_lattice *lattice, const schema_deck *groups,
                              size_t k, namelist_errors *errors)
{
    const former f = {.groups = groups, .body = schema_get(groups, "body", k), .number = k + 1, .errors = errors};
    bool *inside = calloc((size_t)lattice->n_triangles + 1, sizeof *inside);
    if (inside == NULL) return DEM_ERROR_MEMORY;
    for (dem_index t = 0; t < lattice->n_triangles; t++) of[t] = 0;
    const dem_status status = mark_inclusions(&f, of, is_met, lattice, inside);
    free(inside);
    return status;
}

static double weight_of(const dem_material *m)
{
    return m->density * m->thickness;
}

/* The area of an inclusion is what is missing when it is a void; the last one goes before the others. */
static dem_status weigh_shape(former *f, const dem_material *materials)
{
    const double body = weight_of(&materials[0]);
    size_t material = f->geometry.n_inclusions;
    double area = 0.0, without;
    f->geometry.mass = body * f->geometry.area;
    dem_status status = material > 0 ? dem_shape_area(&f->shape, &area) : DEM_OK;
    for (size_t i = schema_count(f->groups, "inclusion"); status == DEM_OK && i-- > 0;) {
        if (own(f, "inclusion", i) == NULL) continue;
        f->voids[f->shape.n_voids++] = body_outline_placed(own(f, "inclusion", i));
        status = dem_shape_area(&f->shape, &without);
        if (status == DEM_OK) f->geometry.mass += (weight_of(&materials[material--]) - body) * (area - without);
        area = without;
    }
    return report(f, status, f->body->place, "");
}

static dem_status weigh_mesh(former *f, const dem_material *materials)
{
    dem_index *of = calloc((size_t)f->lattice.n_triangles, sizeof *of);
    if (of == NULL) return DEM_ERROR_MEMORY;
    const dem_status status = body_geometry_mark(of, NULL, &f->lattice, f->groups, f->number - 1, f->errors);
    for (dem_index t = 0; status == DEM_OK && t < f->lattice.n_triangles; t++)
        f->geometry.mass += weight_of(&materials[of[t]]) * area_of_triangle(&f->lattice, t);
    free(of);
    return status;
}

/* The true mass; the shape is not to be used after that. */
static dem_status weigh(former *f)
{
    dem_material *materials = calloc(f->geometry.n_inclusions + 1, sizeof *materials);
    if (materials == NULL) return DEM_ERROR_MEMORY;
    body_geometry_materials(materials, f->groups, f->number - 1);
    const dem_status status = has_shape(f->body, "mesh") ? weigh_mesh(f, materials) : weigh_shape(f, materials);
    free(materials);
    return status;
}

/* ---- cracks ---- */

/* Where cracks run. */
typedef struct crack_rows {
    const dem_lattice *lattice;
    const bool *are_there; /* [n_triangles] */
    dem_index begin, end;  /* the triangles by which a crack is found to be in the body */
} crack_rows;

/* Of a cell of squares both triangles stay, or none. */
static void keep_cells(bool *keep, dem_index n_triangles)
{
    for (dem_index t = 0; t + 1 < n_triangles; t += 2) keep[t] = keep[t + 1] = keep[t] && keep[t + 1];
}

/* \param crossed  [n_triangles] room
 * \param[out] is_met  whether one of the triangles from `begin` on, before `end`, that are there is crossed */
static dem_status mark_crack(const former *f, bool *crossed, bool *is_met, const crack_rows *rows, size_t k)
{
    const double aside = BODY_GEOMETRY_ASIDE * f->geometry.spacing;
    const schema_value *points = schema_value_of(own(f, "crack", k), "points");
    const dem_status status =
        dem_lattice_crossed(rows->lattice, points->reals, points->count / 2, aside, crossed, NULL);
    for (dem_index t = rows->begin; t < rows->end && status == DEM_OK; t++)
        *is_met = *is_met || (rows->are_there[t] && crossed[t]);
    return report(f, status, points->place, "");
}

/* What cracks take.  \param keep  [n_triangles] those that there are; those that are crossed become false */
static dem_status mark_cracks(const former *f, bool *keep, const crack_rows *rows, bool *crossed)
{
    const dem_index n = rows->lattice->n_triangles;
    size_t crack = 0;
    for (size_t k = 0; k < schema_count(f->groups, "crack"); k++) {
        if (own(f, "crack", k) == NULL) continue;
        const dem_status status = mark_crack(f, crossed, &f->is_met[crack++], rows, k);
        if (status != DEM_OK) return status;
        for (dem_index t = 0; t < n; t++) keep[t] = keep[t] && !crossed[t];
    }
    if (body_geometry_has_squares(f->body)) keep_cells(keep, n);
    return DEM_OK;
}

/* Of all triangles, or of rows as dem_private_rows_cut (shape/shape_slab.h) has them. */
static dem_status cut_cracks(void *program, const dem_lattice *lattice, bool *keep, dem_index begin, dem_index end)
{
    const former *f = program;
    const size_t n = (size_t)lattice->n_triangles;
    bool *are_there = calloc(n + 1, sizeof *are_there), *crossed = calloc(n + 1, sizeof *crossed);
    dem_status status = are_there != NULL && crossed != NULL ? DEM_OK : DEM_ERROR_MEMORY;
    if (status == DEM_OK) {
        memcpy(are_there, keep, n * sizeof *are_there);
        status = mark_cracks(f, keep, &(crack_rows){lattice, are_there, begin, end}, crossed);
    }
    free(are_there);
    free(crossed);
    return status;
}

static dem_status check_cracks(const former *f)
{
    size_t crack = 0;
    for (size_t k = 0; k < schema_count(f->groups, "crack"); k++) {
        if (own(f, "crack", k) == NULL || f->is_met[crack++]) continue;
        namelist_errors_add(f->errors, schema_value_of(own(f, "crack", k), "points")->place,
                            "crack crosses no triangle of body %zu: its points are in the body's own coordinates",
                            f->number);
        return DEM_ERROR_MODEL;
    }
    return DEM_OK;
}

/* \param keep  [n_triangles] room */
static dem_status take_cracks(former *f, bool *keep)
{
    const dem_index n = f->lattice.n_triangles;
    memset(keep, 1, (size_t)n * sizeof *keep);
    dem_status status = cut_cracks(f, &f->lattice, keep, 0, n);
    if (status == DEM_OK) status = check_cracks(f);
    if (status != DEM_OK) return status;
    status = dem_lattice_trim(&f->lattice, keep);
    if (status == DEM_ERROR_MODEL)
        namelist_errors_add(f->errors, f->body->place, "body %zu: its cracks leave none of %lld triangles", f->number,
                            (long long)n);
    f->geometry.n_cracked = n - f->lattice.n_triangles;
    return status;
}

static bool list_cracks(former *f)
{
    f->is_met = calloc(count_own(f, "crack") + 1, sizeof *f->is_met);
    return f->is_met != NULL;
}

static dem_status crack(former *f)
{
    bool *keep = calloc((size_t)f->lattice.n_triangles + 1, sizeof *keep);
    const dem_status status = keep != NULL && list_cracks(f) ? take_cracks(f, keep) : DEM_ERROR_MEMORY;
    free(keep);
    return status;
}

/* ---- all of it ---- */

/* \param slab  NULL: all of the body is in f->lattice */
static dem_status jitter(former *f, dem_slab *slab)
{
    const double radius = schema_real(f->body, "jitter") * f->geometry.spacing;
    const uint64_t seed = (uint64_t)schema_real(f->body, "seed");
    if (radius == 0.0) return DEM_OK;
    const dem_status status =
        slab != NULL ? dem_slab_jitter(slab, radius, seed) : dem_lattice_jitter(&f->lattice, radius, seed);
    if (status == DEM_ERROR_MODEL)
        namelist_errors_add(f->errors, schema_place(f->body, "jitter"), "body %zu: %s", f->number,
                            dem_status_message());
    return status;
}

char *body_geometry_file(const char *folder, const schema_instance *body)
{
    const char *file = schema_text(body, "file"), *where = file[0] == '/' ? "" : folder;
    const size_t size = strlen(where) + strlen(file) + 1;
    char *path = malloc(size);
    if (path != NULL) (void)snprintf(path, size, "%s%s", where, file);
    return path;
}

static former begin(const schema_deck *groups, size_t k, const char *folder, namelist_errors *errors)
{
    former f = {
        .groups = groups, .body = schema_get(groups, "body", k), .number = k + 1, .folder = folder, .errors = errors};
    (void)snprintf(f.name, sizeof f.name, "body %zu", f.number);
    f.lattice = dem_lattice_empty();
    f.geometry.n_inclusions = count_own(&f, "inclusion");
    return f;
}

/* What is found of the whole comes from the slab that counts rows: it has no `counts` yet. */
static dem_status cut_rows(dem_slab *slab, former *f, dem_index **counts, body_range range)
{
    const bool are_counted = *counts == NULL;
    dem_private_rows rows = {.cut = count_own(f, "crack") > 0 ? cut_cracks : NULL, .program = f};
    f->shape.numbered = false;
    if (!list_cracks(f)) return DEM_ERROR_MEMORY;
    const dem_status status =
        report(f, dem_private_slab_between(slab, &f->shape, &rows, counts, range.begin, range.end), f->body->place, "");
    f->geometry.report = rows.report;
    f->geometry.n_cracked = rows.n_taken;
    return status == DEM_OK && are_counted ? check_cracks(f) : status;
}

static dem_status cut_slab(dem_slab *slab, former *f, dem_index **counts, body_range range)
{
    dem_status status = make_shape(f);
    if (status == DEM_OK) status = cut_rows(slab, f, counts, range);
    if (status == DEM_OK) status = weigh(f);
    return status == DEM_OK && slab->n_own > 0 ? jitter(f, slab) : status;
}

static dem_status read_slab(dem_slab *slab, const former *f, dem_index **node_ranges, body_range range)
{
    char *path = body_geometry_file(f->folder, f->body);
    if (path == NULL) return DEM_ERROR_MEMORY;
    const dem_status status = dem_private_slab_of_file(slab, path, node_ranges, range.begin, range.end);
    free(path);
    return report(f, status, schema_place(f->body, "file"), "");
}

dem_status body_geometry_slab(dem_slab *slab, body_geometry *out, const body_keys *body, body_range range,
                              namelist_errors *errors)
{
    former f = begin(body->groups, body->k, body->folder, errors);
    *slab = dem_slab_empty();
    const dem_status status =
        has_shape(f.body, "file") ? read_slab(slab, &f, body->rows, range) : cut_slab(slab, &f, body->rows, range);
    if (status != DEM_OK) dem_slab_free(slab);
    former_free(&f);
    *out = f.geometry;
    return status;
}

dem_status body_geometry_triangulate(dem_lattice *lattice, body_geometry *out, const schema_deck *groups, size_t k,
                                     const char *folder, namelist_errors *errors)
{
    former f = begin(groups, k, folder, errors);
    dem_status status = DEM_OK;
    if (has_shape(f.body, "mesh")) {
        status = read_mesh(&f);
    } else {
        status = make_shape(&f);
        if (status == DEM_OK) status = make_lattice(&f);
    }
    if (status == DEM_OK) status = weigh(&f);
    if (status == DEM_OK && count_own(&f, "crack") > 0) status = crack(&f);
    if (status == DEM_OK) status = jitter(&f, NULL);
    if (status != DEM_OK) dem_lattice_free(&f.lattice);
    former_free(&f);
    *lattice = f.lattice;
    *out = f.geometry;
    return status;
}
