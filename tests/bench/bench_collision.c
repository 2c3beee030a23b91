/* SPDX-License-Identifier: BSD-3-Clause */
/* Two blocks of equilateral triangles that run into each other at 5 m/s (W3), with nothing else in the way.
 *
 *      bench_collision NODES GAP METHOD STEPS [FILE]   so many steps, its state at the end into FILE
 *      bench_collision NODES GAP lammps FILE           the same blocks as a data file of LAMMPS
 *
 * NODES are those of a block, GAP is between the blocks, in spacings. Verlet's method takes steps of a tenth of
 * sqrt(m/k). A run prints: nodes, springs, step in s, evaluations, CPU and wall time in s, the velocity that the upper
 * block has at the end in m/s, and how many pairs push then. */
#include <string.h>

#include "ask.h"
#include "plate.h"

static const double spacing = 5e-3, speed = 2.5;

static double upper_velocity(const dem_simulation *simulation)
{
    const dem_index n = ask_sizes(dem_simulation_model(simulation)).n_nodes;
    const double *v = ask_state(simulation).v;
    double sum = 0.0;
    for (dem_index i = n / 2; i < n; i++) sum += v[2 * i + 1];
    return sum / (double)(n - n / 2);
}

static void run(const dem_lattice *blocks, dem_method method, double steps, const char *path)
{
    dem_options options = dem_options_default();
    dem_simulation *simulation;
    dem_model *model;
    options.gravity[1] = 0.0;
    options.bodies = DEM_BODIES_ALL;
    options.method = method;
    if (method == DEM_METHOD_VERLET) options.fixed_step = 0.1 * plate_period(spacing);
    ask(dem_model_create(&model, blocks, NULL, 0));
    ask(dem_simulation_create(&simulation, model, &options));
    const double step = ask_options(simulation).max_step;
    const double cpu = seconds(CLOCK_PROCESS_CPUTIME_ID), wall = seconds(CLOCK_MONOTONIC);
    ask(dem_simulation_advance(simulation, step * steps));
    const double cpu_end = seconds(CLOCK_PROCESS_CPUTIME_ID), wall_end = seconds(CLOCK_MONOTONIC);
    (void)printf("nodes %lld\nsprings %lld\nstep %.17g\nevaluations %lld\ncpu %.6f\nwall %.6f\n",
                 (long long)blocks->n_nodes, (long long)blocks->n_springs, step,
                 (long long)ask_counts(simulation).evaluations, cpu_end - cpu, wall_end - wall);
    (void)printf("velocity %.6f\npushing %lld\n", upper_velocity(simulation),
                 (long long)ask_surfaces(simulation).pushing);
    if (path != NULL) plate_write_state(simulation, path);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
}

int main(int argc, char **argv)
{
    must(argc == 5 || argc == 6, "NODES GAP METHOD STEPS [FILE] or NODES GAP lammps FILE");
    dem_lattice blocks = plate_make_two((dem_index)atof(argv[1]), atof(argv[2]), spacing, speed);
    if (strcmp(argv[3], "lammps") == 0) {
        plate_write_lammps(&blocks, spacing, 20.0 * spacing, argv[4]);
    } else {
        dem_method method;
        ask(dem_method_find(&method, argv[3]));
        run(&blocks, method, atof(argv[4]), argc == 6 ? argv[5] : NULL);
    }
    dem_lattice_free(&blocks);
    return 0;
}
