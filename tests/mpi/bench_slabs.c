/* SPDX-License-Identifier: BSD-3-Clause */
/* A square of equilateral triangles falls on a flat floor, a tenth of a spacing below it: in slabs, which no rank has
 * as a whole, or on one rank as a whole. Time of set-up, memory that a rank has taken at most in it and in all, ns per
 * node and evaluation, events, and energies at the end to the last bit, which any number of ranks has.
 *
 *      mpirun -n N bench_slabs NODES METHOD STEPS */
#define _XOPEN_SOURCE 700
#include <sys/resource.h>

#include "bench.h"
#include "rank_test.h"

static const double spacing = 5e-3;

static const double down[2] = {0.0, -10.0}, drop[2] = {0.0, 5e-4};
static const double points[] = {-1000.0, 0.0, 1000.0, 0.0};
static const dem_obstacle ground = {
    .struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points, .restitution = 0.5};

static double side_of(dem_index nodes)
{
    return spacing * (sqrt((double)nodes * sqrt(3.0) / 2.0) - 0.5);
}

static void make_solid(dem_lattice *l)
{
    const dem_material solid = {.struct_size = sizeof solid,
                                .youngs_modulus = 1e7,
                                .poissons_ratio = 1.0 / 3.0,
                                .density = 1050.0,
                                .thickness = 1.0};
    ask(dem_lattice_assemble(l, &solid));
    dem_lattice_move(l, 0.0, drop);
    ask(dem_lattice_launch(l, down));
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

static dem_model *make_whole(dem_index nodes)
{
    dem_model *model = NULL;
    dem_lattice l = dem_lattice_empty();
    ask(dem_lattice_rectangle(&l, side_of(nodes), side_of(nodes), spacing));
    make_solid(&l);
    ask(dem_model_create(&model, &l, &ground, 1));
    dem_lattice_free(&l);
    return model;
}

static dem_model *make_shared(dem_index nodes, const dem_options *options, team t)
{
    dem_model *model = NULL;
    dem_slab s = dem_slab_empty();
    ask(dem_slab_rectangle(&s, side_of(nodes), side_of(nodes), spacing, t.rank, t.size));
    make_solid(&s.lattice);
    ask(dem_model_create_mpi_slab(&model, &s, &ground, 1, options, MPI_COMM_WORLD));
    return model;
}

int main(int argc, char **argv)
{
    const team t = rank_test_begin(&argc, &argv);
    dem_options options = dem_options_default();
    dem_counts counts = {.struct_size = sizeof counts};
    dem_energy energy = {.struct_size = sizeof energy};
    dem_simulation *s = NULL;
    must(argc == 4, "NODES METHOD STEPS");
    ask(dem_method_find(&options.method, argv[2]));
    options.checkpoint_steps = 0;
    const double begin = seconds(CLOCK_MONOTONIC);
    const dem_index n = (dem_index)atof(argv[1]);
    dem_model *model = t.size > 1 ? make_shared(n, &options, t) : make_whole(n);
    const double set_up_time = largest(seconds(CLOCK_MONOTONIC) - begin), set_up_peak = peak();
    ask(dem_simulation_create(&s, model, &options));
    ask(dem_simulation_options(s, &options));
    const double from = seconds(CLOCK_MONOTONIC);
    ask(dem_simulation_advance(s, atof(argv[3]) * options.max_step));
    const double taken = largest(seconds(CLOCK_MONOTONIC) - from);
    ask(dem_simulation_counts(s, &counts));
    ask(dem_simulation_energy(s, &energy));
    const double all = peak();
    if (t.rank == 0) {
        (void)printf("%lld nodes, %d ranks: set up in %.2f s, at most %.0f MB a rank; ", (long long)n, t.size,
                     set_up_time, set_up_peak);
        (void)printf("%lld steps, %lld events, %.2f ns per node and evaluation, at most %.0f MB a rank; ",
                     (long long)counts.steps, (long long)counts.events,
                     1e9 * taken / (double)n / (double)counts.evaluations, all);
        (void)printf("energies %a %a %a J\n", energy.kinetic, energy.elastic, energy.impact);
    }
    dem_simulation_destroy(s);
    dem_model_destroy(model);
    (void)MPI_Finalize();
    return 0;
}
