/* SPDX-License-Identifier: BSD-3-Clause */
/* Rings are made one by one. The triangulation is Bowyer and Watson's: a node takes away the triangles whose
 * circumcircles it is in, and is joined to the edges of the hole. */
#include "elastic_bodies.h"

#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include <stdbool.h>
#include <stdlib.h>

#include "harness/cleanup.h"
#include "harness/cleanup_gsl.h"
#include "../unit/close.h"

static void allocate(dem_lattice *l, dem_index n_nodes, dem_index n_triangles)
{
    *l = dem_lattice_empty();
    l->n_nodes = n_nodes;
    l->n_triangles = n_triangles;
    l->x = calloc((size_t)n_nodes, 2 * sizeof *l->x);
    l->triangles = calloc((size_t)n_triangles, 3 * sizeof *l->triangles);
    assert_true(l->x != NULL && l->triangles != NULL);
}

static void put_on_circle(double *x, dem_index i, double radius, double turn)
{
    x[2 * i] = radius * cos(2.0 * M_PI * turn);
    x[2 * i + 1] = radius * sin(2.0 * M_PI * turn);
}

/* ---- rings ---- */

/* Ring k of a disc has 6 k nodes at the radius k, the next of which begin at any angle. */
static dem_index first_of(dem_index ring)
{
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1);
}

/* Between rings the next triangle stands on the side, of either ring, whose middle comes first. */
static void fill_ring(dem_lattice *l, dem_index ring, dem_index *t)
{
    const dem_index inner = 6 * ring, outer = inner + 6;
    dem_index i = 0, o = 0;
    while (i < inner || o < outer) {
        const dem_index a = first_of(ring) + (inner > 0 ? i % inner : 0), b = first_of(ring + 1) + o % outer;
        const bool on_outer = o < outer && (inner == 0 || (2 * o + 1) * inner <= (2 * i + 1) * outer || i == inner);
        dem_index *corner = l->triangles + 3 * (*t)++;
        corner[0] = a;
        corner[1] = b;
        if (on_outer)
            corner[2] = first_of(ring + 1) + ++o % outer;
        else
            corner[2] = first_of(ring) + ++i % inner;
        if (inner == 0 && o == outer) break;
    }
}

void elastic_bodies_rings(dem_lattice *out, dem_index n)
{
    dem_index t = 0;
    allocate(out, first_of(n + 1), 6 * n * n);
    for (dem_index ring = 1; ring <= n; ring++)
        for (dem_index j = 0; j < 6 * ring; j++)
            put_on_circle(out->x, first_of(ring) + j, (double)ring, (double)j / (6.0 * (double)ring));
    for (dem_index ring = 0; ring < n; ring++) fill_ring(out, ring, &t);
    assert_int_equal(t, out->n_triangles);
}

/* ---- Delaunay ---- */

typedef struct mesh {
    double *x;
    dem_index n, *corners; /* [n][3] */
} mesh;

static bool is_in_circle(const mesh *m, dem_index t, const double *p)
{
    double a[3][3];
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 2; k++) a[c][k] = m->x[2 * m->corners[3 * t + c] + k] - p[k];
        a[c][2] = a[c][0] * a[c][0] + a[c][1] * a[c][1];
    }
    return a[0][0] * (a[1][1] * a[2][2] - a[2][1] * a[1][2]) - a[1][0] * (a[0][1] * a[2][2] - a[2][1] * a[0][2]) +
               a[2][0] * (a[0][1] * a[1][2] - a[1][1] * a[0][2]) >
           0.0;
}

/* Whether a taken triangle has this edge the other way round. */
static bool is_between(const mesh *m, const bool *taken, dem_index i, dem_index j)
{
    for (dem_index k = 0; k < 3 * m->n; k++)
        if (taken[k / 3] && m->corners[k] == j && m->corners[k / 3 * 3 + (k + 1) % 3] == i) return true;
    return false;
}

static void insert(mesh *m, dem_index node, bool *taken)
{
    const dem_index before = m->n;
    dem_index kept = 0;
    for (dem_index t = 0; t < before; t++) taken[t] = is_in_circle(m, t, m->x + 2 * node);
    for (dem_index k = 0; k < 3 * before; k++) {
        const dem_index i = m->corners[k], j = m->corners[k / 3 * 3 + (k + 1) % 3];
        const mesh old = {m->x, before, m->corners};
        if (!taken[k / 3] || is_between(&old, taken, i, j)) continue;
        const dem_index made[3] = {i, j, node};
        taken[m->n] = false;
        for (int c = 0; c < 3; c++) m->corners[3 * m->n + c] = made[c];
        m->n++;
    }
    for (dem_index t = 0; t < m->n; t++) {
        if (taken[t]) continue;
        for (int c = 0; c < 3; c++) m->corners[3 * kept + c] = m->corners[3 * t + c];
        kept++;
    }
    m->n = kept;
}

/* The mean distance of n nodes in the circle, times 0.4. */
static bool is_apart(const double *x, dem_index i, dem_index n)
{
    for (dem_index j = 0; j < i; j++)
        if (hypot(x[2 * i] - x[2 * j], x[2 * i + 1] - x[2 * j + 1]) < 0.4 * sqrt(M_PI / (double)n)) return false;
    return true;
}

void elastic_bodies_delaunay(dem_lattice *out, dem_index rim, dem_index inside, unsigned long seed)
{
    const dem_index n = rim + inside;
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    CLEANUP(free_memory) bool *taken = calloc(16 * (size_t)n, sizeof *taken);
    dem_index kept = 0;
    gsl_rng_set(r, seed);
    allocate(out, n + 3, 16 * n); /* three more: a triangle about everything */
    mesh m = {out->x, 1, out->triangles};
    for (dem_index i = 0; i < rim; i++) put_on_circle(m.x, i, 1.0, (double)i / (double)rim);
    for (dem_index i = rim; i < n; i++) do
            put_on_circle(m.x, i, 0.93 * sqrt(gsl_rng_uniform(r)), gsl_rng_uniform(r));
        while (!is_apart(m.x, i, n));
    for (dem_index c = 0; c < 3; c++) {
        put_on_circle(m.x, n + c, 1e3, (double)c / 3.0 + 0.013);
        m.corners[c] = n + c;
    }
    for (dem_index i = n - 1; i >= 0; i--) insert(&m, i, taken); /* the rim last: its nodes alone are on one circle */
    for (dem_index t = 0; t < m.n; t++) {
        const dem_index *c = m.corners + 3 * t;
        if (c[0] >= n || c[1] >= n || c[2] >= n) continue;
        for (int k = 0; k < 3; k++) m.corners[3 * kept + k] = c[k];
        kept++;
    }
    out->n_nodes = n;
    out->n_triangles = kept;
    assert_int_equal(kept, 2 * n - 2 - rim); /* Euler: every node of the rim is on the boundary */
}
