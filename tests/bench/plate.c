/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/motion.h"
#include "plate.h"

#include <math.h>

static const double youngs_modulus = 1e7, density = 1050.0;

double plate_bond(void)
{
    return youngs_modulus * sqrt(3.0) / 2.0;
}

double plate_mass(double spacing)
{
    return density * spacing * spacing * sqrt(3.0) / 2.0;
}

double plate_period(double spacing)
{
    return sqrt(plate_mass(spacing) / plate_bond());
}

static void *zeros(dem_index n, size_t size)
{
    void *array = calloc((size_t)n, size);
    must(array != NULL, "out of memory");
    return array;
}

static void join(dem_lattice *l, dem_index i, dem_index j)
{
    l->ends[2 * l->n_springs] = i;
    l->ends[2 * l->n_springs + 1] = j;
    l->n_springs++;
}

static void join_rows(dem_lattice *l, dem_index columns, dem_index rows)
{
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const dem_index column = i % columns, row = i / columns, side = row % 2 ? column + 1 : column - 1;
        if (column + 1 < columns) join(l, i, i + 1);
        if (row + 1 == rows) continue;
        if (side >= 0 && side < column) join(l, i, i + columns - 1);
        join(l, i, i + columns);
        if (side < columns && side > column) join(l, i, i + columns + 1);
    }
}

dem_lattice plate_make(dem_index columns, dem_index rows, double spacing)
{
    dem_lattice l = dem_lattice_empty();
    l.n_nodes = columns * rows;
    l.x = zeros(2 * l.n_nodes, sizeof *l.x);
    l.velocity = zeros(2 * l.n_nodes, sizeof *l.velocity);
    l.mass = zeros(l.n_nodes, sizeof *l.mass);
    l.flags = zeros(l.n_nodes, sizeof *l.flags);
    l.ends = zeros(6 * l.n_nodes, sizeof *l.ends);
    l.rest_length = zeros(3 * l.n_nodes, sizeof *l.rest_length);
    l.stiffness = zeros(3 * l.n_nodes, sizeof *l.stiffness);
    for (dem_index i = 0; i < l.n_nodes; i++) {
        const dem_index column = i % columns, row = i / columns;
        l.x[2 * i] = ((double)column + 0.5 * (double)(row % 2)) * spacing;
        l.x[2 * i + 1] = (double)row * spacing * sqrt(3.0) / 2.0;
        l.mass[i] = plate_mass(spacing);
    }
    join_rows(&l, columns, rows);
    for (dem_index k = 0; k < l.n_springs; k++) {
        l.rest_length[k] = spacing;
        l.stiffness[k] = plate_bond() * spacing;
    }
    return l;
}

/* From two neighbours of a row to the node between them above, and below. */
void plate_triangulate(dem_lattice *l, dem_index columns)
{
    l->triangles = zeros(6 * l->n_nodes, sizeof *l->triangles);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const dem_index shift = i / columns % 2, up = i + columns + shift, down = i - columns + shift;
        if (i % columns + 1 == columns) continue;
        if (up < l->n_nodes) {
            const dem_index corners[] = {i, i + 1, up};
            for (int c = 0; c < 3; c++) l->triangles[3 * l->n_triangles + c] = corners[c];
            l->n_triangles++;
        }
        if (down >= 0) {
            const dem_index corners[] = {i + 1, i, down};
            for (int c = 0; c < 3; c++) l->triangles[3 * l->n_triangles + c] = corners[c];
            l->n_triangles++;
        }
    }
    free(l->flags);
    l->flags = NULL;
}

/* Springs of stiffness k per length have E h = 2 k/sqrt 3. */
dem_lattice plate_make_falling(double spacing)
{
    static const double width = 0.08, height = 0.13, speed[2] = {0.0, -10.0}, tilt = 0.03;
    const dem_index columns = llround(width / spacing) + 1, rows = llround(height / (spacing * sqrt(3.0) / 2.0)) + 1;
    dem_lattice body = plate_make(columns, rows, spacing);
    double lift[2] = {0.0, INFINITY};
    plate_triangulate(&body, columns);
    dem_lattice_move(&body, tilt, (const double[2]){0.0, 0.0});
    for (dem_index i = 0; i < body.n_nodes; i++) lift[1] = fmin(lift[1], body.x[2 * i + 1]);
    lift[1] = 0.2 * spacing - lift[1];
    dem_lattice_move(&body, 0.0, lift);
    ask(dem_lattice_launch(&body, speed));
    return body;
}

void plate_guard(dem_lattice *l, double strength)
{
    l->guard = zeros(l->n_triangles, sizeof *l->guard);
    for (dem_index k = 0; k < l->n_triangles; k++) l->guard[k] = strength * 2.0 / sqrt(3.0) * plate_bond();
}

void plate_damp(dem_lattice *l, double time)
{
    l->viscosity = zeros(l->n_springs, sizeof *l->viscosity);
    for (dem_index k = 0; k < l->n_springs; k++) l->viscosity[k] = time * l->stiffness[k];
}

dem_lattice plate_make_two(dem_index nodes, double gap, double spacing, double speed)
{
    const dem_index columns = llround(sqrt((double)nodes)), rows = columns;
    const double height = ((double)(rows - 1) * sqrt(3.0) / 2.0 + gap) * spacing;
    dem_lattice both = dem_lattice_empty(), block = plate_make(columns, rows, spacing);
    plate_triangulate(&block, columns);
    ask(dem_lattice_launch(&block, (const double[2]){0.0, speed}));
    ask(dem_lattice_append(&both, &block));
    dem_lattice_move(&block, 0.0, (const double[2]){0.37 * spacing, height});
    ask(dem_lattice_launch(&block, (const double[2]){0.0, -2.0 * speed}));
    ask(dem_lattice_append(&both, &block));
    dem_lattice_free(&block);
    return both;
}

void plate_write_lammps(const dem_lattice *l, double spacing, double pad, const char *path)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    FILE *file = fopen(path, "w");
    must(file != NULL, path);
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) {
        low[k % 2] = fmin(low[k % 2], l->x[k] - pad);
        high[k % 2] = fmax(high[k % 2], l->x[k] + pad);
    }
    (void)fprintf(file, "plate\n\n%lld atoms\n%lld bonds\n1 atom types\n1 bond types\n6 extra special per atom\n\n",
                  (long long)l->n_nodes, (long long)l->n_springs);
    (void)fprintf(file, "%.17g %.17g xlo xhi\n%.17g %.17g ylo yhi\n%.17g %.17g zlo zhi\n\n", low[0], high[0], low[1],
                  high[1], -0.5 * spacing, 0.5 * spacing);
    (void)fprintf(file, "Masses\n\n1 %.17g\n\nAtoms # bond\n\n", plate_mass(spacing));
    for (dem_index i = 0; i < l->n_nodes; i++)
        (void)fprintf(file, "%lld %d 1 %.17g %.17g 0\n", (long long)i + 1, l->body != NULL ? l->body[i] + 1 : 1,
                      l->x[2 * i], l->x[2 * i + 1]);
    (void)fprintf(file, "\nVelocities\n\n");
    for (dem_index i = 0; i < l->n_nodes; i++)
        (void)fprintf(file, "%lld %.17g %.17g 0\n", (long long)i + 1, l->velocity[2 * i], l->velocity[2 * i + 1]);
    (void)fprintf(file, "\nBonds\n\n");
    for (dem_index k = 0; k < l->n_springs; k++)
        (void)fprintf(file, "%lld 1 %lld %lld\n", (long long)k + 1, (long long)l->ends[2 * k] + 1,
                      (long long)l->ends[2 * k + 1] + 1);
    must(fclose(file) == 0, path);
    (void)printf("springs %lld\nconstant %.17g\nlength %.17g\nperiod %.17g\n", (long long)l->n_springs,
                 0.5 * plate_bond(), spacing, plate_period(spacing));
}

void plate_write_state(const dem_simulation *simulation, const char *path)
{
    motion state;
    motion_see(simulation, &state);
    FILE *file = fopen(path, "w");
    must(file != NULL, path);
    for (dem_index i = 0; i < ask_sizes(dem_simulation_model(simulation)).n_nodes; i++)
        (void)fprintf(file, "%.17g %.17g %.17g %.17g\n", state.x[2 * i], state.x[2 * i + 1], state.v[2 * i],
                      state.v[2 * i + 1]);
    must(fclose(file) == 0, path);
}

dem_lattice plate_make_rubber(double nodes, double height)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = youngs_modulus,
                                 .poissons_ratio = 1.0 / 3.0,
                                 .density = density,
                                 .thickness = 1.0,
                                 .guard = 0.02};
    const double spacing = 1e-3, columns = sqrt(sqrt(3.0) * nodes), up[2] = {0.0, height}, speed[2] = {0.0, -1.0};
    dem_lattice l = dem_lattice_empty();
    ask(dem_lattice_rectangle(&l, columns * spacing, 0.5 * columns * spacing, spacing));
    ask(dem_lattice_assemble(&l, &rubber));
    dem_lattice_move(&l, 0.0, up);
    ask(dem_lattice_launch(&l, speed));
    return l;
}
