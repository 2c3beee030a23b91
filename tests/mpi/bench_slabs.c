/* SPDX-License-Identifier: BSD-3-Clause */
/* A square of equilateral triangles in slabs, which no rank has as a whole: time of set-up, memory that a rank has
 * taken at most in it and in all, and ns per node and evaluation of steps in free flight.
 *
 *      mpirun -n N bench_slabs NODES METHOD STEPS */
#define _XOPEN_SOURCE 700
#include <sys/resource.h>

#include "bench.h"
#include "rank_test.h"

static const double spacing = 5e-3;

static dem_slab make_slab(dem_index nodes, team t)
{
    const double side = spacing * (sqrt((double)nodes * sqrt(3.0) / 2.0) - 0.5);
    const dem_material solid = {.struct_size = sizeof solid,
                                .youngs_modulus = 1e7,
                                .poissons_ratio = 1.0 / 3.0,
                                .density = 1050.0,
                                .thickness = 1.0};
    dem_slab s = dem_slab_empty();
    ask(dem_slab_rectangle(&s, side, side, spacing, t.rank, t.size));
    ask(dem_lattice_assemble(&s.lattice, &solid));
    ask(dem_lattice_launch(&s.lattice, (const double[2]){1.0, 0.0}));
    return s;
}

/* The largest of all ranks. */
static double largest(double own)
{
    double all = 0.0;
    (void)MPI_Allreduce(&own, &all, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return all;
}

/* MB that a rank has taken at most so far. */
static double peak(void)
{
    struct rusage use = {0};
    must(getrusage(RUSAGE_SELF, &use) == 0, "no usage of memory");
    return largest((double)use.ru_maxrss * 1.024e-3);
}

static dem_model *set_up(dem_index nodes, const dem_options *options, team t, dem_index *n_whole)
{
    dem_model *model = NULL;
    dem_slab slab = make_slab(nodes, t);
    *n_whole = slab.n_nodes;
    ask(dem_model_create_mpi_slab(&model, &slab, NULL, 0, options, MPI_COMM_WORLD));
    dem_slab_free(&slab);
    return model;
}

int main(int argc, char **argv)
{
    const team t = rank_test_begin(&argc, &argv);
    dem_options options = dem_options_default();
    dem_counts counts = {.struct_size = sizeof counts};
    dem_simulation *s = NULL;
    dem_index n = 0;
    must(argc == 4, "NODES METHOD STEPS");
    ask(dem_method_find(&options.method, argv[2]));
    options.checkpoint_steps = 0;
    options.gravity[1] = 0.0;
    const double begin = seconds(CLOCK_MONOTONIC);
    dem_model *model = set_up((dem_index)atof(argv[1]), &options, t, &n);
    const double set_up_time = largest(seconds(CLOCK_MONOTONIC) - begin), set_up_peak = peak();
    ask(dem_simulation_create(&s, model, &options));
    ask(dem_simulation_options(s, &options));
    const double from = seconds(CLOCK_MONOTONIC);
    ask(dem_simulation_advance(s, atof(argv[3]) * options.max_step));
    const double taken = largest(seconds(CLOCK_MONOTONIC) - from);
    ask(dem_simulation_counts(s, &counts));
    const double all = peak();
    if (t.rank == 0) {
        (void)printf("%lld nodes, %d ranks: set up in %.2f s, at most %.0f MB a rank; ", (long long)n, t.size,
                     set_up_time, set_up_peak);
        (void)printf("%lld steps, %.2f ns per node and evaluation, at most %.0f MB a rank\n", (long long)counts.steps,
                     1e9 * taken / (double)n / (double)counts.evaluations, all);
    }
    dem_simulation_destroy(s);
    dem_model_destroy(model);
    (void)MPI_Finalize();
    return 0;
}
