/* SPDX-License-Identifier: BSD-3-Clause */
#include "body_geometry.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "area.h"
#include "body_checks.h"
#include "body_outline.h"
#include "crack.h"
#include "enclosed.h"
#include "material.h"
#include "msh.h"
#include "shape.h"

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
    dem_lattice lattice;
    body_geometry geometry;
} former;

/* The k-th group of a name if it is for this body, else NULL. */
static const schema_instance *own(const former *f, const char *name, size_t k)
{
    const schema_instance *group = schema_get(f->groups, name, k);
    return (size_t)schema_real(group, "body") == f->number ? group : NULL;
}

static dem_status add_void(shape *s, const schema_instance *group)
{
    outline hole;
    return body_outline_place(&hole, group) && shape_add_void(s, &hole) ? DEM_OK : DEM_ERROR_MEMORY;
}

static dem_status report_pores(const former *f, const schema_instance *group, const pores_recipe *recipe,
                               pores_status status, const pores *p)
{
    const bool wall_given = schema_given(group, "wall");
    switch (status) {
    case PORES_PLACED:
        return DEM_OK;
    case PORES_MEMORY:
        return DEM_ERROR_MEMORY;
    case PORES_CROWDED:
        namelist_errors_add(f->errors, group->place,
                            "pore %zu of %zu, of radius %g m, finds no place in body %zu with walls of %g m%s; "
                            "take fewer or smaller ones, or a thinner 'wall'",
                            p->n_placed + 1, p->n, p->list[p->n_placed].radius, f->number, recipe->wall,
                            wall_given ? "" : ", the default");
        return DEM_ERROR_MODEL;
    case PORES_TOO_MANY:
        namelist_errors_add(f->errors, schema_place(group, "porosity"),
                            "'porosity' in &pores, %g, needs more than %d pores of such radii in body %zu",
                            schema_real(group, "porosity"), PORES_MAX, f->number);
        return DEM_ERROR_MODEL;
    case PORES_RARE:
    case PORES_UNSOUND:
        namelist_errors_add(f->errors, schema_place(group, "mean"),
                            "'mean' and 'deviation' in &pores, %g m and %g m, give next to no radius from %g m to %g m",
                            recipe->mean, recipe->deviation, recipe->radius_min, recipe->radius_max);
        return DEM_ERROR_MODEL;
    }
    return DEM_ERROR_MODEL;
}

static dem_status add_pores(former *f, shape *s, const schema_instance *group)
{
    const double *radius = schema_reals(group, "radius"), *wall = schema_reals(group, "wall");
    pores_recipe recipe = {.number = (size_t)schema_real(group, "number"),
                           .area = schema_real(group, "porosity") * f->geometry.area,
                           .radius_min = radius[0],
                           .radius_max = radius[1],
                           .distribution = schema_is(group, "distribution", "normal")      ? PORES_NORMAL
                                           : schema_is(group, "distribution", "lognormal") ? PORES_LOGNORMAL
                                                                                           : PORES_UNIFORM,
                           .mean = schema_real(group, "mean"),
                           .deviation = schema_real(group, "deviation"),
                           .wall = wall != NULL ? wall[0] : 2.0 * s->spacing,
                           .seed = (unsigned long)schema_real(group, "seed")};
    pores placed;
    const pores_status drawn = shape_add_pores(s, &placed, &recipe);
    const dem_status status = report_pores(f, group, &recipe, drawn, &placed);
    f->geometry.n_pores += placed.n_placed;
    for (size_t k = 0; k < placed.n_placed; k++)
        f->geometry.pore_area += pi * placed.list[k].radius * placed.list[k].radius;
    free(placed.list);
    return status;
}

static dem_status read_mask(const former *f, shape *s)
{
    char *path = body_geometry_file(f->folder, f->body), fault[IMAGE_FAULT];
    if (path == NULL) return DEM_ERROR_MEMORY;
    const image_status status = mask_read(&s->mask, fault, path, schema_real(f->body, "scale"),
                                          schema_real(f->body, "threshold"), schema_real(f->body, "invert") != 0.0);
    if (status == IMAGE_REFUSED)
        namelist_errors_add(f->errors, schema_place(f->body, "file"), "body %zu: %s:%s", f->number, path, fault);
    free(path);
    if (status != IMAGE_READ) return status == IMAGE_MEMORY ? DEM_ERROR_MEMORY : DEM_ERROR_MODEL;
    s->outline.size[0] = (double)s->mask.width * s->mask.scale;
    s->outline.size[1] = (double)s->mask.height * s->mask.scale;
    s->outline.centre[1] = 0.5 * s->outline.size[1];
    if (s->spacing <= s->outline.size[0] && s->spacing <= s->outline.size[1]) return DEM_OK;
    body_checks_refuse_spacing(f->body, "image", s->outline.size, f->errors);
    return DEM_ERROR_MODEL;
}

/* Outline or mask, voids, pores; the true area. */
static dem_status make_shape(former *f, shape *s)
{
    dem_status status = body_outline_copy(&s->outline, f->body) ? DEM_OK : DEM_ERROR_MEMORY;
    s->spacing = f->geometry.spacing = schema_real(f->body, "spacing");
    s->squares = body_geometry_has_squares(f->body);
    /* Where areas underflow the lattice is left as it is, to be refused for that. */
    s->smooth = schema_is(f->body, "outline", "smooth") && isnormal(s->spacing * s->spacing);
    if (status == DEM_OK && has_shape(f->body, "mask")) status = read_mask(f, s);
    for (size_t k = 0; status == DEM_OK && k < schema_count(f->groups, "void"); k++)
        if (own(f, "void", k) != NULL) status = add_void(s, own(f, "void", k));
    if (status != DEM_OK) return status;
    f->geometry.area = area_of(s);
    if (f->geometry.area < 0.0) return DEM_ERROR_MEMORY;
    for (size_t k = 0; status == DEM_OK && k < schema_count(f->groups, "pores"); k++)
        if (own(f, "pores", k) != NULL) status = add_pores(f, s, own(f, "pores", k));
    f->geometry.area -= f->geometry.pore_area;
    return status;
}

/* A void that takes nothing is a fault where it is not in the body at all; one between nodes is only small. */
static dem_status check_voids(const former *f, const shape *s)
{
    dem_status status = DEM_OK;
    size_t v = 0; /* the voids of a shape begin with those of its groups */
    for (size_t k = 0; k < schema_count(f->groups, "void"); k++) {
        if (own(f, "void", k) == NULL) continue;
        const outline *hole = &s->voids[v++];
        const double *inside = hole->kind == OUTLINE_POLYGON ? hole->points : hole->centre;
        if (shape_outline_has(s, inside) || shape_takes(s, hole, &f->lattice)) continue;
        namelist_errors_add(f->errors, schema_place(own(f, "void", k), "centre"),
                            "void takes no node of body %zu: its centre is in the body's own coordinates", f->number);
        status = DEM_ERROR_MODEL;
    }
    return status;
}

/* ---- numbers ---- */

/* Triangles have no strength yet; what is written there goes along with those that stay. Doubles hold them exactly. */
static dem_status number_triangles(dem_lattice *lattice)
{
    lattice->strength = calloc((size_t)lattice->n_triangles + 1, sizeof *lattice->strength);
    for (dem_index t = 0; lattice->strength != NULL && t < lattice->n_triangles; t++) lattice->strength[t] = (double)t;
    return lattice->strength != NULL ? DEM_OK : DEM_ERROR_MEMORY;
}

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

static dem_status cut_lattice(former *f, const shape *s)
{
    dem_status status = shape_mesh(&f->lattice, s);
    if (status == DEM_ERROR_MODEL)
        namelist_errors_add(f->errors, schema_place(f->body, "spacing"),
                            "body %zu would have more nodes than 2^40 with the spacing %g m", f->number, s->spacing);
    if (status == DEM_OK) status = number_triangles(&f->lattice);
    if (status == DEM_OK) status = check_voids(f, s);
    if (status != DEM_OK) return status;
    const dem_index n = f->lattice.n_nodes;
    status = s->smooth ? smoothing_apply(&f->geometry.smoothing, &f->lattice, s) : shape_cut(&f->lattice, s);
    if (status == DEM_ERROR_MODEL)
        namelist_errors_add(f->errors, f->body->place,
                            "body %zu: its outline, voids and pores leave none of %lld nodes%s", f->number,
                            (long long)n, body_geometry_hint(f->body));
    return status;
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
    char *path = body_geometry_file(f->folder, f->body), fault[MSH_FAULT];
    if (path == NULL) return DEM_ERROR_MEMORY;
    const dem_status status = msh_read(&f->lattice, fault, path);
    if (status == DEM_ERROR_MODEL)
        namelist_errors_add(f->errors, schema_place(f->body, "file"), "body %zu: %s:%s", f->number, path, fault);
    free(path);
    if (status != DEM_OK) return status;
    for (dem_index k = 0; k < 2 * f->lattice.n_nodes; k++) f->lattice.x[k] *= schema_real(f->body, "scale");
    double least = (double)INFINITY;
    for (dem_index t = 0; t < f->lattice.n_triangles; t++) {
        const double area = area_of_triangle(&f->lattice, t);
        least = fmin(least, area);
        f->geometry.area += area;
    }
    f->geometry.spacing = sqrt(least / 0.43301270189221932); /* sqrt(3)/4 */
    return number_triangles(&f->lattice);
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

void body_geometry_materials(dem_material *out, const schema_deck *groups, size_t k)
{
    const former f = {.groups = groups, .number = k + 1};
    size_t n = 1;
    out[0] = material_of(groups, schema_get(groups, "body", k));
    for (size_t i = 0; i < schema_count(groups, "inclusion"); i++)
        if (own(&f, "inclusion", i) != NULL) out[n++] = material_of(groups, own(&f, "inclusion", i));
    /* The material may be one of triangles, too. */
    for (size_t i = 0; i < n && body_geometry_has_squares(schema_get(groups, "body", k)); i++)
        out[i].springs = DEM_SPRINGS_INDEPENDENT;
}

dem_status body_geometry_mark(dem_index *of, const dem_lattice *lattice, const schema_deck *groups, size_t k,
                              namelist_errors *errors)
{
    const former f = {.groups = groups, .body = schema_get(groups, "body", k), .number = k + 1};
    dem_index material = 0;
    for (dem_index t = 0; t < lattice->n_triangles; t++) of[t] = 0;
    for (size_t i = 0; i < schema_count(groups, "inclusion"); i++) {
        const schema_instance *group = own(&f, "inclusion", i);
        outline o;
        if (group == NULL) continue;
        if (!body_outline_place(&o, group)) return DEM_ERROR_MEMORY;
        const dem_index n = enclosed_triangles(of, lattice, &o, ++material, body_geometry_has_squares(f.body) ? 2 : 1);
        outline_free(&o);
        if (n > 0) continue;
        namelist_errors_add(errors, schema_place(group, "centre"),
                            "inclusion has no triangle of body %zu: its centre is in the body's own coordinates",
                            f.number);
        return DEM_ERROR_MODEL;
    }
    return DEM_OK;
}

static double weight_of(const dem_material *m)
{
    return m->density * m->thickness;
}

/* The area of an inclusion is what is missing when it is a void; the last one goes before the others. */
static dem_status weigh_shape(former *f, shape *s, const dem_material *materials)
{
    const double body = weight_of(&materials[0]);
    double area = f->geometry.n_inclusions > 0 ? area_of(s) : 0.0;
    size_t material = f->geometry.n_inclusions;
    f->geometry.mass = body * f->geometry.area;
    for (size_t i = schema_count(f->groups, "inclusion"); area >= 0.0 && i-- > 0;) {
        if (own(f, "inclusion", i) == NULL) continue;
        if (add_void(s, own(f, "inclusion", i)) != DEM_OK) return DEM_ERROR_MEMORY;
        const double without = area_of(s);
        if (without >= 0.0) f->geometry.mass += (weight_of(&materials[material--]) - body) * (area - without);
        area = without;
    }
    return area < 0.0 ? DEM_ERROR_MEMORY : DEM_OK;
}

static dem_status weigh_mesh(former *f, const dem_material *materials)
{
    dem_index *of = calloc((size_t)f->lattice.n_triangles, sizeof *of);
    if (of == NULL) return DEM_ERROR_MEMORY;
    const dem_status status = body_geometry_mark(of, &f->lattice, f->groups, f->number - 1, f->errors);
    for (dem_index t = 0; status == DEM_OK && t < f->lattice.n_triangles; t++)
        f->geometry.mass += weight_of(&materials[of[t]]) * area_of_triangle(&f->lattice, t);
    free(of);
    return status;
}

/* The true mass; the shape is not to be used after that. */
static dem_status weigh(former *f, shape *s)
{
    for (size_t i = 0; i < schema_count(f->groups, "inclusion"); i++)
        f->geometry.n_inclusions += own(f, "inclusion", i) != NULL;
    dem_material *materials = calloc(f->geometry.n_inclusions + 1, sizeof *materials);
    if (materials == NULL) return DEM_ERROR_MEMORY;
    body_geometry_materials(materials, f->groups, f->number - 1);
    const dem_status status = has_shape(f->body, "mesh") ? weigh_mesh(f, materials) : weigh_shape(f, s, materials);
    free(materials);
    return status;
}

/* ---- cracks ---- */

static dem_status mark_crack(const former *f, bool *keep, const schema_instance *group, double shift)
{
    const schema_value *points = schema_value_of(group, "points");
    const dem_index n = crack_mark(keep, &f->lattice, points->reals, (size_t)points->count / 2, shift);
    if (n < 0) return DEM_ERROR_MEMORY;
    if (n > 0) return DEM_OK;
    namelist_errors_add(f->errors, points->place,
                        "crack crosses no triangle of body %zu: its points are in the body's own coordinates",
                        f->number);
    return DEM_ERROR_MODEL;
}

static bool has_cracks(const former *f)
{
    for (size_t k = 0; k < schema_count(f->groups, "crack"); k++)
        if (own(f, "crack", k) != NULL) return true;
    return false;
}

static dem_status crack(former *f)
{
    const double shift = CRACK_ASIDE * f->geometry.spacing;
    const dem_index n = f->lattice.n_triangles;
    bool *keep = malloc((size_t)n + 1);
    dem_status status = DEM_OK;
    if (keep == NULL) return DEM_ERROR_MEMORY;
    memset(keep, 1, (size_t)n + 1);
    for (size_t k = 0; status == DEM_OK && k < schema_count(f->groups, "crack"); k++)
        if (own(f, "crack", k) != NULL) status = mark_crack(f, keep, own(f, "crack", k), shift);
    if (body_geometry_has_squares(f->body)) shape_keep_cells(keep, n);
    if (status == DEM_OK) {
        status = dem_lattice_trim(&f->lattice, keep);
        if (status == DEM_ERROR_MODEL)
            namelist_errors_add(f->errors, f->body->place, "body %zu: its cracks leave none of %lld triangles",
                                f->number, (long long)n);
    }
    f->geometry.n_cracked = n - f->lattice.n_triangles;
    free(keep);
    return status;
}

/* ---- all of it ---- */

static dem_status jitter(former *f)
{
    const double share = schema_real(f->body, "jitter");
    if (share == 0.0) return DEM_OK;
    const dem_status status =
        dem_lattice_jitter(&f->lattice, share * f->geometry.spacing, (uint64_t)schema_real(f->body, "seed"));
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

dem_status body_geometry_triangulate(dem_lattice *lattice, body_geometry *out, const schema_deck *groups, size_t k,
                                     const char *folder, namelist_errors *errors)
{
    former f = {
        .groups = groups, .body = schema_get(groups, "body", k), .number = k + 1, .folder = folder, .errors = errors};
    shape s = {0};
    f.lattice = dem_lattice_empty();
    dem_status status = DEM_OK;
    if (has_shape(f.body, "mesh")) {
        status = read_mesh(&f);
    } else {
        status = make_shape(&f, &s);
        if (status == DEM_OK) status = cut_lattice(&f, &s);
    }
    if (status == DEM_OK) status = weigh(&f, &s);
    if (status == DEM_OK && has_cracks(&f)) status = crack(&f);
    if (status == DEM_OK) status = jitter(&f);
    if (status != DEM_OK) dem_lattice_free(&f.lattice);
    shape_free(&s);
    *lattice = f.lattice;
    *out = f.geometry;
    return status;
}
