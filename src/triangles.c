/* SPDX-License-Identifier: BSD-3-Clause */
/* The folding guard W = A0 g w(J), w = (-ln(J/Jc))^3, J = A/A0; forces gathered node by node in a fixed order. */
#include "triangles.h"

#include <stdbool.h>
#include <stdlib.h>

#include "status.h"

static const double taylor_below = 0.05;

/* ln(r) for 0 < r <= 1, the same bits on every machine: r = m 2^-k, ln m = 2 artanh((m - 1)/(m + 1)). */
static double natural_log(double r)
{
    const double ln2 = 0.693147180559945309417;
    double m = r, halvings = 0.0;
    while (m < 0.70710678118654752) {
        m *= 2.0;
        halvings += 1.0;
    }
    const double s = (m - 1.0) / (m + 1.0), s2 = s * s; /* |s| < 0.1716: the first term left out is below 1e-17 */
    double series = 0.0;
    for (int k = 21; k >= 1; k -= 2) series = series * s2 + 1.0 / k;
    return 2.0 * s * series - halvings * ln2;
}

void triangles_guard_law(double area_ratio, double *energy, double *slope)
{
    *energy = 0.0;
    *slope = 0.0;
    if (area_ratio >= TRIANGLES_GUARD_ONSET) return;
    const double J = fmax(area_ratio, taylor_below), beyond = area_ratio - J;
    const double L = -natural_log(J / TRIANGLES_GUARD_ONSET);
    const double w = L * L * L, w1 = -3.0 * L * L / J, w2 = (6.0 * L + 3.0 * L * L) / (J * J);
    *energy = w + beyond * (w1 + 0.5 * beyond * w2);
    *slope = w1 + beyond * w2;
}

static double area(const triangles *t, dem_index i, dem_index p, const double *x)
{
    return triangles_area(vec2_at(x, i), vec2_at(x, t->next[p]), vec2_at(x, t->last[p]));
}

vec2 triangles_force(const triangles *t, dem_index i, const double *x)
{
    vec2 force = {0.0, 0.0};
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
        const double A = area(t, i, p, x);
        if (!(A < TRIANGLES_GUARD_ONSET * t->rest_area[p])) continue;
        double energy, slope;
        triangles_guard_law(A / t->rest_area[p], &energy, &slope);
        const vec2 opposite = vec2_sub(vec2_at(x, t->last[p]), vec2_at(x, t->next[p]));
        const vec2 gradient = {-0.5 * opposite.y, 0.5 * opposite.x}; /* dA/dx_i */
        force = vec2_along(force, -t->strength[p] * slope, gradient);
    }
    return force;
}

double triangles_virial(const triangles *t, dem_index i, dem_index p, const double *x)
{
    const double A = area(t, i, p, x);
    double energy, slope;
    triangles_guard_law(A / t->rest_area[p], &energy, &slope);
    return A * t->strength[p] * slope;
}

static double slot_energy(const triangles *t, dem_index i, dem_index p, const double *x)
{
    double energy, slope;
    triangles_guard_law(area(t, i, p, x) / t->rest_area[p], &energy, &slope);
    return t->rest_area[p] * t->strength[p] * energy;
}

double triangles_node_energy(const triangles *t, dem_index i, const double *x)
{
    double energy = 0.0;
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) energy += slot_energy(t, i, p, x);
    return energy;
}

double triangles_energy(const triangles *t, const double *x)
{
    double energy = 0.0;
    for (dem_index i = 0; i < t->n_nodes; i++)
        for (dem_index p = t->row[i]; p < t->row[i + 1]; p++)
            if (i < t->next[p] && i < t->last[p]) energy += slot_energy(t, i, p, x);
    return energy;
}

static bool guarded(const dem_lattice *lattice, dem_index k)
{
    return lattice->guard != NULL && lattice->guard[k] > 0.0;
}

static dem_status allocate(triangles *t, dem_index slots)
{
    const size_t n = (size_t)slots + 1;
    t->row = calloc((size_t)t->n_nodes + 1, sizeof *t->row);
    t->next = malloc(n * sizeof *t->next);
    t->last = malloc(n * sizeof *t->last);
    t->rest_area = malloc(n * sizeof *t->rest_area);
    t->strength = malloc(n * sizeof *t->strength);
    CHECK(t->row && t->next && t->last && t->rest_area && t->strength, DEM_ERROR_MEMORY,
          "out of memory for %lld triangles", (long long)(slots / 3));
    return DEM_OK;
}

static void fill(triangles *t, const dem_lattice *lattice)
{
    for (dem_index k = 0; k < lattice->n_triangles; k++)
        for (int c = 0; c < 3 && guarded(lattice, k); c++) t->row[lattice->triangles[3 * k + c] + 1]++;
    for (dem_index i = 0; i < t->n_nodes; i++) t->row[i + 1] += t->row[i];
    for (dem_index k = lattice->n_triangles - 1; k >= 0; k--) { /* backwards: row[i+1] counts down to the row's start */
        const dem_index *corner = &lattice->triangles[3 * k];
        for (int c = 0; c < 3 && guarded(lattice, k); c++) {
            const dem_index p = --t->row[corner[c] + 1];
            t->next[p] = corner[(c + 1) % 3];
            t->last[p] = corner[(c + 2) % 3];
            t->strength[p] = lattice->guard[k];
            t->rest_area[p] = triangles_area(vec2_at(lattice->x, corner[0]), vec2_at(lattice->x, corner[1]),
                                             vec2_at(lattice->x, corner[2]));
        }
    }
}

/* After fill() row[i + 1] is the start of row i. */
static void shift_rows(triangles *t, dem_index slots)
{
    for (dem_index i = 0; i < t->n_nodes; i++) t->row[i] = t->row[i + 1];
    t->row[t->n_nodes] = slots;
}

dem_status triangles_compile(triangles *out, const dem_lattice *lattice)
{
    triangles t = {.n_nodes = lattice->n_nodes};
    dem_index slots = 0;
    for (dem_index k = 0; k < lattice->n_triangles; k++) slots += guarded(lattice, k) ? 3 : 0;
    const dem_status status = allocate(&t, slots);
    if (status != DEM_OK) {
        triangles_free(&t);
        return status;
    }
    fill(&t, lattice);
    shift_rows(&t, slots);
    *out = t;
    return DEM_OK;
}

void triangles_free(triangles *t)
{
    free(t->row);
    free(t->next);
    free(t->last);
    free(t->rest_area);
    free(t->strength);
    *t = (triangles){0};
}
