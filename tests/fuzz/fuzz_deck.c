/* SPDX-License-Identifier: BSD-3-Clause */
/* Any bytes may come as a deck: it is refused with a fault that has a place, or makes a model and a simulation, and its
 * echo is a deck of the same run. Decks of large bodies are left out, and those that name files other than ours. */
#include "unit/whole_deck.h"

#include <math.h>

#include "bytes.h"
#include "schema.h"
#include "ask.h"
#include "scratch.h"

static const double most_nodes = 2000.0, most_segments = 2000.0, most_pores = 50.0;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* ---- files that decks may name ---- */

static const char image[] = "P2 4 4 1\n1 1 1 1  1 1 1 1  1 1 0 1  1 1 1 1\n";
static const char mesh[] = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
                           "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n"
                           "$Elements\n1 2 1 2\n2 1 2 2\n1 1 2 3\n2 1 3 4\n$EndElements\n";

static void write_lattice(void)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 1.0 / 3.0,
                                 .density = 1050.0,
                                 .thickness = 1.0,
                                 .guard = 0.02};
    const dem_options options = dem_options_default();
    const dem_trajectory_options bare = dem_trajectory_options_default();
    dem_lattice lattice = dem_lattice_empty();
    dem_model *model;
    dem_simulation *simulation;
    dem_trajectory *trajectory;
    if (dem_lattice_rectangle(&lattice, 0.02, 0.02, 0.01) != DEM_OK ||
        dem_lattice_assemble(&lattice, &rubber) != DEM_OK || dem_model_create(&model, &lattice, NULL, 0) != DEM_OK ||
        dem_simulation_create(&simulation, model, &options) != DEM_OK ||
        dem_trajectory_create(&trajectory, scratch_path("a.vtkhdf"), simulation, &bare) != DEM_OK ||
        dem_trajectory_finish(trajectory) != DEM_OK)
        abort();
    dem_trajectory_destroy(trajectory);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    dem_lattice_free(&lattice);
}

static void write_files(void)
{
    static bool written = false;
    if (written) return;
    scratch_write(scratch_path("a.pgm"), image, sizeof image - 1);
    scratch_write(scratch_path("a.msh"), mesh, sizeof mesh - 1);
    write_lattice();
    written = true;
}

static bool is_ours(const char *file)
{
    return strcmp(file, "a.pgm") == 0 || strcmp(file, "a.msh") == 0 || strcmp(file, "a.vtkhdf") == 0;
}

/* ---- what a deck would build ---- */

static double nodes_of(const schema_instance *body)
{
    const schema_value *points = schema_value_of(body, "points"), *size = schema_value_of(body, "size");
    const double radius = schema_real(body, "radius"), scale = schema_real(body, "scale");
    double low[2] = {-radius, -radius}, high[2] = {radius, radius};
    for (int k = 0; k < points->count; k++) {
        low[k % 2] = fmin(low[k % 2], points->reals[k]);
        high[k % 2] = fmax(high[k % 2], points->reals[k]);
    }
    for (int c = 0; c < 2; c++) high[c] += (size->count == 2 ? size->reals[c] : 0.0) + 4.0 * scale;
    const double spacing = schema_real(body, "spacing");
    return spacing > 0.0 ? ((high[0] - low[0]) / spacing + 3.0) * ((high[1] - low[1]) / spacing + 3.0) : 0.0;
}

static double segments_of(const schema_instance *obstacle)
{
    const schema_value *points = schema_value_of(obstacle, "points");
    const double resolution = schema_real(obstacle, "resolution");
    if (points->count < 2 || resolution == 0.0) return (double)points->count;
    return fabs(points->reals[points->count - 2] - points->reals[0]) / resolution;
}

static double pores_of(const schema_deck *groups, const schema_instance *pores)
{
    const schema_value *radius = schema_value_of(pores, "radius");
    double area = 0.0;
    for (size_t k = 0; k < schema_count(groups, "body"); k++) {
        const schema_instance *body = schema_get(groups, "body", k);
        area = fmax(area, nodes_of(body) * schema_real(body, "spacing") * schema_real(body, "spacing"));
    }
    const double least = radius->count > 0 ? radius->reals[0] * radius->reals[0] : 0.0;
    return schema_real(pores, "number") + schema_real(pores, "porosity") * area / least;
}

static bool is_small(const schema_deck *groups)
{
    double nodes = 0.0, segments = 0.0, pores = 0.0;
    for (size_t k = 0; k < groups->n_instances; k++) {
        const schema_instance *group = &groups->instances[k];
        if (strcmp(group->group->name, "body") == 0) {
            if (schema_given(group, "file") && !is_ours(schema_text(group, "file"))) return false;
            nodes += nodes_of(group) + 20.0;
        }
        if (strcmp(group->group->name, "obstacle") == 0) segments += segments_of(group);
        if (strcmp(group->group->name, "pores") == 0) pores += pores_of(groups, group);
        if (strcmp(group->group->name, "solver") == 0 && schema_real(group, "threads") > 2.0) return false;
    }
    return nodes <= most_nodes && segments <= most_segments && pores <= most_pores;
}

static bool may_be_built(const char *text, size_t size)
{
    namelist list;
    namelist_errors errors = {0};
    schema_deck groups = {0};
    require(namelist_parse(&list, text, size, &errors) && schema_resolve(&groups, &list, &errors));
    const bool small = is_small(&groups);
    schema_free(&groups);
    namelist_free(&list);
    namelist_errors_free(&errors);
    return small;
}

/* ---- what must hold ---- */

static void check_faults(const namelist_errors *errors)
{
    require(errors->n > 0);
    for (size_t k = 0; k < errors->n; k++) require(errors->list[k].text[0] != '\0' && errors->list[k].place.line >= 0);
}

/* That of a deck whose bodies come from files has their whole paths. */
static void check_echo(const deck *d)
{
    const char *path = scratch_path("echo.nml");
    namelist_errors errors = {0};
    deck again;
    scratch_write(path, d->echo, strlen(d->echo));
    require(whole_deck_read(&again, path, &errors) == DECK_OK && again.hash == d->hash &&
            again.run_hash == d->run_hash);
    namelist_errors_free(&errors);
    deck_free(&again);
}

/* As dem_batch does. */
static void build(const deck *d)
{
    dem_model *model = NULL;
    dem_simulation *simulation = NULL;
    require(dem_model_create(&model, &d->lattice, d->obstacles, d->n_obstacles) == DEM_OK);
    const dem_status status = dem_simulation_create(&simulation, model, &d->options);
    require(status == DEM_OK || status == DEM_ERROR_MODEL || status == DEM_ERROR_ARGUMENT);
    if (status == DEM_OK) require(isfinite(ask_energy(simulation).ledger));
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    namelist_errors errors = {0};
    deck d;
    write_files();
    if (size == 0 || !may_be_built((const char *)data, size)) return 0;
    scratch_write(scratch_path("a.nml"), data, size);
    const deck_status status = whole_deck_read(&d, scratch_path("a.nml"), &errors);
    require(status == DECK_OK || status == DECK_INVALID);
    if (status == DECK_OK) {
        check_echo(&d);
        build(&d);
    } else {
        check_faults(&errors);
    }
    namelist_errors_free(&errors);
    deck_free(&d);
    return 0;
}
