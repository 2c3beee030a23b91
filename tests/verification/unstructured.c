/* SPDX-License-Identifier: BSD-3-Clause */
#include "unstructured.h"

#include <stdlib.h>

#include "support.h"

typedef struct edge {
    dem_index ends[2]; /* ascending */
    dem_index corner;  /* of its triangle, 3 triangle + c: the one that is not on it */
} edge;

static int compare(const void *a, const void *b)
{
    const edge *p = a, *q = b;
    if (p->ends[0] != q->ends[0]) return p->ends[0] < q->ends[0] ? -1 : 1;
    return (p->ends[1] > q->ends[1]) - (p->ends[1] < q->ends[1]);
}

/* All edges of all triangles; the two of one place are neighbours. */
static void list_edges(const dem_lattice *l, edge *list)
{
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
        const dem_index *corner = &l->triangles[k - k % 3], a = corner[(k + 1) % 3], b = corner[(k + 2) % 3];
        list[k] = (edge){{a < b ? a : b, a < b ? b : a}, k};
    }
    qsort(list, (size_t)(3 * l->n_triangles), sizeof *list, compare);
}

/* Twice the area of a triangle. */
static double area(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static double cosine(const double *at, const double *a, const double *b)
{
    const double u[2] = {a[0] - at[0], a[1] - at[1]}, v[2] = {b[0] - at[0], b[1] - at[1]};
    return (u[0] * v[0] + u[1] * v[1]) / (hypot(u[0], u[1]) * hypot(v[0], v[1]));
}

/* Gives two triangles the other diagonal where the angles that face their edge are more than a half turn.
 * \return whether it did */
static bool flip(dem_lattice *l, const edge *one, const edge *other)
{
    dem_index *t = &l->triangles[one->corner - one->corner % 3], *u = &l->triangles[other->corner - other->corner % 3];
    const dem_index p = l->triangles[one->corner], q = l->triangles[other->corner];
    const dem_index a = t[(one->corner + 1) % 3], b = t[(one->corner + 2) % 3];
    const double *x = l->x;
    const double sum = cosine(&x[2 * p], &x[2 * a], &x[2 * b]) + cosine(&x[2 * q], &x[2 * a], &x[2 * b]);
    if (sum > -1e-9 || area(&x[2 * p], &x[2 * a], &x[2 * q]) <= 0.0 || area(&x[2 * q], &x[2 * b], &x[2 * p]) <= 0.0)
        return false;
    t[0] = p, t[1] = a, t[2] = q;
    u[0] = q, u[1] = b, u[2] = p;
    return true;
}

/* Each triangle takes part in one flip at most, since the list of edges is that of before. */
static bool flip_all(dem_lattice *l, edge *list, unsigned char *turned)
{
    bool any = false;
    list_edges(l, list);
    for (dem_index k = 0; k < l->n_triangles; k++) turned[k] = 0;
    for (dem_index k = 0; k + 1 < 3 * l->n_triangles; k++) {
        const dem_index one = list[k].corner / 3, other = list[k + 1].corner / 3;
        if (compare(&list[k], &list[k + 1]) != 0 || turned[one] || turned[other]) continue;
        if (!flip(l, &list[k], &list[k + 1])) continue;
        turned[one] = turned[other] = 1;
        any = true;
    }
    return any;
}

static void make_delaunay(dem_lattice *l)
{
    edge *list = malloc((size_t)(3 * l->n_triangles) * sizeof *list);
    unsigned char *turned = malloc((size_t)l->n_triangles);
    assert_true(list != NULL && turned != NULL);
    while (flip_all(l, list, turned)) continue;
    free(list);
    free(turned);
}

/* Moves every inner node half-way to the mean of its neighbours; those on the outline have an edge of one triangle. */
static void smooth(dem_lattice *l)
{
    edge *list = malloc((size_t)(3 * l->n_triangles) * sizeof *list);
    double *sum = calloc((size_t)(3 * l->n_nodes), sizeof *sum);
    assert_true(list != NULL && sum != NULL);
    list_edges(l, list);
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
        const dem_index last = 3 * l->n_triangles - 1;
        const bool inner =
            (k > 0 && compare(&list[k], &list[k - 1]) == 0) || (k < last && compare(&list[k], &list[k + 1]) == 0);
        for (int end = 0; end < 2; end++) {
            double *of = &sum[3 * list[k].ends[end]];
            const double *x = &l->x[2 * list[k].ends[1 - end]];
            of[0] += x[0];
            of[1] += x[1];
            of[2] += inner ? 1.0 : (double)NAN;
        }
    }
    for (dem_index i = 0; i < l->n_nodes; i++)
        for (int axis = 0; axis < 2 && !isnan(sum[3 * i + 2]); axis++)
            l->x[2 * i + axis] += 0.5 * (sum[3 * i + axis] / sum[3 * i + 2] - l->x[2 * i + axis]);
    free(sum);
    free(list);
}

void unstructured_make(dem_lattice *l, double spacing, uint64_t seed)
{
    for (uint64_t round = 0; round < 12; round++) {
        assert_ok(dem_lattice_jitter(l, 0.5 * spacing, seed + 1000 * round));
        make_delaunay(l);
    }
    for (int round = 0; round < 10; round++) {
        smooth(l);
        make_delaunay(l);
    }
}
