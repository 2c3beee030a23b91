/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that are processes, each with a slab of a block, of a disc with a hole, or of two blocks that hit each other,
 * which fall on a floor: positions, velocities, energies and surfaces have the bits of one process that has the whole,
 * whether slabs are made or read from the output of a run of the whole. `mpirun -n N test_slabs`. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "harness/slab_cut.h"
#include "rank_test.h"

static const double width = 0.05, height = 0.04, spacing = 2.5e-3;

static const dem_outline disc = {
    .struct_size = sizeof disc, .kind = DEM_OUTLINE_DISC, .centre = {0.0, 0.02}, .radius = 0.02};
static const dem_outline hole = {
    .struct_size = sizeof hole, .kind = DEM_OUTLINE_DISC, .centre = {0.005, 0.022}, .radius = 0.006};
static const dem_shape holed = {
    .struct_size = sizeof holed, .outline = &disc, .spacing = 2.5e-3, .n_voids = 1, .voids = &hole};

/* The same of the whole and of slabs. */
static void finish_block(dem_lattice *l)
{
    const dem_material solid = {.struct_size = sizeof solid,
                                .youngs_modulus = 1e7,
                                .poissons_ratio = 0.3,
                                .density = 1050.0,
                                .thickness = 1.0,
                                .guard = 0.02,
                                .springs = DEM_SPRINGS_COUPLED};
    INSIST(dem_lattice_assemble(l, &solid) == DEM_OK);
    INSIST(dem_lattice_launch(l, (const double[2]){1.0, -4.0}) == DEM_OK);
    dem_lattice_move(l, 0.02, (const double[2]){0.0, 8e-4});
}

/* \param shape  NULL: the block */
static dem_lattice make_whole(const dem_shape *shape)
{
    dem_lattice l = dem_lattice_empty();
    INSIST((shape != NULL ? dem_shape_lattice(&l, shape, NULL) : dem_lattice_rectangle(&l, width, height, spacing)) ==
           DEM_OK);
    INSIST(dem_lattice_jitter(&l, 0.2 * spacing, 1) == DEM_OK);
    finish_block(&l);
    return l;
}

static dem_slab make_slab(const dem_shape *shape, team t)
{
    dem_slab s = dem_slab_empty();
    INSIST((shape != NULL ? dem_slab_shape(&s, shape, t.rank, t.size)
                          : dem_slab_rectangle(&s, width, height, spacing, t.rank, t.size)) == DEM_OK);
    INSIST(dem_slab_jitter(&s, 0.2 * spacing, 1) == DEM_OK);
    finish_block(&s.lattice);
    return s;
}

/* ---- two blocks ---- */

/* The upper one is turned, and comes down on the lower one. */
static dem_lattice make_blocks(void)
{
    dem_lattice upper = dem_lattice_empty(), l = make_whole(NULL);
    INSIST(dem_lattice_rectangle(&upper, 0.6 * width, 0.4 * height, spacing) == DEM_OK);
    finish_block(&upper);
    INSIST(dem_lattice_launch(&upper, (const double[2]){4.0, -20.0}) == DEM_OK);
    dem_lattice_move(&upper, 0.1, (const double[2]){0.0, height + spacing});
    INSIST(dem_lattice_append(&l, &upper) == DEM_OK);
    dem_lattice_free(&upper);
    return l;
}

/* Slabs of as many nodes, of which one has some of both blocks. */
static dem_slab cut_slab(const dem_lattice *whole, team t)
{
    const dem_index n = whole->n_nodes;
    const dem_slab s = slab_cut(whole, n * t.rank / t.size, n * (t.rank + 1) / t.size);
    INSIST(s.n_own > 0);
    return s;
}

/* ---- runs ---- */

static bool is_empty(const dem_slab *s)
{
    return s->n_own == 0 && s->n_nodes == 0 && s->lattice.n_nodes == 0 && s->lattice.x == NULL;
}

typedef struct seen {
    double *x, *v; /* [n][2] of the whole */
    dem_energy energy;
    dem_counts counts;
    dem_surfaces surfaces;
} seen;

static seen run(const dem_model *model, const dem_options *options, dem_index n)
{
    dem_simulation *s = NULL;
    seen r = {.energy = {.struct_size = sizeof r.energy},
              .counts = {.struct_size = sizeof r.counts},
              .surfaces = {.struct_size = sizeof r.surfaces}};
    r.x = malloc(2 * (size_t)n * sizeof *r.x);
    r.v = malloc(2 * (size_t)n * sizeof *r.v);
    INSIST(r.x != NULL && r.v != NULL);
    INSIST(dem_simulation_create(&s, model, options) == DEM_OK && dem_simulation_advance(s, 4e-4) == DEM_OK);
    INSIST(dem_simulation_gather(s, r.x, r.v) == DEM_OK && dem_simulation_energy(s, &r.energy) == DEM_OK);
    INSIST(dem_simulation_counts(s, &r.counts) == DEM_OK && dem_simulation_surfaces(s, &r.surfaces) == DEM_OK);
    dem_simulation_destroy(s);
    return r;
}

static void compare(const seen *shared, const seen *alone, dem_index n, int rank)
{
    const size_t size = 2 * (size_t)n * sizeof(double);
    INSIST(memcmp(&shared->energy, &alone->energy, sizeof alone->energy) == 0);
    INSIST(memcmp(&shared->counts, &alone->counts, sizeof alone->counts) == 0);
    INSIST(memcmp(&shared->surfaces, &alone->surfaces, sizeof alone->surfaces) == 0);
    INSIST(rank != 0 || memcmp(shared->x, alone->x, size) == 0);
    INSIST(rank != 0 || memcmp(shared->v, alone->v, size) == 0);
    INSIST(alone->counts.events > 10);
}

static const double points[] = {-0.1, 0.0, 0.0, 2e-4, 0.1, 0.0};
static const dem_obstacle floor_below = {
    .struct_size = sizeof floor_below, .n_points = 3, .points = points, .restitution = 0.5, .friction = 0.3};

/* Runs the whole by itself, and the slab together with those of other ranks. */
static void check(const dem_options *options, const dem_lattice *whole, dem_slab *slab, team t)
{
    dem_model *model = NULL;
    INSIST(dem_model_create(&model, whole, &floor_below, 1) == DEM_OK);
    seen alone = run(model, options, whole->n_nodes);
    dem_model_destroy(model);
    INSIST(dem_model_create_mpi_slab(&model, slab, &floor_below, 1, options, MPI_COMM_WORLD) == DEM_OK);
    INSIST(is_empty(slab));
    seen shared = run(model, options, whole->n_nodes);
    dem_model_destroy(model);
    compare(&shared, &alone, whole->n_nodes, t.rank);
    INSIST(options->bodies == DEM_BODIES_NONE || shared.surfaces.pushing > 0);
    free(alone.x);
    free(alone.v);
    free(shared.x);
    free(shared.v);
}

static dem_options options_of(dem_method method)
{
    dem_options options = dem_options_default();
    options.method = method;
    return options;
}

static void check_made(dem_method method, const dem_shape *shape, team t)
{
    const dem_options options = options_of(method);
    dem_lattice whole = make_whole(shape);
    dem_slab slab = make_slab(shape, t);
    check(&options, &whole, &slab, t);
    dem_lattice_free(&whole);
}

static void check_two(dem_method method, team t)
{
    dem_options options = options_of(method);
    dem_lattice whole = make_blocks();
    dem_slab slab = cut_slab(&whole, t);
    options.bodies = DEM_BODIES_ALL;
    options.contact_friction = 0.4;
    check(&options, &whole, &slab, t);
    dem_lattice_free(&whole);
}

/* ---- slabs of a file ---- */

/* The body as the output of a run has it. */
static void write_output(const char *path, const dem_shape *shape)
{
    const dem_trajectory_options none = dem_trajectory_options_default();
    const dem_options options = dem_options_default();
    dem_lattice whole = make_whole(shape);
    dem_model *model = NULL;
    dem_simulation *simulation = NULL;
    dem_trajectory *output = NULL;
    INSIST(dem_model_create(&model, &whole, NULL, 0) == DEM_OK);
    INSIST(dem_simulation_create(&simulation, model, &options) == DEM_OK);
    INSIST(dem_trajectory_create(&output, path, simulation, &none) == DEM_OK);
    INSIST(dem_trajectory_finish(output) == DEM_OK);
    dem_trajectory_destroy(output);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    dem_lattice_free(&whole);
}

/* Where one rank has no slab none has a model. */
static void refuse_unread(const char *path, team t)
{
    dem_model *model = NULL;
    dem_slab slab = dem_slab_empty();
    const dem_status status = dem_slab_read(&slab, t.rank == t.size - 1 ? "none.h5" : path, t.rank, t.size);
    INSIST(status == (t.rank == t.size - 1 ? DEM_ERROR_IO : DEM_OK));
    INSIST(dem_model_create_mpi_slab(&model, &slab, NULL, 0, NULL, MPI_COMM_WORLD) == DEM_ERROR_ARGUMENT);
    INSIST(model == NULL);
    dem_slab_free(&slab);
}

static void check_read(dem_method method, const dem_shape *shape, team t)
{
    char path[64];
    const dem_options options = options_of(method);
    dem_lattice whole = dem_lattice_empty();
    dem_slab slab = dem_slab_empty();
    (void)snprintf(path, sizeof path, "mpi_slabs_%d.vtkhdf", t.size); /* tests of other numbers run beside this one */
    if (t.rank == 0) write_output(path, shape);
    (void)MPI_Barrier(MPI_COMM_WORLD);
    INSIST(dem_lattice_read(&whole, path) == DEM_OK && dem_slab_read(&slab, path, t.rank, t.size) == DEM_OK);
    INSIST(t.size == 1 || slab.lattice.n_nodes < whole.n_nodes);
    check(&options, &whole, &slab, t);
    refuse_unread(path, t);
    (void)MPI_Barrier(MPI_COMM_WORLD);
    INSIST(t.rank != 0 || unlink(path) == 0);
    dem_lattice_free(&whole);
}

/* ---- what is refused ---- */

/* On all ranks, whichever has it. */
static void refuse(dem_slab *slab, dem_status status, const char *message)
{
    dem_model *model = NULL;
    INSIST(dem_model_create_mpi_slab(&model, slab, NULL, 0, NULL, MPI_COMM_WORLD) == status);
    INSIST(strstr(dem_status_message(), message) != NULL && model == NULL);
    INSIST(slab == NULL || is_empty(slab));
}

static void refuse_all(team t)
{
    dem_slab slab = make_slab(NULL, t);
    refuse(t.rank == t.size - 1 ? NULL : &slab, DEM_ERROR_ARGUMENT, "slab is NULL");
    dem_slab_free(&slab);
    slab = make_slab(NULL, t);
    INSIST(dem_model_create_mpi_slab(NULL, &slab, NULL, 0, NULL, MPI_COMM_WORLD) == DEM_ERROR_ARGUMENT);
    INSIST(is_empty(&slab));
}

int main(int argc, char **argv)
{
    const team t = rank_test_begin(&argc, &argv);
    check_made(DEM_METHOD_FEHLBERG45, NULL, t);
    check_made(DEM_METHOD_VERLET, NULL, t);
    check_made(DEM_METHOD_VERLET, &holed, t);
    check_two(DEM_METHOD_FEHLBERG45, t);
    check_two(DEM_METHOD_VERLET, t);
    check_read(DEM_METHOD_FEHLBERG45, &holed, t);
    check_read(DEM_METHOD_VERLET, NULL, t);
    refuse_all(t);
    (void)MPI_Finalize();
    return 0;
}
