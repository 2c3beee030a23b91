/* SPDX-License-Identifier: BSD-3-Clause */
/* A stretched strip of springs without triangles, cut from one end between two rows: when its springs break, here and
 * for LAMMPS (tests/bench/strip.py).
 *
 *      bench_strip DRIVE METHOD STEP FILE   time in a/c, and both nodes, of each break into FILE; STEP in a/c
 *      bench_strip DRIVE lammps FILE        the strip at rest as a data file of LAMMPS, and what a run needs
 *
 * DRIVE is G/(E stretch^2 a) of the strip ahead of the cut, stretch the critical one. A run prints its steps and its
 * CPU time, s. */
#include <math.h>
#include <string.h>

#include "ask.h"
#include "plate.h"

static const double spacing = 5e-3, stretch = 1e-3;     /* m; critical */
enum { COLUMNS = 91, ROWS = 43, CUT = 10, MOST = 130 }; /* nodes; spacings; breaks */

/* Strain across the strip, Poisson's ratio 1/3: G = E strain^2 H/(2 (1 - nu^2)). */
static double strain_across(double drive)
{
    const double height = (ROWS - 1) * 0.5 * sqrt(3.0);
    return stretch * sqrt(2.0 * (1.0 - 1.0 / 9.0) * drive / height);
}

static bool is_cut(const dem_lattice *l, dem_index spring)
{
    const dem_index a = l->ends[2 * spring], b = l->ends[2 * spring + 1], below = ROWS / 2;
    const double x = 0.5 * (l->x[2 * a] + l->x[2 * b]);
    return a / COLUMNS == below && b / COLUMNS == below + 1 && x < CUT * spacing;
}

static dem_lattice make_strip(double drive)
{
    dem_lattice l = plate_make(COLUMNS, ROWS, spacing);
    dem_index n = 0;
    for (dem_index k = 0; k < l.n_springs; k++) {
        if (is_cut(&l, k)) continue;
        for (int end = 0; end < 2; end++) l.ends[2 * n + end] = l.ends[2 * k + end];
        n++;
    }
    l.n_springs = n;
    l.critical_stretch = calloc((size_t)n, sizeof(double));
    l.position = calloc((size_t)(2 * l.n_nodes), sizeof(double));
    must(l.critical_stretch != NULL && l.position != NULL, "out of memory");
    for (dem_index k = 0; k < n; k++) l.critical_stretch[k] = stretch;
    for (dem_index j = 0; j < 2 * l.n_nodes; j++) l.position[j] = l.x[j] * (j % 2 ? 1.0 + strain_across(drive) : 1.0);
    return l;
}

typedef struct record {
    FILE *file;
    dem_index n;
} record;

static dem_status note(void *context, const dem_simulation *s, const dem_break *what)
{
    record *r = context;
    const dem_index *ends = &dem_model_lattice(dem_simulation_model(s))->ends[2 * what->spring];
    if (r->n++ < MOST)
        (void)fprintf(r->file, "%.17g %lld %lld\n", what->t / plate_period(spacing), (long long)ends[0] + 1,
                      (long long)ends[1] + 1);
    return r->n < MOST ? DEM_OK : DEM_STOPPED;
}

static void run(double drive, dem_options *options, const char *path)
{
    dem_lattice l = make_strip(drive);
    dem_index sides[2 * COLUMNS];
    for (dem_index j = 0; j < COLUMNS; j++) {
        sides[j] = j;
        sides[COLUMNS + j] = l.n_nodes - COLUMNS + j;
    }
    const dem_boundary hold = {.struct_size = sizeof hold,
                               .kind = DEM_BOUNDARY_VELOCITY,
                               .components = DEM_COMPONENT_X | DEM_COMPONENT_Y,
                               .n_nodes = 2 * COLUMNS,
                               .nodes = sides};
    record r = {.file = fopen(path, "w")};
    must(r.file != NULL, path);
    dem_model *model;
    dem_simulation *s;
    options->n_boundaries = 1;
    options->boundaries = &hold;
    ask(dem_model_create(&model, &l, NULL, 0));
    ask(dem_simulation_create(&s, model, options));
    const dem_observer observer = {.struct_size = sizeof observer, .broken = note, .context = &r};
    ask(dem_simulation_observe(s, &observer));
    const double cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    must(dem_simulation_advance(s, 1000.0 * plate_period(spacing)) == DEM_STOPPED, "too few springs break");
    (void)printf("steps %lld\ncpu %.6f\n", (long long)ask_counts(s).steps, seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu);
    must(fclose(r.file) == 0, path);
    dem_simulation_destroy(s);
    dem_model_destroy(model);
    dem_lattice_free(&l);
}

static void write_lammps(double drive, const char *path)
{
    dem_lattice l = make_strip(drive);
    plate_write_lammps(&l, spacing, 2.0 * spacing, path);
    (void)printf("side %d\nnodes %lld\nheight %.17g\nstrain %.17g\nstretch %.17g\n", COLUMNS, (long long)l.n_nodes,
                 (ROWS - 1) * 0.5 * sqrt(3.0) * spacing, strain_across(drive), stretch);
    dem_lattice_free(&l);
}

int main(int argc, char **argv)
{
    must(argc == 5 || (argc == 4 && strcmp(argv[2], "lammps") == 0), "DRIVE METHOD STEP FILE or DRIVE lammps FILE");
    const double drive = atof(argv[1]);
    if (argc == 4) {
        write_lammps(drive, argv[3]);
        return 0;
    }
    dem_options options = dem_options_default();
    ask(dem_method_find(&options.method, argv[2]));
    options.gravity[1] = 0.0;
    options.fixed_step = atof(argv[3]) * plate_period(spacing);
    run(drive, &options, argv[4]);
    return 0;
}
