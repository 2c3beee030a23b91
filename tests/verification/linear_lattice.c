/* SPDX-License-Identifier: BSD-3-Clause */
#include "linear_lattice.h"

#include "support.h"

#include <stdlib.h>
#include <string.h>

/* The line from node i to node j, and by how much u makes it longer. */
typedef struct line {
    dem_index i, j;
    double along[2], longer;
} line;

static line line_between(const dem_lattice *l, const double *u, dem_index i, dem_index j)
{
    const double x = l->x[2 * j] - l->x[2 * i], y = l->x[2 * j + 1] - l->x[2 * i + 1], length = sqrt(x * x + y * y);
    line e = {i, j, {x / length, y / length}, 0.0};
    for (int c = 0; c < 2; c++) e.longer += e.along[c] * (u[2 * j + c] - u[2 * i + c]);
    return e;
}

static void add_tension(double *f, const line *e, double tension)
{
    for (int c = 0; c < 2; c++) {
        f[2 * e->i + c] -= tension * e->along[c];
        f[2 * e->j + c] += tension * e->along[c];
    }
}

/* The coupling of corner c is that of the sides before and behind it. */
static void add_couplings(const dem_lattice *l, const double *u, double *f, dem_index t)
{
    const dem_index *corner = l->triangles + 3 * t;
    const double *coupling = l->coupling + 3 * t;
    line side[3];
    for (int c = 0; c < 3; c++) side[c] = line_between(l, u, corner[c], corner[(c + 1) % 3]);
    for (int c = 0; c < 3; c++) {
        const int before = (c + 2) % 3, behind = (c + 1) % 3;
        add_tension(f, &side[c], coupling[c] * side[before].longer + coupling[behind] * side[behind].longer);
    }
}

void linear_lattice_multiply(const dem_lattice *l, const double *u, double *f)
{
    memset(f, 0, 2 * (size_t)l->n_nodes * sizeof *f);
    for (dem_index k = 0; k < l->n_springs; k++) {
        const line e = line_between(l, u, l->ends[2 * k], l->ends[2 * k + 1]);
        add_tension(f, &e, l->stiffness[k] / l->rest_length[k] * e.longer);
    }
    for (dem_index t = 0; l->coupling != NULL && t < l->n_triangles; t++) add_couplings(l, u, f, t);
}

double linear_lattice_product(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t k = 0; k < n; k++) sum += a[k] * b[k];
    return sum;
}

double *linear_lattice_solve(const dem_lattice *l, const double *f)
{
    const size_t n = 2 * (size_t)l->n_nodes, size = n * sizeof(double);
    double *u = calloc(4 * n, sizeof *u), *r = u + n, *p = r + n, *q = p + n;
    assert_non_null(u);
    memcpy(r, f, size);
    memcpy(p, f, size);
    double rr = linear_lattice_product(r, r, n);
    const double goal = 1e-16 * rr;
    for (int k = 0; rr > goal; k++) {
        assert_true(k < 10000);
        linear_lattice_multiply(l, p, q);
        const double step = rr / linear_lattice_product(p, q, n), before = rr;
        for (size_t c = 0; c < n; c++) {
            u[c] += step * p[c];
            r[c] -= step * q[c];
        }
        rr = linear_lattice_product(r, r, n);
        for (size_t c = 0; c < n; c++) p[c] = r[c] + rr / before * p[c];
    }
    return u;
}

double *linear_lattice_stress(dem_lattice *l, const double *f, double scale)
{
    CLEANUP(support_close) support_run run;
    const dem_options options = support_options();
    CLEANUP(free_memory) double *u = linear_lattice_solve(l, f);
    double *stress = malloc(3 * (size_t)l->n_nodes * sizeof *stress);
    l->position = malloc(2 * (size_t)l->n_nodes * sizeof *l->position);
    assert_true(stress != NULL && l->position != NULL);
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) l->position[k] = l->x[k] + scale * u[k];
    support_open(&run, l, NULL, 0, &options);
    assert_ok(dem_simulation_stress(run.simulation, stress));
    for (dem_index k = 0; k < 3 * l->n_nodes; k++) stress[k] /= scale;
    return stress;
}
