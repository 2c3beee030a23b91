/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads the file, has its groups checked, and turns them into what the library takes. Bodies are body.c's business,
 * obstacles obstacles.c's. */
#include "deck.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "body.h"
#include "body_files.h"
#include "body_friction.h"
#include "conditional_keys.h"
#include "copies.h"
#include "digest.h"
#include "base/file.h"
#include "loading.h"
#include "obstacles.h"
#include "precision.h"
#include "probes.h"
#include "schema.h"
#include "surfaces.h"

static const double most_frames = 1e7;

static const conditional_key surface_keys[] = {
    {"thickness", "others, all", false}, {"stiffness", "others, all", false}, {"friction", "others, all", false}};
static const conditional_keys surface_uses = {"contact", "bodies", sizeof surface_keys / sizeof *surface_keys,
                                              surface_keys};

/* ---- the file ---- */

static deck_status read_text(deck *d, size_t *size, namelist_errors *errors)
{
    char why[FILE_WHY];
    switch (file_read(&d->source, size, d->path, NAMELIST_MAX_FILE, why)) {
    case FILE_READ:
        return DECK_OK;
    case FILE_REFUSED:
        namelist_errors_add(errors, (namelist_place){0, 0}, "%s", why);
        return DECK_UNREADABLE;
    case FILE_MEMORY:
        break;
    }
    return DECK_MEMORY;
}

/* ---- checks ---- */

static void check_frames(const schema_deck *groups, namelist_errors *errors)
{
    const schema_value *interval = schema_value_of(schema_get(groups, "output", 0), "frame_interval");
    const double frames = schema_real(schema_get(groups, "run", 0), "t_end") / interval->reals[0];
    if (frames > most_frames && !interval->faulty)
        namelist_errors_add(errors, interval->place,
                            "'frame_interval' in &output, %g s, makes %g frames until 't_end'; the limit is %.0f",
                            interval->reals[0], frames, most_frames);
}

/* A pause ends by the residual. */
static void check_pause(const schema_instance *run, namelist_errors *errors)
{
    const schema_value *pause = schema_value_of(run, "pause"), *residual = schema_value_of(run, "residual");
    if (schema_real(run, "pause") != 0.0 && !pause->faulty && !residual->given)
        namelist_errors_add(errors, pause->place, "'pause' in &run needs 'residual', at which a pause ends");
}

/* SUNDIALS may lack the method, and the machine the kernel. */
static void check_solver(const schema_instance *solver, namelist_errors *errors)
{
    const schema_value *name = schema_value_of(solver, "method"), *longest = schema_value_of(solver, "max_step");
    dem_method method;
    dem_method_traits traits = {.struct_size = sizeof traits};
    if (!name->faulty && dem_method_find(&method, schema_text(solver, "method")) == DEM_OK &&
        dem_method_describe(&traits, method) != DEM_OK)
        namelist_errors_add(errors, name->place, "%s", dem_status_message());
    const schema_value *instructions = schema_value_of(solver, "kernel");
    dem_kernel kernel;
    if (!instructions->faulty && dem_kernel_find(&kernel, schema_text(solver, "kernel")) == DEM_OK &&
        dem_kernel_check(kernel) != DEM_OK)
        namelist_errors_add(errors, instructions->place, "%s", dem_status_message());
    if (longest->given && schema_value_of(solver, "fixed_step")->given)
        namelist_errors_add(errors, longest->place, "'max_step' in &solver: give it or 'fixed_step', not both");
}

static bool ends_with(const char *text, const char *end)
{
    const size_t n = strlen(text), m = strlen(end);
    return n >= m && strcmp(text + n - m, end) == 0;
}

/* As segments of a run do. */
static bool ends_with_number(const char *text)
{
    const char *point = strrchr(text, '.');
    return point != NULL && strlen(point + 1) >= 5 && strspn(point + 1, "0123456789") == strlen(point + 1);
}

static void check_name(const schema_instance *output, namelist_errors *errors)
{
    const schema_value *name = schema_value_of(output, "name");
    const char *text = schema_text(output, "name");
    const size_t length = strlen(text);
    if (length == 0 || length > 100 || strchr(text, '/') != NULL || text[0] == '.' || text[0] == '-')
        namelist_errors_add(errors, name->place,
                            "'name' in &output must have 1 to 100 characters, no '/', and not begin with '.' or '-'");
    else if (ends_with(text, ".obstacle") || ends_with(text, ".body") || ends_with(text, ".part") ||
             ends_with_number(text))
        namelist_errors_add(errors, name->place,
                            "'name' in &output must not end in '.obstacle', '.body', '.part' or a '.' and five digits "
                            "or more: other files are called so");
}

static void check(const schema_deck *groups, namelist_errors *errors)
{
    body_check_all(groups, errors);
    obstacles_check(groups, errors);
    loading_check_all(groups, errors);
    conditional_keys_check(schema_get(groups, "contact", 0), &surface_uses, errors);
    body_friction_check(groups, errors);
    check_solver(schema_get(groups, "solver", 0), errors);
    probes_check(groups, errors);
    check_name(schema_get(groups, "output", 0), errors);
    check_frames(groups, errors);
    check_pause(schema_get(groups, "run", 0), errors);
}

/* ---- scalars ---- */

static dem_bodies bodies_of(const schema_instance *contact)
{
    if (schema_is(contact, "bodies", "none")) return DEM_BODIES_NONE;
    return schema_is(contact, "bodies", "all") ? DEM_BODIES_ALL : DEM_BODIES_OTHERS;
}

static void set_options(dem_options *options, const schema_deck *groups)
{
    const schema_instance *run = schema_get(groups, "run", 0), *contact = schema_get(groups, "contact", 0);
    const schema_instance *solver = schema_get(groups, "solver", 0);
    *options = dem_options_default();
    for (int c = 0; c < 2; c++) options->gravity[c] = schema_value_of(run, "gravity")->reals[c];
    (void)dem_method_find(&options->method, schema_text(solver, "method")); /* the table of keys has no other name */
    (void)dem_kernel_find(&options->kernel, schema_text(solver, "kernel"));
    options->threads = (int32_t)schema_real(solver, "threads");
    options->thread_nodes = (dem_index)schema_real(solver, "thread_nodes");
    options->checkpoint_steps = (dem_index)schema_real(solver, "checkpoint_steps");
    options->rtol = schema_real(solver, "rtol");
    options->pause = schema_real(run, "pause") != 0.0 ? schema_real(run, "residual") : 0.0;
    options->spacing = schema_real(solver, "spacing");
    options->v_scale = schema_real(solver, "v_scale");
    options->max_step = schema_real(solver, "max_step");
    options->fixed_step = schema_real(solver, "fixed_step");
    options->penetration_tolerance = schema_real(contact, "penetration_tolerance");
    options->rest_speed = schema_real(contact, "rest_speed");
    options->max_impacts = (dem_index)schema_real(contact, "max_impacts");
    options->vertices = schema_real(contact, "vertices") != 0.0;
    options->mass_damping = schema_real(solver, "mass_damping");
    options->contact = schema_is(contact, "method", "local") ? DEM_CONTACT_LOCAL : DEM_CONTACT_EXACT;
    options->bodies = bodies_of(contact);
    options->contact_thickness = schema_real(contact, "thickness");
    options->contact_stiffness = schema_real(contact, "stiffness");
    options->contact_friction = schema_real(contact, "friction");
    if (schema_value_of(contact, "window")->given) options->window = schema_real(contact, "window");
}

static uint32_t fields_of(const schema_value *names)
{
    static const struct {
        const char *name;
        uint32_t field;
    } all[] = {{"displacement", DEM_FIELD_DISPLACEMENT},
               {"velocity", DEM_FIELD_VELOCITY},
               {"stress", DEM_FIELD_STRESS},
               {"von_mises", DEM_FIELD_VON_MISES},
               {"principal", DEM_FIELD_PRINCIPAL},
               {"contact", DEM_FIELD_CONTACT},
               {"fragment", DEM_FIELD_FRAGMENT},
               {"damage", DEM_FIELD_DAMAGE},
               {"strain", DEM_FIELD_STRAIN},
               {"force", DEM_FIELD_FORCE}};
    uint32_t fields = 0;
    for (int k = 0; k < names->count; k++)
        for (size_t f = 0; f < sizeof all / sizeof *all; f++)
            if (strcmp(names->texts[k], all[f].name) == 0) fields |= all[f].field;
    return fields;
}

static bool set_scalars(deck *d, const schema_deck *groups)
{
    const schema_instance *run = schema_get(groups, "run", 0), *output = schema_get(groups, "output", 0);
    set_options(&d->options, groups);
    d->t_end = schema_real(run, "t_end");
    d->residual = schema_real(run, "residual");
    d->closure = schema_real(output, "closure");
    d->stop_at_overlap = strcmp(schema_text(schema_get(groups, "contact", 0), "overlap"), "stop") == 0;
    d->frame_interval = schema_real(output, "frame_interval");
    d->history_interval = schema_given(output, "history_interval") ? schema_real(output, "history_interval") : -1.0;
    d->double_precision = strcmp(schema_text(output, "precision"), "double") == 0;
    d->deflate = (int)schema_real(output, "deflate");
    d->events = schema_real(output, "events") != 0.0;
    d->breaks = schema_real(output, "breaks") != 0.0;
    d->fragments = schema_real(output, "fragments") != 0.0;
    d->fields = fields_of(schema_value_of(output, "fields"));
    d->peak_every = schema_given(output, "peak_every") ? (dem_index)schema_real(output, "peak_every") : -1;
    d->most_stressed = (dem_index)schema_real(output, "most_stressed");
    d->measure = schema_real(output, "measure") != 0.0;
    d->title = strdup(schema_text(run, "title"));
    d->name = strdup(schema_text(output, "name"));
    return d->title != NULL && d->name != NULL;
}

/* ---- bodies ---- */

/* The deck's folder with its '/', or ""; NULL when memory runs out. */
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return strndup(path, slash == NULL ? 0 : (size_t)(slash - path) + 1);
}

/* Echoes and hashes; to be called when the bodies are built, since it changes the names of files in `groups`. */
static bool set_texts(deck *d, schema_deck *groups, const char *folder, namelist_errors *errors)
{
    char *bare = NULL;
    if (!body_files_name(groups, folder, errors)) return false;
    if (errors->n > 0) return true;
    if (!schema_echo(groups, SCHEMA_MARKED, &d->echo)) return false;
    if (!body_files_hash(groups, errors)) return false;
    if (!schema_echo(groups, SCHEMA_PHYSICS, &d->physics) || !schema_echo(groups, SCHEMA_COURSE, &d->course) ||
        !schema_echo(groups, SCHEMA_BARE, &bare))
        return false;
    d->hash = digest_add(DIGEST_BEGIN, d->physics, strlen(d->physics));
    d->run_hash = digest_add(DIGEST_BEGIN, bare, strlen(bare));
    free(bare);
    return true;
}

static bool append(deck *d, const dem_lattice *body, namelist_place place, namelist_errors *errors)
{
    const dem_status status = dem_lattice_append(&d->lattice, body);
    if (status != DEM_OK && status != DEM_ERROR_MEMORY) namelist_errors_add(errors, place, "%s", dem_status_message());
    return status != DEM_ERROR_MEMORY;
}

/* The bodies, of which `found`, if any, has the strips that stand for them. */
typedef struct builder {
    const body_scene *scene;
    deck_slabs_found *found; /* NULL: there are the bodies themselves */
    namelist_errors *errors;
} builder;

/* As the library's model of slabs has it, the strip takes the place of its body. */
static bool set_first(deck *d, dem_lattice *body, body_start *start, const builder *b, size_t k)
{
    if (b->found == NULL) return body_build(body, &d->bodies[k], start, b->scene, k, b->errors);
    slab_body *of_slabs = &d->slabs.bodies[k];
    d->bodies[k] = b->found->bodies[k];
    *body = b->found->strips[k];
    b->found->strips[k] = dem_lattice_empty();
    const bool good = body_place_strip(body, start, b->scene, k, of_slabs->centre, b->errors);
    memcpy(of_slabs->shift, start->shift, sizeof of_slabs->shift);
    return good;
}

/* A body with its copies. `starts` has one for each. */
static bool set_body(deck *d, body_start *starts, const builder *b, size_t k)
{
    const namelist_place place = schema_get(b->scene->groups, "body", k)->place;
    const size_t before = b->errors->n;
    dem_lattice body = dem_lattice_empty();
    bool good = set_first(d, &body, starts, b, k) && append(d, &body, place, b->errors);
    for (size_t c = 1; c <= d->bodies[k].further && good && b->errors->n == before; c++) {
        starts[c] = starts[c - 1];
        good =
            body_copy(&body, &d->bodies[k], &starts[c], b->scene, k, b->errors) && append(d, &body, place, b->errors);
    }
    dem_lattice_free(&body);
    strengths_free(&d->bodies[k].strengths);
    return good;
}

static bool build_bodies(deck *d, body_start *starts, placement *places, const builder *b)
{
    body_start *next = starts;
    bool good = true;
    for (size_t k = 0; k < d->n_bodies && good; k++) {
        const dem_index first = d->lattice.n_nodes;
        good = set_body(d, next, b, k);
        places[k] = (placement){.first = first,
                                .n_nodes = d->lattice.n_nodes - first,
                                .angle = next->angle,
                                .offset = {next->offset[0], next->offset[1]}};
        next += copies_count(schema_get(b->scene->groups, "body", k));
    }
    return good;
}

/* ---- what is looked for in the lattice ---- */

/* All nodes as one slab; of those that are made in slabs there is but the number. */
static dem_slab view(const deck *d)
{
    dem_slab whole = dem_slab_empty();
    if (d->slabs.are_made) {
        whole.n_nodes = deck_slabs_nodes(&d->groups, d->slabs.bodies, d->n_bodies);
    } else {
        whole.n_nodes = whole.n_own = d->lattice.n_nodes;
        whole.lattice = d->lattice;
    }
    return whole;
}

/* Returns false when memory runs out. */
static bool look_at_all(const deck *d, deck_slabs_visitor *look, void *search)
{
    const body_scene scene = {.groups = &d->groups, .folder = d->folder};
    const dem_slab whole = view(d);
    if (d->slabs.are_made) return deck_slabs_each(&d->slabs, &scene, look, search) == DEM_OK;
    return look(search, &whole) == DEM_OK;
}

/* By the numbers that nodes have in the whole. \return NULL when memory runs out; to be freed */
static placement *number_nodes(const deck *d, const placement *places)
{
    placement *whole = calloc(d->n_bodies + 1, sizeof *whole);
    for (size_t k = 0; k < d->n_bodies && whole != NULL; k++) {
        whole[k] = places[k];
        if (!d->slabs.are_made) continue;
        whole[k].first = deck_slabs_nodes(&d->groups, d->slabs.bodies, k);
        whole[k].n_nodes = deck_slabs_nodes(&d->groups, d->slabs.bodies, k + 1) - whole[k].first;
    }
    return whole;
}

static dem_status look_at_probes(void *search, const dem_slab *slab)
{
    probes_look(search, slab);
    return DEM_OK;
}

static bool find_probes(deck *d, const placement *bodies, namelist_errors *errors)
{
    probe_search s;
    const bool good = probes_begin(&s, d->probes, &d->groups, bodies) && look_at_all(d, look_at_probes, &s);
    if (good) probes_end(&s, d->probe_places, errors);
    probes_forget(&s);
    return good;
}

static bool set_probes(deck *d, const placement *places, namelist_errors *errors)
{
    const size_t n = schema_count(&d->groups, "probe");
    if (n == 0) return true;
    placement *bodies = number_nodes(d, places);
    d->probes = calloc(n, sizeof *d->probes);
    d->probe_places = calloc(n, sizeof *d->probe_places);
    d->n_probes = d->probes != NULL ? (dem_index)n : 0;
    const bool good = bodies != NULL && d->probes != NULL && d->probe_places != NULL && find_probes(d, bodies, errors);
    free(bodies);
    return good;
}

static dem_status look_at_boundaries(void *search, const dem_slab *slab)
{
    return loading_look(search, slab) ? DEM_OK : DEM_ERROR_MEMORY;
}

static bool find_boundaries(deck *d, const placement *bodies, const placement *places, namelist_errors *errors)
{
    const dem_slab whole = view(d);
    loading_search s;
    const bool good = loading_begin(&s, &d->groups, bodies, &d->lattice, places) &&
                      look_at_all(d, look_at_boundaries, &s) &&
                      loading_end(&d->boundaries, &d->n_boundaries, &s, &whole, errors);
    loading_forget(&s);
    return good;
}

static bool set_boundaries(deck *d, const placement *places, namelist_errors *errors)
{
    if (schema_count(&d->groups, "boundary") == 0) return true;
    placement *bodies = number_nodes(d, places);
    const bool good = bodies != NULL && find_boundaries(d, bodies, places, errors);
    free(bodies);
    return good;
}

/* ---- bodies together ---- */

/* In place of the lattice the strips of the bodies, which are as good for all checks. */
static bool take_strips(deck *d, body_start *starts, placement *places, const body_scene *scene)
{
    deck_slabs_found found;
    namelist_errors errors = {0};
    bool good = deck_slabs_look(&found, &d->slabs, scene);
    if (good && d->slabs.are_made) good = build_bodies(d, starts, places, &(builder){scene, &found, &errors});
    if (good && d->slabs.are_made && errors.n == 0) good = set_boundaries(d, places, &errors);
    d->slabs.are_made = d->slabs.are_made && errors.n == 0;
    if (good && d->slabs.are_made) {
        d->facts = found.lattice;
        found.lattice = (lattice_facts){0};
        lattice_facts_find_box(&d->facts, &d->lattice);
        good = deck_slabs_hold(&d->slabs, d->boundaries, d->n_boundaries);
    } else {
        dem_lattice_free(&d->lattice);
        loading_free(d->boundaries, d->n_boundaries);
        d->boundaries = NULL;
        d->n_boundaries = 0;
        deck_slabs_free(&d->slabs);
    }
    deck_slabs_forget(&found);
    namelist_errors_free(&errors);
    return good;
}

/* By the rule of the library, which has the last word. */
static bool check_starts(const deck *d, const body_start *starts, const body_scene *scene, namelist_errors *errors)
{
    const size_t n = copies_total(scene->groups);
    double spacing = d->options.spacing > 0.0 ? d->options.spacing : (double)INFINITY;
    for (size_t k = 0; k < n && !(d->options.spacing > 0.0); k++) spacing = fmin(spacing, starts[k].rest_length);
    const double penetration_tolerance =
        d->options.penetration_tolerance > 0.0 ? d->options.penetration_tolerance : 1e-6 * spacing;
    for (size_t k = 0; k < n; k++)
        if (!body_check_start(scene, copies_find(scene->groups, k).group, &starts[k], penetration_tolerance, errors))
            return false;
    return true;
}

static bool set_bodies(deck *d, schema_deck *groups, const char *folder, namelist_errors *errors)
{
    dem_obstacle *still = obstacles_still(d->obstacles, d->n_obstacles);
    const body_scene scene = {.groups = groups,
                              .folder = folder,
                              .obstacles = still,
                              .n_obstacles = d->n_obstacles,
                              .gravity = {d->options.gravity[0], d->options.gravity[1]}};
    const size_t n = schema_count(groups, "body");
    body_start *starts = calloc(copies_total(groups) + 1, sizeof *starts);
    placement *places = calloc(n + 1, sizeof *places);
    d->bodies = calloc(n + 1, sizeof *d->bodies);
    d->n_bodies = n;
    bool good = starts != NULL && places != NULL && d->bodies != NULL && still != NULL;
    if (good && d->slabs.n > 0) good = take_strips(d, starts, places, &scene);
    if (good && !d->slabs.are_made) good = build_bodies(d, starts, places, &(builder){&scene, NULL, errors});
    good = good && check_starts(d, starts, &scene, errors);
    if (good && errors->n == 0) precision_check(groups, &d->lattice, errors);
    if (good && errors->n == 0) good = surfaces_settle(&d->options, groups, &d->lattice, places, errors);
    if (good && errors->n == 0 && !d->slabs.are_made)
        good = set_boundaries(d, places, errors) && loading_hold(&d->lattice, d->boundaries, d->n_boundaries);
    if (good && errors->n == 0) good = set_probes(d, places, errors);
    if (good && errors->n == 0) good = body_friction_make(&d->body_friction, &d->options, groups, &d->lattice, places);
    d->options.boundaries = d->boundaries;
    d->options.n_boundaries = d->n_boundaries;
    obstacles_free(still, d->n_obstacles);
    free(starts);
    free(places);
    return good;
}

/* ---- all of it ---- */

static bool interpret(deck *d)
{
    body_drop_unused(&d->groups);
    loading_drop_unused(&d->groups);
    probes_drop_unused(&d->groups);
    obstacles_drop_unused(&d->groups);
    conditional_keys_drop(&d->groups, &surface_uses);
    return body_settle_outlines(&d->groups) && set_scalars(d, &d->groups);
}

static deck_status resolve(deck *d, const namelist *list, namelist_errors *errors)
{
    bool good = schema_resolve(&d->groups, list, errors);
    if (good) check(&d->groups, errors);
    if (good && errors->n == 0) good = interpret(d);
    return good ? DECK_OK : DECK_MEMORY;
}

static deck_status parse(deck *d, size_t size, const setting *settings, size_t n, namelist_errors *errors)
{
    namelist list;
    deck_status status = DECK_OK;
    bool good = namelist_parse(&list, d->source, size, errors);
    for (size_t k = 0; k < n && good && !list.unreadable; k++)
        good = setting_apply(&settings[k], -1 - (int)k, &list, errors);
    if (!good)
        status = DECK_MEMORY;
    else if (!list.unreadable)
        status = resolve(d, &list, errors);
    namelist_free(&list);
    return status;
}

/* Sorts what was found. The deck stays where nothing was. */
static deck_status conclude(deck *d, deck_status status, namelist_errors *errors)
{
    namelist_errors_sort(errors);
    if (status == DECK_OK && errors->n > 0) status = DECK_INVALID;
    if (errors->out_of_memory) status = DECK_MEMORY;
    if (status != DECK_OK) deck_free(d);
    return status;
}

deck_status deck_parse(deck *out, const char *path, const setting *settings, size_t n, namelist_errors *errors)
{
    size_t size = 0;
    *out = (deck){.path = strdup(path), .folder = folder_of(path)};
    out->lattice = dem_lattice_empty();
    deck_status status = out->path == NULL || out->folder == NULL ? DECK_MEMORY : read_text(out, &size, errors);
    if (status == DECK_OK) status = parse(out, size, settings, n, errors);
    return conclude(out, status, errors);
}

/* Where nothing may break there is no table of it; where something may, frames show fragments,
 * too, and where something may soften damage. */
static void settle_breaks(deck *d)
{
    d->breaks = d->breaks && d->facts.may_break;
    d->fragments = d->fragments && d->facts.may_break;
    if (d->breaks) d->fields |= DEM_FIELD_FRAGMENT;
    if (d->breaks && d->facts.may_soften) d->fields |= DEM_FIELD_DAMAGE;
}

deck_status deck_build(deck *d, namelist_errors *errors)
{
    d->obstacles = obstacles_make(&d->groups, errors);
    d->n_obstacles = d->obstacles != NULL ? (dem_index)schema_count(&d->groups, "obstacle") : 0;
    bool good = d->obstacles != NULL;
    if (good && errors->n == 0) good = set_bodies(d, &d->groups, d->folder, errors);
    if (good && errors->n == 0) good = set_texts(d, &d->groups, d->folder, errors);
    if (good && errors->n == 0 && !d->slabs.are_made) good = lattice_facts_find(&d->facts, &d->lattice);
    if (d->slabs.are_made) dem_lattice_free(&d->lattice); /* the strip has been checked */
    settle_breaks(d);
    return conclude(d, good ? DECK_OK : DECK_MEMORY, errors);
}

void deck_free(deck *d)
{
    obstacles_free(d->obstacles, d->n_obstacles);
    schema_free(&d->groups);
    probes_free(d->probes, (size_t)d->n_probes);
    free(d->probe_places);
    dem_lattice_free(&d->lattice);
    lattice_facts_free(&d->facts);
    free(d->bodies);
    deck_slabs_free(&d->slabs);
    loading_free(d->boundaries, d->n_boundaries);
    free(d->body_friction);
    free(d->path);
    free(d->folder);
    free(d->source);
    free(d->echo);
    free(d->physics);
    free(d->course);
    free(d->title);
    free(d->name);
    *d = (deck){0};
    d->lattice = dem_lattice_empty();
}
