/* SPDX-License-Identifier: BSD-3-Clause */
#include "weakness.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "body_geometry.h"
#include "body_outline.h"

/* The elements that one group touches, and what they are multiplied by, of all groups; 0: by nothing yet. */
typedef struct work {
    const weakness_body *body;
    const dem_lattice *lattice;
    namelist_errors *errors;
    bool squares;
    bool *triangles, *springs; /* [n_triangles], [n_springs] touched */
    unsigned char *sides;      /* [n_nodes] 1: of a triangle in an inclusion, 2: of one beside it, 3: of both */
    double *of_triangles, *of_energies, *of_springs;
} work;

static void work_free(work *w)
{
    free(w->triangles);
    free(w->springs);
    free(w->sides);
    free(w->of_triangles);
    free(w->of_energies);
    free(w->of_springs);
}

static dem_status work_create(work *w, const weakness_body *body, const dem_lattice *l, namelist_errors *errors)
{
    const size_t n = (size_t)l->n_triangles + 1, m = (size_t)l->n_springs + 1;
    *w = (work){.body = body, .lattice = l, .errors = errors};
    w->squares = body_geometry_has_squares(schema_get(body->groups, "body", body->k));
    w->triangles = calloc(n, sizeof *w->triangles);
    w->springs = calloc(m, sizeof *w->springs);
    w->sides = calloc((size_t)l->n_nodes + 1, 1);
    w->of_triangles = calloc(n, sizeof *w->of_triangles);
    w->of_energies = calloc(n, sizeof *w->of_energies);
    w->of_springs = calloc(m, sizeof *w->of_springs);
    if (w->triangles && w->springs && w->sides && w->of_triangles && w->of_energies && w->of_springs) return DEM_OK;
    work_free(w);
    return DEM_ERROR_MEMORY;
}

/* ---- what is touched ---- */

static void touch_nothing(work *w)
{
    memset(w->triangles, 0, (size_t)w->lattice->n_triangles * sizeof *w->triangles);
    memset(w->springs, 0, (size_t)w->lattice->n_springs * sizeof *w->springs);
}

/* Both triangles of a cell break together. */
static void touch_cells(work *w)
{
    for (dem_index t = 0; w->squares && t + 1 < w->lattice->n_triangles; t += 2)
        w->triangles[t] = w->triangles[t + 1] = w->triangles[t] || w->triangles[t + 1];
}

/* What a crack would take away, or what lies in a shape. */
static dem_status touch_group(work *w, const schema_instance *group)
{
    const schema_value *points = schema_value_of(group, "points");
    dem_status status;
    if (schema_is(group, "shape", "polyline")) {
        status = dem_lattice_crossed(w->lattice, points->reals, points->count / 2,
                                     BODY_GEOMETRY_ASIDE * w->body->spacing, w->triangles, w->springs);
    } else {
        const dem_outline o = body_outline_placed(group);
        status = dem_lattice_inside(w->lattice, &o, w->squares ? 2 : 1, w->triangles, w->springs);
    }
    if (status != DEM_OK && status != DEM_ERROR_MEMORY)
        namelist_errors_add(w->errors, group->place, "%s", dem_status_message());
    touch_cells(w);
    return status;
}

/* Triangles and springs at the nodes where an inclusion, from 1, meets what is not of it, on both sides: a crack that
 * runs along the edge goes through those of one of them. */
static void touch_edge(work *w, dem_index inclusion)
{
    const dem_lattice *l = w->lattice;
    touch_nothing(w);
    memset(w->sides, 0, (size_t)l->n_nodes);
    for (dem_index k = 0; k < 3 * l->n_triangles; k++)
        w->sides[l->triangles[k]] |= w->body->of[k / 3] == inclusion ? 1 : 2;
    for (dem_index k = 0; k < 3 * l->n_triangles; k++)
        if (w->sides[l->triangles[k]] == 3) w->triangles[k / 3] = true;
    for (dem_index k = 0; k < 2 * l->n_springs; k++)
        if (w->sides[l->ends[k]] == 3) w->springs[k / 2] = true;
    touch_cells(w);
}

/* ---- factors ---- */

static bool breaks(const double *limits, dem_index k)
{
    return limits != NULL && isfinite(limits[k]);
}

static double product(double before, double factor)
{
    return before == 0.0 ? factor : before * factor;
}

static double smaller(double before, double factor)
{
    return before == 0.0 ? factor : fmin(before, factor);
}

/* Of all that is touched.  \return whether any of it can break */
static bool weaken(work *w, double (*join)(double before, double factor), double factor)
{
    const dem_lattice *l = w->lattice;
    bool any = false;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        if (w->triangles[t]) w->of_triangles[t] = join(w->of_triangles[t], factor);
        any = any || (w->triangles[t] && breaks(l->strength, t));
    }
    for (dem_index k = 0; k < l->n_springs; k++) {
        if (w->springs[k]) w->of_springs[k] = join(w->of_springs[k], factor);
        any = any || (w->springs[k] && breaks(l->critical_stretch, k));
    }
    return any;
}

/* Of the energies of all that is touched.  \return whether any of it has one */
static bool embrittle(work *w, double factor)
{
    const double *softening = w->lattice->softening;
    bool any = false;
    for (dem_index t = 0; t < w->lattice->n_triangles; t++) {
        if (!w->triangles[t]) continue;
        w->of_energies[t] = product(w->of_energies[t], factor);
        any = any || (softening != NULL && softening[t] > 1.0);
    }
    return any;
}

/* Counts those that break.  \param factor  [n] 0 becomes 1 */
static void settle(double *factor, dem_index n, const double *limits, dem_index *count)
{
    for (dem_index k = 0; k < n; k++) {
        *count += factor[k] > 0.0 && breaks(limits, k);
        if (factor[k] == 0.0) factor[k] = 1.0;
    }
}

/* And begins anew: what interfaces do comes on top of what weaknesses do. */
static dem_status multiply(work *w, dem_lattice *lattice, weakness_counts *counts)
{
    settle(w->of_triangles, lattice->n_triangles, lattice->strength, &counts->n_triangles);
    settle(w->of_energies, lattice->n_triangles, NULL, &counts->n_triangles);
    settle(w->of_springs, lattice->n_springs, lattice->critical_stretch, &counts->n_springs);
    const dem_status status = dem_lattice_weaken(lattice, w->of_triangles, w->of_energies, w->of_springs);
    if (status != DEM_OK)
        namelist_errors_add(w->errors, schema_get(w->body->groups, "body", w->body->k)->place, "body %zu: %s",
                            w->body->k + 1, dem_status_message());
    memset(w->of_triangles, 0, (size_t)lattice->n_triangles * sizeof *w->of_triangles);
    memset(w->of_energies, 0, (size_t)lattice->n_triangles * sizeof *w->of_energies);
    memset(w->of_springs, 0, (size_t)lattice->n_springs * sizeof *w->of_springs);
    return status;
}

/* ---- groups ---- */

static dem_status refuse_touch(const work *w, const schema_instance *group)
{
    const bool line = schema_is(group, "shape", "polyline");
    namelist_errors_add(w->errors, schema_place(group, line ? "points" : "centre"),
                        "weakness touches nothing of body %zu that can break: its %s in the body's own coordinates, "
                        "and materials need a 'fracture'",
                        w->body->k + 1, line ? "points are" : "centre is");
    return DEM_ERROR_MODEL;
}

static dem_status use_weakness(work *w, const schema_instance *group)
{
    const dem_status status = touch_group(w, group);
    if (status != DEM_OK) return status;
    if (!weaken(w, product, schema_real(group, "strength"))) return refuse_touch(w, group);
    if (!schema_given(group, "toughness") || embrittle(w, schema_real(group, "toughness"))) return DEM_OK;
    namelist_errors_add(w->errors, schema_place(group, "toughness"),
                        "'toughness' in &weakness: nothing that it touches in body %zu softens; materials need both "
                        "'strength' and 'fracture_energy', else toughness follows from 'strength'",
                        w->body->k + 1);
    return DEM_ERROR_MODEL;
}

static dem_status use_interface(work *w, dem_index inclusion)
{
    const schema_instance *group = body_geometry_user(w->body->groups, w->body->k, (size_t)inclusion);
    if (!schema_given(group, "interface")) return DEM_OK;
    touch_edge(w, inclusion);
    if (weaken(w, smaller, schema_real(group, "interface"))) return DEM_OK;
    namelist_errors_add(w->errors, schema_place(group, "interface"),
                        "'interface' in &inclusion: nothing at its edge in body %zu can break; its material, or the "
                        "body's, needs a 'fracture'",
                        w->body->k + 1);
    return DEM_ERROR_MODEL;
}

static bool is_asked(const weakness_body *body)
{
    bool asked = schema_count(body->groups, "weakness") > 0;
    for (size_t i = 1; i <= body->n_inclusions && !asked; i++)
        asked = schema_given(body_geometry_user(body->groups, body->k, i), "interface");
    return asked;
}

static dem_status use_groups(work *w, dem_lattice *lattice, weakness_report *out)
{
    const schema_deck *groups = w->body->groups;
    dem_status status = DEM_OK;
    for (size_t i = 0; status == DEM_OK && i < schema_count(groups, "weakness"); i++) {
        const schema_instance *group = schema_get(groups, "weakness", i);
        if ((size_t)schema_real(group, "body") == w->body->k + 1) status = use_weakness(w, group);
    }
    if (status == DEM_OK) status = multiply(w, lattice, &out->weaknesses);
    for (size_t i = 1; status == DEM_OK && i <= w->body->n_inclusions; i++) status = use_interface(w, (dem_index)i);
    if (status == DEM_OK) status = multiply(w, lattice, &out->interfaces);
    return status;
}

dem_status weakness_apply(weakness_report *out, dem_lattice *lattice, const weakness_body *body,
                          namelist_errors *errors)
{
    work w;
    *out = (weakness_report){0};
    if (!is_asked(body)) return DEM_OK;
    dem_status status = work_create(&w, body, lattice, errors);
    if (status != DEM_OK) return status;
    status = use_groups(&w, lattice, out);
    work_free(&w);
    return status;
}
