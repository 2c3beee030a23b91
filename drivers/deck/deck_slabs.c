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
    return !schema_is(body, "outline", "smooth") && copies_count(body) == 1 && !rigid_keys_ask(body);
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
    static const char *const of_the_whole[] = {"crack", "weakness", "boundary"};
    for (size_t k = 0; k < sizeof of_the_whole / sizeof *of_the_whole; k++)
        if (schema_count(groups, of_the_whole[k]) > 0) return false;
    return schema_count(groups, "body") == 1 && is_plain(schema_get(groups, "body", 0)) && is_elastic(groups) &&
           schema_real(schema_get(groups, "run", 0), "residual") == 0.0 &&
           !shows_fragments(schema_get(groups, "output", 0));
}

/* ---- slabs ---- */

/* Rank 0 looks at all of them, the others make one. */
typedef struct maker {
    const schema_deck *groups;
    namelist_errors *errors;
    dem_index n_nodes; /* of the whole */
    body_geometry geometry;
    body_inclusions inclusions;
} maker;

static dem_status triangulate(maker *m, dem_slab *slab, body_part part)
{
    const dem_status status = body_geometry_slab(slab, &m->geometry, m->groups, 0, part, m->errors);
    m->n_nodes = slab->n_nodes;
    m->inclusions.n = m->geometry.n_inclusions;
    return status;
}

/* Assembled, where the body is to be but for its clearance, as it moves there. */
static dem_status put(maker *m, dem_slab *slab, const double centre[2])
{
    const body_scene scene = {.groups = m->groups};
    const dem_status status = body_assemble_slab(slab, &m->inclusions, &scene, 0, m->errors);
    return status == DEM_OK ? body_put(&slab->lattice, schema_get(m->groups, "body", 0), centre) : status;
}

/* In its place, by the same steps as a whole body. */
static dem_status make(dem_slab *out, const slab_place *place, const schema_deck *groups, body_part part,
                       namelist_errors *errors)
{
    maker m = {.groups = groups, .errors = errors};
    dem_status status = triangulate(&m, out, part);
    if (status == DEM_OK) status = put(&m, out, place->centre);
    if (schema_given(schema_get(groups, "body", 0), "clearance")) dem_lattice_move(&out->lattice, 0.0, place->shift);
    free(m.inclusions.is_met);
    return status;
}

dem_status deck_slabs_each(const deck_slabs *slabs, const schema_deck *groups, deck_slabs_visitor *visit, void *visitor)
{
    namelist_errors errors = {0};
    dem_status status = DEM_OK;
    for (dem_index part = 0; part < slabs->n && status == DEM_OK; part++) {
        dem_slab slab;
        status = make(&slab, &slabs->place, groups, (body_part){part, slabs->n}, &errors);
        if (status == DEM_OK) status = visit(visitor, &slab);
        dem_slab_free(&slab);
    }
    namelist_errors_free(&errors);
    return status;
}

/* ---- looking ---- */

static dem_status add_facts(void *facts, const dem_slab *slab)
{
    return lattice_facts_add(facts, slab) ? DEM_OK : DEM_ERROR_MEMORY;
}

typedef struct looker {
    maker maker;
    deck_slabs_found *found;
    slab_survey survey;
    bool spins;       /* how it moves is not known before its centre of mass is */
    double moment[2]; /* kg m, sum of masses times places */
    double centre[2]; /* of mass, m, once all slabs have been seen */
} looker;

/* Sums of the whole, in the order of its nodes: of them dem_lattice_spin() makes the centre. */
static void add_mass(looker *k, const dem_slab *slab)
{
    const dem_lattice *l = &slab->lattice;
    for (dem_index i = slab->first_own; i < slab->first_own + slab->n_own; i++) {
        for (int c = 0; c < 2; c++) k->moment[c] += l->mass[i] * l->x[2 * i + c];
        k->found->body.mass += l->mass[i];
    }
}

static dem_status note_angle(body_facts *facts, const dem_slab *slab)
{
    double least;
    const dem_status status = dem_lattice_least_angle(&slab->lattice, &least);
    if (status == DEM_OK) facts->least_angle = fmin(facts->least_angle, least / angle_degree);
    return status;
}

static dem_status survey(looker *k, dem_slab *slab)
{
    if (!slab_survey_add_strip(&k->survey, slab)) return DEM_ERROR_MEMORY;
    dem_status status = note_angle(&k->found->body, slab);
    if (status == DEM_OK) status = put(&k->maker, slab, k->centre);
    if (status == DEM_OK && !slab_survey_add_parts(&k->survey, slab)) return DEM_ERROR_MEMORY;
    if (status == DEM_OK) add_mass(k, slab);
    return status == DEM_OK && !k->spins ? add_facts(&k->found->lattice, slab) : status;
}

static dem_status survey_all(looker *k, dem_index n)
{
    dem_status status = DEM_OK;
    for (dem_index part = 0; part < n && status == DEM_OK; part++) {
        dem_slab slab;
        status = triangulate(&k->maker, &slab, (body_part){part, n});
        if (status == DEM_OK) status = survey(k, &slab);
        dem_slab_free(&slab);
    }
    return status;
}

static bool all_are_met(const body_inclusions *inclusions)
{
    for (size_t i = 0; i < inclusions->n; i++)
        if (!inclusions->is_met[i]) return false;
    return true;
}

static dem_status look_at_all(looker *k, dem_index n)
{
    const dem_status status = survey_all(k, n);
    if (status != DEM_OK) return status;
    if (!slab_survey_is_one(&k->survey) || !all_are_met(&k->maker.inclusions)) return DEM_ERROR_MODEL;
    k->found->body.geometry = k->maker.geometry;
    k->found->body.n_included = k->maker.inclusions.n_triangles;
    for (int c = 0; c < 2; c++) k->centre[c] = 1.0 / k->found->body.mass * k->moment[c];
    return DEM_OK;
}

static dem_status place(looker *k, const body_scene *scene)
{
    deck_slabs_found *f = k->found;
    if (!slab_survey_take_strip(&f->strip, &k->survey)) return DEM_ERROR_MEMORY;
    if (!body_place_strip(&f->strip, &f->start, scene, 0, k->centre, k->maker.errors)) return DEM_ERROR_MEMORY;
    lattice_facts_find_box(&f->lattice, &f->strip);
    f->body.true_mass = f->body.geometry.mass;
    f->body.plane = body_geometry_material(scene->groups, 0).plane;
    return k->maker.errors->n == 0 ? DEM_OK : DEM_ERROR_MODEL;
}

static void forget(deck_slabs_found *f)
{
    dem_lattice_free(&f->strip);
    lattice_facts_free(&f->lattice);
    *f = (deck_slabs_found){0};
}

bool deck_slabs_look(deck_slabs_found *out, deck_slabs *slabs, const body_scene *scene)
{
    namelist_errors errors = {0};
    looker k = {.maker = {.groups = scene->groups, .errors = &errors},
                .found = out,
                .spins = schema_real(schema_get(scene->groups, "body", 0), "spin") != 0.0};
    *out = (deck_slabs_found){.strip = dem_lattice_empty(), .body.least_angle = (double)INFINITY};
    dem_status status = look_at_all(&k, slabs->n);
    if (status == DEM_OK) status = place(&k, scene);
    slabs->n_nodes = k.maker.n_nodes;
    memcpy(slabs->place.centre, k.centre, sizeof k.centre);
    memcpy(slabs->place.shift, out->start.shift, sizeof out->start.shift);
    if (status == DEM_OK && k.spins) status = deck_slabs_each(slabs, scene->groups, add_facts, &out->lattice);
    slabs->are_made = status == DEM_OK;
    slab_survey_free(&k.survey);
    free(k.maker.inclusions.is_met);
    namelist_errors_free(&errors);
    if (status != DEM_OK) forget(out);
    return status != DEM_ERROR_MEMORY;
}

/* ---- on all ranks ---- */

/* A text follows. All ranks are the same program on machines of one kind. */
typedef struct recipe {
    slab_place place;
} recipe;

void *deck_slabs_recipe(size_t *size, const deck_slabs *slabs, const char *echo)
{
    const size_t length = strlen(echo);
    recipe *r = malloc(sizeof *r + length + 1);
    if (r == NULL) return NULL;
    r->place = slabs->place;
    memcpy(r + 1, echo, length + 1);
    *size = sizeof *r + length + 1;
    return r;
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
    if (good)
        status = errors.n == 0 ? make(out, &r->place, &groups, (body_part){part, n_parts}, &errors) : DEM_ERROR_MODEL;
    schema_free(&groups);
    namelist_free(&list);
    namelist_errors_free(&errors);
    return status;
}
