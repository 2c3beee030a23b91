/* SPDX-License-Identifier: BSD-3-Clause */
/* What fails here is no fault of the deck: the whole is built then, and reports it. */
#include "deck_slabs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "angle.h"
#include "copies.h"
#include "namelist.h"
#include "rigid_keys.h"
#include "slab_survey.h"

/* ---- whether a deck suits ---- */

static bool is_plain(const schema_instance *body)
{
    static const char *const of_files[] = {"file", "mesh", "mask"};
    for (size_t k = 0; k < sizeof of_files / sizeof *of_files; k++)
        if (schema_is(body, "shape", of_files[k])) return false;
    return schema_is(body, "lattice", "triangular") && schema_is(body, "outline", "lattice") &&
           schema_real(body, "jitter") == 0.0 && schema_real(body, "spin") == 0.0 && copies_count(body) == 1 &&
           !rigid_keys_ask(body);
}

static bool is_elastic(const schema_deck *groups)
{
    for (size_t k = 0; k < schema_count(groups, "material"); k++)
        if (!schema_is(schema_get(groups, "material", k), "fracture", "none")) return false;
    return true;
}

static bool shows_fragments(const schema_instance *output)
{
    const schema_value *fields = schema_value_of(output, "fields");
    for (int k = 0; k < fields->count; k++)
        if (strcmp(fields->texts[k], "fragment") == 0) return true;
    return false;
}

bool deck_slabs_suit(const schema_deck *groups)
{
    static const char *const of_the_whole[] = {"crack", "inclusion", "weakness", "boundary", "probe"};
    for (size_t k = 0; k < sizeof of_the_whole / sizeof *of_the_whole; k++)
        if (schema_count(groups, of_the_whole[k]) > 0) return false;
    return schema_count(groups, "body") == 1 && is_plain(schema_get(groups, "body", 0)) && is_elastic(groups) &&
           schema_real(schema_get(groups, "run", 0), "residual") == 0.0 &&
           !shows_fragments(schema_get(groups, "output", 0));
}

/* ---- slabs ---- */

static dem_status assemble(dem_slab *slab, const schema_deck *groups)
{
    const dem_material material = body_geometry_material(groups, 0);
    return dem_lattice_assemble(&slab->lattice, &material);
}

static dem_status launch(dem_slab *slab, const schema_deck *groups)
{
    return dem_lattice_launch(&slab->lattice, schema_reals(schema_get(groups, "body", 0), "velocity"));
}

static void add_mass(body_facts *facts, const dem_slab *slab)
{
    for (dem_index i = slab->first_own; i < slab->first_own + slab->n_own; i++) facts->mass += slab->lattice.mass[i];
}

static dem_status note_angle(body_facts *facts, const dem_slab *slab)
{
    double least;
    const dem_status status = dem_lattice_least_angle(&slab->lattice, &least);
    if (status == DEM_OK) facts->least_angle = fmin(facts->least_angle, least / angle_degree);
    return status;
}

static dem_status add_slab(deck_slabs_found *f, slab_survey *s, dem_slab *slab, const schema_deck *groups)
{
    if (!slab_survey_add_strip(s, slab)) return DEM_ERROR_MEMORY;
    dem_status status = note_angle(&f->body, slab);
    if (status == DEM_OK) status = assemble(slab, groups);
    if (status == DEM_OK && !slab_survey_add_parts(s, slab)) return DEM_ERROR_MEMORY;
    if (status == DEM_OK) status = launch(slab, groups);
    if (status != DEM_OK) return status;
    add_mass(&f->body, slab);
    return lattice_facts_add(&f->lattice, slab) ? DEM_OK : DEM_ERROR_MEMORY;
}

static dem_status look_at_all(deck_slabs_found *f, slab_survey *s, dem_index n, const schema_deck *groups,
                              namelist_errors *errors)
{
    dem_status status = DEM_OK;
    for (dem_index k = 0; k < n && status == DEM_OK; k++) {
        dem_slab slab;
        status = body_geometry_slab(&slab, &f->body.geometry, groups, 0, (body_part){k, n}, errors);
        if (status == DEM_OK) status = add_slab(f, s, &slab, groups);
        dem_slab_free(&slab);
    }
    return status == DEM_OK && !slab_survey_is_one(s) ? DEM_ERROR_MODEL : status;
}

static dem_status place(deck_slabs_found *f, slab_survey *s, const body_scene *scene, namelist_errors *errors)
{
    if (!slab_survey_take_strip(&f->strip, s)) return DEM_ERROR_MEMORY;
    if (!body_place_strip(&f->strip, &f->start, scene, 0, errors)) return DEM_ERROR_MEMORY;
    lattice_facts_find_box(&f->lattice, &f->strip);
    f->body.true_mass = f->body.geometry.mass;
    f->body.plane = body_geometry_material(scene->groups, 0).plane;
    return errors->n == 0 ? DEM_OK : DEM_ERROR_MODEL;
}

static void forget(deck_slabs_found *f)
{
    dem_lattice_free(&f->strip);
    lattice_facts_free(&f->lattice);
    *f = (deck_slabs_found){0};
}

bool deck_slabs_look(deck_slabs_found *out, deck_slabs *slabs, const body_scene *scene)
{
    slab_survey s = {0};
    namelist_errors errors = {0};
    *out = (deck_slabs_found){.strip = dem_lattice_empty(), .body.least_angle = (double)INFINITY};
    dem_status status = look_at_all(out, &s, slabs->n, scene->groups, &errors);
    if (status == DEM_OK) status = place(out, &s, scene, &errors);
    slabs->are_made = status == DEM_OK;
    memcpy(slabs->shift, out->start.shift, sizeof slabs->shift);
    slab_survey_free(&s);
    namelist_errors_free(&errors);
    if (status != DEM_OK) forget(out);
    return status != DEM_ERROR_MEMORY;
}

/* ---- on all ranks ---- */

/* A text follows. All ranks are the same program on machines of one kind. */
typedef struct recipe {
    double shift[2];
} recipe;

void *deck_slabs_recipe(size_t *size, const deck_slabs *slabs, const char *echo)
{
    const size_t length = strlen(echo);
    recipe *r = malloc(sizeof *r + length + 1);
    if (r == NULL) return NULL;
    memcpy(r->shift, slabs->shift, sizeof r->shift);
    memcpy(r + 1, echo, length + 1);
    *size = sizeof *r + length + 1;
    return r;
}

/* In its place, by the same steps as a whole body. */
static dem_status make(dem_slab *out, const recipe *r, const schema_deck *groups, body_part part,
                       namelist_errors *errors)
{
    const schema_instance *body = schema_get(groups, "body", 0);
    body_geometry ignored;
    dem_status status = body_geometry_slab(out, &ignored, groups, 0, part, errors);
    if (status == DEM_OK) status = assemble(out, groups);
    if (status != DEM_OK) return status;
    dem_lattice_move(&out->lattice, angle_degree * schema_real(body, "angle"), schema_reals(body, "position"));
    status = launch(out, groups);
    if (schema_given(body, "clearance")) dem_lattice_move(&out->lattice, 0.0, r->shift);
    return status;
}

dem_status deck_slabs_make(void *program, const void *bytes, size_t size, dem_index part, dem_index n_parts,
                           dem_slab *out)
{
    const recipe *r = bytes;
    const char *text = (const char *)(r + 1);
    namelist_errors errors = {0};
    namelist list;
    schema_deck groups = {0};
    (void)program;
    bool good = namelist_parse(&list, text, size - sizeof *r - 1, &errors);
    if (good) good = schema_resolve(&groups, &list, &errors);
    dem_status status = good ? DEM_OK : DEM_ERROR_MEMORY;
    if (good) status = errors.n == 0 ? make(out, r, &groups, (body_part){part, n_parts}, &errors) : DEM_ERROR_MODEL;
    schema_free(&groups);
    namelist_free(&list);
    namelist_errors_free(&errors);
    return status;
}
