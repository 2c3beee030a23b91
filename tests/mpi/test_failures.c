/* SPDX-License-Identifier: BSD-3-Clause */
/* What fails on one rank fails on all, with one status and one message, and without a wait. `mpirun -n N
 * test_failures`; the last rank is the one that fails. */
#include "mpi_body.h"

static const double longest_wait = 10.0; /* s */

/* The part of the message is known, all of it is the same on all ranks. */
static void check_refusal(dem_status status, dem_status expected, const char *part)
{
    char message[512];
    (void)snprintf(message, sizeof message, "%s", dem_status_message());
    INSIST(status == expected);
    INSIST(strstr(message, part) != NULL);
    (void)MPI_Bcast(message, sizeof message, MPI_CHAR, 0, MPI_COMM_WORLD);
    INSIST(strcmp(message, dem_status_message()) == 0);
}

static dem_simulation *start(const dem_model *model, const dem_options *options)
{
    dem_simulation *s = NULL;
    INSIST(dem_simulation_create(&s, model, options) == DEM_OK);
    return s;
}

/* ---- models ---- */

static void refuse_lattices(const dem_lattice *l, bool fails, int n_ranks)
{
    dem_model *model = NULL;
    const double mass = l->mass[3], points[] = {-1.0, -1.0, 1.0, -1.0};
    const dem_obstacle floor = {.struct_size = sizeof floor, .n_points = 2, .points = points};
    check_refusal(dem_model_create_mpi(&model, fails ? NULL : l, NULL, 0, MPI_COMM_WORLD), DEM_ERROR_ARGUMENT,
                  "lattice is NULL");
    if (fails) l->mass[3] = -1.0;
    check_refusal(dem_model_create_mpi(&model, l, NULL, 0, MPI_COMM_WORLD), DEM_ERROR_MODEL, "node 3: mass");
    if (fails) l->mass[3] = nextafter(mass, 1.0);
    if (n_ranks > 1)
        check_refusal(dem_model_create_mpi(&model, l, NULL, 0, MPI_COMM_WORLD), DEM_ERROR_ARGUMENT,
                      "the lattices or obstacles of the ");
    l->mass[3] = mass;
    dem_options options = dem_options_default();
    check_refusal(dem_model_create_mpi_for(&model, l, NULL, 0, NULL, MPI_COMM_WORLD), DEM_ERROR_ARGUMENT,
                  "options is NULL");
    if (fails) options.contact = (dem_contact_method)7;
    check_refusal(dem_model_create_mpi_for(&model, l, NULL, 0, &options, MPI_COMM_WORLD), DEM_ERROR_ARGUMENT, "");
    options = dem_options_default();
    if (fails) options.method = DEM_METHOD_VERLET;
    if (n_ranks > 1)
        check_refusal(dem_model_create_mpi_for(&model, l, NULL, 0, &options, MPI_COMM_WORLD), DEM_ERROR_ARGUMENT,
                      "ranks share a model for options that differ");
    if (n_ranks > 1)
        check_refusal(dem_model_create_mpi(&model, l, &floor, fails, MPI_COMM_WORLD), DEM_ERROR_ARGUMENT,
                      "the lattices or obstacles of the ");
    INSIST(model == NULL);
}

/* ---- functions of the program ---- */

/* Somewhere else on the rank that fails. */
static dem_status stay(void *context, double t, dem_pose *pose)
{
    (void)t;
    pose->place[0] = *(const double *)context;
    return DEM_OK;
}

static dem_status push(void *context, const dem_force_query *q, double *force)
{
    for (dem_index k = 0; k < 2 * q->n; k++) force[k] = *(const double *)context;
    return DEM_OK;
}

static void refuse_functions(const dem_lattice *l, dem_options options, bool fails, int n_ranks)
{
    double place = fails ? 1e-9 : 0.0, points[] = {-1.0, -1.0, 1.0, -1.0};
    const dem_obstacle floor = {.struct_size = sizeof floor,
                                .n_points = 2,
                                .points = points,
                                .motion = stay,
                                .motion_context = &place,
                                .most_speed = 1.0,
                                .most_acceleration = 1.0};
    dem_model *model = NULL;
    dem_simulation *s = NULL;
    if (n_ranks == 1) return;
    INSIST(dem_model_create_mpi(&model, l, &floor, 1, MPI_COMM_WORLD) == DEM_OK);
    check_refusal(dem_simulation_create(&s, model, &options), DEM_ERROR_ARGUMENT, "moves obstacle 0 says otherwise");
    dem_model_destroy(model);
    INSIST(dem_model_create_mpi(&model, l, NULL, 0, MPI_COMM_WORLD) == DEM_OK);
    options.force = push;
    options.force_context = &place;
    s = start(model, &options);
    check_refusal(dem_simulation_advance(s, 1e-3), DEM_ERROR_ARGUMENT, "is another one on rank ");
    dem_simulation_destroy(s);
    dem_model_destroy(model);
}

/* ---- simulations ---- */

static void refuse_options(const dem_model *model, dem_options options, bool fails)
{
    dem_simulation *s = NULL;
    if (fails) options.rtol = -1.0;
    check_refusal(dem_simulation_create(&s, model, &options), DEM_ERROR_ARGUMENT, "rtol");
    const dem_index twice[] = {0, 9, 0}; /* which one rank alone owns */
    const dem_boundary force = {.struct_size = sizeof force, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 3, .nodes = twice};
    options.rtol = 1e-6;
    options.n_boundaries = 1;
    options.boundaries = &force;
    check_refusal(dem_simulation_create(&s, model, &options), DEM_ERROR_ARGUMENT, "node 0 is named twice");
    INSIST(s == NULL);
}

typedef struct watcher {
    bool fails;
    dem_index steps;
} watcher;

static dem_status watch(void *context, const dem_simulation *s)
{
    watcher *w = context;
    (void)s;
    return ++w->steps == 4 && w->fails ? DEM_STOPPED : DEM_OK;
}

static void stop(const dem_model *model, const dem_options *options, bool fails)
{
    watcher w = {.fails = fails};
    const dem_observer observer = {.struct_size = sizeof observer, .context = &w, .step = watch};
    dem_simulation *s = start(model, options);
    INSIST(dem_simulation_observe(s, &observer) == DEM_OK);
    INSIST(dem_simulation_advance(s, 1e-3) == DEM_STOPPED);
    INSIST(w.steps == 4);
    dem_simulation_destroy(s);
}

static void refuse_gathering(const dem_model *model, const dem_options *options, dem_index n_nodes)
{
    double *x = malloc(2 * (size_t)n_nodes * sizeof *x);
    dem_simulation *s = start(model, options);
    check_refusal(dem_simulation_gather(s, x, NULL), DEM_ERROR_ARGUMENT, "v is NULL");
    free(x);
    dem_simulation_destroy(s);
}

/* Two neighbours at one place have no direction of their force. */
static void break_down(dem_lattice *l, const dem_options *options)
{
    dem_model *model = NULL;
    l->position = malloc(2 * (size_t)l->n_nodes * sizeof *l->position);
    INSIST(l->position != NULL);
    memcpy(l->position, l->x, 2 * (size_t)l->n_nodes * sizeof *l->position);
    memcpy(l->position + 2 * l->ends[0], l->position + 2 * l->ends[1], 2 * sizeof *l->position);
    INSIST(dem_model_create_mpi(&model, l, NULL, 0, MPI_COMM_WORLD) == DEM_OK);
    dem_simulation *s = start(model, options);
    check_refusal(dem_simulation_advance(s, 1e-3), DEM_ERROR_INTEGRATOR, "node ");
    dem_simulation_destroy(s);
    dem_model_destroy(model);
}

int main(int argc, char **argv)
{
    const team t = rank_test_begin(&argc, &argv);
    const bool fails = t.rank == t.size - 1;
    const double begin = MPI_Wtime();
    dem_lattice l = mpi_body_make(1.0);
    dem_options options = dem_options_default();
    dem_model *model = NULL;
    refuse_lattices(&l, fails, t.size);
    INSIST(dem_model_create_mpi(&model, &l, NULL, 0, MPI_COMM_WORLD) == DEM_OK);
    refuse_functions(&l, options, fails, t.size);
    refuse_options(model, options, fails);
    stop(model, &options, fails);
    refuse_gathering(model, &options, l.n_nodes);
    dem_model_destroy(model);
    break_down(&l, &options);
    dem_lattice_free(&l);
    INSIST(MPI_Wtime() - begin < longest_wait);
    (void)MPI_Finalize();
    return 0;
}
