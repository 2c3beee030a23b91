/* SPDX-License-Identifier: BSD-3-Clause */
/* What the contact of bodies costs a whole run where nothing is near: two plates of NODES nodes each, GAP spacings
 * apart, with every choice of `bodies` in turns.
 *
 *      bench_apart NODES GAP STEPS METHOD TURNS
 *
 * Prints the median CPU time of a step without contact, us, and the medians over the turns of what a step takes with
 * contact of others, and of all, as parts of that. With 'all' overlaps are looked for less often. */
#include "ask.h"
#include "plate.h"

enum { NONE, OTHERS, ALL, KINDS, MOST = 1000 };

static const double spacing = 5e-3, speed = 2.5;
static const int first_steps = 10; /* lists are made in these */

/* CPU time of a step, s. */
static double time_step(const dem_model *model, const dem_options *options, int steps)
{
    dem_simulation *simulation;
    ask(dem_simulation_create(&simulation, model, options));
    const double h = ask_options(simulation).max_step;
    ask(dem_simulation_advance(simulation, first_steps * h));
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    ask(dem_simulation_advance(simulation, (first_steps + steps) * h));
    const double spent = seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    dem_simulation_destroy(simulation);
    return spent / steps;
}

int main(int argc, char **argv)
{
    static const dem_bodies bodies[KINDS] = {DEM_BODIES_NONE, DEM_BODIES_OTHERS, DEM_BODIES_ALL};
    static double times[KINDS][MOST];
    must(argc == 6 && atoi(argv[5]) > 0 && atoi(argv[5]) <= MOST, "NODES GAP STEPS METHOD TURNS");
    const int n = atoi(argv[5]);
    const size_t n_turns = (size_t)n;
    dem_lattice both = plate_make_two((dem_index)atof(argv[1]), atof(argv[2]), spacing, speed);
    dem_model *model;
    ask(dem_model_create(&model, &both, NULL, 0));
    dem_lattice_free(&both);
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    ask(dem_method_find(&options.method, argv[4]));
    for (int turn = 0; turn < n; turn++)
        for (int k = 0; k < KINDS; k++) {
            const int kind = (turn + k) % KINDS;
            options.bodies = bodies[kind];
            times[kind][turn] = time_step(model, &options, atoi(argv[3]));
        }
    for (int turn = 0; turn < n; turn++) {
        times[OTHERS][turn] /= times[NONE][turn];
        times[ALL][turn] /= times[NONE][turn];
    }
    (void)printf("%s: %.2f us a step, %.4f with contact of others, %.4f of all\n", argv[4],
                 1e6 * median(times[NONE], n_turns), median(times[OTHERS], n_turns), median(times[ALL], n_turns));
    dem_model_destroy(model);
    return 0;
}
