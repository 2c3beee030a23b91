/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run takes beside its time loop: setting up, memory, frames. A rectangle with the folding guard above a ground;
 * CPU time, of frames and steps the least, of set-up in the last of five turns: memory that the system has to clear
 * first is slow. `bench_setup NODES` */
#define _XOPEN_SOURCE 700 /* getrusage */
#include <math.h>
#include <sys/resource.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "plate.h"
#include "ask.h"
#include "memory.h"

static const char path[] = "bench_setup.vtkhdf", beside[] = "bench_setup.body.vtkhdf";

typedef struct body {
    dem_model *model;
    dem_simulation *simulation;
    dem_index n_nodes;
    double spent[3]; /* s, on the lattice, the model and the simulation */
} body;

static double lap(double *start)
{
    const double now = seconds(CLOCK_PROCESS_CPUTIME_ID), spent = now - *start;
    *start = now;
    return spent;
}

static body set_up(double nodes)
{
    const double points[4] = {-100.0, 0.0, 100.0, 0.0};
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points};
    const dem_options options = dem_options_default();
    double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    dem_lattice l = plate_make_rubber(nodes, 1e-3);
    body b = {.n_nodes = l.n_nodes, .spent = {lap(&start)}};
    ask(dem_model_create(&b.model, &l, &ground, 1));
    dem_lattice_free(&l);
    b.spent[1] = lap(&start);
    ask(dem_simulation_create(&b.simulation, b.model, &options));
    b.spent[2] = lap(&start);
    return b;
}

static void tear_down(body *b)
{
    dem_simulation_destroy(b->simulation);
    dem_model_destroy(b->model);
}

static double resident(void) /* bytes, at most so far */
{
    struct rusage used;
    must(getrusage(RUSAGE_SELF, &used) == 0, "getrusage");
    return 1024.0 * (double)used.ru_maxrss;
}

/* A frame each 4 steps, so that there is something new to show. */
static void time_frames(body *b, int n)
{
    dem_trajectory_options options = dem_trajectory_options_default();
    const double h = ask_options(b->simulation).max_step;
    double frame = INFINITY, steps = INFINITY;
    dem_trajectory *reader;
    options.frame_interval = 1.0;
    ask(dem_trajectory_create(&reader, path, b->simulation, &options));
    const dem_observer watcher = ask_trajectory_observer(reader);
    for (int k = 1; k <= n; k++) {
        double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
        ask(dem_simulation_advance(b->simulation, 4.0 * h * k));
        steps = fmin(steps, lap(&start));
        ask(watcher.frame(watcher.context, b->simulation));
        frame = fmin(frame, lap(&start));
    }
    ask(dem_trajectory_finish(reader));
    dem_trajectory_destroy(reader);
    must(unlink(path) == 0 && unlink(beside) == 0, path);
    (void)printf("frames     %.2f ms each, a step %.3f ms: %.2f %% of a run with one each 1 ms of %.3g s\n",
                 1e3 * frame, 1e3 * steps / 4.0, 100.0 * frame / (0.25 * steps * 1e-3 / h), h);
}

int main(int argc, char **argv)
{
    must(argc == 2, "NODES");
    const double nodes = atof(argv[1]);
    body b = set_up(nodes);
    for (int turn = 0; turn < 4 && nodes < 2e6; turn++) {
        tear_down(&b);
        b = set_up(nodes);
    }
    const double n = (double)b.n_nodes, whole = b.spent[0] + b.spent[1] + b.spent[2];
    (void)printf(
        "nodes      %lld\nset-up     lattice %.3f s, model %.3f s, simulation %.3f s: %.2f s a million nodes\n",
        (long long)b.n_nodes, b.spent[0], b.spent[1], b.spent[2], 1e6 * whole / n);
    time_frames(&b, nodes < 1e5 ? 100 : 10);
    (void)printf("memory     %.0f bytes a node at most, %.0f resident\n", memory_in_use() / n, resident() / n);
    tear_down(&b);
    return 0;
}
