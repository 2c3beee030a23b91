/* SPDX-License-Identifier: BSD-3-Clause */
#include "body_checks.h"

#include <math.h>
#include <string.h>

#include "body_outline.h"
#include "conditional_keys.h"
#include "copies.h"

static bool has_shape(const schema_instance *group, const char *name)
{
    return schema_is(group, "shape", name);
}

/* ---- checks: keys of a choice ---- */

#define OURS "rectangle, disc, ring, polygon, mask" /* shapes whose lattice is made here */

static const conditional_key body_keys[] = {
    {"size", "rectangle", true},
    {"radius", "disc, ring", true},
    {"inner_radius", "ring", true},
    {"points", "polygon", true},
    {"spacing", OURS, true},
    {"lattice", OURS, false},
    {"diagonal", OURS, false},
    {"outline", "rectangle, disc, ring, polygon", false},
    {"jitter", OURS, false},
    {"material", OURS ", mesh", false},
    {"file", "file, mask, mesh", true},
    {"scale", "mask, mesh", true},
    {"threshold", "mask", false},
    {"invert", "mask", false},
};
static const conditional_key void_keys[] = {
    {"size", "rectangle", true}, {"radius", "disc, ring", true},         {"inner_radius", "ring", true},
    {"points", "polygon", true}, {"angle", "rectangle, polygon", false},
};
static const conditional_key weakness_keys[] = {
    {"centre", "disc, rectangle, ring, polygon", true},
    {"size", "rectangle", true},
    {"radius", "disc, ring", true},
    {"inner_radius", "ring", true},
    {"points", "polyline, polygon", true},
    {"angle", "rectangle, polygon", false},
};
static const conditional_key lattice_keys[] = {{"diagonal", "square", false}, {"outline", "triangular", false}};
static const conditional_key pores_keys[] = {{"mean", "lognormal, normal", true},
                                             {"deviation", "lognormal, normal", true}};

#define COUNT(list) (sizeof(list) / sizeof *(list))

static const conditional_keys body_uses = {"body", "shape", COUNT(body_keys), body_keys};
static const conditional_keys lattice_uses = {"body", "lattice", COUNT(lattice_keys), lattice_keys};
static const conditional_keys void_uses = {"void", "shape", COUNT(void_keys), void_keys};
static const conditional_keys inclusion_uses = {"inclusion", "shape", COUNT(void_keys), void_keys};
static const conditional_keys weakness_uses = {"weakness", "shape", COUNT(weakness_keys), weakness_keys};
static const conditional_keys pores_uses = {"pores", "distribution", COUNT(pores_keys), pores_keys};

/* Whether anything of a body is random. */
static bool draws(const schema_instance *body)
{
    return schema_real(body, "jitter") > 0.0 || schema_real(body, "scatter") > 0.0;
}

void body_checks_drop_unused(schema_deck *groups)
{
    conditional_keys_drop(groups, &body_uses);
    conditional_keys_drop(groups, &lattice_uses);
    conditional_keys_drop(groups, &void_uses);
    conditional_keys_drop(groups, &inclusion_uses);
    conditional_keys_drop(groups, &weakness_uses);
    conditional_keys_drop(groups, &pores_uses);
    for (size_t i = 0; i < groups->n_instances; i++) {
        schema_instance *group = &groups->instances[i];
        if (strcmp(group->group->name, "body") == 0 && !draws(group)) schema_drop(group, "seed");
    }
}

/* ---- checks: points ---- */

/* Pairs, and not too many of them. */
static bool check_points(const schema_instance *group, namelist_errors *errors)
{
    const schema_value *points = schema_value_of(group, "points");
    const char *name = group->group->name;
    const int n = points->count / 2;
    if (points->faulty) return false;
    if (points->count % 2 != 0)
        namelist_errors_add(errors, points->place, "'points' in &%s must be pairs of x and y, got %d values", name,
                            points->count);
    else if (n > DEM_OUTLINE_MAX_POINTS)
        namelist_errors_add(errors, points->place, "'points' in &%s must be at most %d points, got %d", name,
                            DEM_OUTLINE_MAX_POINTS, n);
    return points->count % 2 == 0 && n <= DEM_OUTLINE_MAX_POINTS;
}

/* Of a library's status that is no success. */
static bool report_points(const schema_instance *group, namelist_errors *errors)
{
    namelist_errors_add(errors, schema_place(group, "points"), "'points' in &%s: %s", group->group->name,
                        dem_status_message());
    return false;
}

static bool check_polyline(const schema_instance *group, namelist_errors *errors)
{
    const schema_value *points = schema_value_of(group, "points");
    if (!schema_given(group, "points") || !check_points(group, errors)) return false;
    return dem_points_check(points->reals, points->count / 2) == DEM_OK || report_points(group, errors);
}

static bool check_polygon(const schema_instance *group, namelist_errors *errors)
{
    if (!has_shape(group, "polygon") || !schema_given(group, "points") || !check_points(group, errors)) return false;
    const dem_outline o = body_outline(group);
    const dem_index n = dem_outline_corners(&o); /* without a last point that is the first */
    if (n >= 3) return dem_outline_check(&o) == DEM_OK || report_points(group, errors);
    namelist_errors_add(errors, schema_place(group, "points"), "'points' in &%s must be at least 3 points, got %lld",
                        group->group->name, (long long)n);
    return false;
}

/* ---- checks: sizes, references ---- */

static void check_ring(const schema_instance *group, namelist_errors *errors)
{
    const double *radius = schema_reals(group, "radius"), *inner = schema_reals(group, "inner_radius");
    if (has_shape(group, "ring") && radius != NULL && inner != NULL && inner[0] >= radius[0])
        namelist_errors_add(errors, schema_place(group, "inner_radius"),
                            "'inner_radius' in &%s must be less than 'radius', %g m, got %g m", group->group->name,
                            radius[0], inner[0]);
}

void body_checks_refuse_spacing(const schema_instance *body, const char *what, const double size[2],
                                namelist_errors *errors)
{
    namelist_errors_add(errors, schema_place(body, "spacing"),
                        "'spacing' in &body must not exceed the %s, %g m x %g m, got %g m", what, size[0], size[1],
                        schema_real(body, "spacing"));
}

static void check_spacing(const schema_instance *body, bool sound_polygon, namelist_errors *errors)
{
    const double *size = schema_reals(body, "size"), *radius = schema_reals(body, "radius");
    const double *inner = schema_reals(body, "inner_radius"), spacing = schema_real(body, "spacing");
    const double width = radius != NULL && inner != NULL ? radius[0] - inner[0] : 0.0;
    if (has_shape(body, "rectangle") && size != NULL && (spacing > size[0] || spacing > size[1]))
        body_checks_refuse_spacing(body, "size", size, errors);
    if (has_shape(body, "disc") && radius != NULL && spacing > radius[0])
        namelist_errors_add(errors, schema_place(body, "spacing"),
                            "'spacing' in &body must not exceed the radius, %g m, got %g m", radius[0], spacing);
    if (has_shape(body, "ring") && width > 0.0 && spacing > width)
        namelist_errors_add(errors, schema_place(body, "spacing"),
                            "'spacing' in &body must not exceed the ring's width, %g m, got %g m", width, spacing);
    if (sound_polygon) {
        double box[4];
        const dem_outline o = body_outline(body);
        if (dem_outline_box(&o, box) != DEM_OK) return;
        const double extent[2] = {box[2] - box[0], box[3] - box[1]};
        if (spacing > extent[0] || spacing > extent[1])
            body_checks_refuse_spacing(body, "polygon's extent", extent, errors);
    }
}

static void check_file(const schema_instance *body, namelist_errors *errors)
{
    const char *what = has_shape(body, "mask") ? "an image" : (has_shape(body, "mesh") ? "a mesh" : "a lattice file");
    if (schema_given(body, "file") && schema_text(body, "file")[0] == '\0')
        namelist_errors_add(errors, schema_place(body, "file"), "'file' in &body must name %s, got ''", what);
}

/* The body that a group is for, from 1 in the deck; voids and pores are not for meshes, and nothing is for lattice
 * files. */
static void check_owner(const schema_deck *groups, const schema_instance *group, namelist_errors *errors)
{
    const size_t n = schema_count(groups, "body");
    const double number = schema_real(group, "body");
    const namelist_place place = schema_place(group, "body");
    if (n == 0 || groups->misspelt) return;
    if (number > (double)n) {
        namelist_errors_add(errors, place, "&%s is for body %.0f, but the number of bodies is %zu", group->group->name,
                            number, n);
        return;
    }
    const schema_instance *body = schema_get(groups, "body", (size_t)number - 1);
    const char *name = group->group->name;
    const bool of_mesh = strcmp(name, "void") != 0 && strcmp(name, "pores") != 0;
    if (has_shape(body, "file") || (has_shape(body, "mesh") && !of_mesh))
        namelist_errors_add(errors, place, "&%s is for body %.0f, which is of shape '%s'", group->group->name, number,
                            schema_text(body, "shape"));
}

static void check_pores(const schema_instance *group, namelist_errors *errors)
{
    const double *radius = schema_reals(group, "radius");
    const bool number = schema_given(group, "number"), porosity = schema_given(group, "porosity");
    const bool faulty = schema_value_of(group, "number")->faulty || schema_value_of(group, "porosity")->faulty;
    if (radius != NULL && radius[0] > radius[1])
        namelist_errors_add(errors, schema_place(group, "radius"),
                            "'radius' in &pores must be the smallest, then the largest one, got %g, %g", radius[0],
                            radius[1]);
    if (schema_real(group, "number") > DEM_PORES_MAX)
        namelist_errors_add(errors, schema_place(group, "number"), "'number' in &pores must be at most %d, got %.0f",
                            DEM_PORES_MAX, schema_real(group, "number"));
    if (number && porosity)
        namelist_errors_add(errors, schema_place(group, "porosity"), "'porosity' in &pores does not go with 'number'");
    else if (!number && !porosity && !faulty)
        namelist_errors_add(errors, group->place, "'number' or 'porosity' in &pores must be given");
}

/* Keys that a shape does not use have been reported. */
static void check_lattice(const schema_instance *body, namelist_errors *errors)
{
    if (strstr(OURS, schema_text(body, "shape")) == NULL) return;
    conditional_keys_check(body, &lattice_uses, errors);
}

static void check_seed(const schema_instance *body, namelist_errors *errors)
{
    const bool faulty = schema_value_of(body, "jitter")->faulty || schema_value_of(body, "scatter")->faulty;
    if (schema_given(body, "seed") && !faulty && !draws(body))
        namelist_errors_add(errors, schema_place(body, "seed"),
                            "'seed' in &body is not used without 'jitter' or 'scatter'");
}

static void check_body(const schema_instance *body, namelist_errors *errors)
{
    conditional_keys_check(body, &body_uses, errors);
    check_lattice(body, errors);
    check_seed(body, errors);
    check_ring(body, errors);
    check_spacing(body, check_polygon(body, errors), errors);
    check_file(body, errors);
}

/* Voids, inclusions or weaknesses. */
static void check_holes(const schema_deck *groups, const conditional_keys *table, namelist_errors *errors)
{
    for (size_t k = 0; k < schema_count(groups, table->group); k++) {
        const schema_instance *group = schema_get(groups, table->group, k);
        conditional_keys_check(group, table, errors);
        check_owner(groups, group, errors);
        check_ring(group, errors);
        (void)(has_shape(group, "polyline") ? check_polyline(group, errors) : check_polygon(group, errors));
    }
}

void body_checks_all(const schema_deck *groups, namelist_errors *errors)
{
    copies_check(groups, errors);
    for (size_t k = 0; k < schema_count(groups, "body"); k++) check_body(schema_get(groups, "body", k), errors);
    check_holes(groups, &void_uses, errors);
    check_holes(groups, &inclusion_uses, errors);
    check_holes(groups, &weakness_uses, errors);
    for (size_t k = 0; k < schema_count(groups, "pores"); k++) {
        const schema_instance *group = schema_get(groups, "pores", k);
        conditional_keys_check(group, &pores_uses, errors);
        check_owner(groups, group, errors);
        check_pores(group, errors);
    }
    for (size_t k = 0; k < schema_count(groups, "crack"); k++) {
        check_owner(groups, schema_get(groups, "crack", k), errors);
        (void)check_polyline(schema_get(groups, "crack", k), errors);
    }
}
