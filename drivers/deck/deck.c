/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads the file, has its groups checked, and turns them into what the library takes. Bodies are body.c's business,
 * profiles profile.c's. */
#include "deck.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "body.h"
#include "digest.h"
#include "file.h"
#include "loading.h"
#include "motion.h"
#include "precision.h"
#include "probes.h"
#include "profile.h"
#include "schema.h"
#include "conditional_keys.h"

static const double most_frames = 1e7;
static const double default_segments = 200.0; /* of a profile */
static const double lost = 1e-6;              /* of a segment: rounding must not hide more */

static const conditional_key profile_keys[] = {
    {"resolution", "smooth, rough", false},
    {"roughness", "rough", true},
    {"correlation", "rough", true},
    {"seed", "rough", false},
};
static const conditional_key surface_keys[] = {{"thickness", "others, all", false},
                                               {"stiffness", "others, all", false}};
static const conditional_keys surface_uses = {"contact", "bodies", sizeof surface_keys / sizeof *surface_keys,
                                              surface_keys};
static const conditional_keys profile_uses = {"obstacle", "profile", sizeof profile_keys / sizeof *profile_keys,
                                              profile_keys};

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

static bool has_paper_law(const schema_instance *obstacle)
{
    return strcmp(schema_text(obstacle, "friction_law"), "paper") == 0;
}

/* Squares of lengths must be numbers that can be computed with. */
static bool is_degenerate(const double *a)
{
    const double x = a[2] - a[0], y = a[3] - a[1];
    return !isnormal(x * x + y * y);
}

/* Reports the first degenerate segment of an obstacle, from 1, and how many there are. */
static bool check_segments(const double *points, size_t n_points, size_t number, namelist_place place,
                           namelist_errors *errors)
{
    size_t first = 0, n = 0;
    char more[80] = "";
    for (size_t k = n_points; k-- > 1;) {
        if (!is_degenerate(points + 2 * k - 2)) continue;
        first = k;
        n++;
    }
    if (n == 0) return true;
    const double *a = points + 2 * first - 2, length = hypot(a[2] - a[0], a[3] - a[1]);
    if (n > 1) (void)snprintf(more, sizeof more, "; so it is with %zu of %zu segments", n, n_points - 1);
    namelist_errors_add(errors, place,
                        "'points' in &obstacle: segment %zu of obstacle %zu, from (%g, %g) to (%g, %g) m, %s%s", first,
                        number, a[0], a[1], a[2], a[3],
                        length > 1.0 ? "is too long" : (length > 0.0 ? "is too short" : "has no length"), more);
    return false;
}

/* Reports two segments of an obstacle that have more than a point in common that joins them. False when memory runs
 * out. */
static bool check_crossings(const dem_obstacle *obstacle, size_t number, namelist_place place, namelist_errors *errors)
{
    dem_index pair[2];
    if (dem_obstacle_check(obstacle, pair) == DEM_ERROR_MEMORY) return false;
    if (pair[0] < 0) return true;
    const bool follows = pair[1] == (pair[0] + 1) % (obstacle->n_points - 1);
    namelist_errors_add(errors, place,
                        follows ? "'points' in &obstacle: segment %lld of obstacle %zu goes back over segment %lld"
                                : "'points' in &obstacle: segment %lld of obstacle %zu meets segment %lld",
                        (long long)pair[follows] + 1, number, (long long)pair[!follows] + 1);
    return true;
}

static bool has_profile(const schema_instance *obstacle)
{
    return strcmp(schema_text(obstacle, "profile"), "polyline") != 0;
}

/* m along x. */
static double extent_of(const schema_value *points)
{
    return points->reals[points->count - 2] - points->reals[0];
}

static double count_segments(const schema_instance *obstacle)
{
    const double extent = extent_of(schema_value_of(obstacle, "points")), length = schema_real(obstacle, "resolution");
    return length > 0.0 ? ceil(extent / length * (1.0 - 1e-12)) : default_segments; /* rounding adds none */
}

static bool check_increase(const schema_instance *obstacle, size_t number, namelist_errors *errors)
{
    const schema_value *points = schema_value_of(obstacle, "points");
    for (int k = 2; k < points->count; k += 2) {
        if (points->reals[k] > points->reals[k - 2]) continue;
        namelist_errors_add(errors, points->place,
                            "'points' in &obstacle must increase in x for profile '%s'; point %d of obstacle %zu is at "
                            "%g m, the one before at %g m",
                            schema_text(obstacle, "profile"), k / 2 + 1, number, points->reals[k],
                            points->reals[k - 2]);
        return false;
    }
    return true;
}

static void check_resolution(const schema_instance *obstacle, size_t number, namelist_errors *errors)
{
    const schema_value *points = schema_value_of(obstacle, "points");
    const schema_value *resolution = schema_value_of(obstacle, "resolution");
    const double extent = extent_of(points), n = count_segments(obstacle), length = extent / n;
    const double largest = fmax(fabs(points->reals[0]), fabs(points->reals[points->count - 2]));
    if (resolution->given && schema_real(obstacle, "resolution") > extent)
        namelist_errors_add(errors, resolution->place,
                            "'resolution' in &obstacle must not exceed the extent of its points, %g m, got %g m",
                            extent, schema_real(obstacle, "resolution"));
    else if (n > PROFILE_MAX)
        namelist_errors_add(errors, resolution->place,
                            "'resolution' in &obstacle, %g m, makes %g segments of obstacle %zu; the limit is %d",
                            schema_real(obstacle, "resolution"), n, number, PROFILE_MAX);
    else if (largest * DBL_EPSILON > lost * length)
        namelist_errors_add(errors, resolution->place,
                            "obstacle %zu has points at x of up to %g m, so large that rounding blurs its segments of "
                            "%g m",
                            number, largest, length);
}

/* Segments may come out half as long as asked for. */
static void check_correlation(const schema_instance *obstacle, namelist_errors *errors)
{
    const schema_value *resolution = schema_value_of(obstacle, "resolution");
    const double correlation = schema_real(obstacle, "correlation");
    const double length =
        resolution->given ? resolution->reals[0] : extent_of(schema_value_of(obstacle, "points")) / default_segments;
    const int coarsest = PROFILE_COARSEST, finest = PROFILE_FINEST / 2;
    if (correlation <= 0.0 || (length <= correlation / coarsest && length >= correlation / finest)) return;
    namelist_errors_add(errors, resolution->place,
                        "'resolution' in &obstacle must be 1/%d to 1/%d of 'correlation', %g m, got %g m%s", finest,
                        coarsest, correlation, length, resolution->given ? "" : ", the default");
}

/* The default, none by Coulomb's law, would stop all sliding by the paper's. */
static void check_friction(const schema_instance *obstacle, namelist_errors *errors)
{
    const schema_value *friction = schema_value_of(obstacle, "friction");
    if (!has_paper_law(obstacle) || friction->faulty) return;
    if (!friction->given)
        namelist_errors_add(errors, obstacle->place,
                            "'friction' in &obstacle must be given for friction_law 'paper', in [0, 1]: an impact "
                            "leaves this part of the tangential velocity, and 1 is frictionless");
    else if (friction->reals[0] > 1.0)
        namelist_errors_add(errors, friction->place,
                            "'friction' in &obstacle must be in [0, 1] for friction_law 'paper', got %g",
                            friction->reals[0]);
}

static void check_obstacle(const schema_instance *obstacle, size_t number, namelist_errors *errors)
{
    const schema_value *points = schema_value_of(obstacle, "points");
    const bool pairs = points->count % 2 == 0;
    conditional_keys_check(obstacle, &profile_uses, errors);
    check_friction(obstacle, errors);
    motion_check(obstacle, errors);
    if (!pairs)
        namelist_errors_add(errors, points->place, "'points' in &obstacle must be pairs of x and y, got %d values",
                            points->count);
    if (!pairs || points->faulty || points->count == 0) return;
    const bool good = check_segments(points->reals, (size_t)points->count / 2, number, points->place, errors);
    if (!good || !has_profile(obstacle) || !check_increase(obstacle, number, errors)) return;
    if (schema_value_of(obstacle, "resolution")->faulty) return;
    const size_t before = errors->n;
    check_resolution(obstacle, number, errors);
    if (errors->n == before) check_correlation(obstacle, errors);
}

static void check_frames(const schema_deck *groups, namelist_errors *errors)
{
    const schema_value *interval = schema_value_of(schema_get(groups, "output", 0), "frame_interval");
    const double frames = schema_real(schema_get(groups, "run", 0), "t_end") / interval->reals[0];
    if (frames > most_frames && !interval->faulty)
        namelist_errors_add(errors, interval->place,
                            "'frame_interval' in &output, %g s, makes %g frames until 't_end'; the limit is %.0f",
                            interval->reals[0], frames, most_frames);
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
    else if (ends_with(text, ".obstacle") || ends_with(text, ".part") || ends_with_number(text))
        namelist_errors_add(errors, name->place,
                            "'name' in &output must not end in '.obstacle', '.part' or a '.' and five digits or more: "
                            "other files are called so");
}

static void check(const schema_deck *groups, namelist_errors *errors)
{
    body_check_all(groups, errors);
    for (size_t k = 0; k < schema_count(groups, "obstacle"); k++)
        check_obstacle(schema_get(groups, "obstacle", k), k + 1, errors);
    loading_check_all(groups, errors);
    conditional_keys_check(schema_get(groups, "contact", 0), &surface_uses, errors);
    check_solver(schema_get(groups, "solver", 0), errors);
    probes_check(groups, errors);
    check_name(schema_get(groups, "output", 0), errors);
    check_frames(groups, errors);
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
    options->checkpoint_steps = (dem_index)schema_real(solver, "checkpoint_steps");
    options->rtol = schema_real(solver, "rtol");
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
    d->double_precision = strcmp(schema_text(output, "precision"), "double") == 0;
    d->deflate = (int)schema_real(output, "deflate");
    d->events = schema_real(output, "events") != 0.0;
    d->fields = fields_of(schema_value_of(output, "fields"));
    d->peak_every = (dem_index)schema_real(output, "peak_every");
    d->most_stressed = (dem_index)schema_real(output, "most_stressed");
    d->title = strdup(schema_text(run, "title"));
    d->name = strdup(schema_text(output, "name"));
    return d->title != NULL && d->name != NULL;
}

/* ---- obstacles, bodies ---- */

/* The points that bodies touch; NULL when memory runs out. */
static double *make_points(size_t *n_points, const schema_instance *obstacle)
{
    const schema_value *from = schema_value_of(obstacle, "points");
    profile_recipe recipe = {.points = from->reals,
                             .n_points = (size_t)from->count / 2,
                             .smooth = strcmp(schema_text(obstacle, "profile"), "smooth") == 0,
                             .roughness = schema_real(obstacle, "roughness"),
                             .correlation = schema_real(obstacle, "correlation"),
                             .seed = (unsigned long)schema_real(obstacle, "seed")};
    if (has_profile(obstacle)) recipe.n_segments = (size_t)count_segments(obstacle);
    *n_points = has_profile(obstacle) ? recipe.n_segments + 1 : recipe.n_points;
    double *points = calloc(2 * *n_points, sizeof *points);
    if (points == NULL) return NULL;
    if (!has_profile(obstacle)) return memcpy(points, from->reals, 2 * *n_points * sizeof *points);
    if (profile_sample(points, &recipe) == DEM_OK) return points;
    free(points);
    return NULL;
}

static bool set_obstacles(deck *d, const schema_deck *groups, namelist_errors *errors)
{
    const size_t n = schema_count(groups, "obstacle");
    d->obstacles = calloc(n + 1, sizeof *d->obstacles);
    for (size_t k = 0; k < n && d->obstacles != NULL; k++) {
        const schema_instance *group = schema_get(groups, "obstacle", k);
        size_t n_points;
        double *points = make_points(&n_points, group);
        if (points == NULL) return false;
        const bool good = check_segments(points, n_points, k + 1, schema_place(group, "points"), errors);
        dem_obstacle *made = &d->obstacles[d->n_obstacles++];
        *made = (dem_obstacle){.struct_size = sizeof(dem_obstacle),
                               .n_points = (dem_index)n_points,
                               .points = points,
                               .restitution = schema_real(group, "restitution"),
                               .friction = schema_real(group, "friction"),
                               .friction_law = has_paper_law(group) ? DEM_FRICTION_PAPER : DEM_FRICTION_COULOMB};
        motion_set(made, group);
        if (good && !check_crossings(made, k + 1, schema_place(group, "points"), errors)) return false;
    }
    return d->obstacles != NULL;
}

/* The deck's folder with its '/', or ""; NULL when memory runs out. */
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return strndup(path, slash == NULL ? 0 : (size_t)(slash - path) + 1);
}

/* Puts a file's whole path in the place of its name. */
static bool name_file(schema_instance *body, const char *folder, namelist_errors *errors)
{
    char here[4096] = "", *path = body_geometry_file(folder, body);
    if (path == NULL) return false;
    if (path[0] != '/' && getcwd(here, sizeof here) == NULL)
        namelist_errors_add(errors, schema_value_of(body, "file")->place, "%s: %s", path, strerror(errno));
    const size_t size = strlen(here) + strlen(path) + 2;
    char *whole = malloc(size);
    if (whole != NULL) (void)snprintf(whole, size, "%s%s%s", here, path[0] == '/' ? "" : "/", path);
    const bool good = whole != NULL && schema_set_text(body, "file", whole);
    free(whole);
    free(path);
    return good;
}

/* Puts the hash of its bytes there: where a file lies makes no other problem. */
static bool hash_file(schema_instance *body, namelist_errors *errors)
{
    const char *path = schema_text(body, "file");
    char bytes[4096], text[32];
    uint64_t hash = DIGEST_BEGIN;
    FILE *file = fopen(path, "rb");
    for (size_t n; file != NULL && (n = fread(bytes, 1, sizeof bytes, file)) > 0;) hash = digest_add(hash, bytes, n);
    if (file == NULL || ferror(file))
        namelist_errors_add(errors, schema_value_of(body, "file")->place, "%s: %s", path, strerror(errno));
    if (file != NULL) (void)fclose(file);
    (void)snprintf(text, sizeof text, "fnv1a:%016llx", (unsigned long long)hash);
    return schema_set_text(body, "file", text);
}

/* Whether a group is a body that is made from a file. */
static bool is_file(const schema_instance *group)
{
    return strcmp(group->group->name, "body") == 0 && schema_given(group, "file");
}

/* Echoes and hashes; to be called when the bodies are built, since it changes the names of files in `groups`. */
static bool set_texts(deck *d, schema_deck *groups, const char *folder, namelist_errors *errors)
{
    char *bare = NULL;
    for (size_t k = 0; k < groups->n_instances; k++)
        if (is_file(&groups->instances[k]) && !name_file(&groups->instances[k], folder, errors)) return false;
    if (errors->n > 0) return true;
    if (!schema_echo(groups, SCHEMA_MARKED, &d->echo)) return false;
    for (size_t k = 0; k < groups->n_instances; k++)
        if (is_file(&groups->instances[k]) && !hash_file(&groups->instances[k], errors)) return false;
    if (!schema_echo(groups, SCHEMA_PHYSICS, &d->physics) || !schema_echo(groups, SCHEMA_COURSE, &d->course) ||
        !schema_echo(groups, SCHEMA_BARE, &bare))
        return false;
    d->hash = digest_add(DIGEST_BEGIN, d->physics, strlen(d->physics));
    d->run_hash = digest_add(DIGEST_BEGIN, bare, strlen(bare));
    free(bare);
    return true;
}

static bool set_body(deck *d, body_start *start, const body_scene *scene, size_t k, namelist_errors *errors)
{
    const schema_instance *group = schema_get(scene->groups, "body", k);
    dem_lattice body = dem_lattice_empty();
    if (!body_build(&body, &d->bodies[k], start, scene, k, errors)) return false;
    const dem_status status = dem_lattice_append(&d->lattice, &body);
    dem_lattice_free(&body);
    if (status == DEM_ERROR_MEMORY) return false;
    if (status != DEM_OK) namelist_errors_add(errors, group->place, "%s", dem_status_message());
    return true;
}

/* By the rule of the library, which has the last word. */
static bool check_starts(const deck *d, const body_start *starts, const body_scene *scene, namelist_errors *errors)
{
    const size_t n = schema_count(scene->groups, "body");
    double spacing = d->options.spacing > 0.0 ? d->options.spacing : (double)INFINITY;
    for (size_t k = 0; k < n && !(d->options.spacing > 0.0); k++) spacing = fmin(spacing, starts[k].rest_length);
    const double penetration_tolerance =
        d->options.penetration_tolerance > 0.0 ? d->options.penetration_tolerance : 1e-6 * spacing;
    for (size_t k = 0; k < n; k++)
        if (!body_check_start(scene, k, &starts[k], penetration_tolerance, errors)) return false;
    return true;
}

static bool set_probes(deck *d, const schema_deck *groups, const placement *bodies, namelist_errors *errors)
{
    const size_t n = schema_count(groups, "probe");
    d->probes = calloc(n + 1, sizeof *d->probes);
    if (d->probes == NULL) return false;
    d->n_probes = (dem_index)n;
    return probes_find(d->probes, groups, &d->lattice, bodies, errors);
}

static bool set_bodies(deck *d, const schema_deck *groups, const char *folder, namelist_errors *errors)
{
    dem_obstacle *still = motion_still(d->obstacles, d->n_obstacles);
    const body_scene scene = {.groups = groups,
                              .folder = folder,
                              .obstacles = still,
                              .n_obstacles = d->n_obstacles,
                              .gravity = {d->options.gravity[0], d->options.gravity[1]}};
    const size_t n = schema_count(groups, "body");
    body_start *starts = calloc(n + 1, sizeof *starts);
    placement *places = calloc(n + 1, sizeof *places);
    d->bodies = calloc(n + 1, sizeof *d->bodies);
    d->n_bodies = n;
    bool good = starts != NULL && places != NULL && d->bodies != NULL && still != NULL;
    for (size_t k = 0; k < n && good; k++) {
        const dem_index first = d->lattice.n_nodes;
        good = set_body(d, &starts[k], &scene, k, errors);
        places[k] = (placement){.first = first,
                                .n_nodes = d->lattice.n_nodes - first,
                                .angle = starts[k].angle,
                                .offset = {starts[k].offset[0], starts[k].offset[1]}};
    }
    good = good && check_starts(d, starts, &scene, errors);
    if (good && errors->n == 0) precision_check(groups, &d->lattice, errors);
    if (good && errors->n == 0)
        good = loading_build(&d->boundaries, &d->n_boundaries, &d->lattice, places, groups, errors);
    if (good && errors->n == 0) good = set_probes(d, groups, places, errors);
    d->options.boundaries = d->boundaries;
    d->options.n_boundaries = d->n_boundaries;
    motion_free_still(still, d->n_obstacles);
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
    conditional_keys_drop(&d->groups, &profile_uses);
    conditional_keys_drop(&d->groups, &surface_uses);
    motion_drop_unused(&d->groups);
    return set_scalars(d, &d->groups);
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

deck_status deck_build(deck *d, namelist_errors *errors)
{
    bool good = set_obstacles(d, &d->groups, errors);
    if (good && errors->n == 0) good = set_bodies(d, &d->groups, d->folder, errors);
    if (good && errors->n == 0) good = set_texts(d, &d->groups, d->folder, errors);
    return conclude(d, good ? DECK_OK : DECK_MEMORY, errors);
}

void deck_free(deck *d)
{
    for (dem_index k = 0; k < d->n_obstacles; k++) free((void *)d->obstacles[k].points);
    free(d->obstacles);
    schema_free(&d->groups);
    probes_free(d->probes, (size_t)d->n_probes);
    dem_lattice_free(&d->lattice);
    free(d->bodies);
    loading_free(d->boundaries, d->n_boundaries);
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
