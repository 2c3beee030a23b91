/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads the file, has its groups checked, and turns them into what the library takes. Bodies are body.c's business. */
#include "deck.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "body.h"
#include "schema.h"

enum { MAX_SIZE = 1 << 20 }; /* bytes of a deck */

/* ---- the file ---- */

static deck_status refuse(namelist_errors *errors, const char *why)
{
    namelist_errors_add(errors, (namelist_place){0, 0}, "%s", why);
    return DECK_UNREADABLE;
}

/* `text` has MAX_SIZE + 2 bytes: one more than a deck may have tells that it is too long. */
static deck_status read_bytes(char *text, size_t *size, int file, namelist_errors *errors)
{
    struct stat info;
    if (fstat(file, &info) != 0) return refuse(errors, strerror(errno));
    if (!S_ISREG(info.st_mode)) return refuse(errors, "not a regular file");
    for (*size = 0; *size <= MAX_SIZE;) {
        const ssize_t n = read(file, text + *size, MAX_SIZE + 1 - *size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return refuse(errors, strerror(errno));
        if (n == 0) break;
        *size += (size_t)n;
    }
    text[*size] = '\0';
    if (*size > MAX_SIZE) return refuse(errors, "the file is larger than 1 MiB");
    return *size == 0 ? refuse(errors, "the file is empty") : DECK_OK;
}

static deck_status read_text(deck *d, size_t *size, namelist_errors *errors)
{
    d->source = malloc(MAX_SIZE + 2);
    if (d->source == NULL) return DECK_MEMORY;
    const int file = open(d->path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); /* a pipe without writer must not hang */
    if (file < 0) return refuse(errors, strerror(errno));
    const deck_status status = read_bytes(d->source, size, file, errors);
    (void)close(file);
    return status;
}

/* ---- checks ---- */

static void check_points(const schema_instance *obstacle, namelist_errors *errors)
{
    const schema_value *points = schema_value_of(obstacle, "points");
    const double *x = points->reals;
    if (points->count % 2 != 0)
        namelist_errors_add(errors, points->place, "'points' in &obstacle must be pairs of x and y, got %d values",
                            points->count);
    for (int k = 0; points->count % 2 == 0 && k + 1 < points->count / 2; k++)
        if (x[2 * k] == x[2 * k + 2] && x[2 * k + 1] == x[2 * k + 3])
            namelist_errors_add(errors, points->place,
                                "'points' in &obstacle: segment %d has no length, both its ends are (%g, %g)", k + 1,
                                x[2 * k], x[2 * k + 1]);
}

static void check_name(const schema_instance *output, namelist_errors *errors)
{
    const schema_value *name = schema_value_of(output, "name");
    const char *text = schema_text(output, "name");
    const size_t length = strlen(text);
    if (length == 0 || length > 100 || strchr(text, '/') != NULL || text[0] == '.' || text[0] == '-')
        namelist_errors_add(errors, name->place,
                            "'name' in &output must have 1 to 100 characters, no '/', and not begin with '.' or '-'");
}

static void check(const schema_deck *groups, namelist_errors *errors)
{
    body_check_all(groups, errors);
    for (size_t k = 0; k < schema_count(groups, "obstacle"); k++)
        check_points(schema_get(groups, "obstacle", k), errors);
    check_name(schema_get(groups, "output", 0), errors);
}

/* ---- scalars ---- */

static const char *const method_names[] = {[DEM_METHOD_FEHLBERG45] = "fehlberg45",
                                           [DEM_METHOD_DOPRI45] = "dopri45",
                                           [DEM_METHOD_CASHKARP45] = "cashkarp45",
                                           [DEM_METHOD_ZONNEVELD34] = "zonneveld34",
                                           [DEM_METHOD_BS23] = "bs23"};

/* The table of keys admits no other name. */
static dem_method method_of(const char *name)
{
    size_t k = 0;
    while (strcmp(name, method_names[k]) != 0) k++;
    return (dem_method)k;
}

static void set_options(dem_options *options, const schema_deck *groups)
{
    const schema_instance *run = schema_get(groups, "run", 0), *contact = schema_get(groups, "contact", 0);
    const schema_instance *solver = schema_get(groups, "solver", 0);
    *options = dem_options_default();
    for (int c = 0; c < 2; c++) options->gravity[c] = schema_value_of(run, "gravity")->reals[c];
    options->method = method_of(schema_text(solver, "method"));
    options->rtol = schema_real(solver, "rtol");
    options->spacing = schema_real(solver, "spacing");
    options->v_scale = schema_real(solver, "v_scale");
    options->max_step = schema_real(solver, "max_step");
    options->skin = schema_real(contact, "skin");
    options->rest_speed = schema_real(contact, "rest_speed");
    options->max_impacts = (dem_index)schema_real(contact, "max_impacts");
}

static bool set_scalars(deck *d, const schema_deck *groups)
{
    const schema_instance *run = schema_get(groups, "run", 0), *output = schema_get(groups, "output", 0);
    set_options(&d->options, groups);
    d->t_end = schema_real(run, "t_end");
    d->frame_interval = schema_real(output, "frame_interval");
    d->double_precision = strcmp(schema_text(output, "precision"), "double") == 0;
    d->deflate = (int)schema_real(output, "deflate");
    d->title = strdup(schema_text(run, "title"));
    d->name = strdup(schema_text(output, "name"));
    return d->title != NULL && d->name != NULL;
}

/* ---- obstacles, bodies ---- */

static bool set_obstacles(deck *d, const schema_deck *groups)
{
    const size_t n = schema_count(groups, "obstacle");
    d->obstacles = calloc(n + 1, sizeof *d->obstacles);
    for (size_t k = 0; k < n && d->obstacles != NULL; k++) {
        const schema_instance *group = schema_get(groups, "obstacle", k);
        const schema_value *from = schema_value_of(group, "points");
        double *points = calloc((size_t)from->count, sizeof *points);
        if (points == NULL) return false;
        memcpy(points, from->reals, (size_t)from->count * sizeof *points);
        d->obstacles[d->n_obstacles++] = (dem_obstacle){
            .n_points = from->count / 2, .points = points, .restitution = schema_real(group, "restitution")};
    }
    return d->obstacles != NULL;
}

/* The deck's folder with its '/', or ""; NULL when memory runs out. */
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return strndup(path, slash == NULL ? 0 : (size_t)(slash - path) + 1);
}

static uint64_t hash_bytes(uint64_t hash, const char *bytes, size_t n)
{
    for (size_t k = 0; k < n; k++) hash = (hash ^ (unsigned char)bytes[k]) * UINT64_C(0x100000001b3); /* FNV-1a */
    return hash;
}

static bool hash_file(uint64_t *hash, const body_scene *scene, const schema_instance *body, namelist_errors *errors)
{
    char bytes[4096], *path = body_file(scene, body);
    if (path == NULL) return false;
    FILE *file = fopen(path, "rb");
    for (size_t n; file != NULL && (n = fread(bytes, 1, sizeof bytes, file)) > 0;) *hash = hash_bytes(*hash, bytes, n);
    if (file == NULL || ferror(file))
        namelist_errors_add(errors, schema_value_of(body, "file")->place, "%s: %s", path, strerror(errno));
    if (file != NULL) (void)fclose(file);
    free(path);
    return true;
}

static bool set_bodies(deck *d, const schema_deck *groups, const char *folder, namelist_errors *errors)
{
    const body_scene scene = {.groups = groups,
                              .folder = folder,
                              .obstacles = d->obstacles,
                              .n_obstacles = d->n_obstacles,
                              .gravity = {d->options.gravity[0], d->options.gravity[1]}};
    for (size_t k = 0; k < schema_count(groups, "body"); k++) {
        const schema_instance *group = schema_get(groups, "body", k);
        dem_lattice body;
        if (!body_build(&body, &scene, k, errors)) return false;
        const dem_status status = dem_lattice_append(&d->lattice, &body);
        dem_lattice_free(&body);
        if (status == DEM_ERROR_MEMORY) return false;
        if (status != DEM_OK) namelist_errors_add(errors, group->place, "%s", dem_status_message());
        if (strcmp(schema_text(group, "shape"), "file") == 0 && errors->n == 0 &&
            !hash_file(&d->hash, &scene, group, errors))
            return false;
    }
    return true;
}

/* ---- all of it ---- */

static deck_status interpret(deck *d, const schema_deck *groups, namelist_errors *errors)
{
    char *folder = NULL;
    bool good = schema_echo(groups, false, &d->echo) && schema_echo(groups, true, &d->physics);
    good = good && set_scalars(d, groups) && set_obstacles(d, groups);
    if (good) {
        d->hash = hash_bytes(UINT64_C(0xcbf29ce484222325), d->physics, strlen(d->physics));
        folder = folder_of(d->path);
        good = folder != NULL && set_bodies(d, groups, folder, errors);
    }
    free(folder);
    if (!good) return DECK_MEMORY;
    return errors->n > 0 ? DECK_INVALID : DECK_OK;
}

static deck_status resolve(deck *d, size_t size, namelist_errors *errors)
{
    namelist list;
    schema_deck groups = {0};
    deck_status status = DECK_MEMORY;
    if (namelist_parse(&list, d->source, size, errors) && schema_resolve(&groups, &list, errors)) {
        check(&groups, errors);
        status = errors->n > 0 ? DECK_INVALID : interpret(d, &groups, errors);
    }
    schema_free(&groups);
    namelist_free(&list);
    namelist_errors_sort(errors);
    return errors->out_of_memory ? DECK_MEMORY : status;
}

const char *deck_method_name(dem_method method)
{
    return method_names[method];
}

deck_status deck_read(deck *out, const char *path, namelist_errors *errors)
{
    deck d = {.path = strdup(path)};
    size_t size = 0;
    dem_lattice_init(&d.lattice);
    deck_status status = d.path == NULL ? DECK_MEMORY : read_text(&d, &size, errors);
    if (status == DECK_OK) status = resolve(&d, size, errors);
    if (status != DECK_OK) deck_free(&d);
    *out = d;
    return status;
}

void deck_free(deck *d)
{
    for (dem_index k = 0; k < d->n_obstacles; k++) free((void *)d->obstacles[k].points);
    free(d->obstacles);
    dem_lattice_free(&d->lattice);
    free(d->path);
    free(d->source);
    free(d->echo);
    free(d->physics);
    free(d->title);
    free(d->name);
    *d = (deck){0};
    dem_lattice_init(&d->lattice);
}
