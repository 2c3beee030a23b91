/* SPDX-License-Identifier: BSD-3-Clause */
/* What fails here is no fault of the deck: the whole is built then, and reports it. */
#include "deck_slabs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "angle.h"
#include "base/grow.h"
#include "copies.h"
#include "file_slab.h"
#include "namelist.h"
#include "rigid_keys.h"
#include "slab_survey.h"

/* ---- whether a deck suits ---- */

static bool is_of_file(const schema_deck *groups, size_t k)
{
    return schema_is(schema_get(groups, "body", k), "shape", "file");
}

/* The fastest node of a file may be inside, where no strip has it: only rounding at `v_scale` asks for it. */
static bool is_plain(const schema_deck *groups, size_t k)
{
    const schema_instance *body = schema_get(groups, "body", k);
    if (is_of_file(groups, k) && schema_given(schema_get(groups, "solver", 0), "v_scale")) return false;
    return !schema_is(body, "shape", "mesh") && !rigid_keys_ask(body);
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
    if (schema_count(groups, "weakness") > 0) return false;
    for (size_t k = 0; k < schema_count(groups, "body"); k++)
        if (!is_plain(groups, k)) return false;
    return is_elastic(groups) && !shows_fragments(schema_get(groups, "output", 0));
}

/* ---- slabs ---- */

/* What slabs are made by. */
typedef struct maker {
    const schema_deck *groups;
    const char *folder;      /* of the deck, with its last '/', or "" */
    const slab_body *bodies; /* [number of &body groups] */
    const dem_index *held;   /* [n_held] as deck_slabs has them */
    dem_index n_held;
    dem_index **rows; /* [number of &body groups] as body_keys has them */
    namelist_errors *errors;
} maker;

static dem_status triangulate(dem_slab *out, body_geometry *geometry, const maker *m, size_t k, body_range range)
{
    return body_geometry_slab(out, geometry, &(body_keys){m->groups, k, m->folder, &m->rows[k]}, range, m->errors);
}

/* Assembled, where the body is to be but for its clearance and copies, as it moves there. */
static dem_status put(dem_slab *slab, body_inclusions *found, const maker *m, size_t k)
{
    const body_scene scene = {.groups = m->groups};
    const dem_status status = body_assemble_slab(slab, found, &scene, k, m->errors);
    if (status != DEM_OK) return status;
    if (is_of_file(m->groups, k)) file_slab_forget_start(slab);
    return body_put(&slab->lattice, schema_get(m->groups, "body", k), m->bodies[k].centre);
}

/* A slab of one body, which goes from copy to copy. */
typedef struct body_slab {
    size_t k; /* of which body */
    body_range range;
    dem_slab slab;
    size_t next_copy;
    double offset[2]; /* m, of the body's own coordinates */
} body_slab;

static dem_status open_body_slab(body_slab *p, const maker *m, size_t k, body_range range)
{
    const schema_instance *body = schema_get(m->groups, "body", k);
    body_geometry geometry;
    body_inclusions found = {0};
    *p = (body_slab){.k = k, .range = range};
    for (int c = 0; c < 2; c++) p->offset[c] = schema_reals(body, "position")[c];
    dem_status status = triangulate(&p->slab, &geometry, m, k, range);
    found.n = geometry.n_inclusions;
    if (status == DEM_OK && p->slab.n_own > 0) status = put(&p->slab, &found, m, k);
    if (status == DEM_OK && schema_given(body, "clearance"))
        dem_lattice_move(&p->slab.lattice, 0.0, m->bodies[k].shift);
    free(found.is_met);
    return status;
}

static dem_status go_to_copy(body_slab *p, const schema_instance *body, size_t copy)
{
    for (; copies_count(body) > 1 && p->next_copy <= copy; p->next_copy++)
        if (!body_put_copy(&p->slab.lattice, p->offset, body, p->next_copy)) return DEM_ERROR_MEMORY;
    return DEM_OK;
}

/* What comes in the whole before a body. */
typedef struct tally {
    dem_index nodes, triangles, bodies;
} tally;

static bool add_rim(dem_slab *out, const dem_slab *more, const tally *before)
{
    const dem_index n = out->lattice.n_nodes - out->n_own, m = more->lattice.n_nodes - more->n_own;
    dem_index *rim = realloc(out->rim, (size_t)(n + m + 1) * sizeof *rim);
    if (rim == NULL) return false;
    for (dem_index i = 0; i < m; i++) rim[n + i] = before->nodes + more->rim[i];
    out->rim = rim;
    return true;
}

static bool number_body(dem_lattice *l, dem_index first, dem_index number)
{
    if (l->body == NULL) l->body = calloc((size_t)l->n_nodes, sizeof *l->body);
    for (dem_index i = first; i < l->n_nodes && l->body != NULL; i++) l->body[i] = (int32_t)number;
    return l->body != NULL;
}

/* Behind what there is: of a body that goes on in the slab after this one nothing comes behind. What is not wanted any
 * more is taken over. */
static dem_status add(dem_slab *out, dem_slab *more, const tally *before, bool is_wanted)
{
    const dem_index n = out->lattice.n_nodes;
    dem_status status = DEM_OK;
    if (!add_rim(out, more, before)) return DEM_ERROR_MEMORY;
    if (n == 0) {
        out->first_node = before->nodes + more->first_node;
        out->first_triangle = more->first_triangle < 0 ? -1 : before->triangles + more->first_triangle;
        out->first_own = more->first_own;
    }
    if (n == 0 && !is_wanted) {
        out->lattice = more->lattice;
        more->lattice = dem_lattice_empty();
    } else {
        status = dem_lattice_append(&out->lattice, &more->lattice);
    }
    if (status != DEM_OK) return status;
    out->n_own += more->n_own;
    return number_body(&out->lattice, n, before->bodies) ? DEM_OK : DEM_ERROR_MEMORY;
}

/* What the nodes `all` of the whole have of a body that has n nodes behind those before it. */
static body_range share_of(body_range all, dem_index before, dem_index n)
{
    const dem_index begin = all.begin - before, end = all.end - before;
    return (body_range){begin > 0 ? begin : 0, end < n ? end : n};
}

static bool is_same(body_range a, body_range b)
{
    return a.begin == b.begin && a.end == b.end;
}

/* All copies of body k, which come next. */
static dem_status add_body(dem_slab *out, tally *before, const maker *m, size_t k, body_range all)
{
    const schema_instance *body = schema_get(m->groups, "body", k);
    const size_t n_copies = copies_count(body);
    body_slab p = {.slab = dem_slab_empty()};
    dem_status status = DEM_OK;
    for (size_t copy = 0; copy < n_copies && status == DEM_OK; copy++) {
        const body_range range = share_of(all, before->nodes, m->bodies[k].n_nodes);
        const bool has_any = range.begin < range.end;
        if (has_any && !is_same(range, p.range)) {
            dem_slab_free(&p.slab);
            status = open_body_slab(&p, m, k, range);
        }
        if (has_any && status == DEM_OK) status = go_to_copy(&p, body, copy);
        if (has_any && status == DEM_OK && p.slab.n_own > 0) status = add(out, &p.slab, before, n_copies > 1);
        before->nodes += m->bodies[k].n_nodes;
        before->triangles += m->bodies[k].n_triangles;
        before->bodies++;
    }
    dem_slab_free(&p.slab);
    return status;
}

dem_index deck_slabs_nodes(const schema_deck *groups, const slab_body *bodies, size_t n)
{
    dem_index nodes = 0;
    for (size_t k = 0; k < n; k++) nodes += bodies[k].n_nodes * (dem_index)copies_count(schema_get(groups, "body", k));
    return nodes;
}

static dem_index count_nodes(const maker *m)
{
    return deck_slabs_nodes(m->groups, m->bodies, schema_count(m->groups, "body"));
}

/* Of n nodes those of rank 0. It keeps of a frame what arrays are packed to, which takes as much memory as an 80th of
 * all nodes do where they are own ones (docs/performance.md): so that no rank takes more than others, it has so many
 * nodes less than they, but a quarter of the mean at least. */
static dem_index first_share(dem_index n, dem_index n_parts)
{
    enum { PACKED = 80, LEAST = 4 };
    const dem_index share = (n + n / PACKED) / n_parts - n / PACKED, least = n / (LEAST * n_parts);
    return share > least ? share : least;
}

/* The first of n nodes that is of a part; n behind the last one. */
static dem_index first_of(dem_index n, dem_index part, dem_index n_parts)
{
    const dem_index of_first = first_share(n, n_parts);
    if (part == 0 || part == n_parts) return part == 0 ? 0 : n;
    return of_first + (part - 1) * (n - of_first) / (n_parts - 1);
}

static body_range part_of(dem_index n, dem_index part, dem_index n_parts)
{
    return (body_range){first_of(n, part, n_parts), first_of(n, part + 1, n_parts)};
}

/* Nodes of all bodies. */
static body_range wanted(const maker *m, const slab_share *which)
{
    if (which->first == NULL) return part_of(count_nodes(m), which->part, which->n_parts);
    return (body_range){which->first[which->part], which->first[which->part + 1]};
}

/* Own nodes that are held may not touch. The flags of all slabs are written out where there are any. */
static dem_status hold(dem_slab *slab, const maker *m)
{
    dem_index *own = malloc((size_t)m->n_held * sizeof *own + 1), n = 0;
    if (own == NULL) return DEM_ERROR_MEMORY;
    for (dem_index k = 0; k < m->n_held; k++)
        if (m->held[k] >= slab->first_node && m->held[k] < slab->first_node + slab->n_own)
            own[n++] = m->held[k] - slab->first_node + slab->first_own;
    const dem_status status = dem_lattice_exclude(&slab->lattice, own, n);
    free(own);
    return status;
}

/* By the same steps as whole bodies. */
static dem_status make(dem_slab *out, const maker *m, const slab_share *which)
{
    const body_range all = wanted(m, which);
    dem_status status = DEM_OK;
    tally before = {0};
    *out = dem_slab_empty();
    for (size_t k = 0; k < schema_count(m->groups, "body") && status == DEM_OK; k++)
        status = add_body(out, &before, m, k, all);
    out->n_nodes = before.nodes;
    out->n_triangles = before.triangles;
    if (status == DEM_OK && out->n_own == 0) status = DEM_ERROR_MODEL; /* there are fewer rows than ranks */
    if (status == DEM_OK && m->n_held > 0) status = hold(out, m);
    if (status != DEM_OK) dem_slab_free(out);
    return status;
}

static dem_status make_each(dem_index n, const maker *m, deck_slabs_visitor *visit, void *visitor)
{
    dem_status status = DEM_OK;
    for (dem_index part = 0; part < n && status == DEM_OK; part++) {
        dem_slab slab;
        status = make(&slab, m, &(slab_share){part, n, NULL});
        if (status == DEM_OK) status = visit(visitor, &slab);
        dem_slab_free(&slab);
    }
    return status;
}

/* In how many slabs bodies are looked at, which are those of ranks, or larger ones of files. */
static dem_index count_looks(const deck_slabs *slabs, const maker *m)
{
    for (size_t k = 0; k < schema_count(m->groups, "body"); k++)
        if (!is_of_file(m->groups, k)) return slabs->n;
    const dem_index most = slabs->least > 0 ? 1 + count_nodes(m) / slabs->least : slabs->n;
    return slabs->n < most ? slabs->n : most;
}

static maker maker_of(const deck_slabs *slabs, const body_scene *scene, namelist_errors *errors)
{
    return (maker){.groups = scene->groups,
                   .folder = scene->folder,
                   .bodies = slabs->bodies,
                   .held = slabs->held,
                   .n_held = slabs->n_held,
                   .rows = slabs->rows,
                   .errors = errors};
}

dem_status deck_slabs_each(const deck_slabs *slabs, const body_scene *scene, deck_slabs_visitor *visit, void *visitor)
{
    namelist_errors errors = {0};
    const maker m = maker_of(slabs, scene, &errors);
    const dem_status status = make_each(count_looks(slabs, &m), &m, visit, visitor);
    namelist_errors_free(&errors);
    return status;
}

/* ---- looking ---- */

static dem_status add_facts(void *facts, const dem_slab *slab)
{
    return lattice_facts_add(facts, slab) ? DEM_OK : DEM_ERROR_MEMORY;
}

/* At one body. */
typedef struct body_look {
    const maker *maker;
    size_t k;
    body_facts *facts;
    body_geometry counted; /* what is known since rows were counted */
    slab_survey survey;
    body_inclusions inclusions;
    double moment[2];       /* kg m, sum of masses times places */
    lattice_facts *at_once; /* NULL: they are found by a second look */
} body_look;

/* Sums of the whole, in the order of its nodes: of them dem_lattice_spin() makes the centre. */
static void add_mass(body_look *l, const dem_slab *slab)
{
    const dem_lattice *lattice = &slab->lattice;
    for (dem_index i = slab->first_own; i < slab->first_own + slab->n_own; i++) {
        for (int c = 0; c < 2; c++) l->moment[c] += lattice->mass[i] * lattice->x[2 * i + c];
        l->facts->mass += lattice->mass[i];
    }
}

/* Of what is made here: files are taken as they are. */
static dem_status note_angle(body_facts *facts, const dem_slab *slab)
{
    double least;
    const dem_status status = dem_lattice_least_angle(&slab->lattice, &least);
    if (status == DEM_OK) facts->least_angle = fmin(facts->least_angle, least / angle_degree);
    return status;
}

static dem_status look_at_slab(body_look *l, dem_slab *slab)
{
    if (!slab_survey_add_strip(&l->survey, slab)) return DEM_ERROR_MEMORY;
    const bool is_read = is_of_file(l->maker->groups, l->k);
    dem_status status = is_read ? file_slab_check(slab) : note_angle(l->facts, slab);
    l->inclusions.n = l->facts->geometry.n_inclusions;
    if (status == DEM_OK) status = put(slab, &l->inclusions, l->maker, l->k);
    if (status == DEM_OK && !slab_survey_add_parts(&l->survey, slab)) return DEM_ERROR_MEMORY;
    if (status == DEM_OK) add_mass(l, slab);
    return status == DEM_OK && l->at_once != NULL ? add_facts(l->at_once, slab) : status;
}

static dem_status look_at_slabs(body_look *l, dem_index n)
{
    const maker *m = l->maker;
    dem_status status = DEM_OK;
    for (dem_index part = 0; part < n && status == DEM_OK; part++) {
        dem_slab slab;
        const body_range range = part_of(m->bodies[l->k].n_nodes, part, n);
        status = triangulate(&slab, &l->facts->geometry, m, l->k, range);
        if (status == DEM_OK && slab.n_own > 0) status = look_at_slab(l, &slab);
        if (status == DEM_OK && slab.n_own == 0 && l->at_once != NULL) status = DEM_ERROR_MODEL; /* for a rank */
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

static dem_status conclude(body_look *l, dem_lattice *strip, slab_body *body)
{
    body_facts *f = l->facts;
    if (!slab_survey_is_one(&l->survey) || !all_are_met(&l->inclusions)) return DEM_ERROR_MODEL;
    f->is_strip = true;
    f->geometry.report = l->counted.report;
    f->geometry.n_cracked = l->counted.n_cracked;
    f->further = copies_count(schema_get(l->maker->groups, "body", l->k)) - 1;
    for (int c = 0; c < 2; c++) body->centre[c] = 1.0 / f->mass * l->moment[c];
    if (!slab_survey_take_strip(strip, &l->survey)) return DEM_ERROR_MEMORY;
    if (is_of_file(l->maker->groups, l->k)) return file_slab_join_strip(strip, l->survey.rest_length);
    f->true_mass = f->geometry.mass;
    f->plane = body_geometry_material(l->maker->groups, l->k).plane;
    f->n_included = l->inclusions.n_triangles;
    return DEM_OK;
}

/* In n slabs. */
static dem_status look_at_body(deck_slabs_found *out, slab_body *body, const maker *m, size_t k, dem_index n)
{
    body_facts *facts = &out->bodies[k];
    body_look l = {
        .maker = m, .k = k, .facts = facts, .counted = facts->geometry, .at_once = out->at_once ? &out->lattice : NULL};
    *l.facts = (body_facts){.least_angle = is_of_file(m->groups, k) ? 0.0 : (double)INFINITY};
    dem_status status = look_at_slabs(&l, n);
    if (status == DEM_OK) status = conclude(&l, &out->strips[k], body);
    slab_survey_free(&l.survey);
    free(l.inclusions.is_met);
    return status;
}

/* \param[out] geometry  tells of cracks and smooth edges, which no later slab does */
static dem_status count(slab_body *body, body_geometry *geometry, const maker *m, size_t k)
{
    dem_slab none;
    const dem_status status = triangulate(&none, geometry, m, k, (body_range){0, 0});
    body->n_nodes = none.n_nodes;
    body->n_triangles = none.n_triangles;
    dem_slab_free(&none);
    return status;
}

/* In slabs that are about as large as those of ranks, and the same where there is one body. */
static dem_status look_at_all(deck_slabs_found *out, deck_slabs *slabs, const maker *m)
{
    dem_status status = DEM_OK;
    for (size_t k = 0; k < out->n && status == DEM_OK; k++)
        status = count(&slabs->bodies[k], &out->bodies[k].geometry, m, k);
    const dem_index all = count_nodes(m), n = count_looks(slabs, m);
    if (status == DEM_OK && all < slabs->n) return DEM_ERROR_MODEL; /* a rank would have none */
    for (size_t k = 0; k < out->n && status == DEM_OK; k++) {
        slab_body *body = &slabs->bodies[k];
        status = look_at_body(out, body, m, k, (body->n_nodes * n + all - 1) / all);
    }
    if (status != DEM_OK || out->at_once) return status;
    return make_each(n, m, add_facts, &out->lattice);
}

/* Sums over nodes are those of a single body, whose motion is known as soon as its slabs are made. */
static bool needs_one_look(const schema_deck *groups)
{
    return copies_total(groups) == 1 && schema_real(schema_get(groups, "body", 0), "spin") == 0.0;
}

bool deck_slabs_look(deck_slabs_found *out, deck_slabs *slabs, const body_scene *scene)
{
    const schema_deck *groups = scene->groups;
    const size_t n = schema_count(groups, "body");
    namelist_errors errors = {0};
    *out = (deck_slabs_found){.n = n, .at_once = needs_one_look(groups)};
    out->bodies = calloc(n + 1, sizeof *out->bodies);
    out->strips = calloc(n + 1, sizeof *out->strips);
    slabs->n_bodies = n;
    slabs->bodies = calloc(n + 1, sizeof *slabs->bodies);
    slabs->rows = calloc(n + 1, sizeof *slabs->rows);
    const maker m = maker_of(slabs, scene, &errors);
    const bool good = out->bodies != NULL && out->strips != NULL && slabs->bodies != NULL && slabs->rows != NULL;
    for (size_t k = 0; k < n && good; k++) out->strips[k] = dem_lattice_empty();
    const dem_status status = good ? look_at_all(out, slabs, &m) : DEM_ERROR_MEMORY;
    slabs->are_made = status == DEM_OK;
    namelist_errors_free(&errors);
    return status != DEM_ERROR_MEMORY;
}

void deck_slabs_forget(deck_slabs_found *found)
{
    for (size_t k = 0; k < found->n && found->strips != NULL; k++) dem_lattice_free(&found->strips[k]);
    free(found->strips);
    free(found->bodies);
    lattice_facts_free(&found->lattice);
    *found = (deck_slabs_found){0};
}

bool deck_slabs_hold(deck_slabs *slabs, const dem_boundary *list, dem_index n)
{
    dem_index room = 0;
    for (dem_index b = 0; b < n; b++) {
        if (list[b].kind == DEM_BOUNDARY_FORCE) continue;
        if (!grow_array((void **)&slabs->held, &room, slabs->n_held + list[b].n_nodes, sizeof *slabs->held))
            return false;
        memcpy(slabs->held + slabs->n_held, list[b].nodes, (size_t)list[b].n_nodes * sizeof *slabs->held);
        slabs->n_held += list[b].n_nodes;
    }
    return true;
}

static void free_rows(dem_index **rows, size_t n)
{
    for (size_t k = 0; k < n && rows != NULL; k++) free(rows[k]);
    free(rows);
}

void deck_slabs_free(deck_slabs *slabs)
{
    free_rows(slabs->rows, slabs->n_bodies);
    free(slabs->bodies);
    free(slabs->held);
    *slabs = (deck_slabs){0};
}

/* ---- on all ranks ---- */

/* What is known of each body; numbers of nodes that are held, and of each body its `rows`, or 0 for none; a text behind
 * them. All ranks are the same program on machines of one kind. */
typedef struct recipe {
    size_t n_bodies, n_held, n_rows; /* n_rows: numbers of all lists */
    slab_body bodies[];
} recipe;

static const dem_index *held_in(const recipe *r)
{
    return (const dem_index *)(const void *)(r->bodies + r->n_bodies);
}

static const dem_index *rows_in(const recipe *r)
{
    return held_in(r) + r->n_held;
}

static const char *text_in(const recipe *r)
{
    return (const char *)(rows_in(r) + r->n_rows);
}

static size_t count_numbers(const dem_index *list)
{
    return list != NULL ? 1 + (size_t)list[0] : 1;
}

static char *put_rows(char *to, const deck_slabs *slabs)
{
    static const dem_index none = 0;
    for (size_t k = 0; k < slabs->n_bodies; k++) {
        const size_t size = count_numbers(slabs->rows[k]) * sizeof none;
        memcpy(to, slabs->rows[k] != NULL ? slabs->rows[k] : &none, size);
        to += size;
    }
    return to;
}

void *deck_slabs_recipe(size_t *size, const deck_slabs *slabs, const char *echo)
{
    const size_t bodies = slabs->n_bodies * sizeof *slabs->bodies, held = (size_t)slabs->n_held * sizeof *slabs->held;
    const size_t length = strlen(echo) + 1;
    size_t n_rows = 0;
    for (size_t k = 0; k < slabs->n_bodies; k++) n_rows += count_numbers(slabs->rows[k]);
    *size = sizeof(recipe) + bodies + held + n_rows * sizeof **slabs->rows + length;
    recipe *r = malloc(*size);
    if (r == NULL) return NULL;
    *r = (recipe){slabs->n_bodies, (size_t)slabs->n_held, n_rows};
    char *to = (char *)r->bodies;
    memcpy(to, slabs->bodies, bodies);
    if (held > 0) memcpy(to + bodies, slabs->held, held);
    memcpy(put_rows(to + bodies + held, slabs), echo, length);
    return r;
}

/* Copies of the lists, [n_bodies]; NULL where memory runs out. */
static dem_index **take_rows(const recipe *r)
{
    dem_index **rows = calloc(r->n_bodies + 1, sizeof *rows);
    const dem_index *from = rows_in(r);
    for (size_t k = 0; k < r->n_bodies && rows != NULL; k++) {
        const size_t n = count_numbers(from);
        if (from[0] > 0) rows[k] = malloc(n * sizeof *from);
        if (rows[k] != NULL) memcpy(rows[k], from, n * sizeof *from);
        from += n;
    }
    return rows;
}

/* Rank 0 has found no fault before: one of now is of a file that has changed. */
dem_status deck_slabs_make(void *program, const void *bytes, size_t size, const slab_share *which, dem_slab *out)
{
    const recipe *r = bytes;
    const char *text = text_in(r);
    namelist_errors errors = {0};
    namelist list;
    schema_deck groups = {0};
    (void)program;
    bool good = namelist_parse(&list, text, size - (size_t)(text - (const char *)bytes) - 1, &errors);
    if (good) good = schema_resolve(&groups, &list, &errors);
    dem_status status = good ? DEM_OK : DEM_ERROR_MEMORY;
    dem_index **rows = take_rows(r);
    const maker m = {&groups, "", r->bodies, held_in(r), (dem_index)r->n_held, rows, &errors};
    if (good) body_drop_unused(&groups);
    if (rows == NULL) status = DEM_ERROR_MEMORY;
    if (status == DEM_OK) status = errors.n == 0 ? make(out, &m, which) : DEM_ERROR_MODEL;
    if (status == DEM_ERROR_MODEL && errors.n > 0) status = dem_private_slab_refuse(errors.list[0].text);
    free_rows(rows, r->n_bodies);
    schema_free(&groups);
    namelist_free(&list);
    namelist_errors_free(&errors);
    return status;
}
