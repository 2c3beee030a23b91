/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs of a flat triangle are stiff and compensate each other by their couplings, so that bounds of the single
 * terms are too high by far. A coupled triangle is therefore bounded as a whole. With its shares of its springs,
 * couplings and area term its energy is (1/2) s.K s in the stretches s of its edges, the change of area being a.s
 * with a_k = L_k cot_k/2. Let D_c be the stiffness at corner c when only this corner moves, and lambda the largest
 * number with det(K - lambda D) = 0 for D of the three D_c. Then lambda times D bounds the triangle, and this takes
 * the place of 2 k n n^T of its shares and 3 max(kappa, 0)/A0 g g^T of its area term. lambda is 2 for equilateral
 * triangles at nu = 1/3, where the two are equal, and below 3 for any other. frequency_bound() in model_scales.c
 * has the rest. */
#include "model/coupled_bound.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/status.h"
#include "model/spring_share.h"

enum { n_squarings = 10 }; /* the 1024th root of 3 is 1.001 */

/* A triangle at rest. */
typedef struct element {
    const coupled_triangle *triangle;
    vec2 normal[3];         /* unit, along the edges */
    double share[3];        /* of the springs, N/m */
    double kappa, area;     /* N/m, m^2 */
    double stiffness[3][3]; /* K */
    sym2 corner[3];         /* D */
} element;

/* ---- the largest eigenvalue ---- */

static double largest_entry(double a[3][3])
{
    double largest = 0.0;
    for (int k = 0; k < 9; k++) largest = fmax(largest, fabs(a[k / 3][k % 3]));
    return largest;
}

/* Divides by the largest entry.  \return that; 0 if there is none but 0 */
static double normalise(double a[3][3])
{
    const double largest = largest_entry(a);
    for (int k = 0; k < 9 && largest > 0.0; k++) a[k / 3][k % 3] /= largest;
    return largest;
}

static void square(double a[3][3])
{
    double product[3][3] = {{0.0}};
    for (int k = 0; k < 27; k++) product[k / 9][k % 3] += a[k / 9][k / 3 % 3] * a[k / 3 % 3][k % 3];
    for (int k = 0; k < 9; k++) a[k / 3][k % 3] = product[k / 3][k % 3];
}

/* A bound of |eigenvalues| of a matrix whose eigenvalues are real, at most 0.1 % high: the trace of its 1024th power is
 * not below that of the largest one. With n the factors taken out, |M| = n0 sqrt(n1 sqrt(n2 ...)). */
static double largest_eigenvalue(double a[3][3])
{
    double taken[n_squarings + 1], bound;
    for (int k = 0; k <= n_squarings; k++) {
        if (k > 0) square(a);
        taken[k] = normalise(a);
    }
    bound = a[0][0] + a[1][1] + a[2][2];
    for (int k = n_squarings; k > 0; k--) bound = sqrt(bound * taken[k]);
    return bound * taken[0];
}

/* ---- one triangle ---- */

static sym2 scaled(double s, sym2 A)
{
    return (sym2){s * A.xx, s * A.xy, s * A.yy};
}

/* a.D^-1 b; D is positive definite. */
static double product_by_inverse(sym2 D, vec2 a, vec2 b)
{
    const double determinant = D.xx * D.yy - D.xy * D.xy;
    return (a.x * (D.yy * b.x - D.xy * b.y) + a.y * (D.xx * b.y - D.xy * b.x)) / determinant;
}

/* K from shares, couplings and area term. */
static void fill_stiffness(element *e)
{
    const coupled_triangle *t = e->triangle;
    double slope[3]; /* a */
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3, last = (k + 2) % 3;
        const double cosine = -vec2_dot(e->normal[next], e->normal[last]); /* of the angle opposite to edge k */
        slope[k] = 0.25 * t->rest_length[0] * t->rest_length[1] * t->rest_length[2] * cosine / e->area;
    }
    for (int k = 0; k < 9; k++) e->stiffness[k / 3][k % 3] = e->kappa / e->area * slope[k / 3] * slope[k % 3];
    for (int k = 0; k < 3; k++) {
        e->stiffness[k][k] += e->share[k];
        e->stiffness[k][(k + 2) % 3] += t->coupling[k];
        e->stiffness[(k + 2) % 3][k] += t->coupling[k];
    }
}

/* Corner c is the beginning of edge c and the end of the last one. */
static void fill_corners(element *e)
{
    for (int c = 0; c < 3; c++) {
        const int last = (c + 2) % 3;
        const vec2 n = e->normal[c], m = e->normal[last];
        const double both = -e->stiffness[c][last];
        const sym2 own = sym2_along((sym2){0.0, 0.0, 0.0}, e->stiffness[c][c], n);
        const sym2 sum = sym2_along(own, e->stiffness[last][last], m);
        e->corner[c] =
            sym2_add(sum, (sym2){2.0 * both * n.x * m.x, both * (n.x * m.y + n.y * m.x), 2.0 * both * n.y * m.y});
    }
}

/* lambda is the largest eigenvalue of K B D^-1 B^T, where B takes displacements of corners to stretches. \return 0
 * where some D_c is not positive definite */
static double factor_of(const element *e)
{
    double inverse[3][3] = {{0.0}}, product[3][3] = {{0.0}};
    for (int c = 0; c < 3; c++) {
        const int last = (c + 2) % 3;
        const sym2 D = e->corner[c];
        if (!(D.xx > 0.0 && D.xx * D.yy > D.xy * D.xy)) return 0.0;
        inverse[c][c] += product_by_inverse(D, e->normal[c], e->normal[c]);
        inverse[last][last] += product_by_inverse(D, e->normal[last], e->normal[last]);
        inverse[c][last] = inverse[last][c] = -product_by_inverse(D, e->normal[c], e->normal[last]);
    }
    for (int k = 0; k < 27; k++) product[k / 9][k % 3] += e->stiffness[k / 9][k / 3 % 3] * inverse[k / 3 % 3][k % 3];
    return largest_eigenvalue(product);
}

/* What the blocks of springs and areas have of corner c already. */
static sym2 counted_at(const element *e, const double *x, int c)
{
    const dem_index *corner = e->triangle->corner;
    const int last = (c + 2) % 3;
    const vec2 side = vec2_sub(vec2_at(x, corner[last]), vec2_at(x, corner[(c + 1) % 3]));
    const sym2 own = sym2_along((sym2){0.0, 0.0, 0.0}, 2.0 * e->share[c], e->normal[c]);
    const sym2 both = sym2_along(own, 2.0 * e->share[last], e->normal[last]);
    return sym2_along(both, 0.75 * fmax(e->kappa, 0.0) / e->area, (vec2){-side.y, side.x});
}

/* Without lambda each coupling counts like springs of its absolute value along both of its edges, since
 * 2 k s t <= |k| (s^2 + t^2); shares and area are counted already. */
static sym2 bound_of_couplings(const element *e, int c)
{
    const double *k = e->triangle->coupling;
    const int next = (c + 1) % 3, last = (c + 2) % 3;
    const sym2 own = sym2_along((sym2){0.0, 0.0, 0.0}, 2.0 * (fabs(k[c]) + fabs(k[next])), e->normal[c]);
    return sym2_along(own, 2.0 * (fabs(k[c]) + fabs(k[last])), e->normal[last]);
}

static void add_triangle(const dem_lattice *l, const coupled_triangle *t, const double *given, sym2 *block)
{
    const coupled_edges edges = couplings_edges(t, l->x);
    element e = {.triangle = t, .kappa = l->area_stiffness != NULL ? l->area_stiffness[t->triangle] : 0.0};
    for (int k = 0; k < 3; k++) {
        const dem_index spring = t->spring[k];
        e.normal[k] = vec2_scale(1.0 / edges.length[k], edges.edge[k]);
        e.share[k] = springs_rate(l, spring) * spring_share_given(l, t->triangle, spring) / given[spring];
    }
    e.area = 0.5 * vec2_cross(edges.edge[0], edges.edge[1]);
    fill_stiffness(&e);
    fill_corners(&e);
    const double factor = factor_of(&e);
    for (int c = 0; c < 3; c++) {
        const sym2 counted = counted_at(&e, l->x, c);
        const sym2 own = factor > 0.0 && isfinite(factor) ? sym2_add(scaled(factor, e.corner[c]), scaled(-1.0, counted))
                                                          : bound_of_couplings(&e, c);
        block[t->corner[c]] = sym2_add(block[t->corner[c]], own);
    }
}

/* ---- all of them ---- */

dem_status coupled_bound_given(double **given, const dem_lattice *lattice, const springs *s)
{
    *given = calloc((size_t)lattice->n_springs + 1, sizeof **given);
    CHECK(*given, DEM_ERROR_MEMORY, "out of memory for %lld springs", (long long)lattice->n_springs);
    for (dem_index k = 0; k < 3 * lattice->n_triangles; k++) {
        const dem_index i = lattice->triangles[k], j = lattice->triangles[k / 3 * 3 + (k + 1) % 3];
        const dem_index spring = springs_between(s, i, j);
        if (spring >= 0) (*given)[spring] += spring_share_given(lattice, k / 3, spring);
    }
    return DEM_OK;
}

void coupled_bound_add(const dem_lattice *lattice, const couplings *c, const double *given, sym2 *block)
{
    for (dem_index k = 0; k < c->n; k++) add_triangle(lattice, &c->list[k], given, block);
}
