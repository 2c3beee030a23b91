/* SPDX-License-Identifier: BSD-3-Clause */
/* A free plate of equilateral triangles that vibrates, by all ranks and by one process, in turns: wall time in ns per
 * spring and evaluation, medians, and their ratio.
 *
 *      mpirun -n N bench_ranks NODES METHOD TURNS
 *
 * The process is rank 0 with a model without ranks. Then the others sleep. A team of one shows what ranks cost by
 * themselves. */
#define _XOPEN_SOURCE 700 /* M_PI */
#include "bench.h"
#include "rank_test.h"

static const double spacing = 5e-3, wavelength = 0.12, speed = 1.0;

/* A square of about so many nodes of springs alone, without area terms and without the guard. Its triangles are left
 * out, too, in which overlaps would be looked for. */
static dem_lattice make_plate(dem_index nodes)
{
    const double side = spacing * (sqrt((double)nodes * sqrt(3.0) / 2.0) - 0.5);
    const dem_material solid = {.struct_size = sizeof solid,
                                .youngs_modulus = 1e7,
                                .poissons_ratio = 1.0 / 3.0,
                                .density = 1050.0,
                                .thickness = 1.0};
    dem_lattice l = dem_lattice_empty();
    ask(dem_lattice_rectangle(&l, side, side, spacing));
    ask(dem_lattice_assemble(&l, &solid));
    l.n_triangles = 0;
    if (l.velocity == NULL) l.velocity = calloc(2 * (size_t)l.n_nodes, sizeof *l.velocity);
    must(l.velocity != NULL, "out of memory");
    for (dem_index i = 0; i < l.n_nodes; i++) {
        const double phase = 2.0 * M_PI / wavelength * l.x[2 * i];
        l.velocity[2 * i] = speed * cos(phase);
        l.velocity[2 * i + 1] = speed * sin(phase);
    }
    return l;
}

enum { LEAST_STEPS = 66 };

typedef struct run {
    dem_simulation *simulation; /* NULL on ranks that do not take part */
    double t, *ns;              /* s; [turns] wall time of a spring and evaluation */
} run;

static dem_options options_of(dem_method method)
{
    dem_options options = dem_options_default();
    options.method = method;
    options.gravity[1] = 0.0;
    options.checkpoint_steps = 0; /* ranks have none yet */
    options.rtol = 1e-3;          /* the stable step limits the pair, so that all steps are equal */
    return options;
}

static run start(const dem_model *model, dem_method method, int turns)
{
    const dem_options options = options_of(method);
    run r = {.ns = calloc((size_t)turns, sizeof *r.ns)};
    must(r.ns != NULL, "out of memory");
    if (model != NULL) ask(dem_simulation_create(&r.simulation, model, &options));
    return r;
}

static dem_index evaluations_of(const dem_simulation *s)
{
    dem_counts counts = {.struct_size = sizeof counts};
    ask(dem_simulation_counts(s, &counts));
    return counts.evaluations;
}

/* Advances by `duration`. A turn below 0 is not measured. */
static void go_on(run *r, double duration, dem_index n_springs, int turn)
{
    if (r->simulation == NULL) return;
    const dem_index before = evaluations_of(r->simulation);
    const double wall = seconds(CLOCK_MONOTONIC);
    r->t += duration;
    ask(dem_simulation_advance(r->simulation, r->t));
    const double taken = seconds(CLOCK_MONOTONIC) - wall;
    if (turn < 0) return;
    r->ns[turn] = 1e9 * taken / (double)n_springs / (double)(evaluations_of(r->simulation) - before);
}

/* Asks now and then whether all ranks are here, as MPI_Barrier() may keep a core busy. */
static void meet(void)
{
    const struct timespec pause = {.tv_nsec = 50000};
    MPI_Request request;
    int is_done = 0;
    (void)MPI_Ibarrier(MPI_COMM_WORLD, &request);
    while ((void)MPI_Test(&request, &is_done, MPI_STATUS_IGNORE), !is_done) (void)nanosleep(&pause, NULL);
}

/* Turns of some 50 ms of one process; and so long that the step beyond a turn's end, which is taken by itself, is of no
 * account beside those that Verlet's method takes at once. */
static double duration_of(const dem_model *model, dem_method method, dem_index n_springs)
{
    dem_method_traits traits = {.struct_size = sizeof traits};
    dem_options options = {.struct_size = sizeof options};
    run r = start(model, method, 1);
    ask(dem_method_describe(&traits, method));
    ask(dem_simulation_options(r.simulation, &options));
    dem_simulation_destroy(r.simulation);
    free(r.ns);
    const double steps = ceil(2.5e7 / (double)n_springs / traits.evaluations);
    return options.max_step * fmax(LEAST_STEPS, steps);
}

int main(int argc, char **argv)
{
    const team t = rank_test_begin(&argc, &argv);
    must(argc == 4, "NODES METHOD TURNS");
    const int turns = atoi(argv[3]);
    dem_method method;
    dem_model *alone = NULL, *shared;
    ask(dem_method_find(&method, argv[2]));
    dem_lattice plate = make_plate((dem_index)atof(argv[1]));
    const dem_index n_springs = plate.n_springs;
    ask(dem_model_create(&alone, &plate, NULL, 0));
    const dem_options options = options_of(method);
    ask(dem_model_create_mpi_for(&shared, &plate, NULL, 0, &options, MPI_COMM_WORLD));
    const double duration = duration_of(alone, method, n_springs);
    run one = start(t.rank == 0 ? alone : NULL, method, turns), all = start(shared, method, turns);
    double *ratio = calloc((size_t)turns, sizeof *ratio);
    must(ratio != NULL, "out of memory");
    for (int turn = -1; turn < turns; turn++) {
        meet();
        go_on(&one, duration, n_springs, turn);
        meet();
        go_on(&all, duration, n_springs, turn);
        if (turn >= 0) ratio[turn] = one.ns[turn] / all.ns[turn];
    }
    if (t.rank == 0) {
        const size_t n = (size_t)turns;
        (void)printf("%s, %lld nodes: 1 process %.3f ns, %d ranks %.3f ns, %.2f times", argv[2],
                     (long long)plate.n_nodes, median(one.ns, n), t.size, median(all.ns, n), median(ratio, n));
        (void)printf(" (%.2f to %.2f)\n", ratio[turns / 10], ratio[turns - 1 - turns / 10]);
    }
    dem_simulation_destroy(one.simulation);
    dem_simulation_destroy(all.simulation);
    dem_model_destroy(alone);
    dem_model_destroy(shared);
    dem_lattice_free(&plate);
    free(one.ns);
    free(all.ns);
    free(ratio);
    (void)MPI_Finalize();
    return 0;
}
