/* SPDX-License-Identifier: BSD-3-Clause */
/* The model: validates a lattice and obstacles, copies them, unless it borrows the lattice, and compiles what a run
 * reads often: springs and triangles in rows, the layout of the sweep, the surface, obstacles. It is immutable
 * afterwards, but for what is made when it is first asked for (base/on_demand.h), and may be shared by simulations and
 * threads. The first fault is reported with node, place and numbers. How each part is compiled is in its own file; what
 * changes during a run belongs to the simulation (simulation/). */
#include "model/model.h"

#include <stdlib.h>
#include <string.h>

#include "base/reduce.h"
#include "base/status.h"
#include "base/struct_size.h"
#include "lattice/lattice.h"
#include "lattice/lattice_arrays.h"
#include "lattice/mesh_edges.h"
#include "model/model_rules.h"
#include "obstacle/obstacle_input.h"
#include "obstacle/obstacle_set.h"
#include "obstacle/point_gap.h"

/* ---- validation ---- */

/* A node without springs is legal only as a body of its own, or of a rigid one. */
static dem_status check_bodies(const dem_model *m)
{
    const dem_index own[2] = {0, m->lattice.n_nodes};
    unsigned char *is_loose = lattice_zeros(own[1], sizeof *is_loose);
    CHECK_MEMORY(is_loose);
    for (dem_index i = 0; i < own[1]; i++)
        is_loose[i] = m->springs.row[i] == m->springs.row[i + 1] && !rigid_bodies_at(&m->rigid, i);
    const dem_status status = model_rules_check_bodies(&m->lattice, m->ranks, own, is_loose);
    free(is_loose);
    return status;
}

/* ---- compilation ---- */

/* Fills in what the absence of an array stands for, so that later code need not ask. A fixed node has no velocity. */
static dem_status fill_defaults(dem_lattice *l)
{
    const dem_index n = l->n_nodes;
    if (l->body == NULL) CHECK_MEMORY(l->body = lattice_zeros(n, sizeof *l->body));
    if (l->velocity == NULL) CHECK_MEMORY(l->velocity = lattice_zeros(2 * n, sizeof *l->velocity));
    if (l->position == NULL) l->position = l->x; /* neither is changed */
    if (l->flags == NULL) {
        CHECK_MEMORY(l->flags = lattice_zeros(n, sizeof *l->flags));
        TRY(mesh_edges_contact_flags(l->flags, l));
    }
    for (dem_index i = 0; i < n; i++)
        if (l->flags[i] & DEM_NODE_FIXED) vec2_put(l->velocity, i, (vec2){0.0, 0.0});
    return DEM_OK;
}

/* The inverse mass of a fixed node is 0: no force accelerates it. */
static dem_status compile_nodes(dem_model *m)
{
    const dem_lattice *l = &m->lattice;
    m->inverse_mass = lattice_zeros(l->n_nodes, sizeof *m->inverse_mass);
    CHECK(m->inverse_mass, DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)l->n_nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const int fixed = l->flags[i] & DEM_NODE_FIXED;
        m->inverse_mass[i] = fixed ? 0.0 : 1.0 / l->mass[i];
    }
    return DEM_OK;
}

/* All arrays but the velocities, which may have to be changed; what no item is of is as if it were missing. */
static dem_status borrow(dem_model *m, const dem_lattice *lattice)
{
    m->borrowed = *lattice;
    m->borrowed.velocity = NULL;
    for (int k = 0; k < LATTICE_ARRAYS; k++)
        if (lattice_count(lattice, lattice_arrays[k].of) == 0)
            lattice_array_put(&m->borrowed, &lattice_arrays[k], NULL);
    m->lattice = m->borrowed;
    if (lattice->velocity == NULL) return DEM_OK;
    const size_t size = 2 * (size_t)lattice->n_nodes * sizeof *lattice->velocity;
    CHECK_MEMORY(m->lattice.velocity = malloc(size));
    memcpy(m->lattice.velocity, lattice->velocity, size);
    return DEM_OK;
}

/* Appending to an empty lattice copies the caller's arrays. */
static dem_status take_lattice(dem_model *m, const dem_lattice *lattice, bool borrows)
{
    m->lattice = dem_lattice_empty();
    TRY(borrows ? borrow(m, lattice) : dem_lattice_append(&m->lattice, lattice));
    return fill_defaults(&m->lattice);
}

static void free_lattice(dem_model *m)
{
    dem_lattice *l = &m->lattice;
    if (l->position == l->x) l->position = NULL; /* is freed once */
    for (int k = 0; k < LATTICE_ARRAYS; k++)
        if (lattice_array_of(&m->borrowed, &lattice_arrays[k]) != NULL) lattice_array_put(l, &lattice_arrays[k], NULL);
    dem_lattice_free(l);
}

static dem_status compile_parts(dem_model *m, const dem_obstacle *list, dem_index n)
{
    TRY(rigid_bodies_compile(&m->rigid, &m->lattice));
    TRY(model_rows_compile(m));
    TRY(surface_compile(&m->surface, &m->lattice, SURFACE_TOUCHING));
    TRY(stress_compile(&m->stress, &m->lattice, &m->springs, &m->couplings));
    TRY(obstacles_compile(&m->obstacles, list, n));
    return compile_nodes(m);
}

/* A failure of one part is reduced before the sums, at which all processes would meet (base/reduce.h). */
static dem_status compile(dem_model *m, const dem_obstacle *list, dem_index n)
{
    TRY(reduce_status(m->ranks, compile_parts(m, list, n), 0.0));
    TRY(model_find_scales(m, NULL));
    return check_bodies(m);
}

/* ---- public ---- */

/* What a model is made of. */
typedef struct source {
    dem_lattice lattice;
    bool is_lent; /* whether its arrays are not copied */
    const dem_obstacle *obstacles;
    dem_index n_obstacles;
} source;

static dem_status create(dem_model **out, const source *from)
{
    TRY(model_rules_check(&from->lattice, from->lattice.n_nodes));
    dem_model *model = calloc(1, sizeof *model);
    CHECK_MEMORY(model);
    model->ranks = &ranks_alone;
    dem_status status = take_lattice(model, &from->lattice, from->is_lent);
    if (status == DEM_OK) status = compile(model, from->obstacles, from->n_obstacles);
    if (status == DEM_OK)
        *out = model;
    else
        dem_model_destroy(model);
    return status;
}

/* The caller's structs may be of another version of the library: those of the source are copies in this one's
 * layout. */
static dem_status read_and_create(dem_model **out, const dem_lattice *lattice, source from)
{
    CHECK(out != NULL && lattice != NULL, DEM_ERROR_ARGUMENT, "dem_model_create: %s is NULL", out ? "lattice" : "out");
    CHECK(from.n_obstacles >= 0 && (from.n_obstacles == 0 || from.obstacles != NULL), DEM_ERROR_ARGUMENT,
          "dem_model_create: %lld obstacles, obstacles is %s", (long long)from.n_obstacles,
          from.obstacles ? "given" : "NULL");
    void *list;
    TRY(lattice_read(&from.lattice, lattice));
    TRY(obstacle_input_read_all(&list, from.obstacles, from.n_obstacles));
    from.obstacles = list;
    const dem_status status = create(out, &from);
    free(list);
    return status;
}

dem_status dem_model_create(dem_model **out, const dem_lattice *lattice, const dem_obstacle *obstacles,
                            dem_index n_obstacles)
{
    return read_and_create(out, lattice, (source){.obstacles = obstacles, .n_obstacles = n_obstacles});
}

dem_status dem_model_create_borrowing(dem_model **out, const dem_lattice *lattice, const dem_obstacle *obstacles,
                                      dem_index n_obstacles)
{
    return read_and_create(out, lattice, (source){.obstacles = obstacles, .n_obstacles = n_obstacles, .is_lent = true});
}

void dem_model_destroy(dem_model *model)
{
    if (model == NULL) return;
    free_lattice(model);
    model_rows_free(model);
    surface_free(&model->surface);
    stress_free(&model->stress);
    obstacles_free(&model->obstacles);
    rigid_bodies_free(&model->rigid);
    if (model->touching != NULL) touching_bodies_free(model->touching);
    free(model->touching);
    if (model->domain != NULL) domain_free(model->domain);
    free(model->domain);
    free(model->inverse_mass);
    dem_model_destroy(model->part);
    free(model->slabs.recipe);
    if (model->ends_ranks) model->ranks->end(model->ranks->self);
    free(model);
}

dem_status dem_model_part(const dem_model *model, dem_index *n_nodes, const dem_index **number,
                          const unsigned char **is_own)
{
    CHECK(model != NULL && n_nodes != NULL && number != NULL && is_own != NULL, DEM_ERROR_ARGUMENT,
          "dem_model_part: %s is NULL", model == NULL ? "model" : "where to write");
    const domain *d = model->domain;
    *n_nodes = model->lattice.n_nodes;
    *number = d != NULL ? d->number : NULL;
    *is_own = d != NULL ? d->is_own : NULL;
    return DEM_OK;
}

dem_status dem_model_csr(const dem_model *model, dem_csr *out)
{
    CHECK(model != NULL && out != NULL, DEM_ERROR_ARGUMENT, "dem_model_csr: %s is NULL", model ? "out" : "model");
    dem_csr own;
    TRY(model_rows_renew(model));
    TRY(csr_view_show(model->csr, &own));
    return struct_size_write(&STRUCT_KIND(dem_csr), out, &own);
}

const dem_lattice *dem_model_lattice(const dem_model *model)
{
    return &model->lattice;
}

const dem_obstacle *dem_model_obstacle(const dem_model *model, dem_index obstacle)
{
    const dem_index n = model != NULL ? model->obstacles.n : 0;
    return status_check_number("obstacle", obstacle, n) == DEM_OK ? &model->obstacles.list[obstacle] : NULL;
}

dem_status dem_model_sizes(const dem_model *model, dem_model_size *out)
{
    CHECK(model != NULL && out != NULL, DEM_ERROR_ARGUMENT, "dem_model_sizes: %s is NULL", model ? "out" : "model");
    const dem_model_size own = {.n_nodes = model->lattice.n_nodes,
                                .n_springs = model->lattice.n_springs,
                                .n_triangles = model->lattice.n_triangles,
                                .n_bodies = model->n_bodies,
                                .n_contact_nodes = model->surface.n_nodes,
                                .n_contact_edges = model->surface.n_edges,
                                .n_obstacles = model->obstacles.n,
                                .n_segments = model->obstacles.n_segments,
                                .n_vertices = model->obstacles.n_vertices};
    return struct_size_write(&STRUCT_KIND(dem_model_size), out, &own);
}

double dem_model_spacing(const dem_model *model)
{
    return model->spacing;
}

double dem_model_omega_max(const dem_model *model)
{
    return model->omega_max;
}

double dem_model_mass(const dem_model *model)
{
    return model->mass;
}

const double *dem_model_volumes(const dem_model *model)
{
    return stress_volumes(&model->stress);
}

/* At t = 0; free ends are not lengthened, and no obstacle is left out. */
double dem_model_gap(const dem_model *model, const double *x)
{
    return obstacles_gap(&model->obstacles, 0.0, vec2_at(x, 0), 0.0, -1, -1).distance;
}
