/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies: checks of their groups, then geometry or file, parts, place, clearance, velocity. */
#include "body.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <dem/shape.h>
#include <dem/trajectory.h>

#include "angle.h"
#include "body_checks.h"
#include "copies.h"
#include "material.h"
#include "rigid_keys.h"
#include "slab_nodes.h"
#include "weibull_keys.h"

static const double lost = 1e-6; /* of the spacing: the default penetration tolerance, which rounding must not hide */

static namelist_place place_of(const schema_instance *group, const char *key)
{
    return schema_value_of(group, key)->place;
}

static bool is_given(const schema_instance *group, const char *key)
{
    return schema_value_of(group, key)->given;
}

static const double *reals_of(const schema_instance *group, const char *key)
{
    return schema_value_of(group, key)->reals;
}

static bool has_shape(const schema_instance *group, const char *name)
{
    return strcmp(schema_text(group, "shape"), name) == 0;
}

/* ---- checks ---- */

/* Only lattice files come with springs and masses of their own. */
static void check_materials(const schema_deck *groups, namelist_errors *errors)
{
    bool needed = false;
    for (size_t k = 0; k < schema_count(groups, "body"); k++) {
        const schema_instance *body = schema_get(groups, "body", k);
        needed = needed || (schema_text(body, "shape")[0] != '\0' && !has_shape(body, "file"));
        if (!has_shape(body, "file")) material_check_user(groups, body, errors);
    }
    for (size_t k = 0; k < schema_count(groups, "inclusion"); k++)
        material_check_user(groups, schema_get(groups, "inclusion", k), errors);
    if (needed && schema_count(groups, "material") == 0 && !groups->misspelt)
        namelist_errors_add(errors, (namelist_place){1, 1}, "&material must be given");
}

static bool has_equal_springs(const schema_deck *groups, const schema_instance *body)
{
    const schema_instance *material = material_find(groups, schema_text(body, "material"));
    return material != NULL && is_given(material, "bond_stiffness");
}

static void check_diagonal(const schema_deck *groups, const schema_instance *body, namelist_errors *errors)
{
    if (is_given(body, "diagonal") && has_equal_springs(groups, body))
        namelist_errors_add(errors, place_of(body, "diagonal"),
                            "'diagonal' in &body is not used with the 'bond_stiffness' of its material");
}

/* Whether a &body or &inclusion is of a material, and its cells are squares (1) or triangles (2). */
static int cells_of(const schema_deck *groups, const schema_instance *user, const schema_instance *material)
{
    const bool inclusion = strcmp(user->group->name, "inclusion") == 0;
    const size_t k = inclusion ? (size_t)schema_real(user, "body") : 0, n = schema_count(groups, "body");
    if (!schema_is(user, "material", schema_text(material, "name")) || (inclusion && (k < 1 || k > n))) return 0;
    return body_geometry_has_squares(inclusion ? schema_get(groups, "body", k - 1) : user) ? 1 : 2;
}

/* Whether all that is of a material has squares, whose springs are independent. */
static bool is_of_squares(const schema_deck *groups, const schema_instance *material)
{
    int cells = 0;
    for (size_t k = 0; k < schema_count(groups, "body"); k++)
        cells |= cells_of(groups, schema_get(groups, "body", k), material);
    for (size_t k = 0; k < schema_count(groups, "inclusion"); k++)
        cells |= cells_of(groups, schema_get(groups, "inclusion", k), material);
    return cells == 1;
}

static void check_springs(const schema_deck *groups, namelist_errors *errors)
{
    for (size_t k = 0; k < schema_count(groups, "material"); k++) {
        const schema_instance *material = schema_get(groups, "material", k);
        if (is_given(material, "springs") && is_of_squares(groups, material))
            namelist_errors_add(errors, place_of(material, "springs"),
                                "'springs' in &material is not used by bodies of squares");
    }
}

static void check_clearance(const schema_deck *groups, const schema_instance *body, namelist_errors *errors)
{
    const double *gravity = reals_of(schema_get(groups, "run", 0), "gravity");
    const namelist_place place = place_of(body, "clearance");
    if (!is_given(body, "clearance")) return;
    if (schema_count(groups, "obstacle") == 0)
        namelist_errors_add(errors, place, "'clearance' in &body needs an &obstacle");
    if (gravity[0] == 0.0 && gravity[1] == 0.0)
        namelist_errors_add(errors, place, "'clearance' in &body needs gravity, which is 0");
}

/* ---- building ---- */

/* A body on its way. What works on it returns DEM_OK, DEM_ERROR_MEMORY, or another status after reporting a fault. */
typedef struct builder {
    const body_scene *scene;
    const schema_instance *body;
    size_t number; /* from 1 */
    namelist_errors *errors;
    dem_lattice lattice;
    bool is_strip; /* of a body that is not here */
    body_facts facts;
    body_start start;
} builder;

/* Passes a status on; one that speaks of a fault is reported with the library's message. */
static dem_status report(const builder *b, dem_status status, const char *key)
{
    if (status != DEM_OK && status != DEM_ERROR_MEMORY)
        namelist_errors_add(b->errors, place_of(b->body, key), "body %zu: %s", b->number, dem_status_message());
    return status;
}

/* What is wrong with a number that cannot be computed with; NULL if it can. */
static const char *fault_of(double x)
{
    return isnormal(x) ? NULL : (x < 1.0 ? "too small" : "too large");
}

/* Whether an equilateral triangle has an area, a mass and a stiffness to compute with. */
static dem_status check_scales(const builder *b, const dem_material *m)
{
    const char *key = has_shape(b->body, "mesh") ? "scale" : "spacing";
    const double spacing = b->facts.geometry.spacing, area = 0.43301270189221932 * spacing * spacing;
    const double mass = m->density * m->thickness * area / 3.0;
    const double stiffness = m->bond_stiffness > 0.0 ? m->bond_stiffness : m->youngs_modulus * m->thickness * spacing;
    const double damping = m->damping_time * stiffness / (mass * spacing);
    if (fault_of(area) != NULL)
        namelist_errors_add(b->errors, place_of(b->body, key),
                            "body %zu: the area of a triangle, %g m^2, is %s; its sides are %g m", b->number, area,
                            fault_of(area), spacing);
    else if (fault_of(mass) != NULL)
        namelist_errors_add(
            b->errors, place_of(b->body, "material"),
            "body %zu: the mass of a node, %g kg, is %s; density %g kg/m^3, thickness %g m, spacing %g m", b->number,
            mass, fault_of(mass), m->density, m->thickness, spacing);
    else if (fault_of(stiffness) != NULL && m->bond_stiffness > 0.0)
        namelist_errors_add(b->errors, place_of(b->body, "material"),
                            "body %zu: the stiffness of a spring, %g N, is %s", b->number, stiffness,
                            fault_of(stiffness));
    else if (fault_of(stiffness) != NULL)
        namelist_errors_add(b->errors, place_of(b->body, "material"),
                            "body %zu: the stiffness of a spring, %g N, is %s; Young's modulus %g Pa, thickness %g m, "
                            "spacing %g m",
                            b->number, stiffness, fault_of(stiffness), m->youngs_modulus, m->thickness, spacing);
    else if (!isfinite(damping * damping))
        namelist_errors_add(b->errors, place_of(b->body, "material"),
                            "body %zu: the damping of a spring, %g 1/s, is too large; damping_time %g s", b->number,
                            damping, m->damping_time);
    else
        return DEM_OK;
    return DEM_ERROR_MODEL;
}

/* ---- parts ---- */

static void report_parts(const builder *b)
{
    const bool triangles = b->lattice.n_springs == 0, one = b->facts.loose.n == 1;
    char list[PARTS_LIST];
    parts_print(list, &b->facts.loose, triangles ? "triangle" : "node");
    namelist_errors_add(b->errors, place_of(b->body, "disconnected"),
                        "body %zu has %lld part%s that %s its largest, of %s m in its own coordinates; 'disconnected' "
                        "can remove or keep such parts%s",
                        b->number, (long long)b->facts.loose.n, one ? "" : "s",
                        !triangles ? "no spring connects to" : (one ? "shares no edge with" : "share no edge with"),
                        list, body_geometry_hint(b->body));
}

/* Of a triangulation what shares edges, of a solid what springs connect. */
static dem_status settle_parts(builder *b)
{
    const bool triangles = b->lattice.n_springs == 0, refuse = schema_is(b->body, "disconnected", "refuse");
    const bool remove = schema_is(b->body, "disconnected", "remove");
    bool *kept = calloc((size_t)(triangles ? b->lattice.n_triangles : b->lattice.n_nodes) + 1, sizeof *kept);
    if (kept == NULL) return DEM_ERROR_MEMORY;
    dem_status status = parts_find(&b->facts.loose, kept, &b->lattice);
    b->facts.removed = remove;
    if (status == DEM_OK && b->facts.loose.n > 0 && remove) {
        status = triangles ? dem_lattice_trim(&b->lattice, kept) : dem_lattice_select(&b->lattice, kept);
    } else if (status == DEM_OK && b->facts.loose.n > 0 && refuse) {
        report_parts(b);
        status = DEM_ERROR_MODEL;
    }
    free(kept);
    return status == DEM_OK ? parts_find_hinges(&b->facts.hinges, &b->lattice) : status;
}

/* ---- shape, material ---- */

/* Of squares; 0 for triangles. Equal springs know of none. */
static double diagonal_of(const schema_instance *body)
{
    if (!body_geometry_has_squares(body)) return 0.0;
    const double *diagonal = reals_of(body, "diagonal");
    return diagonal != NULL ? diagonal[0] : 0.5;
}

/* `of` has the materials of the triangles. */
static dem_status weaken(builder *b, const dem_index *of)
{
    const weakness_body body = {.groups = b->scene->groups,
                                .k = b->number - 1,
                                .spacing = b->facts.geometry.spacing,
                                .n_inclusions = b->facts.geometry.n_inclusions,
                                .of = of};
    return weakness_apply(&b->facts.weak, &b->lattice, &body, b->errors);
}

/* By the numbers of the triangles. */
static dem_status draw_strengths(builder *b, const dem_index *of, const dem_index *numbers)
{
    const size_t n = b->facts.geometry.n_inclusions + 1;
    dem_weibull *laws = calloc(n, sizeof *laws);
    if (laws == NULL) return DEM_ERROR_MEMORY;
    for (size_t k = 0; k < n; k++) {
        laws[k] = weibull_keys_law(b->scene->groups, body_geometry_user(b->scene->groups, b->number - 1, k));
        laws[k].number = numbers;
    }
    const strengths_rule rule = {
        .laws = laws, .n_laws = (dem_index)n, .of = of, .body = b->number - 1, .n_copies = copies_count(b->body)};
    const dem_status status = report(b, strengths_draw(&b->facts.strengths, &b->lattice, &rule), "material");
    free(laws);
    return status;
}

/* Of the body's material and those of its inclusions. `of` has those of the triangles. */
static dem_status make_springs(builder *b, const dem_index *of)
{
    const size_t n = b->facts.geometry.n_inclusions + 1;
    dem_material *materials = calloc(n, sizeof *materials);
    if (materials == NULL) return DEM_ERROR_MEMORY;
    body_geometry_materials(materials, b->scene->groups, b->number - 1);
    b->facts.plane = materials[0].plane;
    dem_status status = DEM_OK;
    for (size_t k = 0; status == DEM_OK && k < n; k++) status = check_scales(b, &materials[k]);
    if (status == DEM_OK)
        status = report(b, dem_lattice_assemble_mixed(&b->lattice, materials, (dem_index)n, of, diagonal_of(b->body)),
                        body_geometry_has_squares(b->body) ? "diagonal" : "material");
    free(materials);
    return status;
}

static dem_status assemble(builder *b)
{
    dem_index *of = calloc((size_t)b->lattice.n_triangles, sizeof *of);
    dem_index *numbers = body_geometry_take_numbers(&b->lattice);
    dem_status status = of != NULL && numbers != NULL ? DEM_OK : DEM_ERROR_MEMORY;
    if (status == DEM_OK)
        status = body_geometry_mark(of, NULL, &b->lattice, b->scene->groups, b->number - 1, b->errors);
    if (status == DEM_OK) status = make_springs(b, of);
    for (dem_index t = 0; status == DEM_OK && t < b->lattice.n_triangles; t++) b->facts.n_included += of[t] > 0;
    if (status == DEM_OK) status = weaken(b, of);
    if (status == DEM_OK) status = draw_strengths(b, of, numbers);
    free(of);
    free(numbers);
    return status;
}

static dem_status make_mesh(builder *b)
{
    const body_scene *scene = b->scene;
    dem_status status = body_geometry_triangulate(&b->lattice, &b->facts.geometry, scene->groups, b->number - 1,
                                                  scene->folder, b->errors);
    if (status == DEM_OK) status = settle_parts(b);
    if (status == DEM_OK) status = assemble(b);
    b->facts.true_mass = b->facts.geometry.mass;
    if (status == DEM_OK) status = dem_lattice_least_angle(&b->lattice, &b->facts.least_angle);
    b->facts.least_angle /= angle_degree;
    return status;
}

static dem_status read_file(builder *b)
{
    char *path = body_geometry_file(b->scene->folder, b->body);
    if (path == NULL) return DEM_ERROR_MEMORY;
    const dem_status status = dem_lattice_read(&b->lattice, path);
    if (status == DEM_ERROR_IO && strstr(dem_status_message(), "file signature not found") != NULL)
        namelist_errors_add(b->errors, place_of(b->body, "file"), "body %zu: %s: is not an HDF5 file", b->number, path);
    else
        (void)report(b, status, "file");
    free(path);
    return status == DEM_OK ? settle_parts(b) : status;
}

/* ---- place and velocity ---- */

static const char reversed[] = "or reverse the obstacle's points: bodies live on the left of each segment";

static dem_status clear(builder *b, const dem_model *model)
{
    double shift[2];
    bool reached;
    const clearance_body body = {model, &b->lattice, b->is_strip};
    if (!clearance_shift(shift, &reached, &body, b->scene->gravity, schema_real(b->body, "clearance")))
        return DEM_ERROR_MEMORY;
    if (!reached) {
        namelist_errors_add(
            b->errors, place_of(b->body, "clearance"),
            "'clearance' in &body cannot be reached: along gravity there is no obstacle below body %zu; "
            "move it, %s",
            b->number, reversed);
        return DEM_ERROR_MODEL;
    }
    dem_lattice_move(&b->lattice, 0.0, shift);
    for (int c = 0; c < 2; c++) b->start.offset[c] += shift[c];
    memcpy(b->start.shift, shift, sizeof shift);
    return DEM_OK;
}

/* Where the body is now: `model` knows the obstacles, and which nodes may touch, but not that the body was moved. */
static void measure_start(builder *b, const dem_model *model)
{
    const dem_lattice *lattice = dem_model_lattice(model);
    const double *places = b->lattice.position != NULL ? b->lattice.position : b->lattice.x;
    b->start.depth = -(double)INFINITY;
    b->start.rest_length = lattice->n_springs > 0 ? dem_model_spacing(model) : (double)INFINITY;
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        if ((lattice->flags[i] & (DEM_NODE_CONTACT | DEM_NODE_FIXED)) != DEM_NODE_CONTACT) continue;
        const double *x = places + 2 * i, depth = -dem_model_gap(model, x);
        if (depth <= b->start.depth) continue;
        b->start.depth = depth;
        b->start.x[0] = x[0], b->start.x[1] = x[1];
    }
}

/* Whether a body is where its shape survives rounding. */
static dem_status check_place(const builder *b, const char *key)
{
    double largest = 0.0, least = (double)INFINITY;
    for (dem_index k = 0; k < 2 * b->lattice.n_nodes; k++) largest = fmax(largest, fabs(b->lattice.x[k]));
    for (dem_index k = 0; k < b->lattice.n_springs; k++) least = fmin(least, b->lattice.rest_length[k]);
    if (largest * DBL_EPSILON <= lost * least || !isfinite(largest) || !(least > 0.0)) return DEM_OK; /* or no model */
    namelist_errors_add(b->errors, place_of(b->body, key),
                        "body %zu has coordinates of up to %g m, so large that rounding blurs its spacing of %g m",
                        b->number, largest, least);
    return DEM_ERROR_MODEL;
}

/* Meets the obstacles where the body is: its clearance, and how deep it starts. */
static dem_status face(builder *b)
{
    const bool file = has_shape(b->body, "file"), cleared = is_given(b->body, "clearance");
    const body_scene *scene = b->scene;
    dem_model *model = NULL;
    dem_status status = report(b, dem_model_create_borrowing(&model, &b->lattice, scene->obstacles, scene->n_obstacles),
                               file ? "file" : "shape");
    if (status == DEM_OK && cleared) status = clear(b, model);
    if (status == DEM_OK && cleared) status = check_place(b, "clearance");
    if (status == DEM_OK) measure_start(b, model);
    const clearance_body body = {model, &b->lattice, b->is_strip};
    if (status == DEM_OK && !clearance_find_pierced(&b->start.pierced, &body)) status = DEM_ERROR_MEMORY;
    dem_model_destroy(model);
    if (status == DEM_OK && !clearance_find_spike(&b->start.spike, &body, scene->obstacles, scene->n_obstacles))
        status = DEM_ERROR_MEMORY;
    return status;
}

dem_status body_put(dem_lattice *lattice, const schema_instance *body, const double *centre)
{
    const double spin = schema_real(body, "spin");
    dem_lattice_move(lattice, angle_degree * schema_real(body, "angle"), reals_of(body, "position"));
    const dem_status status = dem_lattice_launch(lattice, reals_of(body, "velocity"));
    if (status != DEM_OK) return status;
    return centre != NULL ? dem_lattice_spin_about(lattice, spin, centre) : dem_lattice_spin(lattice, spin);
}

/* `centre` as body_put() has it. */
static dem_status put(builder *b, const double *centre)
{
    b->start.angle = angle_degree * schema_real(b->body, "angle");
    for (int c = 0; c < 2; c++) b->start.offset[c] = reals_of(b->body, "position")[c];
    dem_status status = report(b, body_put(&b->lattice, b->body, centre), "velocity");
    if (status == DEM_OK) status = check_place(b, "position");
    return status == DEM_OK ? face(b) : status;
}

bool body_put_copy(dem_lattice *lattice, double offset[2], const schema_instance *body, size_t k)
{
    const double *position = reals_of(body, "position");
    double shift[2], way[2];
    if (!copies_shift(shift, body, k)) return false;
    for (int c = 0; c < 2; c++) way[c] = position[c] + shift[c] - offset[c];
    for (int c = 0; c < 2; c++) offset[c] += way[c];
    dem_lattice_move(lattice, 0.0, way);
    return true;
}

static dem_status put_copy(builder *b, size_t k)
{
    if (!body_put_copy(&b->lattice, b->start.offset, b->body, k)) return DEM_ERROR_MEMORY;
    const dem_status status = check_place(b, "pitch");
    return status == DEM_OK ? face(b) : status;
}

/* The obstacle, from 1, that has x deepest inside; 0 when memory runs out. */
static dem_index find_obstacle(const body_scene *scene, const double x[2])
{
    double place[2] = {x[0], x[1]}, mass = 1.0, least = (double)INFINITY;
    dem_index deepest = 0;
    dem_lattice point = dem_lattice_empty();
    point.n_nodes = 1, point.x = place, point.mass = &mass;
    for (dem_index k = 0; k < scene->n_obstacles; k++) {
        dem_model *model;
        if (dem_model_create(&model, &point, scene->obstacles + k, 1) != DEM_OK) return 0;
        const double gap = dem_model_gap(model, x);
        dem_model_destroy(model);
        if (gap < least) deepest = k + 1;
        least = fmin(least, gap);
    }
    return deepest;
}

bool body_check_start(const body_scene *scene, size_t k, const body_start *start, double penetration_tolerance,
                      namelist_errors *errors)
{
    const clearance_spike *spike = &start->spike;
    const clearance_pierced *pierced = &start->pierced;
    const schema_instance *body = schema_get(scene->groups, "body", k);
    const namelist_place place = body->place;
    char copy[48] = "";
    if (copies_count(body) > 1) (void)snprintf(copy, sizeof copy, " (copy %zu)", start->copy + 1);
    if (start->depth > penetration_tolerance) {
        const dem_index obstacle = find_obstacle(scene, start->x);
        namelist_errors_add(errors, place,
                            "body %zu%s starts %g m inside obstacle %lld, at (%g, %g) m, deeper than the penetration "
                            "tolerance of %g m; "
                            "'position' or 'clearance' can put it in front, %s",
                            k + 1, copy, start->depth, (long long)obstacle, start->x[0], start->x[1],
                            penetration_tolerance, reversed);
        return obstacle > 0;
    }
    if (spike->depth > penetration_tolerance) {
        namelist_errors_add(
            errors, place,
            "body %zu%s starts with point %lld of obstacle %lld, at (%g, %g) m, %g m inside it between "
            "its nodes, deeper than the penetration tolerance of %g m; 'position' or 'clearance' can put it "
            "in front",
            k + 1, copy, (long long)spike->point + 1, (long long)spike->obstacle + 1, spike->x[0], spike->x[1],
            spike->depth, penetration_tolerance);
        return true;
    }
    if (pierced->depth > penetration_tolerance)
        namelist_errors_add(errors, place,
                            "body %zu%s starts with obstacle %lld, after its point %lld, through its side at (%g, %g) "
                            "m, %g m deep, more than the penetration tolerance of %g m; 'position' or 'clearance' can "
                            "put it in front",
                            k + 1, copy, (long long)pierced->obstacle + 1, (long long)pierced->point + 1, pierced->x[0],
                            pierced->x[1], pierced->depth, penetration_tolerance);
    return true;
}

void body_drop_unused(schema_deck *groups)
{
    body_checks_drop_unused(groups);
    material_drop_unused(groups);
    rigid_keys_drop_unused(groups);
    weibull_keys_drop_unused(groups);
    for (size_t i = 0; i < groups->n_instances; i++) {
        schema_instance *group = &groups->instances[i];
        if (strcmp(group->group->name, "body") == 0 && has_equal_springs(groups, group)) schema_drop(group, "diagonal");
        if (strcmp(group->group->name, "material") == 0 && is_of_squares(groups, group)) schema_drop(group, "springs");
    }
}

bool body_settle_outlines(schema_deck *groups)
{
    for (size_t i = 0; i < groups->n_instances; i++) {
        schema_instance *body = &groups->instances[i];
        const bool by_default = strcmp(body->group->name, "body") == 0 && !is_given(body, "outline") &&
                                schema_text(body, "outline")[0] != '\0';
        if (!by_default) continue;
        const schema_instance *material = material_find(groups, schema_text(body, "material"));
        const bool coupled = material != NULL && schema_is(material, "springs", "coupled");
        if (!coupled && !schema_set_text(body, "outline", "lattice")) return false;
    }
    return true;
}

void body_check_all(const schema_deck *groups, namelist_errors *errors)
{
    body_checks_all(groups, errors);
    material_check_all(groups, errors);
    rigid_keys_check(groups, errors);
    weibull_keys_check(groups, errors);
    check_materials(groups, errors);
    check_springs(groups, errors);
    for (size_t k = 0; k < schema_count(groups, "body"); k++) {
        const schema_instance *body = schema_get(groups, "body", k);
        check_diagonal(groups, body, errors);
        check_clearance(groups, body, errors);
    }
}

static builder begin(const body_scene *scene, size_t k, namelist_errors *errors)
{
    const double none = (double)INFINITY;
    builder b = {.scene = scene,
                 .body = schema_get(scene->groups, "body", k),
                 .number = k + 1,
                 .errors = errors,
                 .start = {.depth = -none, .rest_length = none}};
    b.lattice = dem_lattice_empty();
    return b;
}

/* Makes it rigid if it is to be: without a surface it would touch nothing. */
static dem_status stiffen(builder *b)
{
    if (!rigid_keys_ask(b->body) || b->lattice.n_triangles > 0)
        return report(b, rigid_keys_apply(&b->lattice, b->body), "rigid");
    namelist_errors_add(b->errors, place_of(b->body, "rigid"),
                        "'rigid' in &body: body %zu has no triangles, and so no surface that could touch anything",
                        b->number);
    return DEM_ERROR_MODEL;
}

bool body_build(dem_lattice *out, body_facts *facts, body_start *start, const body_scene *scene, size_t k,
                namelist_errors *errors)
{
    builder b = begin(scene, k, errors);
    dem_status status = has_shape(b.body, "file") ? read_file(&b) : make_mesh(&b);
    if (status == DEM_OK) status = stiffen(&b);
    if (status == DEM_OK) status = put(&b, NULL);
    if (status == DEM_OK && copies_count(b.body) > 1) status = put_copy(&b, 0);
    for (dem_index i = 0; status == DEM_OK && i < b.lattice.n_nodes; i++) b.facts.mass += b.lattice.mass[i];
    if (status != DEM_OK) dem_lattice_free(&b.lattice);
    if (status != DEM_OK) strengths_free(&b.facts.strengths);
    b.facts.further = copies_count(b.body) - 1;
    *out = b.lattice;
    *facts = b.facts;
    *start = b.start;
    return status != DEM_ERROR_MEMORY;
}

static void count_included(body_inclusions *found, const dem_slab *slab, const dem_index *of)
{
    for (dem_index t = 0; t < slab->lattice.n_triangles; t++)
        found->n_triangles += of[t] > 0 && slab_nodes_owns(slab, slab->lattice.triangles + 3 * t, 3);
}

dem_status body_assemble_slab(dem_slab *slab, body_inclusions *found, const body_scene *scene, size_t k,
                              namelist_errors *errors)
{
    builder b = begin(scene, k, errors);
    if (has_shape(b.body, "file")) return DEM_OK;
    dem_index *of = calloc((size_t)slab->lattice.n_triangles + 1, sizeof *of);
    if (found->is_met == NULL) found->is_met = calloc(found->n + 1, sizeof *found->is_met);
    if (of == NULL || found->is_met == NULL) {
        free(of);
        return DEM_ERROR_MEMORY;
    }
    b.lattice = slab->lattice;
    b.facts.geometry = (body_geometry){.spacing = schema_real(b.body, "spacing"), .n_inclusions = found->n};
    dem_status status = body_geometry_mark(of, found->is_met, &b.lattice, scene->groups, k, errors);
    if (status == DEM_OK) status = make_springs(&b, of);
    if (status == DEM_OK) count_included(found, slab, of);
    slab->lattice = b.lattice;
    free(of);
    return status;
}

bool body_place_strip(dem_lattice *strip, body_start *start, const body_scene *scene, size_t k, const double centre[2],
                      namelist_errors *errors)
{
    builder b = begin(scene, k, errors);
    b.lattice = *strip;
    b.is_strip = true;
    dem_status status = DEM_OK;
    if (!has_shape(b.body, "file")) {
        const dem_material material = body_geometry_material(scene->groups, k);
        status = report(&b, dem_lattice_assemble(&b.lattice, &material), "material");
    }
    if (status == DEM_OK) status = put(&b, centre);
    if (status == DEM_OK && copies_count(b.body) > 1) status = put_copy(&b, 0);
    *strip = b.lattice;
    *start = b.start;
    return status != DEM_ERROR_MEMORY;
}

bool body_copy(dem_lattice *lattice, const body_facts *facts, body_start *start, const body_scene *scene, size_t k,
               namelist_errors *errors)
{
    builder b = begin(scene, k, errors);
    b.lattice = *lattice;
    b.is_strip = facts->is_strip;
    b.start.copy = start->copy + 1;
    b.start.angle = start->angle;
    for (int c = 0; c < 2; c++) b.start.offset[c] = start->offset[c];
    strengths_put(&b.lattice, &facts->strengths, b.start.copy);
    const dem_status status = put_copy(&b, b.start.copy);
    *lattice = b.lattice;
    *start = b.start;
    return status != DEM_ERROR_MEMORY;
}
