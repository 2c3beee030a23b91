/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of a run, bytes a node: what the C library has given out, and what the system has, after so many steps of a
 * rectangle with the folding guard at this height over a ground, onto which it flies. What the program has before it
 * makes a lattice does not count. `bench_memory NODES METHOD HEIGHT STEPS` */
#define _XOPEN_SOURCE 700 /* sysconf */
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "plate.h"
#include "ask.h"
#include "memory.h"

/* The line of the system's account of this process that begins so, in kB. */
static double account(const char *name)
{
    char line[256];
    double kilobytes = -1.0;
    FILE *file = fopen("/proc/self/status", "r");
    must(file != NULL, "/proc/self/status");
    while (kilobytes < 0.0 && fgets(line, sizeof line, file) != NULL)
        if (strncmp(line, name, strlen(name)) == 0) kilobytes = atof(line + strlen(name));
    (void)fclose(file);
    must(kilobytes >= 0.0, name);
    return 1024.0 * kilobytes;
}

int main(int argc, char **argv)
{
    must(argc == 5, "NODES METHOD HEIGHT STEPS");
    const double points[4] = {-100.0, 0.0, 100.0, 0.0}, before = account("VmRSS:"), given = memory_in_use();
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points};
    dem_options options = dem_options_default();
    dem_model *model;
    dem_simulation *simulation;
    ask(dem_method_find(&options.method, argv[2]));
    dem_lattice l = plate_make_rubber(atof(argv[1]), atof(argv[3]));
    const double n = (double)l.n_nodes;
    ask(dem_model_create(&model, &l, &ground, 1));
    dem_lattice_free(&l);
    ask(dem_simulation_create(&simulation, model, &options));
    const double peak = account("VmHWM:") - before;
    ask(dem_simulation_advance(simulation, atof(argv[4]) * ask_options(simulation).max_step));
    (void)printf("nodes %.0f, steps %lld, bytes a node: set-up %.1f at most, given out %.1f, resident %.1f\n", n,
                 (long long)ask_counts(simulation).steps, peak / n, (memory_in_use() - given) / n,
                 (account("VmRSS:") - before) / n);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    return 0;
}
